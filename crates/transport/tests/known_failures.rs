//! One test for each row of the design's list of what bidirectional renderers are known to get wrong (media left
//! out).
//!
//! Unless a test says otherwise, pictures are compared block by block with Welch's t-test at a significance of
//! 10⁻³ a pair, Šidák-corrected over the blocks; seeds are fixed, so that a test that passes keeps passing.

use std::f64::consts::PI;

use caustica_math::elementary::{asin, atan2, ln, sin};
use caustica_math::{Filter, Rgb, Vec2};
use caustica_scene::Description;
use caustica_scene::description::{CameraKind, Crop, Image, LightKind, MaterialKind};
use caustica_testkit::agreement::{Estimate, Plan, agree, estimate, flatten, is_close};
use caustica_testkit::build::{self, diffuse, emit, quad, scene, sphere};
use caustica_testkit::known_failures::*;
use caustica_testkit::scenes;
use caustica_testkit::seed::seed;
use caustica_testkit::ways::{Way, Way::*};
use caustica_transport::{Kernel, Scratch, Settings, Sink, Strategy};

/// What differs between a test and the common case.
#[derive(Clone)]
struct Check {
    name: &'static str,
    passes: u32,
    block: u32,
    depth: u32,
}

const CHECK: Check = Check { name: "", passes: 200, block: 4, depth: 9 };

impl Check {
    fn estimates(&self, description: Description, ways: &[Way]) -> Vec<Estimate> {
        let scene = flatten(description);
        let plan = Plan { passes: self.passes, block: self.block, only: None };
        let render = |(i, way): (usize, &Way)| {
            let settings = Settings { max_depth: Some(self.depth), ..way.settings(101 + i as u64) };
            let e = estimate(&scene, &settings, plan);
            println!("{} {way:?}: {:.5} ± {:.5}", self.name, e.whole.mean, e.whole.variance_of_mean().sqrt());
            e
        };
        ways.iter().enumerate().map(render).collect()
    }

    /// Renders a scene in several ways and compares each with the first.
    fn agree(&self, description: Description, ways: &[Way]) {
        let estimates = self.estimates(description, ways);
        assert!(estimates[0].whole.mean > 0.0, "{} is black", self.name);
        for (way, e) in ways.iter().zip(&estimates).skip(1) {
            if let Err(message) = agree(&estimates[0], e) {
                panic!("{}: {way:?} differs from {:?} in {message}", self.name, ways[0]);
            }
        }
    }

    /// Renders a scene in several ways and compares each picture's mean with a known figure: within ±`tolerance`
    /// (relative), and by Student's t-test.
    fn is(&self, description: Description, expected: f64, tolerance: f64, ways: &[Way]) {
        for (way, e) in ways.iter().zip(self.estimates(description, ways)) {
            if let Err(message) = is_close(&e, expected, tolerance) {
                panic!("{} by {way:?}: {message}", self.name);
            }
        }
    }
}

fn check(name: &'static str) -> Check {
    Check { name, ..CHECK }
}

fn grey(albedo: f32) -> MaterialKind {
    MaterialKind::Diffuse { albedo: Rgb::splat(albedo).into() }
}

/// "Shading normals and bump maps: light walks lack the adjoint factor, BDPT ≠ PT."
#[test]
fn shading_normals() {
    check("leaning, diffuse")
        .agree(leaning_normals(grey(0.8)), &[Bdpt, Path, Light, Only("s=0;s=1&t>2;s>=2&t!=2")]);
    check("leaning, rough glass").agree(leaning_normals(scenes::rough_glass_kind()), &[Bdpt, Path, Light]);
    check("leaning, metal").agree(leaning_normals(scenes::metal_kind(Some(0.3))), &[Bdpt, Path, Light]);
    let glass = Check { passes: 1000, ..check("leaning, glass") };
    glass.agree(leaning_normals(scenes::glass_kind(false)), &[Bdpt, Naive, NoLightImage]);
}

/// A lamp with vertex normals that lean from the geometric ones emits the same however it is found.
#[test]
fn shading_normals_of_lamps() {
    check("smooth lamp").agree(smooth_lamp(), &[Bdpt, Naive, Path, Emitters, Light]);
}

/// "Thin lens: splats miss the vignetting or the lens density."
#[test]
fn thin_lens() {
    // Blocks in the dark are lit by few of 200 passes.
    let blurred = Check { passes: 1000, ..check("out of focus") };
    blurred.agree(lamp_out_of_focus(), &[Bdpt, Path, Light, NoLightImage]);
    let seen = Check { depth: 1, ..check("lamp seen directly") };
    seen.agree(lamp_out_of_focus(), &[Only("s=0"), Only("1,1"), Naive, Bdpt]);
}

/// "Crop window: splats outside and inside are normalised differently." A crop's picture is that part of the full
/// one: eye and light image together, and each alone under the weights of its own strategies.
#[test]
fn crop_window() {
    let mut full = scenes::ball(scenes::plastic_kind());
    (full.film.width, full.film.height) = (32, 24);
    full.film.filter = Filter::Gaussian { radius: 3.0, stddev: 1.2 };
    let (x0, y0, width, height) = (8, 4, 16, 12);
    let mut cropped = full.clone();
    cropped.film.crop = Some(Crop { x: x0, y: y0, width, height });
    let check = check("crop");
    for way in [Bdpt, Light, Only("t=1"), NoLightImage, Path] {
        let (whole, part) =
            (&check.estimates(full.clone(), &[way])[0], &check.estimates(cropped.clone(), &[way, way])[1]);
        // Blocks of 4 × 4 pixels: 8 columns in the full picture, 4 in the crop.
        let blocks = (0..12).map(|i| whole.blocks[(y0 / 4 + i / 4) as usize * 8 + (x0 / 4 + i % 4) as usize]);
        let mut inside = part.clone();
        inside.blocks = blocks.collect();
        // Means over the two windows are not comparable.
        inside.whole = part.whole;
        if let Err(message) = agree(&inside, part) {
            panic!("{way:?}: the crop differs in {message}");
        }
    }
}

/// "Weights with specular chains (jacobians next to Dirac vertices dropped)."
#[test]
fn specular_chains_between_diffuse_surfaces() {
    let check = Check { passes: 400, ..check("chains") };
    check.agree(specular_chains(), &[Bdpt, Naive, NoLightImage, Power, Only("s=0;s=1;t>=3;2,2;t=1&s!=3")]);
}

/// "Narrow spots, spot cosines in emission densities."
#[test]
fn narrow_spots() {
    for in_view in [true, false] {
        check("wide spot").agree(spot(in_view, 20.0, 50.0), &[Bdpt, Path, Light]);
        // By `path` a corner of the picture gets one contribution in twenty passes.
        let edge = Check { passes: 1000, ..check("spot with an edge") };
        edge.agree(spot(in_view, 12.0, 12.0), &[Bdpt, Path, Light]);
        check("narrow spot").agree(spot(in_view, 3.0, 4.0), &[Bdpt, Light, Only("s>=2")]);
    }
}

/// "Next-event density of the light sampler differs from the emission density, weights mix them up."
#[test]
fn light_sampler_densities() {
    check("unequal lamps").agree(unequal_lamps(), &[Bdpt, Path, Light, NoLightImage, Power]);
    let depth_two = Check { depth: 2, ..check("unequal lamps, direct light") };
    depth_two.agree(unequal_lamps(), &[Bdpt, Emitters, Path, Light, Only("s=1;t=1")]);
}

/// No lamp is so weak beside the others that it is never chosen: the sun has 3·10¹² times the lantern's power.
#[test]
fn weak_lamps_are_chosen() {
    let scene = flatten(lantern_under_the_sun());
    let lights = scene.lights(caustica_math::Wavelengths::Rgb);
    let masses: Vec<f32> = (0..2)
        .map(|i| {
            let point = caustica_scene::light::LightPoint::infinite(i, caustica_math::Vec3::Y);
            lights.emission_pdf(&point, caustica_math::Vec3::Y).point.0
        })
        .collect();
    assert!(masses[1] > 1e-4, "{masses:?}");
}

/// "Single-strategy images black or wrong": whichever strategy alone finds all paths of a length, the picture is
/// the same. (Every strategy against known figures: tests/strategies.rs.)
#[test]
fn single_strategies() {
    let mut d = scenes::open_box();
    d.camera.kind = CameraKind::Perspective { fov: 30.0 };
    let m = diffuse(&mut d, 0.5);
    let lamp = quad(&mut d, [-0.9, -0.9, 0.95], [0.0, 1.8, 0.0], [1.8, 0.0, 0.0], m);
    emit(&mut d, lamp, 1.0);
    let scene = flatten(d);
    for (length, passes) in [(1, 150), (2, 300), (3, 300)] {
        let only = |s| {
            let settings =
                Settings { max_depth: Some(length), seed: seed(31) + u64::from(s), ..Settings::default() };
            let only = Some(Strategy { s, t: length + 1 - s });
            estimate(&scene, &settings, Plan { passes, block: 8, only })
        };
        let images: Vec<Estimate> = (0..=length).map(only).collect();
        for (s, e) in images.iter().enumerate() {
            println!(
                "length {length}, s = {s}: {:.5} ± {:.5}",
                e.whole.mean,
                e.whole.variance_of_mean().sqrt()
            );
            if let Err(message) = agree(&images[1], e) {
                panic!("paths of {length} edges by s = {s}: {message}");
            }
        }
    }
}

/// "360° and orthographic cameras abort or are refused."
#[test]
fn all_cameras() {
    let with = |kind| {
        let mut d = scenes::ball(scenes::plastic_kind());
        d.camera.kind = kind;
        d
    };
    let ways = [Bdpt, Path, Light, NoLightImage];
    check("orthographic").agree(with(CameraKind::Orthographic), &ways);
    let mut around = with(CameraKind::Environment);
    around.camera.to_world = caustica_math::Transform::rotate(30.0, [1.0, 0.5, 0.0])
        .then(caustica_math::Transform::translate([0.2, 0.4, -0.5]));
    (around.film.width, around.film.height) = (32, 16);
    check("360°").agree(around.clone(), &ways);
    around.film.filter = Filter::Mitchell { radius: 2.0, b: 1.0 / 3.0, c: 1.0 / 3.0 };
    around.film.crop = Some(Crop { x: 20, y: 0, width: 12, height: 8 });
    check("part of 360°").agree(around, &ways);
}

/// "Closed white furnace fails": albedo 0.9 and emission 0.1, where 30 edges leave 0.9³⁰ of the light out.
#[test]
fn closed_furnace() {
    let mut d = scenes::furnace();
    d.materials[0].kind = grey(0.9);
    d.shapes[0].emission = Some(Rgb::splat(0.1).into());
    d.camera.kind = CameraKind::Environment;
    let check = Check { passes: 400, depth: 30, block: 8, ..check("white furnace") };
    check.is(d, 1.0 - 0.9_f64.powi(30), 0.02, &[Bdpt, Path, Emitters, Light]);
}

/// "A scene lit by an environment alone is black": without surfaces, and around white ones.
#[test]
fn environment_alone() {
    let check = Check { block: 8, passes: 1500, ..check("environment") };
    let kinds = [
        CameraKind::Perspective { fov: 60.0 },
        CameraKind::ThinLens { fov: 60.0, aperture_radius: 0.3, focus_distance: 2.0 },
        CameraKind::Environment,
    ];
    for kind in kinds {
        let mut d = scene(8);
        d.camera.kind = kind;
        build::light(&mut d, LightKind::Constant { radiance: Rgb::WHITE });
        let dirty = d.clone();
        check.is(d, 1.0, 0.03, &[Bdpt, Naive, Path, Emitters, Light]);
        // Seen from outside, convex and white: radiance one everywhere, whatever the surface does.
        let mut d = dirty;
        build::look(&mut d, [0.0, 0.0, -4.0], [0.0; 3]);
        let m = diffuse(&mut d, 1.0);
        sphere(&mut d, [0.0; 3], 1.0, m);
        check.is(d.clone(), 1.0, 0.03, &[Bdpt, Naive, Path, Emitters, Light]);
        d.materials[0].kind = scenes::glass_kind(false);
        Check { depth: 40, passes: 200, ..check.clone() }.is(d, 1.0, 0.02, &[Bdpt, Naive]);
    }
    let mut d = scene(8);
    d.camera.kind = CameraKind::Orthographic;
    build::light(&mut d, LightKind::Constant { radiance: Rgb::WHITE });
    check.is(d, 1.0, 1e-5, &[Bdpt, Naive, Path]);
}

/// The largest single contribution.
#[derive(Default)]
struct Largest {
    eye: f64,
    splat: f64,
}

impl Sink for Largest {
    fn eye(&mut self, value: Rgb) {
        self.eye = self.eye.max(value.max_channel().into());
    }

    fn splat(&mut self, _: Vec2, value: Rgb) {
        self.splat = self.splat.max(value.max_channel().into());
    }
}

/// "Point light produces fireflies of 80,000 and more": a lamp a millimetre above the floor. What the weights
/// leave of next-event estimation there is within 300 times the picture's brightest pixels.
#[test]
fn point_light_fireflies() {
    check("point at the floor").agree(point_at_the_floor(), &[Bdpt, Light, Only("s>=2"), Power]);
    let scene = flatten(point_at_the_floor());
    let largest = |way: Way| {
        let kernel = Kernel::new(&scene, way.settings(5));
        let (mut scratch, mut sink) = (Scratch::default(), Largest::default());
        for sample in 0..300 {
            for pixel in 0..256 {
                kernel.sample([pixel % 16, pixel / 16], sample, &mut scratch, &mut sink);
            }
        }
        println!("{way:?}: {:.1} in the eye image, {:.3} in the light image", sink.eye, sink.splat);
        sink
    };
    let (path, bdpt) = (largest(Path), largest(Bdpt));
    assert!(bdpt.eye < 30.0 && bdpt.splat < 30.0);
    assert!(path.eye > 100.0 * bdpt.eye, "the scene is too easy");
}

fn numbers(d: Description, way: Way, passes: u32) -> Vec<f64> {
    let plan = Plan { passes, block: 2, only: None };
    estimate(&flatten(d), &way.settings(77), plan).blocks.iter().map(|b| b.mean).collect()
}

/// "Negative scale (mirrored transforms) with vertex normals, lamps that flip."
#[test]
fn mirrored_transforms() {
    for way in [Bdpt, Path, Light] {
        let (a, b) = (numbers(mirrored(true), way, 20), numbers(mirrored(false), way, 20));
        assert!(a.iter().sum::<f64>() > 0.1, "{way:?} is black");
        assert_eq!(a, b, "{way:?}");
    }
    check("mirrored").agree(mirrored(true), &[Bdpt, Path, Light]);
    // A picture taken through a mirrored camera is mirrored; only the sum over each row stays the same.
    let straight = scenes::ball(scenes::plastic_kind());
    let mut flipped = straight.clone();
    flipped.camera.to_world = caustica_math::Transform::scale([-1.0, 1.0, 1.0]).then(flipped.camera.to_world);
    let rows = Check { block: 16, ..check("mirrored camera") };
    let mut estimates = rows.estimates(straight, &[Bdpt]);
    estimates.extend(rows.estimates(flipped, &[Path, Bdpt, Light]));
    for e in &estimates[1..] {
        agree(&estimates[0], e).unwrap();
    }
}

/// "Large interior scenes: PT ≠ BDPT by percents."
#[test]
fn large_interior() {
    let check = Check { passes: 300, depth: 14, block: 8, ..check("three rooms") };
    check.agree(three_rooms(), &[Bdpt, Path, NoLightImage, Power]);
}

/// "Brightness depends on distance; wrong image edges; laser-like lights": the same scene at other scales, with
/// radiance kept, gives the same picture.
#[test]
fn scale() {
    for way in [Bdpt, Path, Light, Power] {
        let metres = numbers(scaled(1.0), way, 40);
        // By powers of two every figure scales exactly.
        for scale in [1.0 / 1024.0, 1024.0] {
            let other = numbers(scaled(scale), way, 40);
            let same = metres.iter().zip(&other).all(|(a, b)| (a - b).abs() <= 1e-5 * a);
            assert!(same, "{way:?} at {scale}: {metres:?} {other:?}");
        }
    }
    let at = |scale| check("scale").estimates(scaled(scale), &[Bdpt]).remove(0);
    let metres = check("scale").estimates(scaled(1.0), &[Path, NoLightImage, Power, Bdpt]).remove(3);
    for scale in [1e-3, 1e3] {
        if let Err(message) = agree(&metres, &at(scale)) {
            panic!("at {scale}: {message}");
        }
    }
    // The floor's radiance under a laser does not depend on the distance to it.
    for distance in [0.1, 10.0, 1000.0] {
        let mut d = plate();
        let position = [0.0, distance, 0.0];
        let outer_angle = atan2(0.5, distance).to_degrees();
        let s = f64::from(sin(0.5 * outer_angle.to_radians()));
        let solid_angle = 4.0 * PI * s * s;
        let intensity = Rgb::splat((1.0 / solid_angle) as f32);
        build::light(
            &mut d,
            LightKind::Spot {
                position,
                direction: [0.0, -1.0, 0.0],
                intensity,
                inner_angle: outer_angle,
                outer_angle,
            },
        );
        let check = Check { depth: 2, block: 8, passes: 400, ..check("laser") };
        // One watt on four square metres.
        check.is(d, 0.5 / PI / 4.0, 0.02, &[Bdpt, Path, Light]);
    }
}

/// "Roulette probability missing from the weights: 6–12% too bright": from the first bounce on, or not at all.
#[test]
fn roulette() {
    let scene = flatten(scenes::ball(scenes::plastic_kind()));
    let plan = Plan { passes: 200, block: 4, only: None };
    for way in [Bdpt, Path, Light, NoLightImage] {
        let from = |roulette_start, seed| {
            let e = estimate(
                &scene,
                &Settings { roulette_start: Some(roulette_start), ..way.settings(seed) },
                plan,
            );
            println!(
                "{way:?} from {roulette_start}: {:.5} ± {:.5}",
                e.whole.mean,
                e.whole.variance_of_mean().sqrt()
            );
            e
        };
        if let Err(message) = agree(&from(1000, 1), &from(0, 2)) {
            panic!("{way:?}: {message}");
        }
    }
}

/// The mean radiance of the plate under a lamp of intensity one at height `h` above its centre: what the plate
/// subtends there, over its area, times albedo/π.
fn under_a_point(h: f64) -> f64 {
    let subtended = 4.0 * f64::from(asin((1.0 / (1.0 + h * h)) as f32));
    0.5 / PI * subtended / 4.0
}

/// "Irradiance off by π between light types": on a plate, as worked out by hand.
#[test]
fn irradiance() {
    let check = |name| Check { depth: 2, block: 8, passes: 1200, ..check(name) };
    let with = |add: &dyn Fn(&mut Description)| {
        let mut d = plate();
        add(&mut d);
        d
    };
    let lit = |kind| with(&|d| build::light(d, kind));
    let down = [0.0, -1.0, 0.0];
    let (unit, h) = (Rgb::WHITE, 0.75);
    let position = [0.0, h as f32, 0.0];
    let delta = [Bdpt, Path, Emitters, Light, Only("s=1"), Only("2,1")];
    check("point").is(lit(LightKind::Point { position, intensity: unit }), under_a_point(h), 0.02, &delta);
    let spot =
        LightKind::Spot { position, direction: down, intensity: unit, inner_angle: 75.0, outer_angle: 80.0 };
    check("spot").is(lit(spot), under_a_point(h), 0.02, &delta);
    let sun = LightKind::Directional { direction: [0.6, -0.8, 0.0], irradiance: unit };
    check("sun").is(lit(sun), 0.8 * 0.5 / PI, 0.01, &delta);
    let all = [Bdpt, Naive, Path, Emitters, Light, Only("s=0"), Only("s=1"), Only("t=1")];
    check("constant").is(lit(LightKind::Constant { radiance: unit }), 0.5, 0.01, &all);
    let map = with(&|d| {
        let image = d.add_image(Image { width: 8, height: 4, pixels: vec![unit; 32].into() });
        build::light(
            d,
            LightKind::Environment {
                image,
                to_world: Default::default(),
                scale: 1.0,
                rows: Default::default(),
            },
        );
    });
    check("map").is(map, 0.5, 0.02, &all);
    // A ball of radius r and radiance L lights a plate that it does not touch like a point of intensity πLr².
    let ball = with(&|d| {
        let m = diffuse(d, 0.0);
        let ball = sphere(d, [0.0, 1.25, 0.0], 0.4, m);
        emit(d, ball, 3.0);
    });
    let expected = PI * 3.0 * 0.16 * under_a_point(1.25);
    check("ball").is(ball.clone(), expected, 0.015, &[Bdpt, Path, Emitters, Light, Only("s=1"), Only("t=1")]);
    check("ball").is(ball, expected, 0.05, &[Naive, Only("s=0")]);
    // The share of the light from one square that meets another, straight across at distance h: Howell, "A Catalog
    // of Radiation Heat Transfer Configuration Factors", C-11.
    let square = with(&|d| {
        let m = diffuse(d, 0.0);
        let lamp = quad(d, [-1.0, 1.5, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], m);
        emit(d, lamp, 1.0);
    });
    let x = 2.0 / 1.5_f64;
    let r = (1.0 + x * x).sqrt();
    let factor = 2.0 / (PI * x * x)
        * (f64::from(ln((r * r / (1.0 + 2.0 * x * x).sqrt()) as f32)) + 2.0 * x * r * (x / r).atan()
            - 2.0 * x * x.atan());
    Check { passes: 5000, ..check("square") }.is(square, 0.5 * factor, 0.01, &all);
}

/// "Black through glass, light lost behind glass, nested interfaces."
#[test]
fn behind_glass() {
    let check = |name| Check { passes: 400, depth: 14, ..check(name) };
    check("bulb").agree(scenes::bulb(), &[Bdpt, Naive, NoLightImage]);
    check("water in glass").agree(nested_interfaces(), &[Bdpt, Naive, NoLightImage, Power]);
}

/// "Caustics only with flipped normals": a caster described with its normals in or out.
#[test]
fn flipped_normals() {
    let out = check("out").estimates(caster(false), &[Bdpt, Light]);
    let inward = check("in").estimates(caster(true), &[Light, NoLightImage, Bdpt]);
    agree(&out[0], &inward[2]).unwrap();
    agree(&out[1], &inward[0]).unwrap();
}

/// "The same seed on every thread; results differ between runs."
#[test]
fn seeds() {
    for way in [Bdpt, Path, Light] {
        let (a, b) = (numbers(scaled(1.0), way, 8), numbers(scaled(1.0), way, 8));
        assert_eq!(a, b, "{way:?}");
        let scene = flatten(scaled(1.0));
        let plan = Plan { passes: 8, block: 2, only: None };
        let other = estimate(&scene, &way.settings(78), plan);
        let same = other.blocks.iter().zip(&a).filter(|(x, y)| x.mean == **y).count();
        // Some blocks show nothing but the environment.
        assert!(same < 32, "{way:?}: {same} of 64 blocks do not depend on the seed");
    }
    // Passes differ from each other: the variance over them is that of independent samples, 1/n of a pass's.
    let scene = flatten(scenes::open_box());
    let e = |passes, seed| {
        let plan = Plan { passes, block: 4, only: None };
        estimate(&scene, &Bdpt.settings(seed), plan)
    };
    agree(&e(100, 1), &e(100, u64::MAX)).unwrap();
}

/// "The pixel filter is ignored by light tracing": edges of a lamp and of shadows, pixel by pixel.
#[test]
fn pixel_filters() {
    let filters = [
        Filter::Gaussian { radius: 3.0, stddev: 1.5 },
        Filter::Mitchell { radius: 2.5, b: 1.0 / 3.0, c: 1.0 / 3.0 },
        Filter::Lanczos { lobes: 2 },
        Filter::Tent { radius: 2.0 },
        Filter::Box { radius: 1.3 },
    ];
    for filter in filters {
        let mut d = scenes::open_box();
        d.camera.kind = CameraKind::Perspective { fov: 24.0 };
        (d.film.width, d.film.height) = (10, 10);
        let m = diffuse(&mut d, 0.2);
        let lamp = quad(&mut d, [-0.4, -0.6, 0.2], [0.0, 0.7, 0.1], [0.5, 0.2, 0.0], m);
        emit(&mut d, lamp, 3.0);
        d.film.filter = filter;
        let check = Check { passes: 800, block: 1, depth: 2, ..check("filter") };
        check.agree(d, &[Path, Light, Bdpt]);
    }
}

/// "Textured emitters sampled wrongly."
#[test]
fn emitters_with_textures() {
    check("textured").agree(textured_emitters(), &[Bdpt, Naive, Path, Emitters, Light, NoLightImage]);
    let seen = Check { depth: 1, block: 2, passes: 400, ..check("textured, seen directly") };
    seen.agree(textured_emitters(), &[Naive, Only("1,1"), Bdpt]);
}
