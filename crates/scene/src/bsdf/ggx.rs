//! The GGX distribution of microfacet normals with Smith's masking.
//!
//! Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007; Heitz,
//! "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014.
//!
//! Directions here point to the upper side (cos ≥ 0). With s = √(cos² + α²·sin²), Smith's Λ is
//! (s − cos)/(2·cos), and each ratio that a BSDF needs loses its division by a cosine: nothing here is
//! singular at grazing angles.

use std::f32::consts::FRAC_1_PI;

use caustica_math::Vec3;
use caustica_math::elementary::{safe_sqrt, sin_cos_turns};

/// Below this roughness single precision resolves no lobe; it looks like a smooth surface.
pub const MIN_ALPHA: f32 = 1e-4;

/// An isotropic GGX distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    alpha: f32,
}

impl Ggx {
    /// Of roughness `alpha`, raised to [`MIN_ALPHA`] if it is less.
    #[inline]
    pub fn new(alpha: f32) -> Self {
        Self { alpha: alpha.max(MIN_ALPHA) }
    }

    /// Density of microfacet area, per area of surface and solid angle of the normal `h` (sr⁻¹):
    /// D = α²/(π·(α²·cos² + sin²)²).
    #[inline]
    pub fn density(self, h: Vec3) -> f32 {
        let alpha2 = self.alpha * self.alpha;
        // x and y know a small angle better than z does.
        let t = h.x * h.x + h.y * h.y + alpha2 * h.z * h.z;
        alpha2 * FRAC_1_PI / (t * t)
    }

    /// s = √(cos² + α²·sin²) of a direction.
    #[inline]
    fn slope(self, v: Vec3) -> f32 {
        (v.z * v.z + self.alpha * self.alpha * (v.x * v.x + v.y * v.y)).sqrt()
    }

    /// G₁(v)/(2·cos v) = 1/(cos + s): the density of visible normals is this times 2·D·(v·h).
    #[inline]
    pub fn masking_over_twice_cos(self, v: Vec3) -> f32 {
        1.0 / (v.z + self.slope(v))
    }

    /// G₂(a, b)/(2·cos b), height-correlated: G₂ = 1/(1 + Λ(a) + Λ(b)).
    #[inline]
    pub fn shadowing_over_twice_cos(self, a: Vec3, b: Vec3) -> f32 {
        let sum = self.slope(a) * b.z + self.slope(b) * a.z;
        a.z / sum.max(f32::MIN_POSITIVE)
    }

    /// Samples a normal by its visible area from `v`, with density G₁(v)·D(h)·(v·h)⁺/cos v.
    ///
    /// Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023.
    #[inline]
    pub fn sample_visible(self, v: Vec3, u: [f32; 2]) -> Vec3 {
        // Seen from the hemisphere that the microfacets are stretched to, reflections of `v` fill a
        // spherical cap evenly.
        let v = Vec3::new(v.x * self.alpha, v.y * self.alpha, v.z).normalized();
        let depth = u[1] * (1.0 + v.z);
        let radius = safe_sqrt(depth * (2.0 - depth));
        let (sin, cos) = sin_cos_turns(u[0]);
        // The cap's height is 1 − depth, to which v.z is added.
        let z = (1.0 - u[1]) * (1.0 + v.z);
        Vec3::new((radius * cos + v.x) * self.alpha, (radius * sin + v.y) * self.alpha, z).normalized()
    }
}

/// The normal that mirrors `a` to `b`, and the cosine between it and each of them. `None` if they are opposite
/// to within rounding, where it could be any.
#[inline]
pub(super) fn half_vector(a: Vec3, b: Vec3) -> Option<(Vec3, f32)> {
    let sum = a + b;
    let length2 = sum.length_squared();
    if length2 < 1e-12 {
        return None;
    }
    let length = length2.sqrt();
    Some((sum * (1.0 / length), 0.5 * length))
}

/// `v` mirrored at the normal `h`.
#[inline]
pub(super) fn reflected(v: Vec3, h: Vec3) -> Vec3 {
    h * (2.0 * v.dot(h)) - v
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ D(h)·cos h dω = 1, by the midpoint rule in sin² = 1 − cos², where d(sin²)·π = cos·dω.
    #[test]
    fn projected_microfacet_area_is_one() {
        for alpha in [0.1, 0.5, 1.0] {
            let n = 100_000;
            let sum: f64 = (0..n)
                .map(|i| {
                    let sin2 = (i as f32 + 0.5) / n as f32;
                    let h = Vec3::new(sin2.sqrt(), 0.0, (1.0 - sin2).sqrt());
                    f64::from(Ggx::new(alpha).density(h)) * std::f64::consts::PI / f64::from(n)
                })
                .sum();
            assert!((sum - 1.0).abs() < 1e-3, "{sum} at {alpha}");
        }
    }

    #[test]
    fn ratios_are_those_of_smith() {
        let (a, b) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, 0.8, 0.6));
        let lambda = |v: Vec3| {
            let tan2 = (1.0 - v.z * v.z) / (v.z * v.z);
            0.5 * ((1.0 + 0.09 * tan2).sqrt() - 1.0)
        };
        let ggx = Ggx::new(0.3);
        let g1 = 1.0 / (1.0 + lambda(a));
        assert!((ggx.masking_over_twice_cos(a) - g1 / (2.0 * a.z)).abs() < 1e-6);
        let g2 = 1.0 / (1.0 + lambda(a) + lambda(b));
        assert!((ggx.shadowing_over_twice_cos(a, b) - g2 / (2.0 * b.z)).abs() < 1e-6);
    }
}
