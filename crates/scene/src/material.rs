//! Materials of the flat scene: BSDFs whose textures are still to be looked up.

use caustica_math::{Vec2, Wavelengths};

use crate::bsdf::{
    Bsdf, Conductor, Dielectric, Diffuse, Microfacet, RoughConductor, RoughDielectric, ThinDielectric,
};
use crate::description::MaterialKind;
use crate::texture::TextureTable;

/// The BSDF of a material that is no wrapper, at texture coordinates `uv`.
#[inline(always)]
pub fn bsdf_at(kind: &MaterialKind, textures: &TextureTable<'_>, uv: Vec2, w: Wavelengths) -> Bsdf {
    let metal = |eta, k, reflectance| Conductor {
        eta: w.spectrum(eta),
        k: w.spectrum(k),
        reflectance: w.spectrum(reflectance),
    };
    match *kind {
        MaterialKind::Diffuse { ref albedo } => {
            Bsdf::Diffuse(Diffuse { albedo: textures.spectrum(albedo, uv, w) })
        }
        MaterialKind::Mirror { reflectance } => Bsdf::Mirror { reflectance: w.spectrum(reflectance) },
        MaterialKind::Dielectric { interior_ior, exterior_ior } => {
            Bsdf::Dielectric(Dielectric { interior_ior, exterior_ior })
        }
        MaterialKind::RoughDielectric { alpha, interior_ior, exterior_ior } => {
            Bsdf::RoughDielectric(RoughDielectric::new(alpha, interior_ior, exterior_ior))
        }
        MaterialKind::Conductor { eta, k, reflectance } => Bsdf::Conductor(metal(eta, k, reflectance)),
        MaterialKind::RoughConductor { alpha, eta, k, reflectance } => {
            Bsdf::RoughConductor(RoughConductor::new(metal(eta, k, reflectance), alpha))
        }
        MaterialKind::Microfacet { alpha, interior_ior, exterior_ior, ref kd } => {
            Bsdf::Microfacet(Microfacet::new(textures.spectrum(kd, uv, w), alpha, interior_ior, exterior_ior))
        }
        MaterialKind::ThinDielectric { interior_ior, exterior_ior, ref reflectance, ref transmittance } => {
            let [r, t] = [reflectance, transmittance].map(|texture| textures.spectrum(texture, uv, w));
            Bsdf::ThinDielectric(ThinDielectric::new((interior_ior, exterior_ior), r, t))
        }
        MaterialKind::Null | MaterialKind::Wrapped(_) => Bsdf::Null,
    }
}
