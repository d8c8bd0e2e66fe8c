//! Numerical failures are told, wherever they happen, and what is told as a value is finite; what merely carries no
//! light is no failure.

use caustica_math::{Rgb, Vec2};
use caustica_scene::Description;
use caustica_scene::description::{CameraKind, Integrator, LightKind, MaterialKind, Roughness, Technique};
use caustica_testkit::agreement::flatten;
use caustica_testkit::build::{self, diffuse, emit, look, quad, scene, sphere};
use caustica_testkit::{scenes, ways::Way, ways::Way::*};
use caustica_transport::{Kernel, Scratch, Settings, Sink};

/// Counts failures.
#[derive(Default)]
struct Count {
    invalid: u32,
    eyes: u32,
}

impl Sink for Count {
    fn eye(&mut self, value: Rgb) {
        assert!(value.is_valid(), "{value:?}");
        self.eyes += 1;
    }

    fn splat(&mut self, film: Vec2, value: Rgb) {
        assert!(value.is_valid() && film.x.is_finite() && film.y.is_finite(), "{value:?} at {film:?}");
    }

    fn invalid(&mut self) {
        self.invalid += 1;
    }
}

/// Failures in eight samples of every pixel.
fn failures(description: &Description, settings: Settings) -> u32 {
    let scene = flatten(description.clone());
    let (kernel, mut scratch, mut sink) =
        (Kernel::new(&scene, settings), Scratch::default(), Count::default());
    let window = scene.film.window();
    let pixels = (0..window.height).flat_map(|y| (0..window.width).map(move |x| [x, y]));
    pixels.for_each(|pixel| (0..8).for_each(|sample| kernel.sample(pixel, sample, &mut scratch, &mut sink)));
    let eyes =
        if kernel.settings().integrator == Integrator::Light { 0 } else { 8 * window.width * window.height };
    assert_eq!(sink.eyes, eyes);
    sink.invalid
}

#[track_caller]
fn fails(description: &Description, ways: &[Way]) {
    for way in ways {
        assert!(failures(description, way.settings(1)) > 0, "{way:?} tells of no failure");
    }
}

/// A floor that fills the picture.
fn floor() -> Description {
    let mut d = scene(4);
    look(&mut d, [0.0, 1.0, 0.0], [0.0, 0.0, 0.001]);
    let m = diffuse(&mut d, 0.5);
    quad(&mut d, [-9.0, 0.0, -9.0], [0.0, 0.0, 18.0], [18.0, 0.0, 0.0], m);
    d
}

/// The floor as a mirror that makes light out of nothing, below a ceiling.
fn bright_mirror(reflectance: f32, ceiling: MaterialKind) -> Description {
    let mut d = floor();
    d.materials[0].kind = MaterialKind::Mirror { reflectance: Rgb::splat(reflectance) };
    let m = d.add_material(ceiling);
    quad(&mut d, [-9.0, 2.0, -9.0], [18.0, 0.0, 0.0], [0.0, 0.0, 18.0], m);
    d
}

fn grey() -> MaterialKind {
    MaterialKind::Diffuse { albedo: Rgb::splat(0.5).into() }
}

#[test]
fn lamps_that_are_hit() {
    let mut d = bright_mirror(4.0, grey());
    emit(&mut d, 1, 3e38);
    fails(&d, &[Naive, Path, Only("s=0")]);
}

#[test]
fn lamps_that_are_found() {
    let mut d = floor();
    build::point_light(&mut d, [0.0, 0.1, 0.0], 3e38);
    fails(&d, &[Path, Emitters, Only("s=1&t>=2"), Bdpt]);
}

#[test]
fn light_paths_that_begin_too_bright() {
    let mut d = floor();
    let m = diffuse(&mut d, 0.5);
    let lamp = quad(&mut d, [-9.0, 2.0, -9.0], [18.0, 0.0, 0.0], [0.0, 0.0, 18.0], m);
    emit(&mut d, lamp, 3e38);
    fails(&d, &[Light, Only("s>=2"), Bdpt]);
}

#[test]
fn walks_that_gain_light() {
    let mirror = MaterialKind::Mirror { reflectance: Rgb::splat(1e30) };
    let mut d = bright_mirror(1e30, mirror);
    build::point_light(&mut d, [0.0, 0.5, 0.0], 1.0);
    fails(&d, &[Naive, Path, Light, Only("t>=2"), Only("t=1"), Bdpt]);
}

#[test]
fn connections() {
    let mut d = bright_mirror(1e10, grey());
    build::point_light(&mut d, [0.0, 0.9, 0.0], 1e35);
    // A wall that light paths reach without the mirror, and eye paths by it.
    let m = diffuse(&mut d, 0.5);
    quad(&mut d, [-9.0, 0.0, 4.0], [18.0, 0.0, 0.0], [0.0, 2.0, 0.0], m);
    fails(&d, &[Only("s>=2&t>=2")]);
}

#[test]
fn splats() {
    let mut d = floor();
    look(&mut d, [0.0, 0.3, 0.0], [0.0, 0.0, 0.0003]);
    d.camera.kind = CameraKind::Perspective { fov: 0.1 };
    let (position, direction, intensity) = ([0.0, 0.5, 0.0], [0.0, -1.0, 0.0], Rgb::splat(3e38));
    build::light(
        &mut d,
        LightKind::Spot { position, direction, intensity, inner_angle: 0.1, outer_angle: 0.1 },
    );
    fails(&d, &[Light, Only("t=1")]);
    // The lamp itself, which the camera sees from near by.
    let mut d = scene(1);
    d.camera.near = 0.0;
    let m = diffuse(&mut d, 0.5);
    let lamp = quad(&mut d, [-1e-4, -1e-4, 1e-3], [0.0, 2e-4, 0.0], [2e-4, 0.0, 0.0], m);
    emit(&mut d, lamp, 3e38);
    d.camera.kind = CameraKind::Perspective { fov: 8.0 };
    fails(&d, &[Light, Only("s=1&t=1")]);
}

/// So small that a pixel's density on the surface is beyond all numbers.
#[test]
fn densities() {
    let mut d = scene(4);
    d.camera.kind = CameraKind::Perspective { fov: 1e-3 };
    d.camera.near = 0.0;
    let m = diffuse(&mut d, 0.5);
    sphere(&mut d, [0.0, 0.0, 2e-14], 1e-14, m);
    build::light(&mut d, LightKind::Constant { radiance: Rgb::WHITE });
    fails(&d, &[Bdpt, Only("t>=2")]);
}

/// What carries no light is not sampled or absorbed, and nobody is told of it.
#[test]
fn no_light_is_no_failure() {
    let rough = MaterialKind::rough_dielectric(Roughness::ggx(1.0), 1.5, 1.0);
    let mut grazing = scenes::open_box();
    look(&mut grazing, [0.0, -1.0, -3.0], [0.0, -1.0, 0.0]);
    let black = MaterialKind::Diffuse { albedo: Rgb::BLACK.into() };
    let integrators = [
        Integrator::Bdpt,
        Integrator::Light,
        Integrator::Path(Technique::Mis),
        Integrator::Path(Technique::Materials),
        Integrator::Whitted,
        Integrator::Normals,
        Integrator::Depth,
    ];
    let leaning = scenes::smooth_mesh(scenes::metal_kind(Some(0.2)));
    let bare = [scene(4), floor(), scenes::dark_box()];
    for d in
        [grazing, leaning, scenes::ball(rough), scenes::ball(black), scenes::bulb()].into_iter().chain(bare)
    {
        for integrator in integrators {
            assert_eq!(failures(&d, Settings { integrator, ..Settings::default() }), 0, "{integrator:?}");
        }
    }
}
