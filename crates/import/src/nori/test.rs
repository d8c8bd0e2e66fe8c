//! `<test>`: the statistical tests that a scene file can carry.

use caustica_scene::{Description, Diagnostic, Origin};

use crate::files::Folder;

use super::class::Class;
use super::context::{Context, Warnings};
use super::fields::Fields;
use super::range::Bounds;
use super::tree::{Object, Place};
use super::{bsdf, emitter, scene, shape, value};

const TESTS: &[&str] = &["ttest", "chi2test"];

/// A statistical test.
#[derive(Clone, Debug)]
pub struct SceneTest {
    /// What is tested, and how.
    pub kind: TestKind,
    /// The probability of failing although all is well.
    pub significance: f64,
    /// What the test is about, in the order of the file: its materials are the BSDFs under test, its
    /// lights and shapes the emitters. It has no camera of its own.
    pub stage: Description,
    /// Where it stands in the file.
    pub origin: Option<Origin>,
}

/// The kinds of tests.
#[derive(Clone, Debug)]
pub enum TestKind {
    /// Student's t-test of means against references: of each BSDF at each of the angles, of the emitters
    /// at each of the distances, or of each scene's mean radiance.
    TTest {
        /// Samples for each reference.
        sample_count: u64,
        /// The true means.
        references: Vec<f64>,
        /// Angles of incidence in degrees.
        angles: Vec<f64>,
        /// Distances along +z from which emitters are seen.
        distances: Vec<f64>,
        /// Scenes.
        scenes: Vec<Description>,
    },
    /// χ² test of the BSDFs' sampling against their densities.
    Chi2Test {
        /// Cells in cos θ; there are twice as many in φ.
        resolution: u32,
        /// Cells in which fewer samples are expected are pooled.
        min_exp_frequency: u32,
        /// Samples for each direction of incidence; 5000 a cell if `None`.
        sample_count: Option<u64>,
        /// Random directions of incidence for each BSDF.
        test_count: u32,
    },
}

/// The most samples of a test: a run that ends within days.
const MOST_SAMPLES: i64 = 1 << 40;

pub(super) fn read(
    object: &Object,
    place: Place,
    folder: Folder<'_>,
    warnings: &mut Warnings,
) -> Result<SceneTest, Diagnostic> {
    let mut fields = Fields::new(object, place);
    let mut scenes = Vec::new();
    for child in fields.children(Class::Scene) {
        scenes.push(scene::read(child, place, folder, warnings)?);
    }
    let mut cx = Context::new(place, folder, warnings);
    for child in fields.children(Class::Bsdf) {
        bsdf::read(child, &mut cx)?;
    }
    let significance = fields.float(&["significanceLevel"], 0.01, Bounds::Between(0.0, 1.0))?;
    let kind = match object.plugin.as_str() {
        "ttest" => ttest(&mut fields, &mut cx, scenes)?,
        "chi2test" if scenes.is_empty() => chi2test(&mut fields, &cx)?,
        "chi2test" => return Err(fields.error("a `chi2test` tests BSDFs, not scenes")),
        _ => return Err(fields.unknown_plugin(TESTS)),
    };
    fields.finish(&mut cx)?;
    let origin = cx.origin(&object.range);
    Ok(SceneTest { kind, significance: significance.into(), stage: cx.description, origin })
}

fn ttest(fields: &mut Fields, cx: &mut Context, scenes: Vec<Description>) -> Result<TestKind, Diagnostic> {
    let bsdfs = cx.description.materials.len();
    for child in fields.children(Class::Emitter) {
        emitter::read_light(child, cx)?;
    }
    for child in fields.children(Class::Mesh) {
        shape::read(child, cx)?;
    }
    let emitters = cx.description.lights.len() + cx.description.shapes.len();
    let sample_count = fields.integer(&["sampleCount"], 2..=MOST_SAMPLES)?.unwrap_or(100_000) as u64;
    let references = list(fields, &["references"])?;
    let angles = list(fields, &["angles"])?;
    let distances = list(fields, &["distances"])?;
    let expected = match (bsdfs > 0, emitters > 0, !scenes.is_empty()) {
        (true, false, false) => bsdfs * angles.len(),
        (false, true, false) => emitters * distances.len(),
        (false, false, true) => scenes.len(),
        (false, false, false) => return Err(fields.error("the test has nothing to test")),
        _ => {
            return Err(
                fields.error("a test is about BSDFs, about emitters or about scenes, not about several")
            );
        }
    };
    if references.len() != expected || expected == 0 {
        let message = format!("the test has {} references and needs {expected}", references.len());
        return Err(fields
            .error(message)
            .hint("one for each BSDF and angle, emitter and distance, or scene"));
    }
    Ok(TestKind::TTest { sample_count, references, angles, distances, scenes })
}

fn chi2test(fields: &mut Fields, cx: &Context) -> Result<TestKind, Diagnostic> {
    if cx.description.materials.is_empty() {
        return Err(fields.error("the test has nothing to test"));
    }
    let sample_count = fields.integer(&["sampleCount"], -1..=MOST_SAMPLES)?.unwrap_or(-1);
    if sample_count == 0 {
        return Err(fields.error("`sampleCount` must be at least 1, or -1 for 5000 a cell"));
    }
    Ok(TestKind::Chi2Test {
        resolution: fields.integer(&["resolution"], 1..=4096)?.unwrap_or(10) as u32,
        min_exp_frequency: fields.integer(&["minExpFrequency"], 0..=1_000_000)?.unwrap_or(5) as u32,
        sample_count: u64::try_from(sample_count).ok(),
        test_count: fields.integer(&["testCount"], 1..=1_000_000)?.unwrap_or(5) as u32,
    })
}

/// Numbers in a string.
fn list(fields: &mut Fields, names: &[&'static str]) -> Result<Vec<f64>, Diagnostic> {
    let Some((text, property)) = fields.string(names)? else { return Ok(Vec::new()) };
    value::numbers(text, 0..=usize::MAX).map_err(|bad| fields.error_in(property, bad.message))
}
