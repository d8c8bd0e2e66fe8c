//! A rough interface between two dielectrics.

use caustica_math::{SolidAnglePdf, Spectrum, Vec3};

use super::facets::{Facets, half_vector, reflected};
use super::fresnel::{Interface, fresnel_dielectric, reflectance};
use super::specular::{Dielectric, sides};
use super::{Evaluated, Scattered, Walk};

/// Indices that differ by a smaller share than this bend light by less than a ten-thousandth, while single
/// precision loses the microfacet normals: the interface is taken as absent.
const MATCHED: f32 = 1e-4;

/// An interface of microfacets between two dielectrics. It reflects and refracts, on both sides; light that meets
/// more than one microfacet is lost.
///
/// Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, with visible normals sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughDielectric {
    // Plain lanes: the alignment of spectra would cost every BSDF 16 bytes.
    reflectance: [f32; 4],
    transmittance: [f32; 4],
    facets: Facets,
    interior_ior: f32,
    exterior_ior: f32,
}

impl RoughDielectric {
    /// Indices of refraction inside and outside.
    #[inline]
    pub fn indices(&self) -> (f32, f32) {
        (self.interior_ior, self.exterior_ior)
    }

    /// What the smooth interface becomes with such microfacets. If the indices are equal, or almost so, light goes
    /// straight through: a Dirac lobe.
    #[inline]
    pub fn new(facets: Facets, smooth: Dielectric) -> Self {
        let Dielectric { interior_ior, exterior_ior, reflectance, transmittance } = smooth;
        let matched = (interior_ior - exterior_ior).abs() <= MATCHED * exterior_ior;
        let interior_ior = if matched { exterior_ior } else { interior_ior };
        Self {
            reflectance: reflectance.0,
            transmittance: transmittance.0,
            facets,
            interior_ior,
            exterior_ior,
        }
    }

    /// Whether the two indices are the same, so that there is nothing but a Dirac lobe.
    #[inline]
    pub(super) fn is_matched(&self) -> bool {
        self.interior_ior == self.exterior_ior
    }

    /// What light does where the indices are the same.
    #[inline]
    pub(super) fn sample_matched(&self, walk: Walk, given: Vec3, u: [f32; 3]) -> Option<Scattered> {
        Dielectric {
            interior_ior: self.exterior_ior,
            exterior_ior: self.exterior_ior,
            reflectance: Spectrum(self.reflectance),
            transmittance: Spectrum(self.transmittance),
        }
        .sample(walk, given, u)
    }

    #[inline]
    pub(super) fn eval(&self, to_light: Vec3, to_camera: Vec3) -> Evaluated {
        if self.is_matched() || to_light.z == 0.0 || to_camera.z == 0.0 {
            return Evaluated::default();
        }
        let evaluated = if (to_light.z > 0.0) == (to_camera.z > 0.0) {
            self.eval_reflection(to_light, to_camera)
        } else {
            self.eval_transmission(to_light, to_camera)
        };
        evaluated.unwrap_or_default()
    }

    #[inline]
    fn eval_reflection(&self, to_light: Vec3, to_camera: Vec3) -> Option<Evaluated> {
        let (ior, ior_beyond) = sides(to_camera.z, self.interior_ior, self.exterior_ior)?;
        let (l, c) = (upper(to_light), upper(to_camera));
        let (h, cos) = half_vector(l, c)?;
        let fresnel = fresnel_dielectric(cos.min(1.0), ior, ior_beyond).reflectance;
        // F·D·G₂/(4·cos) for the value and F·D·G₁/(4·cos) for the densities.
        let common = 0.5 * fresnel * self.facets.density(h);
        Some(Evaluated {
            value: Spectrum(self.reflectance) * (common * self.facets.shadowing_over_twice_cos(l, c)),
            to_light_pdf: SolidAnglePdf(common * self.facets.masking_over_twice_cos(c)),
            to_camera_pdf: SolidAnglePdf(common * self.facets.masking_over_twice_cos(l)),
        })
    }

    #[inline]
    fn eval_transmission(&self, to_light: Vec3, to_camera: Vec3) -> Option<Evaluated> {
        let iors = (self.interior_ior, self.exterior_ior);
        let mut evaluated = transmission(&self.facets, iors, to_light, to_camera)?;
        evaluated.value *= Spectrum(self.transmittance);
        Some(evaluated)
    }

    /// `u[2]` chooses reflection with Fresnel's probability at the microfacet.
    #[inline]
    pub(super) fn sample_direction(&self, given: Vec3, u: [f32; 3]) -> Option<Vec3> {
        let (ior, ior_beyond) = sides(given.z, self.interior_ior, self.exterior_ior)?;
        let g = upper(given);
        let h = self.facets.sample_visible(g, [u[0], u[1]]);
        let cos = g.dot(h);
        if cos <= 0.0 {
            return None;
        }
        let interface = fresnel_dielectric(cos.min(1.0), ior, ior_beyond);
        deflected(given, h, (interface, ior / ior_beyond), u[2] < interface.reflectance)
    }
}

/// Refraction by microfacets between two media (indices inside and outside) from one side to the other, with the
/// densities of visible normals times Fresnel's transmittance.
#[inline]
pub(super) fn transmission(
    facets: &Facets,
    (interior, exterior): (f32, f32),
    to_light: Vec3,
    to_camera: Vec3,
) -> Option<Evaluated> {
    let (ior_light, ior_camera) = sides(to_light.z, interior, exterior)?;
    // The microfacet normal is along n_l·l + n_c·c, on the upper side.
    let sum = to_light * ior_light + to_camera * ior_camera;
    let length2 = sum.length_squared();
    let h = sum * (1.0_f32.copysign(sum.z) / length2.sqrt());
    let (cos_light, cos_camera) = (to_light.dot(h), to_camera.dot(h));
    // Each direction must be on the same side of the microfacet as it is of the surface.
    if cos_light * to_light.z <= 0.0 || cos_camera * to_camera.z <= 0.0 {
        return None;
    }
    let (cos_light, cos_camera) = (cos_light.abs(), cos_camera.abs());
    let fresnel = reflectance(ior_camera * cos_camera, ior_light * cos_light, ior_light / ior_camera);
    // What Walter's equation 21 and the densities of both directions share.
    let common = 2.0 * cos_light * cos_camera * (1.0 - fresnel) * facets.density(h) / length2;
    let (l, c) = (upper(to_light), upper(to_camera));
    let (light2, camera2) = (ior_light * ior_light, ior_camera * ior_camera);
    Some(Evaluated {
        value: Spectrum::splat(common * camera2 * facets.shadowing_over_twice_cos(l, c)),
        // dω_h/dω_l = n_l²·|l·h|/|n_l·l + n_c·c|² (equation 17), and likewise for c.
        to_light_pdf: SolidAnglePdf(common * light2 * facets.masking_over_twice_cos(c)),
        to_camera_pdf: SolidAnglePdf(common * camera2 * facets.masking_over_twice_cos(l)),
    })
}

/// Where a microfacet of normal `h` (on the upper side) mirrors or refracts the direction `given` to, at an interface
/// of relative index `eta`. `None` if that is on the wrong side: steep microfacets send some rays to where they would
/// meet another one.
#[inline]
pub(super) fn deflected(
    given: Vec3,
    h: Vec3,
    (interface, eta): (Interface, f32),
    reflects: bool,
) -> Option<Vec3> {
    let g = upper(given);
    let v = if reflects { reflected(g, h) } else { h * (eta * g.dot(h) - interface.cos_refracted) - g * eta };
    if (v.z > 0.0) != reflects || v.z == 0.0 {
        return None;
    }
    Some(Vec3::new(v.x, v.y, if given.z > 0.0 { v.z } else { -v.z }))
}

/// A direction mirrored to the upper side: microfacets are the same from both.
#[inline]
pub(super) fn upper(v: Vec3) -> Vec3 {
    Vec3::new(v.x, v.y, v.z.abs())
}
