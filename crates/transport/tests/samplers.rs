//! Stratified samples have the same mean as independent ones, and less noise.
//!
//! Every observation is a picture of a seed of its own, so that observations are independent of each other, as the
//! tests of significance suppose.

use caustica_math::stats::Moments;
use caustica_math::{Filter, Sampler};
use caustica_scene::Description;
use caustica_scene::description::CameraKind;
use caustica_testkit::agreement::{Estimate, Plan, agree, estimate, flatten};
use caustica_testkit::scenes::*;
use caustica_testkit::ways::Way::{self, *};
use caustica_transport::Settings;

/// Moments over the pictures of `pictures` seeds, each of `passes` samples a pixel.
fn pictures(d: &Description, settings: &Settings, (pictures, passes): (u64, u32)) -> Estimate {
    let scene = flatten(d.clone());
    let mut all = Estimate { blocks: Vec::new(), whole: Moments::default() };
    for seed in 0..pictures {
        let settings = Settings { seed: settings.seed + seed, ..settings.clone() };
        let e = estimate(&scene, &settings, Plan { passes, block: 4, only: None });
        all.blocks.resize(e.blocks.len(), Moments::default());
        all.blocks.iter_mut().zip(&e.blocks).for_each(|(all, block)| all.push(block.mean));
        all.whole.push(e.whole.mean);
    }
    all
}

/// By how much stratified pictures have less variance, in the mean over the blocks.
fn check(name: &str, d: &Description, way: Way, (count, passes): (u64, u32)) -> f64 {
    let by = |sampler, seed| pictures(d, &Settings { sampler, ..way.settings(seed) }, (count, passes));
    let (sobol, independent) = (by(Sampler::Sobol, 1000), by(Sampler::Independent, 5000));
    if let Err(message) = agree(&sobol, &independent) {
        panic!("{name} by {way:?}: {message}");
    }
    let noise = |e: &Estimate| e.blocks.iter().map(Moments::variance).sum::<f64>();
    let gain = noise(&independent) / noise(&sobol);
    println!("{name} {way:?}, {passes} passes: {gain:.2}");
    gain
}

#[test]
fn samplers_agree_and_stratified_ones_gain() {
    for (way, least) in [(Path, 5.0), (Bdpt, 3.0), (Light, 1.5), (Emitters, 5.0), (Naive, 1.5)] {
        for passes in [1, 16] {
            let gain = check("box", &open_box(), way, (60, passes));
            assert!(passes == 1 || gain > least, "{way:?}: {gain}");
        }
    }
}

#[test]
fn samplers_agree_on_every_kind_of_number() {
    check("glass", &ball(glass_kind(false)), Bdpt, (40, 16));
    check("plastic", &ball(plastic_kind()), Path, (60, 7));
    check("sky", &under_the_sky(rough_glass_kind()), Bdpt, (60, 16));
    check("textured", &textured(), Bdpt, (60, 16));
    let mut lens = ball(metal_kind(Some(0.3)));
    lens.camera.kind = CameraKind::ThinLens { fov: 45.0, aperture_radius: 0.2, focus_distance: 2.5 };
    lens.film.filter = Filter::Tent { radius: 1.0 };
    for way in [Bdpt, Path, Light] {
        check("thin lens", &lens, way, (60, 16));
    }
}
