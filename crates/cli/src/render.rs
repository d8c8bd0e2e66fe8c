use std::path::Path;
use std::process::ExitCode;

use caustica::description::Integrator;
use caustica::film::{write_exr, write_png};
use caustica::scene::Diagnostic;
use caustica::session::{integrator_by_name, integrator_name};
use caustica::{LightImage, Picture, RenderOptions, Report, Scene, Session, Settings};
use serde::Serialize;

use crate::args::{LightImageChoice, Look, Method, Render};
use crate::console::Console;
use crate::failure::Failure;
use crate::interrupt::Interrupts;
use crate::outputs::Outputs;
use crate::progress::Bar;
use crate::{loading, prompt, replay};

/// What `--json` prints, beside warnings.
#[derive(Serialize)]
struct Outcome<'a> {
    #[serde(flatten)]
    report: &'a Report,
    /// Width and height of the full picture.
    resolution: [u32; 2],
    /// The part of it that was rendered: x, y, width, height.
    window: [u32; 4],
    outputs: [String; 2],
    light_image: String,
}

pub fn run(args: &Render, console: &mut Console) -> Result<ExitCode, Failure> {
    let opened = loading::open(&args.source, console)?;
    let (scene, samples) = (opened.scene, opened.samples);
    let settings = settings(&args.method, &scene, opened.integrator);
    if let Some(sample) = args.replay {
        return replay::run(&scene, settings, sample, console);
    }
    let outputs = Outputs::new(args)?;
    let options = RenderOptions {
        settings,
        samples: args.length.samples(samples),
        time: args.length.time,
        threads: args.source.threads.map(usize::from),
    };
    let session = Session::new(&scene, options)?;
    console.warn(setting_warnings(args, &session));
    let interrupts = Interrupts::listen();
    let report = run_with_bar(&session, &interrupts, console)?;
    let picture = session.film().develop();
    let light_image = save(&session, &picture, &report, (args, &outputs), &interrupts)?;
    tell(console, (&picture, light_image), &report, &outputs)?;
    Ok(ExitCode::SUCCESS)
}

/// The settings that the arguments ask for; the scene's own integrator if they name none.
pub fn settings(method: &Method, scene: &Scene, asked: Integrator) -> Settings {
    let named = method
        .integrator
        .as_deref()
        .and_then(|name| integrator(name, scene))
        // If the scene asks for the same, it may have set its parameters.
        .filter(|i| integrator_name(i) != integrator_name(&asked));
    Settings { strategies: method.strategies.clone(), ..method.sampling.settings(named.unwrap_or(asked)) }
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
    warnings
}

fn run_with_bar(
    session: &Session<'_>,
    interrupts: &Interrupts,
    console: &Console,
) -> Result<Report, Failure> {
    let bar = Bar::new(console.is_talkative());
    let report = session.run(&interrupts.control, |p| {
        bar.tell_stop(&interrupts.control);
        bar.show(p);
    });
    bar.finish();
    Ok(report?)
}

/// Writes both files. The EXR holds all layers whatever becomes of the light image, so that it is written
/// before anyone is asked: waiting for an answer must not cost the work of hours.
fn save(
    session: &Session<'_>,
    picture: &Picture,
    report: &Report,
    (args, outputs): (&Render, &Outputs),
    interrupts: &Interrupts,
) -> Result<LightImage, Failure> {
    let mut metadata = session.metadata(report);
    metadata.set("scene", args.source.name());
    let save_exr = |light_image| {
        write_exr(&outputs.exr, picture, light_image, &metadata).map_err(|e| Failure::output(&outputs.exr, e))
    };
    if args.light_image == LightImageChoice::Ask {
        save_exr(LightImage::On)?;
        interrupts.stop_at_once();
    }
    let light_image = prompt::light_image(args.light_image, picture.light_samples > 0);
    if args.light_image != LightImageChoice::Ask || light_image != LightImage::On {
        save_exr(light_image)?;
    }
    save_png(&outputs.png, picture, light_image, args.look)?;
    Ok(light_image)
}

/// Writes what a picture looks like.
pub fn save_png(to: &Path, picture: &Picture, light_image: LightImage, look: Look) -> Result<(), Failure> {
    let window = picture.window;
    write_png(to, window.width, window.height, &picture.combined(light_image), look.develop())
        .map_err(|e| Failure::output(to, e))
}

fn tell(
    console: &Console,
    (picture, light_image): (&Picture, LightImage),
    report: &Report,
    outputs: &Outputs,
) -> Result<(), Failure> {
    let w = picture.window;
    let outcome = Outcome {
        report,
        resolution: [picture.width, picture.height],
        window: [w.x, w.y, w.width, w.height],
        outputs: [&outputs.exr, &outputs.png].map(|p| p.display().to_string()),
        light_image: light_image.to_string(),
    };
    console.result(&outcome, || summary(&outcome))
}

fn summary(outcome: &Outcome<'_>) -> String {
    let Outcome { report, outputs: [exr, png], .. } = outcome;
    let plural = |n: u64| if n == 1 { "" } else { "s" };
    let mut text = format!(
        "{}: {} sample{} per pixel in {:.1} s ({:.2} M samples/s on {} thread{}){}\n",
        report.integrator,
        report.samples,
        plural(report.samples),
        report.seconds,
        report.samples_per_second * 1e-6,
        report.threads,
        plural(report.threads as u64),
        if report.stopped { ", stopped early" } else { "" },
    );
    if report.invalid > 0 {
        text += &format!("{} contributions were not finite numbers and are left out\n", report.invalid);
    }
    if report.clamped > 0 {
        text += &format!("{} contributions were too large for the film and are cut\n", report.clamped);
    }
    text + &format!("wrote {exr} and {png}")
}
