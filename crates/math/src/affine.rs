//! Affine maps, for what is done for every ray.

use crate::Vec3;

/// x ↦ A·x + b. Worked out in `f64` and rounded once, so that what comes out is as good as what went in, even where
/// large parts of it cancel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine {
    /// Of A and, last, of b.
    rows: [[f64; 4]; 3],
}

impl Affine {
    /// From the rows of A, each with its part of b behind.
    pub(crate) fn from_rows(rows: [[f64; 4]; 3]) -> Self {
        Self { rows }
    }

    /// A point.
    #[inline]
    pub fn point(&self, p: Vec3) -> Vec3 {
        let [x, y, z] = p.to_array().map(f64::from);
        Vec3::from(self.rows.map(|[a, b, c, d]| (a * x + b * y + c * z + d) as f32))
    }

    /// A direction or difference of points: not moved by b, not normalised.
    #[inline]
    pub fn vector(&self, v: Vec3) -> Vec3 {
        let [x, y, z] = v.to_array().map(f64::from);
        Vec3::from(self.rows.map(|[a, b, c, _]| (a * x + b * y + c * z) as f32))
    }

    /// Aᵀ·n. A normal of the space that this leads to becomes one of the space that it comes from; not normalised.
    #[inline]
    pub fn normal_back(&self, n: Vec3) -> Vec3 {
        let [x, y, z] = n.to_array().map(f64::from);
        let [a, b, c] = &self.rows;
        Vec3::from([0, 1, 2].map(|i| (a[i] * x + b[i] * y + c[i] * z) as f32))
    }

    /// |A|·|p| + |b|, axis by axis: no step on the way to a point has larger numbers if p bounds its coordinates.
    pub fn magnitude(&self, p: Vec3) -> Vec3 {
        let [x, y, z] = p.to_array().map(|c| f64::from(c).abs());
        Vec3::from(self.rows.map(|[a, b, c, d]| (a.abs() * x + b.abs() * y + c.abs() * z + d.abs()) as f32))
    }

    /// The largest absolute value in A.
    pub fn largest(&self) -> f64 {
        self.rows.iter().flat_map(|row| &row[..3]).fold(0.0, |m, a| a.abs().max(m))
    }
}
