//! `<bsdf>`.

use caustica_math::Rgb;
use caustica_scene::Diagnostic;
use caustica_scene::bsdf::metals::{METAL_NAMES, metal};
use caustica_scene::description::{Material, MaterialId, MaterialKind, Roughness};

use super::context::Context;
use super::fields::Fields;
use super::range::{Bounds, Radiometry};
use super::texture;
use super::tree::Object;
use crate::suggest;

const BSDFS: &[&str] =
    &["diffuse", "mirror", "dielectric", "roughdielectric", "conductor", "roughconductor", "microfacet"];
const UNSUPPORTED: &[&str] = &["disney", "thindielectric"];

/// The glass and the air that Nori takes where a scene names none.
const GLASS: f32 = 1.5046;
const AIR: f32 = 1.000_277;

/// Reads a material and adds it to the description.
pub(super) fn read(object: &Object, cx: &mut Context) -> Result<MaterialId, Diagnostic> {
    let mut fields = Fields::new(object, cx.place);
    let kind = kind(&mut fields, object, cx)?;
    fields.finish(cx)?;
    let id = MaterialId(cx.description.materials.len() as u32);
    let origin = cx.origin(&object.range);
    cx.description.materials.push(Material { kind, origin });
    Ok(id)
}

fn kind(fields: &mut Fields, object: &Object, cx: &mut Context) -> Result<MaterialKind, Diagnostic> {
    Ok(match object.plugin.as_str() {
        "diffuse" => {
            let names = &["albedo", "reflectance"];
            let albedo = texture::slot(fields, names, Radiometry::Reflectance, cx)?;
            MaterialKind::Diffuse { albedo: albedo.unwrap_or(Rgb::splat(0.5).into()) }
        }
        "mirror" => MaterialKind::Mirror { reflectance: reflectance(fields)? },
        "dielectric" => {
            let (interior_ior, exterior_ior) = iors(fields)?;
            MaterialKind::dielectric(interior_ior, exterior_ior)
        }
        "roughdielectric" => {
            let (interior_ior, exterior_ior) = iors(fields)?;
            MaterialKind::rough_dielectric(Roughness::ggx(ggx_alpha(fields)?), interior_ior, exterior_ior)
        }
        "conductor" => {
            let (eta, k) = metal_index(fields)?;
            MaterialKind::Conductor { eta, k, reflectance: reflectance(fields)?.into() }
        }
        "roughconductor" => {
            let (eta, k) = metal_index(fields)?;
            let roughness = Roughness::ggx(ggx_alpha(fields)?);
            MaterialKind::RoughConductor { roughness, eta, k, reflectance: reflectance(fields)?.into() }
        }
        "microfacet" => {
            let (interior_ior, exterior_ior) = iors(fields)?;
            let alpha = alpha(fields)?;
            let kd = texture::slot(fields, &["kd"], Radiometry::Share, cx)?;
            let kd = kd.unwrap_or(Rgb::splat(0.5).into());
            MaterialKind::Microfacet { alpha, interior_ior, exterior_ior, kd }
        }
        known if UNSUPPORTED.contains(&known) => return Err(fields.unsupported()),
        _ => return Err(fields.unknown_plugin(BSDFS)),
    })
}

fn reflectance(fields: &mut Fields) -> Result<Rgb, Diagnostic> {
    let names = &["reflectance", "specularReflectance"];
    Ok(fields.color(names, Radiometry::Reflectance)?.unwrap_or(Rgb::WHITE))
}

fn iors(fields: &mut Fields) -> Result<(f32, f32), Diagnostic> {
    let interior = fields.float(&["intIOR"], GLASS, Bounds::Positive)?;
    Ok((interior, fields.float(&["extIOR"], AIR, Bounds::Positive)?))
}

fn alpha(fields: &mut Fields) -> Result<f32, Diagnostic> {
    fields.float(&["alpha"], 0.1, Bounds::Positive)
}

/// The roughness of a GGX surface, which is what these surfaces are whatever the scene would like.
fn ggx_alpha(fields: &mut Fields) -> Result<f32, Diagnostic> {
    if let Some((name, property)) = fields.string(&["distribution"])?
        && !name.eq_ignore_ascii_case("ggx")
    {
        let name = suggest::shorten(name);
        fields
            .warn_in(property, format!("the distribution `{name}` is not supported; `ggx` is used instead"));
    }
    alpha(fields)
}

/// The complex index of a metal relative to the outside: by name (copper if there is none), or as colours.
fn metal_index(fields: &mut Fields) -> Result<(Rgb, Rgb), Diagnostic> {
    let outside = fields.float(&["extIOR", "extEta"], 1.0, Bounds::Positive)?;
    let name = fields.string(&["material"])?;
    let eta = fields.color(&["eta"], Radiometry::Light)?;
    let k = fields.color(&["k"], Radiometry::Light)?;
    let (eta, k) = match (name, eta, k) {
        (None, Some(eta), Some(k)) => (eta, k),
        (Some((name, property)), None, None) => metal(name).ok_or_else(|| {
            let message = format!("unknown metal `{}`", suggest::shorten(name));
            fields.error_in(property, message).hint(suggest::hint(name, METAL_NAMES))
        })?,
        (None, None, None) => metal("Cu").ok_or_else(|| fields.missing("material", "the string"))?,
        _ => return Err(fields.error("a metal is given by `material`, or by both `eta` and `k`")),
    };
    Ok((eta * (1.0 / outside), k * (1.0 / outside)))
}
