//! Every lamp's samples are distributed as its densities tell: points, directions, and directions towards it.
//!
//! Together the tests of each function have the significance level 0.01 (Šidák); seeds are fixed, so a test
//! that passes once passes always.

mod lights_registry;

use caustica_math::stats::{chi_square_test, sidak};
use caustica_math::{Frame, Vec3};
use caustica_scene::light::{Anchor, LightPoint};
use caustica_testkit::chi_square::{ChiSquareConfig, chi_square_sphere};
use lights_registry::{Example, View, examples, random};

const SIGNIFICANCE: f64 = 0.01;

/// Fewer samples than usual: the maps' discontinuities make the integrals dear.
fn config() -> ChiSquareConfig {
    ChiSquareConfig { samples: 20_000, pilot: 4_000, rows: 6, columns: 8, ..ChiSquareConfig::default() }
}

/// Collects p-values and judges them together.
struct Verdict(Vec<(String, f64)>);

impl Verdict {
    fn add(&mut self, name: String, p: Result<f64, String>) {
        self.0.push((name, p.unwrap_or_else(|e| panic!("{e}"))));
    }

    fn judge(self) {
        let alpha = sidak(SIGNIFICANCE, self.0.len());
        for (name, p) in self.0 {
            assert!(p > alpha, "{name}: p = {p:e}");
        }
    }
}

/// Directions of emission, in the frame of the normal if there is one.
fn emitted_directions(e: &Example) -> Result<f64, String> {
    let query = e.query();
    let frame =
        |p: &LightPoint| if p.anchor == Anchor::Surface { Frame::from_normal(p.normal) } else { UPRIGHT };
    let mut s = random(10);
    let any = (0..100_000).find_map(|_| query.sample_emission(s.next_2d(), s.next_2d(), s.next_2d()));
    let any = any.expect("some emission").point;
    let mut sample = |u: [f32; 3]| {
        let x = query.sample_emission([u[2], s.next_1d()], s.next_2d(), [u[0], u[1]])?;
        Some(frame(&x.point).to_local(x.direction))
    };
    let pdf = |v: Vec3| {
        let d = frame(&any).to_world(v);
        // What carries nothing is not returned.
        if query.radiance(&any, d).is_black() {
            0.0
        } else {
            f64::from(query.emission_pdf(&any, d).direction.0)
        }
    };
    chi_square_sphere(e.name, &mut sample, &pdf, config())
}

const UPRIGHT: Frame = Frame { x: Vec3::X, y: Vec3::Y, z: Vec3::Z };

#[test]
fn directions_of_emission() {
    let mut verdict = Verdict(vec![]);
    for e in examples() {
        // Dark parts of textures are returned by no sample; the points' test knows that.
        let dirac = e.name.contains("normals");
        if e.anchor() != Anchor::Infinite && !e.name.contains("spark") && !dirac {
            verdict.add(e.name.into(), emitted_directions(&e));
        }
    }
    verdict.judge();
}

/// Lamps at infinity: rays start evenly on the disk before the scene.
#[test]
fn origins_at_infinity() {
    let mut verdict = Verdict(vec![]);
    for e in examples().into_iter().filter(|e| e.anchor() == Anchor::Infinite) {
        let (center, radius) = e.scene.bounding_sphere();
        let (mut s, mut cells, mut n) = (random(11), vec![0.0; 96], 0.0);
        for _ in 0..40_000 {
            let Some(x) = e.query().sample_emission(s.next_2d(), s.next_2d(), s.next_2d()) else { continue };
            let d = (x.origin - center) * (1.0 / radius);
            assert!((d.dot(x.direction) + 1.0).abs() < 1e-4, "{}: the disk is before the scene", e.name);
            let p = Frame::from_normal(x.direction).to_local(d);
            let ring = ((p.x * p.x + p.y * p.y) * 8.0) as usize;
            let turn = caustica_math::elementary::atan2(p.y, p.x) / std::f32::consts::TAU + 0.5;
            cells[ring.min(7) * 12 + ((turn * 12.0) as usize).min(11)] += 1.0;
            n += 1.0;
            let told = std::f32::consts::PI * radius * radius * x.pdf.direction.0;
            assert!((told - 1.0).abs() < 1e-5, "{}", e.name);
        }
        verdict.add(e.name.into(), Ok(chi_square_test(&cells, &vec![n / 96.0; 96], 5.0, n).p_value));
    }
    verdict.judge();
}

/// Points of emission: on spheres and at infinity as a distribution of directions, on meshes by counting in the
/// quarters of every triangle.
#[test]
fn points_of_emission() {
    let mut verdict = Verdict(vec![]);
    for e in examples() {
        let p = match e.anchor() {
            Anchor::Point => continue,
            Anchor::Infinite if e.name == "directional" || e.name.contains("turned") => continue,
            Anchor::Infinite => points_on_sphere(&e, |p| p.at, |v| LightPoint::infinite(0, v), 1.0),
            Anchor::Surface => match e.scene.surfaces().sphere(0) {
                Some(sphere) => {
                    let on = |v: Vec3| LightPoint::on_surface(0, &e.scene.surfaces().sphere_point(0, v));
                    points_on_sphere(&e, |p| p.normal, on, sphere.radius)
                }
                None if e.name.contains("spark") => continue,
                None => Ok(points_on_mesh(&e)),
            },
        };
        verdict.add(e.name.into(), p);
    }
    verdict.judge();
}

fn points_on_sphere(
    e: &Example,
    direction: impl Fn(&LightPoint) -> Vec3,
    point: impl Fn(Vec3) -> LightPoint,
    radius: f32,
) -> Result<f64, String> {
    let (query, mut s) = (e.query(), random(12));
    let mut sample = |u: [f32; 3]| {
        let x = query.sample_emission([u[2], s.next_1d()], [u[0], u[1]], s.next_2d())?;
        Some(direction(&x.point))
    };
    let pdf = |v: Vec3| {
        let p = point(v);
        let outward = if p.anchor == Anchor::Surface { v } else { -v };
        let density = query.emission_pdf(&p, outward).point.0 * radius * radius;
        if query.radiance(&p, outward).is_black() { 0.0 } else { f64::from(density) }
    };
    chi_square_sphere(e.name, &mut sample, &pdf, config())
}

fn points_on_mesh(e: &Example) -> f64 {
    let (query, surfaces, mut s) = (e.query(), e.scene.surfaces(), random(13));
    let n = 60_000.0;
    let mut observed = vec![0.0; surfaces.triangles().len() * 4];
    for _ in 0..n as u32 {
        let x = query.sample_emission(s.next_2d(), s.next_2d(), s.next_2d()).expect("no part is dark");
        let [a, b, c] = surfaces.corners(x.point.primitive);
        let part = |p: Vec3, q: Vec3| (p - x.point.at).cross(q - x.point.at).length();
        let whole = (b - a).cross(c - a).length();
        // Which quarter: that of a corner if its coordinate is above a half.
        let coordinates = [part(b, c), part(c, a), part(a, b)];
        let quarter = coordinates.iter().position(|p| *p > 0.5 * whole).unwrap_or(3);
        observed[x.point.primitive as usize * 4 + quarter] += 1.0;
    }
    let expected = |i: usize| {
        let triangle = i as u32 / 4;
        let [a, b, c] = surfaces.corners(triangle);
        let middle = LightPoint::on_surface(0, &surfaces.triangle_point(triangle, 0.3, 0.3));
        let density = f64::from(query.emission_pdf(&middle, middle.normal).point.0);
        n * density * f64::from((b - a).cross(c - a).length()) * 0.5 / 4.0
    };
    let expected: Vec<f64> = (0..observed.len()).map(expected).collect();
    assert!((expected.iter().sum::<f64>() / n - 1.0).abs() < 1e-4, "{}", e.name);
    chi_square_test(&observed, &expected, 5.0, n).p_value
}

/// Directions in which a lamp is looked for; and what is told with each sample is what is told when asked.
#[test]
fn directions_towards_lamps() {
    let mut verdict = Verdict(vec![]);
    for e in examples() {
        for v in &e.views {
            check_told(&e, v);
            let delta = e.scene.lamps().get(0).is_delta();
            // One map and one view of it are enough: they are the dearest.
            let repeated = e.name == "environment map"
                || e.name.ends_with("poles") && v.normal.z == 0.0
                || (e.anchor() == Anchor::Infinite && v.normal.z == 0.0);
            if !delta && !repeated {
                verdict.add(format!("{} from {:?}", e.name, v.from), towards(&e, v));
            }
        }
    }
    verdict.judge();
}

fn check_told(e: &Example, v: &View) {
    let (query, mut s) = (e.query(), random(14));
    for _ in 0..2000 {
        let Some(t) = query.sample_towards(v.from, s.next_2d(), s.next_2d()) else { continue };
        let told = query.towards_pdf(v.from, &t.point);
        assert!((told.0 - t.pdf.0).abs() <= 1e-4 * t.pdf.0, "{} from {:?}: {told:?} {t:?}", e.name, v.from);
        assert_eq!(t.radiance, query.radiance(&t.point, -t.direction), "{}", e.name);
        let (direction, distance) = t.point.direction_from(v.from);
        assert!(direction == t.direction && distance == t.distance, "{}", e.name);
        assert_eq!(distance.is_infinite(), e.scene.lamps().get(0).is_infinite(), "{}", e.name);
    }
}

fn towards(e: &Example, v: &View) -> Result<f64, String> {
    let query = e.query();
    let mut t = random(19);
    let mut sample =
        |u: [f32; 3]| Some(query.sample_towards(v.from, [u[2], t.next_1d()], [u[0], u[1]])?.direction);
    let pdf = |d: Vec3| {
        let Some(p) = e.seen(v.from, d) else { return 0.0 };
        if query.radiance(&p, -d).is_black() {
            return 0.0;
        }
        let density = f64::from(query.towards_pdf(v.from, &p).0);
        if p.anchor == Anchor::Infinite {
            return density;
        }
        let distance = f64::from(p.direction_from(v.from).1);
        density * distance * distance / f64::from(p.cos(d))
    };
    chi_square_sphere(&format!("{} from {:?}", e.name, v.from), &mut sample, &pdf, config())
}

/// Wherever a map has radiance, its directions can be found.
#[test]
fn no_radiance_without_density() {
    for e in examples().iter().filter(|e| e.anchor() == Anchor::Infinite && e.name != "directional") {
        let mut s = random(15);
        for i in 0..200_000 {
            let [a, b] = s.next_2d();
            // Half of them within a thousandth of a pole.
            let near_pole = if i % 2 == 0 { 1e-6 * a } else { a };
            let d = caustica_math::warp::uniform_sphere([near_pole, b]);
            let d = [d, -d, Vec3::new(d.x, d.z, d.y), Vec3::new(d.x, -d.z, d.y)][i % 4];
            let p = LightPoint::infinite(0, d);
            let radiance = e.query().radiance(&p, -d);
            let pdf = e.query().towards_pdf(Vec3::ZERO, &p);
            assert!(pdf.0.is_finite() && (radiance.is_black() || pdf.0 > 0.0), "{}: {d:?} {pdf:?}", e.name);
        }
    }
}
