//! Why a part of a picture is black or noisy.

mod advice;
mod missing;
mod noise;
mod survey;
mod words;

use std::collections::BTreeSet;

use caustica_math::MemoryLimit;
use caustica_render::Control;
use caustica_scene::Scene;
use caustica_scene::description::Crop;
use caustica_transport::Settings;
use serde::Serialize;

use crate::class::PathClass;
use crate::estimator::Estimator;
use crate::grid::Grid;
use crate::memory;
use crate::outcome::{PatternShare, by_pattern, lamp_name};
use crate::verify::VerifyError;

pub use missing::Missing;
pub(crate) use noise::MOST_PATTERNS;
use noise::Pattern;
use survey::Survey;

/// What is to be explained.
#[derive(Clone, Debug)]
pub struct Question<'a> {
    /// The part of the picture, in pixels; all of it if `None`.
    pub region: Option<Crop>,
    /// How the picture is rendered. The integrator counts: what it cannot reach is told.
    pub settings: Settings,
    /// Samples per pixel that are looked at.
    pub samples: u32,
    /// Worker threads; as many as the machine has if `None`.
    pub threads: Option<usize>,
    /// Names of the shapes, in the order of the description.
    pub names: &'a [String],
}

/// The light and the noise of a pattern of paths.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Such as `LS+DE`.
    pub pattern: String,
    /// Where its light is from.
    pub lamp: &'static str,
    /// Its share of the light that bdpt finds.
    pub light: f64,
    /// Its share of the noise of bdpt: of the sum of the variances of all patterns.
    pub noise: f64,
    /// The standard deviation of one sample a pixel, over the mean of all light.
    pub per_sample: f64,
    /// Which strategies make such paths.
    pub strategies: Vec<&'static str>,
    /// Integrators that do not reach all of it.
    pub missed_by: Vec<&'static str>,
}

/// The answer.
#[derive(Clone, Debug, Serialize)]
pub struct Explanation {
    /// The part of the picture: x, y, width, height.
    pub region: [u32; 4],
    /// Samples per pixel that were looked at: as many as were asked for, or some more.
    pub samples: u32,
    /// Mean luminance that bdpt finds there.
    pub mean: f64,
    /// The standard deviation of one sample a pixel of all light, over its mean.
    pub per_sample: f64,
    /// Patterns of paths by their light.
    pub rows: Vec<Row>,
    /// Light that no strategy reaches, estimated crudely.
    pub missing: Vec<Missing>,
    /// What is to be said, in sentences.
    pub sentences: Vec<String>,
}

/// Integrators that are told of, by the names of their estimators.
const INTEGRATORS: [&str; 5] = ["bdpt", "path", "path_ems", "naive", "light"];

/// Looks into the paths of a part of a picture.
///
/// # Errors
/// A region that needs more memory than there is, threads that do not start, and a control that stops it.
pub fn explain(
    scene: &Scene,
    question: &Question<'_>,
    control: &Control,
    mut tell: impl FnMut(f64),
) -> Result<Explanation, VerifyError> {
    let window = question.region.unwrap_or(scene.film.window());
    memory::for_explaining(window, question.threads).check(MemoryLimit::Machine)?;
    let region = Grid { window, block: 1 };
    let survey = Survey::run(scene, (question, region), control, |f| tell(0.8 * f))?;
    let missing = missing::estimate(scene, (question, region), &survey, control)?;
    tell(1.0);
    let rows = rows(scene, question, &survey);
    let mean = survey.light() / survey.pixel_samples();
    let variance = survey.noise.whole(survey.passes_of_a_part()) / survey.pixels as f64;
    let per_sample = if mean > 0.0 { variance.sqrt() / mean } else { 0.0 };
    let sentences = words::sentences(scene, question, (&survey, &rows, &missing), per_sample);
    Ok(Explanation {
        region: [window.x, window.y, window.width, window.height],
        samples: survey.passes,
        mean,
        per_sample,
        rows,
        missing,
        sentences,
    })
}

/// The patterns of what was found, the brightest first.
fn rows(scene: &Scene, question: &Question<'_>, survey: &Survey) -> Vec<Row> {
    let estimators = Estimator::all(&question.settings);
    let camera = scene.camera.joins();
    let light = survey.light();
    let mean = light / survey.pixel_samples();
    let variance = |p: &Pattern| survey.noise.variance(p, survey.passes_of_a_part()) / survey.pixels as f64;
    let patterns: BTreeSet<Pattern> = survey.classes.keys().map(|c| (c.lamp(), c.pattern())).collect();
    let all: f64 = patterns.iter().map(variance).sum();
    let shares = by_pattern(survey.classes.iter().map(|(class, c)| (class, c.light)));
    let row = |PatternShare { pattern, lamp, share }: PatternShare| {
        let is_own = |p: &Pattern| p.1 == pattern && lamp_name(p.0) == lamp;
        let classes: Vec<&PathClass> =
            survey.classes.keys().filter(|c| is_own(&(c.lamp(), c.pattern()))).collect();
        let own: f64 = patterns.iter().filter(|p| is_own(p)).map(variance).sum();
        let reached = |e: &Estimator| classes.iter().all(|c| e.reaches(c, camera));
        let misses = |name: &str| estimators.iter().find(|e| e.name == name).is_some_and(|e| !reached(e));
        let sets = [
            ("s=0", "bdpt, s=0"),
            ("s=1", "bdpt, s=1&t>=2"),
            ("t=1", "bdpt, t=1"),
            ("inner", "bdpt, s>=2&t>=2"),
        ];
        let makes = |(_, name): &(&str, &str)| {
            let makes = |e: &Estimator| classes.iter().any(|c| e.reaches(c, camera));
            estimators.iter().find(|e| e.name == *name).is_some_and(makes)
        };
        Row {
            light: if light > 0.0 { share / light } else { 0.0 },
            noise: if all > 0.0 { own / all } else { 0.0 },
            per_sample: if mean > 0.0 { own.sqrt() / mean } else { 0.0 },
            strategies: sets.iter().filter(|s| makes(s)).map(|s| s.0).collect(),
            missed_by: INTEGRATORS.into_iter().filter(|name| misses(name)).collect(),
            pattern,
            lamp,
        }
    };
    shares.into_iter().map(row).collect()
}
