//! Rendering by several methods in turn.

use std::time::Duration;

use caustica_film::{LightImage, Picture};
use caustica_math::Rgb;
use caustica_metrics::{Errors, Image, errors, flip, relative_error_map};
use caustica_render::{Budget, Control, Progress, RenderError, RenderOptions, Report, Session};
use caustica_report::CurvePoint;
use caustica_scene::Scene;
use caustica_scene::description::Integrator;
use caustica_transport::Settings;

use crate::method::Method;
use crate::outcome::{CompareError, Entrant, Outcome, Reference};

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
    /// Pixels of the scene's window, row by row, and where they are from.
    Given(Vec<Rgb>, String),
    /// `bdpt` renders it, by these settings but for the seed, for so long.
    Made(Settings, Budget),
}

/// What is told while a comparison is made.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// A stage renders.
    Rendering(Stage<'a>, &'a Progress),
    /// A stage's picture is measured.
    Measuring(Stage<'a>),
    /// The reference is there.
    Reference(&'a Reference),
    /// A method is done: what it made can be kept.
    Done(&'a Entrant),
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
const MOMENTS: u32 = 8;

/// Renders the reference, then one method after the other. Stopping ends the comparison with what has been rendered
/// so far; a reference that was stopped is used as it is. What measuring takes is not counted as time. `tell` hears of
/// everything as it happens; its errors end the comparison.
///
/// # Errors
/// A reference of another size or with values that are not finite, films that do not fit into memory, threads that do
/// not start; and those of `tell`.
pub fn compare<E: From<CompareError>>(
    scene: &Scene,
    options: &Options,
    control: &Control,
    mut tell: impl FnMut(Event<'_>) -> Result<(), E>,
) -> Result<Outcome, E> {
    let made = usize::from(matches!(options.reference, ReferenceChoice::Made(..)));
    let count = options.methods.len() + made;
    let stage = Stage { name: "reference", index: 0, count };
    let reference = reference(scene, options, control, |p| tell_progress(&mut tell, stage, p))?;
    let window = scene.film.window();
    let size = [window.width, window.height];
    check(&reference, size)?;
    tell(Event::Reference(&reference))?;
    let race = Race { scene, options, control, size, reference: &reference.pixels };
    let mut entrants = Vec::new();
    for (i, method) in options.methods.iter().enumerate() {
        if control.is_stopped() {
            break;
        }
        let stage = Stage { name: &method.name, index: i + made, count };
        let entrant = race.enter(method, stage, &mut tell)?;
        tell(Event::Done(&entrant))?;
        entrants.push(entrant);
    }
    Ok(Outcome { size, reference, entrants, stopped: control.is_stopped() })
}

/// Progress that cannot end anything: a session calls for it in the middle of its work.
fn tell_progress<E>(tell: &mut impl FnMut(Event<'_>) -> Result<(), E>, stage: Stage<'_>, p: &Progress) {
    let _ = tell(Event::Rendering(stage, p));
}

fn check(reference: &Reference, [width, height]: [u32; 2]) -> Result<(), CompareError> {
    if reference.pixels.len() as u64 != u64::from(width) * u64::from(height) {
        return Err(CompareError::Reference { width, height, found: reference.pixels.len() });
    }
    let image = Image::new(width, height, &reference.pixels)?;
    errors(image, image)?;
    Ok(())
}

/// What every method is given.
struct Race<'a> {
    scene: &'a Scene,
    options: &'a Options,
    control: &'a Control,
    size: [u32; 2],
    reference: &'a [Rgb],
}

impl Race<'_> {
    /// Renders by one method, and measures at several moments.
    fn enter<E: From<CompareError>>(
        &self,
        method: &Method,
        stage: Stage<'_>,
        tell: &mut impl FnMut(Event<'_>) -> Result<(), E>,
    ) -> Result<Entrant, E> {
        let session =
            session(self.scene, &method.settings, self.options.threads).map_err(CompareError::from)?;
        let budget = self.options.budget;
        let mut curve: Vec<CurvePoint> = Vec::new();
        let mut last: Option<(Report, Seen)> = None;
        for mark in marks(budget) {
            let (seconds, samples) = curve.last().map_or((0.0, 0.0), |p| (p.seconds, p.samples));
            let late = mark.time.is_some_and(|t| t.as_secs_f64() <= seconds);
            if late || samples >= f64::from(mark.samples) {
                continue;
            }
            let left = mark.time.map(|t| t.saturating_sub(Duration::from_secs_f64(seconds)));
            let report = session
                .run_for(Budget { time: left, ..mark }, self.control, |p| {
                    tell_progress(tell, stage, &overall(p, (seconds, 0), budget));
                })
                .map_err(CompareError::from)?;
            let seen = self.look(&session)?;
            let Errors { rel_mse, trimmed_rel_mse, .. } = seen.errors;
            let (seconds, samples) = (seconds + report.seconds, report.samples as f64);
            curve.push(CurvePoint { seconds, samples, rel_mse, trimmed_rel_mse });
            let stopped = report.stopped;
            last = Some((report, seen));
            if stopped {
                break;
            }
        }
        tell(Event::Measuring(stage))?;
        let last = last.ok_or(CompareError::Nothing)?;
        Ok(self.measured(method, &session, (curve, last))?)
    }

    /// The picture so far, and its errors.
    fn look(&self, session: &Session<'_>) -> Result<Seen, CompareError> {
        let picture = session.film().develop();
        let pixels = picture.combined(LightImage::On);
        let errors = errors(self.image(&pixels)?, self.image(self.reference)?)?;
        Ok(Seen { picture, pixels, errors })
    }

    fn image<'p>(&self, pixels: &'p [Rgb]) -> Result<Image<'p>, CompareError> {
        Ok(Image::new(self.size[0], self.size[1], pixels)?)
    }

    fn measured(
        &self,
        method: &Method,
        session: &Session<'_>,
        (curve, (report, seen)): (Vec<CurvePoint>, (Report, Seen)),
    ) -> Result<Entrant, CompareError> {
        let (image, reference) = (self.image(&seen.pixels)?, self.image(self.reference)?);
        // All are finite by now, so that only a black reference has no exposure to look at it by.
        let flip = flip::hdr(image, reference, &flip::Options::default()).ok();
        let relative_errors = relative_error_map(image, reference)?;
        let seconds = curve.last().map_or(0.0, |p| p.seconds);
        let samples_per_second = report.samples as f64 * seen.pixels.len() as f64 / seconds.max(1e-9);
        let report = Report { seconds, samples_per_second, ..report };
        Ok(Entrant {
            method: method.clone(),
            metadata: session.metadata(&report),
            picture: seen.picture,
            errors: seen.errors,
            relative_errors,
            report,
            flip,
            curve,
        })
    }
}

/// A picture at one moment, as it is compared.
struct Seen {
    picture: Picture,
    pixels: Vec<Rgb>,
    errors: Errors,
}

/// The budgets up to each moment, the last one the whole.
fn marks(whole: Budget) -> impl Iterator<Item = Budget> {
    (0..MOMENTS).rev().map(move |k| match whole.time {
        Some(time) => Budget { time: Some(time / (1 << k)), ..whole },
        None => Budget { samples: (whole.samples >> k).max(1), time: None },
    })
}

/// A part's progress as that of the whole, after so many seconds and samples of other sessions.
fn overall(p: &Progress, (seconds, samples): (f64, u64), whole: Budget) -> Progress {
    let elapsed = p.elapsed + Duration::from_secs_f64(seconds);
    let samples = p.samples + samples as f64;
    let by_samples = samples / f64::from(whole.samples);
    let by_time = whole.time.map_or(0.0, |t| elapsed.as_secs_f64() / t.as_secs_f64().max(1e-9));
    Progress { samples, total: whole.samples, fraction: by_samples.max(by_time).min(1.0), elapsed, ..*p }
}

fn session<'a>(
    scene: &'a Scene,
    settings: &Settings,
    threads: Option<usize>,
) -> Result<Session<'a>, RenderError> {
    let samples = u32::MAX;
    Session::new(
        scene,
        RenderOptions { settings: settings.clone(), samples, threads, ..RenderOptions::default() },
    )
}

/// The reference, in two halves of different seeds, whose difference tells its error.
fn reference(
    scene: &Scene,
    options: &Options,
    control: &Control,
    mut progress: impl FnMut(&Progress),
) -> Result<Reference, CompareError> {
    let (settings, budget) = match &options.reference {
        ReferenceChoice::Given(pixels, from) => {
            return Ok(Reference { from: from.clone(), pixels: pixels.clone(), made: None });
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
        let before = (seconds, samples);
        let report = session.run_for(half, control, |p| progress(&overall(p, before, budget)))?;
        seconds += report.seconds;
        samples += report.samples;
        halves.push((report.samples, session.film().develop().combined(LightImage::On)));
    }
    Reference::of_halves(scene, &halves, (samples, seconds))
}
