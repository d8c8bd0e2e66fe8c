//! Counter-based sample streams.
//!
//! A stream is a pure function of (seed, pixel, sample, walk, dimension): no generator state survives
//! a sample, so any sample can be made again, alone, in any order and on any machine.

use crate::ONE_BELOW;

/// What names a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct StreamId {
    /// The render's seed.
    pub seed: u64,
    /// The pixel's index in the full film, row by row.
    pub pixel: u32,
    /// The sample's index within the pixel.
    pub sample: u32,
    /// Which walk of the sample: each has dimensions of its own.
    pub walk: u32,
}

/// Uniform numbers in [0, 1) of one walk of one sample.
#[derive(Clone, Debug)]
pub struct SampleStream {
    key: u64,
    dimension: u64,
}

const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// The finaliser of SplitMix64 (Steele, Lea and Flood, "Fast Splittable Pseudorandom Number
/// Generators", OOPSLA 2014, with Stafford's variant 13 of the constants).
#[inline]
pub fn mix64(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl SampleStream {
    /// The stream of that name, at its first dimension.
    #[inline]
    pub fn new(id: StreamId) -> Self {
        let a = mix64(id.seed.wrapping_add(GOLDEN));
        let b = mix64(a ^ (u64::from(id.pixel) << 32 | u64::from(id.sample)));
        Self { key: mix64(b.wrapping_add(u64::from(id.walk).wrapping_mul(GOLDEN))), dimension: 0 }
    }

    #[inline]
    fn next_u64(&mut self) -> u64 {
        self.dimension += 1;
        mix64(self.key.wrapping_add(self.dimension.wrapping_mul(GOLDEN)))
    }

    /// The next dimension.
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        to_unit((self.next_u64() >> 40) as u32)
    }

    /// The next two dimensions.
    #[inline]
    pub fn next_2d(&mut self) -> [f32; 2] {
        let bits = self.next_u64();
        [to_unit((bits >> 40) as u32), to_unit((bits as u32) >> 8)]
    }
}

/// 24 random bits to [0, 1).
#[inline]
fn to_unit(bits: u32) -> f32 {
    (bits as f32 * (1.0 / 16_777_216.0)).min(ONE_BELOW)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn id(pixel: u32, sample: u32, walk: u32) -> StreamId {
        StreamId { seed: 1, pixel, sample, walk }
    }

    #[test]
    fn a_stream_repeats_and_its_neighbours_differ() {
        let draw = |i| {
            let mut s = SampleStream::new(i);
            (s.next_1d(), s.next_2d(), s.next_1d())
        };
        assert_eq!(draw(id(3, 4, 0)), draw(id(3, 4, 0)));
        for other in [id(4, 4, 0), id(3, 5, 0), id(3, 4, 1), id(4, 3, 0)] {
            assert_ne!(draw(id(3, 4, 0)), draw(other));
        }
    }

    /// Means of 1e5 numbers over pixels, samples, walks and dimensions: 5σ = .0046.
    #[test]
    fn every_axis_is_uniform() {
        let n = 100_000;
        let mean = |f: &dyn Fn(u32) -> f32| (0..n).map(|i| f64::from(f(i))).sum::<f64>() / f64::from(n);
        let first = |i| SampleStream::new(i).next_1d();
        let mut long = SampleStream::new(id(0, 0, 0));
        let dims: Vec<f32> = (0..n).map(|_| long.next_1d()).collect();
        for m in [
            mean(&|i| first(id(i, 0, 0))),
            mean(&|i| first(id(0, i, 0))),
            mean(&|i| first(id(0, 0, i))),
            mean(&|i| dims[i as usize]),
            mean(&|i| SampleStream::new(id(i, 1, 0)).next_2d()[1]),
        ] {
            assert!((m - 0.5).abs() < 0.0046, "{m}");
        }
    }
}
