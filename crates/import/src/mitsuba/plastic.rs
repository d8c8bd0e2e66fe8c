//! Plastics.

use caustica_math::Rgb;
use caustica_scene::Diagnostic;
use caustica_scene::description::{MaterialKind, Texture};

use super::context::Context;
use super::fields::Fields;
use super::spectrum::Role;
use super::{ior, roughness, texture};
use crate::nori::range::Bounds;

/// `plastic`.
pub(super) fn smooth(fields: &mut Fields, cx: &mut Context) -> Result<MaterialKind, Diagnostic> {
    let (interior_ior, exterior_ior) = iors(fields)?;
    let (diffuse, reflectance) = colours(fields, cx)?;
    let nonlinear = fields.boolean("nonlinear", false)?;
    Ok(MaterialKind::Plastic { interior_ior, exterior_ior, diffuse, reflectance, nonlinear })
}

/// `roughplastic`, whose roughness is one number.
pub(super) fn rough(fields: &mut Fields, cx: &mut Context) -> Result<MaterialKind, Diagnostic> {
    let (interior_ior, exterior_ior) = iors(fields)?;
    let (diffuse, reflectance) = colours(fields, cx)?;
    Ok(MaterialKind::RoughPlastic {
        distribution: roughness::distribution(fields)?,
        alpha: fields.float("alpha", 0.1, Bounds::Positive)?,
        interior_ior,
        exterior_ior,
        diffuse,
        reflectance,
        nonlinear: fields.boolean("nonlinear", false)?,
    })
}

fn iors(fields: &mut Fields) -> Result<(f32, f32), Diagnostic> {
    Ok((ior::index(fields, "int_ior", "polypropylene")?, ior::index(fields, "ext_ior", "air")?))
}

/// Of the base and of the coat.
fn colours(fields: &mut Fields, cx: &mut Context) -> Result<(Texture, Texture), Diagnostic> {
    let mut color = |name, default| -> Result<Texture, Diagnostic> {
        Ok(texture::slot(fields, name, Role::Reflectance, cx)?.unwrap_or(Rgb::splat(default).into()))
    };
    Ok((color("diffuse_reflectance", 0.5)?, color("specular_reflectance", 1.0)?))
}
