//! Every strategy alone, and every integrator, against scenes whose radiance is known exactly.
//!
//! In a closed diffuse enclosure of albedo ρ that emits ε, every path length has a known share: k edges bring
//! ε·ρ^(k−1), in any direction, from anywhere. Under a point light of intensity π at the centre of a unit sphere it
//! is ρ^(k−1) for k ≥ 2.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use caustica_math::elementary::sin;
use caustica_math::stats::{Moments, sidak, student_t_test};
use caustica_math::{Rgb, Transform, Vec2};
use caustica_scene::Description;
use caustica_scene::description::{CameraKind, Integrator, MaterialId, MaterialKind, Technique};
use caustica_testkit::agreement::flatten;
use caustica_testkit::build::{diffuse, emit, glass, point_light, sphere};
use caustica_testkit::materials::{blend, checks, mask, thin_glass, two_sided};
use caustica_testkit::scenes::{furnace, glass_kind, point_furnace};
use caustica_testkit::seed::seed;
use caustica_transport::{Contribution, Kernel, Scratch, Settings, Sink, Strategy};

/// Edges of the longest paths.
const LONGEST: u32 = 5;
/// Of all strategies of a scene together.
const SIGNIFICANCE: f64 = 1e-3;

/// What adds up in a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Row {
    /// One strategy's unweighted estimates.
    Alone(Strategy),
    /// All strategies' weighted estimates of paths of that many edges.
    Together(u32),
}

impl Row {
    fn edges(self) -> u32 {
        match self {
            Row::Alone(s) => s.s + s.t - 1,
            Row::Together(k) => k,
        }
    }
}

/// Means over the sphere of directions of a 360° picture.
struct Shares {
    sums: BTreeMap<Row, f64>,
    height: f32,
}

impl Sink for Shares {
    const PROBES: bool = true;

    fn eye(&mut self, _: Rgb) {}

    fn splat(&mut self, _: Vec2, _: Rgb) {}

    fn contribution(&mut self, c: &Contribution<'_>) {
        // By the solid angle that a place on the film stands for: without this factor, splats near the poles make
        // a heavy tail.
        let solid_angle = f64::from(sin(std::f32::consts::PI * c.film.y / self.height)) * 0.5 * PI;
        let value = f64::from(c.unweighted[1]) * solid_angle;
        let mut add = |row, value| *self.sums.entry(row).or_default() += value;
        add(Row::Alone(c.strategy), value);
        add(Row::Together(c.strategy.s + c.strategy.t - 1), value * f64::from(c.weight));
    }
}

fn all_around(mut d: Description) -> Description {
    d.camera.kind = CameraKind::Environment;
    // Some pixels share light paths with what lies beyond the window.
    (d.film.width, d.film.height) = (11, 7);
    d.camera.to_world = Transform::rotate(20.0, [1.0, 0.2, 0.0]).then(Transform::translate([0.2, -0.1, 0.3]));
    d
}

/// Checks the share of each strategy (within ±`tolerance`, relative, and by Student's t-test) for paths of `first` edges and more; `expected` is `None` where it must not
/// find anything.
fn check(
    name: &str,
    d: Description,
    (passes, tolerance): (u32, f64),
    first: u32,
    expected: &dyn Fn(Row) -> Option<f64>,
) {
    let scene = flatten(all_around(d));
    let settings = Settings {
        max_depth: Some(LONGEST),
        seed: seed(3),
        roulette_start: Some(1000),
        ..Settings::default()
    };
    let kernel = Kernel::new(&scene, settings);
    let (width, height) = (scene.film.width, scene.film.height);
    let mut scratch = Scratch::default();
    let mut rows: BTreeMap<Row, Moments> = (first..=LONGEST)
        .flat_map(|k| {
            let alone = (0..=k).map(move |s| Row::Alone(Strategy { s, t: k + 1 - s }));
            alone.chain([Row::Together(k)])
        })
        .filter(|row| expected(*row).is_some())
        .map(|row| (row, Moments::default()))
        .collect();
    let pixels = kernel.in_groups((0..width * height).map(|i| [i % width, i / width]));
    for pass in 0..passes {
        let mut sink = Shares { sums: BTreeMap::new(), height: height as f32 };
        for &pixel in &pixels {
            kernel.sample(pixel, pass, &mut scratch, &mut sink);
        }
        for row in sink.sums.keys() {
            assert!(rows.contains_key(row), "{name}: {row:?} should not find anything");
        }
        for (row, moments) in &mut rows {
            moments.push(sink.sums.get(row).copied().unwrap_or(0.0) / f64::from(width * height));
        }
    }
    let alpha = sidak(SIGNIFICANCE, rows.len());
    let mut wrong = Vec::new();
    for (row, moments) in &rows {
        let Some(e) = expected(*row) else { continue };
        let p = student_t_test(moments, e);
        println!("{name} {row:?}: {:.5} of {e:.5} ± {:.5}", moments.mean, moments.variance_of_mean().sqrt());
        let close = (moments.mean / e - 1.0).abs() <= tolerance;
        if !close || p < alpha {
            wrong.push(format!("{row:?}: {:.6}, expected {e:.6} (p = {p:.1e})", moments.mean));
        }
    }
    assert!(wrong.is_empty(), "{name}:\n{}", wrong.join("\n"));
}

#[test]
fn every_strategy_under_emission() {
    check("furnace", furnace(), (500, 0.005), 1, &|row| Some(0.5_f64.powi(row.edges() as i32)));
}

#[test]
fn every_strategy_under_a_point_light() {
    for lamps in [1, 4] {
        check("point", point_furnace(lamps), (500, 0.005), 2, &|row| match row {
            Row::Alone(Strategy { s: 0, .. }) => None,
            _ => Some(0.5_f64.powi(row.edges() as i32 - 1)),
        });
    }
}

/// Two kinds of lamps, of unequal power: s = 0 finds the walls' part, the others all.
#[test]
fn every_strategy_under_both() {
    let mut d = furnace();
    point_light(&mut d, [0.0; 3], 0.5 * std::f32::consts::PI);
    d.shapes[0].emission = Some(Rgb::splat(0.25).into());
    let walls = |k: u32| 0.5 * 0.5_f64.powi(k as i32);
    let point = |k: u32| if k >= 2 { 0.5_f64.powi(k as i32) } else { 0.0 };
    check("both", d, (900, 0.015), 1, &|row| match row {
        Row::Alone(Strategy { s: 0, t }) => Some(walls(t - 1)),
        Row::Alone(s) => Some(walls(s.s + s.t - 1) + point(s.s + s.t - 1)),
        Row::Together(k) => Some(walls(k) + point(k)),
    });
}

/// Radiance seen by each integrator that can reach it, over a 360° picture.
fn whole(name: &str, d: Description, (passes, tolerance): (u32, f64), integrators: &[Integrator]) {
    struct Whole {
        sum: f64,
        row: u32,
        light_alone: bool,
        width: f32,
        height: f32,
    }
    impl Whole {
        /// Adds a pixel's value by the solid angle of its row. (By that of a place within the row, eye and light
        /// image would not add up: their weights vary over it.)
        fn add(&mut self, row: f32, value: Rgb) {
            let cos = |y: f32| f64::from(sin(std::f32::consts::PI * (0.5 - y / self.height)));
            let share = 0.5 * f64::from(self.height) * (cos(row) - cos(row + 1.0));
            self.sum += f64::from(value.luminance()) * share;
        }
    }
    impl Sink for Whole {
        fn eye(&mut self, value: Rgb) {
            self.add(self.row as f32, value);
        }
        fn splat(&mut self, film: Vec2, value: Rgb) {
            // Beyond the seams and poles lie aliases, for wider filters.
            if film.y >= 0.0 && film.y < self.height && film.x >= 0.0 && film.x < self.width {
                if self.light_alone {
                    // Lighter tails at the poles.
                    let sin = sin(std::f32::consts::PI * film.y / self.height);
                    self.sum += f64::from(value.luminance() * sin) * 0.5 * PI;
                } else {
                    self.add(film.y.floor(), value);
                }
            }
        }
    }
    let scene = flatten(all_around(d));
    for integrator in integrators {
        // Late roulette: by then hardly any light is left to be noisy.
        let settings = Settings {
            integrator: *integrator,
            seed: seed(17),
            roulette_start: Some(9),
            ..Settings::default()
        };
        let kernel = Kernel::new(&scene, settings);
        let (width, height) = (scene.film.width, scene.film.height);
        let (mut scratch, mut moments) = (Scratch::default(), Moments::default());
        let pixels = kernel.in_groups((0..width * height).map(|i| [i % width, i / width]));
        for pass in 0..passes {
            let mut sink = Whole {
                sum: 0.0,
                row: 0,
                light_alone: *integrator == Integrator::Light,
                width: width as f32,
                height: height as f32,
            };
            for &pixel in &pixels {
                sink.row = pixel[1];
                kernel.sample(pixel, pass, &mut scratch, &mut sink);
            }
            moments.push(sink.sum / f64::from(width * height));
        }
        let p = student_t_test(&moments, 1.0);
        println!("{name} {integrator:?}: {:.5} ± {:.5}", moments.mean, moments.variance_of_mean().sqrt());
        assert!(
            (moments.mean - 1.0).abs() < tolerance && p > SIGNIFICANCE,
            "{name} {integrator:?}: {} (p = {p:.1e})",
            moments.mean
        );
    }
}

const NAIVE: Integrator = Integrator::Path(Technique::Materials);
const EMITTERS: Integrator = Integrator::Path(Technique::Emitters);
const PATH: Integrator = Integrator::Path(Technique::Mis);

#[test]
fn furnaces_by_every_integrator() {
    whole("furnace", furnace(), (400, 0.002), &[NAIVE, EMITTERS, PATH, Integrator::Bdpt]);
    whole("furnace", furnace(), (2000, 0.002), &[Integrator::Light]);
    whole("point", point_furnace(1), (400, 0.002), &[EMITTERS, PATH, Integrator::Bdpt]);
    whole("point", point_furnace(1), (5000, 0.002), &[Integrator::Light]);
    whole("four points", point_furnace(4), (400, 0.002), &[EMITTERS, PATH, Integrator::Bdpt]);
}

/// Balls of what neither absorbs nor adds light leave the radiance at one.
#[test]
fn furnaces_with_balls() {
    let with = |kind: MaterialKind| {
        let mut d = furnace();
        let m = d.add_material(kind);
        sphere(&mut d, [0.1, 0.2, -0.4], 0.35, m);
        d
    };
    let mirror = MaterialKind::Mirror { reflectance: Rgb::WHITE };
    for (name, kind) in [("mirror", mirror), ("glass", glass_kind(false)), ("bubble", glass_kind(true))] {
        whole(name, with(kind), (140, 0.005), &[NAIVE, EMITTERS, PATH, Integrator::Bdpt]);
    }
    let made = |make: &dyn Fn(&mut Description) -> MaterialId| {
        let mut d = furnace();
        let m = make(&mut d);
        sphere(&mut d, [0.1, 0.2, -0.4], 0.35, m);
        d
    };
    let white = |d: &mut Description| diffuse(d, 1.0);
    let all = &[NAIVE, EMITTERS, PATH, Integrator::Bdpt];
    whole("nothing", made(&|d| d.add_material(MaterialKind::Null)), (140, 0.005), all);
    whole("thin glass", made(&|d| d.add_material(thin_glass())), (140, 0.005), all);
    let masked = |d: &mut Description| {
        let white = white(d);
        let both = two_sided(d, white, white);
        mask(d, checks(3.0, [0.2, 0.9]), both)
    };
    whole("mask", made(&masked), (300, 0.005), all);
    let frosted = |d: &mut Description| {
        let (clear, white) = (glass(d), white(d));
        let both = two_sided(d, white, white);
        blend(d, checks(3.0, [0.3, 0.7]), [clear, both])
    };
    whole("blend", made(&frosted), (300, 0.005), all);
    // One in the other.
    let mut nested = with(glass_kind(false));
    let water = nested.add_material(MaterialKind::dielectric(1.33, 1.5));
    sphere(&mut nested, [0.1, 0.2, -0.4], 0.25, water);
    whole("nested", nested, (140, 0.005), &[NAIVE, PATH, Integrator::Bdpt]);
    // One that is itself a lamp of what the walls are: diffuse, so that every integrator sees it.
    let mut lamp = furnace();
    let m = diffuse(&mut lamp, 0.25);
    let ball = sphere(&mut lamp, [0.1, 0.2, -0.4], 0.35, m);
    emit(&mut lamp, ball, 0.75);
    whole("lamp", lamp, (350, 0.005), &[NAIVE, EMITTERS, PATH, Integrator::Light, Integrator::Bdpt]);
}

/// From inside glass of index n, radiance is n² times that outside.
#[test]
fn radiance_inside_glass() {
    let mut d = furnace();
    let m = glass(&mut d);
    sphere(&mut d, [0.2, -0.1, 0.3], 0.3, m);
    let scaled = |e: f32| e / 2.25;
    d.shapes[0].emission = Some(Rgb::splat(scaled(0.5)).into());
    whole("inside", d, (140, 0.005), &[NAIVE, EMITTERS, PATH, Integrator::Bdpt]);
}
