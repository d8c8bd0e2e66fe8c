//! Densities over the sphere of directions, integrated over cells: what Pearson's χ² test of a sampler of
//! directions expects (see [`stats::chi_square_test`](crate::stats::chi_square_test)).

use std::f64::consts::PI;

use crate::{Vec3, elementary};

/// A rectangle in cos θ and φ around +z, with φ in [−π, π].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// From and to which cos θ.
    pub cos: [f64; 2],
    /// From and to which φ.
    pub phi: [f64; 2],
}

/// cos θ and φ of a direction; φ is in [−π, π].
pub fn spherical(v: Vec3) -> [f64; 2] {
    let r2 = f64::from(v.x).powi(2) + f64::from(v.y).powi(2);
    // Near the poles x and y know the angle better than z does.
    let cos = if r2 < 0.5 { (1.0 - r2).sqrt().copysign(f64::from(v.z)) } else { f64::from(v.z) };
    [cos, f64::from(elementary::atan2(v.y, v.x)).clamp(-PI, PI)]
}

/// A density that is to be integrated over cells.
pub struct Integrand<'a, F: ?Sized> {
    /// The density, in sr⁻¹.
    pub pdf: &'a F,
    /// Of how many samples the points are that [`Integrand::over`] gets.
    pub samples: f64,
    /// The error that may remain in a part of a cell, as a share of all samples. Such errors add up.
    pub tolerance: f64,
}

/// Nodes and weights of Simpson's rule on [0, 1]. Nodes at the rims notice a lobe that starts there; they are
/// just inside, because densities may jump at the edges of cells (the horizon is one). The second-order
/// error of that displacement vanishes as cells are refined.
const SIMPSON: [(f64, f64); 3] = [(1e-4, 1.0 / 6.0), (0.5, 4.0 / 6.0), (1.0 - 1e-4, 1.0 / 6.0)];

impl<F: Fn(Vec3) -> f64 + ?Sized> Integrand<'_, F> {
    /// The integral over a cell, adaptively. `points` are the samples ([`spherical`]) that fell into it: they
    /// tell where a lobe hides that no node meets. Their order changes.
    pub fn over(&self, cell: Cell, points: &mut [[f64; 2]]) -> f64 {
        let [south, north] = cell.cos;
        if south < 0.0 && 0.0 < north {
            // Most densities jump at the horizon: an edge there keeps the integrands smooth.
            let (below, above) = partition(points, 0, 0.0);
            return self.over(Cell { cos: [south, 0.0], ..cell }, below)
                + self.over(Cell { cos: [0.0, north], ..cell }, above);
        }
        self.refine(cell, points, self.rule(cell), 14)
    }

    fn refine(&self, cell: Cell, points: &mut [[f64; 2]], whole: f64, depth: u32) -> f64 {
        let quarters = cell.quarters();
        let parts = quarters.map(|q| self.rule(q));
        let sum: f64 = parts.iter().sum();
        let steady = (sum - whole).abs() < self.tolerance;
        // A peak or an edge can hide between the nodes, but not from the points. This leads to no false
        // agreement: it is always the integral that is refined, and it has but one limit.
        let (expected, count) = (sum * self.samples, points.len() as f64);
        let plausible = (expected - count).abs() <= 3.0 * expected.sqrt() + 1.0;
        if depth == 0 || (steady && plausible) {
            // Richardson's extrapolation, for a rule of the fourth order.
            return sum + (sum - whole) / 15.0;
        }
        let [c, p] = cell.middle();
        let (south, north) = partition(points, 0, c);
        let (south_west, south_east) = partition(south, 1, p);
        let (north_west, north_east) = partition(north, 1, p);
        let points = [south_west, south_east, north_west, north_east];
        quarters
            .into_iter()
            .zip(points)
            .zip(parts)
            .map(|((quarter, points), part)| self.refine(quarter, points, part, depth - 1))
            .sum()
    }

    /// One tensor rule of 3 × 3 nodes.
    fn rule(&self, cell: Cell) -> f64 {
        let [width, height] = [cell.phi[1] - cell.phi[0], cell.cos[1] - cell.cos[0]];
        let mut sum = 0.0;
        for (x, weight_x) in SIMPSON {
            let (sin_phi, cos_phi) = sin_cos(cell.phi[0] + x * width);
            for (y, weight_y) in SIMPSON {
                let z = cell.cos[0] + y * height;
                let r = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
                let v = Vec3::new((r * cos_phi) as f32, (r * sin_phi) as f32, z as f32);
                sum += weight_x * weight_y * (self.pdf)(v);
            }
        }
        sum * width * height
    }
}

impl Cell {
    fn middle(self) -> [f64; 2] {
        [0.5 * (self.cos[0] + self.cos[1]), 0.5 * (self.phi[0] + self.phi[1])]
    }

    /// South-west, south-east, north-west, north-east: cos θ grows to the north, φ to the east.
    fn quarters(self) -> [Self; 4] {
        let [c, p] = self.middle();
        let cell = |cos, phi| Self { cos, phi };
        [
            cell([self.cos[0], c], [self.phi[0], p]),
            cell([self.cos[0], c], [p, self.phi[1]]),
            cell([c, self.cos[1]], [self.phi[0], p]),
            cell([c, self.cos[1]], [p, self.phi[1]]),
        ]
    }
}

/// The points whose coordinate is below `at`, and the others.
fn partition(points: &mut [[f64; 2]], axis: usize, at: f64) -> (&mut [[f64; 2]], &mut [[f64; 2]]) {
    let mut below = 0;
    for i in 0..points.len() {
        if points[i][axis] < at {
            points.swap(i, below);
            below += 1;
        }
    }
    points.split_at_mut(below)
}

fn sin_cos(phi: f64) -> (f64, f64) {
    let (s, c) = elementary::sin_cos(phi as f32);
    (f64::from(s), f64::from(c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warp;

    fn integrand<F: Fn(Vec3) -> f64>(pdf: &F, samples: f64) -> Integrand<'_, F> {
        Integrand { pdf, samples, tolerance: 1e-9 }
    }

    #[test]
    fn smooth_densities_are_integrated() {
        // ∫∫ cos θ/π over 0.2 < cos θ < 0.5 and a quarter of φ; the second cell reaches below the horizon.
        let cosine = |v: Vec3| f64::from(v.z.max(0.0)) / PI;
        let quarter = [0.0, 0.5 * PI];
        let share = integrand(&cosine, 0.0).over(Cell { cos: [0.2, 0.5], phi: quarter }, &mut []);
        assert!((share - 0.25 * (0.25 - 0.04)).abs() < 1e-7, "{share}");
        let jump = |v: Vec3| if v.z > 0.0 { 1.0 } else { 0.0 };
        let share = integrand(&jump, 0.0).over(Cell { cos: [-0.31, 0.5], phi: quarter }, &mut []);
        assert!((share - 0.25 * PI).abs() < 1e-7, "{share}");
    }

    #[test]
    fn points_lead_to_a_narrow_lobe() {
        let axis = [0.27, 1.03];
        let lobe = |v: Vec3| {
            let [c, p] = spherical(v);
            if (c - axis[0]).abs() < 0.001 && (p - axis[1]).abs() < 0.001 { 250_000.0 } else { 0.0 }
        };
        let cell = Cell { cos: [0.2, 0.4], phi: [0.9, 1.3] };
        let integrand = integrand(&lobe, 1000.0);
        assert_eq!(integrand.over(cell, &mut []), 0.0);
        let share = integrand.over(cell, &mut [axis; 1000]);
        assert!((share - 1.0).abs() < 0.01, "{share}");
    }

    #[test]
    fn directions_to_angles() {
        for z in [-0.9, -0.3, 0.0, 0.7, 0.999] {
            let sin = (1.0_f32 - z * z).sqrt();
            let [cos, phi] = spherical(Vec3::new(-0.6 * sin, -0.8 * sin, z));
            assert!((cos - f64::from(z)).abs() < 1e-6);
            assert!((phi - libm::atan2(-0.8, -0.6)).abs() < 1e-6);
        }
        let near_pole = warp::uniform_cone([0.5, 0.2], 1e-6);
        assert!((spherical(near_pole)[0] - (1.0 - 5e-7)).abs() < 1e-7);
    }
}
