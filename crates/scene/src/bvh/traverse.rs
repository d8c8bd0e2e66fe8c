use wide::f32x4;

#[cfg(doc)]
use super::Node;
use super::triangle::ShearedRay;
use super::{Bvh, Child, Hit, Ray};

/// Entries that wait while a tree of that many levels is walked: three siblings at each.
pub(super) const fn stack_for(levels: usize) -> usize {
    3 * levels + 4
}

/// Enough for trees of small scenes. Clearing a stack costs time, so that shallow trees get a shallow one.
const SMALL_STACK: usize = 32;

/// Enough for the depth that the builder allows.
const LARGE_STACK: usize = stack_for(super::build::MAX_DEPTH);

/// The first hit along the ray.
#[inline]
pub(super) fn closest(bvh: &Bvh, ray: &Ray) -> Option<Hit> {
    if bvh.stack <= SMALL_STACK {
        closest_with::<SMALL_STACK>(bvh, ray)
    } else {
        closest_with::<LARGE_STACK>(bvh, ray)
    }
}

/// Whether the ray hits anything.
#[inline]
pub(super) fn occluded(bvh: &Bvh, ray: &Ray) -> bool {
    if bvh.stack <= SMALL_STACK {
        occluded_with::<SMALL_STACK>(bvh, ray)
    } else {
        occluded_with::<LARGE_STACK>(bvh, ray)
    }
}

/// A ray made ready for box tests.
pub(super) struct SlabRay {
    inverse: [f32x4; 3],
    /// For each axis where the ray starts, for planes that are entered first and for those that are left.
    origins: [[f32x4; 2]; 3],
    /// For each axis the row of [`Node::bounds`] that is entered first.
    near: [usize; 3],
}

/// The far planes are pushed out by this factor, which covers the rounding of the slab test and of the
/// triangle test, so that no box is missed whose content is hit (Ize, "Robust BVH Ray Traversal", JCGT
/// 2(2), 2013).
const FAR: f32 = 1.0 + 8.0 * f32::EPSILON;

impl SlabRay {
    #[inline]
    fn new(ray: &Ray) -> Self {
        let (d, o) = (ray.direction, ray.origin);
        let axis = |i: usize| {
            let (d, o) = (d[i], o[i]);
            // A zero component would make 0·∞ of a plane through the origin.
            let parallel = d.abs() < f32::MIN_POSITIVE;
            let inverse = 1.0 / if parallel { f32::MIN_POSITIVE.copysign(d) } else { d };
            // A ray in the plane in which a box ends does not leave the box at once.
            let inset = if parallel { (o.abs() * f32::EPSILON).max(1e-20).copysign(d) } else { 0.0 };
            (
                f32x4::splat(inverse),
                [f32x4::splat(o), f32x4::splat(o - inset)],
                if inverse < 0.0 { i + 3 } else { i },
            )
        };
        let [x, y, z] = [axis(0), axis(1), axis(2)];
        Self { inverse: [x.0, y.0, z.0], origins: [x.1, y.1, z.1], near: [x.2, y.2, z.2] }
    }

    /// Which of four boxes, given by the rows of [`Node::bounds`], the ray meets before `t_max`, and where it
    /// enters them.
    ///
    /// Differences and products are monotonic even when rounded: a box around a box that is met is met, and
    /// entered no later.
    #[inline(always)]
    pub(super) fn enter(&self, row: impl Fn(usize) -> f32x4, t_max: f32) -> (u32, f32x4) {
        let near = |axis: usize| (row(self.near[axis]) - self.origins[axis][0]) * self.inverse[axis];
        let far = |axis: usize| {
            let opposite = if self.near[axis] >= 3 { axis } else { axis + 3 };
            (row(opposite) - self.origins[axis][1]) * self.inverse[axis]
        };
        let t_near = near(0).fast_max(near(1)).fast_max(near(2).fast_max(f32x4::ZERO));
        let t_far = far(0).fast_min(far(1)).fast_min(far(2));
        let hit = t_near.simd_le((t_far * f32x4::splat(FAR)).fast_min(f32x4::splat(t_max)));
        (hit.to_bitmask(), t_near)
    }
}

fn closest_with<const STACK: usize>(bvh: &Bvh, ray: &Ray) -> Option<Hit> {
    let slab = SlabRay::new(ray);
    let sheared = ShearedRay::new(ray, &slab);
    let mut best: Option<Hit> = None;
    let mut stack = [(Child::NONE, 0.0_f32); STACK];
    let mut depth = 0;
    let mut current = Child::node(0);
    if bvh.nodes.is_empty() {
        return None;
    }
    loop {
        if current.is_leaf() {
            test_leaf(bvh, current, ray, &sheared, &mut best);
        } else {
            let node = &bvh.nodes[current.0 as usize];
            let limit = best.map_or(ray.t_max, |b| b.t);
            let (mut mask, t_near) = slab.enter(|row| f32x4::new(node.bounds[row]), limit);
            if mask != 0 {
                let t_near = t_near.to_array();
                let first = mask.trailing_zeros() as usize;
                mask &= mask - 1;
                let mut nearest = (node.children[first], t_near[first]);
                let bottom = depth;
                while mask != 0 {
                    let lane = mask.trailing_zeros() as usize;
                    mask &= mask - 1;
                    let mut other = (node.children[lane], t_near[lane]);
                    if other.1 < nearest.1 {
                        std::mem::swap(&mut other, &mut nearest);
                    }
                    // Insertion, so that the nearest of those that wait is on top.
                    let mut slot = depth;
                    while slot > bottom && stack[slot - 1].1 < other.1 {
                        stack[slot] = stack[slot - 1];
                        slot -= 1;
                    }
                    stack[slot] = other;
                    depth += 1;
                }
                current = nearest.0;
                continue;
            }
        }
        let limit = best.map_or(ray.t_max, |b| b.t);
        loop {
            if depth == 0 {
                return best;
            }
            depth -= 1;
            if stack[depth].1 <= limit {
                current = stack[depth].0;
                break;
            }
        }
    }
}

#[inline]
fn test_leaf(bvh: &Bvh, leaf: Child, ray: &Ray, sheared: &ShearedRay<'_>, best: &mut Option<Hit>) {
    if leaf.holds_spheres() {
        for (sphere, primitive) in &bvh.spheres[leaf.range()] {
            let limited = Ray { t_max: best.map_or(ray.t_max, |b| b.t), ..*ray };
            if let Some(t) = sphere.intersect(&limited)
                && best.is_none_or(|b| t < b.t || *primitive < b.primitive)
            {
                *best = Some(Hit { t, primitive: *primitive, b1: 0.0, b2: 0.0 });
            }
        }
    } else {
        for block in &bvh.blocks[leaf.range()] {
            block.closest(sheared, ray.t_max, best);
        }
    }
}

fn occluded_with<const STACK: usize>(bvh: &Bvh, ray: &Ray) -> bool {
    let slab = SlabRay::new(ray);
    let sheared = ShearedRay::new(ray, &slab);
    let mut stack = [Child::NONE; STACK];
    let mut depth = 0;
    let mut current = Child::node(0);
    if bvh.nodes.is_empty() {
        return false;
    }
    loop {
        if current.is_leaf() {
            let hit = if current.holds_spheres() {
                bvh.spheres[current.range()].iter().any(|(s, _)| s.intersect(ray).is_some())
            } else {
                bvh.blocks[current.range()].iter().any(|b| b.any(&sheared, ray.t_max))
            };
            if hit {
                return true;
            }
        } else {
            let node = &bvh.nodes[current.0 as usize];
            let (mut mask, _) = slab.enter(|row| f32x4::new(node.bounds[row]), ray.t_max);
            while mask != 0 {
                stack[depth] = node.children[mask.trailing_zeros() as usize];
                depth += 1;
                mask &= mask - 1;
            }
        }
        if depth == 0 {
            return false;
        }
        depth -= 1;
        current = stack[depth];
    }
}
