//! `principled` and `principledthin`.

use caustica_scene::Diagnostic;
use caustica_scene::description::{MaterialKind, Principled, PrincipledThin, Scalar, Texture};

use super::context::Context;
use super::fields::Fields;
use super::spectrum::Role;
use super::{roughness, texture};
use crate::nori::range::Bounds;

/// Of a number that is a share.
const SHARE: Bounds = Bounds::Within(0.0, 1.0);

/// `principled`.
pub(super) fn solid(fields: &mut Fields, cx: &mut Context) -> Result<MaterialKind, Diagnostic> {
    // How lobes are chosen is not the scene's business.
    fields.ignore(&[
        "main_specular_sampling_rate",
        "clearcoat_sampling_rate",
        "diffuse_reflectance_sampling_rate",
    ]);
    let mut p = Principled { base_color: base_color(fields, cx)?, ..Principled::default() };
    for (name, value, bounds) in [
        ("roughness", &mut p.roughness, SHARE),
        ("anisotropic", &mut p.anisotropic, SHARE),
        ("metallic", &mut p.metallic, SHARE),
        ("spec_trans", &mut p.spec_trans, SHARE),
        ("spec_tint", &mut p.spec_tint, SHARE),
        ("sheen", &mut p.sheen, Bounds::NotNegative),
        ("sheen_tint", &mut p.sheen_tint, SHARE),
        ("flatness", &mut p.flatness, SHARE),
        ("clearcoat", &mut p.clearcoat, Bounds::NotNegative),
        ("clearcoat_gloss", &mut p.clearcoat_gloss, SHARE),
    ] {
        set(fields, (name, bounds), value, cx)?;
    }
    let eta = fields.float_if_any("eta", Bounds::Positive)?;
    let specular = fields.float_if_any("specular", SHARE)?;
    p.eta = match (eta, specular) {
        (Some(_), Some(_)) => return Err(fields.error("give either `eta` or `specular`, not both")),
        (Some(eta), None) => eta,
        (None, specular) => {
            // Reflectance at normal incidence is 0.08·specular: (η − 1)²/(η + 1)².
            2.0 / (1.0 - (0.08 * specular.unwrap_or(0.5)).sqrt()) - 1.0
        }
    };
    Ok(MaterialKind::Principled(p))
}

/// `principledthin`.
pub(super) fn thin(fields: &mut Fields, cx: &mut Context) -> Result<MaterialKind, Diagnostic> {
    fields.ignore(&[
        "specular_reflectance_sampling_rate",
        "specular_transmittance_sampling_rate",
        "diffuse_reflectance_sampling_rate",
        "diffuse_transmittance_sampling_rate",
    ]);
    let mut p = PrincipledThin { base_color: base_color(fields, cx)?, ..PrincipledThin::default() };
    for (name, value, bounds) in [
        ("roughness", &mut p.roughness, SHARE),
        ("anisotropic", &mut p.anisotropic, SHARE),
        ("spec_trans", &mut p.spec_trans, SHARE),
        ("eta", &mut p.eta, Bounds::Positive),
        ("spec_tint", &mut p.spec_tint, SHARE),
        ("sheen", &mut p.sheen, Bounds::NotNegative),
        ("sheen_tint", &mut p.sheen_tint, SHARE),
        ("flatness", &mut p.flatness, SHARE),
        ("diff_trans", &mut p.diff_trans, Bounds::Within(0.0, 2.0)),
    ] {
        set(fields, (name, bounds), value, cx)?;
    }
    Ok(MaterialKind::PrincipledThin(p))
}

fn base_color(fields: &mut Fields, cx: &mut Context) -> Result<Texture, Diagnostic> {
    let found = texture::slot(fields, "base_color", Role::Reflectance, cx)?;
    Ok(found.unwrap_or(Principled::default().base_color))
}

/// Reads a number or a texture, if it is there.
fn set(
    fields: &mut Fields,
    (name, bounds): (&'static str, Bounds),
    value: &mut Scalar,
    cx: &mut Context,
) -> Result<(), Diagnostic> {
    if let Some(found) = roughness::scalar(fields, name, bounds, cx)? {
        *value = found;
    }
    Ok(())
}
