//! `caustica compare`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use caustica::description::Integrator;
use caustica::film::{LightImage, Metadata, Window, check_writable, write_exr, write_layers};
use caustica::scene::Diagnostic;
use caustica::session::{Budget, available_threads};
use caustica::{Rgb, Scene, import};
use caustica_compare::{
    CompareError, EYE_ONLY, Entrant, Event, Made, Method, Options, Outcome, Reference, ReferenceChoice,
    Stage, compare,
};
use caustica_report::{Comparison, ReportError, write_comparison};
use serde::Serialize;

use crate::args::Compare;
use crate::console::Console;
use crate::failure::Failure;
use crate::interrupt::Interrupts;
use crate::loading;
use crate::progress::Bar;
use crate::render::{integrator, loss_warnings};

/// How long each integrator renders if nobody says.
const TIME: Duration = Duration::from_secs(30);

/// How many times as long the reference renders, if nobody says.
const REFERENCE: u32 = 10;

/// What `--json` prints, beside warnings.
#[derive(Serialize)]
struct Told<'a> {
    page: String,
    outputs: Vec<String>,
    #[serde(flatten)]
    comparison: &'a Comparison,
}

pub fn run(args: &Compare, console: &mut Console) -> Result<ExitCode, Failure> {
    let opened = loading::open(&args.source, console)?;
    let args = &Compare { sampling: args.sampling.or(opened.depths).suited(&opened.scene), ..args.clone() };
    let scene = &opened.scene;
    let folder = args.output.clone().unwrap_or_else(|| args.source.beside("-compare"));
    let page = folder.join("index.html");
    let budget = Budget {
        samples: args.spp.unwrap_or(u32::MAX),
        time: args.time.or(if args.spp.is_none() { Some(TIME) } else { None }),
    };
    let options = Options {
        methods: methods(args, scene),
        budget,
        reference: reference(args, scene, budget, console)?,
        threads: args.source.threads.map(usize::from),
    };
    fs::create_dir_all(&folder).map_err(|e| unwritable(&folder, &e))?;
    for file in files(&folder, &options) {
        check_writable(&file).map_err(|e| Failure::output(&file, e))?;
    }
    let outcome = render(args, scene, &folder, (&options, console))?;
    let name = args.source.name();
    let comparison =
        outcome.page(&format!("{name}: integrators compared"), &name, notes(args, scene, budget))?;
    write_comparison(&comparison, &folder).map_err(|e| report_failure(&folder, e))?;
    let outputs = files(&folder, &options).iter().map(|p| p.display().to_string()).collect();
    let told = Told { page: page.display().to_string(), outputs, comparison: &comparison };
    console.result(&told, || summary(&told))?;
    Ok(ExitCode::SUCCESS)
}

/// The files that are written.
fn files(folder: &Path, options: &Options) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = options.methods.iter().map(|m| picture(folder, &m.name)).collect();
    if matches!(options.reference, ReferenceChoice::Made(..)) {
        files.push(picture(folder, "reference"));
    }
    files.extend([folder.join("report.json"), folder.join("index.html")]);
    files
}

fn picture(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.exr"))
}

/// Renders everything, and writes each picture as soon as it is there.
fn render(
    args: &Compare,
    scene: &Scene,
    folder: &Path,
    (options, console): (&Options, &mut Console),
) -> Result<Outcome, Failure> {
    let interrupts = Interrupts::listen();
    let bar = Bar::new(console.is_talkative());
    let title = |s: Stage<'_>| format!("{} ({}/{})", s.name, s.index + 1, s.count);
    let mut lost = Vec::new();
    let outcome = compare(scene, options, &interrupts.control, |event| {
        bar.tell_stop(&interrupts.control);
        match event {
            Event::Rendering(stage, p) => bar.show_stage(&title(stage), p),
            Event::Measuring(stage) => bar.show_measuring(&title(stage)),
            Event::Reference(reference) => save_reference(reference, scene, folder, args)?,
            Event::Done(entrant) => {
                let (invalid, clamped) = (entrant.report.invalid, entrant.report.clamped);
                lost.extend(loss_warnings(&entrant.method.name, (invalid, clamped)));
                save_picture(entrant, folder, args)?;
            }
        }
        Ok::<_, Failure>(())
    });
    bar.finish();
    console.warn(lost);
    outcome
}

fn methods(args: &Compare, scene: &Scene) -> Vec<Method> {
    let base = args.sampling.settings(Integrator::Bdpt);
    let mut names: Vec<&String> = Vec::new();
    for name in &args.integrators {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let by_name = |name: &&String| match name.as_str() {
        EYE_ONLY => Some(Method::eye_only(&base)),
        name => integrator(name, scene).map(|i| Method::new(i, &base)),
    };
    names.iter().filter_map(by_name).collect()
}

fn reference(
    args: &Compare,
    scene: &Scene,
    budget: Budget,
    console: &mut Console,
) -> Result<ReferenceChoice, Failure> {
    let Some(path) = &args.reference else {
        let settings = args.sampling.settings(Integrator::Bdpt);
        let made = match (args.reference_time, budget.time) {
            (Some(time), _) => Budget { samples: u32::MAX, time: Some(time) },
            (None, Some(time)) => Budget { samples: u32::MAX, time: Some(time * REFERENCE) },
            (None, None) => Budget { samples: budget.samples.saturating_mul(REFERENCE), time: None },
        };
        return Ok(ReferenceChoice::Made(settings, made));
    };
    let read = import::read_image(path)?;
    console.warn(read.warnings);
    let (image, window) = (read.image, scene.film.window());
    if (image.width, image.height) != (window.width, window.height) {
        return Err(Failure::Usage(format!(
            "the reference `{}` has {} × {} pixels, but the picture has {} × {}",
            path.display(),
            image.width,
            image.height,
            window.width,
            window.height
        )));
    }
    Ok(ReferenceChoice::Given(image.pixels.to_vec(), path.display().to_string()))
}

fn notes(args: &Compare, scene: &Scene, budget: Budget) -> Vec<(String, String)> {
    let window = scene.film.window();
    let each = match budget.time {
        Some(time) => format!("{} s", time.as_secs_f64()),
        None => format!("{} samples a pixel", budget.samples),
    };
    let threads = args.source.threads.map_or_else(available_threads, usize::from);
    let mut notes: Vec<(String, String)> = [
        ("size", format!("{} × {} pixels", window.width, window.height)),
        ("each integrator", each),
        ("threads", threads.to_string()),
    ]
    .map(|(name, value)| (name.to_owned(), value))
    .into();
    notes.extend(args.sampling.notes());
    notes
}

fn save_picture(entrant: &Entrant, folder: &Path, args: &Compare) -> Result<(), Failure> {
    let path = picture(folder, &entrant.method.name);
    let mut metadata = entrant.metadata.clone();
    metadata.set("scene", args.source.name());
    write_exr(&path, &entrant.picture, LightImage::On, &metadata).map_err(|e| Failure::output(&path, e))
}

/// Writes a reference that was made here.
fn save_reference(
    reference: &Reference,
    scene: &Scene,
    folder: &Path,
    args: &Compare,
) -> Result<(), Failure> {
    let Some(Made { samples, seconds, .. }) = reference.made else { return Ok(()) };
    let path = picture(folder, "reference");
    let mut metadata = Metadata::new();
    metadata.set("scene", args.source.name());
    metadata.set("integrator", "bdpt");
    metadata.set("samples", samples);
    metadata.set("seconds", format!("{seconds:.3}"));
    metadata.set("version", env!("CARGO_PKG_VERSION"));
    let (film, w) = (&scene.film, scene.film.window());
    let window = Window { x: w.x, y: w.y, width: w.width, height: w.height };
    let layers: [(&str, &[Rgb]); 1] = [("combined", &reference.pixels)];
    write_layers(&path, [film.width, film.height], window, (&layers, &metadata))
        .map_err(|e| Failure::output(&path, e))
}

fn summary(told: &Told<'_>) -> String {
    let mut text = format!(
        "{:<10} {:>9} {:>9} {:>11} {:>11} {:>8} {:>7}\n",
        "", "samples", "seconds", "relMSE", "trimmed", "FLIP", "slope"
    );
    let figure =
        |x: Option<f64>, digits: usize| x.map_or_else(|| "–".to_owned(), |x| format!("{x:.digits$}"));
    let small = |x: Option<f64>| x.map_or_else(|| "–".to_owned(), |x| format!("{x:.3e}"));
    for e in &told.comparison.entries {
        let m = &e.metrics;
        text += &format!(
            "{:<10} {:>9} {:>9.1} {:>11} {:>11} {:>8} {:>7}\n",
            e.shown.name,
            m.samples,
            m.seconds,
            small(m.rel_mse),
            small(m.trimmed_rel_mse),
            figure(m.flip, 4),
            figure(e.slope, 2)
        );
    }
    for s in told.comparison.speedups.iter().filter(|s| s.factor > 1.0) {
        let more = if s.at_least { "more than " } else { "" };
        text += &format!("{} reaches {}'s error {more}{:.1} times sooner\n", s.faster, s.slower, s.factor);
    }
    text + &format!("wrote {}", told.page)
}

impl From<CompareError> for Failure {
    fn from(e: CompareError) -> Self {
        match e {
            CompareError::Render(e) => e.into(),
            CompareError::Metrics(e) => Diagnostic::error(e.to_string()).into(),
            other => Self::Usage(other.to_string()),
        }
    }
}

fn unwritable(folder: &Path, e: &std::io::Error) -> Failure {
    Failure::Output(format!("cannot make the folder `{}`: {e}", folder.display()))
}

/// What went wrong in writing a page.
pub fn report_failure(to: &Path, e: ReportError) -> Failure {
    Failure::Output(format!("cannot write the page in `{}`: {e}", to.display()))
}
