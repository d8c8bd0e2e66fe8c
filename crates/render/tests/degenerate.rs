//! Whole pictures of scenes at the ends of what can be described: scales, brightness, nothing at all.

use caustica_math::Rgb;
use caustica_render::{Control, INTEGRATOR_NAMES, RenderOptions, Session, integrator_by_name};
use caustica_scene::description::{CameraKind, LightKind, MaterialKind, Texture};
use caustica_scene::{Description, Scene};
use caustica_testkit::scaled::scaled;
use caustica_testkit::{build, scenes};
use caustica_transport::Settings;

/// All channels of both layers, and how many contributions were invalid.
fn render(d: Description, integrator: &str, samples: u32) -> (Vec<f32>, u64) {
    let scene = Scene::new(d).unwrap_or_else(|e| panic!("{e}")).0;
    let integrator = integrator_by_name(integrator, 1.0, [0.0; 3], [0.0, 0.0, 1.0]).unwrap();
    let settings = Settings { integrator, seed: 4, ..Settings::default() };
    let options = RenderOptions { settings, samples, threads: Some(2), ..RenderOptions::default() };
    let session = Session::new(&scene, options).unwrap();
    let report = session.run(&Control::default(), |_| ()).unwrap();
    assert_eq!(report.invalid, session.film().counts().invalid);
    let picture = session.film().develop();
    let values: Vec<f32> = picture.eye.iter().chain(&picture.light).flat_map(|p| p.0).collect();
    assert!(values.iter().all(|v| v.is_finite() && *v >= 0.0), "{values:?}");
    (values, report.invalid)
}

/// The largest difference, relative to the mean.
fn difference(a: &[f32], b: &[f32]) -> f32 {
    let mean = a.iter().sum::<f32>() / a.len() as f32;
    assert!(mean > 0.0);
    a.iter().zip(b).fold(0.0_f32, |m, (a, b)| m.max((a - b).abs())) / mean
}

/// Scenes with everything that has a length: a lens, points, spheres, meshes, textures, glass.
fn with_lengths() -> [Description; 3] {
    let mut lens = scenes::textured();
    lens.camera.kind = CameraKind::ThinLens { fov: 45.0, aperture_radius: 0.2, focus_distance: 2.5 };
    let mut lit = scenes::smooth_mesh(scenes::rough_glass_kind());
    build::point_light(&mut lit, [0.3, 0.6, -0.2], 1.0);
    let mut parallel = scenes::ball(scenes::glass_kind(false));
    parallel.camera.kind = CameraKind::Orthographic;
    build::light(&mut parallel, LightKind::Constant { radiance: Rgb::splat(0.3) });
    [lens, lit, parallel]
}

/// A power of two changes no digit of anything: the pictures are the same but for what has no scale.
#[test]
fn powers_of_two_change_nothing() {
    for (i, d) in with_lengths().into_iter().enumerate() {
        for integrator in ["bdpt", "path", "light"] {
            let (unscaled, _) = render(d.clone(), integrator, 8);
            for k in [(1 << 20) as f32, 1.0 / (1 << 20) as f32] {
                let (picture, invalid) = render(scaled(d.clone(), k), integrator, 8);
                assert_eq!(invalid, 0, "scene {i}, {integrator}, {k}");
                let difference = difference(&unscaled, &picture);
                assert!(difference < 1e-4, "scene {i}, {integrator} at {k}: {difference}");
            }
        }
    }
}

/// Emission times 2¹⁰⁰ and 2⁻¹⁰⁰ gives the same picture so many times as bright.
#[test]
fn brightness_has_no_scale() {
    let lamp = |k: f32| {
        let mut d = scenes::ball(scenes::plastic_kind());
        d.shapes[4].emission = Some(Texture::Constant(Rgb::splat(8.0 * k)));
        d
    };
    let huge = 1.267_650_6e30;
    for integrator in ["bdpt", "path", "light"] {
        let (plain, _) = render(lamp(1.0), integrator, 8);
        for k in [huge, 1.0 / huge] {
            let (picture, invalid) = render(lamp(k), integrator, 8);
            let scaled: Vec<f32> = picture.iter().map(|v| v / k).collect();
            assert_eq!(invalid, 0, "{integrator}, {k}");
            assert!(difference(&plain, &scaled) < 1e-4, "{integrator}, {k}: {}", difference(&plain, &scaled));
        }
    }
}

/// What cannot be counted is left out and told.
#[test]
fn what_overflows_is_told() {
    let mut d = scenes::open_box();
    build::emit(&mut d, 4, 3e38);
    d.materials[0].kind = MaterialKind::Mirror { reflectance: Rgb::splat(1e20) };
    for integrator in ["bdpt", "path", "light"] {
        assert!(render(d.clone(), integrator, 2).1 > 0, "{integrator}");
    }
}

/// No lamp, no surface, nothing; and a film of one pixel: every integrator comes to an end.
#[test]
fn scenes_of_nothing() {
    let mut empty = Description::default();
    (empty.film.width, empty.film.height) = (1, 1);
    let mut lit = empty.clone();
    build::point_light(&mut lit, [0.0; 3], 1.0);
    build::light(&mut lit, LightKind::Constant { radiance: Rgb::splat(0.5) });
    let mut dark = scenes::dark_box();
    (dark.film.width, dark.film.height) = (1, 1);
    let mut one = scenes::open_box();
    (one.film.width, one.film.height) = (1, 1);
    for (name, _) in INTEGRATOR_NAMES {
        for d in [&empty, &lit, &dark, &one] {
            assert_eq!(render(d.clone(), name, 2).1, 0, "{name}");
        }
    }
    let (black, _) = render(empty, "bdpt", 2);
    assert!(black.iter().all(|v| *v == 0.0));
    let (sky, _) = render(lit, "bdpt", 4);
    assert!((sky[0] + sky[3] - 0.5).abs() < 0.2, "{sky:?}");
    assert!(render(one, "bdpt", 4).0[0] > 0.0);
}
