//! The identity on which bidirectional path tracing rests: for one path, every strategy's estimate times its
//! density is the same measured contribution, and the weights of all strategies follow from the densities.
//!
//! [`caustica_testkit::oracle`] works both out for each path that a strategy finds, in many small scenes. This is
//! deterministic: a wrong jacobian, a forgotten adjoint or a mistaken density shows in a single path.

use std::collections::BTreeMap;

use caustica_math::{Filter, Rgb, Transform, Vec2};
use caustica_scene::description::{
    CameraKind, Crop, Geometry, Image, ImageId, LightKind, MaterialId, MaterialKind, Mesh, Texture,
    TextureTransform,
};
use caustica_scene::{Description, Scene};
use caustica_testkit::agreement::flatten;
use caustica_testkit::build::{add, ellipsoid, emit, glass, light, look, point_light, quad, scene, sphere};
use caustica_testkit::oracle::{judge, lanes};
use caustica_testkit::scenes::inside_out;
use caustica_transport::{Contribution, Heuristic, Kernel, Scratch, Settings, Sink, Strategy, StrategySet};

/// Edges of the longest paths.
const DEPTH: u32 = 6;
/// Relative error of an estimate, and absolute error of a weight.
const TOLERANCE: f64 = 2e-3;
/// Paths that graze surfaces, have tiny edges or pass far down a lobe's flank lose more digits than this and are
/// not checked.
const UNCERTAIN: f64 = 1.5e-3;

/// What was checked and what was found wrong.
#[derive(Default)]
struct Tally {
    checked: BTreeMap<Strategy, u32>,
    skipped: u32,
    wrong: u32,
    messages: Vec<String>,
}

impl Tally {
    fn wrong(&mut self, message: String) {
        self.wrong += 1;
        if self.messages.len() < 12 {
            self.messages.push(message);
        }
    }
}

/// Judges every contribution, and that the film gets what they amount to.
struct Judge<'a> {
    scene: &'a Scene,
    settings: Settings,
    tally: Tally,
    /// Of one sample: what went to the eye image and to the light image, and what should have.
    film: [f64; 2],
    due: [f64; 2],
}

impl Judge<'_> {
    fn check(&mut self, c: &Contribution<'_>) -> Result<bool, String> {
        if !self.settings.strategies.contains(c.strategy) {
            return Err("not in the set".into());
        }
        // All comparisons are written so that NaN fails them.
        if !(c.unweighted.is_valid() && (0.0..=1.0 + 1e-4).contains(&c.weight)) {
            return Err(format!("estimate {:?}, weight {}", c.unweighted, c.weight));
        }
        let judgement = judge(self.scene, c)?;
        if judgement.uncertainty > UNCERTAIN {
            return Ok(false);
        }
        let (estimate, expected) = (lanes(c.unweighted), judgement.estimate(c.strategy));
        let largest = expected.iter().fold(0.0_f64, |a, b| a.max(*b));
        let close = |lane: usize| (estimate[lane] - expected[lane]).abs() <= TOLERANCE * largest;
        if !(0..3).all(close) {
            let ratio = [0, 1, 2].map(|lane| estimate[lane] / expected[lane]);
            return Err(format!("estimate {estimate:?} is {ratio:?} of what it should be; {judgement:?}"));
        }
        let weight = judgement.weight(c.strategy, &self.settings.strategies, self.settings.heuristic);
        let off = (f64::from(c.weight) - weight).abs();
        if off.partial_cmp(&TOLERANCE) != Some(std::cmp::Ordering::Less) {
            return Err(format!("weight {} should be {weight}; {judgement:?}", c.weight));
        }
        Ok(true)
    }
}

impl Sink for Judge<'_> {
    const PROBES: bool = true;

    fn eye(&mut self, value: Rgb) {
        self.film[0] += f64::from(value.0[1]);
    }

    fn splat(&mut self, _: Vec2, value: Rgb) {
        self.film[1] += f64::from(value.0[1]);
    }

    fn contribution(&mut self, c: &Contribution<'_>) {
        self.due[usize::from(c.strategy.t == 1)] += f64::from(c.unweighted[1] * c.weight);
        match self.check(c) {
            Ok(true) => *self.tally.checked.entry(c.strategy).or_default() += 1,
            Ok(false) => self.tally.skipped += 1,
            Err(m) => self.tally.wrong(format!("{}: {m}", c.strategy)),
        }
    }
}

/// A scene and what it is to show.
struct Case {
    name: &'static str,
    description: Description,
    /// Strategies that cannot occur.
    impossible: fn(Strategy) -> bool,
}

fn case(name: &'static str, description: Description) -> Case {
    Case { name, description, impossible: |_| false }
}

impl Case {
    fn without(self, impossible: fn(Strategy) -> bool) -> Self {
        Self { impossible, ..self }
    }
}

fn settings(strategies: &str, heuristic: Heuristic, exhaustive_weights: bool) -> Settings {
    Settings {
        max_depth: Some(DEPTH),
        // No roulette.
        roulette_start: 1000,
        seed: 7,
        strategies: strategies.parse().unwrap(),
        heuristic,
        exhaustive_weights,
        ..Settings::default()
    }
}

/// Renders passes of one sample a pixel and judges all that is found.
fn run(scene: &Scene, settings: Settings, passes: u32) -> Tally {
    let kernel = Kernel::new(scene, settings.clone());
    let mut scratch = Scratch::default();
    let mut judge = Judge { scene, settings, tally: Tally::default(), film: [0.0; 2], due: [0.0; 2] };
    let window = scene.film.window();
    // In a 360° picture a splat near a seam is repeated beyond it.
    let repeats = scene.camera.aliases(Vec2::new(0.1, 0.1), 1.0).count() > 1;
    for pass in 0..passes {
        for i in 0..window.width * window.height {
            (judge.film, judge.due) = ([0.0; 2], [0.0; 2]);
            let pixel = [window.x + i % window.width, window.y + i / window.width];
            kernel.sample(pixel, pass, &mut scratch, &mut judge);
            for layer in 0..if repeats { 1 } else { 2 } {
                let (got, due) = (judge.film[layer], judge.due[layer]);
                if !((got - due).abs() <= 1e-4 * due) {
                    judge.tally.wrong(format!("layer {layer} gets {got} where {due} is due"));
                }
            }
        }
    }
    judge.tally
}

fn expect_clean(name: &str, settings: &Settings, tally: &Tally) {
    let what = format!(
        "{name}, {} by {:?}{}",
        settings.strategies,
        settings.heuristic,
        if settings.exhaustive_weights { ", exhaustive" } else { "" }
    );
    let checked: u32 = tally.checked.values().sum();
    let all = checked + tally.wrong + tally.skipped;
    assert!(tally.wrong == 0, "{what}: {} of {all} wrong:\n{}", tally.wrong, tally.messages.join("\n"));
    assert!(tally.skipped * 50 <= all, "{what}: {} of {all} skipped", tally.skipped);
    assert!(checked > 0, "{what}: nothing was found");
}

/// Sets of which some are and some are no unions of classes.
const SETS: [&str; 6] = ["s=0", "t>=2", "s=0;s=1&t>=2", "t=1", "2,3", "s>=2&t>=2"];

fn verify(case: Case) {
    let Case { name, description, impossible } = case;
    let scene = flatten(description);
    let window = scene.film.window();
    let passes = |samples: u32| samples.div_ceil(window.width * window.height);
    let all = settings("all", Heuristic::Balance, false);
    let tally = run(&scene, all.clone(), passes(1500));
    expect_clean(name, &all, &tally);
    println!("{name}: {:?}, {} skipped", tally.checked, tally.skipped);
    for k in 1..=DEPTH {
        for strategy in (0..=k).map(|s| Strategy { s, t: k + 1 - s }) {
            let found = tally.checked.contains_key(&strategy);
            assert!(found != impossible(strategy), "{name}: {strategy} was found: {found}");
        }
    }
    for (heuristic, exhaustive) in
        [(Heuristic::Balance, true), (Heuristic::Power, false), (Heuristic::Power, true)]
    {
        let s = settings("all", heuristic, exhaustive);
        expect_clean(name, &s, &run(&scene, s.clone(), passes(200)));
    }
    for (i, set) in SETS.iter().enumerate() {
        let heuristic = if i % 2 == 0 { Heuristic::Balance } else { Heuristic::Power };
        let s = settings(set, heuristic, false);
        if (1..=DEPTH).any(|k| reaches(&s.strategies, k, impossible)) {
            expect_clean(name, &s, &run(&scene, s.clone(), passes(200)));
        }
    }
}

/// Whether a set has a possible strategy for paths of `k` edges.
fn reaches(set: &StrategySet, k: u32, impossible: fn(Strategy) -> bool) -> bool {
    (0..=k).map(|s| Strategy { s, t: k + 1 - s }).any(|s| set.contains(s) && !impossible(s))
}

/// Lamps without an extent cannot be hit, nor are they in the picture themselves.
fn hits(s: Strategy) -> bool {
    s.s == 0 || s == Strategy { s: 1, t: 1 }
}

fn coloured(d: &mut Description, rgb: [f32; 3]) -> MaterialId {
    d.add_material(MaterialKind::Diffuse { albedo: Rgb(rgb).into() })
}

/// A floor with walls on two sides, seen from between them.
fn stage() -> Description {
    let mut d = scene(8);
    look(&mut d, [0.05, 0.1, -0.9], [0.0, -0.1, 0.2]);
    let m = coloured(&mut d, [0.8, 0.6, 0.4]);
    let red = coloured(&mut d, [0.7, 0.2, 0.1]);
    quad(&mut d, [-1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], m);
    quad(&mut d, [-1.0, -1.0, -1.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0], red);
    quad(&mut d, [1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [0.0, 2.0, 0.0], m);
    d
}

/// The stage with its other walls and a ceiling.
fn closed() -> Description {
    let mut d = stage();
    quad(&mut d, [-1.0, -1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], MaterialId(0));
    quad(&mut d, [-1.0, -1.0, 1.0], [0.0, 2.0, 0.0], [2.0, 0.0, 0.0], MaterialId(0));
    quad(&mut d, [-1.0, 1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], MaterialId(0));
    d
}

/// A lamp in view, turned to the middle of the room.
fn lamp(d: &mut Description) -> usize {
    let m = coloured(d, [0.3, 0.4, 0.5]);
    let lamp = quad(d, [-0.4, 0.65, 0.1], [0.8, 0.1, 0.0], [0.0, -0.3, 0.6], m);
    emit(d, lamp, 3.0);
    lamp
}

/// The closed room with the lamp.
fn room() -> Description {
    let mut d = closed();
    lamp(&mut d);
    d
}

/// A room with a ball.
fn ball(material: MaterialKind) -> Description {
    let mut d = room();
    let m = d.add_material(material);
    sphere(&mut d, [0.1, -0.25, 0.2], 0.45, m);
    d
}

/// A room with a coarse ellipsoid whose shading normals lean far from the geometric ones.
fn faceted(material: MaterialKind) -> Description {
    let mut d = room();
    let m = d.add_material(material);
    add_ellipsoid(&mut d, m);
    d
}

fn add_ellipsoid(d: &mut Description, m: MaterialId) {
    let egg = add(d, "egg", Geometry::Mesh(ellipsoid(5, [0.5, 0.35, 0.4])), m);
    d.shapes[egg].to_world =
        Transform::rotate(20.0, [1.0, 0.5, 0.0]).then(Transform::translate([0.05, -0.3, 0.2]));
}

fn dielectric(interior_ior: f32) -> MaterialKind {
    MaterialKind::Dielectric { interior_ior, exterior_ior: 1.0 }
}

fn rough_dielectric(interior_ior: f32, exterior_ior: f32) -> MaterialKind {
    MaterialKind::RoughDielectric { alpha: 0.25, interior_ior, exterior_ior }
}

const GOLD: [Rgb; 2] = [Rgb([0.14312, 0.37496, 1.4425]), Rgb([3.9832, 2.3857, 1.6032])];

fn gold() -> MaterialKind {
    MaterialKind::Conductor { eta: GOLD[0], k: GOLD[1], reflectance: Rgb([0.9, 1.0, 0.8]) }
}

fn rough_gold(alpha: f32) -> MaterialKind {
    MaterialKind::RoughConductor { alpha, eta: GOLD[0], k: GOLD[1], reflectance: Rgb::WHITE }
}

fn microfacet() -> MaterialKind {
    MaterialKind::Microfacet {
        alpha: 0.2,
        interior_ior: 1.5,
        exterior_ior: 1.0,
        kd: Rgb([0.3, 0.2, 0.4]).into(),
    }
}

#[test]
fn diffuse_room() {
    verify(case("diffuse room", room()));
}

#[test]
fn smooth_materials() {
    verify(case("glass", ball(dielectric(1.5))));
    verify(case("bubble", ball(dielectric(0.7))));
    verify(case("no interface", ball(dielectric(1.0))));
    verify(case("mirror", ball(MaterialKind::Mirror { reflectance: Rgb([0.9, 0.8, 0.7]) })));
    verify(case("gold", ball(gold())));
}

#[test]
fn rough_materials() {
    verify(case("rough glass", ball(rough_dielectric(1.5, 1.0))));
    verify(case("rough bubble", ball(rough_dielectric(1.0, 1.4))));
    verify(case("no rough interface", ball(rough_dielectric(1.3, 1.3))));
    verify(case("rough gold", ball(rough_gold(0.2))));
    verify(case("sharp gold", ball(rough_gold(0.02))));
    verify(case("microfacet", ball(microfacet())));
}

#[test]
fn shading_normals() {
    verify(case("diffuse egg", faceted(MaterialKind::Diffuse { albedo: Rgb([0.9, 0.7, 0.5]).into() })));
    verify(case("glass egg", faceted(dielectric(1.5))));
    verify(case("mirror egg", faceted(MaterialKind::Mirror { reflectance: Rgb::WHITE })));
    verify(case("rough glass egg", faceted(rough_dielectric(1.5, 1.0))));
    verify(case("rough gold egg", faceted(rough_gold(0.3))));
    verify(case("microfacet egg", faceted(microfacet())));
}

/// An image without symmetries.
fn image(d: &mut Description, width: u32, height: u32) -> ImageId {
    let pixel = |i: u32| {
        let channel = |k: u32| 0.1 + (i.wrapping_mul(k) % 17) as f32 / 8.0;
        Rgb([channel(5), channel(7), channel(11)])
    };
    d.add_image(Image { width, height, pixels: (0..width * height).map(pixel).collect() })
}

fn environment(d: &mut Description) {
    let image = image(d, 8, 4);
    let to_world = Transform::rotate(35.0, [1.0, 2.0, 0.5]);
    light(d, LightKind::Environment { image, to_world, scale: 0.7 });
}

fn sky(d: &mut Description) {
    light(d, LightKind::Constant { radiance: Rgb([0.5, 0.7, 1.0]) });
}

fn sun(d: &mut Description) {
    light(d, LightKind::Directional { direction: [0.3, -1.0, 0.5], irradiance: Rgb([2.0, 1.8, 1.5]) });
}

fn spot(d: &mut Description) {
    let kind = LightKind::Spot {
        position: [-0.3, 0.8, 0.3],
        direction: [0.4, -1.0, 0.1],
        intensity: Rgb([3.0, 2.0, 1.0]),
        inner_angle: 20.0,
        outer_angle: 55.0,
    };
    light(d, kind);
}

/// A stage with a rough egg and the given lamps.
fn lit(lamps: &[fn(&mut Description)]) -> Description {
    let mut d = stage();
    let m = d.add_material(rough_dielectric(1.5, 1.0));
    add_ellipsoid(&mut d, m);
    for lamp in lamps {
        lamp(&mut d);
    }
    d
}

#[test]
fn lamps_at_infinity() {
    verify(case("sky", lit(&[sky])));
    verify(case("environment map", lit(&[environment])));
    verify(case(
        "two skies and a lamp",
        lit(&[sky, environment, |d| {
            lamp(d);
        }]),
    ));
    verify(case("sun", lit(&[sun])).without(hits));
    let mut d = stage();
    let m = d.add_material(dielectric(1.5));
    add_ellipsoid(&mut d, m);
    sun(&mut d);
    environment(&mut d);
    verify(case("glass egg in the sun", d));
}

#[test]
fn lamps_without_extent() {
    let mut d = closed();
    point_light(&mut d, [0.2, 0.4, 0.3], 2.0);
    add_ellipsoid(&mut d, MaterialId(1));
    verify(case("point", d.clone()).without(hits));
    d.lights.clear();
    spot(&mut d);
    verify(case("spot", d).without(hits));
}

#[test]
fn sphere_lamps() {
    let mut d = closed();
    let m = coloured(&mut d, [0.3, 0.5, 0.4]);
    let bulb = sphere(&mut d, [-0.3, 0.4, 0.3], 0.25, m);
    emit(&mut d, bulb, 3.0);
    verify(case("bulb", d));

    // Seen from inside of its glass, and by what is inside with the camera.
    let mut d = closed();
    let m = glass(&mut d);
    let bulb = sphere(&mut d, [0.0, 0.0, -0.1], 0.85, m);
    emit(&mut d, bulb, 1.0);
    sphere(&mut d, [0.2, 0.0, 0.15], 0.4, MaterialId(0));
    look(&mut d, [0.05, 0.0, -0.5], [0.1, 0.0, 0.3]);
    // What the camera sees is inside, or the glass.
    verify(case("inside of a bulb", d).without(|s| s.s + s.t < 4 || (s.s > 0 && s.t == 2) || (s.s < 4 && s.t == 1)));

    let mut d = scene(8);
    let m = coloured(&mut d, [0.5, 0.6, 0.7]);
    let shell = inside_out(&mut d, m);
    emit(&mut d, shell, 1.0);
    sphere(&mut d, [0.2, 0.0, 0.4], 0.3, m);
    verify(case("shell", d));
}

#[test]
fn textured_and_many_lamps() {
    let mut d = closed();
    let shape = lamp(&mut d);
    let image = image(&mut d, 5, 3);
    let transform = TextureTransform { scale: [1.5, 2.0], offset: [0.2, 0.1] };
    d.shapes[shape].emission = Some(Texture::Image { image, transform });
    verify(case("textured lamp", d.clone()));
    d.shapes[shape].emission = Some(Texture::Checkerboard {
        delta: [0.1, 0.2],
        scale: [0.3, 0.4],
        value1: Rgb([1.0, 2.0, 3.0]),
        value2: Rgb([0.5, 0.1, 0.0]),
    });
    verify(case("checkered lamp", d));

    let mut d = lit(&[sky, sun, spot]);
    lamp(&mut d);
    point_light(&mut d, [0.5, 0.1, -0.2], 0.4);
    let bulb = sphere(&mut d, [0.6, -0.6, -0.2], 0.2, MaterialId(1));
    emit(&mut d, bulb, 2.0);
    verify(case("many lamps", d));
}

/// A room with a lamp, a mirror and a rough egg, whose camera is still to be chosen.
fn studio(kind: CameraKind) -> Description {
    let mut d = faceted(rough_gold(0.3));
    let m = d.add_material(MaterialKind::Mirror { reflectance: Rgb::WHITE });
    sphere(&mut d, [-0.6, -0.6, 0.5], 0.3, m);
    d.camera.kind = kind;
    d
}

const THIN_LENS: CameraKind = CameraKind::ThinLens { fov: 70.0, aperture_radius: 0.08, focus_distance: 1.1 };

#[test]
fn cameras() {
    verify(case("lens", studio(THIN_LENS)));
    verify(case("parallel", studio(CameraKind::Orthographic)));
    verify(case("all around", studio(CameraKind::Environment)));
    // It cannot be joined with the sky, and sees no sky in the room's open front.
    let mut d = lit(&[environment]);
    d.camera.kind = CameraKind::Orthographic;
    d.camera.to_world = Transform::scale([1.2; 3]).then(d.camera.to_world);
    verify(case("parallel under a sky", d.clone()).without(|s| s == Strategy { s: 1, t: 1 }));
    d.camera.kind = CameraKind::Environment;
    verify(case("all around under a sky", d.clone()));
    d.camera.kind = THIN_LENS;
    verify(case("lens under a sky", d));
}

#[test]
fn films() {
    let mut d = studio(THIN_LENS);
    d.film.filter = Filter::Gaussian { radius: 1.5, stddev: 0.5 };
    d.film.width = 16;
    d.film.height = 12;
    d.film.crop = Some(Crop { x: 3, y: 2, width: 9, height: 8 });
    d.camera.near = 0.1;
    verify(case("crop", d));
}
