//! Rendering by several methods in turn.

use std::time::Duration;

use caustica_film::{FilmError, Picture};
use caustica_math::Rgb;
use caustica_render::{Budget, Control, Progress, RenderError, RenderOptions, Report, Session};
use caustica_scene::Scene;
use caustica_scene::description::Integrator;
use caustica_transport::Settings;

use crate::method::Method;
use crate::outcome::{CompareError, Entrant, Moment, Outcome, Reference};

/// How to compare.
#[derive(Clone, Debug)]
pub struct Options {
    /// What is compared, in this order.
    pub methods: Vec<Method>,
    /// How long each may render.
    pub budget: Budget,
    /// What the pictures are compared with.
    pub reference: ReferenceChoice,
    /// Worker threads; as many as the machine has if `None`.
    pub threads: Option<usize>,
}

/// Where the reference comes from.
#[derive(Clone, Debug)]
pub enum ReferenceChoice {
    /// Pixels of the scene's window, row by row, and what they are called.
    Given(Vec<Rgb>, String),
    /// `bdpt` renders it, by these settings but for the seed, for so long.
    Made(Settings, Budget),
}

/// What is being rendered.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// The method's name, or `reference`.
    pub name: &'a str,
    /// How many stages came before.
    pub index: usize,
    /// How many there are.
    pub count: usize,
}

/// The seeds of the reference's two halves are this far from that of its settings: its samples are others than those
/// that are compared.
const REFERENCE_SEED: u64 = 0x5eed_0000;

/// Moments at which the error is measured: each after twice the time of the one before.
const MOMENTS: u32 = 9;

/// Renders the reference, then one method after the other. Stopping ends the comparison with what has been rendered
/// so far; a reference that was stopped is used as it is. What measuring takes is not counted as time.
///
/// # Errors
/// A reference of another size, films that do not fit into memory, threads that do not start.
pub fn compare(
    scene: &Scene,
    options: &Options,
    control: &Control,
    mut progress: impl FnMut(Stage<'_>, &Progress),
) -> Result<Outcome, CompareError> {
    let made = usize::from(matches!(options.reference, ReferenceChoice::Made(..)));
    let count = options.methods.len() + made;
    let reference = reference(scene, options, control, |p| {
        progress(Stage { name: "reference", index: 0, count }, p);
    })?;
    let window = scene.film.window();
    if reference.pixels.len() as u64 != u64::from(window.width) * u64::from(window.height) {
        let found = reference.pixels.len();
        return Err(CompareError::Reference { width: window.width, height: window.height, found });
    }
    let mut entrants = Vec::new();
    for (i, method) in options.methods.iter().enumerate() {
        if control.is_stopped() {
            break;
        }
        let stage = Stage { name: &method.name, index: i + made, count };
        entrants.push(enter(scene, options, method, (control, &mut |p: &Progress| progress(stage, p)))?);
    }
    Ok(Outcome { size: [window.width, window.height], reference, entrants })
}

/// Renders by one method, and keeps what there is at several moments.
fn enter(
    scene: &Scene,
    options: &Options,
    method: &Method,
    (control, progress): (&Control, &mut dyn FnMut(&Progress)),
) -> Result<Entrant, CompareError> {
    let session = session(scene, &method.settings, options.threads)?;
    let mut moments: Vec<Moment> = Vec::new();
    let mut seconds = 0.0;
    let mut last: Option<Report> = None;
    for mark in marks(options.budget) {
        let done = last.as_ref().map_or(0, |r: &Report| r.samples);
        let late = mark.time.is_some_and(|t| t.as_secs_f64() <= seconds);
        if late || done >= u64::from(mark.samples) {
            continue;
        }
        let left = mark.time.map(|t| t.saturating_sub(Duration::from_secs_f64(seconds)));
        let before = seconds;
        let report = session.run_for(Budget { time: left, ..mark }, control, |p| {
            progress(&overall(p, before, options.budget));
        })?;
        seconds += report.seconds;
        moments.push(Moment { seconds, samples: report.samples, pixels: pixels(&session.film().develop()) });
        let stopped = report.stopped;
        last = Some(report);
        if stopped {
            break;
        }
    }
    let report = last.ok_or(CompareError::Nothing)?;
    let report = Report { seconds, ..report };
    let metadata = session.metadata(&report);
    Ok(Entrant { method: method.clone(), picture: session.film().develop(), metadata, report, moments })
}

/// The budgets up to each moment, the last one the whole.
fn marks(whole: Budget) -> impl Iterator<Item = Budget> {
    (0..MOMENTS).rev().map(move |k| match whole.time {
        Some(time) => Budget { time: Some(time / (1 << k)), ..whole },
        None => Budget { samples: (whole.samples >> k).max(1), time: None },
    })
}

/// A part's progress as that of the whole.
fn overall(p: &Progress, before: f64, whole: Budget) -> Progress {
    let elapsed = p.elapsed + Duration::from_secs_f64(before);
    let by_samples = p.samples / f64::from(whole.samples);
    let by_time = whole.time.map_or(0.0, |t| elapsed.as_secs_f64() / t.as_secs_f64().max(1e-9));
    Progress { total: whole.samples, fraction: by_samples.max(by_time).min(1.0), elapsed, ..*p }
}

/// The pixels of a picture as they are compared.
fn pixels(picture: &Picture) -> Vec<Rgb> {
    picture.combined(caustica_film::LightImage::On)
}

fn session<'a>(
    scene: &'a Scene,
    settings: &Settings,
    threads: Option<usize>,
) -> Result<Session<'a>, RenderError> {
    Session::new(scene, RenderOptions { settings: settings.clone(), samples: u32::MAX, time: None, threads })
}

/// The reference, in two halves of different seeds, whose difference tells its error.
fn reference(
    scene: &Scene,
    options: &Options,
    control: &Control,
    mut progress: impl FnMut(&Progress),
) -> Result<Reference, CompareError> {
    let (settings, budget) = match &options.reference {
        ReferenceChoice::Given(pixels, name) => {
            return Ok(Reference { name: name.clone(), pixels: pixels.clone(), halves: None, made: None });
        }
        ReferenceChoice::Made(settings, budget) => (settings, *budget),
    };
    let half = Budget { samples: budget.samples.div_ceil(2), time: budget.time.map(|t| t / 2) };
    let mut halves = Vec::new();
    let (mut seconds, mut samples) = (0.0, 0);
    for i in 0..2 {
        let settings = Settings {
            integrator: Integrator::Bdpt,
            seed: settings.seed.wrapping_add(REFERENCE_SEED + i),
            ..settings.clone()
        };
        let session = session(scene, &settings, options.threads)?;
        let before = seconds;
        let report = session.run_for(half, control, |p| progress(&overall(p, before, budget)))?;
        seconds += report.seconds;
        samples += report.samples;
        halves.push((report.samples, pixels(&session.film().develop())));
    }
    let total = samples.max(1) as f32;
    let [(n, a), (m, b)] = [&halves[0], &halves[1]];
    let mean = |(a, b): (&Rgb, &Rgb)| *a * (*n as f32 / total) + *b * (*m as f32 / total);
    let pixels = a.iter().zip(b).map(mean).collect();
    let halves = (*n > 0 && *m > 0).then(|| [a.clone(), b.clone()]);
    Ok(Reference { name: "reference".into(), pixels, halves, made: Some((samples, seconds)) })
}

impl From<RenderError> for CompareError {
    fn from(e: RenderError) -> Self {
        Self::Render(e)
    }
}

impl From<FilmError> for CompareError {
    fn from(e: FilmError) -> Self {
        Self::Render(e.into())
    }
}
