//! A small comparison from start to end.

use std::time::Duration;

use caustica_compare::{
    CompareError, DEFAULT_METHODS, EYE_ONLY, Event, Method, Options, Outcome, ReferenceChoice, compare,
};
use caustica_math::Rgb;
use caustica_render::{Budget, Control, integrator_by_name};
use caustica_scene::Scene;
use caustica_testkit::agreement::flatten;
use caustica_testkit::scenes::open_box;
use caustica_transport::Settings;

fn scene() -> Scene {
    flatten(open_box())
}

fn base() -> Settings {
    Settings { max_depth: Some(6), seed: 3, ..Settings::default() }
}

fn methods(names: &[&str]) -> Vec<Method> {
    let by_name = |name: &&str| match *name {
        EYE_ONLY => Method::eye_only(&base()),
        name => Method::new(integrator_by_name(name, 1.0, [0.0; 3], [0.0; 3]).unwrap(), &base()),
    };
    names.iter().map(by_name).collect()
}

fn samples(samples: u32) -> Budget {
    Budget { samples, time: None }
}

fn run(names: &[&str], budget: Budget, reference: ReferenceChoice) -> Result<Outcome, CompareError> {
    let options = Options { methods: methods(names), budget, reference, threads: Some(2) };
    compare(&scene(), &options, &Control::default(), |_| Ok(()))
}

#[test]
fn equal_samples() {
    let made = ReferenceChoice::Made(base(), samples(256));
    let outcome = run(&DEFAULT_METHODS, samples(20), made).unwrap();
    let page = outcome.page("box", "open_box", vec![("depth".into(), "6".into())]).unwrap();
    let names: Vec<_> = page.entries.iter().map(|e| e.shown.name.as_str()).collect();
    assert_eq!(names, DEFAULT_METHODS);
    for e in &page.entries {
        let counts: Vec<_> = e.curve.iter().map(|p| p.samples).collect();
        assert_eq!(counts, [1.0, 2.0, 5.0, 10.0, 20.0], "{}", e.shown.name);
        assert!(e.curve.windows(2).all(|w| w[0].seconds < w[1].seconds));
        assert_eq!((e.metrics.samples, e.metrics.seconds), (20.0, e.curve[4].seconds));
        assert!(e.curve[4].rel_mse < 0.5 * e.curve[0].rel_mse, "{}: {:?}", e.shown.name, e.curve);
        assert!((e.metrics.mean / page.entries[4].metrics.mean - 1.0).abs() < 0.1, "{}", e.shown.name);
    }
    let error =
        |name: &str| page.entries.iter().find(|e| e.shown.name == name).unwrap().metrics.rel_mse.unwrap();
    assert!(error("bdpt") < error("naive") && error("path") < error("naive"));
    assert!(page.speedups.iter().any(|s| s.slower == "naive" && s.factor > 0.0));
    assert_eq!(page.notes[0].0, "depth");
    assert!(page.notes[1].1.starts_with("bdpt, 256 samples"), "{:?}", page.notes);
    assert!(!page.insets.is_empty());
    let folder = std::env::temp_dir().join(format!("caustica-compare-{}", std::process::id()));
    caustica_report::write_comparison(&page, &folder).unwrap();
    let json = std::fs::read_to_string(folder.join("report.json")).unwrap();
    assert!(json.contains("rel_mse") && folder.join("index.html").exists());
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn equal_time() {
    let budget = Budget { samples: u32::MAX, time: Some(Duration::from_millis(400)) };
    let made = ReferenceChoice::Made(base(), Budget { time: Some(Duration::from_millis(200)), ..budget });
    let outcome = run(&["path", "bdpt"], budget, made).unwrap();
    for e in outcome.page("", "", Vec::new()).unwrap().entries {
        assert!(e.curve.len() >= 3 && e.metrics.seconds > 0.3, "{:?}", e.curve);
        assert!(e.curve.windows(2).all(|w| w[0].samples < w[1].samples));
    }
}

/// The pictures are those that sessions without pauses make.
#[test]
fn pauses_change_nothing() {
    let given = || ReferenceChoice::Given(vec![Rgb::WHITE; open_pixels()], "white".into());
    let whole = run(&["bdpt"], samples(13), given()).unwrap();
    let scene = scene();
    let options = caustica_render::RenderOptions {
        settings: base(),
        samples: 13,
        threads: Some(1),
        ..Default::default()
    };
    let session = caustica_render::Session::new(&scene, options).unwrap();
    session.run(&Control::default(), |_| ()).unwrap();
    assert_eq!(whole.entrants[0].picture, session.film().develop());
}

fn open_pixels() -> usize {
    let window = scene().film.window();
    (window.width * window.height) as usize
}

#[test]
fn a_reference_must_fit() {
    let given = ReferenceChoice::Given(vec![Rgb::WHITE; 7], "seven".into());
    let error = run(&["path"], samples(1), given).unwrap_err();
    assert!(matches!(error, CompareError::Reference { found: 7, .. }), "{error}");
}

#[test]
fn everything_is_told_as_it_happens() {
    let options = Options {
        methods: methods(&["path", "bdpt"]),
        budget: samples(4),
        reference: ReferenceChoice::Made(base(), samples(8)),
        threads: Some(1),
    };
    let mut told = Vec::new();
    let tell = |event: Event<'_>| {
        match event {
            Event::Rendering(stage, p) => assert!(p.fraction <= 1.0 && stage.count == 3),
            Event::Measuring(stage) => told.push(format!("measuring {} {}", stage.name, stage.index)),
            Event::Reference(r) => told.push(format!("reference {}", r.made.unwrap().samples)),
            Event::Done(e) => told.push(format!("done {}", e.method.name)),
        }
        Ok::<_, CompareError>(())
    };
    compare(&scene(), &options, &Control::default(), tell).unwrap();
    assert_eq!(told, ["reference 8", "measuring path 1", "done path", "measuring bdpt 2", "done bdpt"]);
    let failing = |event: Event<'_>| match event {
        Event::Done(_) => Err(CompareError::Nothing),
        _ => Ok(()),
    };
    assert!(compare(&scene(), &options, &Control::default(), failing).is_err());
}

/// The reference's own error, from its halves, is what it differs by from a much better one.
#[test]
fn references_know_their_error() {
    let made = |n| ReferenceChoice::Made(base(), samples(n));
    let rough = run(&["path"], samples(1), made(16)).unwrap().reference;
    let fine =
        run(&["path"], samples(1), ReferenceChoice::Made(Settings { seed: 99, ..base() }, samples(4096)));
    let fine = fine.unwrap().reference.pixels;
    let window = scene().film.window();
    let image = |pixels| caustica_metrics::Image::new(window.width, window.height, pixels).unwrap();
    let truth = caustica_metrics::errors(image(&rough.pixels), image(&fine)).unwrap().rel_mse;
    let told = rough.made.unwrap().rel_mse.unwrap();
    assert!((told / truth - 1.0).abs() < 0.3, "{told} {truth}");
}

#[test]
fn stopping_keeps_what_there_is() {
    let control = Control::default();
    control.stop();
    let reference = ReferenceChoice::Given(vec![Rgb::WHITE; open_pixels()], "white".into());
    let options = Options { methods: methods(&["path"]), budget: samples(4), reference, threads: None };
    let outcome = compare(&scene(), &options, &control, |_| Ok::<_, CompareError>(())).unwrap();
    assert!(outcome.entrants.is_empty());
    assert!(outcome.page("", "", Vec::new()).unwrap().entries.is_empty());
}
