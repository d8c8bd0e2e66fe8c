//! Microfacets: a distribution of normals with Smith's masking.
//!
//! Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007; Heitz, "Understanding the
//! Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2), 2014.
//!
//! Directions here point to the upper side (cos ≥ 0). Smith's Λ enters as the slope S = cos·(1 + 2Λ), so that each
//! ratio that a BSDF needs loses its division by a cosine: nothing here is singular at grazing angles.

use caustica_math::Vec3;

use super::{beckmann, ggx};
use crate::description::{Distribution, Shadowing};

/// Below this roughness single precision resolves no lobe; it looks like a smooth surface.
pub const MIN_ALPHA: f32 = 1e-4;
/// Above this one, powers of it leave the range of single precision.
const MAX_ALPHA: f32 = 1e6;

/// The microfacets of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facets {
    /// Along x and y.
    pub(super) alpha: [f32; 2],
    distribution: Distribution,
    shadowing: Shadowing,
}

impl Facets {
    /// Of roughness `alpha` along x and y, raised to [`MIN_ALPHA`] where it is less.
    #[inline]
    pub fn new(distribution: Distribution, shadowing: Shadowing, alpha: [f32; 2]) -> Self {
        Self { alpha: alpha.map(|a| a.clamp(MIN_ALPHA, MAX_ALPHA)), distribution, shadowing }
    }

    /// Isotropic GGX with correlated shadowing.
    #[inline]
    pub fn ggx(alpha: f32) -> Self {
        Self::new(Distribution::Ggx, Shadowing::Correlated, [alpha; 2])
    }

    /// Density D of microfacet area, per area of surface and solid angle of the normal `h` (sr⁻¹).
    #[inline]
    pub fn density(self, h: Vec3) -> f32 {
        match self.distribution {
            Distribution::Ggx => ggx::density(self.alpha, h),
            Distribution::Beckmann => beckmann::density(self.alpha, h),
        }
    }

    /// S = cos·(1 + 2Λ) of a direction: at least its cosine, and not zero at grazing angles.
    #[inline]
    fn slope(self, v: Vec3) -> f32 {
        let [x, y] = [v.x * self.alpha[0], v.y * self.alpha[1]];
        match self.distribution {
            Distribution::Ggx => (v.z * v.z + (x * x + y * y)).sqrt(),
            Distribution::Beckmann => beckmann::slope((x * x + y * y).sqrt(), v.z),
        }
    }

    /// G₁(v)/(2·cos v) = 1/(cos + S): the density of visible normals is this times 2·D·(v·h).
    #[inline]
    pub fn masking_over_twice_cos(self, v: Vec3) -> f32 {
        1.0 / (v.z + self.slope(v))
    }

    /// G₂(a, b)/(2·cos b): G₂ is 1/(1 + Λ(a) + Λ(b)) or G₁(a)·G₁(b).
    #[inline]
    pub fn shadowing_over_twice_cos(self, a: Vec3, b: Vec3) -> f32 {
        let (sa, sb) = (self.slope(a), self.slope(b));
        match self.shadowing {
            Shadowing::Correlated => a.z / (sa * b.z + sb * a.z).max(f32::MIN_POSITIVE),
            Shadowing::Separable => 2.0 * a.z / ((a.z + sa) * (b.z + sb)),
        }
    }

    /// Samples a normal by its visible area from `v`, with density G₁(v)·D(h)·(v·h)⁺/cos v.
    #[inline]
    pub fn sample_visible(self, v: Vec3, u: [f32; 2]) -> Vec3 {
        match self.distribution {
            Distribution::Ggx => ggx::sample_visible(self.alpha, v, u),
            Distribution::Beckmann => beckmann::sample_visible(self.alpha, v, u),
        }
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
    use Distribution::{Beckmann, Ggx};

    fn facets(distribution: Distribution, alpha: [f32; 2]) -> Facets {
        Facets::new(distribution, Shadowing::Separable, alpha)
    }

    /// ∫ D(h)·cos h dω = 1, by the midpoint rule in sin² = 1 − cos² and the azimuth, where ½·d(sin²)·dφ = cos·dω.
    #[test]
    fn projected_microfacet_area_is_one() {
        for alpha in [[0.1, 0.1], [0.5, 0.5], [1.0, 1.0], [0.2, 0.6]] {
            for distribution in [Ggx, Beckmann] {
                let (rows, columns) = (4000, 64);
                let mut sum = 0.0;
                for i in 0..rows * columns {
                    // Squared, to look closely at small angles.
                    let t = ((i / columns) as f64 + 0.5) / f64::from(rows);
                    let (sin, cos) =
                        libm::sincos(f64::from(i % columns) / f64::from(columns) * std::f64::consts::TAU);
                    let h = Vec3::new((t * cos) as f32, (t * sin) as f32, (1.0 - t * t).sqrt() as f32);
                    let cell = std::f64::consts::TAU / f64::from(rows * columns);
                    sum += f64::from(facets(distribution, alpha).density(h)) * t * cell;
                }
                assert!((sum - 1.0).abs() < 1e-3, "{distribution:?}: {sum} at {alpha:?}");
            }
        }
    }

    /// G₁·∫ D(h)·(v·h)⁺ dω = cos v: what is masked is what the visible microfacets hide.
    #[test]
    fn visible_microfacets_fill_the_view() {
        for distribution in [Ggx, Beckmann] {
            for v in [Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, 0.96, 0.28), Vec3::new(-0.7, -0.7, 0.141_421)]
            {
                let f = facets(distribution, [0.3, 0.5]);
                let (rows, columns) = (2000, 128);
                let mut sum = 0.0;
                for i in 0..rows * columns {
                    let t = ((i / columns) as f64 + 0.5) / f64::from(rows);
                    let (sin, cos) =
                        libm::sincos(f64::from(i % columns) / f64::from(columns) * std::f64::consts::TAU);
                    let z = (1.0 - t * t).sqrt();
                    let h = Vec3::new((t * cos) as f32, (t * sin) as f32, z as f32);
                    let cell = std::f64::consts::TAU / f64::from(rows * columns) * t / z;
                    sum += f64::from(f.density(h) * v.dot(h).max(0.0)) * cell;
                }
                let cos = 2.0 * sum * f64::from(f.masking_over_twice_cos(v) * v.z);
                assert!((cos - f64::from(v.z)).abs() < 2e-3, "{distribution:?} from {v:?}: {cos}");
            }
        }
    }

    #[test]
    fn ratios_are_those_of_smith() {
        let (a, b) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, 0.8, 0.6));
        let tan2 = |v: Vec3| (1.0 - v.z * v.z) / (v.z * v.z);
        let ggx = |v: Vec3| 0.5 * ((1.0 + 0.09 * tan2(v)).sqrt() - 1.0);
        let beckmann = |v: Vec3| {
            let a = 1.0 / (0.3 * tan2(v).sqrt());
            0.5 * (libm::erff(a) - 1.0 + libm::expf(-a * a) / (a * std::f32::consts::PI.sqrt()))
        };
        for (distribution, lambda) in [(Ggx, &ggx as &dyn Fn(Vec3) -> f32), (Beckmann, &beckmann)] {
            let f = facets(distribution, [0.3; 2]);
            let g1 = |v| 1.0 / (1.0 + lambda(v));
            assert!((f.masking_over_twice_cos(a) - g1(a) / (2.0 * a.z)).abs() < 1e-6);
            assert!((f.shadowing_over_twice_cos(a, b) - g1(a) * g1(b) / (2.0 * b.z)).abs() < 1e-6);
            let g2 = 1.0 / (1.0 + lambda(a) + lambda(b));
            let correlated = Facets::new(distribution, Shadowing::Correlated, [0.3; 2]);
            assert!((correlated.shadowing_over_twice_cos(a, b) - g2 / (2.0 * b.z)).abs() < 1e-6);
        }
    }
}
