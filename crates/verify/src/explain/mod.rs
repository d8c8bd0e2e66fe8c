//! Why a part of a picture is black or noisy.

mod missing;
mod survey;
mod words;

use caustica_render::Control;
use caustica_scene::Scene;
use caustica_scene::description::Crop;
use caustica_transport::Settings;
use serde::Serialize;

use crate::estimator::Estimator;
use crate::grid::Grid;
use crate::outcome::{PatternShare, by_pattern};
use crate::verify::VerifyError;

pub use missing::Missing;
use survey::{Carried, Survey};

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
    /// Its share of the noise (variance) of bdpt.
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
    /// Mean luminance that bdpt finds there.
    pub mean: f64,
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
/// Threads that do not start, and a control that stops it.
pub fn explain(
    scene: &Scene,
    question: &Question<'_>,
    control: &Control,
    mut tell: impl FnMut(f64),
) -> Result<Explanation, VerifyError> {
    let window = question.region.unwrap_or(scene.film.window());
    let region = Grid { window, block: 1 };
    let survey = Survey::run(scene, (question, region), control, |f| tell(0.8 * f))?;
    let missing = missing::estimate(scene, (question, region), &survey, control)?;
    tell(1.0);
    let rows = rows(scene, question, &survey);
    let sentences = words::sentences(scene, question, (&survey, &rows, &missing));
    Ok(Explanation {
        region: [window.x, window.y, window.width, window.height],
        mean: survey.light() / survey.pixel_samples(),
        rows,
        missing,
        sentences,
    })
}

/// The patterns of what was found, the brightest first.
fn rows(scene: &Scene, question: &Question<'_>, survey: &Survey) -> Vec<Row> {
    let estimators = Estimator::all(&question.settings);
    let camera = scene.camera.joins();
    let (light, squares) = (survey.light(), survey.squares());
    let mean = light / survey.pixel_samples();
    let shares = by_pattern(survey.classes.iter().map(|(class, c)| (class, c.tally.light)));
    let row = |PatternShare { pattern, lamp, share }: PatternShare| {
        let classes: Vec<_> = survey
            .classes
            .iter()
            .filter(|(c, _)| c.pattern() == pattern && crate::outcome::lamp_name(c.lamp()) == lamp)
            .collect();
        let own: f64 = classes.iter().map(|(_, c): &(_, &Carried)| c.tally.squares).sum();
        let reached = |e: &Estimator| classes.iter().all(|(c, _)| e.reaches(c, camera));
        let misses = |name: &str| estimators.iter().find(|e| e.name == name).is_some_and(|e| !reached(e));
        let sets = [
            ("s=0", "bdpt, s=0"),
            ("s=1", "bdpt, s=1&t>=2"),
            ("t=1", "bdpt, t=1"),
            ("inner", "bdpt, s>=2&t>=2"),
        ];
        let makes = |(_, name): &(&str, &str)| {
            let makes = |e: &Estimator| classes.iter().any(|(c, _)| e.reaches(c, camera));
            estimators.iter().find(|e| e.name == *name).is_some_and(makes)
        };
        Row {
            light: if light > 0.0 { share / light } else { 0.0 },
            noise: if squares > 0.0 { own / squares } else { 0.0 },
            per_sample: if mean > 0.0 { (own / survey.pixel_samples()).sqrt() / mean } else { 0.0 },
            strategies: sets.iter().filter(|s| makes(s)).map(|s| s.0).collect(),
            missed_by: INTEGRATORS.into_iter().filter(|name| misses(name)).collect(),
            pattern,
            lamp,
        }
    };
    shares.into_iter().map(row).collect()
}
