//! The plastic of the Nori renderer: a diffuse base under a Beckmann specular lobe.

use std::f32::consts::FRAC_1_PI;

use caustica_math::elementary::{exp, ln, safe_sqrt, sin_cos_turns};
use caustica_math::{SolidAnglePdf, Spectrum, Vec3, warp};

use super::Evaluated;
use super::facets::{MIN_ALPHA, half_vector, reflected};
use super::fresnel::fresnel_dielectric;

/// Nori's `microfacet`: f = kd/π + ks·F·D·G₁(l)·G₁(c)/(4·cos l·cos c) with Beckmann's D; black on the side away
/// from the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Microfacet {
    kd: Spectrum,
    ks: f32,
    alpha: f32,
    interior_ior: f32,
    exterior_ior: f32,
}

impl Microfacet {
    /// A surface of diffuse reflectance `kd` and Beckmann roughness `alpha` (raised to
    /// [`super::facets::MIN_ALPHA`] if it is less). The specular lobe weighs ks = 1 − max(kd).
    #[inline]
    pub fn new(kd: Spectrum, alpha: f32, interior_ior: f32, exterior_ior: f32) -> Self {
        let ks = (1.0 - kd.max_lane()).max(0.0);
        Self { kd, ks, alpha: alpha.max(MIN_ALPHA), interior_ior, exterior_ior }
    }

    #[inline]
    pub(super) fn eval(&self, to_light: Vec3, to_camera: Vec3) -> Evaluated {
        if to_light.z <= 0.0 || to_camera.z <= 0.0 {
            return Evaluated::default();
        }
        let mut value = self.kd * (to_light.z * FRAC_1_PI);
        let mut specular_pdf = 0.0;
        if let Some((h, cos)) = half_vector(to_light, to_camera) {
            let density = self.beckmann(h);
            let fresnel = fresnel_dielectric(cos.min(1.0), self.exterior_ior, self.interior_ior).reflectance;
            let shadowing = self.masking(to_light) * self.masking(to_camera);
            let specular = self.ks * fresnel * density * shadowing / (4.0 * to_camera.z);
            value += Spectrum::splat(specular);
            // dω_h = dω/(4·cos), the same whichever direction is given.
            specular_pdf = self.ks * density * h.z / (4.0 * cos);
        }
        let pdf = |v: Vec3| SolidAnglePdf(specular_pdf + (1.0 - self.ks) * v.z * FRAC_1_PI);
        Evaluated { value, to_light_pdf: pdf(to_light), to_camera_pdf: pdf(to_camera) }
    }

    /// `u[2]` chooses the specular lobe with probability ks.
    #[inline]
    pub(super) fn sample_direction(&self, given: Vec3, u: [f32; 3]) -> Option<Vec3> {
        if given.z <= 0.0 {
            return None;
        }
        if u[2] >= self.ks {
            return Some(warp::cosine_hemisphere([u[0], u[1]]));
        }
        // Beckmann: P(tan² > t) = exp(−t/α²).
        let tan2 = -self.alpha * self.alpha * ln(1.0 - u[1]);
        let cos2 = 1.0 / (1.0 + tan2);
        let sin = safe_sqrt(tan2 * cos2);
        let (sin_phi, cos_phi) = sin_cos_turns(u[0]);
        Some(reflected(given, Vec3::new(sin * cos_phi, sin * sin_phi, cos2.sqrt())))
    }

    /// Beckmann's density of microfacet area (sr⁻¹): exp(−tan²/α²)/(π·α²·cos⁴); times cos it is the density
    /// of the sampled normals.
    #[inline]
    fn beckmann(&self, h: Vec3) -> f32 {
        let alpha2 = self.alpha * self.alpha;
        let cos2 = h.z * h.z;
        let decay = exp(-(h.x * h.x + h.y * h.y) / (alpha2 * cos2));
        // Where it underflows, cos⁴ may do so too.
        if decay > 0.0 { decay * FRAC_1_PI / (alpha2 * cos2 * cos2) } else { 0.0 }
    }

    /// Smith's G₁ for Beckmann by Walter's rational fit.
    #[inline]
    fn masking(&self, v: Vec3) -> f32 {
        let b = v.z / (self.alpha * (v.x * v.x + v.y * v.y).sqrt());
        if b < 1.6 { b * (3.535 + 2.181 * b) / (1.0 + b * (2.276 + 2.577 * b)) } else { 1.0 }
    }
}
