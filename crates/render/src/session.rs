use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use caustica_film::{
    DualFilm, Film, FilmError, FilmFacts, FilmLayout, FilmRecord, LightBuffer, MOST_SAMPLES, Metadata,
    Provenance, Window, half_of,
};
use caustica_math::{Rgb, Sampler, Vec2};
use caustica_scene::Scene;
use caustica_scene::description::Integrator;
use caustica_transport::{Heuristic, Kernel, Scratch, Settings, Sink};
use serde::Serialize;

use crate::names::integrator_name;
use crate::provenance::facts;
use crate::workers::{Budget, Units, Workers, pixels};

/// What a session renders, and for how long.
#[derive(Clone, Debug)]
pub struct RenderOptions {
    /// The algorithm with its settings.
    pub settings: Settings,
    /// The number of each pixel's first sample: 0, or more to render another part of what is merged later.
    pub first_sample: u32,
    /// Samples per pixel, at most.
    pub samples: u32,
    /// Stops with the pass that runs when this is over.
    pub time: Option<Duration>,
    /// Worker threads; as many as the machine has if `None`.
    pub threads: Option<usize>,
}

impl RenderOptions {
    /// For how long to render.
    pub fn budget(&self) -> Budget {
        Budget { samples: self.samples, time: self.time }
    }

    /// Worker threads, as asked for or as the machine has.
    pub fn thread_count(&self) -> usize {
        self.threads.unwrap_or_else(available_threads).max(1)
    }
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self { settings: Settings::default(), first_sample: 0, samples: 64, time: None, threads: None }
    }
}

/// Asks a running session to stop. Shared between threads.
#[derive(Debug, Default)]
pub struct Control {
    stop: AtomicBool,
}

impl Control {
    /// Ends the session with the pass that runs.
    pub fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// Whether it was asked to stop.
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

/// How far a session has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Samples per pixel done; a fraction while a pass runs.
    pub samples: f64,
    /// Samples per pixel asked for.
    pub total: u32,
    /// The part of the work that is done, by samples or time, in [0, 1].
    pub fraction: f64,
    /// Time since the start.
    pub elapsed: Duration,
    /// Samples (of all pixels) per second.
    pub rate: f64,
}

/// What a session did.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// The integrator's name.
    pub integrator: &'static str,
    /// Samples per pixel in the film.
    pub samples: u64,
    /// Whether it ended early, because it was asked to.
    pub stopped: bool,
    /// Wall time in seconds.
    pub seconds: f64,
    /// Samples (of all pixels) per second.
    pub samples_per_second: f64,
    /// Worker threads.
    pub threads: usize,
    /// The seed.
    pub seed: u64,
    /// Contributions left out because they were not finite numbers.
    pub invalid: u64,
    /// Contributions cut because they were too large for the film.
    pub clamped: u64,
    /// The relative error that a typical pixel does not exceed with 95 % certainty, where it is known: see
    /// [`ErrorBars::relative`](caustica_film::ErrorBars::relative).
    pub noise: Option<f64>,
}

/// Why a session cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The film.
    #[error(transparent)]
    Film(#[from] FilmError),
    /// No threads could be started.
    #[error("cannot start a worker thread: {0}")]
    Threads(#[source] std::io::Error),
    /// A film that is to be continued.
    #[error("{0}")]
    Continue(String),
}

/// A film being rendered from a scene.
#[derive(Debug)]
pub struct Session<'a> {
    kernel: Kernel<'a>,
    film: DualFilm,
    options: RenderOptions,
    /// Seconds that went into the film before this session.
    seconds: f64,
}

/// Threads get buffers of their own for splats while all of them together take no more bytes than this.
const MOST_BUFFERED: u64 = 256 << 20;

impl<'a> Session<'a> {
    /// A session with an empty film.
    ///
    /// # Errors
    /// If the film does not fit into memory.
    pub fn new(scene: &'a Scene, options: RenderOptions) -> Result<Self, RenderError> {
        let film = DualFilm::new(film_layout(scene, &options.settings.integrator))?;
        Ok(Self { kernel: Kernel::new(scene, options.settings.clone()), film, options, seconds: 0.0 })
    }

    /// A session that goes on where a film ends: with the same scene, settings and first sample, the film becomes
    /// what it would have become without a pause.
    ///
    /// # Errors
    /// A film of something else than `provenance`, whose samples are not those from the first one on, or that has more
    /// than the options ask for.
    pub fn resume(
        scene: &'a Scene,
        options: RenderOptions,
        (record, provenance): (FilmRecord, &Provenance),
    ) -> Result<Self, RenderError> {
        let refuse = |why: String| Err(RenderError::Continue(why));
        let (ours, theirs) = (film_layout(scene, &options.settings.integrator), *record.film.layout());
        if ours != theirs {
            return refuse(format!("the film is of {theirs}, not of {ours}"));
        }
        if let Some(what) = record.facts.provenance.difference(provenance) {
            return refuse(format!("the film cannot be continued: {what} changed"));
        }
        let first = u64::from(options.first_sample);
        let samples = &record.facts.samples;
        if samples.single().is_none_or(|r| !r.is_empty() && r.start != first) {
            return refuse(format!("the film holds the samples {samples}, not those from {first} on"));
        }
        let (there, asked) = (samples.total(), options.samples);
        if there > u64::from(asked) {
            return refuse(format!("the film holds {there} samples per pixel already, more than {asked}"));
        }
        let kernel = Kernel::new(scene, options.settings.clone());
        Ok(Self { kernel, film: record.film, options, seconds: record.facts.seconds })
    }

    /// The film.
    pub fn film(&self) -> &DualFilm {
        &self.film
    }

    /// What is known of the film now, after so many seconds of this session: what a film file needs beside it.
    pub fn facts(&self, provenance: &Provenance, seconds: f64) -> FilmFacts {
        let (samples, seconds) = (self.range().into(), self.seconds + seconds);
        FilmFacts { provenance: provenance.clone(), samples, seconds }
    }

    /// The samples in the film.
    pub fn range(&self) -> Range<u64> {
        let first = u64::from(self.options.first_sample);
        first..first + self.samples()
    }

    /// The kernel.
    pub fn kernel(&self) -> &Kernel<'a> {
        &self.kernel
    }

    /// What to write beside the picture: how it was made.
    pub fn metadata(&self, report: &Report) -> Metadata {
        let mut m: Metadata = facts(&self.options.settings).into_iter().collect();
        m.set("seconds", format!("{:.3}", self.seconds + report.seconds));
        if let Some(noise) = report.noise {
            m.set("noise", format!("{noise:.5}"));
        }
        m
    }

    /// Renders for as long as the options say: see [`Session::run_for`].
    ///
    /// # Errors
    /// If no worker thread can be started.
    pub fn run(&self, control: &Control, progress: impl FnMut(&Progress)) -> Result<Report, RenderError> {
        self.run_for(self.options.budget(), control, progress)
    }

    /// Renders until the samples or the time are used up, or `control` says stop; only whole passes of one
    /// sample a pixel are counted, and the time is enough for one at least. What is in the film already
    /// counts: a session that was stopped goes on where it was. `progress` is called about ten times a second,
    /// on this thread.
    ///
    /// # Errors
    /// If no worker thread can be started.
    pub fn run_for(
        &self,
        budget: Budget,
        control: &Control,
        mut progress: impl FnMut(&Progress),
    ) -> Result<Report, RenderError> {
        let start = Instant::now();
        let window = self.film.layout().window;
        let threads = self.options.thread_count();
        let per_thread = 2 * LightBuffer::memory(window.pixels());
        let buffered = self.kernel.has_light_image() && per_thread * threads as u64 <= MOST_BUFFERED;
        let (first, done) = (u64::from(self.options.first_sample), self.samples());
        let workers =
            Workers { window, start: first, done, budget: self.within_reach(budget), threads, control };
        let asked = |p: &Progress| progress(&Progress { total: budget.samples, ..*p });
        let added = workers.run(|units| self.work(units, buffered), asked)?;
        let (eye, light) =
            (self.options.settings.integrator != Integrator::Light, self.kernel.has_light_image());
        self.film.finish_passes(first + done..first + done + added, eye, light);
        let stopped = control.is_stopped() && self.samples() < u64::from(budget.samples);
        Ok(Report { stopped, ..self.report(added, start.elapsed(), threads) })
    }

    /// Worker threads.
    pub(crate) fn threads(&self) -> usize {
        self.options.thread_count()
    }

    /// For how long the options say.
    pub(crate) fn budget(&self) -> Budget {
        self.options.budget()
    }

    /// No more samples than there are numbers for, nor than a film holds.
    pub(crate) fn within_reach(&self, budget: Budget) -> Budget {
        let most = (u32::MAX - self.options.first_sample).min(MOST_SAMPLES as u32);
        Budget { samples: budget.samples.min(most), ..budget }
    }

    /// Samples per pixel in the film.
    pub(crate) fn samples(&self) -> u64 {
        let counts = self.film.counts();
        counts.eye_samples.max(counts.light_samples)
    }

    /// The report on a run of `added` samples that was not stopped.
    fn report(&self, added: u64, time: Duration, threads: usize) -> Report {
        let seconds = time.as_secs_f64();
        let pixels = self.film.layout().window.pixels() as f64;
        Report {
            integrator: integrator_name(&self.options.settings.integrator),
            samples: self.samples(),
            stopped: false,
            seconds,
            samples_per_second: added as f64 * pixels / seconds.max(1e-9),
            threads,
            seed: self.options.settings.seed,
            invalid: self.film.counts().invalid,
            clamped: self.film.counts().clamped,
            noise: None,
        }
    }

    /// Renders units until there are none left. `buffered` is whether splats are gathered apart.
    fn work(&self, units: Units<'_>, buffered: bool) {
        let mut scratch = Scratch::default();
        let halves = self.film.halves();
        let mut buffers = halves.each_ref().map(|f| if buffered { f.light_buffer() } else { None });
        for (pass, tile) in units {
            let half = half_of(pass.into());
            for pixel in self.kernel.in_groups(pixels(tile)) {
                let (film, kernel) = (&halves[half], &self.kernel);
                let mut sink = FilmSink { film, kernel, buffer: buffers[half].as_mut(), pixel };
                self.kernel.sample(pixel, pass, &mut scratch, &mut sink);
            }
        }
        for (film, buffer) in halves.iter().zip(&mut buffers) {
            if let Some(buffer) = buffer {
                film.flush(buffer);
            }
        }
    }
}

/// Adds to a film.
struct FilmSink<'a, 's> {
    film: &'a Film,
    kernel: &'a Kernel<'s>,
    buffer: Option<&'a mut LightBuffer>,
    pixel: [u32; 2],
}

impl Sink for FilmSink<'_, '_> {
    #[inline]
    fn eye(&mut self, value: Rgb) {
        self.film.add_eye(self.pixel, value);
    }

    #[inline]
    fn splat(&mut self, film: Vec2, value: Rgb) {
        // The film divides by the number of passes; a pass has as many light paths as the window has pixels.
        match &mut self.buffer {
            Some(buffer) => self.film.splat_into(buffer, self.kernel.filter(), film, value),
            None => self.film.splat_light(self.kernel.filter(), film, value),
        }
    }
}

pub(crate) fn sampler_name(sampler: Sampler) -> &'static str {
    match sampler {
        Sampler::Independent => "independent",
        Sampler::Sobol => "sobol",
    }
}

pub(crate) fn heuristic_name(heuristic: Heuristic) -> &'static str {
    match heuristic {
        Heuristic::Balance => "balance",
        Heuristic::Power => "power",
    }
}

/// How many threads the machine offers.
pub fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// The film that a scene asks for, with a quantum that suits the integrator.
pub(crate) fn film_layout(scene: &Scene, integrator: &Integrator) -> FilmLayout {
    let w = scene.film.window();
    FilmLayout {
        width: scene.film.width,
        height: scene.film.height,
        window: Window { x: w.x, y: w.y, width: w.width, height: w.height },
        quantum_exponent: quantum_exponent(scene, integrator),
    }
}

/// The film's quantum: a power of two far below what the scene's lamps would give if their light were spread
/// over its bounds, but large enough that the brightest lamp, seen directly, does not overflow in 2²⁷ samples.
fn quantum_exponent(scene: &Scene, integrator: &Integrator) -> i32 {
    let lit = matches!(
        integrator,
        Integrator::Bdpt
            | Integrator::Light
            | Integrator::Path(_)
            | Integrator::Direct(_)
            | Integrator::Whitted
    );
    let (_, radius) = scene.bounding_sphere();
    if !lit {
        // Normals and visibility lie within one, distances within the scene.
        return log2_ceiling(f64::from(radius).max(1.0)) - 36;
    }
    let (power, r) = (scene.lamps().power(), f64::from(radius));
    let spread = power / (4.0 * std::f64::consts::PI * std::f64::consts::PI * r * r);
    let fine = log2_ceiling(spread) - 26;
    let coarse = log2_ceiling(f64::from(scene.brightest())) - 36;
    fine.max(coarse).clamp(-120, 120)
}

/// ⌈log₂⌉, and −120 for zero.
fn log2_ceiling(x: f64) -> i32 {
    if x > 0.0 && x.is_finite() { libm::ceil(libm::log2(x)) as i32 } else { -120 }
}
