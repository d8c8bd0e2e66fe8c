//! Scenes on which all estimators agree, and what is told of their reach.

use caustica_math::{Filter, Rgb};
use caustica_render::Control;
use caustica_scene::description::{CameraKind, Crop, LightKind};
use caustica_testkit::agreement::flatten;
use caustica_testkit::{build, scenes};
use caustica_transport::Settings;
use caustica_verify::{Options, Outcome, Verdict, VerifyError, verify};

fn options(samples: u32, seed: u64) -> Options {
    let settings = Settings { seed, max_depth: Some(8), ..Settings::default() };
    Options { settings, samples, block: 4, ..Options::default() }
}

fn table(outcome: &Outcome) -> String {
    let line = |t: &caustica_verify::Tested| {
        let (name, tests, p) = (&t.estimator.name, t.tests(), t.smallest_p());
        format!("{name}: {:?}, {tests} tests, p = {p:.1e}, untested {:.2}\n", t.verdict, t.untested)
    };
    outcome.tested.iter().map(line).collect()
}

#[test]
fn a_box_with_a_ball_agrees_and_says_who_reaches_what() {
    let scene = flatten(scenes::ball(scenes::glass_kind(false)));
    let outcome = verify(&scene, &options(64, 3), &Control::default(), |_| ()).unwrap();
    assert!(outcome.agrees(), "{}", table(&outcome));
    let of = |name: &str| outcome.tested.iter().position(|t| t.estimator.name == name).unwrap();
    assert!(outcome.missed(of("bdpt")).is_empty() && outcome.missed(of("naive")).is_empty());
    let missed = outcome.missed(of("light"));
    assert!(missed.iter().any(|m| m.pattern == "LDS+E"), "{missed:?}");
    assert!(missed.iter().map(|m| m.share).sum::<f64>() < 0.6, "{missed:?}");
    assert!(outcome.tested[of("path")].tests() > 10, "{}", table(&outcome));
}

#[test]
fn what_reaches_nothing_is_no_mismatch() {
    let point = LightKind::Point { position: [0.3, 0.6, -0.2], intensity: Rgb::splat(3.0) };
    let scene = flatten(scenes::lit_by(point));
    let outcome = verify(&scene, &options(64, 1), &Control::default(), |_| ()).unwrap();
    assert!(outcome.agrees(), "{}", table(&outcome));
    for t in &outcome.tested {
        let nothing = ["naive", "bdpt, s=0"].contains(&t.estimator.name.as_str());
        assert_eq!(t.verdict == Verdict::NothingToReach, nothing, "{}", table(&outcome));
    }
}

#[test]
fn outcomes_do_not_depend_on_threads() {
    let scene = flatten(scenes::ball(scenes::plastic_kind()));
    let run = |threads| {
        let options = Options { threads: Some(threads), ..options(16, 5) };
        verify(&scene, &options, &Control::default(), |_| ()).unwrap()
    };
    let (a, b) = (run(1), run(3));
    assert_eq!(table(&a), table(&b));
    assert_eq!(a.reference_pixels(), b.reference_pixels());
    for (a, b) in a.tested.iter().zip(&b.tested) {
        assert_eq!(a.picture.pixels, b.picture.pixels);
    }
}

/// Found by fuzzing random scenes: eye paths that see an environment alone have no variance, and the few splats that
/// the rest of its light comes by fell on no pixel, as the filter is narrow. It was told as a mismatch.
#[test]
fn rare_splats_beside_steady_light_are_no_mismatch() {
    let mut d = build::scene(6);
    d.camera.kind = CameraKind::Perspective { fov: 134.0 };
    d.film.crop = Some(Crop { x: 0, y: 4, width: 6, height: 2 });
    d.film.filter = Filter::Tent { radius: 0.264 };
    let material = build::diffuse(&mut d, 0.5);
    build::sphere(&mut d, [0.0, 0.0, -9.0], 0.1, material);
    build::light(&mut d, LightKind::Constant { radiance: Rgb::WHITE });
    let scene = flatten(d);
    for (samples, seeds) in [(16, 0..40), (64, 40..70), (256, 70..80)] {
        for seed in seeds {
            let options = Options { significance: 1e-4, block: 8, ..options(samples, seed) };
            let outcome = verify(&scene, &options, &Control::default(), |_| ()).unwrap();
            assert!(outcome.agrees(), "{samples} samples, seed {seed}:\n{}", table(&outcome));
        }
    }
}

#[test]
fn what_cannot_be_is_an_error() {
    let scene = flatten(scenes::open_box());
    let few = verify(&scene, &options(4, 0), &Control::default(), |_| ());
    assert!(matches!(few, Err(VerifyError::TooFewSamples(4))));
    let control = Control::default();
    control.stop();
    assert!(matches!(verify(&scene, &options(8, 0), &control, |_| ()), Err(VerifyError::Stopped)));
}

/// Twenty seeds, at a significance of 0.2 each: four false alarms are expected at most, ten would be one in 400.
#[test]
fn false_alarms_are_no_more_than_stated() {
    let scene = flatten(scenes::ball(scenes::glass_kind(false)));
    let alarms = (0..20).filter(|seed| {
        let options = Options { significance: 0.2, ..options(32, 1000 + seed) };
        let outcome = verify(&scene, &options, &Control::default(), |_| ()).unwrap();
        !outcome.agrees()
    });
    let alarms = alarms.count();
    println!("{alarms} of 20");
    assert!(alarms < 10, "{alarms}");
}
