//! Metals, smooth and rough.

use caustica_math::{SolidAnglePdf, Spectrum, Vec3};

use super::facets::{Facets, half_vector, reflected};
use super::fresnel::fresnel_conductor;
use super::specular::sample_mirror;
use super::{Evaluated, Scattered};

/// A smooth metal: mirrors on the side of the normal, black on the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conductor {
    /// Real part of the index of refraction, relative to the outside.
    pub eta: Spectrum,
    /// Imaginary part of the index (extinction), relative to the outside.
    pub k: Spectrum,
    /// Factor on Fresnel's reflectance.
    pub reflectance: Spectrum,
}

impl Conductor {
    #[inline]
    pub(super) fn sample(&self, given: Vec3) -> Option<Scattered> {
        sample_mirror(self.reflectance * fresnel_conductor(given.z.max(0.0), self.eta, self.k), given)
    }
}

/// A metal of microfacets; black on the side away from the normal. Light that meets more than one microfacet is
/// lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughConductor {
    // Plain lanes: the alignment of spectra would cost every BSDF 16 bytes.
    eta: [f32; 4],
    k: [f32; 4],
    reflectance: [f32; 4],
    facets: Facets,
}

impl RoughConductor {
    /// A metal with such microfacets.
    #[inline]
    pub fn new(metal: Conductor, facets: Facets) -> Self {
        let Conductor { eta, k, reflectance } = metal;
        Self { eta: eta.0, k: k.0, reflectance: reflectance.0, facets }
    }

    #[inline]
    pub(super) fn eval(&self, to_light: Vec3, to_camera: Vec3) -> Evaluated {
        if to_light.z <= 0.0 || to_camera.z <= 0.0 {
            return Evaluated::default();
        }
        let Some((h, cos)) = half_vector(to_light, to_camera) else { return Evaluated::default() };
        let half_density = 0.5 * self.facets.density(h);
        let fresnel = fresnel_conductor(cos.min(1.0), Spectrum(self.eta), Spectrum(self.k));
        let shadowing = self.facets.shadowing_over_twice_cos(to_light, to_camera);
        // D·G₂/(4·cos) for the value and D·G₁/(4·cos) for the densities.
        Evaluated {
            value: Spectrum(self.reflectance) * fresnel * (half_density * shadowing),
            to_light_pdf: SolidAnglePdf(half_density * self.facets.masking_over_twice_cos(to_camera)),
            to_camera_pdf: SolidAnglePdf(half_density * self.facets.masking_over_twice_cos(to_light)),
        }
    }

    #[inline]
    pub(super) fn sample_direction(&self, given: Vec3, u: [f32; 3]) -> Option<Vec3> {
        if given.z <= 0.0 {
            return None;
        }
        let h = self.facets.sample_visible(given, [u[0], u[1]]);
        Some(reflected(given, h))
    }
}
