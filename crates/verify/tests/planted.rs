//! Planted faults are found on the scenes of the gallery, each within a minute of one CPU. Needs the feature
//! `planted-fault`.
//!
//! Most pictures are half as large as those of `caustica verify`, and have half as many samples, so that all of this
//! takes minutes. The table below states which faults must be found on which scene. What is not in it is a fault that
//! changes the scene's picture by less than so few samples show: a weight that is wrong by half changes nothing where
//! it is small anyway.

use std::path::Path;
use std::sync::Mutex;

use caustica_import::load;
use caustica_render::Control;
use caustica_scene::Scene;
use caustica_testkit::agreement::flatten;
use caustica_testkit::scenes::{plastic_kind, under_the_sky};
use caustica_transport::fault::Fault::{self, *};
use caustica_transport::fault::plant;
use caustica_verify::{Options, Outcome, shrink, verify};

/// Faults are planted in the whole process.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// A minute of one CPU.
const SECONDS: f64 = 60.0;

/// A scene of the gallery and what must be found on it.
struct Case {
    scene: &'static str,
    /// The longest side of the picture, and samples per pixel.
    size: (u32, u32),
    found: &'static [Fault],
    also: &'static [Fault],
}

impl Case {
    fn all(&self) -> impl Iterator<Item = Fault> {
        self.found.iter().chain(self.also).copied()
    }
}

const SMALL: (u32, u32) = (48, 64);
/// That of `caustica verify`, for scenes that need it.
const FULL: (u32, u32) = (96, 128);

/// Found wherever walks are scattered and joined.
const USUAL: [Fault; 4] = [Adjoint, LightPaths, Roulette, LampCosine];

const CASES: [Case; 10] = [
    Case { scene: "bulb", size: SMALL, found: &USUAL, also: &[] },
    Case { scene: "cornell", size: SMALL, found: &USUAL, also: &[SwappedDensities] },
    Case { scene: "final", size: SMALL, found: &USUAL, also: &[SwappedDensities] },
    Case { scene: "furnace", size: SMALL, found: &USUAL, also: &[SwappedDensities] },
    // The adjoint is missed: what it changes is within the noise here, as in long-way.
    Case { scene: "gap", size: SMALL, found: &[LightPaths, Roulette, LampCosine], also: &[] },
    Case { scene: "glass", size: SMALL, found: &USUAL, also: &[] },
    Case { scene: "inverted", size: SMALL, found: &USUAL, also: &[SwappedDensities, NextEventDensity] },
    // Hardly any of its light is found by next-event estimation.
    Case { scene: "long-way", size: FULL, found: &[LightPaths, Roulette], also: &[] },
    // Next-event estimation finds nearly all of its light, by lamps of all directions.
    Case { scene: "many-lamps", size: SMALL, found: &[Roulette], also: &[] },
    Case { scene: "veach-mi", size: SMALL, found: &USUAL, also: &[NextEventDensity] },
];

/// Seconds of CPU time of this process so far, in its own code and the system's: a busy machine does not count. Nothing
/// where the system does not tell.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = stat.rsplit(") ").next().unwrap_or_default().split(' ').collect();
    let ticks = |i: usize| fields.get(i).and_then(|t| t.parse::<f64>().ok()).unwrap_or(0.0);
    // Fields 14 and 15 of proc(5), counted from after the name; a hundred ticks a second everywhere.
    (ticks(11) + ticks(12)) / 100.0
}

fn scene(name: &str, side: u32) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenes/{name}/{name}.xml"));
    let mut description = load(&path).unwrap().scene.unwrap();
    shrink(&mut description.film, side);
    Scene::new(description).unwrap().0
}

/// What `verify` says of a scene with that fault planted, and the CPU time that it took.
fn verified(scene: &Scene, fault: Option<Fault>, options: &Options) -> (Outcome, f64) {
    plant(fault);
    let start = cpu_seconds();
    let outcome = verify(scene, options, &Control::default(), |_| ()).unwrap();
    plant(None);
    (outcome, cpu_seconds() - start)
}

fn name(fault: Fault) -> &'static str {
    Fault::ALL.iter().find(|(_, f)| *f == fault).unwrap().0
}

/// Finds the faults of the table on a scene.
fn finds(scene_name: &str) {
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(|e| e.into_inner());
    let case = CASES.iter().find(|c| c.scene == scene_name).unwrap();
    let (side, samples) = case.size;
    let scene = scene(scene_name, side);
    let options = Options { samples, ..Options::default() };
    for fault in case.all() {
        let (outcome, seconds) = verified(&scene, Some(fault), &options);
        let caught: Vec<_> =
            outcome.tested.iter().filter(|t| t.mismatches > 0).map(|t| t.estimator.name.as_str()).collect();
        println!("{scene_name:<12} {:<24} {seconds:5.1} s  {caught:?}", name(fault));
        assert!(!outcome.agrees(), "{scene_name}: {} was missed", name(fault));
        assert!(seconds < SECONDS, "{scene_name}: {} took {seconds} s", name(fault));
    }
}

/// Faults that show under an environment only, or little elsewhere.
const BY_THE_SKY: [Fault; 3] = [InfinityJacobian, NextEventDensity, SwappedDensities];

#[test]
fn light_from_infinity() {
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(|e| e.into_inner());
    let scene = flatten(under_the_sky(plastic_kind()));
    for fault in std::iter::once(None).chain(BY_THE_SKY.map(Some)) {
        let options = Options { samples: 128, block: 4, ..Options::default() };
        let (outcome, seconds) = verified(&scene, fault, &options);
        assert_eq!(outcome.agrees(), fault.is_none(), "{fault:?}");
        assert!(seconds < SECONDS, "{fault:?} took {seconds} s");
    }
}

/// No fault is left out, and every scene finds some.
#[test]
fn every_fault_must_be_found_somewhere() {
    for (name, fault) in Fault::ALL {
        assert!(CASES.iter().any(|c| c.all().any(|f| f == fault)) || BY_THE_SKY.contains(&fault), "{name}");
    }
    assert!(CASES.iter().all(|c| !c.found.is_empty()));
}

/// Scenes without a fault agree at these sizes, or finding one would mean nothing.
#[test]
fn without_a_fault_nothing_is_found() {
    let _alone = ONE_AT_A_TIME.lock().unwrap_or_else(|e| e.into_inner());
    for case in &CASES {
        let (side, samples) = case.size;
        let options = Options { samples, ..Options::default() };
        let (outcome, seconds) = verified(&scene(case.scene, side), None, &options);
        println!("{:<12} {:<24} {seconds:5.1} s", case.scene, "no fault");
        assert!(outcome.agrees(), "{}", case.scene);
    }
}

#[test]
fn bulb() {
    finds("bulb");
}

#[test]
fn cornell() {
    finds("cornell");
}

#[test]
fn final_() {
    finds("final");
}

#[test]
fn furnace() {
    finds("furnace");
}

#[test]
fn gap() {
    finds("gap");
}

#[test]
fn glass() {
    finds("glass");
}

#[test]
fn inverted() {
    finds("inverted");
}

#[test]
fn long_way() {
    finds("long-way");
}

#[test]
fn many_lamps() {
    finds("many-lamps");
}

#[test]
fn veach_mi() {
    finds("veach-mi");
}
