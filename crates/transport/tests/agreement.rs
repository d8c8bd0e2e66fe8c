//! Block by block, `naive`, `path`, `light` and `bdpt` (and parts of it) agree: Welch's t-test at a significance
//! of 10⁻³ a pair of pictures, Šidák-corrected over the blocks; seeds are fixed.

use caustica_math::{Filter, Rgb, Transform};
use caustica_scene::Description;
use caustica_scene::description::{
    BumpRule, CameraKind, Crop, Geometry, LightKind, MaterialId, MaterialKind, Texture,
};
use caustica_testkit::agreement::{Estimate, Plan, agree, estimate, flatten};
use caustica_testkit::build::{quad, sphere};
use caustica_testkit::materials::*;
use caustica_testkit::scenes::*;
use caustica_testkit::ways::{ODD, Way, Way::*};

/// Renders a scene in several ways and compares each with the first.
fn check(name: &str, description: Description, passes: u32, ways: &[Way]) {
    let scene = flatten(description);
    let plan = Plan { passes, block: 4, only: None };
    let render = |(i, way): (usize, &Way)| estimate(&scene, &way.settings(11 + i as u64), plan);
    let estimates: Vec<Estimate> = ways.iter().enumerate().map(render).collect();
    for (i, e) in estimates.iter().enumerate() {
        println!("{name} {i}: {:.5} ± {:.5}", e.whole.mean, e.whole.variance_of_mean().sqrt());
    }
    for (i, e) in estimates.iter().enumerate().skip(1) {
        if let Err(message) = agree(&estimates[0], e) {
            panic!("{name}: way {i} differs from way 0 in {message}");
        }
    }
}

#[test]
fn diffuse_box() {
    check("box", open_box(), 400, &[Bdpt, Naive, Path, Emitters, Light, Power, NoLightImage, ODD]);
}

#[test]
fn glass() {
    check("glass", ball(glass_kind(false)), 6000, &[Bdpt, Naive, Path, Power, NoLightImage, ODD]);
}

#[test]
fn inverted_glass() {
    check("inverted", ball(glass_kind(true)), 600, &[Bdpt, Naive, Path]);
}

#[test]
fn rough_glass() {
    check("rough glass", ball(rough_glass_kind()), 400, &[Bdpt, Naive, Path, Light, ODD]);
}

#[test]
fn metals() {
    check("smooth metal", ball(metal_kind(None)), 400, &[Bdpt, Naive, Path]);
    check("rough metal", ball(metal_kind(Some(0.15))), 400, &[Bdpt, Naive, Path, Light]);
}

#[test]
fn plastic() {
    check("plastic", ball(plastic_kind()), 400, &[Bdpt, Naive, Path, Light, ODD]);
}

#[test]
fn shading_normals() {
    let white = caustica_scene::description::MaterialKind::Diffuse { albedo: Rgb::splat(0.8).into() };
    check("smooth diffuse", smooth_mesh(white), 600, &[Bdpt, Naive, Path, Light]);
    check("smooth glass", smooth_mesh(glass_kind(false)), 600, &[Bdpt, Naive, Path]);
    check("smooth rough glass", smooth_mesh(rough_glass_kind()), 400, &[Bdpt, Naive, Path, Light]);
    check("smooth metal", smooth_mesh(metal_kind(Some(0.2))), 400, &[Bdpt, Path, Light]);
}

/// All kinds of lobes in one box.
fn lobes(kinds: impl IntoIterator<Item = MaterialKind>) -> Description {
    let mut d = open_box();
    for (i, kind) in kinds.into_iter().enumerate() {
        let (x, y) = ((i % 2) as f32, (i / 2 % 2) as f32);
        let m = d.add_material(kind);
        sphere(&mut d, [0.9 * x - 0.45, 0.9 * y - 0.55, 0.3 * x - 0.2 * y], 0.4, m);
    }
    d
}

#[test]
fn lobes_beside_one_another() {
    let MaterialKind::Conductor { eta, k, .. } = metal_kind(None) else { panic!() };
    let brushed = MaterialKind::rough_conductor(brushed([0.15, 0.5]), eta, k);
    let rough = [rough_plastic(), principled(), principled_thin(), brushed];
    check("rough lobes", lobes(rough), 600, &[Bdpt, Naive, Path, Emitters, Light, Power, NoLightImage, ODD]);
    let mixed = [smooth_plastic(false), rough_plastic(), principled(), smooth_plastic(true)];
    // (Where bdpt has no light image, what plastic mirrors onto others is rare and bright: more than a t-test can do with.)
    check("smooth plastic", lobes(mixed), 600, &[Bdpt, Naive, Path, Power]);
}

/// The box with a screen of some material before its ball, and another one below the lamp.
fn screened(make: impl Fn(&mut Description) -> MaterialId) -> Description {
    let mut d = ball(metal_kind(Some(0.3)));
    let m = make(&mut d);
    quad(&mut d, [-0.9, -0.9, -0.7], [1.2, 0.0, 0.0], [0.0, 1.0, 0.4], m);
    quad(&mut d, [-0.6, 0.4, -0.6], [0.0, 0.1, 1.0], [1.0, 0.0, 0.0], m);
    d
}

#[test]
fn materials_of_others() {
    check("leaves", screened(leaves), 800, &[Bdpt, Naive, Path, ODD]);
    check("frosted", screened(frosted), 1500, &[Bdpt, Naive, Path, NoLightImage]);
    check("thin", screened(|d| d.add_material(thin_glass())), 800, &[Bdpt, Naive, Path]);
    let both = |d: &mut Description| two_sided(d, MaterialId(0), MaterialId(1));
    check("two-sided", screened(both), 400, &[Bdpt, Naive, Path, Light, ODD]);
    let clay = |d: &mut Description| {
        let both = two_sided(d, MaterialId(0), MaterialId(1));
        bump(d, 0.1, BumpRule::default(), both)
    };
    check("bumps", screened(clay), 400, &[Bdpt, Naive, Path, Light, ODD]);
    let mirror = |d: &mut Description| {
        let m = d.add_material(metal_kind(None));
        bump(d, 0.05, BumpRule::default(), m)
    };
    check("bumpy mirror", screened(mirror), 1500, &[Bdpt, Naive, Path]);
    let rough = |d: &mut Description| {
        let m = d.add_material(metal_kind(Some(0.2)));
        normal_map(d, 0.7, BumpRule::default(), m)
    };
    check("normals", screened(rough), 400, &[Bdpt, Naive, Path, Light]);
}

#[test]
fn environment_light() {
    check("sky", under_the_sky(plastic_kind()), 600, &[Bdpt, Naive, Path, Emitters, Light, ODD]);
    check("sky, glass", under_the_sky(glass_kind(false)), 600, &[Bdpt, Naive, Path]);
    let mut both = open_box();
    caustica_testkit::build::light(&mut both, LightKind::Constant { radiance: Rgb::splat(0.4) });
    check("lamp and sky", both, 400, &[Bdpt, Naive, Path, Light]);
}

#[test]
fn daylight() {
    let by_day = |aperture, kind| {
        let mut d = under_the_sky(kind);
        d.lights.clear();
        dome(&mut d, [0.4, 0.5, -0.6]);
        sun(&mut d, [0.4, 0.5, -0.6], aperture);
        d
    };
    check("wide sun", by_day(30.0, plastic_kind()), 600, &[Bdpt, Naive, Path, Emitters, Light, ODD]);
    check("sun", by_day(0.5358, plastic_kind()), 400, &[Bdpt, Path, Emitters, Light, ODD]);
    check("wide sun, glass", by_day(30.0, glass_kind(false)), 600, &[Bdpt, Naive, Path]);
    // Cut by the horizon, in a room with a lamp.
    let mut both = open_box();
    sun(&mut both, [0.2, 0.05, -1.0], 30.0);
    check("lamp and sun", both, 400, &[Bdpt, Naive, Path, Light]);
}

#[test]
fn instances() {
    check("instances", instanced(), 1500, &[Bdpt, Naive, Path]);
    // Not stretched, as normals between corners are mixed before they are stretched in an instance, and after it in
    // what has corners of its own.
    let mut even = instanced();
    even.instances.truncate(2);
    let [turned, mirrored] = [&[0.8, 0.8, 0.8], &[-0.7, 0.7, 0.7]].map(|s| Transform::scale(*s));
    even.instances[0].to_world = turned.then(Transform::translate([-0.4, -0.9, 0.0]));
    even.instances[1].to_world =
        mirrored.then(Transform::rotate(25.0, [0.2, 1.0, 0.0])).then(Transform::translate([0.4, -0.3, 0.2]));
    let plan = Plan { passes: 1500, block: 4, only: None };
    let estimates = [even.clone(), flattened(even)]
        .map(flatten)
        .each_ref()
        .map(|scene| estimate(scene, &Bdpt.settings(u64::from(scene.surfaces().instances() > 0)), plan));
    agree(&estimates[0], &estimates[1]).unwrap_or_else(|e| panic!("instances differ from shapes in {e}"));
}

#[test]
fn delta_lights() {
    let white = Rgb::splat(3.0);
    let point = LightKind::Point { position: [0.3, 0.6, -0.2], intensity: white };
    let spot = |inner_angle, outer_angle| LightKind::Spot {
        position: [0.5, 0.7, -0.5],
        direction: [-0.4, -1.0, 0.5],
        intensity: white,
        inner_angle,
        outer_angle,
    };
    let sun = LightKind::Directional { direction: [0.2, -0.3, 1.0], irradiance: white };
    check("point", lit_by(point), 400, &[Bdpt, Path, Light, ODD]);
    check("spot", lit_by(spot(20.0, 35.0)), 400, &[Bdpt, Path, Light]);
    check("narrow spot", lit_by(spot(6.0, 7.0)), 800, &[Bdpt, Light, ODD]);
    check("sun", lit_by(sun), 400, &[Bdpt, Path, Light, ODD]);
}

/// Many lamps, which the hierarchy chooses from, over two sides of glass.
#[test]
fn many_lamps() {
    use caustica_testkit::build::{add, ellipsoid, emit, point_light, sphere};
    let mut d = open_box();
    let m = caustica_testkit::build::diffuse(&mut d, 0.4);
    let ball = add(&mut d, "ball", Geometry::Mesh(ellipsoid(6, [0.3, 0.2, 0.25])), m);
    d.shapes[ball].to_world = Transform::translate([-0.5, -0.3, 0.3]);
    emit(&mut d, ball, 2.0);
    for i in 0..6 {
        let bulb = sphere(&mut d, [0.25 * i as f32 - 0.6, -0.8, -0.4], 0.05, m);
        emit(&mut d, bulb, 1.0 + i as f32);
    }
    check("many lamps", d.clone(), 600, &[Bdpt, Naive, Path, Emitters, Light, ODD]);
    let pane = d.add_material(rough_glass_kind());
    sphere(&mut d, [0.3, 0.1, 0.0], 0.4, pane);
    caustica_testkit::build::light(&mut d, LightKind::Constant { radiance: Rgb::splat(0.2) });
    check("many lamps and glass", d.clone(), 600, &[Bdpt, Naive, Path, Light]);
    (0..8).for_each(|i| point_light(&mut d, [0.2 * i as f32 - 0.8, 0.5, 0.2], 0.3));
    check("many points", d, 600, &[Bdpt, Path, Light, ODD]);
}

#[test]
fn pictures_and_beams() {
    let to_world = Transform::look_at([0.5, 0.7, -0.5], [0.1, -0.3, 0.0], [0.0, 0.0, 1.0]);
    let (value1, value2) = (Rgb([9.0, 3.0, 1.0]), Rgb::splat(0.5));
    let checks =
        Texture::Checkerboard { delta: [0.1, 0.2], scale: [0.3, 0.4], shear: [0.0; 2], value1, value2 };
    let projector = LightKind::Projector { to_world, irradiance: checks, scale: 1.0, fov: 70.0, aspect: 1.3 };
    check("projector", lit_by(projector), 400, &[Bdpt, Path, Light, ODD]);
    let intensity = Rgb::splat(3.0);
    let (inner_angle, outer_angle) = (10.0, 45.0);
    let spot = LightKind::LinearSpot { to_world, intensity, picture: Some(checks), inner_angle, outer_angle };
    check("linear spot", lit_by(spot), 400, &[Bdpt, Path, Light]);
    let mut beam = lit_by(projector);
    beam.lights.clear();
    let lamp = caustica_testkit::build::quad(
        &mut beam,
        [-0.3, 0.9, -0.3],
        [0.6, 0.1, 0.0],
        [0.0, 0.0, 0.6],
        caustica_scene::description::MaterialId(0),
    );
    caustica_testkit::build::light(
        &mut beam,
        LightKind::Collimated { shape: lamp as u32, exitance: Rgb::splat(3.0).into() },
    );
    check("beam", beam, 600, &[Bdpt, Light]);
}

#[test]
fn textured_lamps() {
    check("textured", textured(), 600, &[Bdpt, Naive, Path, Light]);
}

#[test]
fn lamp_in_a_glass_bulb() {
    check("bulb", bulb(), 800, &[Bdpt, Naive, NoLightImage]);
}

#[test]
fn cameras() {
    let with = |kind: CameraKind| {
        let mut d = ball(metal_kind(Some(0.3)));
        d.camera.kind = kind;
        d
    };
    let lens = CameraKind::ThinLens { fov: 45.0, aperture_radius: 0.2, focus_distance: 2.5 };
    check("thin lens", with(lens), 400, &[Bdpt, Path, Light]);
    check("orthographic", with(CameraKind::Orthographic), 400, &[Bdpt, Path, Light, ODD]);
    let mut around = with(CameraKind::Environment);
    around.camera.to_world = Transform::translate([0.1, 0.2, -0.3]);
    around.film.filter = Filter::Gaussian { radius: 2.0, stddev: 0.7 };
    check("360°", around, 400, &[Bdpt, Path, Light]);
    let mut sky = under_the_sky(plastic_kind());
    sky.camera.kind = CameraKind::Orthographic;
    check("orthographic sky", sky, 400, &[Bdpt, Path, ODD]);
    let mut sky = under_the_sky(plastic_kind());
    sky.camera.kind = CameraKind::Environment;
    check("360° sky", sky, 400, &[Bdpt, Path, Light, ODD]);
}

#[test]
fn shifted_lenses_and_hidden_lamps() {
    let mut d = ball(metal_kind(Some(0.3)));
    d.camera.principal_point = [0.3, 0.6];
    check("shifted", d, 400, &[Bdpt, Path, Light]);
    let mut d = open_box();
    d.camera.hides_lamps = true;
    caustica_testkit::build::light(&mut d, LightKind::Constant { radiance: Rgb::splat(0.4) });
    check("hidden", d, 400, &[Bdpt, Naive, Path, Light, NoLightImage, ODD]);
}

/// A sheet that emits along its normals covers all of the picture, before nothing. A camera that hides lamps does not see
/// it in the light of another, nor does light from it to the camera: as Mitsuba has it.
#[test]
fn hidden_beams() {
    let mut d = caustica_testkit::build::scene(4);
    let white = caustica_testkit::build::diffuse(&mut d, 0.8);
    let sheet = [[-9.0, -9.0, 3.0], [0.0, 18.0, 0.0], [18.0, 0.0, 0.0]];
    let shape = caustica_testkit::build::quad(&mut d, sheet[0], sheet[1], sheet[2], white) as u32;
    let kind = LightKind::Collimated { shape, exitance: Rgb::splat(0.01).into() };
    caustica_testkit::build::light(&mut d, kind);
    caustica_testkit::build::point_light(&mut d, [0.5, 1.0, 0.5], 2.0);
    for hides in [false, true] {
        d.camera.hides_lamps = hides;
        let scene = flatten(d.clone());
        for way in [Bdpt, Naive, Path, Light, NoLightImage] {
            let plan = Plan { passes: 50, block: 1, only: None };
            let mean = estimate(&scene, &way.settings(7), plan).whole.mean;
            // `Naive` meets no point light.
            assert!(
                if hides || way == Naive { mean == 0.0 } else { mean > 0.02 },
                "{way:?}, {hides}: {mean}"
            );
        }
    }
}

#[test]
fn meters() {
    let mut d = ball(metal_kind(Some(0.3)));
    let shape = d.shapes.len() as u32 - 1;
    (d.film.width, d.film.height) = (4, 4);
    d.film.filter = Filter::Box { radius: 0.5 };
    d.camera.kind = CameraKind::IrradianceMeter { shape };
    check("irradiance", d.clone(), 2000, &[Bdpt, Naive, Path, Light, ODD]);
    d.camera.kind = CameraKind::RadianceMeter;
    check("radiance", d, 2000, &[Bdpt, Naive, Path, NoLightImage, ODD]);
}

/// A ball under a sky of radiance L gets the irradiance πL everywhere.
#[test]
fn irradiance_of_a_ball_under_the_sky() {
    let mut d = caustica_testkit::build::scene(2);
    let m =
        d.add_material(caustica_scene::description::MaterialKind::Diffuse { albedo: Rgb::splat(0.5).into() });
    let shape = caustica_testkit::build::sphere(&mut d, [0.5, 1.0, -2.0], 0.7, m) as u32;
    caustica_testkit::build::light(&mut d, LightKind::Constant { radiance: Rgb::splat(0.25) });
    d.camera.kind = CameraKind::IrradianceMeter { shape };
    d.film.filter = Filter::Box { radius: 0.5 };
    let scene = flatten(d);
    for (i, way) in [Bdpt, Naive, Path, Light].into_iter().enumerate() {
        let plan = Plan { passes: 4000, block: 1, only: None };
        let e = estimate(&scene, &way.settings(3 + i as u64), plan);
        // Eye paths alone have no noise: every direction has the same radiance.
        let tolerance = if matches!(way, Naive | Path) { 1e-4 } else { 0.02 };
        let expected = 0.25 * std::f64::consts::PI;
        assert!((e.whole.mean / expected - 1.0).abs() < tolerance, "{way:?}: {}", e.whole.mean);
    }
}

#[test]
fn crop_window_and_wide_filter() {
    let mut d = ball(plastic_kind());
    (d.film.width, d.film.height) = (40, 30);
    d.film.crop = Some(Crop { x: 9, y: 3, width: 16, height: 12 });
    d.film.filter = Filter::Mitchell { radius: 2.0, b: 1.0 / 3.0, c: 1.0 / 3.0 };
    check("crop", d, 600, &[Bdpt, Path, Light, NoLightImage]);
}
