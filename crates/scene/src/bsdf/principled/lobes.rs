//! What both principled surfaces are made of.

use std::f32::consts::FRAC_1_PI;

use caustica_math::elementary::{exp, ln, safe_sqrt, sin_cos_turns};
use caustica_math::{Spectrum, Vec3, Wavelengths};

use crate::bsdf::facets::Facets;
use crate::description::{Distribution, Shadowing};

/// Schlick's weight (1 − cos)⁵.
#[inline]
pub(super) fn schlick_weight(cos: f32) -> f32 {
    let m = (1.0 - cos).clamp(0.0, 1.0);
    (m * m) * (m * m) * m
}

/// Schlick's approximation of Fresnel's reflectance from the outside, by the reflectance at normal incidence.
/// Where the inside is thinner, the angle is that of the refracted ray.
#[inline]
pub(super) fn schlick(normal: Spectrum, cos: f32, eta: f32) -> Spectrum {
    let cos = if eta > 1.0 { cos } else { safe_sqrt(1.0 - (1.0 - cos) * (1.0 + cos) / (eta * eta)) };
    let weight = schlick_weight(cos);
    normal * (1.0 - weight) + Spectrum::splat(weight)
}

/// Fresnel's reflectance at normal incidence.
#[inline]
pub(super) fn normal_reflectance(eta: f32) -> f32 {
    let r = (eta - 1.0) / (eta + 1.0);
    r * r
}

/// A colour without its brightness: divided by its luminance.
#[inline]
pub(super) fn tint(color: Spectrum) -> Spectrum {
    let luminance = Wavelengths::Rgb.luminance(color);
    if luminance > 0.0 { color * (1.0 / luminance) } else { Spectrum::ONE }
}

/// From `a` to `b`.
#[inline]
pub(super) fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// The microfacets of a roughness and an anisotropy in [0, 1].
#[inline]
pub(super) fn facets(roughness: f32, anisotropic: f32) -> Facets {
    let aspect = (1.0 - 0.9 * anisotropic).sqrt();
    let alpha = roughness * roughness;
    Facets::new(
        Distribution::Ggx,
        Shadowing::Separable,
        [alpha / aspect, alpha * aspect].map(|a| a.max(0.001)),
    )
}

/// The parts of the base that both surfaces have.
#[derive(Clone, Copy)]
pub(super) struct Base {
    pub color: Spectrum,
    /// Of all but the sheen.
    pub weight: f32,
    pub roughness: f32,
    pub sheen: f32,
    pub sheen_tint: f32,
    pub flatness: f32,
}

impl Base {
    /// Diffuse light, retro-reflection, flattening and sheen (sr⁻¹), given the cosines to the normal and to the half
    /// vector.
    pub fn eval(&self, cos_light: f32, cos_camera: f32, cos_half: f32) -> Spectrum {
        let (l, c) = (schlick_weight(cos_light), schlick_weight(cos_camera));
        let diffuse = (1.0 - 0.5 * l) * (1.0 - 0.5 * c);
        let rr = 2.0 * self.roughness * cos_half * cos_half;
        let retro = rr * (l + c + l * c * (rr - 1.0));
        // Hanrahan and Krueger's subsurface scattering, approximately.
        let grazing = 0.5 * rr;
        let flat = mix(1.0, grazing, l) * mix(1.0, grazing, c);
        let flat = 1.25 * (flat * (1.0 / (cos_light + cos_camera).max(1e-30) - 0.5) + 0.5);
        let share = mix(diffuse + retro, flat, self.flatness) * (self.weight * FRAC_1_PI);
        let mut value = self.color * share;
        if self.sheen > 0.0 {
            let white = Spectrum::splat(1.0 - self.sheen_tint);
            let color = white + tint(self.color) * self.sheen_tint;
            value += color * (self.sheen * schlick_weight(cos_half));
        }
        value
    }
}

/// The clear coat: an isotropic distribution of normals with longer tails than GGX, of index 1.5.
#[derive(Clone, Copy)]
pub(super) struct ClearCoat {
    alpha2: f32,
}

impl ClearCoat {
    /// From 0.1 where the coat is dull to 0.001 where it is glossy.
    #[inline]
    pub fn new(gloss: f32) -> Self {
        let alpha = mix(0.1, 0.001, gloss);
        Self { alpha2: alpha * alpha }
    }

    /// Density of microfacet area (sr⁻¹): D = (α² − 1)/(π·ln α²·(1 + (α² − 1)·cos²)).
    #[inline]
    pub fn density(self, h: Vec3) -> f32 {
        // x and y know a small angle better than z does.
        let t = h.x * h.x + h.y * h.y + self.alpha2 * h.z * h.z;
        (self.alpha2 - 1.0) * FRAC_1_PI / (ln(self.alpha2) * t)
    }

    /// A normal with density D·cos.
    #[inline]
    pub fn sample(self, u: [f32; 2]) -> Vec3 {
        let sin2 = self.alpha2 * (exp(-u[1] * ln(self.alpha2)) - 1.0) / (1.0 - self.alpha2);
        let (sin, cos) = (safe_sqrt(sin2), safe_sqrt(1.0 - sin2));
        let (sin_phi, cos_phi) = sin_cos_turns(u[0]);
        Vec3::new(sin * cos_phi, sin * sin_phi, cos)
    }

    /// F·D·G without the cosines below it that a microfacet surface has, as Burley's coat.
    #[inline]
    pub fn eval(self, h: Vec3, cos_half: f32, cosines: [f32; 2]) -> f32 {
        let fresnel = mix(0.04, 1.0, schlick_weight(cos_half));
        let masking = |cos: f32| {
            // GGX of α = 0.25.
            let s = (cos * cos + 0.0625 * (1.0 - cos * cos)).sqrt();
            2.0 * cos / (cos + s)
        };
        fresnel * self.density(h) * masking(cosines[0]) * masking(cosines[1])
    }
}
