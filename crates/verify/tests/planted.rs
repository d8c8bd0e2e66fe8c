//! Planted faults are found on every scene of the gallery where they can show, by what `caustica verify` does unless
//! told otherwise. Needs the feature `planted-fault`.

use std::path::Path;
use std::time::Instant;

use caustica_import::load;
use caustica_render::Control;
use caustica_scene::Scene;
use caustica_transport::fault::{Fault, plant};
use caustica_verify::{Options, shrink, verify};

/// The gallery, with the faults that change nothing there.
const GALLERY: [(&str, &[Fault]); 10] = [
    ("bulb", &[]),
    ("cornell", &[]),
    ("final", &[]),
    ("furnace", &[]),
    ("gap", &[]),
    ("glass", &[]),
    ("inverted", &[]),
    ("long-way", &[]),
    ("many-lamps", &[]),
    ("veach-mi", &[]),
];

fn scene(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../scenes/{name}/{name}.xml"));
    let mut description = load(&path).unwrap().scene.unwrap();
    shrink(&mut description.film, 96);
    Scene::new(description).unwrap().0
}

#[test]
fn faults_are_found_in_the_gallery() {
    let mut missed = Vec::new();
    for (name, harmless) in GALLERY {
        let scene = scene(name);
        for (fault_name, fault) in Fault::ALL.into_iter().filter(|(_, f)| !harmless.contains(f)) {
            plant(Some(fault));
            let start = Instant::now();
            let outcome = verify(&scene, &Options::default(), &Control::default(), |_| ()).unwrap();
            plant(None);
            let caught: Vec<_> =
                outcome.tested.iter().filter(|t| t.mismatches > 0).map(|t| t.estimator.name.as_str()).collect();
            println!("{name:<12} {fault_name:<24} {:5.1} s  {caught:?}", start.elapsed().as_secs_f64());
            if outcome.agrees() {
                missed.push((name, fault_name));
            }
        }
    }
    assert!(missed.is_empty(), "{missed:?}");
}
