//! Paths whose joining edge is still to be tested, and roulette among them.
//!
//! A shadow ray costs as much as all the rest of a connection. So all that a sample's eye path can be joined with is
//! evaluated and weighed first, and then those contributions that are small beside the sum go on by roulette:
//! whatever is left out makes up less than the sample's other noise.

use caustica_math::Spectrum;
use caustica_scene::bvh::Ray;

use super::{Joined, Sample};
use crate::kernel::Kernel;
use crate::numbers::EyeNumbers;
use crate::sink::Sink;

/// A contribution that counts if nothing stands in the way of a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    /// Before its weight.
    value: Spectrum,
    weight: f32,
    ray: Ray,
}

/// The candidates of a sample.
#[derive(Debug, Default)]
pub(crate) struct Candidates {
    list: Vec<Candidate>,
    /// The paths, for sinks that probe.
    joined: Vec<Joined>,
    /// How many were no numbers, and are not in the list.
    failed: u32,
}

/// Contributions that are smaller than this share of the sample's sum survive with a probability in proportion.
const NEGLIGIBLE: f32 = 0.05;

impl Candidates {
    pub(super) fn clear(&mut self) {
        self.list.clear();
        self.joined.clear();
        self.failed = 0;
    }
}

impl Kernel<'_> {
    /// Adds a path that counts if the ray is free.
    #[inline]
    pub(super) fn offer<S: Sink>(
        &self,
        sample: &Sample<'_>,
        (joined, ray): (Joined, Ray),
        running: impl Fn() -> f32,
        candidates: &mut Candidates,
    ) {
        let Some(weight) = self.weigh(sample, &joined, running) else { return };
        if !(joined.value * weight).is_valid() {
            candidates.failed += 1;
            return;
        }
        candidates.list.push(Candidate { value: joined.value, weight, ray });
        if S::PROBES {
            candidates.joined.push(joined);
        }
    }

    /// The sum of the candidates that roulette and shadow rays leave. `certain` is what the sample has found already.
    pub(super) fn settle<S: Sink>(
        &self,
        sample: &Sample<'_>,
        certain: Spectrum,
        (candidates, numbers): (&Candidates, &mut EyeNumbers),
        sink: &mut S,
    ) -> Spectrum {
        let mut sum = Spectrum::ZERO;
        let total = candidates.list.iter().fold(certain, |all, c| all + c.value * c.weight);
        (0..candidates.failed).for_each(|_| sink.invalid());
        let least = NEGLIGIBLE * total.max_lane();
        // Of a sum beyond all numbers every part is wanted: none is small beside it.
        let least = if S::KEEPS_ALL || !least.is_finite() { 0.0 } else { least };
        // One number decides for all: of the sums of probabilities, those pass that step over an integer.
        let mut position = None;
        for (i, c) in candidates.list.iter().enumerate() {
            let contribution = (c.value * c.weight).max_lane();
            let mut survival = 1.0;
            if contribution < least {
                survival = contribution / least;
                let position = position.get_or_insert_with(|| numbers.candidates());
                *position += survival;
                if *position < 1.0 {
                    continue;
                }
                *position -= 1.0;
            }
            if self.scene.occluded(&c.ray) {
                continue;
            }
            let value = c.value * (1.0 / survival);
            if S::PROBES {
                self.report(sample, &Joined { value, ..candidates.joined[i] }, c.weight, sink);
            }
            sum += value * c.weight;
        }
        sum
    }
}
