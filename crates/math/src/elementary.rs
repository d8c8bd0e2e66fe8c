//! Elementary functions that give the same bits on every machine.
//!
//! The standard library hands `sin`, `exp` and their kin to the platform, whose results differ from
//! one system to the next by the last bit; over a light path that is a different picture. These come
//! from the `libm` crate (pure Rust) or are polynomials written here. Nothing here depends on a fused
//! multiply-add.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// The sine of `x` radians.
#[inline]
pub fn sin(x: f32) -> f32 {
    libm::sinf(x)
}

/// The cosine of `x` radians.
#[inline]
pub fn cos(x: f32) -> f32 {
    libm::cosf(x)
}

/// The sine and the cosine of `x` radians.
#[inline]
pub fn sin_cos(x: f32) -> (f32, f32) {
    libm::sincosf(x)
}

/// The tangent of `x` radians.
#[inline]
pub fn tan(x: f32) -> f32 {
    libm::tanf(x)
}

/// The arc sine of `x`, in radians; `x` outside of [−1, 1] is clamped.
#[inline]
pub fn asin(x: f32) -> f32 {
    libm::asinf(x.clamp(-1.0, 1.0))
}

/// The arc cosine of `x`, in radians; `x` outside of [−1, 1] is clamped.
#[inline]
pub fn acos(x: f32) -> f32 {
    libm::acosf(x.clamp(-1.0, 1.0))
}

/// The angle of the point (x, y), in radians in [−π, π].
#[inline]
pub fn atan2(y: f32, x: f32) -> f32 {
    libm::atan2f(y, x)
}

/// e to the power `x`.
#[inline]
pub fn exp(x: f32) -> f32 {
    libm::expf(x)
}

/// The natural logarithm of `x`.
#[inline]
pub fn ln(x: f32) -> f32 {
    libm::logf(x)
}

/// `x` to the power `y`.
#[inline]
pub fn pow(x: f32, y: f32) -> f32 {
    libm::powf(x, y)
}

/// The error function of `x`: 2/√π·∫₀ˣ exp(−t²) dt.
#[inline]
pub fn erf(x: f32) -> f32 {
    libm::erff(x)
}

/// The number whose error function is `y`; `y` outside of what [`erf`] of finite numbers gives is taken to its ends.
///
/// Giles, "Approximating the erfinv function", GPU Computing Gems 2, 2011: relative error below 10⁻⁶.
pub fn inverse_erf(y: f32) -> f32 {
    const NEAR: [f32; 9] = [
        2.810_226_4e-8,
        3.432_739_4e-7,
        -3.523_387_7e-6,
        -4.391_506_5e-6,
        0.000_218_580_87,
        -0.001_253_725,
        -0.004_177_681_6,
        0.246_640_73,
        1.501_409_4,
    ];
    const FAR: [f32; 9] = [
        -0.000_200_214_26,
        0.000_100_950_56,
        0.001_349_343_2,
        -0.003_673_428_4,
        0.005_739_507_7,
        -0.007_622_461_3,
        0.009_438_870_5,
        1.001_674,
        2.832_976_8,
    ];
    let y = y.clamp(-crate::ONE_BELOW, crate::ONE_BELOW);
    let w = -ln((1.0 - y) * (1.0 + y));
    let (x, terms) = if w < 5.0 { (w - 2.5, &NEAR) } else { (w.sqrt() - 3.0, &FAR) };
    y * terms.iter().fold(0.0, |sum, term| sum * x + term)
}

/// The sine and cosine of `turns`·2π, for `turns` in [0, 1].
///
/// An octant reduction and Taylor polynomials on [−π/4, π/4]: absolute error below 2e-7. About five
/// times as fast as reducing a radian argument, which is why warps use it.
#[inline]
pub fn sin_cos_turns(turns: f32) -> (f32, f32) {
    // By truncation: `floor` is a function call on CPUs that have no instruction for it.
    let quarter = (turns * 4.0 + 0.5) as i32;
    let x = (turns * 4.0 - quarter as f32) * FRAC_PI_2;
    let x2 = x * x;
    let sin =
        x * (1.0 + x2 * (-1.0 / 6.0 + x2 * (1.0 / 120.0 + x2 * (-1.0 / 5040.0 + x2 * (1.0 / 362_880.0)))));
    let cos = 1.0 + x2 * (-0.5 + x2 * (1.0 / 24.0 + x2 * (-1.0 / 720.0 + x2 * (1.0 / 40320.0))));
    // No branch here: nobody can predict the quarter.
    let quarter = quarter as u32;
    let swap = (sin.to_bits() ^ cos.to_bits()) & (quarter & 1).wrapping_neg();
    let sign = |negative: u32| (negative & 2) << 30;
    let signed = |x: f32, negative: u32| f32::from_bits(x.to_bits() ^ swap ^ sign(negative));
    (signed(sin, quarter), signed(cos, quarter + 1))
}

/// The angle of the point (x, y) of the upper half-plane (y ≥ 0), in radians in [0, π]; zero at the origin.
///
/// One division and a minimax polynomial on [0, tan π/8]: relative error below 3e-7, also of the tiniest angles.
#[inline]
pub fn upper_angle(y: f32, x: f32) -> f32 {
    const TAN_PI_8: f32 = 0.414_213_57;
    let right = x.abs();
    // Turned by nothing, an eighth or a quarter of a turn, so that the angle that is left is small.
    let low = mask(y <= right * TAN_PI_8);
    let high = mask(y * TAN_PI_8 > right);
    let opposite = select(low, y, select(high, -right, y - right));
    let adjacent = select(low, right, select(high, y, y + right));
    let turn = select(low, 0.0, select(high, FRAC_PI_2, FRAC_PI_4));
    let t = opposite / adjacent.max(f32::MIN_POSITIVE);
    let t2 = t * t;
    let series = -0.333_329_5 + t2 * (0.199_776_98 + t2 * (-0.138_775_38 + t2 * 0.080_532_34));
    let angle = turn + (t + t * t2 * series);
    select(mask(x < 0.0), PI - angle, angle)
}

/// All bits or none.
#[inline]
fn mask(condition: bool) -> u32 {
    u32::from(condition).wrapping_neg()
}

/// One of two numbers without a branch, where no branch could be predicted.
#[inline]
fn select(mask: u32, yes: f32, no: f32) -> f32 {
    f32::from_bits(no.to_bits() ^ ((yes.to_bits() ^ no.to_bits()) & mask))
}

/// The square root, with negative arguments (from rounding) taken as zero.
#[inline]
pub fn safe_sqrt(x: f32) -> f32 {
    x.max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error_function_and_back() {
        for i in -999..=999 {
            let y = i as f32 / 1000.0;
            let x = f64::from(inverse_erf(y));
            assert!((libm::erf(x) - f64::from(y)).abs() <= 1e-6 * f64::from(y.abs()) + 1e-9, "{y}: {x}");
        }
        assert_eq!(inverse_erf(0.0), 0.0);
        // The ends: 1 − 2⁻²⁴ is the error function of 3.8325.
        assert!((inverse_erf(1.0) - 3.8325).abs() < 1e-2 && inverse_erf(-2.0) == -inverse_erf(1.0));
    }

    #[test]
    fn turns_agree_with_radians() {
        for i in 0..=10_000 {
            let turns = i as f32 / 10_000.0;
            let angle = f64::from(turns) * std::f64::consts::TAU;
            let (s, c) = sin_cos_turns(turns);
            assert!((f64::from(s) - libm::sin(angle)).abs() < 2e-7, "sin at {turns}");
            assert!((f64::from(c) - libm::cos(angle)).abs() < 2e-7, "cos at {turns}");
        }
    }

    #[test]
    fn angles_of_the_upper_half_plane() {
        for i in 0..=40_000 {
            let angle = f64::from(i) / 40_000.0 * std::f64::consts::PI;
            for radius in [1e-12, 0.3, 7.0, 1e12] {
                let (x, y) = ((radius * libm::cos(angle)) as f32, (radius * libm::sin(angle)) as f32);
                let exact = libm::atan2(f64::from(y), f64::from(x));
                let error = (f64::from(upper_angle(y, x)) - exact).abs();
                assert!(error <= 3e-7 * exact, "{y} {x}: {error:e} of {exact}");
            }
        }
        for (y, x, expected) in [(0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, PI), (1.0, 0.0, FRAC_PI_2)] {
            assert_eq!(upper_angle(y, x), expected);
        }
        let tiny = f64::from(upper_angle(1e-20, 1.0));
        assert!((tiny * 1e20 - 1.0).abs() < 3e-7);
    }
}
