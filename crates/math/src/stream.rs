//! Counter-based sample streams.
//!
//! A stream is a pure function of (seed, pixel, sample, walk, dimension): no generator state survives
//! a sample, so any sample can be made again, alone, in any order and on any machine.

pub use crate::strata::GROUP;
use crate::strata::Strata;

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

/// How the samples of a pixel are chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Sampler {
    /// Each by itself.
    Independent,
    /// Owen-scrambled Sobol' points, well spread over the samples of a pixel and over neighbouring pixels.
    #[default]
    Sobol,
}

/// What names a sample of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SampleId {
    /// The render's seed.
    pub seed: u64,
    /// The pixel in the full film.
    pub pixel: [u32; 2],
    /// The sample's index within the pixel.
    pub sample: u32,
}

/// Uniform numbers in [0, 1) of one walk of one sample.
///
/// A stream has *slots*, each of one or two dimensions; a number is drawn from the next one.
#[derive(Clone, Debug)]
pub struct SampleStream {
    source: Source,
    slot: u64,
}

#[derive(Clone, Debug)]
enum Source {
    Hash { key: u64 },
    Strata(Strata),
}

pub(crate) const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// The finaliser of SplitMix64 (Steele, Lea and Flood, "Fast Splittable Pseudorandom Number
/// Generators", OOPSLA 2014, with Stafford's variant 13 of the constants).
#[inline]
pub fn mix64(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl SampleStream {
    /// The stream of that name, of independent numbers, at its first slot.
    #[inline]
    pub fn new(id: StreamId) -> Self {
        let a = mix64(id.seed.wrapping_add(GOLDEN));
        let b = mix64(a ^ (u64::from(id.pixel) << 32 | u64::from(id.sample)));
        let key = mix64(b.wrapping_add(u64::from(id.walk).wrapping_mul(GOLDEN)));
        Self { source: Source::Hash { key }, slot: 0 }
    }

    /// The stream of a walk of a picture's sample, at its first slot.
    #[inline]
    pub fn of_sample(sampler: Sampler, id: SampleId, walk: u32) -> Self {
        match sampler {
            Sampler::Independent => {
                let a = mix64(id.seed.wrapping_add(GOLDEN));
                let b = mix64(a ^ (u64::from(id.pixel[1]) << 32 | u64::from(id.pixel[0])));
                let c = mix64(b ^ (u64::from(walk) << 32 | u64::from(id.sample)));
                Self { source: Source::Hash { key: c }, slot: 0 }
            }
            Sampler::Sobol => Self { source: Source::Strata(Strata::new(id, walk)), slot: 0 },
        }
    }

    /// Goes to a slot.
    #[inline]
    pub fn seek(&mut self, slot: u64) -> &mut Self {
        self.slot = slot;
        self
    }

    /// The next slot's only dimension.
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        self.next_2d()[0]
    }

    /// The next slot's two dimensions.
    #[inline]
    pub fn next_2d(&mut self) -> [f32; 2] {
        let slot = self.slot;
        self.slot = slot.wrapping_add(1);
        match &mut self.source {
            Source::Hash { key } => {
                let bits = mix64(key.wrapping_add(slot.wrapping_add(1).wrapping_mul(GOLDEN)));
                [to_unit((bits >> 40) as u32), to_unit((bits as u32) >> 8)]
            }
            Source::Strata(strata) => strata.point(slot).map(|bits| to_unit(bits >> 8)),
        }
    }
}

/// 24 random bits to [0, 1): exactly, the largest to [`ONE_BELOW`](crate::ONE_BELOW).
#[inline]
fn to_unit(bits: u32) -> f32 {
    bits as i32 as f32 * (1.0 / 16_777_216.0)
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
