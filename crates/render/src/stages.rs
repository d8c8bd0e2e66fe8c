//! Sessions that pause: to look at the noise, and to save what is there.

use std::time::{Duration, Instant};

use crate::session::{Control, Progress, RenderError, Report, Session};
use crate::workers::Budget;

/// For what a session pauses.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stages {
    /// How often the film is to be saved.
    pub every: Option<Duration>,
    /// The relative error at which to stop: see [`ErrorBars::relative`](caustica_film::ErrorBars::relative).
    pub noise: Option<f64>,
}

/// With fewer samples a pixel nothing is said about the noise: there may be paths that no sample has found yet.
const FEWEST: u64 = 16;

/// A render that is to stop at a noise level, and has found no light at all, gives up here.
const DARK: u64 = 1 << 16;

/// Whether the noise is looked at when there are so many samples.
fn is_look(samples: u64) -> bool {
    samples >= FEWEST && next_look(samples - 1) == samples
}

/// The next number of samples at which the noise is looked at. It depends on nothing but the samples, so that a
/// session stops at the same number however often it was interrupted.
fn next_look(samples: u64) -> u64 {
    if samples < FEWEST {
        return FEWEST;
    }
    let step = 1 << (samples.ilog2() - 3);
    (samples / step + 1) * step
}

impl Session<'_> {
    /// Renders as [`Session::run`] does, with pauses between passes. `save` is called after each interval of
    /// [`Stages::every`], with the report so far. The final report tells the noise, if there is any to be told.
    ///
    /// # Errors
    /// If no worker thread can be started.
    pub fn run_in_stages(
        &self,
        stages: &Stages,
        control: &Control,
        (mut progress, mut save): (impl FnMut(&Progress), impl FnMut(&Report)),
    ) -> Result<Report, RenderError> {
        let (asked, start) = (self.budget(), Instant::now());
        let whole = self.within_reach(asked);
        let (before, mut saved) = (self.samples(), start);
        loop {
            let done = self.samples();
            // A film that was quiet enough when it was interrupted stays as it is.
            let look = match stages.noise {
                Some(most) if is_look(done) && self.is_quiet(self.noise(), most) => done,
                Some(_) => next_look(done),
                None => u64::MAX,
            };
            let samples = u64::from(whole.samples).min(look) as u32;
            let until = |from: Instant, time: Duration| time.saturating_sub(from.elapsed());
            let left = whole.time.map(|t| until(start, t));
            let time = left.into_iter().chain(stages.every.map(|t| until(saved, t))).min();
            let report = self.run_for(Budget { samples, time }, control, |p| {
                progress(&overall(p, start.elapsed(), asked));
            })?;
            let report = self.total(report, start.elapsed(), before);
            let noise = if report.samples >= look { self.noise() } else { None };
            let quiet = report.samples >= look && stages.noise.is_some_and(|most| self.is_quiet(noise, most));
            let late = whole.time.is_some_and(|t| start.elapsed() >= t);
            if quiet || late || report.stopped || report.samples >= u64::from(whole.samples) {
                return Ok(Report { noise: noise.or_else(|| self.noise()), ..report });
            }
            if stages.every.is_some_and(|t| saved.elapsed() >= t) {
                save(&report);
                saved = Instant::now();
            }
        }
    }

    /// Whether the noise is no more than that; where there is no light, when it has been looked for long enough.
    fn is_quiet(&self, noise: Option<f64>, most: f64) -> bool {
        noise.map_or(self.samples() >= DARK, |noise| noise <= most)
    }

    /// The relative error of the whole film, if it is known.
    fn noise(&self) -> Option<f64> {
        self.film().error_bars().and_then(|bars| bars.relative())
    }

    /// The report on all stages, of that on the last one.
    fn total(&self, last: Report, time: Duration, before: u64) -> Report {
        let added = (last.samples - before) as f64 * self.film().layout().window.pixels() as f64;
        let seconds = time.as_secs_f64();
        Report { seconds, samples_per_second: added / seconds.max(1e-9), ..last }
    }
}

/// A stage's progress as that of the whole.
fn overall(p: &Progress, elapsed: Duration, whole: Budget) -> Progress {
    let by_samples = p.samples / f64::from(whole.samples);
    let by_time = whole.time.map_or(0.0, |t| elapsed.as_secs_f64() / t.as_secs_f64().max(1e-9));
    Progress { total: whole.samples, fraction: by_samples.max(by_time).min(1.0), elapsed, ..*p }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn looks_come_at_the_same_samples_wherever_one_starts() {
        let all: Vec<u64> = std::iter::successors(Some(0), |n| Some(next_look(*n))).take(22).collect();
        let expected =
            [0, 16, 18, 20, 22, 24, 26, 28, 30, 32, 36, 40, 44, 48, 52, 56, 60, 64, 72, 80, 88, 96];
        assert_eq!(all, expected);
        assert!((0..97).all(|n| is_look(n) == (all.contains(&n) && n > 0)));
        for samples in 0..90 {
            assert_eq!(next_look(samples), *all.iter().find(|n| **n > samples).unwrap());
        }
    }
}
