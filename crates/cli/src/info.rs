use std::fmt::Write;
use std::path::Path;
use std::process::ExitCode;

use caustica::film::{FilmCounts, FilmFacts, FilmRecord, Window};
use caustica::import::Provision;

use caustica::scene::bvh::TreeQuality;
use caustica::session::info::{SceneInfo, describe, outline};

use serde::Serialize;

use crate::args::Info;
use crate::console::Console;
use crate::develop::is_film_file;
use crate::failure::Failure;
use crate::loading;

pub fn run(args: &Info, console: &mut Console) -> Result<ExitCode, Failure> {
    if let Some(film) = args.scene.as_deref().filter(|path| is_film_file(path)) {
        return film_info(film, console);
    }
    let from = Provision { trust: loading::trust(args.untrusted), variables: &args.definitions };
    let description = loading::description(args.scene.as_deref(), &from, console)?.description;
    let outline = outline(&description);
    let scene = loading::scene(description, TreeQuality::default(), console)?;
    let info = describe(&scene, outline);
    console.result(&info, || text(&info))?;
    Ok(ExitCode::SUCCESS)
}

/// What `--json` prints of a film, beside warnings.
#[derive(Serialize)]
struct FilmInfo {
    resolution: [u32; 2],
    window: Window,
    #[serde(flatten)]
    facts: FilmFacts,
    counts: FilmCounts,
    noise: Option<f64>,
}

fn film_info(path: &Path, console: &Console) -> Result<ExitCode, Failure> {
    let FilmRecord { film, facts } = FilmRecord::read(path).map_err(|e| Failure::input(path, e))?;
    let layout = film.layout();
    let noise = film.error_bars().and_then(|bars| bars.relative());
    let resolution = [layout.width, layout.height];
    let info = FilmInfo { resolution, window: layout.window, counts: film.counts(), facts, noise };
    console.result(&info, || film_text(&info))?;
    Ok(ExitCode::SUCCESS)
}

fn film_text(info: &FilmInfo) -> String {
    let ([width, height], w, facts) = (info.resolution, info.window, &info.facts);
    let mut rows = vec![
        ("film of", facts.provenance.scene.clone()),
        ("picture", format!("{width} × {height} pixels")),
        ("samples", format!("{} per pixel ({})", facts.samples.total(), facts.samples)),
        ("time", format!("{:.1} s of rendering", facts.seconds)),
    ];
    if [w.width, w.height] != [width, height] {
        rows.push(("crop", format!("{} × {} pixels from {}, {}", w.width, w.height, w.x, w.y)));
    }
    if let Some(noise) = info.noise {
        rows.push(("error", format!("{:.2} % in a typical pixel (95 % certain)", 100.0 * noise)));
    }
    if info.counts.invalid + info.counts.clamped > 0 {
        rows.push(("lost", format!("{} invalid, {} clamped", info.counts.invalid, info.counts.clamped)));
    }
    let settings = facts.provenance.settings.iter().map(|(name, value)| (name.as_str(), value.clone()));
    rows.into_iter().chain(settings).map(|(name, value)| format!("{name:<14}{value}\n")).collect()
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
    if info.groups > 0 {
        let (groups, instances) = (counted(info.groups, "group"), counted(info.instances, "instance"));
        row("instances", format!("{instances} of {groups}: {} triangles are seen", info.placed_triangles));
    }
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
