//! Rays made ready for tests of eight boxes or triangles at a time.
#![allow(unsafe_code)]

use wide::f32x4;

use super::Ray;
use super::lanes::Lanes;

/// A ray made ready for box tests and for Woop's triangle test. `PARALLEL` says that a component of its direction
/// is zero or almost.
///
/// All that has three parts is by the axes as the ray sees them: the last is the one along which it moves most.
pub(super) struct LaneRay<L, const PARALLEL: bool> {
    /// As it was given.
    source: Ray,
    origin: [L; 3],
    /// Where the ray starts for planes that are left, if it is `PARALLEL`.
    far_origin: [L; 3],
    inverse: [L; 3],
    /// `inverse`, times [`FAR`].
    far_inverse: [L; 3],
    /// The shear that makes the ray the last axis.
    shear: [L; 2],
    /// Where to find what.
    rows: Rows,
}

/// Where rows of coordinates begin.
#[derive(Clone, Copy)]
struct Rows {
    /// The planes of eight boxes that are entered first, and those that are left.
    near: [u8; 3],
    far: [u8; 3],
    /// The coordinates of eight points.
    points: [u8; 3],
    axes: [u8; 3],
}

/// The far planes are pushed out by this factor, which covers the rounding of the slab test and of the
/// triangle test, so that no box is missed whose content is hit (Ize, "Robust BVH Ray Traversal", JCGT
/// 2(2), 2013).
const FAR: f32 = 1.0 + 8.0 * f32::EPSILON;

/// Whether a component of the direction is zero, or so small that its inverse would overflow.
#[inline(always)]
pub(super) fn is_parallel(ray: &Ray) -> bool {
    let [x, y, z] = ray.direction.to_array();
    f32x4::new([x, y, z, 1.0]).abs().simd_lt(f32x4::splat(f32::MIN_POSITIVE)).to_bitmask() != 0
}

/// The rows for directions that are largest along each axis, by the signs of their components.
const ROWS: [[Rows; 8]; 3] = {
    let mut rows = [[Rows { near: [0; 3], far: [0; 3], points: [0; 3], axes: [0; 3] }; 8]; 3];
    let mut i = 0;
    while i < 24 {
        let (z, signs) = (i / 8, i % 8);
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        if signs >> z & 1 == 1 {
            // So that it stays right-handed.
            (x, y) = (y, x);
        }
        let axes = [x, y, z];
        let mut n = 0;
        while n < 3 {
            let axis = axes[n];
            let backward = signs >> axis & 1;
            let of = &mut rows[z][signs];
            of.axes[n] = axis as u8;
            of.points[n] = 8 * axis as u8;
            of.near[n] = 8 * (axis + 3 * backward) as u8;
            of.far[n] = 8 * (axis + 3 - 3 * backward) as u8;
            n += 1;
        }
        i += 1;
    }
    rows
};

impl<L: Lanes, const PARALLEL: bool> LaneRay<L, PARALLEL> {
    #[inline(always)]
    pub(super) fn new(ray: &Ray) -> Self {
        let (d, o) = (ray.direction.to_array(), ray.origin.to_array());
        let (mut divisor, mut far_origin) = (d, o);
        if PARALLEL {
            for axis in 0..3 {
                let (d, o) = (d[axis], o[axis]);
                if d.abs() < f32::MIN_POSITIVE {
                    // A zero component would make 0·∞ of a plane through the origin.
                    divisor[axis] = f32::MIN_POSITIVE.copysign(d);
                    // A ray in the plane in which a box ends does not leave the box at once.
                    far_origin[axis] = o - (o.abs() * f32::EPSILON).max(1e-20).copysign(d);
                }
            }
        }
        let divisor = f32x4::new([divisor[0], divisor[1], divisor[2], 1.0]);
        let inverse = f32x4::splat(1.0) / divisor;
        let far_inverse = (inverse * f32x4::splat(FAR)).to_array();
        let inverse = inverse.to_array();
        // Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.
        let [x, y, z] = d.map(f32::abs);
        let larger = if x > y { x } else { y };
        let largest = if larger > z { usize::from(x <= y) } else { 2 };
        let rows = &ROWS[largest][divisor.to_bitmask() as usize & 7];
        let pick = |v: [f32; 3]| rows.axes.map(|axis| [v[0], v[1], v[2], 0.0][axis as usize & 3]);
        let d = pick(d);
        let inverse = pick([inverse[0], inverse[1], inverse[2]]);
        Self {
            source: *ray,
            origin: splat(pick(o)),
            far_origin: splat(pick(far_origin)),
            inverse: splat(inverse),
            far_inverse: splat(pick([far_inverse[0], far_inverse[1], far_inverse[2]])),
            shear: [L::splat(d[0] * inverse[2]), L::splat(d[1] * inverse[2])],
            rows: *rows,
        }
    }

    /// Which of eight boxes, given by rows of lower x, y, z, upper x, y, z, the ray meets before `t_max`, and where
    /// it enters them.
    ///
    /// Differences and products are monotonic even when rounded: a box around a box that is met is met, and
    /// entered no later.
    #[inline(always)]
    pub(super) fn enter(&self, boxes: &[[f32; 8]; 6], t_max: L) -> (u32, L) {
        let t_near = self.near(boxes, 0).max(self.near(boxes, 1)).max(self.near(boxes, 2).max(L::splat(0.0)));
        let t_far = self.far(boxes, 0).min(self.far(boxes, 1)).min(self.far(boxes, 2).min(t_max));
        (t_near.le(t_far), t_near)
    }

    #[inline(always)]
    fn near(&self, boxes: &[[f32; 8]; 6], axis: usize) -> L {
        row::<L, 6>(boxes, self.rows.near[axis]).sub(self.origin[axis]).mul(self.inverse[axis])
    }

    #[inline(always)]
    fn far(&self, boxes: &[[f32; 8]; 6], axis: usize) -> L {
        row::<L, 6>(boxes, self.rows.far[axis]).sub(self.left_from(axis)).mul(self.far_inverse[axis])
    }

    /// Where the ray starts for planes that are left.
    #[inline(always)]
    fn left_from(&self, axis: usize) -> L {
        if PARALLEL { self.far_origin[axis] } else { self.origin[axis] }
    }

    /// [`LaneRay::enter`] for the triangles' own boxes. The same values in another way: which planes are entered
    /// first is found lane by lane, as a choice by the ray's signs is a jump that nobody can predict.
    #[inline(always)]
    pub(super) fn enter_triangles(&self, corners: &[[[f32; 8]; 3]; 3], t_max: L) -> (u32, L) {
        let (mut t_near, mut t_far) = (L::splat(0.0), t_max);
        for axis in 0..3 {
            let first = self.rows.points[axis];
            let (a, b, c) = (
                row::<L, 3>(&corners[0], first),
                row::<L, 3>(&corners[1], first),
                row::<L, 3>(&corners[2], first),
            );
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            let (origin, inverse) = (self.origin[axis], self.inverse[axis]);
            t_near = t_near.max(low.sub(origin).mul(inverse).min(high.sub(origin).mul(inverse)));
            let (origin, inverse) = (self.left_from(axis), self.far_inverse[axis]);
            t_far = t_far.min(low.sub(origin).mul(inverse).max(high.sub(origin).mul(inverse)));
        }
        (t_near.le(t_far), t_near)
    }

    /// Points as the ray sees them, looking along z.
    #[inline(always)]
    pub(super) fn shear(&self, points: &[[f32; 8]; 3]) -> [L; 3] {
        let z = self.offset(points, 2);
        let x = self.offset(points, 0).sub(self.shear[0].mul(z));
        let y = self.offset(points, 1).sub(self.shear[1].mul(z));
        [x, y, z]
    }

    /// How far along an axis points are from the ray's origin.
    #[inline(always)]
    fn offset(&self, points: &[[f32; 8]; 3], axis: usize) -> L {
        row::<L, 3>(points, self.rows.points[axis]).sub(self.origin[axis])
    }

    /// The ray as it was given.
    #[inline(always)]
    pub(super) fn source(&self) -> &Ray {
        &self.source
    }

    /// One over the direction along z.
    #[inline(always)]
    pub(super) fn along(&self) -> L {
        self.inverse[2]
    }
}

#[inline(always)]
fn splat<L: Lanes>(v: [f32; 3]) -> [L; 3] {
    [L::splat(v[0]), L::splat(v[1]), L::splat(v[2])]
}

/// The row of numbers that begins with that one.
#[inline(always)]
fn row<L: Lanes, const N: usize>(rows: &[[f32; 8]; N], first: u8) -> L {
    debug_assert!(first.is_multiple_of(8) && usize::from(first) < 8 * N);
    // SAFETY: `first` is one of 0, 8, 16 … up to the last row.
    L::load(unsafe { &*rows.as_ptr().cast::<f32>().add(first.into()).cast::<[f32; 8]>() })
}
