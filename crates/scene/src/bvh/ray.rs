//! Rays made ready for tests of eight boxes or triangles at a time.
#![allow(unsafe_code)]

use wide::f32x4;

use super::Ray;
use super::lanes::Lanes;

/// A ray made ready for box tests and for Woop's triangle test. `PARALLEL` says that a component of its direction
/// is zero or almost.
pub(super) struct LaneRay<L, const PARALLEL: bool> {
    /// As it was given.
    source: Ray,
    origin: [L; 3],
    /// Where the ray starts for planes that are left, if it is `PARALLEL`.
    far_origin: [L; 3],
    inverse: [L; 3],
    /// `inverse`, times [`FAR`].
    far_inverse: [L; 3],
    /// For each axis where the row of planes begins that are entered first, and of those that are left.
    near: [usize; 3],
    far: [usize; 3],
    /// The axes permuted so that z is the largest of the direction, and the shear that makes it the z axis.
    axes: [usize; 3],
    shear: [L; 3],
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

/// The x and y axes for each z axis, for directions along it and against it.
const PERMUTATIONS: [[[usize; 2]; 2]; 3] = [[[1, 2], [2, 1]], [[2, 0], [0, 2]], [[0, 1], [1, 0]]];

/// Where the rows of planes begin that are entered first and those that are left, for directions by the signs of
/// their components.
const ROWS: [[[usize; 3]; 2]; 8] = {
    let mut rows = [[[0; 3]; 2]; 8];
    let mut i = 0;
    while i < 24 {
        let (signs, axis) = (i / 3, i % 3);
        let backward = signs >> axis & 1;
        rows[signs][0][axis] = 8 * (axis + 3 * backward);
        rows[signs][1][axis] = 8 * (axis + 3 - 3 * backward);
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
        let inverse = f32x4::splat(1.0) / f32x4::new([divisor[0], divisor[1], divisor[2], 1.0]);
        let signs = inverse.simd_lt(f32x4::ZERO).to_bitmask() as usize & 7;
        let far_inverse = (inverse * f32x4::splat(FAR)).to_array();
        let inverse = inverse.to_array();
        let [near, far] = ROWS[signs];
        // Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.
        let size = [d[0].abs(), d[1].abs(), d[2].abs()];
        let larger = usize::from(size[0] <= size[1]);
        let z = if size[larger] > size[2] { larger } else { 2 };
        let [x, y] = PERMUTATIONS[z][signs >> z & 1];
        let along = inverse[z];
        Self {
            source: *ray,
            origin: splat(o),
            far_origin: splat(far_origin),
            inverse: splat([inverse[0], inverse[1], inverse[2]]),
            far_inverse: splat([far_inverse[0], far_inverse[1], far_inverse[2]]),
            near,
            far,
            axes: [x, y, z],
            shear: splat([d[x] * along, d[y] * along, along]),
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
        row::<L>(boxes, self.near[axis]).sub(self.origin[axis]).mul(self.inverse[axis])
    }

    #[inline(always)]
    fn far(&self, boxes: &[[f32; 8]; 6], axis: usize) -> L {
        row::<L>(boxes, self.far[axis]).sub(self.left_from(axis)).mul(self.far_inverse[axis])
    }

    /// Where the ray starts for planes that are left.
    #[inline(always)]
    fn left_from(&self, axis: usize) -> L {
        if PARALLEL { self.far_origin[axis] } else { self.origin[axis] }
    }

    /// [`LaneRay::enter`] for the triangles' own boxes. The same values in another way: which planes are entered
    /// first is found lane by lane, as a choice by the ray's signs is a jump that nobody can predict.
    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "the axis numbers many arrays")]
    pub(super) fn enter_triangles(&self, corners: &[[[f32; 8]; 3]; 3], t_max: L) -> (u32, L) {
        let (mut t_near, mut t_far) = (L::splat(0.0), t_max);
        for axis in 0..3 {
            let a = L::load(&corners[0][axis]);
            let b = L::load(&corners[1][axis]);
            let c = L::load(&corners[2][axis]);
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
        let [kx, ky, kz] = self.axes;
        let z = L::load(&points[kz]).sub(self.origin[kz]);
        let x = L::load(&points[kx]).sub(self.origin[kx]).sub(self.shear[0].mul(z));
        let y = L::load(&points[ky]).sub(self.origin[ky]).sub(self.shear[1].mul(z));
        [x, y, z]
    }

    /// The ray as it was given.
    #[inline(always)]
    pub(super) fn source(&self) -> &Ray {
        &self.source
    }

    /// One over the direction along z.
    #[inline(always)]
    pub(super) fn along(&self) -> L {
        self.shear[2]
    }
}

#[inline(always)]
fn splat<L: Lanes>(v: [f32; 3]) -> [L; 3] {
    [L::splat(v[0]), L::splat(v[1]), L::splat(v[2])]
}

/// The row of planes that begins with that number.
#[inline(always)]
fn row<L: Lanes>(boxes: &[[f32; 8]; 6], first: usize) -> L {
    debug_assert!(first.is_multiple_of(8) && first < 48);
    // SAFETY: `first` is one of 0, 8, … 40, and the array has 48 numbers.
    L::load(unsafe { &*boxes.as_ptr().cast::<f32>().add(first).cast::<[f32; 8]>() })
}
