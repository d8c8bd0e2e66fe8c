//! Renders a scene in all ways that apply, and tests block by block that they agree.

use caustica_math::stats::sidak;
use caustica_math::stream::mix64;
use caustica_math::{MemoryLimit, MemoryShortage};
use caustica_render::{Control, RenderError, available_threads};
use caustica_scene::Scene;
use caustica_scene::camera::Joins;
use caustica_scene::description::{FilmSettings, Integrator};
use caustica_transport::{Kernel, Scratch, Settings, StrategySet};

use crate::estimator::Estimator;
use crate::grid::Grid;
use crate::jobs;
use crate::memory;
use crate::outcome::{ClassShare, Finding, Outcome, Tested};
use crate::tally::{Learned, Picture, PictureSink, Powers, Probe, sparsity};
use crate::trial::{Expected, Side, compare};

/// How a scene is verified.
#[derive(Clone, Debug)]
pub struct Options {
    /// How paths are sampled: seed, sampler, depth, roulette, heuristic. The integrator and strategies do not count.
    pub settings: Settings,
    /// Samples per pixel of each estimator; the reference gets twice as many.
    pub samples: u32,
    /// Edge of a block in pixels.
    pub block: u32,
    /// The probability that any test of the run tells of a difference where there is none.
    pub significance: f64,
    /// Worker threads; as many as the machine has if `None`.
    pub threads: Option<usize>,
}

impl Default for Options {
    fn default() -> Self {
        Self { settings: Settings::default(), samples: 128, block: 8, significance: 0.01, threads: None }
    }
}

/// Independent repetitions, with seeds of their own, whose spread tells the variance.
const REPLICATES: u32 = 32;

/// How many samples the reference gets for each sample of an estimator.
const REFERENCE: u32 = 2;

/// Why a scene could not be verified.
#[derive(Debug, thiserror::Error)]
pub enum VerifyError {
    /// Threads.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// Too few samples for any spread to be seen.
    #[error("{0} samples a pixel are too few: at least 8 are needed to see how far they spread")]
    TooFewSamples(u32),
    /// It was asked to stop.
    #[error("stopped before there was anything to compare")]
    Stopped,
    /// The picture is too large for the machine.
    #[error(
        "to {doing} {width} × {height} pixels {shortage}: a smaller picture shows the same (`--resolution`)"
    )]
    Memory {
        /// What was to be done.
        doing: &'static str,
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// How much is needed and there.
        shortage: MemoryShortage,
    },
}

/// The fewest samples per pixel.
const FEWEST: u32 = 8;

/// How far a run has come.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// What is rendered: `reference` or an estimator's name.
    pub name: &'a str,
    /// The part of all work that is done, in [0, 1].
    pub fraction: f64,
}

/// What all parts of a run need.
struct Run<'a> {
    scene: &'a Scene,
    grid: Grid,
    replicates: u32,
    /// Passes of a replicate.
    passes: u32,
    options: &'a Options,
    control: &'a Control,
}

/// What an estimator rendered.
struct Rendered {
    /// The mean picture.
    picture: Picture,
    /// What its replicates found.
    values: Values,
}

/// Sums of blocks, by replicate.
type Values = Vec<Vec<f64>>;

/// Renders the scene by `bdpt` and by every estimator alone, and compares each with what `bdpt` found of the paths
/// that it can reach. The outcome does not depend on the number of threads.
///
/// # Errors
/// Too few samples, a picture that needs more memory than there is, threads that do not start, and a control that
/// stops it.
pub fn verify(
    scene: &Scene,
    options: &Options,
    control: &Control,
    mut tell: impl FnMut(Stage<'_>),
) -> Result<Outcome, VerifyError> {
    if options.samples < FEWEST {
        return Err(VerifyError::TooFewSamples(options.samples));
    }
    let replicates = REPLICATES.min(options.samples);
    let passes = options.samples.div_ceil(replicates);
    let run = Run { scene, grid: Grid::new(scene, options.block), replicates, passes, options, control };
    let estimators = Estimator::all(&options.settings);
    memory::for_verifying(run.grid.window, (estimators.len(), run.grid.blocks()), options.threads)
        .check(MemoryLimit::Machine)?;
    // The reference takes about three times as long as an estimator.
    let parts = estimators.len() as f64 + 3.0;
    let (learned, references) =
        run.reference(&estimators, |f| tell(Stage { name: "reference", fraction: 3.0 * f / parts }))?;
    let mut tested = Vec::new();
    for (i, estimator) in estimators.into_iter().enumerate() {
        let fraction = |f: f64| (3.0 + i as f64 + f) / parts;
        let name = estimator.name.clone();
        let rendered = run.render(&estimator, i, |f| tell(Stage { name: &name, fraction: fraction(f) }))?;
        tested.push(run.test(estimator, i, rendered, (&learned, &references)));
    }
    Ok(run.outcome(learned, tested))
}

impl Run<'_> {
    /// The seed of a replicate of an estimator, unlike all others.
    fn seed(&self, estimator: usize, replicate: usize) -> u64 {
        mix64(self.options.settings.seed ^ mix64((estimator as u64) << 32 | replicate as u64))
    }

    fn camera(&self) -> Joins {
        self.scene.camera.joins()
    }

    /// Runs the replicates on all threads.
    fn each_replicate<T: Send>(
        &self,
        work: impl Fn(usize) -> T + Sync,
        mut take: impl FnMut(T),
        mut progress: impl FnMut(f64),
    ) -> Result<(), VerifyError> {
        let threads = self.options.threads.unwrap_or_else(available_threads);
        let count = self.replicates as usize;
        let mut done = 0;
        let all = jobs::run((count, threads), self.control, work, |result| {
            take(result);
            done += 1;
            progress(f64::from(done) / count as f64);
        })?;
        if all { Ok(()) } else { Err(VerifyError::Stopped) }
    }

    fn reference(
        &self,
        estimators: &[Estimator],
        progress: impl FnMut(f64),
    ) -> Result<(Learned, Vec<Values>), VerifyError> {
        let passes = REFERENCE * self.passes;
        let work = |replicate| {
            let settings = Settings {
                integrator: Integrator::Bdpt,
                strategies: StrategySet::default(),
                seed: self.seed(usize::MAX >> 40, replicate),
                ..self.options.settings.clone()
            };
            let kernel = Kernel::new(self.scene, settings);
            let mut scratch = Scratch::default();
            let render = PictureSink {
                kernel: &kernel,
                grid: self.grid,
                picture: Picture::new(&self.grid),
                pixel: [0; 2],
            };
            let learned = Learned::new(&self.grid, estimators.len());
            let sparsity = sparsity(kernel.filter());
            let (camera, parts) = (self.camera(), Vec::new());
            let mut probe = Probe { render, learned, estimators, camera, sparsity, parts };
            let pixels = kernel.in_groups(self.grid.each_pixel());
            for pass in 0..passes {
                for &pixel in &pixels {
                    probe.render.pixel = pixel;
                    kernel.sample(pixel, pass, &mut scratch, &mut probe);
                }
            }
            Learned { picture: probe.render.picture, ..probe.learned }
        };
        let mut all = Learned::new(&self.grid, estimators.len());
        let mut values = vec![Vec::new(); estimators.len()];
        let take = |learned: Learned| {
            for (i, values) in values.iter_mut().enumerate() {
                let mut sums = vec![0.0; self.grid.blocks()];
                for (_, powers) in learned.by_reach.iter().filter(|(mask, _)| *mask >> i & 1 != 0) {
                    sums.iter_mut().enumerate().for_each(|(b, s)| *s += powers.sum(b) / f64::from(passes));
                }
                values.push(sums);
            }
            all.merge(&learned);
        };
        self.each_replicate(work, take, progress)?;
        Ok((all, values))
    }

    fn render(
        &self,
        estimator: &Estimator,
        index: usize,
        progress: impl FnMut(f64),
    ) -> Result<Rendered, VerifyError> {
        let work = |replicate| {
            let settings = Settings { seed: self.seed(index, replicate), ..estimator.settings.clone() };
            let kernel = Kernel::new(self.scene, settings);
            let mut scratch = Scratch::default();
            let mut sink = PictureSink {
                kernel: &kernel,
                grid: self.grid,
                picture: Picture::new(&self.grid),
                pixel: [0; 2],
            };
            let pixels = kernel.in_groups(self.grid.each_pixel());
            for pass in 0..self.passes {
                for &pixel in &pixels {
                    sink.pixel = pixel;
                    kernel.sample(pixel, pass, &mut scratch, &mut sink);
                }
            }
            sink.picture.scaled(1.0 / self.passes as f32)
        };
        let mut rendered = Rendered { picture: Picture::new(&self.grid), values: Vec::new() };
        let take = |picture: Picture| {
            rendered.values.push(self.grid.sums(&picture.pixels));
            rendered.picture.add(&picture);
        };
        self.each_replicate(work, take, progress)?;
        rendered.picture = rendered.picture.scaled(1.0 / self.replicates as f32);
        Ok(rendered)
    }

    /// Compares an estimator with the reference in blocks of all sizes.
    fn test(
        &self,
        estimator: Estimator,
        index: usize,
        rendered: Rendered,
        (learned, references): (&Learned, &[Values]),
    ) -> Tested {
        let own = f64::from(self.replicates * self.passes);
        let theirs = own * f64::from(REFERENCE);
        let mut found = Powers::new(self.grid.blocks());
        for (_, powers) in learned.by_reach.iter().filter(|(mask, _)| *mask >> index & 1 != 0) {
            found.merge(powers);
        }
        let mut findings = Vec::new();
        for level in 0..self.grid.levels().len() {
            let merged = |all: &[Vec<f64>]| -> Vec<Vec<f64>> {
                all.iter().map(|sums| self.grid.merged(sums, level)).collect()
            };
            let (values, reference) = (merged(&rendered.values), merged(&references[index]));
            let expected = learned.expected[index].merged(&self.grid, level);
            let found = found.merged(&self.grid, level);
            let [columns, rows] = self.grid.levels()[level];
            let blocks = (0..(columns * rows) as usize).map(|b| {
                let column = |all: &[Vec<f64>]| -> Vec<f64> { all.iter().map(|v| v[b]).collect() };
                let estimate = Expected::new(expected.of_block(b), theirs, own);
                let estimate = Side::new(&column(&values), estimate);
                let reference_spread = Expected::new(found.of_block(b), theirs, theirs);
                let reference = Side::new(&column(&reference), reference_spread);
                Finding { trial: compare(&estimate, &reference), estimate, reference }
            });
            findings.push(blocks.collect());
        }
        Tested::new(estimator, rendered.picture, findings)
    }

    fn outcome(&self, learned: Learned, mut tested: Vec<Tested>) -> Outcome {
        let tests = tested.iter().map(Tested::tests).sum();
        let level = sidak(self.options.significance, tests);
        tested.iter_mut().for_each(|t| t.judge(&self.grid, level));
        let total: f64 = learned.classes.values().map(|t| t.light).sum();
        let camera = self.camera();
        let shares = learned.classes.iter().map(|(class, tally)| ClassShare {
            class: *class,
            share: if total > 0.0 { tally.light / total } else { 0.0 },
            count: tally.count,
            reached: tested.iter().map(|t| t.estimator.reaches(class, camera)).collect(),
        });
        let passes = REFERENCE * self.passes * self.replicates;
        Outcome {
            grid: self.grid,
            classes: shares.collect(),
            reference: learned.picture.scaled(1.0 / passes as f32),
            tested,
            level,
            significance: self.options.significance,
            samples: self.passes * self.replicates,
            reference_samples: passes,
            replicates: self.replicates,
        }
    }
}

/// Makes the longer side of a film that many pixels, if it is longer.
pub fn shrink(film: &mut FilmSettings, side: u32) {
    let longest = film.width.max(film.height);
    if longest <= side {
        return;
    }
    let scaled = |n: u32| {
        ((u64::from(n) * u64::from(side) + u64::from(longest) / 2) / u64::from(longest)).max(1) as u32
    };
    (film.width, film.height) = (scaled(film.width), scaled(film.height));
    film.crop = None;
}
