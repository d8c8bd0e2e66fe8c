//! `<bsdf>`.

use caustica_math::Rgb;
use caustica_scene::Diagnostic;
use caustica_scene::description::{MaterialId, MaterialKind, Texture};

use super::class::Class;
use super::context::Context;
use super::fields::Fields;
use super::spectrum::Role;
use super::{ior, texture, wrapper};
use crate::nori::range::Bounds;

const BSDFS: &[&str] = &[
    "diffuse",
    "dielectric",
    "thindielectric",
    "roughdielectric",
    "conductor",
    "roughconductor",
    "null",
    "twosided",
    "mask",
    "blendbsdf",
    "bumpmap",
    "normalmap",
];

/// What has no material of its own yet, and the property whose colour it is shown in.
const SHOWN_DIFFUSE: &[(&str, &str)] = &[
    ("plastic", "diffuse_reflectance"),
    ("roughplastic", "diffuse_reflectance"),
    ("principled", "base_color"),
    ("principledthin", "base_color"),
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
            let mut factor = |name| -> Result<Texture, Diagnostic> {
                let found = texture::slot(fields, name, Role::Reflectance, cx)?;
                Ok(found.unwrap_or(Rgb::WHITE.into()))
            };
            let (reflectance, transmittance) =
                (factor("specular_reflectance")?, factor("specular_transmittance")?);
            MaterialKind::ThinDielectric { interior_ior, exterior_ior, reflectance, transmittance }
        }
        "diffuse" => {
            let albedo = texture::slot(fields, "reflectance", Role::Reflectance, cx)?;
            MaterialKind::Diffuse { albedo: albedo.unwrap_or(Rgb::splat(0.5).into()) }
        }
        "dielectric" => {
            let (interior_ior, exterior_ior) = iors(fields)?;
            factors(fields, cx)?;
            MaterialKind::Dielectric { interior_ior, exterior_ior }
        }
        "roughdielectric" => {
            let (interior_ior, exterior_ior) = iors(fields)?;
            factors(fields, cx)?;
            MaterialKind::RoughDielectric { alpha: alpha(fields, cx)?, interior_ior, exterior_ior }
        }
        "conductor" => {
            let (eta, k) = ior::metal_index(fields, cx)?;
            MaterialKind::Conductor { eta, k, reflectance: reflectance(fields, cx)? }
        }
        "roughconductor" => {
            let (eta, k) = ior::metal_index(fields, cx)?;
            let alpha = alpha(fields, cx)?;
            MaterialKind::RoughConductor { alpha, eta, k, reflectance: reflectance(fields, cx)? }
        }
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

fn reflectance(fields: &mut Fields, cx: &mut Context) -> Result<Rgb, Diagnostic> {
    let found = texture::constant(fields, "specular_reflectance", Role::Reflectance, cx)?;
    Ok(found.unwrap_or(Rgb::WHITE))
}

/// Glass here reflects and transmits what physics says.
fn factors(fields: &mut Fields, cx: &mut Context) -> Result<(), Diagnostic> {
    for name in ["specular_reflectance", "specular_transmittance"] {
        let factor = texture::constant(fields, name, Role::Reflectance, cx)?;
        if factor.is_some_and(|f| f != Rgb::WHITE) {
            fields.warn(format!("`{name}` of the {} is not supported yet; it counts as 1", fields.title()));
        }
    }
    Ok(())
}

/// The roughness of a GGX surface, which is what these surfaces are whatever the scene would like.
fn alpha(fields: &mut Fields, cx: &mut Context) -> Result<f32, Diagnostic> {
    fields.ignore(&["sample_visible"]);
    let distributions = &["beckmann", "ggx", "phong", "as"];
    match fields.choice("distribution", distributions)? {
        Some(("ggx", _)) => {}
        Some((name, property)) => {
            let message = format!("the distribution `{name}` is not supported yet; `ggx` is used instead");
            fields.warn_at(message, &property.value_origin);
        }
        None => fields.warn("the usual distribution `beckmann` is not supported yet; `ggx` is used instead"),
    }
    let (u, v) = (one_alpha(fields, "alpha_u", cx)?, one_alpha(fields, "alpha_v", cx)?);
    let both = one_alpha(fields, "alpha", cx)?;
    match (both, u, v) {
        (Some(alpha), None, None) => Ok(alpha),
        (None, None, None) => Ok(0.1),
        (None, Some(u), Some(v)) if u == v => Ok(u),
        (None, Some(u), Some(v)) => {
            fields
                .warn("roughness that depends on the direction is not supported yet; it is √(αᵤ·αᵥ) in all");
            Ok((u * v).sqrt())
        }
        _ => Err(fields.error("give `alpha`, or both `alpha_u` and `alpha_v`")),
    }
}

fn one_alpha(fields: &mut Fields, name: &'static str, cx: &mut Context) -> Result<Option<f32>, Diagnostic> {
    if fields.has_texture(name) {
        return Ok(texture::constant(fields, name, Role::Index, cx)?.map(|c| c.luminance().max(1e-4)));
    }
    fields.float_if_any(name, Bounds::Positive)
}
