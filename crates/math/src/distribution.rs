//! Discrete and piecewise-constant distributions over tables.

use crate::{Mass, ONE_BELOW};

/// A distribution over the integers 0..n in proportion to given weights, by inversion of the
/// cumulative sums, which keeps stratified inputs stratified.
#[derive(Clone, Debug)]
pub struct Distribution1d {
    /// Cumulative probabilities: n + 1 entries from 0 to 1.
    cdf: Vec<f32>,
    total: f64,
}

/// What a discrete choice returned.
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    /// The chosen index.
    pub index: usize,
    /// Its probability.
    pub mass: Mass,
    /// A uniform number in [0, 1) made from what the choice left of its input.
    pub remapped: f32,
}

impl Distribution1d {
    /// From non-negative, finite weights. `None` if there are none or all are zero.
    pub fn new(weights: &[f32]) -> Option<Self> {
        let total: f64 = weights.iter().map(|w| f64::from(*w)).sum();
        if total <= 0.0 || !total.is_finite() {
            return None;
        }
        let mut sum = 0.0;
        let mut cdf = Vec::with_capacity(weights.len() + 1);
        cdf.push(0.0);
        for w in weights {
            debug_assert!(*w >= 0.0);
            sum += f64::from(*w);
            cdf.push((sum / total) as f32);
        }
        // The last entry with a weight must reach one exactly, and the empty ones after it too.
        let last = weights.iter().rposition(|w| *w > 0.0)?;
        cdf[last + 1..].fill(1.0);
        Some(Self { cdf, total })
    }

    /// How many values there are.
    pub fn len(&self) -> usize {
        self.cdf.len() - 1
    }

    /// Whether there are none (never so: [`Distribution1d::new`] refuses).
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The sum of the weights that it was made from.
    pub fn total(&self) -> f64 {
        self.total
    }

    /// The probability of `index`.
    #[inline]
    pub fn mass(&self, index: usize) -> Mass {
        Mass(self.cdf[index + 1] - self.cdf[index])
    }

    /// Chooses an index by `u` in [0, 1); never one of mass zero.
    #[inline]
    pub fn sample(&self, u: f32) -> Choice {
        let index = self.cdf[1..].partition_point(|c| *c <= u).min(self.len() - 1);
        let (low, mass) = (self.cdf[index], self.cdf[index + 1] - self.cdf[index]);
        Choice { index, mass: Mass(mass), remapped: ((u - low) / mass).clamp(0.0, ONE_BELOW) }
    }
}

/// A piecewise-constant density over the unit square, in cells of a width × height table.
#[derive(Clone, Debug)]
pub struct Distribution2d {
    rows: Vec<Option<Distribution1d>>,
    marginal: Distribution1d,
    width: usize,
}

impl Distribution2d {
    /// From `width`·`height` non-negative weights, row by row. `None` if all are zero.
    pub fn new(weights: &[f32], width: usize) -> Option<Self> {
        let rows: Vec<_> = weights.chunks_exact(width).map(Distribution1d::new).collect();
        let sums: Vec<f32> = rows.iter().map(|r| r.as_ref().map_or(0.0, |r| r.total() as f32)).collect();
        Some(Self { marginal: Distribution1d::new(&sums)?, rows, width })
    }

    /// A point of the unit square and its density there (per unit of the square's area).
    pub fn sample(&self, u: [f32; 2]) -> ([f32; 2], f32) {
        let row = self.marginal.sample(u[1]);
        // A row of no weight is never chosen.
        let Some(distribution) = &self.rows[row.index] else { return (u, 0.0) };
        let column = distribution.sample(u[0]);
        let (w, h) = (self.width as f32, self.rows.len() as f32);
        let point = [(column.index as f32 + column.remapped) / w, (row.index as f32 + row.remapped) / h];
        (point.map(|c| c.min(ONE_BELOW)), column.mass.0 * row.mass.0 * w * h)
    }

    /// The density at a point of the unit square (per unit of the square's area).
    pub fn pdf(&self, p: [f32; 2]) -> f32 {
        let (w, h) = (self.width, self.rows.len());
        let column = ((p[0] * w as f32) as usize).min(w - 1);
        let row = ((p[1] * h as f32) as usize).min(h - 1);
        self.rows[row].as_ref().map_or(0.0, |r| r.mass(column).0 * self.marginal.mass(row).0 * (w * h) as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn empty_and_black_tables_are_refused() {
        assert!(Distribution1d::new(&[]).is_none());
        assert!(Distribution1d::new(&[0.0, 0.0]).is_none());
        assert!(Distribution2d::new(&[0.0; 6], 3).is_none());
    }

    proptest! {
        #[test]
        fn zero_weights_are_never_chosen(u in 0.0f32..1.0) {
            let d = Distribution1d::new(&[0.0, 2.0, 0.0, 1.0, 0.0]).unwrap();
            let c = d.sample(u.min(ONE_BELOW));
            prop_assert!(c.index == 1 || c.index == 3);
            prop_assert!((d.mass(c.index).0 - c.mass.0).abs() < 1e-6);
            prop_assert!(c.remapped < 1.0);
        }

        #[test]
        fn sampled_density_is_the_evaluated_one(u in 0.0f32..1.0, v in 0.0f32..1.0) {
            let d = Distribution2d::new(&[1.0, 2.0, 0.0, 0.0, 4.0, 1.0], 3).unwrap();
            let (p, pdf) = d.sample([u.min(ONE_BELOW), v.min(ONE_BELOW)]);
            prop_assert!((d.pdf(p) - pdf).abs() < 1e-4);
        }
    }

    #[test]
    fn density_integrates_to_one() {
        let d = Distribution2d::new(&[1.0, 2.0, 0.0, 0.0, 4.0, 1.0], 3).unwrap();
        let mut sum = 0.0;
        for i in 0..30 {
            for j in 0..20 {
                sum += d.pdf([(i as f32 + 0.5) / 30.0, (j as f32 + 0.5) / 20.0]);
            }
        }
        assert!((sum / 600.0 - 1.0).abs() < 1e-5);
    }
}
