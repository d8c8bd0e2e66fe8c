//! What a dielectric coat does to the light of a diffuse base under it, worked out once for each material.

use caustica_math::Vec3;

use super::facets::Facets;
use super::fresnel::fresnel_dielectric;
use super::rough_dielectric::{deflected, upper};
use crate::description::{Distribution, Shadowing};

/// A smooth coat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothCoat {
    /// Index of refraction of the coat, relative to the outside.
    pub(super) eta: f32,
    /// The share of diffuse light from below that it reflects.
    pub(super) internal: f32,
}

impl SmoothCoat {
    /// A coat of the index of refraction `eta` relative to the outside.
    pub fn new(eta: f32) -> Self {
        // By n²·|cos|·dω, which refraction keeps, 1 − inside = (1 − outside)/n². The side without total reflection is
        // integrated.
        let internal = if eta >= 1.0 {
            1.0 - (1.0 - diffuse_reflectance(1.0, eta)) / (eta * eta)
        } else {
            diffuse_reflectance(eta, 1.0)
        };
        Self { eta, internal }
    }
}

/// ∫₀¹ 2·F(μ) dμ·μ by the midpoint rule in √μ, whose error is below 10⁻⁵.
fn diffuse_reflectance(ior: f32, ior_beyond: f32) -> f32 {
    const STEPS: u32 = 512;
    let sum: f64 = (0..STEPS)
        .map(|i| {
            let t = (i as f32 + 0.5) / STEPS as f32;
            // μ = t²: 2·μ·dμ = 4·t³·dt.
            f64::from(4.0 * t * t * t * fresnel_dielectric(t * t, ior, ior_beyond).reflectance)
        })
        .sum();
    (sum / f64::from(STEPS)) as f32
}

/// How many places the transmittance of a rough coat is kept for.
pub(super) const NODES: usize = 8;

/// A rough coat: isotropic, with separable shadowing. Light that would meet a second microfacet is lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughCoat {
    pub(super) eta: f32,
    pub(super) internal: f32,
    pub(super) alpha: f32,
    pub(super) distribution: Distribution,
    /// The share of light from outside that passes, at μ = (i/(NODES − 1))².
    pub(super) transmittance: [u16; NODES],
}

impl RoughCoat {
    /// A coat of roughness `alpha` and the index of refraction `eta` relative to the outside.
    pub fn new(distribution: Distribution, alpha: f32, eta: f32) -> Self {
        let facets = Facets::new(distribution, Shadowing::Separable, [alpha; 2]);
        let passes = |mu: f32| shares(&facets, mu.max(1e-6), (1.0, eta), 32).1;
        let last = (NODES - 1) as f32;
        let mut nodes: [f32; NODES] = std::array::from_fn(|i| passes((i as f32 / last).powi(2)));
        // At grazing angles a sharp lobe changes faster than the nodes tell. The first one is moved so that the curve
        // is right in the middle of its interval.
        let middle = passes((0.5 / last).powi(2));
        let missing = middle - curve(&nodes, (0.5 / last).powi(2));
        nodes[0] = (nodes[0] + missing / FIRST_AT_MIDDLE).clamp(0.0, 1.0);
        Self {
            eta,
            internal: internal_reflectance(&facets, eta),
            alpha: facets.alpha[0],
            distribution,
            transmittance: nodes.map(|t| (t * SCALE).round() as u16),
        }
    }
}

/// What [`u16`] stands for one.
const SCALE: f32 = 65_535.0;

/// How much the first node counts in the middle of the first interval, with what lies before it extrapolated by a
/// parabola: 9/16 − 3/16.
const FIRST_AT_MIDDLE: f32 = 0.375;

/// The transmittance at an angle of cosine `mu`.
pub(super) fn transmittance(nodes: &[u16; NODES], mu: f32) -> f32 {
    curve(&nodes.map(|t| f32::from(t) * (1.0 / SCALE)), mu).clamp(0.0, 1.0)
}

/// Catmull and Rom's curve through the nodes; beyond the ends a parabola goes on.
fn curve(nodes: &[f32; NODES], mu: f32) -> f32 {
    let x = mu.clamp(0.0, 1.0).sqrt() * (NODES - 1) as f32;
    let i = (x as usize).min(NODES - 2);
    let f = x - i as f32;
    let (b, c) = (nodes[i], nodes[i + 1]);
    let a = if i == 0 { 3.0 * (b - c) + nodes[2] } else { nodes[i - 1] };
    let d = if i + 2 == NODES { 3.0 * (c - b) + a } else { nodes[i + 2] };
    b + 0.5 * f * (c - a + f * (2.0 * a - 5.0 * b + 4.0 * c - d + f * (3.0 * (b - c) + d - a)))
}

/// The shares of light from the direction of cosine `mu` that such an interface reflects and transmits at once: ∫ F·G₁ and
/// ∫ (1 − F)·G₁ over the visible normals, by the midpoint rule, with G₁ of the direction in which it leaves.
fn shares(facets: &Facets, mu: f32, (ior, ior_beyond): (f32, f32), steps: u32) -> (f32, f32) {
    let v = Vec3::new(((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt(), 0.0, mu);
    let middle = |i: u32| (i as f32 + 0.5) / steps as f32;
    let unmasked = |out: Option<Vec3>| {
        let masking = |out: Vec3| 2.0 * out.z * facets.masking_over_twice_cos(out);
        out.map_or(0.0, |out| masking(upper(out)))
    };
    let (mut reflected, mut transmitted) = (0.0, 0.0);
    for i in 0..steps * steps {
        let h = facets.sample_visible(v, [middle(i / steps), middle(i % steps)]);
        let interface = fresnel_dielectric(v.dot(h).clamp(0.0, 1.0), ior, ior_beyond);
        let out = |reflects| deflected(v, h, (interface, ior / ior_beyond), reflects);
        reflected += f64::from(interface.reflectance * unmasked(out(true)));
        transmitted += f64::from((1.0 - interface.reflectance) * unmasked(out(false)));
    }
    let count = f64::from(steps * steps);
    ((reflected / count) as f32, (transmitted / count) as f32)
}

/// What the coat reflects of diffuse light from below: the sum that Mitsuba takes for ∫ 2·R(μ)·μ dμ, the mean over 64
/// values of μ that are spread evenly from 0 to 1, both included. It is the trapezoidal rule but for a part of 1/64
/// by which it is less.
fn internal_reflectance(facets: &Facets, eta: f32) -> f32 {
    const VALUES: u32 = 64;
    let sum: f64 = (0..VALUES)
        .map(|i| {
            let mu = (i as f32 / (VALUES - 1) as f32).max(1e-6);
            f64::from(2.0 * mu * shares(facets, mu, (eta, 1.0), 16).0)
        })
        .sum();
    (sum / f64::from(VALUES)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Figures of Duntley's closed form.
    #[test]
    fn diffuse_light_from_below_is_mostly_reflected() {
        for (eta, internal) in [(1.3, 0.444_457), (1.5, 0.596_345), (1.9, 0.763_844), (1.0 / 1.5, 0.091_778)]
        {
            let coat = SmoothCoat::new(eta);
            assert!((coat.internal - internal).abs() < 2e-5, "{eta}: {}", coat.internal);
        }
    }

    /// The few nodes know the transmittance to 0.3 % in the mean.
    #[test]
    fn curves_follow_the_transmittance() {
        for distribution in [Distribution::Ggx, Distribution::Beckmann] {
            for alpha in [1e-3, 0.02, 0.1, 0.5] {
                let coat = RoughCoat::new(distribution, alpha, 1.5);
                let facets = Facets::new(distribution, Shadowing::Separable, [alpha; 2]);
                let mut mean = 0.0;
                for i in 0..60 {
                    let mu = 0.05 + 0.95 * i as f32 / 59.0;
                    let exact = shares(&facets, mu, (1.0, 1.5), 64).1;
                    let error = (transmittance(&coat.transmittance, mu) / exact - 1.0).abs();
                    assert!(error < 0.025, "{distribution:?} {alpha}: {error} at {mu}");
                    mean += error / 60.0;
                }
                assert!(mean < 0.003, "{distribution:?} {alpha}: {mean} in the mean");
            }
        }
    }

    /// Rough coats become smooth.
    #[test]
    fn sharp_coats_are_smooth() {
        let (rough, smooth) = (RoughCoat::new(Distribution::Ggx, 1e-4, 1.5), SmoothCoat::new(1.5));
        // But for the part of 1/64.
        assert!((rough.internal - smooth.internal * 63.0 / 64.0).abs() < 2e-3, "{}", rough.internal);
    }
}
