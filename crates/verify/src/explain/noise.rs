//! The noise of patterns of paths. Pictures of independent parts of a run differ by noise alone, so that their
//! differences tell its variance: also that of light that every sample finds alike, which is none.

use std::collections::BTreeMap;

use crate::class::{LampEnd, PathClass};

/// A pattern, and where its light is from.
pub type Pattern = (LampEnd, String);

/// How many patterns there may be: each takes a picture.
pub const MOST_PATTERNS: u64 = 24;

/// What the patterns carry to each pixel of a region, in sums of luminances.
#[derive(Clone, Debug, Default)]
pub struct Layers {
    /// The layer of each class.
    of_class: BTreeMap<PathClass, usize>,
    layers: Vec<(Pattern, Vec<f32>)>,
}

impl Layers {
    /// The picture of a class's pattern, of so many pixels.
    pub fn of(&mut self, class: &PathClass, pixels: usize) -> &mut [f32] {
        let index = match self.of_class.get(class) {
            Some(index) => *index,
            None => {
                let pattern = (class.lamp(), class.pattern());
                let known = self.layers.iter().position(|(p, _)| *p == pattern);
                let index = known.unwrap_or_else(|| {
                    self.layers.push((pattern, vec![0.0; pixels]));
                    self.layers.len() - 1
                });
                self.of_class.insert(*class, index);
                index
            }
        };
        &mut self.layers[index].1
    }
}

/// Sums of squared differences between parts of a run.
#[derive(Clone, Debug, Default)]
pub struct Noise {
    /// A part that waits for the next one.
    waiting: Option<Layers>,
    squares: BTreeMap<Pattern, f64>,
    /// Of all patterns together.
    all: f64,
    pairs: u32,
}

impl Noise {
    /// Adds the next part.
    pub fn add(&mut self, part: Layers) {
        let Some(before) = self.waiting.take() else {
            self.waiting = Some(part);
            return;
        };
        let mut differences: BTreeMap<Pattern, Vec<f32>> = before.layers.into_iter().collect();
        for (pattern, pixels) in part.layers {
            let own = differences.entry(pattern).or_insert_with(|| vec![0.0; pixels.len()]);
            own.iter_mut().zip(pixels).for_each(|(a, b)| *a -= b);
        }
        let squares = |pixels: &[f32]| pixels.iter().map(|d| f64::from(*d).powi(2)).sum::<f64>();
        let mut all: Vec<f32> = Vec::new();
        for (pattern, pixels) in differences {
            *self.squares.entry(pattern).or_default() += squares(&pixels);
            all.resize(pixels.len(), 0.0);
            all.iter_mut().zip(pixels).for_each(|(sum, d)| *sum += d);
        }
        self.all += squares(&all);
        self.pairs += 1;
    }

    /// The variance of one sample a pixel of a pattern, summed over the pixels, if a part has so many passes.
    pub fn variance(&self, pattern: &Pattern, passes: u32) -> f64 {
        self.scaled(self.squares.get(pattern).copied().unwrap_or(0.0), passes)
    }

    /// The same of all patterns together.
    pub fn whole(&self, passes: u32) -> f64 {
        self.scaled(self.all, passes)
    }

    /// Two parts of n passes differ by a square of 2 n variances.
    fn scaled(&self, squares: f64, passes: u32) -> f64 {
        squares / (2.0 * f64::from(passes.max(1)) * f64::from(self.pairs.max(1)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use caustica_math::{SampleStream, StreamId};

    /// Uniform numbers have a variance of 1/12; constants have none, and what is perfectly correlated adds up.
    #[test]
    fn differences_of_parts_tell_the_variance() {
        let mut stream = SampleStream::new(StreamId { seed: 1, pixel: 0, sample: 0, walk: 0 });
        let class = |text: &str| PathClass::new(LampEnd::Surface, text.chars().map(|c| c == 'D'));
        let (pixels, passes) = (400, 4);
        let mut noise = Noise::default();
        for _ in 0..16 {
            let mut part = Layers::default();
            for _ in 0..passes {
                for i in 0..pixels {
                    let u = stream.next_1d();
                    part.of(&class("D"), pixels)[i] += u;
                    // One pattern.
                    part.of(&class("DD"), pixels)[i] += u;
                    part.of(&class("DDD"), pixels)[i] += u;
                    part.of(&class("SD"), pixels)[i] += 100.0;
                }
            }
            noise.add(part);
        }
        let of =
            |pattern: &str| noise.variance(&(LampEnd::Surface, pattern.to_owned()), passes) / pixels as f64;
        let near = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 0.1, "{found}");
        near(of("LDE"), 1.0 / 12.0);
        near(of("LDD+E"), 4.0 / 12.0);
        near(noise.whole(passes) / pixels as f64, 9.0 / 12.0);
        assert_eq!((of("LS+DE"), of("LE")), (0.0, 0.0));
    }
}
