//! Flat lamps looked for from places where rounding hurts: on them, in their plane, at their edges, and at all scales.
//!
//! Seeds are fixed, so a test that passes once passes always.

mod lights_registry;

use caustica_math::stats::Moments;
use caustica_math::{Vec3, Wavelengths};
use caustica_scene::Scene;
use caustica_scene::description::{Geometry, Mesh};
use caustica_scene::light::{LightPoint, Towards};
use caustica_testkit::build;
use lights_registry::random;

/// A lamp in z = 0 around `center` that emits upward: a square, a sheared quad, a triangle or a square with a fold.
fn lamp(kind: usize, center: [f32; 3], size: f32) -> Scene {
    let corners: &[[f32; 3]] = match kind {
        0 => &[[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0]],
        1 => &[[-0.9, -0.5, 0.0], [0.1, -0.5, 0.0], [0.9, 0.5, 0.0], [-0.1, 0.5, 0.0]],
        2 => &[[-0.5, -0.5, 0.0], [0.9, -0.5, 0.0], [0.1, 0.5, 0.0]],
        _ => &[[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.001], [-0.5, 0.5, 0.0]],
    };
    let at = |c: &[f32; 3]| Vec3::from(*c) * size + Vec3::from(center);
    let triangles = if corners.len() == 3 { vec![[0, 1, 2]] } else { vec![[0, 1, 2], [0, 2, 3]] };
    let mesh = Mesh { positions: corners.iter().map(at).collect(), triangles, ..Mesh::default() };
    let mut d = build::scene(8);
    let m = build::diffuse(&mut d, 0.0);
    let s = build::add(&mut d, "lamp", Geometry::Mesh(mesh), m);
    build::emit(&mut d, s, 1.0);
    Scene::new(d).unwrap().0
}

const CENTERS: [[f32; 3]; 3] = [[0.0; 3], [0.3, -0.2, 0.1], [900.0, -500.0, 300.0]];
const KINDS: usize = 4;

/// Whatever the place, a density is finite and what is told with a sample is what is told when asked.
#[test]
fn densities_are_finite_from_everywhere() {
    let mut s = random(20);
    let heights = [0.0, 1e-30, -1e-30, 1e-9, -1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 0.1, 1.0, 1e3, 1e9];
    for kind in 0..KINDS {
        for (center, size) in CENTERS.iter().flat_map(|c| [1e-5, 1.0, 1e6, 1e9].map(|size| (*c, size))) {
            if size < 1.0 && center != [0.0; 3] {
                // Nothing is left of it.
                continue;
            }
            let scene = lamp(kind, center, size);
            let query = scene.lights(Wavelengths::Rgb);
            for i in 0..4000 {
                let x =
                    s.next_2d().map(|x| [x - 0.5, 3.0 * x - 1.5, 2e4 * x - 1e4, 0.5, x.round() - 0.5][i % 5]);
                let height = heights[i / 5 % heights.len()];
                let from = Vec3::new(x[0], x[1], height) * size + Vec3::from(center);
                let told = |t: &Towards| query.towards_pdf(from, &t.point).0;
                if let Some(t) = query.sample_towards(from, s.next_2d(), s.next_2d()) {
                    let name = format!("lamp {kind}, {size} at {center:?}, from {from:?}: {t:?}");
                    assert!(t.pdf.0.is_finite() && t.pdf.0 > 0.0, "{name}");
                    assert!((told(&t) - t.pdf.0).abs() <= 1e-5 * t.pdf.0, "{name}");
                    assert!(t.point.at.is_finite() && t.direction.is_finite(), "{name}");
                }
                let e = query.sample_emission(s.next_2d(), s.next_2d(), s.next_2d()).expect("light").point;
                let found = query.towards_pdf(from, &e).0;
                assert!(found.is_finite() && found >= 0.0, "lamp {kind}, {size}, from {from:?}: {found}");
            }
        }
    }
}

/// ∫ cos/d² over the lamp is the same by area (emission) and as it is looked for. Significance 0.01 for all
/// (Šidák: 4.0 σ).
#[test]
fn both_ways_find_the_same_solid_angle() {
    let places = [
        [0.1, 0.2, 0.3],
        [0.1, 0.2, 0.02],
        [0.499, 0.0, 0.01],
        [-1.2, 0.4, 0.05],
        [0.7, 0.7, 0.9],
        [3.0, 0.0, 4.0],
    ];
    for kind in 0..KINDS {
        for (center, place) in CENTERS.iter().flat_map(|c| places.map(|place| (*c, place))) {
            let scene = lamp(kind, center, 1.0);
            let (query, mut s) = (scene.lights(Wavelengths::Rgb), random(21));
            let from = Vec3::from(place) + Vec3::from(center);
            let falloff = |p: &LightPoint| {
                let d = p.at - from;
                f64::from(-d.dot(p.normal)).max(0.0) / f64::from(d.length()).powi(3)
            };
            let (mut found, mut emitted) = (Moments::default(), Moments::default());
            for _ in 0..40_000 {
                let t = query.sample_towards(from, s.next_2d(), s.next_2d());
                found.push(t.map_or(0.0, |t| falloff(&t.point) / f64::from(t.pdf.0)));
                let e = query.sample_emission(s.next_2d(), s.next_2d(), s.next_2d()).expect("light");
                emitted.push(falloff(&e.point) / f64::from(e.pdf.point.0));
            }
            let sigma = (found.variance_of_mean() + emitted.variance_of_mean()).sqrt();
            let (a, b) = (found.mean, emitted.mean);
            // A thousandth for the rounding of positions far from the origin.
            let close = (a - b).abs() < 4.0 * sigma + 1e-3 * b;
            assert!(close, "lamp {kind} at {center:?} from {place:?}: {a} and {b} ± {sigma}");
            // Far from the origin, low places count as too low to tell.
            let ratio = found.variance_of_mean() / emitted.variance_of_mean();
            assert!(
                ratio < 1.2 || center[0] > 1.0,
                "lamp {kind} at {center:?} from {place:?}: the variance is {ratio} times that by area"
            );
        }
    }
}
