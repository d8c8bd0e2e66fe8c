//! Whether all ways to render a scene agree.

use std::fs;
use std::path::Path;

use askama::Template;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use caustica_film::write_file;
use serde::Serialize;

use crate::ReportError;
use crate::comparison::Shown;
use crate::encode::encode_rgb;
use crate::page::{Blob, SCRIPT, STYLE, check_image, script_json};

/// All that a page of verification tells.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Verification {
    /// The heading.
    pub title: String,
    /// Which scene was rendered.
    pub scene: String,
    /// The verdict in a sentence.
    pub verdict: String,
    /// Whether nothing differs.
    pub agrees: bool,
    /// Settings by name.
    pub notes: Vec<(String, String)>,
    /// What the estimators are compared with.
    pub reference: Shown,
    /// The estimators, in the order of their number keys.
    pub estimators: Vec<Estimated>,
    /// What carries the light.
    pub patterns: Vec<Pattern>,
    /// Where estimators differ, as a PNG.
    #[serde(skip)]
    pub heat_map: Vec<u8>,
}

/// An estimator and what was found.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Estimated {
    /// A short name.
    pub name: String,
    /// What it can reach, in a few words.
    pub reach: String,
    /// Light that it cannot find in this scene: patterns of paths with their shares.
    pub missed: Vec<(String, f64)>,
    /// Mean luminance of its picture.
    pub mean: f64,
    /// The standard deviation of that.
    pub error: f64,
    /// What the reference found of the paths that it reaches.
    pub expected: f64,
    /// Blocks that were tested, of all sizes.
    pub tests: usize,
    /// Blocks in which it differs.
    pub mismatches: usize,
    /// The smallest probability of a test.
    pub smallest_p: f64,
    /// The share of its light in blocks that could not be tested.
    pub untested: f64,
    /// What is to be said of it.
    pub verdict: String,
    /// Its picture.
    #[serde(skip)]
    pub picture: Shown,
}

/// A pattern of paths, such as `LS+DE`, and its light.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Pattern {
    /// The pattern.
    pub pattern: String,
    /// Where its light is from.
    pub lamp: String,
    /// Its share of all light.
    pub share: f64,
    /// Names of estimators that do not reach all of it.
    pub missed_by: Vec<String>,
}

#[derive(Template)]
#[template(path = "verification.html")]
struct Page<'a> {
    title: &'a str,
    scene: &'a str,
    verdict: &'a str,
    agrees: bool,
    rows: Vec<Row<'a>>,
    patterns: Vec<(&'a Pattern, String)>,
    heat_map: String,
    notes: &'a [(String, String)],
    style: &'static str,
    script: &'static str,
    data: String,
    blobs: Vec<Blob>,
}

/// A row of the table, as the page writes it.
struct Row<'a> {
    e: &'a Estimated,
    missed: String,
    p: String,
    untested: String,
}

impl<'a> Row<'a> {
    fn new(e: &'a Estimated) -> Self {
        let missed: Vec<String> = e
            .missed
            .iter()
            .take(4)
            .map(|(pattern, share)| format!("{pattern} {}", percent(*share)))
            .collect();
        let p = if e.tests > 0 { format!("{:.1e}", e.smallest_p) } else { "–".to_owned() };
        Self {
            e,
            missed: if missed.is_empty() { "–".to_owned() } else { missed.join(", ") },
            p,
            untested: percent(e.untested),
        }
    }
}

/// A share as people read it.
pub fn percent(share: f64) -> String {
    match share {
        s if s <= 0.0 => "0 %".to_owned(),
        s if s < 0.001 => "< 0.1 %".to_owned(),
        s if s < 0.0995 => format!("{:.1} %", 100.0 * s),
        s => format!("{:.0} %", 100.0 * s),
    }
}

/// The page as one text.
///
/// # Errors
/// Images without pixels or of different sizes.
pub fn verification_page(v: &Verification) -> Result<String, ReportError> {
    for e in &v.estimators {
        check_image(&v.reference, &e.picture)?;
    }
    check_image(&v.reference, &v.reference)?;
    let page = Page {
        title: &v.title,
        scene: &v.scene,
        verdict: &v.verdict,
        agrees: v.agrees,
        rows: v.estimators.iter().map(Row::new).collect(),
        patterns: v.patterns.iter().map(|p| (p, percent(p.share))).collect(),
        heat_map: STANDARD.encode(&v.heat_map),
        notes: &v.notes,
        style: STYLE,
        script: SCRIPT,
        data: script_json(&viewed(v))?,
        blobs: blobs(v),
    };
    Ok(page.render()?)
}

/// What the viewer shows: the reference and each estimator's picture.
#[derive(Serialize)]
struct Viewed<'a> {
    verification: bool,
    reference: &'a Shown,
    entries: Vec<ViewedEntry<'a>>,
}

#[derive(Serialize)]
struct ViewedEntry<'a> {
    shown: &'a Shown,
    label: &'a str,
}

fn viewed(v: &Verification) -> Viewed<'_> {
    let entries = v.estimators.iter().map(|e| ViewedEntry { shown: &e.picture, label: &e.reach });
    Viewed { verification: true, reference: &v.reference, entries: entries.collect() }
}

fn blobs(v: &Verification) -> Vec<Blob> {
    let blob = |id: String, shown: &Shown| Blob::new(id, encode_rgb(&shown.pixels, shown.width));
    let pictures = v.estimators.iter().enumerate().map(|(i, e)| blob(format!("image-{i}"), &e.picture));
    std::iter::once(blob("reference".to_owned(), &v.reference)).chain(pictures).collect()
}

/// All but the images, for programs: the fields of [`Verification`] by name.
///
/// # Errors
/// None that are known of.
pub fn verification_json(v: &Verification) -> Result<String, ReportError> {
    Ok(serde_json::to_string_pretty(v)? + "\n")
}

/// Writes `index.html` and `report.json` into `folder`, which is made if it is missing. Each file is replaced whole or
/// not at all.
///
/// # Errors
/// Those of [`verification_page`], before anything is written, and what the system says about files.
pub fn write_verification(v: &Verification, folder: &Path) -> Result<(), ReportError> {
    let (page, json) = (verification_page(v)?, verification_json(v)?);
    fs::create_dir_all(folder).map_err(|source| ReportError::Folder { path: folder.to_owned(), source })?;
    write_file(&folder.join("report.json"), json.as_bytes())?;
    Ok(write_file(&folder.join("index.html"), page.as_bytes())?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use caustica_math::Rgb;

    fn shown(name: &str) -> Shown {
        Shown { name: name.into(), width: 2, height: 1, pixels: vec![Rgb::WHITE; 2] }
    }

    fn verification() -> Verification {
        let estimator = Estimated {
            name: "light".into(),
            missed: vec![("LDS+E".into(), 0.25)],
            tests: 7,
            smallest_p: 0.0004,
            picture: shown("light"),
            ..Estimated::default()
        };
        Verification {
            title: "<b>scene</b>".into(),
            verdict: "All agree.".into(),
            agrees: true,
            reference: shown("reference"),
            estimators: vec![estimator],
            heat_map: b"picture".to_vec(),
            ..Verification::default()
        }
    }

    #[test]
    fn a_page_tells_all() {
        let page = verification_page(&verification()).unwrap();
        for text in [
            "id=\"image-0\"",
            "id=\"reference\"",
            "All agree.",
            "LDS+E 25 %",
            "4.0e-4",
            "data:image/png;base64,cGlj",
        ] {
            assert!(page.contains(text), "{text}");
        }
        assert!(!page.contains("<b>scene"));
        let json: serde_json::Value =
            serde_json::from_str(&verification_json(&verification()).unwrap()).unwrap();
        assert_eq!(json["estimators"][0]["missed"][0][0], "LDS+E");
        assert!(json.get("heat_map").is_none() && json["estimators"][0].get("picture").is_none());
    }

    #[test]
    fn pictures_of_other_sizes_are_errors() {
        let mut v = verification();
        v.estimators[0].picture.width = 3;
        assert!(verification_page(&v).unwrap_err().to_string().contains("one page needs one size"));
        v.estimators.clear();
        v.reference.pixels.clear();
        assert!(verification_page(&v).is_err());
    }
}
