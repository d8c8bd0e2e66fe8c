use caustica_math::Vec3;
use wide::f32x4;

use super::triangle::ShearedRay;
use super::{Bvh, Child, Hit, Node, Ray};

/// Enough for the depth that the builder allows: three siblings wait at each level.
pub(super) const STACK: usize = 3 * super::build::MAX_DEPTH + 4;

/// A ray made ready for box tests.
struct SlabRay {
    inverse: [f32x4; 3],
    origin: [f32x4; 3],
    /// For each axis the row of [`Node::bounds`] that is entered first.
    near: [usize; 3],
}

/// The far planes are pushed out by this factor, which covers the rounding of the slab test, so that no
/// box is missed whose content is hit (Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013).
const FAR: f32 = 1.0 + 4.0 * f32::EPSILON;

impl SlabRay {
    #[inline]
    fn new(ray: &Ray) -> Self {
        // A zero component would make 0·∞ of a plane through the origin.
        let inverse = |d: f32| 1.0 / if d.abs() < 1e-18 { 1e-18_f32.copysign(d) } else { d };
        let (d, o) = (ray.direction, ray.origin);
        let i = Vec3::new(inverse(d.x), inverse(d.y), inverse(d.z));
        let near = |axis: usize| if i[axis] < 0.0 { axis + 3 } else { axis };
        Self {
            inverse: [f32x4::splat(i.x), f32x4::splat(i.y), f32x4::splat(i.z)],
            origin: [f32x4::splat(o.x), f32x4::splat(o.y), f32x4::splat(o.z)],
            near: [near(0), near(1), near(2)],
        }
    }

    /// Which of the four children the ray meets before `t_max`, and where it enters them.
    #[inline(always)]
    fn enter(&self, node: &Node, t_max: f32) -> (u32, f32x4) {
        let plane = |row: usize, axis: usize| {
            (f32x4::new(node.bounds[row]) - self.origin[axis]) * self.inverse[axis]
        };
        let far = |axis: usize| if self.near[axis] >= 3 { axis } else { axis + 3 };
        let t_near = plane(self.near[0], 0)
            .fast_max(plane(self.near[1], 1))
            .fast_max(plane(self.near[2], 2).fast_max(f32x4::ZERO));
        let t_far = plane(far(0), 0).fast_min(plane(far(1), 1)).fast_min(plane(far(2), 2));
        let hit = t_near.simd_le((t_far * f32x4::splat(FAR)).fast_min(f32x4::splat(t_max)));
        (hit.to_bitmask(), t_near)
    }
}

pub(super) fn closest(bvh: &Bvh, ray: &Ray) -> Option<Hit> {
    let slab = SlabRay::new(ray);
    let sheared = ShearedRay::new(ray);
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
            let (mut mask, t_near) = slab.enter(node, limit);
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
fn test_leaf(bvh: &Bvh, leaf: Child, ray: &Ray, sheared: &ShearedRay, best: &mut Option<Hit>) {
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

pub(super) fn occluded(bvh: &Bvh, ray: &Ray) -> bool {
    let slab = SlabRay::new(ray);
    let sheared = ShearedRay::new(ray);
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
            let (mut mask, _) = slab.enter(node, ray.t_max);
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
