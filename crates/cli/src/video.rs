//! `caustica video`.

use std::ffi::OsStr;
use std::path::PathBuf;
use std::process::ExitCode;

use caustica::description::Integrator;
use caustica::film::check_writable;
use caustica::scene::Diagnostic;
use caustica::session::integrator_name;
use caustica::transport::Kernel;
use caustica::{Progress, RenderOptions, Scene, Settings, Vec3};
use caustica_clips::{
    ClipError, ClipOptions, Converge, Layout, Orbit, PyramidClip, Step, converge, orbit, pyramid,
};
use caustica_video::VideoError;
use serde::Serialize;

use crate::args::{self, Clip, Video};
use crate::console::Console;
use crate::failure::Failure;
use crate::interrupt::Interrupts;
use crate::loading::{self, Opened};
use crate::progress::Bar;
use crate::render::{settings, strategy_warning};

/// What `--json` prints, beside warnings.
#[derive(Serialize)]
struct Outcome {
    output: String,
    width: u32,
    height: u32,
    frames: u32,
    seconds: f64,
}

pub fn run(args: &Video, console: &mut Console) -> Result<ExitCode, Failure> {
    let clip = args.clip();
    let output = output(args)?;
    check_writable(&output).map_err(|e| Failure::output(&output, e))?;
    let mut opened = loading::open(&clip.source, console)?;
    let interrupts = Interrupts::listen();
    let bar = Bar::new(console.is_talkative());
    let frames = |s: Step| {
        bar.tell_stop(&interrupts.control);
        bar.show_frames(s.done, s.total);
    };
    let options = |integrator: &Integrator| ClipOptions {
        path: output.clone(),
        title: format!("{}, {}", clip.source.name(), integrator_name(integrator)),
        frames_per_second: clip.fps,
        seconds: clip.seconds,
        quality: clip.quality,
        develop: clip.look.develop(),
    };
    let control = &interrupts.control;
    let summary = match args {
        Video::Converge(a) => {
            let mut what = converging(a, &opened);
            console.warn(strategy_warning(&a.method, &what.render.settings.integrator));
            what.layout = layout(what.layout, &what.render.settings, &opened.scene, console);
            converge(&opened.scene, &what, &options(&what.render.settings.integrator), control, frames)
        }
        Video::Pyramid(a) => {
            let settings = a.sampling.or(opened.depths).suited(&opened.scene).settings(Integrator::Bdpt);
            let render = render(clip, settings, a.spp.unwrap_or(opened.samples));
            let what = PyramidClip { render, rows: a.rows, hold: a.hold };
            let options = options(&Integrator::Bdpt);
            let rendering = |p: &Progress| {
                bar.tell_stop(control);
                bar.show(p);
            };
            pyramid(&opened.scene, &what, (&options, control), rendering, frames)
        }
        Video::Orbit(a) => {
            let settings = settings(&a.method, &opened.scene, (opened.integrator, opened.depths));
            console.warn(strategy_warning(&a.method, &settings.integrator));
            let render = render(clip, settings, a.spp);
            let what = Orbit { render, degrees: a.degrees, centre: a.centre.map(Vec3::from) };
            let options = options(&what.render.settings.integrator);
            let camera = opened.camera.clone();
            orbit(&mut opened.scene, (&camera, &what), &options, control, frames)
        }
    };
    bar.finish();
    let summary = summary.map_err(failure)?;
    let outcome = Outcome {
        output: output.display().to_string(),
        width: summary.width,
        height: summary.height,
        frames: summary.frames,
        seconds: summary.seconds,
    };
    console.result(&outcome, || {
        let Outcome { output, width, height, frames, seconds } = &outcome;
        format!("{width} × {height}, {frames} frames, {seconds:.1} s\nwrote {output}")
    })?;
    Ok(ExitCode::SUCCESS)
}

/// The layout, or another where there is no light image to show, or nothing else.
fn layout(asked: Layout, settings: &Settings, scene: &Scene, console: &mut Console) -> Layout {
    let name = integrator_name(&settings.integrator);
    let lacks = if !Kernel::new(scene, settings.clone()).has_light_image() {
        "light"
    } else if settings.integrator == Integrator::Light {
        "eye"
    } else {
        return asked;
    };
    if asked != Layout::With {
        console.warn([Diagnostic::warning(format!(
            "`{name}` makes no {lacks} image here: the picture is shown alone"
        ))]);
    }
    Layout::With
}

fn converging(a: &args::Converge, opened: &Opened) -> Converge {
    let scene: &Scene = &opened.scene;
    let settings = settings(&a.method, scene, (opened.integrator, opened.depths));
    let samples = a.length.samples(opened.samples);
    let render = RenderOptions { time: a.length.time, ..render(&a.clip, settings, samples) };
    Converge { render, layout: a.layout.into(), hold: a.hold }
}

fn render(clip: &Clip, settings: Settings, samples: u32) -> RenderOptions {
    RenderOptions {
        settings,
        samples,
        threads: clip.source.threads.map(usize::from),
        ..RenderOptions::default()
    }
}

fn output(args: &Video) -> Result<PathBuf, Failure> {
    let clip = args.clip();
    let kind = match args {
        Video::Converge(_) => "converge",
        Video::Pyramid(_) => "pyramid",
        Video::Orbit(_) => "orbit",
    };
    let Some(output) = &clip.output else { return Ok(clip.source.beside(&format!("-{kind}.mp4"))) };
    match output.extension().map(OsStr::to_ascii_lowercase) {
        Some(extension) if extension == "mp4" => Ok(output.clone()),
        _ => Err(Failure::Usage(format!("the output `{}` must end in .mp4", output.display()))),
    }
}

fn failure(e: ClipError) -> Failure {
    match e {
        ClipError::Render(e) => e.into(),
        ClipError::Camera(d) => Failure::Input(*d),
        ClipError::Video(e @ VideoError::Size { .. }) => Failure::Usage(e.to_string()),
        ClipError::Stopped => Failure::Output(e.to_string()),
        other => Failure::Output(format!("cannot make the video: {other}")),
    }
}
