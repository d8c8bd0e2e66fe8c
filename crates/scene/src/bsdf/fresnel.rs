//! How much light an interface reflects: Fresnel's equations for unpolarised light.

use caustica_math::Spectrum;
use caustica_math::elementary::safe_sqrt;

/// What a smooth interface between two dielectrics does with a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interface {
    /// The share of the power that is reflected, in [0, 1]; one in total internal reflection.
    pub reflectance: f32,
    /// |cos| of the refracted direction to the normal; zero in total internal reflection.
    pub cos_refracted: f32,
}

/// Reflection and refraction of a ray that makes an angle of cosine `cos` ≥ 0 with the normal, in a medium
/// of index `ior`, at the interface to one of index `ior_beyond`.
#[inline]
pub fn fresnel_dielectric(cos: f32, ior: f32, ior_beyond: f32) -> Interface {
    if ior == ior_beyond {
        return Interface { reflectance: 0.0, cos_refracted: cos };
    }
    let eta = ior / ior_beyond;
    // Snell's law; (1 − c)(1 + c) keeps the small sines that 1 − c² would lose.
    let cos2_refracted = 1.0 - eta * eta * ((1.0 - cos) * (1.0 + cos)).max(0.0);
    if cos2_refracted <= 0.0 {
        return Interface { reflectance: 1.0, cos_refracted: 0.0 };
    }
    let cos_refracted = cos2_refracted.sqrt();
    Interface {
        reflectance: reflectance(cos * ior, cos_refracted * ior_beyond, ior_beyond / ior),
        cos_refracted,
    }
}

/// The reflectance when both cosines are known. `near` and `far` are n·|cos θ| on the two sides, and `ratio`
/// is n on the far side over n on the near one. Exchanging the sides changes the result by rounding only.
#[inline]
pub(super) fn reflectance(near: f32, far: f32, ratio: f32) -> f32 {
    // r⊥ = (n₁c₁ − n₂c₂)/(n₁c₁ + n₂c₂) and r∥ = (n₂c₁ − n₁c₂)/(n₂c₁ + n₁c₂), the latter multiplied by n₁/n₂
    // above and below.
    let beyond = far / (ratio * ratio);
    let perpendicular = (near - far) / (near + far);
    let parallel = (near - beyond) / (near + beyond);
    (0.5 * (perpendicular * perpendicular + parallel * parallel)).min(1.0)
}

/// The reflectance of a conductor of complex index `eta` + i·`k` relative to the medium outside, lane by
/// lane, at an angle of cosine `cos` ≥ 0. `eta` = 0 with `k` > 0 is a perfect mirror.
///
/// The exact equations, in the arrangement of Lagarde, "Memo on Fresnel Equations", 2013.
#[inline]
pub fn fresnel_conductor(cos: f32, eta: Spectrum, k: Spectrum) -> Spectrum {
    let cos2 = cos * cos;
    let sin2 = ((1.0 - cos) * (1.0 + cos)).max(0.0);
    let lane = |i: usize| {
        let (eta2, k2) = (eta[i] * eta[i], k[i] * k[i]);
        let difference = eta2 - k2 - sin2;
        // a is the real part of the root of (eta + ik)² − sin², and the modulus is that of the square.
        let modulus = (difference * difference + 4.0 * eta2 * k2).sqrt();
        let a = safe_sqrt(0.5 * (modulus + difference));
        let (sum, cross) = (modulus + cos2, 2.0 * a * cos);
        // Empty lanes have eta = k = 0, for which numerator and denominator may both vanish.
        let perpendicular = (sum - cross) / (sum + cross).max(f32::MIN_POSITIVE);
        let (sum, cross) = (cos2 * modulus + sin2 * sin2, cross * sin2);
        let ratio = (sum - cross) / (sum + cross).max(f32::MIN_POSITIVE);
        (0.5 * perpendicular * (1.0 + ratio)).clamp(0.0, 1.0)
    };
    Spectrum([lane(0), lane(1), lane(2), lane(3)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_reflectances_of_glass() {
        let f = |cos| fresnel_dielectric(cos, 1.0, 1.5).reflectance;
        assert!((f(1.0) - 0.04).abs() < 1e-7);
        assert_eq!(f(0.0), 1.0);
        // At Brewster's angle, tan θ = 1.5, only the perpendicular part is left: ½((1 − n²)/(1 + n²))².
        let brewster = 1.0 / (1.0_f32 + 2.25).sqrt();
        assert!((f(brewster) - 0.5 * (1.25_f32 / 3.25).powi(2)).abs() < 1e-6);
        // Beyond the critical angle, sin θ > 1/1.5.
        assert_eq!(fresnel_dielectric(0.74, 1.5, 1.0), Interface { reflectance: 1.0, cos_refracted: 0.0 });
        assert!(fresnel_dielectric(0.75, 1.5, 1.0).reflectance < 1.0);
    }

    #[test]
    fn both_sides_reflect_alike() {
        // Not at grazing angles, where the way back is near the critical angle and ill-conditioned.
        for i in 10..=100 {
            let cos = i as f32 / 100.0;
            let there = fresnel_dielectric(cos, 1.0, 1.7);
            let back = fresnel_dielectric(there.cos_refracted, 1.7, 1.0);
            assert!((there.reflectance - back.reflectance).abs() < 1e-5, "at {cos}");
            assert!((back.cos_refracted - cos).abs() < 1e-5, "at {cos}");
        }
    }

    #[test]
    fn a_conductor_without_extinction_is_a_dielectric() {
        for i in 0..=100 {
            let cos = i as f32 / 100.0;
            let c = fresnel_conductor(cos, Spectrum::splat(1.5), Spectrum::ZERO);
            assert!((c[0] - fresnel_dielectric(cos, 1.0, 1.5).reflectance).abs() < 1e-5, "at {cos}");
        }
    }

    #[test]
    fn normal_reflectance_of_a_metal() {
        let (eta, k) = (0.2_f32, 3.9_f32);
        let exact = ((eta - 1.0).powi(2) + k * k) / ((eta + 1.0).powi(2) + k * k);
        let f = fresnel_conductor(1.0, Spectrum::splat(eta), Spectrum::splat(k));
        assert!((f[0] - exact).abs() < 1e-6);
        let mirror = |cos| fresnel_conductor(cos, Spectrum::ZERO, Spectrum::ONE)[1];
        assert!((0..=10).all(|i| (mirror(i as f32 / 10.0) - 1.0).abs() < 1e-6));
    }

    #[test]
    fn empty_lanes_are_finite() {
        for cos in [0.0, 1e-30, 0.3, 1.0] {
            for eta in [0.0, 1.0] {
                assert!(fresnel_conductor(cos, Spectrum::splat(eta), Spectrum::ZERO).is_valid());
            }
        }
    }
}
