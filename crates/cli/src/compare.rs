//! `caustica compare`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use caustica::description::Integrator;
use caustica::film::{LightImage, Metadata, Window, check_writable, write_exr, write_layers};
use caustica::session::Budget;
use caustica::{Rgb, Scene, import};
use caustica_compare::{CompareError, EYE_ONLY, Method, Options, Outcome, ReferenceChoice, compare};
use caustica_report::{Comparison, ReportError, write_comparison};
use serde::Serialize;

use crate::args::Compare;
use crate::console::Console;
use crate::failure::Failure;
use crate::interrupt::Interrupts;
use crate::loading;
use crate::progress::Bar;
use crate::render::integrator;

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
    let scene = &opened.scene;
    let folder = args.output.clone().unwrap_or_else(|| args.source.beside("-compare"));
    let page = folder.join("index.html");
    fs::create_dir_all(&folder).map_err(|e| unwritable(&folder, &e))?;
    check_writable(&page).map_err(|e| Failure::output(&page, e))?;
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
    let interrupts = Interrupts::listen();
    let bar = Bar::new(console.is_talkative());
    let outcome = compare(scene, &options, &interrupts.control, |stage, p| {
        bar.show_stage(&format!("{} ({}/{})", stage.name, stage.index + 1, stage.count), p);
    });
    bar.finish();
    let outcome = outcome.map_err(failure)?;
    let title = format!("{}: integrators compared", args.source.name());
    let comparison =
        outcome.page(&title, &args.source.name(), notes(args, scene, budget)).map_err(failure)?;
    let outputs = save_pictures(&outcome, scene, (&folder, args))?;
    write_comparison(&comparison, &folder).map_err(|e| report_failure(&folder, e))?;
    let told = Told { page: page.display().to_string(), outputs, comparison: &comparison };
    console.result(&told, || summary(&told))?;
    Ok(ExitCode::SUCCESS)
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
    let name = path.file_stem().map_or_else(|| "reference".into(), |n| n.to_string_lossy().into_owned());
    Ok(ReferenceChoice::Given(image.pixels.to_vec(), name))
}

fn notes(args: &Compare, scene: &Scene, budget: Budget) -> Vec<(String, String)> {
    let window = scene.film.window();
    let each = match budget.time {
        Some(time) => format!("{} s", time.as_secs_f64()),
        None => format!("{} samples a pixel", budget.samples),
    };
    let threads = args
        .source
        .threads
        .map_or_else(|| std::thread::available_parallelism().map_or(1, usize::from), usize::from);
    let depth = args.sampling.max_depth.map_or_else(|| "no limit".to_owned(), |d| d.to_string());
    [
        ("size", format!("{} × {} pixels", window.width, window.height)),
        ("each integrator", each),
        ("threads", threads.to_string()),
        ("most edges of a path", depth),
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
    ]
    .map(|(name, value)| (name.to_owned(), value))
    .into()
}

/// Writes every picture as `NAME.exr`, and a reference that was made.
fn save_pictures(
    outcome: &Outcome,
    scene: &Scene,
    (folder, args): (&Path, &Compare),
) -> Result<Vec<String>, Failure> {
    let mut written: Vec<PathBuf> = Vec::new();
    for entrant in &outcome.entrants {
        let path = folder.join(format!("{}.exr", entrant.method.name));
        let mut metadata = entrant.metadata.clone();
        metadata.set("scene", args.source.name());
        write_exr(&path, &entrant.picture, LightImage::On, &metadata)
            .map_err(|e| Failure::output(&path, e))?;
        written.push(path);
    }
    if let Some((samples, seconds)) = outcome.reference.made {
        let path = folder.join("reference.exr");
        let mut metadata = Metadata::new();
        metadata.set("scene", args.source.name());
        metadata.set("integrator", "bdpt");
        metadata.set("samples", samples);
        metadata.set("seconds", format!("{seconds:.3}"));
        let (film, w) = (&scene.film, scene.film.window());
        let window = Window { x: w.x, y: w.y, width: w.width, height: w.height };
        let layers: [(&str, &[Rgb]); 1] = [("combined", &outcome.reference.pixels)];
        write_layers(&path, [film.width, film.height], window, (&layers, &metadata))
            .map_err(|e| Failure::output(&path, e))?;
        written.push(path);
    }
    Ok(written.iter().map(|p| p.display().to_string()).collect())
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
    for s in &told.comparison.speedups {
        text += &format!("{} reaches {}'s error {:.1} times sooner\n", s.faster, s.slower, s.factor);
    }
    text + &format!("wrote {}", told.page)
}

fn failure(e: CompareError) -> Failure {
    match e {
        CompareError::Render(e) => e.into(),
        other => Failure::Usage(other.to_string()),
    }
}

fn unwritable(folder: &Path, e: &std::io::Error) -> Failure {
    Failure::Output(format!("cannot make the folder `{}`: {e}", folder.display()))
}

/// What went wrong in writing a page.
pub fn report_failure(to: &Path, e: ReportError) -> Failure {
    Failure::Output(format!("cannot write the page in `{}`: {e}", to.display()))
}
