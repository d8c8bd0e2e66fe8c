//! The statistical test of a block.
//!
//! Two estimates of a block's light are compared by Welch's t-test over independent replicates. That test trusts the
//! replicates' variance, which is far too small where an estimator finds something bright but rare: if it was not found
//! in any replicate, nothing tells of it. Here the reference knows better: for each path that it finds, the weights of
//! multiple importance sampling tell how often each estimator would have found it, and how bright it would have
//! been. From that follow the variance and the skewness that the estimator must be expected to have. Where the skewness
//! is large, the expected variance counts if it is the larger one, and where few contributions decide, nothing is
//! tested at all. The largest contributions may be left out of account, if all of them together are a small part of the
//! light: then a difference as large as that part proves nothing. (If one of them turns up, the replicates tell.)
//!
//! Contributions are expected as if each came by chance. What eye paths find may be far steadier, each sample having one:
//! an environment that fills the picture has no variance at all. A few splats beside it have, though they are few among
//! all contributions. So those of eye paths and of light paths are looked at apart, and if one kind is skewed and the
//! other is not, the skewed kind's spread alone is expected.
//!
//! What skewness is left is allowed for by the transformation of Hall ("On the Removal of Skewness by Transformation",
//! Journal of the Royal Statistical Society B 54, 1992), in whichever direction makes differences less significant.

use caustica_math::stats::t_p_value;

use crate::tally::Moments;

/// One side of a test: the mean over replicates with what is known of its spread.
#[derive(Clone, Copy, Debug, Default)]
pub struct Side {
    /// The mean.
    pub mean: f64,
    /// The variance of the mean.
    pub variance: f64,
    /// The third central moment of the mean, without its sign.
    third: f64,
    /// The larger of the variances that were seen and expected.
    largest: f64,
    /// How much light is left out of account.
    dropped: f64,
    /// Replicates.
    count: usize,
}

/// What is expected of the mean of independent contributions.
#[derive(Clone, Copy, Debug, Default)]
pub struct Expected {
    /// The variance.
    pub variance: f64,
    /// The third central moment.
    pub third: f64,
    /// How much light is left out of account.
    pub dropped: f64,
}

/// Up to this skewness of the mean, replicates tell its variance well.
const TAME: f64 = 0.1;

/// Beyond this skewness of the mean, too few contributions decide: those of eight equal ones have it.
const TOO_SKEWED: f64 = 0.35;

/// The largest part of a block's light that may be left out of account.
const DROPPED: f64 = 0.02;

impl Expected {
    /// Of contributions by eye paths and by light paths, each by size from small to large, found in so many passes of
    /// another run (`found`), for the mean of `passes` passes.
    pub fn new([eye, light]: [&[Moments]; 2], found: f64, passes: f64) -> Self {
        let mean: f64 = eye.iter().chain(light).map(|m| m[0]).sum::<f64>() / found;
        let droppable = DROPPED * mean.abs();
        let light = Self::of_kind(light, (found, passes), droppable);
        let eye = Self::of_kind(eye, (found, passes), droppable - light.dropped);
        eye.beside(light)
    }

    /// Of contributions of one kind, of which so much may be left out of account.
    fn of_kind(mut sizes: &[Moments], (found, passes): (f64, f64), droppable: f64) -> Self {
        let mut dropped = 0.0;
        loop {
            let sum = |power: usize| sizes.iter().map(|m| m[power]).sum::<f64>();
            let (variance, third) = (sum(1) / (found * passes), sum(2) / (found * passes * passes));
            let now = Self { variance, third, dropped };
            let Some((largest, smaller)) = sizes.split_last() else { return now };
            let with_largest = dropped + largest[0].abs() / found;
            if now.is_tame() || with_largest > droppable {
                return now;
            }
            (sizes, dropped) = (smaller, with_largest);
        }
    }

    /// Whether replicates tell the variance well.
    fn is_tame(&self) -> bool {
        self.third <= TAME * spread(self.variance)
    }

    /// Of two kinds together: the variance that one of them is expected to have must not hide that the other is skewed.
    fn beside(self, other: Self) -> Self {
        let dropped = self.dropped + other.dropped;
        match (self.is_tame(), other.is_tame()) {
            (true, false) => Self { dropped, ..other },
            (false, true) => Self { dropped, ..self },
            _ => {
                let (variance, third) = (self.variance + other.variance, self.third + other.third);
                Self { variance, third, dropped }
            }
        }
    }
}

impl Side {
    /// Of the values of replicates, and of what is expected.
    pub fn new(values: &[f64], expected: Expected) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let central = |power: i32| values.iter().map(|v| (v - mean).powi(power)).sum::<f64>();
        let seen = central(2) / ((n - 1.0).max(1.0) * n);
        let third = (central(3) / (n * n * n)).abs().max(expected.third);
        let largest = seen.max(expected.variance);
        let variance = if expected.is_tame() { seen } else { largest };
        Self { mean, variance, third, largest, dropped: expected.dropped, count: values.len() }
    }

    /// Whether so few contributions decide that nothing can be tested.
    pub fn is_too_skewed(&self) -> bool {
        self.third > TOO_SKEWED * spread(self.largest)
    }
}

/// The cube of a standard deviation, of a variance: what third moments are compared with.
fn spread(variance: f64) -> f64 {
    variance * variance.sqrt()
}

/// The outcome of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// The difference over its standard deviation, allowed for skewness; positive if the estimator is too bright.
    pub t: f64,
    /// The probability of such a difference if the two means are equal.
    pub p: f64,
}

/// Rounding of 32-bit sums, relative.
const ROUNDING: f64 = 1e-5;

/// Tests whether an estimate equals its reference; `None` if nothing can be told, or both are black.
pub fn compare(estimate: &Side, reference: &Side) -> Option<Trial> {
    let black = |s: &Side| s.mean == 0.0 && s.variance == 0.0;
    if black(estimate) && black(reference) || estimate.is_too_skewed() || reference.is_too_skewed() {
        return None;
    }
    let floor = (ROUNDING * reference.mean).powi(2);
    let (a, b) = (estimate.variance + floor, reference.variance);
    let variance = a + b;
    let difference = estimate.mean - reference.mean;
    let unexplained = (difference.abs() - estimate.dropped - reference.dropped).max(0.0);
    let raw = if unexplained > 0.0 { unexplained / variance.sqrt() } else { 0.0 };
    let largest = estimate.largest + reference.largest + floor;
    let skewness = if largest > 0.0 { (estimate.third + reference.third) / spread(largest) } else { 0.0 };
    let t = tempered(raw, skewness);
    let degrees = |v: f64, n: usize| v * v / n.saturating_sub(1).max(1) as f64;
    // Welch–Satterthwaite.
    let p = t_p_value(t, variance * variance / (degrees(a, estimate.count) + degrees(b, reference.count)));
    Some(Trial { t: t.copysign(difference), p })
}

/// Hall's transformation of a statistic that is not negative, towards zero.
fn tempered(t: f64, skewness: f64) -> f64 {
    let g = skewness;
    if g == 0.0 {
        // Also of what cannot be by chance.
        return t;
    }
    (t - g / 6.0 - g * t * t / 3.0 + g * g * t * t * t / 27.0).clamp(0.0, t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use caustica_math::{SampleStream, StreamId};

    const REPLICATES: usize = 32;

    fn side(values: &[f64]) -> Side {
        Side::new(values, Expected::default())
    }

    #[test]
    fn equal_constants_agree_and_others_do_not() {
        let constant = |v: f64| side(&[v; 8]);
        assert_eq!(compare(&constant(1.0), &constant(1.0)).unwrap().p, 1.0);
        assert_eq!(compare(&constant(1.0), &constant(0.0)).unwrap().p, 0.0);
        assert!(compare(&constant(1.1), &constant(1.0)).unwrap().p < 1e-9);
        assert!(compare(&constant(0.9), &constant(1.0)).unwrap().t < -100.0);
        assert_eq!(compare(&constant(0.0), &constant(0.0)), None);
    }

    #[test]
    fn what_is_expected_and_not_found_is_a_difference() {
        let reference = side(&[1.0; REPLICATES]);
        // Of a hundred equal contributions not one was found; of four, that may be.
        let nothing = |hits: f64| {
            let expected = Expected { variance: 1.0 / hits, third: 1.0 / (hits * hits), dropped: 0.0 };
            Side::new(&[0.0; REPLICATES], expected)
        };
        for hits in [60.0, 100.0, 1e4] {
            let trial = compare(&nothing(hits), &reference).unwrap();
            assert!(trial.p < 1e-5 && trial.t < 0.0, "{hits}: {trial:?}");
        }
        assert_eq!(compare(&nothing(4.0), &reference), None);
        // A firefly alone proves nothing either.
        let mut firefly = [0.0; REPLICATES];
        firefly[3] = 100.0;
        assert_eq!(compare(&side(&firefly), &side(&[0.0; REPLICATES])), None);
        let found = [5.0, 6.0, 5.5, 4.0].repeat(8);
        assert!(compare(&side(&found), &side(&[0.0; REPLICATES])).unwrap().p < 1e-9);
    }

    /// Found by fuzzing random scenes: 384 samples saw an environment, one each, that splats show too, and no splat
    /// came.
    #[test]
    fn steady_light_hides_no_splats_that_are_missing() {
        let alike = |count: f64, size: f64| [[count * size, count * size * size, count * size * size * size]];
        let expect = |splats: f64| {
            let (eye, light) = (alike(384.0, 1.0), alike(splats, 4.0));
            Expected::new([&eye, &light], 32.0, 32.0)
        };
        // As much as two splats may be missing; more of them are no small part.
        let few = expect(1.5);
        assert_eq!((few.dropped, few.is_tame()), (6.0 / 32.0, true));
        let missing = |splats: f64| {
            let steady = side(&[12.0 + splats * 4.0 / 32.0; REPLICATES]);
            compare(&Side::new(&[12.0; REPLICATES], expect(splats)), &steady)
        };
        assert_eq!(missing(1.5).unwrap().p, 1.0);
        assert_eq!(missing(5.0), None);
        // A hundred are not left out by chance, and hits alone are as steady as they are seen to be.
        assert!(missing(90.0).unwrap().p < 1e-6);
        assert!(missing(1000.0).unwrap().p < 1e-9);
        let hits = Expected::new([&alike(384.0, 1.0), &[]], 32.0, 32.0);
        assert!(compare(&Side::new(&[11.9; REPLICATES], hits), &side(&[12.0; REPLICATES])).unwrap().p < 1e-9);
    }

    /// Sums of Poisson-many contributions of sizes that spread over `decades` powers of ten, `mean` of them a replicate,
    /// against a constant: how often p falls below `level`, over how often there is a test.
    fn false_alarms(mean: f64, decades: f64, level: f64) -> (u32, u32) {
        let mut stream = SampleStream::new(StreamId { seed: 9, pixel: 0, sample: 0, walk: mean as u32 });
        let mut uniform = || f64::from(stream.next_1d());
        let size = |u: f64| libm::pow(10.0, decades * (u * u * u - 0.5));
        let moment =
            |power: i32| (0..4000).map(|i| size((i as f64 + 0.5) / 4000.0).powi(power)).sum::<f64>() / 4000.0;
        let n = REPLICATES as f64;
        let expected =
            Expected { variance: mean * moment(2) / n, third: mean * moment(3) / (n * n), dropped: 0.0 };
        let truth = side(&[mean * moment(1); REPLICATES]);
        let (mut alarms, mut tests) = (0, 0);
        for _ in 0..20_000 {
            let mut replicate = || {
                // Poisson by counting exponential steps.
                let (mut sum, mut at) = (0.0, -libm::log(1.0 - uniform()));
                while at < mean {
                    sum += size(uniform());
                    at -= libm::log(1.0 - uniform());
                }
                sum
            };
            let values: Vec<f64> = (0..REPLICATES).map(|_| replicate()).collect();
            if let Some(trial) = compare(&Side::new(&values, expected), &truth) {
                tests += 1;
                alarms += u32::from(trial.p < level);
            }
        }
        (alarms, tests)
    }

    /// At a level of 10⁻³, 20 alarms are expected in 20,000 tests if p is exact; 40 would be 4.5 σ.
    #[test]
    fn skewed_data_give_no_more_false_alarms_than_stated() {
        for (mean, decades) in [(0.3, 0.0), (0.5, 2.0), (2.0, 2.0), (2.0, 4.0), (8.0, 3.0), (20.0, 1.0)] {
            let (alarms, tests) = false_alarms(mean, decades, 1e-3);
            assert!(
                f64::from(alarms) <= 20.0 + 20.0 * f64::from(tests) / 20_000.0,
                "{mean}, {decades}: {alarms} of {tests}"
            );
        }
        // Most of the tame ones are tested.
        let (_, tests) = false_alarms(20.0, 1.0, 1e-3);
        assert!(tests > 19_000, "{tests}");
    }
}
