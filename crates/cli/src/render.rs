use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use caustica::description::{Description, Integrator};
use caustica::film::{Develop, check_writable, write_exr, write_png};
use caustica::scene::Diagnostic;
use caustica::session::{integrator_by_name, integrator_name};
use caustica::{Control, LightImage, Picture, RenderOptions, Report, Scene, Session, Settings};
use serde::Serialize;

use crate::args::{Method, Render};
use crate::failure::{Failure, show};
use crate::progress::Bar;
use crate::{loading, prompt, replay};

/// What `--json` prints.
#[derive(Serialize)]
struct Outcome<'a> {
    #[serde(flatten)]
    report: &'a Report,
    outputs: [String; 2],
    light_image: String,
    warnings: &'a [Diagnostic],
}

pub fn run(args: &Render) -> Result<ExitCode, Failure> {
    let (mut description, mut warnings) = loading::description(args.scene.as_deref())?;
    override_film(&mut description, args)?;
    let (asked, samples) = (description.integrator, description.samples);
    let (scene, more) = Scene::new(description)?;
    warnings.extend(more);
    let settings = settings(&args.method, &scene, asked);
    warnings.extend(setting_warnings(&args.method, &settings));
    if !args.json && !args.quiet {
        warnings.iter().for_each(show);
    }
    if let Some((pixel, sample)) = args.replay {
        return replay::run(&scene, settings, (pixel, sample), args.json);
    }
    let [exr, png] = outputs(args);
    check_writable(&exr).map_err(Failure::output)?;
    check_writable(&png).map_err(Failure::output)?;
    let options = RenderOptions {
        settings,
        samples: args.spp.unwrap_or(if args.time.is_some() { u32::MAX } else { samples.max(1) }),
        time: args.time,
        threads: args.threads.map(usize::from),
    };
    let session = Session::new(&scene, options)?;
    let report = session.run_with_bar(args)?;
    let picture = session.film().develop();
    let light_image = prompt::light_image(args.light_image);
    save(&session, (&picture, light_image), &report, (args, &exr, &png))?;
    tell(args, &report, light_image, ([&exr, &png], &warnings));
    Ok(ExitCode::SUCCESS)
}

/// `--resolution` and `--crop`.
fn override_film(description: &mut Description, args: &Render) -> Result<(), Failure> {
    let film = &mut description.film;
    if let Some((width, height)) = args.resolution {
        (film.width, film.height) = (width, height);
        film.crop = None;
    }
    if let Some(crop) = args.crop {
        let fits = |start: u32, size: u32, full: u32| start.checked_add(size).is_some_and(|end| end <= full);
        if !fits(crop.x, crop.width, film.width) || !fits(crop.y, crop.height, film.height) {
            return Err(Failure::Usage(format!(
                "the crop window reaches beyond the picture of {}x{} pixels",
                film.width, film.height
            )));
        }
        film.crop = Some(crop);
    }
    Ok(())
}

fn settings(method: &Method, scene: &Scene, asked: Integrator) -> Settings {
    let (_, radius) = scene.bounding_sphere();
    let (eye, forward) = (scene.camera.position().to_array(), scene.camera.forward().to_array());
    let named = method
        .integrator
        .as_deref()
        .and_then(|name| integrator_by_name(name, 2.0 * radius, eye, forward))
        // If the scene asks for the same, it may have set its parameters.
        .filter(|i| integrator_name(i) != integrator_name(&asked));
    Settings {
        integrator: named.unwrap_or(asked),
        max_depth: method.max_depth,
        roulette_start: method.roulette_depth,
        seed: method.seed,
        strategies: method.strategies.clone(),
        heuristic: method.heuristic.into(),
        exhaustive_weights: false,
    }
}

fn setting_warnings(method: &Method, settings: &Settings) -> Option<Diagnostic> {
    (settings.integrator != Integrator::Bdpt && !method.strategies.is_all()).then(|| {
        Diagnostic::warning("`--strategies` has no effect: only `bdpt` has strategies to choose from")
            .hint("add `--integrator bdpt`")
    })
}

/// The EXR and the PNG to write.
fn outputs(args: &Render) -> [PathBuf; 2] {
    let stem = match (&args.output, &args.scene) {
        (Some(output), _) => match output.extension().and_then(|e| e.to_str()) {
            Some("exr" | "png") => output.with_extension(""),
            _ => output.clone(),
        },
        (None, Some(scene)) => scene.with_extension(""),
        (None, None) => PathBuf::from("caustica"),
    };
    let with = |extension: &str| {
        let mut name = stem.clone().into_os_string();
        name.push(extension);
        PathBuf::from(name)
    };
    [with(".exr"), with(".png")]
}

/// Running a session for the command line.
trait RunWithBar {
    fn run_with_bar(&self, args: &Render) -> Result<Report, Failure>;
}

impl RunWithBar for Session<'_> {
    fn run_with_bar(&self, args: &Render) -> Result<Report, Failure> {
        let control = Arc::new(Control::default());
        let interrupts = Arc::new(AtomicU32::new(0));
        let handler = {
            let (control, interrupts) = (Arc::clone(&control), Arc::clone(&interrupts));
            ctrlc::set_handler(move || {
                control.stop();
                if interrupts.fetch_add(1, Ordering::SeqCst) > 0 {
                    std::process::exit(130);
                }
            })
        };
        let bar = Bar::new(args.quiet || args.json);
        if let Err(e) = handler {
            bar.note(&format!("Ctrl-C will not be heard: {e}"));
        }
        let mut told = false;
        let report = self.run(&control, |p| {
            if control.is_stopped() && !told {
                told = true;
                bar.note("stopping after this pass; Ctrl-C again stops at once, without a picture");
            }
            bar.show(p);
        })?;
        bar.finish();
        Ok(report)
    }
}

fn save(
    session: &Session<'_>,
    (picture, light_image): (&Picture, LightImage),
    report: &Report,
    (args, exr, png): (&Render, &Path, &Path),
) -> Result<(), Failure> {
    let mut metadata = session.metadata(report);
    let scene = args.scene.as_deref().and_then(Path::file_name).map(|n| n.to_string_lossy().into_owned());
    metadata.set("scene", scene.unwrap_or_else(|| "built-in".to_owned()));
    write_exr(exr, picture, light_image, &metadata).map_err(Failure::output)?;
    let develop = Develop { exposure: args.look.exposure, tone_map: args.look.tone_map };
    let window = picture.window;
    write_png(png, window.width, window.height, &picture.combined(light_image), develop)
        .map_err(Failure::output)
}

fn tell(
    args: &Render,
    report: &Report,
    light_image: LightImage,
    ([exr, png], warnings): ([&PathBuf; 2], &[Diagnostic]),
) {
    let outputs = [exr.display().to_string(), png.display().to_string()];
    if args.json {
        let outcome = Outcome { report, outputs, light_image: light_image.to_string(), warnings };
        println!("{}", serde_json::json!(outcome));
        return;
    }
    if args.quiet {
        return;
    }
    println!(
        "{}: {} samples per pixel in {:.1} s ({:.2} M samples/s on {} threads){}",
        report.integrator,
        report.samples,
        report.seconds,
        report.samples_per_second * 1e-6,
        report.threads,
        if report.stopped { ", stopped early" } else { "" },
    );
    if report.invalid + report.clamped > 0 {
        println!(
            "{} contributions were not finite and {} too large for the film; they are left out",
            report.invalid, report.clamped
        );
    }
    println!("wrote {} and {}", outputs[0], outputs[1]);
}
