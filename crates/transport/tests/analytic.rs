//! Scenes whose radiance is known exactly, for every integrator that can reach it.

use caustica_scene::description::{Integrator, Technique};
use caustica_testkit::agreement::{Plan, estimate, flatten, is_close};
use caustica_testkit::scenes;
use caustica_transport::Settings;

/// The whole picture's mean must be within ±0.2%.
const TOLERANCE: f64 = 0.002;

fn check(name: &str, description: caustica_scene::Description, integrator: Integrator, passes: u32) {
    let scene = flatten(description);
    let settings = Settings { integrator, ..Settings::default() };
    let e = estimate(&scene, &settings, Plan { passes, block: 8, only: None });
    println!("{name} {integrator:?}: {:.6} ± {:.6}", e.whole.mean, e.whole.variance_of_mean().sqrt());
    if let Err(message) = is_close(&e, 1.0, TOLERANCE) {
        panic!("{name} by {integrator:?}: {message}");
    }
}

const PATHS: [Integrator; 5] = [
    Integrator::Path(Technique::Materials),
    Integrator::Path(Technique::Emitters),
    Integrator::Path(Technique::Mis),
    Integrator::Light,
    Integrator::Bdpt,
];

#[test]
fn emission_one_half() {
    for i in PATHS {
        check("furnace", scenes::furnace(), i, 8000);
    }
}

#[test]
fn point_light_at_the_centre() {
    for i in &PATHS[1..] {
        check("point", scenes::point_furnace(1), *i, 8000);
        check("four points", scenes::point_furnace(4), *i, 8000);
    }
}
