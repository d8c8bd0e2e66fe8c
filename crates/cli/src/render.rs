use std::path::Path;
use std::process::ExitCode;

use caustica::description::{Integrator, Layer};
use caustica::film::{Channel, FilmFacts, Provenance, write_exr, write_png};
use caustica::scene::Diagnostic;
use caustica::scene::camera::Joins;
use caustica::session::{Stages, content_hash, integrator_by_name, integrator_name, provenance};
use caustica::transport::suited_light_paths;
use caustica::{LightImage, Picture, Progress, RenderOptions, Report, Scene, Session, Settings};
use serde::Serialize;

use crate::args::{LightImageChoice, Look, Method, Render};
use crate::checkpoint::{self, Checkpoint};
use crate::console::Console;
use crate::failure::Failure;
use crate::interrupt::Interrupts;
use crate::loading::{self, Depths};
use crate::outputs::{Outputs, check_replaceable};
use crate::progress::Bar;
use crate::{prompt, replay};

/// `--layers` with a film.
const NO_LAYERS: &str = "films hold no layers: use `--layers` when the picture is written. `caustica render SCENE \
    --checkpoint FILM --resume --layers …` makes one of a film";

/// What `--json` prints, beside warnings.
#[derive(Serialize)]
struct Outcome<'a> {
    #[serde(flatten)]
    report: &'a Report,
    /// The first sample of each pixel, and the one after the last.
    range: [u64; 2],
    /// Width and height of the full picture.
    resolution: [u32; 2],
    /// The part of it that was rendered: x, y, width, height.
    window: [u32; 4],
    outputs: Vec<String>,
    /// What became of the light image in the picture, if there is one.
    light_image: Option<String>,
}

pub fn run(args: &Render, console: &mut Console) -> Result<ExitCode, Failure> {
    let (opened, hash) = loading::open_with(&args.source, console, content_hash)?;
    let scene = opened.scene;
    let settings = settings(&args.method, &scene, (opened.integrator, opened.depths));
    let layers = args.layers.clone().map_or(opened.layers, |list| list.0);
    if let Some(sample) = args.replay {
        return replay::run(&scene, settings, sample, console);
    }
    let outputs = Outputs::new(args)?;
    if matches!((&outputs, &args.layers), (Outputs::Film(_), Some(list)) if !list.0.is_empty()) {
        return Err(Failure::Usage(NO_LAYERS.into()));
    }
    let of = provenance(&args.source.name(), &hash, &settings);
    let (checkpoint, record) = Checkpoint::open(&args.checkpoint)?.unzip();
    let options = options(args, settings, opened.samples);
    let wanted =
        u64::from(options.first_sample)..u64::from(options.first_sample) + u64::from(options.samples);
    let session = checkpoint::session(&scene, options, (record.flatten(), &of))?;
    if let Outputs::Pictures { .. } = &outputs {
        session.check_layers(&layers)?;
    }
    if let (Outputs::Film(path), false) = (&outputs, args.force) {
        let facts = FilmFacts { samples: wanted.into(), ..session.facts(&of, 0.0) };
        check_replaceable(path, (session.film().layout(), &facts))?;
    }
    console.warn(setting_warnings(args, &session));
    let interrupts = Interrupts::listen();
    let checkpoint = checkpoint.as_ref();
    let report = run_with_bar(&session, args.noise, (&interrupts, console), checkpoint.map(|c| (c, &of)))?;
    let kept = checkpoint.map_or(Ok(()), |c| c.write(&session, (&of, &report)));
    let written = save_all(&session, (&of, &report), (args, &outputs, &layers), &interrupts);
    // If either is there, nothing is lost.
    let light_image = match (written, kept) {
        (Ok(light_image), Ok(())) => light_image,
        (Err(failure), kept) if kept.is_err() || checkpoint.is_none() => {
            return Err(checkpoint::rescue(failure, &session, (&of, &report)));
        }
        (Err(failure), _) | (_, Err(failure)) => return Err(failure),
    };
    tell(console, &session, &report, (&outputs, light_image))?;
    Ok(ExitCode::SUCCESS)
}

/// Writes what was asked for. Tells what became of the light image, if a picture is written.
fn save_all(
    session: &Session<'_>,
    what: (&Provenance, &Report),
    (args, outputs, layers): (&Render, &Outputs, &[Layer]),
    interrupts: &Interrupts,
) -> Result<Option<LightImage>, Failure> {
    match outputs {
        Outputs::Film(path) => checkpoint::write_output(path, session, what).map(|()| None),
        Outputs::Pictures { exr, png } => {
            save(session, what.1, (args, [exr, png], layers), interrupts).map(Some)
        }
    }
}

/// What is rendered, where the scene asks for `usual` samples.
fn options(args: &Render, settings: Settings, usual: u32) -> RenderOptions {
    let (first_sample, samples) = match (args.samples, args.noise, args.length.spp) {
        (Some((start, end)), ..) => (start, end - start),
        (None, Some(_), None) => (0, u32::MAX),
        _ => (0, args.length.samples(usual)),
    };
    let threads = args.source.threads.map(usize::from);
    RenderOptions { settings, first_sample, samples, time: args.length.time, threads }
}

/// The settings that the arguments ask for; the scene's own integrator and depths if they name none.
pub fn settings(method: &Method, scene: &Scene, (asked, depths): (Integrator, Depths)) -> Settings {
    let named = method
        .integrator
        .as_deref()
        .and_then(|name| integrator(name, scene))
        // If the scene asks for the same, it may have set its parameters.
        .filter(|i| integrator_name(i) != integrator_name(&asked));
    let sampling = method.sampling.or(depths);
    let strategies = method.strategies.clone();
    let mut settings = Settings { strategies, ..sampling.settings(named.unwrap_or(asked)) };
    if settings.integrator == Integrator::Bdpt && sampling.shared_light_paths.is_none() {
        settings.shared_light_paths = suited_light_paths(scene, &settings);
    }
    settings
}

/// The integrator of that name, with parameters that suit the scene.
pub fn integrator(name: &str, scene: &Scene) -> Option<Integrator> {
    let (_, radius) = scene.bounding_sphere();
    let (eye, forward) = (scene.camera.position().to_array(), scene.camera.forward().to_array());
    integrator_by_name(name, 2.0 * radius, eye, forward)
}

/// `--strategies` without `bdpt`.
pub fn strategy_warning(method: &Method, integrator: &Integrator) -> Option<Diagnostic> {
    let useless = *integrator != Integrator::Bdpt && !method.strategies.is_all();
    let name = integrator_name(integrator);
    useless.then(|| {
        Diagnostic::warning(format!("`--strategies` has no effect on `{name}`"))
            .hint("only `bdpt` has strategies to choose from: add `--integrator bdpt`")
    })
}

/// What was left out of a film or cut, if anything was.
pub fn loss_warnings(what: &str, (invalid, clamped): (u64, u64)) -> Vec<Diagnostic> {
    let warning =
        |n: u64, why: &str| (n > 0).then(|| Diagnostic::warning(format!("{what}: {n} contributions {why}")));
    let left_out = warning(invalid, "were not finite numbers and are left out");
    left_out.into_iter().chain(warning(clamped, "were too large for the film and are cut")).collect()
}

/// Options that do not do what was probably meant.
fn setting_warnings(args: &Render, session: &Session<'_>) -> Vec<Diagnostic> {
    let integrator = session.kernel().settings().integrator;
    let name = integrator_name(&integrator);
    let mut warnings: Vec<Diagnostic> = strategy_warning(&args.method, &integrator).into_iter().collect();
    let black = match args.light_image {
        LightImageChoice::Only => !session.kernel().has_light_image(),
        LightImageChoice::Off => integrator == Integrator::Light,
        LightImageChoice::On | LightImageChoice::Ask => false,
    };
    if black {
        let image = if integrator == Integrator::Light { "eye" } else { "light" };
        warnings.push(
            Diagnostic::warning(format!("`{name}` makes no {image} image here: the picture will be black"))
                .hint("use `--light-image on`"),
        );
    }
    if integrator == Integrator::Light && session.kernel().scene().camera.joins() == Joins::Nothing {
        warnings.push(
            Diagnostic::warning("no light path meets a camera of one ray: the picture will be black")
                .hint("use `--integrator path` or `bdpt`"),
        );
    }
    warnings
}

fn run_with_bar(
    session: &Session<'_>,
    noise: Option<f64>,
    (interrupts, console): (&Interrupts, &Console),
    kept: Option<(&Checkpoint, &Provenance)>,
) -> Result<Report, Failure> {
    let bar = Bar::new(console.is_talkative());
    let stages = Stages { noise, every: kept.map(|(checkpoint, _)| checkpoint.every) };
    let progress = |p: &Progress| {
        bar.tell_stop(&interrupts.control);
        bar.show(p);
    };
    let save = |report: &Report| {
        let note = kept.and_then(|(checkpoint, of)| checkpoint.try_write(session, (of, report)));
        if let Some(note) = note {
            bar.note(&note);
        }
    };
    let report = session.run_in_stages(&stages, &interrupts.control, (progress, save));
    bar.finish();
    Ok(report?)
}

/// Writes both files. The EXR holds all layers whatever becomes of the light image, so that it is written
/// before anyone is asked: waiting for an answer must not cost the work of hours.
fn save(
    session: &Session<'_>,
    report: &Report,
    (args, [exr, png], layers): (&Render, [&Path; 2], &[Layer]),
    interrupts: &Interrupts,
) -> Result<LightImage, Failure> {
    let mut metadata = session.metadata(report);
    metadata.set("scene", args.source.name());
    let plain = session.film().develop();
    let channels = beside(session, layers, || {
        let light_image = prompt::light_image(args.light_image, false);
        write_exr(exr, &plain, light_image, &metadata).map_err(|e| Failure::output(exr, e))?;
        save_png(png, &plain, light_image, args.look)
    })?;
    let picture = &Picture { channels, ..plain };
    let save_exr =
        |light_image| write_exr(exr, picture, light_image, &metadata).map_err(|e| Failure::output(exr, e));
    if args.light_image == LightImageChoice::Ask {
        save_exr(LightImage::On)?;
        interrupts.stop_at_once();
    }
    let light_image = prompt::light_image(args.light_image, picture.light_samples > 0);
    if args.light_image != LightImageChoice::Ask || light_image != LightImage::On {
        save_exr(light_image)?;
    }
    save_png(png, picture, light_image, args.look)?;
    Ok(light_image)
}

/// The layers beside a picture. It is kept without them first: they take a while, and may fail.
fn beside(
    session: &Session<'_>,
    layers: &[Layer],
    keep: impl FnOnce() -> Result<(), Failure>,
) -> Result<Vec<Channel>, Failure> {
    if layers.is_empty() {
        return Ok(Vec::new());
    }
    keep()?;
    let failed = |e| Failure::Output(format!("the picture is written without its layers: {e}"));
    session.layers(layers).map_err(failed)
}

/// Writes what a picture looks like.
pub fn save_png(to: &Path, picture: &Picture, light_image: LightImage, look: Look) -> Result<(), Failure> {
    let window = picture.window;
    write_png(to, window.width, window.height, &picture.combined(light_image), look.develop())
        .map_err(|e| Failure::output(to, e))
}

fn tell(
    console: &Console,
    session: &Session<'_>,
    report: &Report,
    (outputs, light_image): (&Outputs, Option<LightImage>),
) -> Result<(), Failure> {
    let layout = session.film().layout();
    let (w, range) = (layout.window, session.range());
    let outcome = Outcome {
        report,
        range: [range.start, range.end],
        resolution: [layout.width, layout.height],
        window: [w.x, w.y, w.width, w.height],
        outputs: outputs.files().iter().map(|p| p.display().to_string()).collect(),
        light_image: light_image.map(|l| l.to_string()),
    };
    console.result(&outcome, || summary(&outcome))
}

fn summary(outcome: &Outcome<'_>) -> String {
    let Outcome { report, range: [start, end], outputs, .. } = outcome;
    let plural = |n: u64| if n == 1 { "" } else { "s" };
    let range = if *start == 0 { String::new() } else { format!(" ({start}..{end})") };
    let mut text = format!(
        "{}: {} sample{} per pixel{range} in {:.1} s ({:.2} M samples/s on {} thread{}){}\n",
        report.integrator,
        report.samples,
        plural(report.samples),
        report.seconds,
        report.samples_per_second * 1e-6,
        report.threads,
        plural(report.threads as u64),
        if report.stopped { ", stopped early" } else { "" },
    );
    if let Some(noise) = report.noise {
        text += &format!("error of a typical pixel: {:.2} % (95 % certain)\n", 100.0 * noise);
    }
    if report.invalid > 0 {
        text += &format!("{} contributions were not finite numbers and are left out\n", report.invalid);
    }
    if report.clamped > 0 {
        text += &format!("{} contributions were too large for the film and are cut\n", report.clamped);
    }
    text + &format!("wrote {}", outputs.join(" and "))
}
