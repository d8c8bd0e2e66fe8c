//! The pyramid of strategies.

use std::collections::BTreeSet;
use std::path::Path;

use askama::Template;
use caustica_film::write_file;
use caustica_math::Rgb;
use serde::Serialize;

use crate::ReportError;
use crate::encode::encode_rgb;
use crate::page::{Blob, SCRIPT, STYLE, check_count, script_json};

/// What every strategy adds to an image. A page has two images a strategy: twenty noisy strategies of
/// 400 × 300 pixels weigh 16 MB.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Pyramid {
    /// The heading.
    pub title: String,
    /// Width of all images in pixels.
    pub width: u32,
    /// Height of all images in pixels.
    pub height: u32,
    /// The strategies, in any order.
    pub strategies: Vec<StrategyImages>,
    /// What all other paths add, weighted, such as longer ones: with it the weighted images add up to the whole. Empty
    /// if there is nothing.
    #[serde(rename = "longer", serialize_with = "is_there")]
    pub rest: Vec<Rgb>,
    /// Settings by name: scene, integrator, samples.
    pub notes: Vec<(String, String)>,
}

/// Pixels as the page's script hears of them: whether there are any.
fn is_there<S: serde::Serializer>(pixels: &[Rgb], to: S) -> Result<S::Ok, S::Error> {
    to.serialize_bool(!pixels.is_empty())
}

/// What one strategy sees: s light vertices joined with t camera vertices, a path of s + t − 1 edges.
#[derive(Clone, Debug, Default, Serialize)]
pub struct StrategyImages {
    /// Vertices on the light's side.
    pub s: u32,
    /// Vertices on the camera's side.
    pub t: u32,
    /// Linear pixels, each contribution times its weight: these and the rest add up to the image.
    #[serde(skip)]
    pub weighted: Vec<Rgb>,
    /// Linear pixels, as if this strategy were the only one for paths of its length.
    #[serde(skip)]
    pub unweighted: Vec<Rgb>,
}

#[derive(Template)]
#[template(path = "pyramid.html")]
struct Page<'a> {
    title: &'a str,
    notes: &'a [(String, String)],
    style: &'static str,
    script: &'static str,
    data: String,
    blobs: Vec<Blob>,
    has_images: bool,
}

/// The page as one text.
///
/// # Errors
/// Images whose pixels do not fill the size, a strategy that is there twice, and one that makes no path.
pub fn pyramid_page(pyramid: &Pyramid) -> Result<String, ReportError> {
    check(pyramid)?;
    let page = Page {
        title: &pyramid.title,
        notes: &pyramid.notes,
        style: STYLE,
        script: SCRIPT,
        data: script_json(pyramid)?,
        blobs: blobs(pyramid),
        has_images: !pyramid.strategies.is_empty(),
    };
    Ok(page.render()?)
}

/// Writes the page to `path`, whole or not at all.
///
/// # Errors
/// Those of [`pyramid_page`], before anything is written, and what the system says about the file.
pub fn write_pyramid(pyramid: &Pyramid, path: &Path) -> Result<(), ReportError> {
    Ok(write_file(path, pyramid_page(pyramid)?.as_bytes())?)
}

fn check(pyramid: &Pyramid) -> Result<(), ReportError> {
    let mut seen = BTreeSet::new();
    for &StrategyImages { s, t, ref weighted, ref unweighted } in &pyramid.strategies {
        if s.saturating_add(t) < 2 {
            return Err(ReportError::NoPath { s, t });
        }
        if !seen.insert((s, t)) {
            return Err(ReportError::StrategyTwice { s, t });
        }
        for (kind, pixels) in [("weighted", weighted), ("unweighted", unweighted)] {
            let name = format!("s = {s}, t = {t} ({kind})");
            check_count(&name, [pyramid.width, pyramid.height], pixels.len())?;
        }
    }
    if !pyramid.rest.is_empty() {
        check_count("all other paths", [pyramid.width, pyramid.height], pyramid.rest.len())?;
    }
    Ok(())
}

/// The images as `weighted-0`, `unweighted-0`, …; the rest as the last weighted one.
fn blobs(pyramid: &Pyramid) -> Vec<Blob> {
    let both = |(i, strategy): (usize, &StrategyImages)| {
        [("weighted", &strategy.weighted), ("unweighted", &strategy.unweighted)]
            .map(|(kind, pixels)| Blob::new(format!("{kind}-{i}"), encode_rgb(pixels, pyramid.width)))
    };
    let mut blobs: Vec<_> = pyramid.strategies.iter().enumerate().flat_map(both).collect();
    if !pyramid.rest.is_empty() {
        let name = format!("weighted-{}", pyramid.strategies.len());
        blobs.push(Blob::new(name, encode_rgb(&pyramid.rest, pyramid.width)));
    }
    blobs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strategy(s: u32, t: u32) -> StrategyImages {
        StrategyImages { s, t, weighted: vec![Rgb::WHITE], unweighted: vec![Rgb::WHITE] }
    }

    fn pyramid(strategies: Vec<StrategyImages>) -> Pyramid {
        Pyramid {
            title: "A <b>pyramid</b>".into(),
            width: 1,
            height: 1,
            strategies,
            rest: vec![],
            notes: vec![],
        }
    }

    #[test]
    fn one_pixel_makes_a_page() {
        let page = pyramid_page(&pyramid(vec![strategy(0, 2), strategy(1, 1)])).unwrap();
        assert!(page.contains("id=\"unweighted-1\"") && !page.contains("<b>pyramid"));
        assert!(!page.contains("id=\"weighted-2\""));
        let longer = Pyramid { rest: vec![Rgb::WHITE], ..pyramid(vec![strategy(0, 2), strategy(1, 1)]) };
        let page = pyramid_page(&longer).unwrap();
        assert!(page.contains("id=\"weighted-2\"") && page.contains("\"longer\":true"));
        let wrong = Pyramid { rest: vec![Rgb::WHITE; 2], ..longer };
        assert!(pyramid_page(&wrong).unwrap_err().to_string().contains("all other paths"));
    }

    #[test]
    fn no_strategies_make_a_page_that_says_so() {
        assert!(pyramid_page(&pyramid(vec![])).unwrap().contains("no images"));
    }

    #[test]
    fn bad_strategies_are_errors() {
        let mut short = strategy(0, 2);
        short.unweighted.clear();
        for (strategies, expected) in [
            (vec![strategy(1, 2), strategy(1, 2)], "s = 1, t = 2 is there twice"),
            (vec![strategy(0, 1)], "makes no path"),
            (vec![short], "`s = 0, t = 2 (unweighted)` has 0 pixels"),
        ] {
            let error = pyramid_page(&pyramid(strategies)).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
