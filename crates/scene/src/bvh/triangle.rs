//! Leaves: triangles, eight at a time.

use bytemuck::{Pod, Zeroable};
use caustica_math::Vec3;
use caustica_math::spherical::{between, cross, dot};

use super::Ray;
use super::lanes::Lanes;
use super::ray::LaneRay;

/// Triangles in a block.
pub(super) const BLOCK: usize = 8;

/// Up to eight triangles, corner by corner and axis by axis. Unused lanes repeat the first triangle.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C, align(32))]
pub(super) struct TriangleBlock {
    corners: [[[f32; BLOCK]; 3]; 3],
    ids: [u32; BLOCK],
}

/// The best hit so far.
#[derive(Clone, Copy)]
pub(super) struct Best<L> {
    /// Where it is, or where the ray ends.
    pub t: f32,
    /// What was hit; [`NOTHING`] if nothing was.
    pub primitive: u32,
    /// Where it lies among the blocks: the block's index times eight, plus the lane.
    pub place: usize,
    /// For all lanes there the barycentric coordinates of the second and third corner, times `det`.
    pub edges: [L; 2],
    pub det: L,
}

impl<L: Lanes> Best<L> {
    /// Nothing so far.
    #[inline(always)]
    pub(super) fn new(t_max: f32) -> Self {
        let zero = L::splat(0.0);
        Self { t: t_max, primitive: NOTHING, place: 0, edges: [zero; 2], det: zero }
    }
}
/// No primitive.
pub(super) const NOTHING: u32 = u32::MAX;
/// The place of spheres and instances.
pub(super) const SOLID: usize = usize::MAX;

/// What a block's test found.
struct Crossings<L> {
    /// The lanes that are hit.
    mask: u32,
    t: L,
    /// Unnormalised edge values of the second and third corner, and the sum of all three.
    edges: [L; 2],
    det: L,
}

/// Triangles that cover less than one in this many of the square around them, as a ray sees them, count as thin.
const THIN: f32 = 64.0;

/// The absolute values.
#[inline(always)]
fn size<L: Lanes>(v: L) -> L {
    v.max(L::splat(0.0).sub(v))
}

/// The largest absolute value of three, and some more. (No closure: LLVM would not inline that into functions with
/// AVX2.)
#[inline(always)]
fn reach<L: Lanes>([a, b, c]: [L; 3], more: L) -> L {
    size(a).max(size(b)).max(size(c)).add(more)
}

/// Where a ray meets a triangle's plane; not a number or infinite where it runs along it.
fn plane_distance(ray: &Ray, corners: [Vec3; 3]) -> f32 {
    let [a, b, c] = corners;
    let normal = cross(between(a, b), between(a, c));
    (dot(normal, between(ray.origin, a)) / dot(normal, ray.direction.to_array().map(f64::from))) as f32
}

/// The barycentric coordinates of the second and third corner where a ray meets a triangle, for triangles so thin
/// that those found lane by lane have lost all digits.
#[cold]
#[inline(never)]
pub(super) fn barycentrics(ray: &Ray, corners: [Vec3; 3]) -> [f32; 2] {
    let d = ray.direction.to_array().map(f64::from);
    let [a, b, c] = corners.map(|p| between(ray.origin, p));
    let edges = [dot(d, cross(c, b)), dot(d, cross(a, c)), dot(d, cross(b, a))];
    let share = |edge: f64| (edge / (edges[0] + edges[1] + edges[2])).clamp(0.0, 1.0) as f32;
    let [v, w] = [share(edges[1]), share(edges[2])];
    if (v + w).is_nan() { [0.0; 2] } else { [v, w.min(1.0 - v)] }
}

impl TriangleBlock {
    /// A block of the given triangles, one to eight.
    pub(super) fn new(triangles: impl Iterator<Item = (u32, [Vec3; 3])>) -> Self {
        let mut block = Self { corners: [[[0.0; BLOCK]; 3]; 3], ids: [NOTHING; BLOCK] };
        let mut used = 0;
        for (id, corners) in triangles.take(BLOCK) {
            // The first fills the lanes that may stay unused.
            let lanes = if used == 0 { 0..BLOCK } else { used..used + 1 };
            for lane in lanes {
                block.set(lane, id, &corners);
            }
            used += 1;
        }
        debug_assert!(used > 0);
        block
    }

    fn set(&mut self, lane: usize, id: u32, corners: &[Vec3; 3]) {
        self.ids[lane] = id;
        for (corner, p) in corners.iter().enumerate() {
            for axis in 0..3 {
                self.corners[corner][axis][lane] = p[axis];
            }
        }
    }

    /// Tests all triangles.
    ///
    /// Products and differences are not fused, so the value of an edge shared by two triangles is exactly
    /// the negative of the other's: no ray passes between them.
    #[inline(always)]
    fn test<L: Lanes, const P: bool>(&self, ray: &LaneRay<'_, L, P>, t_max: f32) -> Option<Crossings<L>> {
        let [ax, ay, az] = ray.shear(&self.corners[0]);
        let [bx, by, bz] = ray.shear(&self.corners[1]);
        let [cx, cy, cz] = ray.shear(&self.corners[2]);
        let u = cx.mul(by).sub(cy.mul(bx));
        let v = ax.mul(cy).sub(ay.mul(cx));
        let w = bx.mul(ay).sub(by.mul(ax));
        let zero = L::splat(0.0);
        let inside = u.min(v).min(w).ge(zero) | u.max(v).max(w).le(zero);
        if inside == 0 {
            return None;
        }
        let det = u.add(v).add(w);
        let depth = u.mul(az).add(v.mul(bz)).add(w.mul(cz));
        let mut t = ray.along().mul(depth).div(det);
        let spread = az.max(bz).max(cz).sub(az.min(bz).min(cz));
        let square = reach([ax, bx, cx], spread).mul(reach([ay, by, cy], spread));
        let (depth, det_size) = (size(depth), size(det));
        // Both at once: few are, but half of all rays begin on a triangle and are near.
        let unsure = inside & depth.le(det_size.mul(spread)) & det_size.mul(L::splat(THIN)).le(square);
        if unsure != 0 {
            t = L::load(&self.refined(ray.source(), unsure, t.store().0));
        }
        let t_max = L::splat(t_max);
        let hit = inside & t.gt(zero) & t.le(t_max);
        if hit == 0 {
            return None;
        }
        let (mask, t) = self.clip(ray, t, t_max);
        (hit & mask != 0).then_some(Crossings { mask: hit & mask, t, edges: [v, w], det })
    }

    /// The distances with those of the lanes in `mask` found anew, from the triangles' planes.
    ///
    /// Distances are averages of the corners' with the edge values as weights. Where a triangle is long and thin
    /// and the ray starts near by, the rounding of those moves a hit by more than its distance, and it may be lost.
    #[cold]
    #[inline(never)]
    fn refined(&self, ray: &Ray, mask: u32, mut distances: [f32; BLOCK]) -> [f32; BLOCK] {
        for (lane, t) in distances.iter_mut().enumerate().filter(|(lane, _)| mask >> lane & 1 == 1) {
            *t = plane_distance(ray, self.corners(lane));
        }
        distances
    }

    /// The lanes whose triangle's own box the ray meets, and which hit before `t_max`; and their distances,
    /// but none before that box.
    ///
    /// Distances are averages of the corners' with weights that are rounded, and hits can lie just beyond an
    /// edge. By leaving out what its own box would hide, what is hit does not depend on the boxes in which
    /// the tree keeps it.
    #[inline(always)]
    fn clip<L: Lanes, const P: bool>(&self, ray: &LaneRay<'_, L, P>, t: L, t_max: L) -> (u32, L) {
        let (mask, entry) = ray.enter_triangles(&self.corners, t_max);
        let t = t.max(entry);
        (t.le(t_max) & mask, t)
    }

    /// The corners of one triangle.
    #[inline(always)]
    pub(super) fn corners(&self, lane: usize) -> [Vec3; 3] {
        let lane = lane % BLOCK;
        let corner = |[x, y, z]: &[[f32; BLOCK]; 3]| Vec3::new(x[lane], y[lane], z[lane]);
        [corner(&self.corners[0]), corner(&self.corners[1]), corner(&self.corners[2])]
    }

    /// Replaces `best` if a triangle of this block, number `index`, is hit before it, or at the same distance by a
    /// lower id.
    #[inline(always)]
    pub(super) fn closest<L: Lanes, const P: bool>(
        &self,
        index: usize,
        ray: &LaneRay<'_, L, P>,
        best: &mut Best<L>,
    ) {
        let Some(Crossings { mut mask, t, edges, det }) = self.test(ray, best.t) else { return };
        let ts = t.store().0;
        let mut winner = None;
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize;
            mask &= mask - 1;
            let (t, primitive) = (ts[lane], self.ids[lane]);
            // A hit where the ray ends counts: every id is lower than nothing's.
            if t < best.t || (t == best.t && primitive < best.primitive) {
                (best.t, best.primitive) = (t, primitive);
                winner = Some(lane);
            }
        }
        if let Some(lane) = winner {
            best.place = index * BLOCK + lane;
            (best.edges, best.det) = (edges, det);
        }
    }

    /// Whether any triangle is hit.
    #[inline(always)]
    pub(super) fn any<L: Lanes, const P: bool>(&self, ray: &LaneRay<'_, L, P>, t_max: f32) -> bool {
        self.test(ray, t_max).is_some()
    }
}
