use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

use caustica_film::{Film, FilmError, FilmLayout, LightBuffer, Metadata, Window};
use caustica_math::{Rgb, Sampler, Vec2};
use caustica_scene::Scene;
use caustica_scene::description::Integrator;
use caustica_transport::{Heuristic, Kernel, Scratch, Settings, Sink};
use serde::Serialize;

use crate::names::integrator_name;
use crate::queue::Queue;

/// What a session renders, and for how long.
#[derive(Clone, Debug)]
pub struct RenderOptions {
    /// The algorithm with its settings.
    pub settings: Settings,
    /// Samples per pixel, at most.
    pub samples: u32,
    /// Stops with the pass that runs when this is over.
    pub time: Option<Duration>,
    /// Worker threads; as many as the machine has if `None`.
    pub threads: Option<usize>,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self { settings: Settings::default(), samples: 64, time: None, threads: None }
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
}

/// A film being rendered from a scene.
#[derive(Debug)]
pub struct Session<'a> {
    kernel: Kernel<'a>,
    film: Film,
    options: RenderOptions,
}

/// Edge of a tile in pixels: small enough to share out evenly, large enough to keep caches warm.
const TILE: u32 = 16;

/// Threads get buffers of their own for splats while all of them together take no more bytes than this.
const MOST_BUFFERED: u64 = 128 << 20;

/// How often progress is told.
const TICK: Duration = Duration::from_millis(100);

/// The shortest wait for the end of the time, or of a pass that outlasts it.
const SHORTEST_TICK: Duration = Duration::from_millis(5);

impl<'a> Session<'a> {
    /// A session with an empty film.
    ///
    /// # Errors
    /// If the film does not fit into memory.
    pub fn new(scene: &'a Scene, options: RenderOptions) -> Result<Self, RenderError> {
        let window = scene.film.window();
        let film = Film::new(FilmLayout {
            width: scene.film.width,
            height: scene.film.height,
            window: Window { x: window.x, y: window.y, width: window.width, height: window.height },
            quantum_exponent: quantum_exponent(scene, &options.settings.integrator),
        })?;
        Ok(Self { kernel: Kernel::new(scene, options.settings.clone()), film, options })
    }

    /// The film.
    pub fn film(&self) -> &Film {
        &self.film
    }

    /// The kernel.
    pub fn kernel(&self) -> &Kernel<'a> {
        &self.kernel
    }

    /// What to write beside the picture: how it was made.
    pub fn metadata(&self, report: &Report) -> Metadata {
        let settings = &self.options.settings;
        let mut m = Metadata::new();
        m.set("integrator", report.integrator);
        m.set("seed", report.seed);
        m.set("sampler", sampler_name(settings.sampler));
        m.set("seconds", format!("{:.3}", report.seconds));
        m.set("version", env!("CARGO_PKG_VERSION"));
        m.set("strategies", &settings.strategies);
        m.set("heuristic", heuristic_name(settings.heuristic));
        m.set("rouletteDepth", settings.roulette_start());
        m.set("maxDepth", settings.max_depth.map_or("unlimited".to_owned(), |d| d.to_string()));
        m
    }

    /// Renders until the samples or the time are used up, or `control` says stop; only whole passes of one
    /// sample a pixel are counted, and the time is enough for one at least. What is in the film already
    /// counts: a session that was stopped goes on where it was. `progress` is called about ten times a second,
    /// on this thread.
    ///
    /// # Errors
    /// If no worker thread can be started.
    pub fn run(&self, control: &Control, mut progress: impl FnMut(&Progress)) -> Result<Report, RenderError> {
        let start = Instant::now();
        let tiles = self.tiles();
        let first = self.samples();
        let queue = Queue::new(tiles.len() as u64, first, u64::from(self.options.samples));
        let threads = self.options.threads.unwrap_or_else(available_threads).max(1);
        let per_thread = LightBuffer::memory(self.film.layout().window.pixels());
        let buffered = self.kernel.has_light_image() && per_thread * threads as u64 <= MOST_BUFFERED;
        let (sender, receiver) = mpsc::channel::<()>();
        std::thread::scope(|scope| {
            for i in 0..threads {
                let sender = sender.clone();
                let (queue, tiles) = (&queue, &tiles);
                let worker = std::thread::Builder::new().name(format!("render {i}"));
                let spawned = worker.spawn_scoped(scope, move || {
                    self.work(queue, tiles, buffered);
                    drop(sender);
                });
                if let Err(e) = spawned {
                    queue.stop();
                    return Err(RenderError::Threads(e));
                }
            }
            drop(sender);
            // The channel closes when all workers are done.
            while receiver.recv_timeout(self.tick(start)) == Err(RecvTimeoutError::Timeout) {
                let late = self.options.time.is_some_and(|t| start.elapsed() >= t);
                if control.is_stopped() || (late && queue.has_begun()) {
                    queue.stop();
                }
                progress(&self.progress(&queue, start));
            }
            Ok(())
        })?;
        progress(&self.progress(&queue, start));
        let samples = queue.progress().passes as u64 - first;
        let eye = if self.options.settings.integrator == Integrator::Light { 0 } else { samples };
        let light = if self.kernel.has_light_image() { samples } else { 0 };
        self.film.finish_samples(eye, light);
        Ok(self.report(samples, start.elapsed(), (threads, control)))
    }

    /// Samples per pixel in the film.
    fn samples(&self) -> u64 {
        self.film.eye_samples().max(self.film.light_samples())
    }

    /// How long to wait before looking at the time again.
    fn tick(&self, start: Instant) -> Duration {
        let left = self.options.time.map(|t| t.saturating_sub(start.elapsed())).unwrap_or(TICK);
        left.clamp(SHORTEST_TICK, TICK)
    }

    /// The report on a run of `added` samples.
    fn report(&self, added: u64, time: Duration, (threads, control): (usize, &Control)) -> Report {
        let seconds = time.as_secs_f64();
        let pixels = self.film.layout().window.pixels() as f64;
        let samples = self.samples();
        Report {
            integrator: integrator_name(&self.options.settings.integrator),
            samples,
            stopped: control.is_stopped() && samples < u64::from(self.options.samples),
            seconds,
            samples_per_second: added as f64 * pixels / seconds.max(1e-9),
            threads,
            seed: self.options.settings.seed,
            invalid: self.film.invalid(),
            clamped: self.film.clamped(),
        }
    }

    fn progress(&self, queue: &Queue, start: Instant) -> Progress {
        let passes = queue.progress();
        let elapsed = start.elapsed();
        let by_time = self.options.time.map_or(0.0, |t| elapsed.as_secs_f64() / t.as_secs_f64().max(1e-9));
        let pixels = self.film.layout().window.pixels() as f64;
        Progress {
            samples: passes.passes,
            total: self.options.samples,
            fraction: passes.fraction.max(by_time).min(1.0),
            elapsed,
            rate: passes.added * pixels / elapsed.as_secs_f64().max(1e-9),
        }
    }

    /// The tiles of a pass.
    fn tiles(&self) -> Vec<Window> {
        let w = self.film.layout().window;
        let steps = |start: u32, size: u32| (start..start + size).step_by(TILE as usize);
        steps(w.y, w.height)
            .flat_map(|y| {
                steps(w.x, w.width).map(move |x| Window {
                    x,
                    y,
                    width: TILE.min(w.x + w.width - x),
                    height: TILE.min(w.y + w.height - y),
                })
            })
            .collect()
    }

    /// Renders units until there are none left. `buffered` is whether splats are gathered apart.
    fn work(&self, queue: &Queue, tiles: &[Window], buffered: bool) {
        let mut scratch = Scratch::default();
        let mut buffer = if buffered { self.film.light_buffer() } else { None };
        let mut finished = false;
        while let Some((pass, unit)) = queue.next(finished) {
            let tile = tiles[unit as usize];
            for y in tile.y..tile.y + tile.height {
                for x in tile.x..tile.x + tile.width {
                    let (film, kernel) = (&self.film, &self.kernel);
                    let mut sink = FilmSink { film, kernel, buffer: buffer.as_mut(), pixel: [x, y] };
                    self.kernel.sample([x, y], pass as u32, &mut scratch, &mut sink);
                }
            }
            finished = true;
        }
        if let Some(buffer) = &mut buffer {
            self.film.flush(buffer);
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

fn sampler_name(sampler: Sampler) -> &'static str {
    match sampler {
        Sampler::Independent => "independent",
        Sampler::Sobol => "sobol",
    }
}

fn heuristic_name(heuristic: Heuristic) -> &'static str {
    match heuristic {
        Heuristic::Balance => "balance",
        Heuristic::Power => "power",
    }
}

/// How many threads the machine offers.
pub(crate) fn available_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
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
