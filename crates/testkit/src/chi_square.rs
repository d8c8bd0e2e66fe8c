//! Does a sampler of directions follow its density? Pearson's χ² test over cells of the sphere.
//!
//! As in Nori's `chi2test` the cells are rectangles in cos θ and φ around +z. Nori's are equal in size,
//! so a narrow lobe falls into one of them and any density passes; here a pilot run places the edges so
//! that each cell gets about the same share of the samples, however narrow the lobe. The samples that are
//! counted are drawn afterwards and are independent of the edges.

use std::f64::consts::PI;

use caustica_math::chi_square::{Cell, Integrand, spherical};
use caustica_math::stats::chi_square_test;
use caustica_math::{SampleStream, StreamId, Vec3};

use crate::seed::seed;

/// How thorough a test is.
#[derive(Clone, Copy, Debug)]
pub struct ChiSquareConfig {
    /// How many samples are counted.
    pub samples: u32,
    /// How many samples the pilot run draws to place the cells.
    pub pilot: u32,
    /// Rows of cells in cos θ; one edge more is put at the horizon.
    pub rows: usize,
    /// Cells in φ in each row.
    pub columns: usize,
    /// Cells that expect fewer samples are pooled.
    pub minimum: f64,
    /// How far above one the integral of the density may lie.
    pub tolerance: f64,
    /// Seed of the sample stream.
    pub seed: u64,
}

impl Default for ChiSquareConfig {
    fn default() -> Self {
        Self { samples: 60_000, pilot: 6_000, rows: 8, columns: 12, minimum: 5.0, tolerance: 1e-3, seed: 1 }
    }
}

/// The cells of the sphere: rows of columns.
struct Grid {
    cos_edges: Vec<f64>,
    /// For each row, the edges in φ.
    phi_edges: Vec<Vec<f64>>,
}

/// Tests directions drawn by `sample` against the density `pdf` (sr⁻¹) that they should have, and gives
/// the p-value.
///
/// `None` from `sample` counts as a sample of its own kind, which must be as frequent as the density's
/// integral falls short of one.
///
/// # Errors
/// If the density is not finite, is negative or integrates to more than one, or if samples appear where
/// it is zero: a message that starts with `name`.
pub fn chi_square_sphere(
    name: &str,
    sample: &mut dyn FnMut([f32; 3]) -> Option<Vec3>,
    pdf: &dyn Fn(Vec3) -> f64,
    config: ChiSquareConfig,
) -> Result<f64, String> {
    let mut draw = |phase, i| {
        let mut s = SampleStream::new(StreamId { seed: seed(config.seed), pixel: phase, sample: i, walk: 0 });
        let [a, b] = s.next_2d();
        sample([a, b, s.next_1d()])
    };
    let mut pilot: Vec<_> = (0..config.pilot).filter_map(|i| draw(0, i).map(spherical)).collect();
    let grid = Grid::new(&mut pilot, config.rows, config.columns);

    let cells: Vec<Cell> = grid.cells().collect();
    let mut points = vec![vec![]; cells.len()];
    let (mut failed, mut impossible) = (0.0, 0.0);
    for i in 0..config.samples {
        let Some(direction) = draw(1, i) else {
            failed += 1.0;
            continue;
        };
        let point = spherical(direction);
        points[grid.index(point)].push(point);
        // A NaN must count as impossible too.
        if pdf(direction).partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
            impossible += 1.0;
        }
    }
    let n = f64::from(config.samples);
    if impossible > n * 1e-5 {
        return Err(format!("{name}: {impossible} of {n} samples lie where the density is zero"));
    }

    let integrand = Integrand { pdf, samples: n, tolerance: 1e-7 };
    let shares: Vec<f64> =
        cells.iter().zip(&mut points).map(|(cell, points)| integrand.over(*cell, points)).collect();
    let total: f64 = shares.iter().sum();
    if !total.is_finite() || shares.iter().any(|s| *s < 0.0) {
        return Err(format!("{name}: the density is negative or not finite somewhere"));
    }
    if total > 1.0 + config.tolerance {
        return Err(format!("{name}: the density integrates to {total:.4}"));
    }
    // The last entry is for the failed samples. A handful may fail by rounding, and quadrature may take the far
    // end of a tail for nothing: no expectation is zero.
    let mut observed: Vec<f64> = points.iter().map(|p| p.len() as f64).collect();
    observed.push(failed);
    let mut expected: Vec<f64> = shares.iter().map(|s| (s * n).max(n * 1e-6)).collect();
    expected.push(((1.0 - total) * n).max(n * 1e-5));
    Ok(chi_square_test(&observed, &expected, config.minimum, n).p_value)
}

/// The two ends, and between them the quantiles of the sorted values in `parts` parts, from just below the
/// least value to just above the greatest; equal ones only once. (Without these two a narrow lobe would lie
/// at the rim of a wide cell, where quadrature misses it.)
fn edges(sorted: &[f64], ends: [f64; 2], parts: usize) -> Vec<f64> {
    let mut edges = vec![ends[0], ends[1]];
    if let [first, .., last] = *sorted {
        let quantile = |i: usize| sorted[i * (sorted.len() - 1) / parts];
        edges.extend((1..parts).map(quantile));
        edges.push((2.0 * first - quantile(1)).max(ends[0]));
        edges.push((2.0 * last - quantile(parts - 1)).min(ends[1]));
    }
    edges.sort_by(f64::total_cmp);
    edges.dedup();
    edges
}

impl Grid {
    fn new(pilot: &mut [[f64; 2]], rows: usize, columns: usize) -> Self {
        pilot.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let cos: Vec<f64> = pilot.iter().map(|p| p[0]).collect();
        let mut cos_edges = edges(&cos, [-1.0, 1.0], rows);
        // Most densities jump at the horizon: an edge there keeps the integrands smooth.
        cos_edges.push(0.0);
        cos_edges.sort_by(f64::total_cmp);
        cos_edges.dedup();
        let phi_edges = cos_edges
            .windows(2)
            .map(|row| {
                let of_row = pilot.iter().filter(|p| p[0] >= row[0] && p[0] < row[1]);
                let mut phi: Vec<f64> = of_row.map(|p| p[1]).collect();
                phi.sort_by(f64::total_cmp);
                // Too few to place edges by: one cell is a better test than many that are pooled.
                let parts = columns.min(phi.len() / 10).max(1);
                edges(&phi, [-PI, PI], parts)
            })
            .collect();
        Self { cos_edges, phi_edges }
    }

    fn cells(&self) -> impl Iterator<Item = Cell> {
        self.cos_edges.windows(2).zip(&self.phi_edges).flat_map(|(cos, edges)| {
            edges.windows(2).map(|phi| Cell { cos: [cos[0], cos[1]], phi: [phi[0], phi[1]] })
        })
    }

    fn index(&self, [cos, phi]: [f64; 2]) -> usize {
        let find = |edges: &[f64], x: f64| edges[1..edges.len() - 1].partition_point(|e| *e <= x);
        let row = find(&self.cos_edges, cos);
        let before: usize = self.phi_edges[..row].iter().map(|e| e.len() - 1).sum();
        before + find(&self.phi_edges[row], phi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use caustica_math::warp;

    fn cosine_pdf(v: Vec3) -> f64 {
        f64::from(v.z.max(0.0)) / PI
    }

    fn cosine(u: [f32; 3]) -> Option<Vec3> {
        Some(warp::cosine_hemisphere([u[0], u[1]]))
    }

    #[test]
    fn right_samplers_pass() {
        let p = chi_square_sphere("cosine", &mut cosine, &cosine_pdf, ChiSquareConfig::default()).unwrap();
        assert!(p > 0.01, "{p}");
        // A lobe 2.6 degrees wide: a four-hundredth of one of Nori's cells.
        let narrow = 1e-3_f32;
        let mut cone = |u: [f32; 3]| Some(warp::uniform_cone([u[0], u[1]], narrow));
        let pdf = |v: Vec3| {
            if 1.0 - v.z <= narrow { f64::from(warp::uniform_cone_pdf(narrow).get()) } else { 0.0 }
        };
        let p = chi_square_sphere("cone", &mut cone, &pdf, ChiSquareConfig::default()).unwrap();
        assert!(p > 0.01, "{p}");
    }

    #[test]
    fn wrong_samplers_fail() {
        let config = ChiSquareConfig::default();
        let mut uniform = |u: [f32; 3]| {
            let v = warp::uniform_sphere([u[0], u[1]]);
            Some(Vec3::new(v.x, v.y, v.z.abs()))
        };
        assert!(chi_square_sphere("uniform", &mut uniform, &cosine_pdf, config).unwrap() < 1e-9);
        let mut turned = |u: [f32; 3]| cosine(u).map(|v| -v);
        let e = chi_square_sphere("turned", &mut turned, &cosine_pdf, config).unwrap_err();
        assert!(e.starts_with("turned: 60000 of"), "{e}");
        let e = chi_square_sphere("double", &mut cosine, &|v| 2.0 * cosine_pdf(v), config).unwrap_err();
        assert!(e.contains("integrates to 2.0"), "{e}");
        let e = chi_square_sphere("nan", &mut cosine, &|v| cosine_pdf(v) / 0.0 * 0.0, config).unwrap_err();
        assert!(e.contains("density"), "{e}");
    }

    /// A sampler that loses two in a hundred is caught although the others are distributed as they should
    /// be, and passes if its density knows.
    #[test]
    fn lost_samples_are_counted() {
        let mut leaky = |u: [f32; 3]| if u[2] < 0.02 { None } else { cosine(u) };
        let config = ChiSquareConfig::default();
        assert!(chi_square_sphere("leaky", &mut leaky, &cosine_pdf, config).unwrap() < 1e-9);
        let p = chi_square_sphere("leaky", &mut leaky, &|v| 0.98 * cosine_pdf(v), config).unwrap();
        assert!(p > 0.01, "{p}");
    }
}
