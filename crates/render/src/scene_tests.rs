//! Running the statistical tests that a scene file carries: Nori's `ttest` and `chi2test`.
//!
//! Every sample has a stream of its own, named by the seed and the places of the test in the file and of the
//! case in the test: outcomes depend neither on threads nor on which tests ran before.
//!
//! - A `ttest` of BSDFs estimates the mean luminance of the weight of samples drawn from the camera's side,
//!   at each of the angles. Angles run faster than BSDFs in the list of references.
//! - A `ttest` of emitters estimates the luminance that a sample of the emitter, alone in space, sends to
//!   (0, 0, distance): the irradiance of a surface there that faced each ray. Distances run faster.
//! - A `ttest` of scenes estimates the mean luminance of the film, or of its crop window if it has one,
//!   without reconstruction filter, by the scene's own integrator. A sample takes a pixel at random; what its
//!   eye path brings there and what its light path splats anywhere on the film are one observation. Light
//!   paths do not depend on the pixel and are as many as the pixels, so that this has the right mean for
//!   integrators with a light image too, without whole passes.
//! - A `chi2test` counts the directions that a BSDF samples in equal cells, given directions drawn uniformly:
//!   from the upper hemisphere, or from both if the BSDF transmits. A BSDF that is nothing but Dirac lobes
//!   fails, as in Nori, because there is no density to test; it is told once and why. A direction for which
//!   all cells are pooled into one fails too: nothing would have been tested.
//!
//! Textures of BSDFs are looked up at (½, ½).

mod chi_square;
mod parallel;
mod t_test;

use crate::info::material_name;
use crate::session::available_threads;
use caustica_import::{SceneTest, TestKind};
use caustica_math::stream::mix64;
use caustica_math::{Vec3, Wavelengths};
use caustica_scene::bsdf::Bsdf;
use caustica_scene::bvh::Ray;
use caustica_scene::description::{Geometry, MaterialId, Shape};
use caustica_scene::{Description, Diagnostic, Origin, Scene};
use serde::Serialize;

/// How tests are run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TestOptions {
    /// The seed of all sample streams.
    pub seed: u64,
    /// Worker threads; as many as the machine has if `None`.
    pub threads: Option<usize>,
}

/// What one of the comparisons that a test is made of came to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// The test by its number in the file, and what of it was compared.
    pub name: String,
    /// Whether it passed.
    pub passed: bool,
    /// One line: the figures, or why there are none.
    pub detail: String,
    /// Where in the file that stands.
    pub origin: Option<Origin>,
}

/// How many comparisons passed and failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Summary {
    /// Passed.
    pub passed: usize,
    /// Failed.
    pub failed: usize,
}

/// Runs the tests and tells each outcome as soon as it is known, in the order of the file.
pub fn run(tests: &[SceneTest], options: &TestOptions, on_result: &mut dyn FnMut(&Outcome)) -> Summary {
    let mut summary = Summary::default();
    let mut tell = |outcome: Outcome| {
        let count = if outcome.passed { &mut summary.passed } else { &mut summary.failed };
        *count += 1;
        on_result(&outcome);
    };
    let threads = options.threads.unwrap_or_else(available_threads).max(1);
    for (index, test) in tests.iter().enumerate() {
        let job = Job { test, number: index + 1, seed: stream_seed(options.seed, index as u64), threads };
        match &test.kind {
            TestKind::TTest { .. } => t_test::run(&job, &mut tell),
            TestKind::Chi2Test { .. } => chi_square::run(&job, &mut tell),
        }
    }
    summary
}

/// A test that is being run.
struct Job<'a> {
    test: &'a SceneTest,
    /// Its place in the file, from 1.
    number: usize,
    seed: u64,
    threads: usize,
}

impl Job<'_> {
    /// The outcome of a case; where no origin is known, the test's own.
    fn outcome(&self, name: &str, origin: Option<&Origin>, (passed, detail): (bool, String)) -> Outcome {
        let plugin = match self.test.kind {
            TestKind::TTest { .. } => "ttest",
            TestKind::Chi2Test { .. } => "chi2test",
        };
        let name = format!("{plugin} {}, {name}", self.number);
        Outcome { name, passed, detail, origin: origin.or(self.test.origin.as_ref()).cloned() }
    }

    /// The failure of a case that cannot be tested.
    fn refusal(&self, name: &str, origin: Option<&Origin>, why: &Diagnostic) -> Outcome {
        let hint = why.hint.as_ref().map_or(String::new(), |h| format!(" ({h})"));
        self.outcome(name, why.origin.as_ref().or(origin), (false, format!("{}{hint}", why.message)))
    }
}

/// The seed of part `index` of what has the seed `seed`.
fn stream_seed(seed: u64, index: u64) -> u64 {
    mix64(mix64(seed) ^ index)
}

/// The name of the BSDF under test of that index.
fn bsdf_name(stage: &Description, index: usize) -> String {
    let plugin = material_name(&stage.materials[index].kind);
    format!("bsdf {} ({plugin})", index + 1)
}

/// The BSDF under test of that index: that of a sphere at the middle of its texture.
fn bsdf(stage: &Description, index: usize) -> Result<Bsdf, Diagnostic> {
    let sphere = Shape {
        name: "sphere".to_owned(),
        geometry: Geometry::Sphere { center: Vec3::ZERO, radius: 1.0 },
        to_world: Default::default(),
        material: MaterialId(index as u32),
        emission: None,
        origin: None,
    };
    let (scene, _) = Scene::new(alone(stage, vec![sphere]))?;
    let ray = Ray { origin: Vec3::new(2.0, 0.0, 0.0), direction: -Vec3::X, t_max: f32::INFINITY };
    let point = scene.closest(&ray).ok_or_else(|| Diagnostic::error("the BSDF cannot be looked up"))?;
    Ok(scene.bsdf(&point, Wavelengths::Rgb))
}

/// Nothing but these shapes, with the materials and images of the stage.
fn alone(stage: &Description, shapes: Vec<Shape>) -> Description {
    Description {
        images: stage.images.clone(),
        materials: stage.materials.clone(),
        shapes,
        ..Description::default()
    }
}

/// A number in six digits.
fn figure(x: f64) -> String {
    if x == 0.0 || (1e-3..1e5).contains(&x.abs()) { format!("{x:.6}") } else { format!("{x:.5e}") }
}
