//! How rough a bsdf is.

use caustica_scene::Diagnostic;
use caustica_scene::description::{Distribution, Roughness, Scalar, Shadowing, Texture};

use super::context::Context;
use super::fields::Fields;
use super::spectrum::Role;
use super::texture;
use crate::nori::range::Bounds;

/// The roughness of a bsdf whose microfacets may be different along the surface and across.
pub(super) fn read(fields: &mut Fields, cx: &mut Context) -> Result<Roughness, Diagnostic> {
    let distribution = distribution(fields)?;
    let mut alpha = |name| scalar(fields, name, Bounds::Positive, cx);
    let (both, u, v) = (alpha("alpha")?, alpha("alpha_u")?, alpha("alpha_v")?);
    let alpha = match (both, u, v) {
        (Some(alpha), None, None) => [alpha; 2],
        (None, None, None) => [Scalar::Constant(0.1); 2],
        (None, Some(u), Some(v)) => [u, v],
        _ => return Err(fields.error("give `alpha`, or both `alpha_u` and `alpha_v`")),
    };
    Ok(Roughness { distribution, shadowing: Shadowing::Separable, alpha })
}

/// The distribution of normals. (How they are sampled is not the scene's business.)
pub(super) fn distribution(fields: &mut Fields) -> Result<Distribution, Diagnostic> {
    fields.ignore(&["sample_visible"]);
    Ok(match fields.choice("distribution", &["beckmann", "ggx", "phong", "as"])? {
        None | Some(("beckmann", _)) => Distribution::Beckmann,
        Some(("ggx", _)) => Distribution::Ggx,
        Some((name, property)) => {
            let message = format!("the distribution `{name}` is not supported; `beckmann` is used instead");
            fields.warn_at(message, &property.value_origin);
            Distribution::Beckmann
        }
    })
}

/// A number or a texture.
pub(super) fn scalar(
    fields: &mut Fields,
    name: &'static str,
    bounds: Bounds,
    cx: &mut Context,
) -> Result<Option<Scalar>, Diagnostic> {
    if !fields.has_texture(name) {
        return Ok(fields.float_if_any(name, bounds)?.map(Scalar::Constant));
    }
    let found = texture::slot(fields, name, Role::Index, cx)?;
    Ok(found.map(|texture| match texture {
        Texture::Constant(color) => Scalar::Constant(color.luminance()),
        other => Scalar::Texture(other),
    }))
}
