use std::fmt::{self, Write};
use std::process::ExitCode;

use caustica::session::replay::{Replay, VertexRecord, replay};
use caustica::{Scene, Settings};

use crate::console::Console;
use crate::failure::Failure;

pub fn run(
    scene: &Scene,
    settings: Settings,
    (pixel, sample): ([u32; 2], u32),
    console: &Console,
) -> Result<ExitCode, Failure> {
    let w = scene.film.window();
    let inside = |at: u32, start: u32, size: u32| at >= start && at - start < size;
    if !inside(pixel[0], w.x, w.width) || !inside(pixel[1], w.y, w.height) {
        let [x, y] = pixel;
        return Err(Failure::Usage(format!(
            "pixel {x},{y} is not in the picture of {} × {} pixels from {},{}",
            w.width, w.height, w.x, w.y
        )));
    }
    let record = replay(scene, settings, pixel, sample);
    // Writing to a string does not fail.
    console.result(&record, || text(&record).unwrap_or_default())?;
    Ok(ExitCode::SUCCESS)
}

fn text(r: &Replay) -> Result<String, fmt::Error> {
    let mut t = String::new();
    writeln!(t, "pixel {},{}, sample {}, {}", r.pixel[0], r.pixel[1], r.sample, r.integrator)?;
    writeln!(t, "eye image    {}", rgb(r.eye))?;
    for splat in &r.splats {
        writeln!(t, "light image  {} at {:.2}, {:.2}", rgb(splat.value), splat.film[0], splat.film[1])?;
    }
    if r.contributions.is_empty() {
        let why =
            if r.integrator == "bdpt" { "no strategy found light" } else { "only bdpt tells its strategies" };
        writeln!(t, "{why}")?;
    }
    for c in &r.contributions {
        writeln!(t, "\n({}, {})  {}  × weight {:.6}", c.s, c.t, rgb(c.contribution), c.weight)?;
        for v in &c.path {
            writeln!(t, "    {}", vertex(v))?;
        }
    }
    Ok(t)
}

fn rgb(colour: [f32; 3]) -> String {
    format!("({})", colour.map(|c| format!("{c:?}")).join(", "))
}

fn vertex(v: &VertexRecord) -> String {
    let place = if v.infinite { "towards" } else { "at" };
    let at = v.at.map(|x| format!("{x:.5}")).join(", ");
    let pdfs = match (v.pdf_forward, v.pdf_reverse) {
        (Some(forward), Some(reverse)) => format!("  pdf {forward:.4e} forward, {reverse:.4e} reverse"),
        _ => String::new(),
    };
    format!("{:<6} {place} ({at}){pdfs}{}", v.kind, if v.delta { "  Dirac" } else { "" })
}
