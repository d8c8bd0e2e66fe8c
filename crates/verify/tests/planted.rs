//! Planted faults are found on every scene of the gallery where they can show. Needs the feature `planted-fault`.
//!
//! Most pictures are half as large as those of `caustica verify`, and have half as many samples, so that all of this
//! takes minutes.

use std::path::Path;
use std::sync::Mutex;
use std::time::Instant;

use caustica_import::load;
use caustica_render::Control;
use caustica_scene::Scene;
use caustica_testkit::agreement::flatten;
use caustica_testkit::scenes::{plastic_kind, under_the_sky};
use caustica_transport::fault::{Fault, plant};
use caustica_verify::{Options, shrink, verify};

/// Faults are planted in the whole process.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

fn scene(name: &str, side: u32) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenes/{name}/{name}.xml"));
    let mut description = load(&path).unwrap().scene.unwrap();
    shrink(&mut description.film, side);
    Scene::new(description).unwrap().0
}

/// Finds all faults on a scene of the gallery but those that change nothing there.
fn finds(name: &str, harmless: &[Fault]) {
    finds_at((48, 64), name, harmless);
}

/// The same in a picture of that longest side, with so many samples.
fn finds_at((side, samples): (u32, u32), name: &str, harmless: &[Fault]) {
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(|e| e.into_inner());
    let scene = scene(name, side);
    let mut missed = Vec::new();
    for (fault_name, fault) in Fault::ALL.into_iter().filter(|(_, f)| !harmless.contains(f)) {
        plant(Some(fault));
        let start = Instant::now();
        let options = Options { samples, ..Options::default() };
        let outcome = verify(&scene, &options, &Control::default(), |_| ()).unwrap();
        plant(None);
        let caught: Vec<_> =
            outcome.tested.iter().filter(|t| t.mismatches > 0).map(|t| t.estimator.name.as_str()).collect();
        println!("{name:<12} {fault_name:<24} {:5.1} s  {caught:?}", start.elapsed().as_secs_f64());
        if outcome.agrees() {
            missed.push(fault_name);
        }
    }
    assert!(missed.is_empty(), "{name}: {missed:?}");
}

/// Only light from infinity has such an edge, which the gallery does not; and what is wrong with a weight that is small
/// anyway changes the picture by less than so few samples show. The sky has light enough for all of them.
const SMALL: [Fault; 3] = [Fault::InfinityJacobian, Fault::NextEventDensity, Fault::SwappedDensities];

#[test]
fn light_from_infinity() {
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(|e| e.into_inner());
    let scene = flatten(under_the_sky(plastic_kind()));
    for fault in std::iter::once(None).chain(SMALL.map(Some)) {
        plant(fault);
        let options = Options { samples: 128, block: 4, ..Options::default() };
        let outcome = verify(&scene, &options, &Control::default(), |_| ()).unwrap();
        plant(None);
        assert_eq!(outcome.agrees(), fault.is_none(), "{fault:?}");
    }
}

/// The size and the samples of `caustica verify`, for scenes that need them.
const FULL: (u32, u32) = (96, 128);

#[test]
fn bulb() {
    finds("bulb", &SMALL);
}

#[test]
fn cornell() {
    finds("cornell", &SMALL[..2]);
}

#[test]
fn final_() {
    finds("final", &SMALL);
}

#[test]
fn furnace() {
    finds("furnace", &SMALL);
}

#[test]
fn gap() {
    finds("gap", &SMALL);
}

#[test]
fn glass() {
    finds("glass", &SMALL);
}

#[test]
fn inverted() {
    finds("inverted", &SMALL);
}

#[test]
fn long_way() {
    // Hardly any of its light is found by next-event estimation.
    let [a, b, c] = SMALL;
    finds_at(FULL, "long-way", &[a, b, c, Fault::LampCosine]);
}

#[test]
fn many_lamps() {
    // Next-event estimation finds nearly all, by lamps of all directions: little else shows in so few samples.
    let [a, b, c] = SMALL;
    finds("many-lamps", &[a, b, c, Fault::Adjoint, Fault::LightPaths, Fault::LampCosine]);
}

#[test]
fn veach_mi() {
    finds("veach-mi", &SMALL);
}
