//! The comparison of images of one scene.

use std::fs;
use std::path::Path;

use askama::Template;
use caustica_film::write_file;
use caustica_math::Rgb;
use serde::Serialize;

use crate::ReportError;
use crate::encode::{encode_rgb, encode_unit};
use crate::page::{Blob, SCRIPT, STYLE, check_count, check_image, script_json};

/// All that a page of comparison tells. Numbers that are not finite are shown as a dash and are `null` in
/// JSON. Names of images should differ, because permalinks go by them. Seven noisy images of 800 × 600
/// pixels weigh 17 MB, and each map of errors half a MB or less.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Comparison {
    /// The heading.
    pub title: String,
    /// Which scene was rendered.
    pub scene: String,
    /// Settings by name: resolution, threads, version.
    pub notes: Vec<(String, String)>,
    /// What the images should look like.
    pub reference: Option<Shown>,
    /// The images that are compared, in the order of their number keys.
    pub entries: Vec<Entry>,
    /// Parts of the image worth a look.
    pub insets: Vec<Inset>,
    /// Who reaches whose error how much sooner, of all pairs for which that is known.
    pub speedups: Vec<Speedup>,
}

/// An image of linear light with BT.709 primaries.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Shown {
    /// A short name: on buttons and in permalinks.
    pub name: String,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Width × height pixels, row by row from the top.
    #[serde(skip)]
    pub pixels: Vec<Rgb>,
}

/// One image and how good it is.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Entry {
    /// The image.
    pub shown: Shown,
    /// What it is, in a few words.
    pub label: String,
    /// Its figures.
    pub metrics: Metrics,
    /// The FLIP error of each pixel, in [0, 1]. (The page makes the map of relative errors itself.)
    #[serde(skip)]
    pub flip_map: Option<Vec<f32>>,
    /// How the error fell while the image was rendered.
    pub curve: Vec<CurvePoint>,
    /// The slope of log(relMSE) over log(seconds): −1 for an unbiased estimator of finite variance.
    pub slope: Option<f64>,
}

/// Figures of an image. Those that need a reference are `None` without one.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Metrics {
    /// Mean of squared relative errors.
    pub rel_mse: Option<f64>,
    /// The same without the worst 0.1 % of pixels.
    pub trimmed_rel_mse: Option<f64>,
    /// Root of the mean squared error, in units of radiance.
    pub rmse: Option<f64>,
    /// Mean HDR-FLIP, in [0, 1].
    pub flip: Option<f64>,
    /// Mean luminance, in units of radiance.
    pub mean: f64,
    /// Samples per pixel.
    pub samples: f64,
    /// Time of rendering in seconds.
    pub seconds: f64,
    /// 1 / (relMSE · seconds).
    pub efficiency: Option<f64>,
}

/// The error at one moment.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct CurvePoint {
    /// Time since rendering began, in seconds.
    pub seconds: f64,
    /// Samples per pixel so far.
    pub samples: f64,
    /// Mean of squared relative errors.
    pub rel_mse: f64,
    /// The same without the worst 0.1 % of pixels.
    pub trimmed_rel_mse: f64,
}

/// A part of the image, in pixels from the upper left corner.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Inset {
    /// What is to be seen there.
    pub label: String,
    /// Left edge.
    pub x: u32,
    /// Upper edge.
    pub y: u32,
    /// Width.
    pub width: u32,
    /// Height.
    pub height: u32,
}

/// "`faster` reaches `slower`'s error (more than) `factor` times sooner."
#[derive(Clone, Debug, Default, Serialize)]
pub struct Speedup {
    /// Name of the image that is better.
    pub faster: String,
    /// Name of the other one.
    pub slower: String,
    /// Ratio of times to the same error; below one it is later. Factors that are not finite are left out of the page.
    pub factor: f64,
    /// Whether it is more than that: the error was reached before it was first measured.
    pub at_least: bool,
}

#[derive(Template)]
#[template(path = "comparison.html")]
struct Page<'a> {
    title: &'a str,
    scene: &'a str,
    notes: &'a [(String, String)],
    speedups: Vec<Sentence<'a>>,
    times: Times<'a>,
    style: &'static str,
    script: &'static str,
    data: String,
    blobs: Vec<Blob>,
    has_images: bool,
}

/// The page as one text.
///
/// # Errors
/// Images without pixels or of different sizes, and insets outside the image.
pub fn comparison_page(comparison: &Comparison) -> Result<String, ReportError> {
    check(comparison)?;
    let page = Page {
        title: &comparison.title,
        scene: &comparison.scene,
        notes: &comparison.notes,
        speedups: sentences(comparison),
        times: Times::new(comparison),
        style: STYLE,
        script: SCRIPT,
        data: script_json(comparison)?,
        blobs: blobs(comparison),
        has_images: images(comparison).next().is_some(),
    };
    Ok(page.render()?)
}

/// All but the images, for programs: the fields of [`Comparison`] by name.
///
/// # Errors
/// None that are known of.
pub fn comparison_json(comparison: &Comparison) -> Result<String, ReportError> {
    Ok(serde_json::to_string_pretty(comparison)? + "\n")
}

/// Writes `index.html` and `report.json` into `folder`, which is made if it is missing. Each file is
/// replaced whole or not at all.
///
/// # Errors
/// Those of [`comparison_page`], before anything is written, and what the system says about files.
pub fn write_comparison(comparison: &Comparison, folder: &Path) -> Result<(), ReportError> {
    let (page, json) = (comparison_page(comparison)?, comparison_json(comparison)?);
    fs::create_dir_all(folder).map_err(|source| ReportError::Folder { path: folder.to_owned(), source })?;
    write_file(&folder.join("report.json"), json.as_bytes())?;
    Ok(write_file(&folder.join("index.html"), page.as_bytes())?)
}

fn images(comparison: &Comparison) -> impl Iterator<Item = &Shown> {
    comparison.reference.iter().chain(comparison.entries.iter().map(|e| &e.shown))
}

fn check(comparison: &Comparison) -> Result<(), ReportError> {
    let Some(first) = images(comparison).next() else { return Ok(()) };
    images(comparison).try_for_each(|image| check_image(first, image))?;
    let size = [first.width, first.height];
    for entry in &comparison.entries {
        if let Some(map) = &entry.flip_map {
            check_count(&format!("{} (FLIP)", entry.shown.name), size, map.len())?;
        }
    }
    comparison.insets.iter().try_for_each(|inset| check_inset(inset, size))
}

fn check_inset(inset: &Inset, [image_width, image_height]: [u32; 2]) -> Result<(), ReportError> {
    let inside = |at: u32, length: u32, whole: u32| length > 0 && at < whole && length <= whole - at;
    if inside(inset.x, inset.width, image_width) && inside(inset.y, inset.height, image_height) {
        return Ok(());
    }
    let Inset { label, x, y, width, height } = inset.clone();
    Err(ReportError::InsetOutside { label, x, y, width, height, image_width, image_height })
}

/// The images as `image-0`, … (the reference as `reference`) and their FLIP maps as `flip-0`, ….
fn blobs(comparison: &Comparison) -> Vec<Blob> {
    let text = |shown: &Shown| encode_rgb(&shown.pixels, shown.width);
    let mut blobs = Vec::new();
    blobs.extend(comparison.reference.iter().map(|r| Blob::new("reference".to_owned(), text(r))));
    for (i, entry) in comparison.entries.iter().enumerate() {
        blobs.push(Blob::new(format!("image-{i}"), text(&entry.shown)));
        let map = entry.flip_map.iter();
        blobs.extend(map.map(|m| Blob::new(format!("flip-{i}"), encode_unit(m, entry.shown.width))));
    }
    blobs
}

/// A speed-up as the page says it.
struct Sentence<'a> {
    faster: &'a str,
    slower: &'a str,
    factor: String,
    at_least: bool,
}

/// What the best image does better than the others: the one that is sooner than most.
fn sentences(comparison: &Comparison) -> Vec<Sentence<'_>> {
    let sooner = |s: &&Speedup| known(s) && s.factor > 1.0;
    let wins = |name: &str| comparison.speedups.iter().filter(sooner).filter(|s| s.faster == name).count();
    // The last of those with as many: images come in the order of what is hoped of them.
    let best = comparison.entries.iter().map(|e| e.shown.name.as_str()).max_by_key(|name| wins(name));
    let told = comparison.speedups.iter().filter(sooner).filter(|s| Some(s.faster.as_str()) == best);
    told.map(Sentence::new).collect()
}

fn known(s: &Speedup) -> bool {
    s.factor.is_finite() && s.factor > 0.0
}

impl<'a> Sentence<'a> {
    fn new(s: &'a Speedup) -> Self {
        let Speedup { faster, slower, factor, at_least } = s;
        Self { faster, slower, factor: factor_text(*factor), at_least: *at_least }
    }
}

/// A table of all speed-ups: whoever is named at a row's start reaches the errors of the columns.
struct Times<'a> {
    names: Vec<&'a str>,
    rows: Vec<(&'a str, Vec<Option<Sentence<'a>>>)>,
}

impl<'a> Times<'a> {
    fn new(comparison: &'a Comparison) -> Self {
        let all: Vec<&Speedup> = comparison.speedups.iter().filter(|s| known(s)).collect();
        let is_named = |name: &&str| all.iter().any(|s| s.faster == *name || s.slower == *name);
        let names: Vec<&str> =
            comparison.entries.iter().map(|e| e.shown.name.as_str()).filter(is_named).collect();
        let cell = |faster: &str, slower: &str| {
            all.iter().find(|s| s.faster == faster && s.slower == slower).map(|s| Sentence::new(s))
        };
        let row = |faster: &&'a str| (*faster, names.iter().map(|slower| cell(faster, slower)).collect());
        Self { rows: names.iter().map(row).collect(), names }
    }
}

/// A factor as people say it: two digits, or all that are left of the point.
fn factor_text(factor: f64) -> String {
    if factor >= 9.95 { format!("{factor:.0}") } else { format!("{factor:.1}") }
}

#[cfg(test)]
mod tests;
