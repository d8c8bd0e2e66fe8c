//! Aimed rays: they leave the picture as it is, and take out noise where nothing else makes a path.

use caustica_math::stats::{Moments, welch_t_test};
use caustica_math::{Rgb, Vec2};
use caustica_scene::Description;
use caustica_scene::description::{CameraKind, LightKind, MaterialKind};
use caustica_scene::light::Anchor;
use caustica_testkit::agreement::{Estimate, Plan, agree, estimate, flatten};
use caustica_testkit::build::{emit, glass, light, look, quad, scene, sphere};
use caustica_testkit::seed::seed;
use caustica_transport::{Contribution, Kernel, Scratch, Settings, Sink};

/// A floor under a glass ball, seen in a mirror ball.
fn seen_in_a_ball() -> Description {
    let mut d = scene(8);
    look(&mut d, [0.0, 0.3, -0.6], [0.0, -0.35, 0.6]);
    d.camera.kind = CameraKind::Perspective { fov: 40.0 };
    let grey = d.add_material(MaterialKind::Diffuse { albedo: Rgb::splat(0.6).into() });
    let mirror = d.add_material(MaterialKind::Mirror { reflectance: Rgb::splat(0.9) });
    let glass = glass(&mut d);
    quad(&mut d, [-1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], grey);
    sphere(&mut d, [0.0, -0.4, 0.6], 0.4, mirror);
    sphere(&mut d, [0.1, -0.7, -0.2], 0.25, glass);
    d
}

fn under_a_lamp() -> Description {
    let mut d = seen_in_a_ball();
    let black = d.add_material(MaterialKind::Diffuse { albedo: Rgb::BLACK.into() });
    let lamp = quad(&mut d, [-0.15, 0.9, 0.05], [0.3, 0.0, 0.0], [0.0, 0.0, 0.3], black);
    emit(&mut d, lamp, 30.0);
    d
}

fn under_the_sky() -> Description {
    let mut d = seen_in_a_ball();
    light(&mut d, LightKind::Constant { radiance: Rgb::splat(1.0) });
    d
}

fn render(d: &Description, aimed_rays: u32, (first, passes): (u64, u32)) -> Estimate {
    let settings = Settings {
        aimed_rays,
        max_depth: Some(9),
        seed: seed(first + u64::from(aimed_rays)),
        ..Settings::default()
    };
    estimate(&flatten(d.clone()), &settings, Plan { passes, block: 4, only: None })
}

/// Block by block, by Welch's t-test at 10⁻³ a pair of pictures, Šidák-corrected.
#[test]
fn the_picture_is_the_same_with_any_number_of_them() {
    for (name, d) in [("lamp", under_a_lamp()), ("sky", under_the_sky())] {
        let without = render(&d, 0, (40, 20_000));
        for rays in [1, 2, 9] {
            let with = render(&d, rays, (50, 2000));
            println!("{name}, {rays}: {:.5} for {:.5}", with.whole.mean, without.whole.mean);
            agree(&without, &with).unwrap_or_else(|e| panic!("{name}: {rays} aimed rays: {e}"));
        }
    }
}

/// Balls that are seen thousands of times as far away as they are wide, off the axes, so that directions are rounded. At
/// their borders they mirror the sky behind them.
#[test]
fn small_casters_are_as_bright_with_any_number_of_rays() {
    for turn in 0..12 {
        let mut d = scene(1);
        look(&mut d, [0.1, 1.0, 0.2], [0.03, 0.0, 0.07]);
        d.camera.kind = CameraKind::RadianceMeter;
        let grey = d.add_material(MaterialKind::Diffuse { albedo: Rgb::splat(0.6).into() });
        let mirror = d.add_material(MaterialKind::Mirror { reflectance: Rgb::WHITE });
        quad(&mut d, [-1.0, 0.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], grey);
        let (x, z) = (5.77 + 0.17 * turn as f32, 6.93 - 0.31 * turn as f32);
        sphere(&mut d, [x, 4.3, z], 1e-3, mirror);
        light(&mut d, LightKind::Constant { radiance: Rgb::WHITE });
        let [none, twenty] = [0, 20].map(|rays| render(&d, rays, (70, 20_000)).whole.mean);
        assert!((twenty / none - 1.0).abs() < 1e-3, "{turn}: {twenty:e}, {none:e}");
    }
}

/// Squares of what the lamps add that are found beyond a point of the floor that is itself seen in a mirror or in glass.
#[derive(Default)]
struct Squares {
    found: u32,
    sum: f64,
}

/// Whether it is found beyond a point that is itself seen in a mirror or in glass.
fn is_beyond(c: &Contribution<'_>) -> bool {
    let on_lamp = usize::from(c.path.lamp.anchor == Anchor::Surface);
    let before = &c.path.eye[..c.path.eye.len() - on_lamp.min(c.path.eye.len())];
    let [first, between @ .., last] = before else { return false };
    c.strategy.s == 0 && first.delta && last.delta && between.iter().any(|v| v.is_connectible())
}

impl Sink for Squares {
    const PROBES: bool = true;

    fn eye(&mut self, _: Rgb) {}
    fn splat(&mut self, _: Vec2, _: Rgb) {}
    fn contribution(&mut self, c: &Contribution<'_>) {
        if is_beyond(c) {
            self.found += 1;
            self.sum += f64::from(c.unweighted[1] * c.weight).powi(2);
        }
    }
}

/// Two rays cost less than another sample.
#[test]
fn they_take_out_most_of_the_noise() {
    let scene = flatten(under_a_lamp());
    let [none, two] = [0, 2].map(|aimed_rays| {
        let settings = Settings { aimed_rays, max_depth: Some(9), seed: seed(60), ..Settings::default() };
        let kernel = Kernel::new(&scene, settings);
        let (mut scratch, mut squares) = (Scratch::default(), Squares::default());
        for i in 0..400_000u32 {
            kernel.sample([i % 8, i / 8 % 8], i / 64, &mut scratch, &mut squares);
        }
        println!("{aimed_rays} rays: {} found, {:.1}", squares.found, squares.sum);
        squares
    });
    assert!(two.found > 4 * none.found && two.sum < 0.3 * none.sum);
}

/// How often the walk finds lamps there, as the weights tell it.
#[derive(Default)]
struct Shares(f64);

impl Sink for Shares {
    const PROBES: bool = true;
    const WEIGHS_ALL: bool = true;

    fn eye(&mut self, _: Rgb) {}
    fn splat(&mut self, _: Vec2, _: Rgb) {}
    fn contribution(&mut self, c: &Contribution<'_>) {
        if is_beyond(c) {
            self.0 += f64::from(c.weights[0]);
        }
    }
}

/// The walk's weight is its share in all times that a path is found. So the sum of these weights is the number of paths
/// that the walk finds, whether or not aimed rays find them more often. (Roulette is in no weight.) By Welch's t-test at
/// 10⁻³.
#[test]
fn the_shares_of_the_walk_add_up_to_what_it_finds() {
    let scene = flatten(under_the_sky());
    let [none, two] = [0, 2].map(|aimed_rays| {
        let seed = seed(80 + u64::from(aimed_rays));
        let settings =
            Settings { aimed_rays, max_depth: Some(9), roulette_start: Some(9), seed, ..Settings::default() };
        let kernel = Kernel::new(&scene, settings);
        let (mut scratch, mut found) = (Scratch::default(), Moments::default());
        for i in 0..400_000u32 {
            let mut shares = Shares::default();
            kernel.sample([i % 8, i / 8 % 8], i / 64, &mut scratch, &mut shares);
            found.push(shares.0);
        }
        found
    });
    println!("{:.3e} and {:.3e} a sample", none.mean, two.mean);
    assert!(none.mean > 0.0 && welch_t_test(&none, &two, 0.0) > 1e-3);
}
