//! From floating-point contributions to whole numbers of quanta.

use caustica_math::Rgb;
use caustica_math::stream::mix64;

/// The most quanta that one contribution may count; a few of them still fit into an `i64`.
const LIMIT: f64 = (1u64 << 61) as f64;

/// An odd constant that spreads the second half of the dither's key over all bits.
const SPREAD: u64 = 0x9e37_79b9_7f4a_7c15;

/// Counts in a unit that is a power of two.
///
/// A contribution between two whole numbers goes to either with the probability that makes the mean
/// right, so that contributions much below the quantum are not lost. The die is a hash of the
/// contribution and its pixel: the same contribution always counts the same, and so sums do not depend
/// on order. The three channels share one throw, which keeps greys grey.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quantum {
    size: f64,
    per_unit: f64,
}

impl Quantum {
    /// 2 to the power `exponent`, which must lie well within the range of `f64`.
    pub(crate) fn new(exponent: i32) -> Self {
        let power = |e: i32| f64::from_bits(((1023 + i64::from(e)) as u64) << 52);
        Self { size: power(exponent), per_unit: power(-exponent) }
    }

    /// The size of one quantum.
    pub(crate) fn size(self) -> f64 {
        self.size
    }

    /// The quanta of a finite contribution to the pixel with the index `pixel`, and whether a channel
    /// had to be clamped.
    #[inline]
    pub(crate) fn count(self, value: Rgb, pixel: u64) -> ([i64; 3], bool) {
        let [r, g, b] = value.0.map(|c| u64::from(c.to_bits()));
        let hash = mix64((r << 32 | g) ^ (b << 32 ^ pixel).wrapping_mul(SPREAD));
        // 53 bits, as many as f64 can tell apart below one.
        let die = (hash >> 11) as f64 * (1.0 / (1u64 << 53) as f64);
        let scaled = value.0.map(|c| f64::from(c) * self.per_unit);
        let clamped = scaled.iter().any(|x| x.abs() > LIMIT);
        (scaled.map(|x| round(x.clamp(-LIMIT, LIMIT), die)), clamped)
    }
}

/// `x` rounded away from zero if `die` is less than its fraction, and towards zero otherwise.
#[inline]
fn round(x: f64, die: f64) -> i64 {
    let whole = x as i64;
    let up = i64::from(die < (x - whole as f64).abs());
    whole + if x < 0.0 { -up } else { up }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Thousandths of a quantum, all different: the mean of 10⁶ of them within 5σ.
    #[test]
    fn tiny_values_keep_their_mean() {
        let quantum = Quantum::new(-10);
        let n = 1_000_000u32;
        for sign in [1.0f32, -1.0] {
            let (mut counted, mut sum) = ([0i64; 3], 0.0);
            for i in 0..n {
                let v = sign * 1e-6 * (1.0 + i as f32 / n as f32);
                let (q, _) = quantum.count(Rgb::new(v, 2.0 * v, 0.0), 7);
                counted = [0, 1, 2].map(|c| counted[c] + q[c]);
                sum += f64::from(v);
            }
            for (channel, factor) in [(0, 1.0), (1, 2.0)] {
                let expected = factor * sum * 1024.0;
                let sigma = expected.abs().sqrt();
                assert!((counted[channel] as f64 - expected).abs() < 5.0 * sigma, "{counted:?}, {expected}");
            }
            assert_eq!(counted[2], 0);
        }
    }

    /// A constant far below the quantum survives over pixels.
    #[test]
    fn a_dim_constant_survives_over_the_picture() {
        let quantum = Quantum::new(0);
        let n = 400_000;
        let total: i64 = (0..n).map(|pixel| quantum.count(Rgb::splat(0.01), pixel).0[1]).sum();
        assert!((total - 4000).abs() < 5 * 63, "{total}");
    }

    #[test]
    fn whole_numbers_and_greys_stay_what_they_are() {
        let quantum = Quantum::new(-4);
        assert_eq!(quantum.count(Rgb::new(3.0, -0.25, 0.0), 1), ([48, -4, 0], false));
        for i in 0..1000 {
            let (q, _) = quantum.count(Rgb::splat(i as f32 * 0.001), 3);
            assert!(q[0] == q[1] && q[1] == q[2]);
        }
    }

    #[test]
    fn huge_values_are_clamped() {
        let limit = 1i64 << 61;
        let quantum = Quantum::new(-20);
        assert_eq!(quantum.count(Rgb::new(1e30, -1e30, 0.5), 0), ([limit, -limit, 1 << 19], true));
        let large = (1u64 << 60) as f32;
        assert_eq!(Quantum::new(0).count(Rgb::splat(large), 0), ([1 << 60; 3], false));
    }
}
