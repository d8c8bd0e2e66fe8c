//! Random valid scenes, rendered by every integrator.

use caustica_math::{Filter, Sampler, Vec3};
use caustica_render::{Control, INTEGRATOR_NAMES, RenderOptions, Session, integrator_by_name};
use caustica_scene::Scene;
use caustica_testkit::random_scene::{Choices, bytes_of_seed, random_scene};
use caustica_transport::{Heuristic, Settings};
use caustica_verify as verify;

/// Samples a pixel of every render: as many units of work, so that two threads share them.
const SAMPLES: u32 = 3;

/// Edges of the longest paths of these, if there is no other limit: verifying weighs all pairs of vertices of each path.
const LONGEST_TO_AGREE: u32 = 32;

/// Samples a pixel of the renders that must agree.
const SAMPLES_TO_AGREE: u32 = 16;

/// The probability that a scene is told to be rendered wrongly although it is not: there are thousands of them.
const FALSE_ALARM: f64 = 1e-7;

/// Builds a scene out of the bytes and checks all that is known of it.
///
/// # Panics
/// If a promise is broken.
pub fn scenes(data: &[u8]) {
    let mut choices = Choices::new(data);
    let settings = settings(&mut choices);
    // Extreme scales may leave a triangle or a camera without a normal, which is an error with words.
    let Ok((scene, warnings)) = Scene::new(random_scene(&mut choices)) else { return };
    renders_soundly(&scene, &settings);
    // Of a lamp in the plane of another surface it is left to rounding who finds it.
    if is_moderate(&scene) && !warnings.iter().any(|w| w.message.contains("in the plane of another surface"))
    {
        integrators_agree(&scene, &settings);
    }
}

/// Inputs to start from.
pub fn seeds() -> Vec<Vec<u8>> {
    (0..64).map(bytes_of_seed).collect()
}

/// How the scene is rendered, but for the integrator.
fn settings(choices: &mut Choices) -> Settings {
    let sets = ["all", "t>=2", "s=0;s=1", "t=1", "2,2"];
    Settings {
        seed: choices.below(256) as u64,
        max_depth: [None, Some(3), Some(5), Some(12)][choices.below(4)],
        roulette_start: [None, Some(1), Some(9)][choices.below(3)],
        sampler: [Sampler::Sobol, Sampler::Independent][choices.below(2)],
        heuristic: [Heuristic::Balance, Heuristic::Power][choices.below(2)],
        exhaustive_weights: choices.once_in(8),
        shared_light_paths: [1, 2, 4, 8, 16][choices.below(5)],
        strategies: choices.pick(&sets).parse().expect("a set of strategies"),
        ..Settings::default()
    }
}

/// Whether no product of a few quantities of the scene leaves the range of an `f32`: otherwise contributions may be no
/// numbers, and are counted.
fn is_moderate(scene: &Scene) -> bool {
    let ((_, radius), power) = (scene.bounding_sphere(), scene.lamps().power());
    let extreme_filter = match scene.film.filter {
        Filter::Mitchell { b, c, .. } => b.abs().max(c.abs()) > 10.0,
        _ => false,
    };
    (1e-4..1e4).contains(&radius) && power < 1e12 && !extreme_filter
}

/// All integrators and strategies find the same light, as far as they reach it.
fn integrators_agree(scene: &Scene, settings: &Settings) {
    let options = verify::Options {
        settings: Settings { max_depth: settings.max_depth.or(Some(LONGEST_TO_AGREE)), ..settings.clone() },
        samples: SAMPLES_TO_AGREE,
        significance: FALSE_ALARM,
        threads: Some(2),
        ..verify::Options::default()
    };
    let outcome = verify::verify(scene, &options, &Control::default(), |_| {});
    let outcome = outcome.unwrap_or_else(|e| panic!("{e}"));
    for tested in outcome.tested {
        let (name, p) = (&tested.estimator.name, tested.smallest_p());
        assert!(tested.verdict != verify::Verdict::Mismatch, "{name} differs: p = {p:.1e}");
    }
}

/// Every integrator gives finite pixels, none of them negative unless the filter is, and the same bits on one
/// thread and on two.
fn renders_soundly(scene: &Scene, settings: &Settings) {
    let (_, radius) = scene.bounding_sphere();
    for (name, _) in INTEGRATOR_NAMES {
        let [eye, forward] = [scene.camera.position(), scene.camera.forward()].map(|v: Vec3| [v.x, v.y, v.z]);
        let integrator = integrator_by_name(name, 2.0 * radius, eye, forward);
        let settings = Settings { integrator: integrator.expect("a known name"), ..settings.clone() };
        let render = |threads| {
            let options = RenderOptions {
                settings: settings.clone(),
                samples: SAMPLES,
                threads: Some(threads),
                ..RenderOptions::default()
            };
            let session = Session::new(scene, options).unwrap_or_else(|e| panic!("{name}: {e}"));
            session.run(&Control::default(), |_| {}).unwrap_or_else(|e| panic!("{name}: {e}"));
            session
        };
        let (one, two) = (render(1), render(2));
        assert!(one.film().bits_equal(two.film()), "{name}: one thread and two differ");
        if is_moderate(scene) {
            assert_eq!(one.film().counts().invalid, 0, "{name}: contributions that are no numbers");
        }
        let picture = one.film().develop();
        let may_be_negative = scene.film.filter.has_lobes();
        for (layer, pixels) in [("eye", &picture.eye), ("light", &picture.light)] {
            for (i, pixel) in pixels.iter().enumerate() {
                let sound = pixel.0.iter().all(|c| c.is_finite() && (*c >= 0.0 || may_be_negative));
                assert!(sound, "{name}: pixel {i} of the {layer} image is {:?}", pixel.0);
            }
        }
    }
}
