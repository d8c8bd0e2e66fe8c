//! The Beckmann distribution of microfacet normals: slopes are normally distributed.

use std::f32::consts::FRAC_1_PI;

use caustica_math::Vec3;
use caustica_math::elementary::{acos, erf, exp, inverse_erf, pow};

/// 1/√π.
const FRAC_1_SQRT_PI: f32 = 0.564_189_6;

/// D = exp(−(x²/αx² + y²/αy²)/z²)/(π·αx·αy·z⁴).
pub(super) fn density([ax, ay]: [f32; 2], h: Vec3) -> f32 {
    let (x, y, cos2) = (h.x / ax, h.y / ay, h.z * h.z);
    let decay = exp(-(x * x + y * y) / cos2);
    // Far out, products would lose their digits; and where it underflows, cos⁴ may do so too. None is sampled there.
    if decay > 1e-20 { decay * FRAC_1_PI / (ax * ay * cos2 * cos2) } else { 0.0 }
}

/// cos·(1 + 2Λ) with Λ = ½·(erf a − 1 + exp(−a²)/(a·√π)) and a = cos/(α·sin); `sin` is α·sin.
pub(super) fn slope(sin: f32, cos: f32) -> f32 {
    let a = cos / sin;
    cos * erf(a) + sin * FRAC_1_SQRT_PI * exp(-a * a)
}

/// A visible normal. Seen from `v` with the microfacets stretched to roughness one, the slope x along the view has the
/// distribution function (cos·(1 + erf x) + sin·exp(−x²)/√π)/(cos + slope), up to x = cot θ, and the slope across is
/// normally distributed.
///
/// Heitz and d'Eon, "Importance Sampling Microfacet-Based BSDFs using the Distribution of Visible Normals", EGSR 2014;
/// inverted by Newton's method in erf x, from the start that Jakob fitted: "An Improved Visible Normal Sampling Routine
/// for the Beckmann Distribution", 2014.
pub(super) fn sample_visible([ax, ay]: [f32; 2], v: Vec3, u: [f32; 2]) -> Vec3 {
    let v = Vec3::new(v.x * ax, v.y * ay, v.z).normalized();
    let sin = (v.x * v.x + v.y * v.y).sqrt();
    let (cos_phi, sin_phi) = if sin > 0.0 { (v.x / sin, v.y / sin) } else { (1.0, 0.0) };
    let (along, across) = (slope_along(v.z, sin, u[0]), inverse_erf(2.0 * u[1] - 1.0));
    let x = cos_phi * along - sin_phi * across;
    let y = sin_phi * along + cos_phi * across;
    Vec3::new(-x * ax, -y * ay, 1.0).normalized()
}

/// The slope along the view below which a share `u` of the visible microfacets lies.
fn slope_along(cos: f32, sin: f32, u: f32) -> f32 {
    let end = erf(cos / sin);
    let all = cos + slope(sin, cos);
    let target = u * all;
    // Bounds of erf x.
    let (mut low, mut high) = (-1.0, end);
    let theta = acos(cos);
    let power = 1.0 + theta * (-0.876 + theta * (0.4265 - 0.0594 * theta));
    let mut b = end - (1.0 + end) * pow(1.0 - u, power);
    let mut x = 0.0;
    for _ in 0..STEPS {
        if !(b > low && b < high) {
            b = 0.5 * (low + high);
        }
        x = inverse_erf(b);
        let excess = cos * (1.0 + b) + sin * FRAC_1_SQRT_PI * exp(-x * x) - target;
        if excess.abs() <= 1e-7 * all {
            break;
        }
        if excess > 0.0 {
            high = b;
        } else {
            low = b;
        }
        b -= excess / (cos - x * sin);
    }
    x
}

/// Newton's method and halving end before; what is not quite there by then is there to within single precision.
const STEPS: u32 = 24;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_have_their_distribution() {
        for cos in [1.0_f32, 0.9, 0.5, 0.1, 1e-3] {
            let sin = (1.0 - cos * cos).sqrt();
            let all = cos + slope(sin, cos);
            for i in 0..=100 {
                let u = i as f32 / 100.0;
                let x = slope_along(cos, sin, u);
                let below = cos * (1.0 + libm::erff(x)) + sin * FRAC_1_SQRT_PI * exp(-x * x);
                assert!((below / all - u).abs() < 3e-6, "cos {cos}, u {u}: x = {x}, {}", below / all);
            }
        }
    }
}
