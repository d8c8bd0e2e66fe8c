//! `<bsdf>`.

use caustica_math::Rgb;
use caustica_scene::Diagnostic;
use caustica_scene::description::{MaterialId, MaterialKind, Texture};

use super::class::Class;
use super::context::Context;
use super::fields::Fields;
use super::spectrum::Role;
use super::{ior, plastic, principled, roughness, texture, wrapper};

const BSDFS: &[&str] = &[
    "diffuse",
    "dielectric",
    "thindielectric",
    "roughdielectric",
    "conductor",
    "roughconductor",
    "plastic",
    "roughplastic",
    "principled",
    "principledthin",
    "null",
    "twosided",
    "mask",
    "blendbsdf",
    "bumpmap",
    "normalmap",
];

/// What has no material of its own yet, and the property whose colour it is shown in.
const SHOWN_DIFFUSE: &[(&str, &str)] = &[
    ("pplastic", "diffuse_reflectance"),
    ("phong", "diffuse_reflectance"),
    ("ward", "diffuse_reflectance"),
    ("roughdiffuse", "reflectance"),
    ("difftrans", "transmittance"),
    ("irawan", ""),
    ("hair", ""),
    ("measured", ""),
    ("measured_polarized", ""),
    ("polarizer", ""),
    ("retarder", ""),
    ("circular", ""),
    ("hk", ""),
];

/// What changes another material and is left out so far, so that the inner one is shown.
const SHOWN_INNER: &[&str] = &["bump", "mixturebsdf", "coating", "roughcoating"];

/// The material of an object, read once.
pub(super) fn read(index: usize, cx: &mut Context) -> Result<MaterialId, Diagnostic> {
    if let Some(id) = cx.materials.get(&index) {
        return Ok(*id);
    }
    let mut fields = Fields::new(cx.tree, index);
    let id = match inner(&mut fields, cx)? {
        Some(id) => id,
        None => {
            let kind = kind(&mut fields, cx)?;
            cx.add_material(kind, &fields.object.origin)
        }
    };
    fields.finish(cx);
    cx.materials.insert(index, id);
    Ok(id)
}

/// The material inside of one that changes it and is left out.
fn inner(fields: &mut Fields, cx: &mut Context) -> Result<Option<MaterialId>, Diagnostic> {
    if !SHOWN_INNER.contains(&fields.plugin()) {
        return Ok(None);
    }
    let children = fields.children(Class::Bsdf);
    let Some((_, first)) = children.first() else {
        return Err(fields.error(format!("the {} needs a bsdf inside of it", fields.title())));
    };
    let id = read(*first, cx)?;
    // One warning says it all.
    fields.take_rest();
    fields.warn(format!("the {} is not supported yet; shown as the bsdf inside of it", fields.title()));
    Ok(Some(id))
}

fn kind(fields: &mut Fields, cx: &mut Context) -> Result<MaterialKind, Diagnostic> {
    if let Some(wrapper) = wrapper::read(fields, cx)? {
        return Ok(MaterialKind::Wrapped(wrapper));
    }
    Ok(match fields.plugin() {
        "null" => MaterialKind::Null,
        "thindielectric" => {
            let (interior_ior, exterior_ior) = iors(fields)?;
            let [reflectance, transmittance] = factors(fields, cx)?;
            MaterialKind::ThinDielectric { interior_ior, exterior_ior, reflectance, transmittance }
        }
        "diffuse" => {
            let albedo = texture::slot(fields, "reflectance", Role::Reflectance, cx)?;
            MaterialKind::Diffuse { albedo: albedo.unwrap_or(Rgb::splat(0.5).into()) }
        }
        "dielectric" => {
            let (interior_ior, exterior_ior) = iors(fields)?;
            let [reflectance, transmittance] = factors(fields, cx)?;
            MaterialKind::Dielectric { interior_ior, exterior_ior, reflectance, transmittance }
        }
        "roughdielectric" => {
            let (interior_ior, exterior_ior) = iors(fields)?;
            let [reflectance, transmittance] = factors(fields, cx)?;
            let roughness = roughness::read(fields, cx)?;
            MaterialKind::RoughDielectric {
                roughness,
                interior_ior,
                exterior_ior,
                reflectance,
                transmittance,
            }
        }
        "conductor" => {
            let (eta, k) = ior::metal_index(fields, cx)?;
            let reflectance = factor(fields, "specular_reflectance", cx)?;
            MaterialKind::Conductor { eta, k, reflectance }
        }
        "roughconductor" => {
            let (eta, k) = ior::metal_index(fields, cx)?;
            let roughness = roughness::read(fields, cx)?;
            let reflectance = factor(fields, "specular_reflectance", cx)?;
            MaterialKind::RoughConductor { roughness, eta, k, reflectance }
        }
        "plastic" => plastic::smooth(fields, cx)?,
        "roughplastic" => plastic::rough(fields, cx)?,
        "principled" => principled::solid(fields, cx)?,
        "principledthin" => principled::thin(fields, cx)?,
        plugin => return shown_diffuse(plugin, fields, cx),
    })
}

/// The nearest that there is of a material that is known and not supported.
fn shown_diffuse(plugin: &str, fields: &mut Fields, cx: &mut Context) -> Result<MaterialKind, Diagnostic> {
    let Some((_, color)) = SHOWN_DIFFUSE.iter().find(|(name, _)| *name == plugin) else {
        let names: Vec<&str> =
            BSDFS.iter().chain(SHOWN_INNER).copied().chain(SHOWN_DIFFUSE.iter().map(|(n, _)| *n)).collect();
        return Err(fields.unknown_plugin(&names));
    };
    let albedo = match *color {
        "" => None,
        name => texture::slot(fields, name, Role::Reflectance, cx)?,
    };
    let shown = if albedo.is_some() { "of its colour" } else { "grey" };
    fields.warn(format!("the {} is not supported yet; shown as diffuse {shown}", fields.title()));
    // One warning says it all.
    fields.take_rest();
    Ok(MaterialKind::Diffuse { albedo: albedo.unwrap_or(Rgb::splat(0.5).into()) })
}

fn iors(fields: &mut Fields) -> Result<(f32, f32), Diagnostic> {
    Ok((ior::index(fields, "int_ior", "bk7")?, ior::index(fields, "ext_ior", "air")?))
}

/// A factor on what physics says, one if there is none.
fn factor(fields: &mut Fields, name: &'static str, cx: &mut Context) -> Result<Texture, Diagnostic> {
    Ok(texture::slot(fields, name, Role::Reflectance, cx)?.unwrap_or(Rgb::WHITE.into()))
}

/// Those on what a transparent surface reflects and transmits.
fn factors(fields: &mut Fields, cx: &mut Context) -> Result<[Texture; 2], Diagnostic> {
    Ok([factor(fields, "specular_reflectance", cx)?, factor(fields, "specular_transmittance", cx)?])
}
