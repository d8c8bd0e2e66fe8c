//! Planted faults are found on every scene of the gallery where they can show. Needs the feature `planted-fault`.
//!
//! Pictures are half as large as those of `caustica verify`, and have half as many samples, so that all of this takes
//! minutes.

use std::path::Path;
use std::sync::Mutex;
use std::time::Instant;

use caustica_import::load;
use caustica_render::Control;
use caustica_scene::Scene;
use caustica_transport::fault::{Fault, plant};
use caustica_verify::{Options, shrink, verify};

/// Faults are planted in the whole process.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

fn scene(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenes/{name}/{name}.xml"));
    let mut description = load(&path).unwrap().scene.unwrap();
    shrink(&mut description.film, 48);
    Scene::new(description).unwrap().0
}

/// Finds all faults on a scene of the gallery but those that change nothing there.
fn finds(name: &str, harmless: &[Fault]) {
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(|e| e.into_inner());
    let scene = scene(name);
    let mut missed = Vec::new();
    for (fault_name, fault) in Fault::ALL.into_iter().filter(|(_, f)| !harmless.contains(f)) {
        plant(Some(fault));
        let start = Instant::now();
        let options = Options { samples: 64, ..Options::default() };
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

/// Only light from infinity has such an edge.
const INFINITY: Fault = Fault::InfinityJacobian;

#[test]
fn bulb() {
    finds("bulb", &[INFINITY]);
}

#[test]
fn cornell() {
    finds("cornell", &[INFINITY]);
}

#[test]
fn final_() {
    finds("final", &[INFINITY]);
}

#[test]
fn furnace() {
    finds("furnace", &[INFINITY]);
}

#[test]
fn gap() {
    finds("gap", &[INFINITY]);
}

#[test]
fn glass() {
    finds("glass", &[INFINITY]);
}

#[test]
fn inverted() {
    finds("inverted", &[INFINITY]);
}

#[test]
fn long_way() {
    finds("long-way", &[INFINITY]);
}

#[test]
fn many_lamps() {
    finds("many-lamps", &[INFINITY]);
}

#[test]
fn veach_mi() {
    finds("veach-mi", &[INFINITY]);
}
