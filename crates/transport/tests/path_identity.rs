//! The identity on which bidirectional path tracing rests: for one path, every strategy's estimate times its
//! density is the same measured contribution, and the weights of all strategies follow from the densities.
//!
//! [`caustica_testkit::oracle`] works both out for each path that a strategy finds, in many small scenes. This is
//! deterministic: a wrong jacobian, a forgotten adjoint or a mistaken density shows in a single path.

use std::collections::BTreeMap;

use caustica_math::{Filter, Rgb, Transform, Vec2};
use caustica_scene::description::{
    BumpRule, CameraKind, Crop, Domain, EnvironmentRows, Geometry, Image, ImageId, LightKind, MaterialId,
    MaterialKind, Roughness, Texture, TextureTransform,
};
use caustica_scene::{Description, Scene};
use caustica_testkit::agreement::flatten;
use caustica_testkit::build::{add, ellipsoid, emit, glass, light, look, point_light, quad, scene, sphere};
use caustica_testkit::materials::*;
use caustica_testkit::oracle::{judge, lanes};
use caustica_testkit::scenes::{dome, inside_out};
use caustica_testkit::seed::seed;
use caustica_transport::{Contribution, Heuristic, Kernel, Scratch, Settings, Sink, Strategy};

/// Edges of the longest paths.
const DEPTH: u32 = 6;
/// Relative error of an estimate, and absolute error of a weight.
const TOLERANCE: f64 = 1e-3;
/// Paths whose estimate may be off by more are not checked: they graze surfaces or have tiny edges.
const UNCERTAIN: f64 = TOLERANCE;

/// How often each strategy was found.
type Counts = BTreeMap<Strategy, u32>;

/// Judges every contribution.
struct Judge<'a> {
    scene: &'a Scene,
    settings: Settings,
    /// How many rays are aimed, with these settings.
    aimed_rays: u32,
    /// How many light paths pixels share.
    shared: u32,
    checked: Counts,
    skipped: u32,
    wrong: Vec<String>,
}

impl Judge<'_> {
    fn check(&mut self, c: &Contribution<'_>) -> Result<bool, String> {
        if !self.settings.strategies.contains(c.strategy) {
            return Err("not in the set".into());
        }
        if !(c.unweighted.is_valid() && (0.0..=1.0 + 1e-4).contains(&c.weight)) {
            return Err(format!("estimate {:?}, weight {}", c.unweighted, c.weight));
        }
        let judgement = judge(self.scene, c, self.shared)?;
        if judgement.uncertainty > UNCERTAIN {
            return Ok(false);
        }
        let (estimate, mut expected) = (lanes(c.unweighted), judgement.estimate(c.strategy));
        if c.strategy.s == 0 {
            let share = judgement.walk_share(self.aimed_rays, &self.settings.strategies);
            expected = expected.map(|f| f * share);
        }
        let largest = expected.iter().fold(0.0_f64, |a, b| a.max(*b));
        let close = |lane: usize| (estimate[lane] - expected[lane]).abs() <= TOLERANCE * largest;
        if !(0..3).all(close) {
            let ratio = [0, 1, 2].map(|lane| estimate[lane] / expected[lane]);
            return Err(format!("estimate {estimate:?} is {ratio:?} of what it should be; {judgement:?}"));
        }
        let weight = judgement.weight(c.strategy, &self.settings.strategies, self.settings.heuristic);
        let close = (f64::from(c.weight) - weight).abs() <= TOLERANCE;
        if !close {
            return Err(format!("weight {} should be {weight}; {judgement:?}", c.weight));
        }
        Ok(true)
    }
}

impl Sink for Judge<'_> {
    const PROBES: bool = true;

    fn eye(&mut self, _: Rgb) {}
    fn splat(&mut self, _: Vec2, _: Rgb) {}
    fn contribution(&mut self, c: &Contribution<'_>) {
        match self.check(c) {
            Ok(true) => *self.checked.entry(c.strategy).or_default() += 1,
            Ok(false) => self.skipped += 1,
            Err(m) => self.wrong.push(format!("{}: {m}", c.strategy)),
        }
    }
}

/// Without roulette.
fn settings(strategies: &str, heuristic: Heuristic, exhaustive_weights: bool) -> Settings {
    let strategies = strategies.parse().unwrap();
    let base =
        Settings { max_depth: Some(DEPTH), roulette_start: Some(1000), seed: seed(7), ..Settings::default() };
    Settings { strategies, heuristic, exhaustive_weights, ..base }
}

/// Renders about that many samples and judges all that is found; returns what was checked and skipped.
fn run(name: &str, scene: &Scene, settings: Settings, samples: u32) -> (Counts, u32) {
    let what = format!("{name}: {settings:?}");
    let kernel = Kernel::new(scene, settings.clone());
    let mut scratch = Scratch::default();
    // Weights that add up all strategies go without.
    let adds_up = settings.exhaustive_weights || settings.strategies.classes().is_none();
    let aimed_rays = if adds_up { 0 } else { settings.aimed_rays };
    let Crop { x, y, width, height } = scene.film.window();
    let pixels = width * height;
    let (shared, checked, skipped, wrong) = (kernel.shared_light_paths(), Counts::new(), 0, vec![]);
    let mut judge = Judge { scene, settings, aimed_rays, shared, checked, skipped, wrong };
    for i in 0..samples.next_multiple_of(pixels) {
        let pixel = [x + i % width, y + i % pixels / width];
        kernel.sample(pixel, i / pixels, &mut scratch, &mut judge);
    }
    let Judge { checked, skipped, wrong, .. } = judge;
    let right: u32 = checked.values().sum();
    let first = wrong.iter().take(8).cloned().collect::<Vec<_>>().join("\n");
    assert!(wrong.is_empty(), "{what}: {} wrong, {right} right:\n{first}", wrong.len());
    assert!(
        checked.keys().all(|s| s.s + s.t <= DEPTH + 1),
        "{what}: paths of more than {DEPTH} edges: {checked:?}"
    );
    (checked, skipped)
}

/// Sets of which some are and some are no unions of classes.
const SETS: [&str; 8] = ["all", "s=0", "s>=1", "t>=2", "s=0;s=1&t>=2", "t=1", "2,3", "s>=2&t>=2"];

fn verify(name: &str, description: Description) {
    verify_without(|_| false, name, description);
}

/// Checks a scene in which all strategies occur but those that are impossible.
fn verify_without(impossible: fn(Strategy) -> bool, name: &str, description: Description) {
    let scene = flatten(description);
    let (found, mut skipped) = run(name, &scene, settings("all", Heuristic::Balance, false), 4000);
    println!("{name}: {found:?}, {skipped} skipped");
    for s in (1..=DEPTH).flat_map(|k| (0..=k).map(move |s| Strategy { s, t: k + 1 - s })) {
        assert!(found.contains_key(&s) != impossible(s), "{name}: {s} occurs: {}", impossible(s));
    }
    let mut all: u32 = found.values().sum::<u32>() + skipped;
    let mut again = |settings: Settings| {
        let likely: u32 = found.iter().filter(|f| settings.strategies.contains(*f.0)).map(|f| f.1).sum();
        let (checked, left_out) = run(name, &scene, settings, 500);
        assert!(!checked.is_empty() || likely < 100, "{name}: nothing was found");
        all += checked.values().sum::<u32>() + left_out;
        skipped += left_out;
    };
    for heuristic in [Heuristic::Balance, Heuristic::Power] {
        again(settings("all", heuristic, true));
        SETS.iter().for_each(|set| again(settings(set, heuristic, false)));
    }
    // Of several light paths, more vertices lie next to an eye path's.
    assert!(skipped * 40 < all, "{name}: {skipped} of {all} were skipped");
}

/// Lamps without an extent cannot be hit, nor are they in the picture themselves.
fn hits(s: Strategy) -> bool {
    s.s == 0 || s == Strategy { s: 1, t: 1 }
}

fn coloured(d: &mut Description, rgb: [f32; 3]) -> MaterialId {
    d.add_material(MaterialKind::Diffuse { albedo: Rgb(rgb).into() })
}

const X: [f32; 3] = [2.0, 0.0, 0.0];
const Y: [f32; 3] = [0.0, 2.0, 0.0];
const Z: [f32; 3] = [0.0, 0.0, 2.0];

/// A floor with walls on two sides, seen from between them.
fn stage() -> Description {
    let mut d = scene(8);
    look(&mut d, [0.05, 0.1, -0.9], [0.0, -0.1, 0.2]);
    let m = coloured(&mut d, [0.8, 0.6, 0.4]);
    let red = coloured(&mut d, [0.7, 0.2, 0.1]);
    quad(&mut d, [-1.0; 3], Z, X, m);
    quad(&mut d, [-1.0; 3], Y, Z, red);
    quad(&mut d, [1.0, -1.0, -1.0], Z, Y, m);
    d
}

/// The stage with its other walls and a ceiling.
fn closed() -> Description {
    let mut d = stage();
    quad(&mut d, [-1.0; 3], X, Y, MaterialId(0));
    quad(&mut d, [-1.0, -1.0, 1.0], Y, X, MaterialId(0));
    quad(&mut d, [-1.0, 1.0, -1.0], X, Z, MaterialId(0));
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

/// With a coarse ellipsoid, whose shading normals lean far from the geometric ones.
fn egg(mut d: Description, material: MaterialKind) -> Description {
    let m = d.add_material(material);
    let egg = add(&mut d, "egg", Geometry::Mesh(ellipsoid(5, [0.5, 0.35, 0.4])), m);
    d.shapes[egg].to_world =
        Transform::rotate(20.0, [1.0, 0.5, 0.0]).then(Transform::translate([0.05, -0.3, 0.2]));
    d
}

fn dielectric(interior_ior: f32) -> MaterialKind {
    MaterialKind::dielectric(interior_ior, 1.0)
}

fn rough_dielectric(interior_ior: f32, exterior_ior: f32) -> MaterialKind {
    MaterialKind::rough_dielectric(Roughness::ggx(0.25), interior_ior, exterior_ior)
}

fn rough_gold(brushed: Roughness) -> MaterialKind {
    let MaterialKind::Conductor { eta, k, reflectance } = gold(0.0) else { unreachable!() };
    MaterialKind::RoughConductor { roughness: brushed, eta, k, reflectance }
}

/// Smooth if `alpha` is zero.
fn gold(alpha: f32) -> MaterialKind {
    let (eta, k) = (Rgb([0.14312, 0.37496, 1.4425]), Rgb([3.9832, 2.3857, 1.6032]));
    let reflectance = Rgb([0.9, 1.0, 0.8]).into();
    let smooth = MaterialKind::Conductor { eta, k, reflectance };
    let roughness = Roughness::ggx(alpha);
    if alpha > 0.0 { MaterialKind::RoughConductor { roughness, eta, k, reflectance } } else { smooth }
}

fn microfacet() -> MaterialKind {
    let kd = Rgb([0.3, 0.2, 0.4]).into();
    MaterialKind::Microfacet { alpha: 0.2, interior_ior: 1.5, exterior_ior: 1.0, kd }
}

#[test]
fn shared_light_paths() {
    let mut d = ball(dielectric(1.5));
    // Groups reach beyond the window.
    (d.film.width, d.film.height) = (11, 6);
    let scene = flatten(d);
    for shared_light_paths in [1, 2, 8, 16] {
        for heuristic in [Heuristic::Balance, Heuristic::Power] {
            for (set, exhaustive) in [("all", false), ("all", true), ("s=0;s=1&t>=2", false), ("2,3", false)]
            {
                let settings = Settings { shared_light_paths, ..settings(set, heuristic, exhaustive) };
                let (checked, _) = run("shared", &scene, settings, 800);
                assert!(!checked.is_empty());
            }
        }
    }
}

#[test]
fn diffuse_room() {
    verify("diffuse room", room());
}

#[test]
fn smooth_materials() {
    verify("glass", ball(dielectric(1.5)));
    verify("bubble", ball(dielectric(0.7)));
    verify("no interface", ball(dielectric(1.0)));
    verify("mirror", ball(MaterialKind::Mirror { reflectance: Rgb([0.9, 0.8, 0.7]) }));
    verify("gold", ball(gold(0.0)));
}

#[test]
fn rough_materials() {
    verify("rough glass", ball(rough_dielectric(1.5, 1.0)));
    verify("rough bubble", ball(rough_dielectric(1.0, 1.4)));
    verify("no rough interface", ball(rough_dielectric(1.3, 1.3)));
    verify("rough gold", ball(gold(0.2)));
    verify("sharp gold", ball(gold(0.06)));
    verify("brushed gold", ball(rough_gold(brushed([0.15, 0.4]))));
    let (reflectance, transmittance) = (Rgb([0.9, 0.5, 0.7]).into(), Rgb([0.4, 0.8, 1.0]).into());
    let (interior_ior, exterior_ior) = (1.5, 1.0);
    let tinted = MaterialKind::Dielectric { interior_ior, exterior_ior, reflectance, transmittance };
    verify("tinted glass", ball(tinted));
    let roughness = brushed([0.25, 0.5]);
    let tinted =
        MaterialKind::RoughDielectric { roughness, interior_ior, exterior_ior, reflectance, transmittance };
    verify("brushed tinted glass", ball(tinted));
    verify("microfacet", ball(microfacet()));
}

/// Glass eggs, tiles and metal balls in three instances.
#[test]
fn instances() {
    verify("instances", caustica_testkit::scenes::instanced());
}

#[test]
fn plastics() {
    verify("plastic", ball(smooth_plastic(false)));
    verify("nonlinear plastic egg", egg(room(), smooth_plastic(true)));
    verify("rough plastic", ball(rough_plastic()));
    verify("rough plastic egg", egg(room(), rough_plastic()));
    // A plastic floor, which most paths meet, below a sky.
    let mut d = lit(&[environment]);
    lamp(&mut d);
    d.materials[0].kind = smooth_plastic(false);
    verify("plastic room", d);
}

/// A Dirac lobe beside a smooth one, on both sides and under bumps.
#[test]
fn plastics_within_others() {
    let mut d = room();
    let (linear, nonlinear) = (d.add_material(smooth_plastic(false)), d.add_material(smooth_plastic(true)));
    let both = two_sided(&mut d, linear, nonlinear);
    quad(&mut d, [-0.5, -0.8, 0.0], [0.8, 0.1, 0.0], [0.0, 0.9, 0.3], both);
    verify("two-sided plastic", d);
    for rule in [BumpRule { flips: true, shadows: true }, BumpRule { flips: false, shadows: false }] {
        let bumpy = made(room(), |d| {
            let plastic = d.add_material(smooth_plastic(true));
            bump(d, 0.1, rule, plastic)
        });
        verify(&format!("bumps of plastic by {rule:?}"), bumpy);
    }
}

#[test]
fn principled_materials() {
    verify("principled", ball(principled()));
    verify("principled egg", egg(room(), principled()));
    verify("thin", ball(principled_thin()));
    verify("thin egg", egg(room(), principled_thin()));
}

#[test]
fn shading_normals() {
    verify("diffuse egg", egg(room(), MaterialKind::Diffuse { albedo: Rgb([0.9, 0.7, 0.5]).into() }));
    verify("glass egg", egg(room(), dielectric(1.5)));
    verify("mirror egg", egg(room(), MaterialKind::Mirror { reflectance: Rgb::WHITE }));
    verify("rough glass egg", egg(room(), rough_dielectric(1.5, 1.0)));
    verify("rough gold egg", egg(room(), gold(0.3)));
    verify("microfacet egg", egg(room(), microfacet()));
}

/// With an egg of a material that is made of others.
fn made(mut d: Description, make: impl Fn(&mut Description) -> MaterialId) -> Description {
    let m = make(&mut d);
    let egg = add(&mut d, "egg", Geometry::Mesh(ellipsoid(6, [0.5, 0.35, 0.4])), m);
    d.shapes[egg].to_world =
        Transform::rotate(20.0, [1.0, 0.5, 0.0]).then(Transform::translate([0.05, -0.3, 0.2]));
    d
}

#[test]
fn labels() {
    verify("mask", made(room(), leaves));
    verify("blend", made(room(), frosted));
    verify("nothing", made(room(), |d| d.add_material(MaterialKind::Null)));
    verify("thin glass", made(room(), |d| d.add_material(thin_glass())));
    // Seen from behind, a lamp too.
    let mut d = room();
    let (white, gold) = (coloured(&mut d, [0.8, 0.7, 0.6]), d.add_material(gold(0.3)));
    let both = two_sided(&mut d, gold, white);
    let screen = quad(&mut d, [-0.5, -0.8, 0.0], [0.8, 0.1, 0.0], [0.0, 0.9, 0.3], both);
    verify("two-sided", d.clone());
    emit(&mut d, screen, 2.0);
    verify("two-sided lamp", d);
}

#[test]
fn normals_of_their_own() {
    let plain = BumpRule { flips: false, shadows: false };
    let usual = BumpRule::default();
    for (what, rule) in [("plain", plain), ("usual", usual)] {
        let with = |kind: MaterialKind, scale: f32| {
            made(room(), |d| {
                let inner = d.add_material(kind);
                bump(d, scale, rule, inner)
            })
        };
        let clay = MaterialKind::Diffuse { albedo: Rgb([0.9, 0.7, 0.5]).into() };
        verify(&format!("{what} bumps of clay"), with(clay, 0.2));
        verify(&format!("{what} bumps of gold"), with(gold(0.3), 0.1));
        verify(&format!("{what} bumps of rough glass"), with(rough_dielectric(1.5, 1.0), 0.1));
        verify(
            &format!("{what} bumps of a mirror"),
            with(MaterialKind::Mirror { reflectance: Rgb::WHITE }, 0.1),
        );
        verify(&format!("{what} bumps of glass"), with(dielectric(1.5), 0.1));
    }
    let mapped = |d: &mut Description| {
        let (front, back) = (d.add_material(microfacet()), coloured(d, [0.5, 0.6, 0.7]));
        let front = normal_map(d, 0.8, BumpRule::default(), front);
        let both = two_sided(d, front, back);
        bump(d, 0.1, BumpRule::default(), both)
    };
    verify("a normal map on one side", made(room(), mapped));
}

/// An image without symmetries.
fn image(d: &mut Description, width: u32, height: u32) -> ImageId {
    let pixel = |i: u32| Rgb([5, 7, 11].map(|k| 0.1 + (i * k % 17) as f32 / 8.0));
    d.add_image(Image { width, height, pixels: (0..width * height).map(pixel).collect() })
}

fn environment(d: &mut Description) {
    let image = image(d, 8, 4);
    let to_world = Transform::rotate(35.0, [1.0, 2.0, 0.5]);
    light(d, LightKind::Environment { image, to_world, scale: 0.7, rows: Default::default() });
}

fn sky(d: &mut Description) {
    light(d, LightKind::Constant { radiance: Rgb([0.5, 0.7, 1.0]) });
}

fn sun(d: &mut Description) {
    light(d, LightKind::Directional { direction: [0.3, -1.0, 0.5], irradiance: Rgb([2.0, 1.8, 1.5]) });
}

fn spot(d: &mut Description) {
    let (position, direction, intensity) = ([-0.3, 0.8, 0.3], [0.4, -1.0, 0.1], Rgb([3.0, 2.0, 1.0]));
    light(d, LightKind::Spot { position, direction, intensity, inner_angle: 5.0, outer_angle: 60.0 });
}

/// A stage with a rough egg and the given lamps.
fn lit(lamps: &[fn(&mut Description)]) -> Description {
    let mut d = egg(stage(), rough_dielectric(1.5, 1.0));
    for lamp in lamps {
        lamp(&mut d);
    }
    d
}

#[test]
fn lamps_at_infinity() {
    verify("sky", lit(&[sky]));
    verify("environment map", lit(&[environment]));
    let mut d = lit(&[environment]);
    if let LightKind::Environment { rows, .. } = &mut d.lights[0].kind {
        *rows = EnvironmentRows::OnPoles;
    }
    verify("rows on the poles", d);
    let mut d = lit(&[sky, environment]);
    lamp(&mut d);
    verify("two skies and a lamp", d);
    verify_without(hits, "sun", lit(&[sun]));
    let mut d = egg(stage(), dielectric(1.5));
    sun(&mut d);
    environment(&mut d);
    verify("glass egg in the sun", d);
    let disc = |d: &mut Description| caustica_testkit::scenes::sun(d, [0.15, 0.3, 1.0], 60.0);
    verify("a sun's disc", lit(&[disc]));
    let clear = |d: &mut Description| dome(d, [0.15, 0.3, 1.0]);
    verify("a clear sky", lit(&[clear]));
    let mut d = egg(stage(), dielectric(1.5));
    disc(&mut d);
    clear(&mut d);
    lamp(&mut d);
    verify("a glass egg in daylight", d);
}

#[test]
fn lamps_without_extent() {
    let mut d = egg(closed(), microfacet());
    point_light(&mut d, [0.2, 0.4, 0.3], 2.0);
    verify_without(hits, "point", d.clone());
    d.lights.clear();
    spot(&mut d);
    verify_without(hits, "spot", d);
}

#[test]
fn sphere_lamps() {
    let mut d = closed();
    let m = coloured(&mut d, [0.3, 0.5, 0.4]);
    let bulb = sphere(&mut d, [-0.3, 0.4, 0.3], 0.25, m);
    emit(&mut d, bulb, 3.0);
    verify("bulb", d);

    // Seen from inside of its glass, and by what is inside with the camera.
    let mut d = closed();
    let m = glass(&mut d);
    let bulb = sphere(&mut d, [0.0, 0.0, -0.1], 0.85, m);
    emit(&mut d, bulb, 1.0);
    sphere(&mut d, [0.2, 0.0, 0.15], 0.4, MaterialId(0));
    look(&mut d, [0.05, 0.0, -0.5], [0.1, 0.0, 0.3]);
    // What the camera sees is inside, or the glass.
    let outside = |s: Strategy| s.s + s.t < 4 || (s.s > 0 && s.t == 2) || (s.s < 4 && s.t == 1);
    verify_without(outside, "inside of a bulb", d);

    let mut d = scene(8);
    let m = coloured(&mut d, [0.5, 0.6, 0.7]);
    let shell = inside_out(&mut d, m);
    emit(&mut d, shell, 1.0);
    sphere(&mut d, [0.2, 0.0, 0.4], 0.3, m);
    verify("shell", d);
}

/// Colours of corners and of triangles, on surfaces and on a lamp.
#[test]
fn attributes_of_meshes() {
    for domain in [Domain::Vertex, Domain::Face] {
        let mut d = egg(closed(), microfacet());
        let egg = d.shapes.len() - 1;
        let kd = attribute(&mut d, egg, domain, motley);
        d.materials.last_mut().unwrap().kind =
            MaterialKind::Microfacet { alpha: 0.3, interior_ior: 1.5, exterior_ior: 1.0, kd };
        let lamp = lamp(&mut d);
        let emission = attribute(&mut d, lamp, domain, |i| motley(i) * 5.0);
        d.shapes[lamp].emission = Some(emission);
        verify(&format!("by {domain:?}"), d);
    }
}

#[test]
fn textured_and_many_lamps() {
    let mut d = closed();
    let shape = lamp(&mut d);
    let image = image(&mut d, 5, 3);
    let transform = TextureTransform { scale: [1.5, 2.0], offset: [0.2, 0.1], ..TextureTransform::default() };
    d.shapes[shape].emission = Some(Texture::Image { image, transform });
    verify("textured lamp", d.clone());
    let (value1, value2) = (Rgb([1.0, 2.0, 3.0]), Rgb([0.5, 0.1, 0.0]));
    d.shapes[shape].emission = Some(Texture::Checkerboard {
        delta: [0.1, 0.2],
        scale: [0.3, 0.4],
        shear: [0.1, 0.0],
        value1,
        value2,
    });
    verify("checkered lamp", d);

    let mut d = lit(&[sky, sun, spot]);
    lamp(&mut d);
    point_light(&mut d, [0.5, 0.1, -0.2], 0.4);
    let bulb = sphere(&mut d, [0.6, -0.6, -0.2], 0.2, MaterialId(1));
    emit(&mut d, bulb, 2.0);
    verify("many lamps", d);
}

/// Lamps that the hierarchy chooses from: a ball of triangles, and what stands around it.
#[test]
fn hierarchy_of_lamps() {
    let mut d = egg(closed(), rough_dielectric(1.5, 1.0));
    let m = coloured(&mut d, [0.3, 0.5, 0.4]);
    let ball = add(&mut d, "ball", Geometry::Mesh(ellipsoid(4, [0.25, 0.15, 0.2])), m);
    d.shapes[ball].to_world = Transform::translate([-0.4, 0.4, 0.3]);
    emit(&mut d, ball, 2.0);
    lamp(&mut d);
    verify("ball of lamps", d.clone());
    let bulb = sphere(&mut d, [0.6, -0.6, -0.2], 0.2, m);
    emit(&mut d, bulb, 2.0);
    (0..5).for_each(|i| point_light(&mut d, [0.15 * i as f32 - 0.3, 0.5, -0.2], 0.1));
    verify("lamps of all kinds", d.clone());
    sky(&mut d);
    // Open to the sky, with both sides of a pane of glass. (With more rough glass too much would be uncertain.)
    d.shapes.iter_mut().filter(|s| s.name == "egg").for_each(|egg| egg.material = m);
    d.shapes.remove(0);
    let pane = d.add_material(dielectric(1.4));
    quad(&mut d, [-0.5, -0.7, -0.3], [0.6, 0.0, 0.2], [0.0, 0.6, 0.1], pane);
    verify("lamps before and behind glass", d);
}

/// Points that throw pictures.
#[test]
fn pictures_that_are_thrown() {
    let to_world = Transform::look_at([-0.3, 0.8, 0.3], [0.1, -0.2, 0.4], [0.0, 0.3, 1.0]);
    let base = egg(closed(), microfacet());
    let mut d = base.clone();
    let picture = Texture::Image { image: image(&mut d, 5, 3), transform: TextureTransform::default() };
    let intensity = Rgb([3.0, 2.0, 1.0]);
    let (inner_angle, outer_angle) = (10.0, 60.0);
    let kind =
        LightKind::LinearSpot { to_world, intensity, picture: Some(picture), inner_angle, outer_angle };
    light(&mut d, kind);
    verify_without(hits, "spot behind a picture", d.clone());
    d.lights.clear();
    light(&mut d, LightKind::Projector { to_world, irradiance: picture, scale: 2.0, fov: 80.0, aspect: 1.6 });
    verify_without(hits, "projector", d);
}

/// Light along normals: no eye path finds its lamp.
#[test]
fn beams_along_normals() {
    let mut d = egg(closed(), rough_dielectric(1.5, 1.0));
    let m = coloured(&mut d, [0.3, 0.4, 0.5]);
    let lamp = quad(&mut d, [-0.4, 0.65, 0.1], [0.8, 0.1, 0.0], [0.0, -0.3, 0.6], m);
    light(&mut d, LightKind::Collimated { shape: lamp as u32, exitance: Rgb([3.0, 2.0, 1.0]).into() });
    verify_without(|s| s.s < 2, "beam", d.clone());
    lamp_beside(&mut d);
    verify("beam and lamps", d);
}

fn lamp_beside(d: &mut Description) {
    for i in 0..9 {
        let x = 0.15 * i as f32 - 0.6;
        let q = quad(d, [x, -0.9, 0.6], [0.0, 0.1, 0.0], [0.1, 0.0, 0.0], MaterialId(0));
        emit(d, q, 5.0);
    }
}

/// A room with a lamp, a mirror and a rough egg, whose camera is still to be chosen.
fn studio(kind: CameraKind) -> Description {
    let mut d = egg(room(), gold(0.3));
    let m = d.add_material(MaterialKind::Mirror { reflectance: Rgb::WHITE });
    sphere(&mut d, [-0.6, -0.6, 0.5], 0.3, m);
    d.camera.kind = kind;
    d
}

const THIN_LENS: CameraKind = CameraKind::ThinLens { fov: 70.0, aperture_radius: 0.08, focus_distance: 1.1 };

#[test]
fn cameras() {
    verify("lens", studio(THIN_LENS));
    verify("parallel", studio(CameraKind::Orthographic));
    verify("all around", studio(CameraKind::Environment));
    // The sky cannot be joined with it.
    let mut d = lit(&[environment]);
    d.camera.kind = CameraKind::Orthographic;
    d.camera.to_world = Transform::scale([1.2; 3]).then(d.camera.to_world);
    verify_without(|s| s == Strategy { s: 1, t: 1 }, "parallel under a sky", d.clone());
    d.camera.kind = CameraKind::Environment;
    verify("all around under a sky", d.clone());
    d.camera.kind = THIN_LENS;
    verify("lens under a sky", d);
}

/// A window in a wall of the room measures what falls on it; a meter without extent sees one point of the room.
#[test]
fn meters() {
    let mut d = studio(CameraKind::Orthographic);
    let window = quad(&mut d, [-0.3, -0.4, -0.95], [0.6, 0.0, 0.0], [0.0, 0.2, 0.0], MaterialId(0));
    d.camera.kind = CameraKind::IrradianceMeter { shape: window as u32 };
    d.film.filter = Filter::Box { radius: 0.5 };
    verify("irradiance", d.clone());
    (d.film.width, d.film.height) = (1, 1);
    verify("irradiance of one pixel", d);
    let mut d = lit(&[environment]);
    d.film.filter = Filter::Box { radius: 0.5 };
    d.camera.kind = CameraKind::RadianceMeter;
    // It sees the rough glass, and no lamp.
    let splat_or_seen = |s: Strategy| s.t == 1 || s == Strategy { s: 0, t: 2 };
    verify_without(splat_or_seen, "radiance", d);
}

/// Lamps that are not seen, whose light is.
#[test]
fn hidden_lamps() {
    let seen = |s: Strategy| s.s + s.t == 2;
    let mut d = studio(THIN_LENS);
    d.camera.hides_lamps = true;
    verify_without(seen, "hidden lamp", d);
    let mut d = lit(&[sky]);
    lamp(&mut d);
    d.camera.hides_lamps = true;
    verify_without(seen, "hidden sky", d);
}

#[test]
fn films() {
    let mut d = studio(THIN_LENS);
    d.film.filter = Filter::Gaussian { radius: 1.5, stddev: 0.5 };
    (d.film.width, d.film.height) = (16, 12);
    d.film.crop = Some(Crop { x: 3, y: 2, width: 9, height: 8 });
    d.camera.near = 0.1;
    verify("crop", d.clone());
    d.camera.principal_point = [0.3, 0.6];
    verify("shifted lens", d);
}
