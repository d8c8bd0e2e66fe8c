//! χ² of uniform points on triangles and rectangles as they are seen from somewhere. Significance 0.01 for all
//! together, Šidák-corrected; fixed seeds.

use caustica_math::spherical::{Relative, SphericalRectangle, SphericalTriangle};
use caustica_math::stats::{chi_square_test, sidak};
use caustica_math::{SampleStream, StreamId};
use caustica_testkit::seed::seed;

const SAMPLES: u32 = 200_000;
/// Cells along an edge.
const CELLS: usize = 12;

/// The signed solid angle of a triangle by the excess of its angles: not the formula of the code.
fn excess(corners: [Relative; 3]) -> f64 {
    let cross = |a: Relative, b: Relative| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let dot = |a: Relative, b: Relative| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let [n0, n1, n2] = [0, 1, 2].map(|i| cross(corners[i], corners[(i + 1) % 3]));
    let angle = |m: Relative, n: Relative| {
        let c = cross(m, n);
        std::f64::consts::PI - libm::atan2(dot(c, c).sqrt(), dot(m, n))
    };
    angle(n0, n1) + angle(n1, n2) + angle(n2, n0) - std::f64::consts::PI
}

fn mix(corners: [Relative; 3], [b, c]: [f64; 2]) -> Relative {
    [0, 1, 2].map(|i| corners[0][i] * (1.0 - b - c) + corners[1][i] * b + corners[2][i] * c)
}

/// p-value of samples in cells against the solid angles of the cells.
fn judge(index: usize, sample: impl Fn([f32; 2]) -> usize, shares: &[f64]) -> f64 {
    let mut stream = SampleStream::new(StreamId { seed: seed(6), pixel: index as u32, sample: 0, walk: 0 });
    let mut counts = vec![0.0; shares.len()];
    (0..SAMPLES).for_each(|_| counts[sample(stream.next_2d())] += 1.0);
    let total: f64 = shares.iter().sum();
    let n = f64::from(SAMPLES);
    let expected: Vec<f64> = shares.iter().map(|s| s / total * n).collect();
    chi_square_test(&counts, &expected, 5.0, n).p_value
}

fn cell(x: f32) -> usize {
    ((x * CELLS as f32) as usize).min(CELLS - 1)
}

#[test]
fn rectangles() {
    // Corner, size, height: from below the middle, from very close, from beside, grazing, over an edge, far away.
    let views = [
        ([-0.5, -0.5], [1.0, 1.0], 0.5),
        ([-0.3, -0.9], [1.0, 2.0], 0.01),
        ([1.5, 0.7], [2.0, 1.0], 0.8),
        ([0.1, -0.4], [1.0, 1.0], 0.002),
        ([0.0, -0.4], [1.0, 1.0], 0.05),
        ([0.0, 0.0], [3.0, 0.1], 0.2),
        ([40.0, -80.0], [1.0, 2.0], 100.0),
    ];
    let alpha = sidak(0.01, views.len());
    for (index, (corner, size, height)) in views.into_iter().enumerate() {
        let rectangle = SphericalRectangle::new(corner, size, height);
        let n = CELLS as f64;
        let at = |i: usize, j: usize| {
            [corner[0] + size[0] * i as f64 / n, corner[1] + size[1] * j as f64 / n, height]
        };
        let solid_angle = |k: usize| {
            let (i, j) = (k / CELLS, k % CELLS);
            excess([at(i, j), at(i + 1, j), at(i + 1, j + 1)])
                + excess([at(i, j), at(i + 1, j + 1), at(i, j + 1)])
        };
        let shares: Vec<f64> = (0..CELLS * CELLS).map(solid_angle).collect();
        let total: f64 = shares.iter().sum();
        let told = f64::from(rectangle.solid_angle());
        assert!((told / total - 1.0).abs() < 1e-4, "{corner:?}: {told} sr instead of {total}");
        let sample = |u| {
            let [x, y] = rectangle.sample(u);
            cell((x / size[0]) as f32) * CELLS + cell((y / size[1]) as f32)
        };
        let p = judge(index, sample, &shares);
        assert!(p > alpha, "{corner:?} {size:?} {height}: p = {p:.2e}, α = {alpha:.2e}");
    }
}

#[test]
fn triangles() {
    let views: [[Relative; 3]; 7] = [
        [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[-1.0, -0.7, 0.01], [1.0, -0.5, 0.01], [0.2, 1.0, 0.01]],
        [[-1.0, 0.0, 0.05], [1.0, 0.0, 0.05], [0.3, 2.0, 0.05]],
        [[3.0, 0.0, 0.1], [4.0, 0.5, 0.1], [3.0, 2.0, 0.1]],
        [[-5.0, 0.1, 0.5], [7.0, 0.1, 0.5], [7.0, 0.3, 0.5]],
        [[80.0, 0.0, 60.0], [80.4, 0.0, 60.0], [80.0, 0.7, 60.2]],
    ];
    let alpha = sidak(0.01, views.len());
    for (index, corners) in views.into_iter().enumerate() {
        let triangle = SphericalTriangle::new(corners);
        let n = CELLS as f64;
        let at = |i: usize, j: usize| mix(corners, [i as f64 / n, j as f64 / n]);
        // Each cell of the square of coordinates is cut by a diagonal; on the rim only one half is inside.
        let solid_angle = |k: usize| {
            let (i, j) = (k / 2 / CELLS, k / 2 % CELLS);
            match (k % 2, i + j + 1) {
                (0, s) if s <= CELLS => excess([at(i, j), at(i + 1, j), at(i, j + 1)]),
                (1, s) if s < CELLS => excess([at(i + 1, j + 1), at(i + 1, j), at(i, j + 1)]),
                _ => 0.0,
            }
        };
        let shares: Vec<f64> = (0..2 * CELLS * CELLS).map(solid_angle).collect();
        let total: f64 = shares.iter().sum();
        let told = f64::from(triangle.solid_angle());
        assert!((told / total - 1.0).abs() < 1e-4, "{corners:?}: {told} sr instead of {total}");
        let sample = |u| {
            let [b, c] = triangle.sample(u);
            let (i, j) = (cell(b), cell(c).min(CELLS - 1 - cell(b)));
            let upper = (b + c) * CELLS as f32 > (i + j + 1) as f32 && i + j + 1 < CELLS;
            2 * (i * CELLS + j) + usize::from(upper)
        };
        let p = judge(index, sample, &shares);
        assert!(p > alpha, "{corners:?}: p = {p:.2e}, α = {alpha:.2e}");
    }
}
