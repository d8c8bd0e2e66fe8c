use std::fmt::Write;
use std::process::ExitCode;

use caustica::scene::bvh::TreeQuality;
use caustica::session::info::{SceneInfo, describe, outline};

use crate::args::Info;
use crate::console::Console;
use crate::failure::Failure;
use crate::loading;

pub fn run(args: &Info, console: &mut Console) -> Result<ExitCode, Failure> {
    let description = loading::description(args.scene.as_deref(), loading::trust(args.untrusted), console)?;
    let outline = outline(&description);
    let scene = loading::scene(description, TreeQuality::default(), console)?;
    let info = describe(&scene, outline);
    console.result(&info, || text(&info))?;
    Ok(ExitCode::SUCCESS)
}

fn text(info: &SceneInfo) -> String {
    let list = |counts: &[(&str, usize)]| {
        let items: Vec<String> = counts.iter().map(|(name, n)| format!("{n} {name}")).collect();
        if items.is_empty() { "none".to_owned() } else { items.join(", ") }
    };
    let [width, height] = info.resolution;
    let samples = counted(info.samples as usize, "sample");
    let mut t = String::new();
    let mut row = |name: &str, value: String| {
        // Writing to a string does not fail.
        let _ = writeln!(t, "{name:<12}{value}");
    };
    row("picture", format!("{width} × {height} pixels, {samples} per pixel, integrator {}", info.integrator));
    if let Some([x, y, w, h]) = info.crop {
        row("crop", format!("{w} × {h} pixels from {x}, {y}"));
    }
    row("camera", info.camera.to_owned());
    let (triangles, spheres) = (counted(info.triangles, "triangle"), counted(info.spheres, "sphere"));
    row("shapes", format!("{} ({triangles}, {spheres})", info.shapes));
    row("materials", list(&info.materials));
    row("lights", format!("{} ({} W in all)", list(&info.lights), figure(info.power)));
    row(
        "bounds",
        info.bounds.map_or("none".to_owned(), |[low, high]| {
            let corner = |c: [f32; 3]| c.map(|x| figure(x.into())).join(", ");
            format!("({}) to ({})", corner(low), corner(high))
        }),
    );
    let m = &info.memory;
    let [all, tree, surfaces, images, film] = [m.total(), m.tree, m.surfaces, m.images, m.film].map(bytes);
    row("memory", format!("{all} (tree {tree}, surfaces {surfaces}, images {images}, film {film})"));
    t
}

fn counted(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

/// A number in five digits at most, where it has a size that people read.
fn figure(x: f64) -> String {
    let size = x.abs();
    if size >= 1e5 || (size > 0.0 && size < 1e-3) {
        return format!("{x:.3e}");
    }
    let text = format!("{x:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn bytes(n: usize) -> String {
    match n as f64 {
        n if n >= 1e9 => format!("{:.2} GB", n * 1e-9),
        n if n >= 1e6 => format!("{:.1} MB", n * 1e-6),
        n => format!("{:.1} kB", n * 1e-3),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_short() {
        for (x, text) in [
            (0.0, "0"),
            (1.5, "1.5"),
            (-0.98, "-0.98"),
            (1234.5678, "1234.5678"),
            (2e7, "2.000e7"),
            (1e-6, "1.000e-6"),
        ] {
            assert_eq!(figure(x), text);
        }
        assert_eq!([bytes(500), bytes(2_500_000)], ["0.5 kB", "2.5 MB"]);
    }
}
