//! χ² of every warp against its density. Significance 0.01 for all together, Šidák-corrected; fixed seeds.

use std::f32::consts::TAU;

use caustica_math::elementary::atan2;
use caustica_math::stats::{chi_square_test, sidak};
use caustica_math::{SampleStream, StreamId, Vec3, warp};
use caustica_testkit::seed::seed;

const SAMPLES: u32 = 200_000;
const CELLS: usize = 16;

/// A warp, and the place of its samples in a unit square on which its density is uniform.
struct Warp {
    name: &'static str,
    place: fn([f32; 2]) -> [f32; 2],
}

/// Turns of a direction around +z, in [0, 1).
fn turns(v: Vec3) -> f32 {
    (atan2(v.y, v.x) / TAU + 1.0).fract()
}

/// All warps. Equal areas of the square are equal shares of the density: z is uniform on spheres and cones
/// (Archimedes), z² on the cosine-weighted hemisphere, r² on disks; in a triangle, a point's barycentric
/// coordinates (a, b) have (1 − a)² and b/(1 − a) uniform.
const WARPS: [Warp; 7] = [
    Warp {
        name: "concentric_disk",
        place: |u| {
            let p = warp::concentric_disk(u);
            [p.x * p.x + p.y * p.y, turns(Vec3::new(p.x, p.y, 0.0))]
        },
    },
    Warp {
        name: "cosine_hemisphere",
        place: |u| {
            let v = warp::cosine_hemisphere(u);
            [v.z * v.z, turns(v)]
        },
    },
    Warp {
        name: "uniform_sphere",
        place: |u| {
            let v = warp::uniform_sphere(u);
            [0.5 + 0.5 * v.z, turns(v)]
        },
    },
    Warp { name: "narrow uniform_cone", place: |u| cone(u, 0.01) },
    Warp { name: "wide uniform_cone", place: |u| cone(u, 1.7) },
    Warp {
        name: "uniform_triangle, first corner",
        place: |u| {
            let [a, b] = warp::uniform_triangle(u);
            [(1.0 - a) * (1.0 - a), b / (1.0 - a)]
        },
    },
    Warp {
        name: "uniform_triangle, second corner",
        place: |u| {
            let [a, b] = warp::uniform_triangle(u);
            [(1.0 - b) * (1.0 - b), a / (1.0 - b)]
        },
    },
];

fn cone(u: [f32; 2], one_minus_cos: f32) -> [f32; 2] {
    let v = warp::uniform_cone(u, one_minus_cos);
    // 1 − z of a narrow cone from the sine, which has not lost its digits.
    let sin2 = v.x * v.x + v.y * v.y;
    let h = if v.z > 0.0 { sin2 / (1.0 + v.z) } else { 1.0 - v.z };
    [h / one_minus_cos, turns(v)]
}

#[test]
fn every_warp_has_its_density() {
    let alpha = sidak(0.01, WARPS.len());
    for (index, w) in WARPS.iter().enumerate() {
        let id = StreamId { seed: seed(5), pixel: index as u32, sample: 0, walk: 0 };
        let mut stream = SampleStream::new(id);
        let mut counts = vec![0.0; CELLS * CELLS];
        for _ in 0..SAMPLES {
            let [x, y] = (w.place)(stream.next_2d()).map(|c| ((c * CELLS as f32) as usize).min(CELLS - 1));
            counts[x * CELLS + y] += 1.0;
        }
        let expected = vec![f64::from(SAMPLES) / counts.len() as f64; counts.len()];
        let p = chi_square_test(&counts, &expected, 5.0, f64::from(SAMPLES)).p_value;
        assert!(p > alpha, "{}: p = {p:.2e}, α = {alpha:.2e}", w.name);
    }
}

/// The densities that go with the warps integrate to one.
#[test]
fn densities_are_normalised() {
    let n = 200_000;
    let values = (0..n).map(|i| f64::from(warp::cosine_hemisphere_pdf((i as f32 + 0.5) / n as f32).0));
    let hemisphere = values.sum::<f64>() / f64::from(n) * std::f64::consts::TAU;
    assert!((hemisphere - 1.0).abs() < 1e-5);
    assert!((warp::UNIFORM_SPHERE_PDF.0 * 2.0 * TAU - 1.0).abs() < 1e-6);
    for h in [1e-4, 0.3, 2.0] {
        assert!((warp::uniform_cone_pdf(h).0 * TAU * h - 1.0).abs() < 1e-6);
    }
    assert_eq!(warp::cosine_hemisphere_pdf(-0.5).0, 0.0);
}
