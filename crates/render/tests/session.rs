//! Sessions: what is rendered depends on neither threads nor stops, and progress is told truly.

use std::time::{Duration, Instant};

use caustica_math::{Rgb, Transform, Vec3};
use caustica_render::{Control, Progress, RenderOptions, Report, Session, integrator_by_name};
use caustica_scene::Scene;
use caustica_scene::description::{
    CameraKind, Crop, Description, Geometry, Light, LightKind, MaterialId, MaterialKind, Shape,
};
use caustica_transport::Settings;

/// Balls of clay and glass under a lamp and a sky, in 40 × 28 pixels: several tiles, some of them cut.
fn scene(crop: Option<Crop>) -> Scene {
    let mut d = Description::default();
    (d.film.width, d.film.height, d.film.crop) = (40, 28, crop);
    d.camera.kind = CameraKind::Perspective { fov: 50.0 };
    let clay = d.add_material(MaterialKind::Diffuse { albedo: Rgb::new(0.7, 0.5, 0.4).into() });
    let glass = d.add_material(MaterialKind::dielectric(1.5, 1.0));
    let mut add = |x: f32, y: f32, radius: f32, material: MaterialId, lit: Option<Rgb>| {
        d.shapes.push(Shape {
            name: "ball".into(),
            geometry: Geometry::Sphere { center: Vec3::new(x, y, 4.0), radius },
            to_world: Transform::IDENTITY,
            material,
            emission: lit.map(Into::into),
            origin: None,
        });
    };
    add(-0.7, 0.0, 0.6, clay, None);
    add(0.7, 0.0, 0.6, glass, None);
    add(0.0, -100.7, 100.0, clay, None);
    add(0.3, 1.6, 0.2, clay, Some(Rgb::splat(20.0)));
    d.lights.push(Light { kind: LightKind::Constant { radiance: Rgb::splat(0.2) }, origin: None });
    Scene::new(d).unwrap().0
}

const CROP: Option<Crop> = Some(Crop { x: 5, y: 3, width: 21, height: 18 });

fn options(integrator: &str, samples: u32, threads: usize) -> RenderOptions {
    let integrator = integrator_by_name(integrator, 1.0, [0.0; 3], [0.0, 0.0, 1.0]).unwrap();
    let settings = Settings { integrator, seed: 9, ..Settings::default() };
    RenderOptions { settings, samples, threads: Some(threads), ..RenderOptions::default() }
}

fn session<'a>(scene: &'a Scene, options: RenderOptions) -> Session<'a> {
    Session::new(scene, options).unwrap()
}

fn run(session: &Session<'_>) -> Report {
    session.run(&Control::default(), |_| ()).unwrap()
}

/// Runs until it has done so many samples, or a few more.
fn run_until(session: &Session<'_>, samples: f64) -> Report {
    let control = Control::default();
    session
        .run(&control, |p| {
            if p.samples >= samples {
                control.stop();
            }
        })
        .unwrap()
}

#[test]
fn films_of_all_thread_counts_have_the_same_bits() {
    for crop in [None, CROP] {
        let scene = scene(crop);
        for integrator in ["bdpt", "light", "path"] {
            let films = [1, 2, 7].map(|threads| {
                let session = session(&scene, options(integrator, 4, threads));
                assert_eq!(run(&session).threads, threads);
                session
            });
            let [one, two, seven] = films.each_ref().map(Session::film);
            assert!(one.bits_equal(two) && one.bits_equal(seven), "{integrator}, crop {crop:?}");
            assert!(one.sums().flatten().any(|s| s != 0), "{integrator} is black");
        }
    }
}

#[test]
fn a_stopped_session_holds_whole_passes_and_can_go_on() {
    let scene = scene(CROP);
    for threads in [1, 3] {
        let stopped = session(&scene, options("bdpt", 1_000_000, threads));
        let report = run_until(&stopped, 1.0);
        assert!(report.stopped && (1..1_000_000).contains(&report.samples), "{report:?}");
        let whole = session(&scene, options("bdpt", report.samples as u32, 2));
        assert!(!run(&whole).stopped);
        assert!(stopped.film().bits_equal(whole.film()), "{report:?}");

        let more = run_until(&stopped, report.samples as f64 + 1.0);
        assert!(more.samples > report.samples);
        assert_eq!(stopped.film().eye_samples(), more.samples);
        let whole = session(&scene, options("bdpt", more.samples as u32, 2));
        run(&whole);
        assert!(stopped.film().bits_equal(whole.film()), "{more:?}");
    }
}

#[test]
fn a_finished_session_has_nothing_more_to_do() {
    let scene = scene(None);
    for integrator in ["bdpt", "light", "path"] {
        let session = session(&scene, options(integrator, 2, 2));
        let (first, before) = (run(&session), session.film().fingerprint());
        let again = run(&session);
        assert_eq!((first.samples, again.samples, again.stopped), (2, 2, false), "{integrator}");
        assert_eq!(session.film().fingerprint(), before, "{integrator}");
    }
}

#[test]
fn a_session_that_is_stopped_before_it_starts_is_empty() {
    let scene = scene(None);
    let session = session(&scene, options("bdpt", 1_000_000_000, 2));
    let control = Control::default();
    control.stop();
    // Workers may have begun some passes before the first look at the control.
    let report = session.run(&control, |_| ()).unwrap();
    assert!(report.stopped && report.samples < 1_000_000_000);
    assert_eq!(session.film().eye_samples(), report.samples);
}

#[test]
fn layers_count_their_own_samples() {
    let scene = scene(None);
    for (integrator, eye, light) in [("bdpt", 3, 3), ("light", 0, 3), ("path", 3, 0), ("normals", 3, 0)] {
        let session = session(&scene, options(integrator, 3, 2));
        assert_eq!(run(&session).samples, 3);
        assert_eq!(
            (session.film().eye_samples(), session.film().light_samples()),
            (eye, light),
            "{integrator}"
        );
    }
}

#[test]
fn progress_grows_and_ends_at_one() {
    let scene = scene(None);
    let by_samples = RenderOptions { time: None, ..options("bdpt", 150, 2) };
    let by_time = RenderOptions { time: Some(Duration::from_millis(350)), ..options("bdpt", u32::MAX, 2) };
    for options in [by_samples, by_time] {
        let total = options.samples;
        let session = session(&scene, options);
        let mut told: Vec<Progress> = Vec::new();
        let report = session.run(&Control::default(), |p| told.push(*p)).unwrap();
        for pair in told.windows(2) {
            assert!(pair[0].fraction <= pair[1].fraction, "{pair:?}");
            assert!(pair[0].samples <= pair[1].samples && pair[0].elapsed <= pair[1].elapsed, "{pair:?}");
        }
        let last = told.last().unwrap();
        assert_eq!((last.fraction, last.samples, last.total), (1.0, report.samples as f64, total));
        assert!(last.rate > 0.0 && report.samples_per_second > 0.0);
    }
}

#[test]
fn time_is_kept_and_is_enough_for_one_pass() {
    let scene = scene(None);
    for time in [Duration::ZERO, Duration::from_millis(30)] {
        let options = RenderOptions { time: Some(time), ..options("bdpt", u32::MAX, 2) };
        let (session, start) = (session(&scene, options), Instant::now());
        let report = run(&session);
        assert!(report.samples >= 1 && !report.stopped, "{report:?}");
        assert!(start.elapsed() < Duration::from_secs(5));
    }
}

#[test]
fn films_that_cannot_be_had_are_errors() {
    let mut d = Description::default();
    (d.film.width, d.film.height) = (65_536, 65_536);
    let (scene, _) = Scene::new(d).unwrap();
    let error = Session::new(&scene, RenderOptions::default()).unwrap_err().to_string();
    assert!(error.contains("412317 MB"), "{error}");
}
