use caustica_math::Vec3;
use wide::f32x4;

use super::traverse::SlabRay;
use super::{Hit, Ray};

/// Up to four triangles, corner by corner and axis by axis. Unused lanes repeat the first triangle with
/// the id [`TriangleBlock::UNUSED`].
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub(super) struct TriangleBlock {
    corners: [[[f32; 4]; 3]; 3],
    ids: [u32; 4],
}

/// A ray made ready for Woop's test: the axes permuted so that z is the largest of its direction, and
/// the shear that makes it the z axis.
///
/// Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.
#[derive(Clone, Copy)]
pub(super) struct ShearedRay<'a> {
    axes: [usize; 3],
    shear: [f32; 3],
    origin: Vec3,
    slab: &'a SlabRay,
}

impl<'a> ShearedRay<'a> {
    #[inline]
    pub(super) fn new(ray: &Ray, slab: &'a SlabRay) -> Self {
        let d = ray.direction;
        let a = d.abs();
        let z = if a.x > a.y {
            if a.x > a.z { 0 } else { 2 }
        } else if a.y > a.z {
            1
        } else {
            2
        };
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        if d[z] < 0.0 {
            std::mem::swap(&mut x, &mut y);
        }
        let inverse = 1.0 / d[z];
        let shear = [d[x] * inverse, d[y] * inverse, inverse];
        Self { axes: [x, y, z], shear, origin: ray.origin, slab }
    }
}

impl TriangleBlock {
    /// The id of an unused lane.
    const UNUSED: u32 = u32::MAX;

    pub(super) fn new(triangles: &[(u32, [Vec3; 3])]) -> Self {
        debug_assert!((1..=4).contains(&triangles.len()));
        let mut block = Self { corners: [[[0.0; 4]; 3]; 3], ids: [Self::UNUSED; 4] };
        for lane in 0..4 {
            let (id, corners) = triangles[if lane < triangles.len() { lane } else { 0 }];
            if lane < triangles.len() {
                block.ids[lane] = id;
            }
            for (corner, p) in corners.iter().enumerate() {
                for axis in 0..3 {
                    block.corners[corner][axis][lane] = p[axis];
                }
            }
        }
        block
    }

    /// Tests all four triangles; returns (hit lanes, t, unnormalised edge values, their sum).
    ///
    /// Products and differences are not fused, so the value of an edge shared by two triangles is exactly
    /// the negative of the other's: no ray passes between them.
    #[inline(always)]
    fn test(&self, ray: &ShearedRay<'_>, t_max: f32) -> (u32, f32x4, [f32x4; 2], f32x4) {
        let [kx, ky, kz] = ray.axes;
        let (sx, sy, sz) =
            (f32x4::splat(ray.shear[0]), f32x4::splat(ray.shear[1]), f32x4::splat(ray.shear[2]));
        let (ox, oy, oz) =
            (f32x4::splat(ray.origin[kx]), f32x4::splat(ray.origin[ky]), f32x4::splat(ray.origin[kz]));
        let corner = |c: &[[f32; 4]; 3]| {
            let z = f32x4::new(c[kz]) - oz;
            (f32x4::new(c[kx]) - ox - sx * z, f32x4::new(c[ky]) - oy - sy * z, z)
        };
        let (ax, ay, az) = corner(&self.corners[0]);
        let (bx, by, bz) = corner(&self.corners[1]);
        let (cx, cy, cz) = corner(&self.corners[2]);
        let u = cx * by - cy * bx;
        let v = ax * cy - ay * cx;
        let w = bx * ay - by * ax;
        let zero = f32x4::ZERO;
        let inside = (u.simd_ge(zero) & v.simd_ge(zero) & w.simd_ge(zero))
            | (u.simd_le(zero) & v.simd_le(zero) & w.simd_le(zero));
        if inside.to_bitmask() == 0 {
            return (0, zero, [zero; 2], zero);
        }
        let det = u + v + w;
        let t = sz * (u * az + v * bz + w * cz) / det;
        let hit = (inside & t.simd_gt(zero) & t.simd_le(f32x4::splat(t_max))).to_bitmask();
        if hit == 0 {
            return (0, zero, [zero; 2], zero);
        }
        let (mask, t) = self.clip(ray, t, t_max);
        (hit & mask, t, [v, w], det)
    }

    /// The lanes whose triangle's own box the ray meets, and which hit before `t_max`; and their distances,
    /// but none before that box.
    ///
    /// Distances are averages of the corners' with weights that are rounded, and hits can lie just beyond an
    /// edge. By leaving out what its own box would hide, what is hit does not depend on the boxes in which
    /// the tree keeps it.
    #[inline]
    fn clip(&self, ray: &ShearedRay<'_>, t: f32x4, t_max: f32) -> (u32, f32x4) {
        let row = |row: usize| {
            let [a, b, c] = [0, 1, 2].map(|corner: usize| f32x4::new(self.corners[corner][row % 3]));
            if row < 3 { a.fast_min(b).fast_min(c) } else { a.fast_max(b).fast_max(c) }
        };
        let (mask, entry) = ray.slab.enter(row, t_max);
        let t = t.fast_max(entry);
        (t.simd_le(f32x4::splat(t_max)).to_bitmask() & mask, t)
    }

    /// Replaces `best` if a triangle is hit before it, or at the same distance by a lower id.
    #[inline]
    pub(super) fn closest(&self, ray: &ShearedRay<'_>, t_max: f32, best: &mut Option<Hit>) {
        let limit = best.map_or(t_max, |b| b.t);
        let (mut mask, t, [v, w], det) = self.test(ray, limit);
        if mask == 0 {
            return;
        }
        let (t, v, w, det) = (t.to_array(), v.to_array(), w.to_array(), det.to_array());
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize;
            mask &= mask - 1;
            let (t, primitive) = (t[lane], self.ids[lane]);
            if primitive != Self::UNUSED
                && best.is_none_or(|b| t < b.t || (t == b.t && primitive < b.primitive))
            {
                *best = Some(Hit { t, primitive, b1: v[lane] / det[lane], b2: w[lane] / det[lane] });
            }
        }
    }

    /// Whether any triangle is hit.
    #[inline]
    pub(super) fn any(&self, ray: &ShearedRay<'_>, t_max: f32) -> bool {
        // Unused lanes repeat the first triangle, so that they need no mask here.
        self.test(ray, t_max).0 != 0
    }
}
