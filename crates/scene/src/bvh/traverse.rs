//! Walking the tree.
#![allow(unsafe_code)]

use std::mem::MaybeUninit;

use super::build::MAX_DEPTH;
use super::lanes::{Lanes, Portable};
use super::ray::{LaneRay, is_parallel};
use super::triangle::{BLOCK, Best, NOTHING, SOLID, TriangleBlock, barycentrics};
use super::{Bvh, Child, Hit, Node, Ray, WIDTH};

/// Entries that wait while the deepest tree is walked: all siblings but one at each level.
const STACK: usize = (WIDTH - 1) * MAX_DEPTH + 1;
/// Room for a whole node's children to be written at once.
const SLACK: usize = WIDTH;

/// The first hit along the ray, by lanes that every CPU has.
pub(super) fn closest(bvh: &Bvh, ray: &Ray) -> Option<Hit> {
    first_hit::<Portable>(bvh, ray)
}

/// Whether the ray hits anything, by lanes that every CPU has.
pub(super) fn occluded(bvh: &Bvh, ray: &Ray) -> bool {
    any_hit::<Portable>(bvh, ray)
}

/// What waits to be visited. Clearing it for every ray would cost more than many a ray.
struct Stack<T>([MaybeUninit<T>; STACK + SLACK]);

impl<T: Copy> Stack<T> {
    #[inline(always)]
    fn new() -> Self {
        Self([const { MaybeUninit::uninit() }; STACK + SLACK])
    }

    /// Writes entry `at`.
    ///
    /// # Safety
    /// `at` is less than [`STACK`]. (No tree is deeper than `MAX_DEPTH`, the builder sees to it, and each level
    /// leaves at most `WIDTH - 1` entries behind.)
    #[inline(always)]
    unsafe fn write(&mut self, at: usize, value: T) {
        debug_assert!(at < STACK);
        // SAFETY: as the caller promises.
        unsafe { self.0.get_unchecked_mut(at) }.write(value);
    }

    /// Writes several entries from `at` on, of which some may count.
    ///
    /// # Safety
    /// As of [`Stack::write`], for those that count.
    #[inline(always)]
    unsafe fn write_all(&mut self, at: usize, values: [T; WIDTH]) {
        debug_assert!(at < STACK);
        // SAFETY: there is room for all where the first may be written.
        unsafe { self.0.as_mut_ptr().add(at).cast::<[T; WIDTH]>().write(values) };
    }

    /// Reads entry `at`.
    ///
    /// # Safety
    /// The entry has been written.
    #[inline(always)]
    unsafe fn read(&self, at: usize) -> T {
        // SAFETY: as the caller promises.
        unsafe { self.0.get_unchecked(at).assume_init() }
    }
}

/// A child with where the ray enters it, such that keys are ordered as the distances are: distances are not
/// negative, and of such numbers the bits are ordered as the values.
#[inline(always)]
fn key(t_near: f32, child: Child) -> u64 {
    u64::from(t_near.to_bits()) << 32 | u64::from(child.0)
}

#[inline(always)]
fn child_of(key: u64) -> Child {
    Child(key as u32)
}

#[inline(always)]
fn distance_of(key: u64) -> f32 {
    f32::from_bits((key >> 32) as u32)
}

/// Asks for what a child is to be there soon.
#[inline(always)]
fn prefetch(nodes: &[Node], blocks: &[TriangleBlock], child: Child) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let node = nodes.as_ptr().wrapping_add(child.0 as usize & (Child::LEAF as usize - 1)).cast::<i8>();
        let block = blocks.as_ptr().wrapping_add((child.0 & Child::INDEX) as usize).cast::<i8>();
        let first = if child.is_leaf() { block } else { node };
        for line in 0..5 {
            // SAFETY: no harm comes of any address.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(first.wrapping_add(64 * line)) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (nodes, blocks, child);
}

/// The first hit along the ray.
#[inline(always)]
pub(super) fn first_hit<L: Lanes>(bvh: &Bvh, ray: &Ray) -> Option<Hit> {
    if is_parallel(ray) { first_hit_of::<L, true>(bvh, ray) } else { first_hit_of::<L, false>(bvh, ray) }
}

#[inline(always)]
fn first_hit_of<L: Lanes, const P: bool>(bvh: &Bvh, ray: &Ray) -> Option<Hit> {
    let lanes = LaneRay::<L, P>::new(ray);
    let mut best = Best::<L>::new(ray.t_max);
    let (nodes, blocks): (&[Node], &[TriangleBlock]) = (&bvh.nodes, &bvh.blocks);
    let (mut stack, mut waiting) = (Stack::new(), 0);
    let mut solid = None;
    let mut current = bvh.root;
    loop {
        while !current.is_leaf() {
            // SAFETY: children that are no leaves are indices of nodes.
            let node = unsafe { nodes.get_unchecked(current.0 as usize) };
            let (mask, t_near) = lanes.enter(&node.bounds, L::splat(best.t));
            if mask == 0 {
                break;
            }
            let first = lane(mask);
            let others = mask & mask.wrapping_sub(1);
            if others == 0 {
                current = node.children[first];
                continue;
            }
            let distances = t_near.store().0;
            // SAFETY: at most `WIDTH - 1` children wait.
            (current, waiting) = unsafe { push_sorted(&mut stack, waiting, mask, node, &distances) };
            if bvh.is_large {
                // SAFETY: at least one waits.
                prefetch(nodes, blocks, child_of(unsafe { stack.read(waiting - 1) }));
            }
        }
        if current.is_leaf() {
            test_leaf((bvh, blocks), current, (ray, &lanes), &mut best, &mut solid);
        }
        loop {
            if waiting == 0 {
                return finish(blocks, ray, &best, &solid);
            }
            waiting -= 1;
            // SAFETY: what waits has been written.
            let key = unsafe { stack.read(waiting) };
            if distance_of(key) <= best.t {
                current = child_of(key);
                if bvh.is_large && waiting > 0 {
                    // SAFETY: what waits has been written.
                    prefetch(nodes, blocks, child_of(unsafe { stack.read(waiting - 1) }));
                    if waiting > 1 {
                        prefetch(nodes, blocks, child_of(unsafe { stack.read(waiting - 2) }));
                    }
                }
                break;
            }
        }
    }
}

/// Puts the children in `mask`, which are two or more, on the stack, all but the nearest. Returns that and the new
/// height.
///
/// # Safety
/// As of [`Stack::write`], for all children.
#[inline(always)]
unsafe fn push_sorted(
    stack: &mut Stack<u64>,
    bottom: usize,
    mask: u32,
    node: &Node,
    distances: &[f32; WIDTH],
) -> (Child, usize) {
    let of = |lane: usize| key(distances[lane], node.children[lane]);
    let (a, rest) = (of(lane(mask)), mask & mask.wrapping_sub(1));
    let (b, rest) = (of(lane(rest)), rest & rest.wrapping_sub(1));
    let (a, b) = (a.min(b), a.max(b));
    // SAFETY: as the caller promises.
    unsafe {
        if rest == 0 {
            stack.write(bottom, b);
            return (child_of(a), bottom + 1);
        }
        let (c, mut rest) = (of(lane(rest)), rest & rest.wrapping_sub(1));
        let (a, c) = (a.min(c), a.max(c));
        let (b, c) = (b.min(c), b.max(c));
        stack.write(bottom, c);
        stack.write(bottom + 1, b);
        if rest == 0 {
            return (child_of(a), bottom + 2);
        }
        stack.write(bottom + 2, a);
        let mut top = bottom + 3;
        while rest != 0 {
            let new = of(lane(rest));
            rest &= rest.wrapping_sub(1);
            let mut at = top;
            while at > bottom && stack.read(at - 1) < new {
                stack.write(at, stack.read(at - 1));
                at -= 1;
            }
            stack.write(at, new);
            top += 1;
        }
        (child_of(stack.read(top - 1)), top - 1)
    }
}

/// The lowest bit of a mask that is not zero.
#[inline(always)]
fn lane(mask: u32) -> usize {
    mask.trailing_zeros() as usize & (WIDTH - 1)
}

#[inline(always)]
fn finish<L: Lanes>(blocks: &[TriangleBlock], ray: &Ray, best: &Best<L>, solid: &Option<Hit>) -> Option<Hit> {
    let (t, primitive) = (best.t, best.primitive);
    if primitive == NOTHING {
        return None;
    }
    if best.place == SOLID {
        return *solid;
    }
    let lane = best.place % BLOCK;
    let (v, w, det) =
        (best.edges[0].store().0[lane], best.edges[1].store().0[lane], best.det.store().0[lane]);
    // SAFETY: the place is where a triangle was hit.
    let corners = unsafe { blocks.get_unchecked(best.place / BLOCK) }.corners(lane);
    let [b1, b2] = if det == 0.0 { barycentrics(ray, corners) } else { [v / det, w / det] };
    Some(Hit { t, primitive, instance: Hit::NO_INSTANCE, b1, b2, corners })
}

#[inline(always)]
fn test_leaf<L: Lanes, const P: bool>(
    (bvh, blocks): (&Bvh, &[TriangleBlock]),
    leaf: Child,
    (ray, lanes): (&Ray, &LaneRay<'_, L, P>),
    best: &mut Best<L>,
    solid: &mut Option<Hit>,
) {
    if !leaf.holds_spheres() {
        for index in leaf.range() {
            // SAFETY: leaves without spheres are ranges of blocks.
            unsafe { blocks.get_unchecked(index) }.closest(index, lanes, best);
        }
        return;
    }
    if let Some((t, primitive)) = test_solids(bvh, leaf, ray, (best.t, best.primitive), solid) {
        (best.t, best.primitive, best.place) = (t, primitive, SOLID);
    }
}

/// A hit of a leaf of spheres, or of an instance, that comes before the best so far: its distance and the primitive's
/// id. What is hit is put into `solid`.
#[cold]
#[inline(never)]
fn test_solids(
    bvh: &Bvh,
    leaf: Child,
    ray: &Ray,
    mut best: (f32, u32),
    solid: &mut Option<Hit>,
) -> Option<(f32, u32)> {
    if let Some(index) = leaf.as_instance() {
        let hit = bvh.instances.closest(index, &Ray { t_max: best.0, ..*ray })?;
        let id = bvh.first_instance + index as u32;
        let is_first = hit.t < best.0 || (hit.t == best.0 && id < best.1);
        return is_first.then(|| {
            *solid = Some(hit);
            (hit.t, id)
        });
    }
    let before = best;
    for (sphere, primitive) in &bvh.spheres[leaf.range()] {
        if let Some(t) = sphere.intersect(&Ray { t_max: best.0, ..*ray })
            && (t < best.0 || *primitive < best.1)
        {
            best = (t, *primitive);
        }
    }
    (best != before).then(|| {
        *solid = Some(Hit::of_sphere(best));
        best
    })
}

/// Whether the ray hits anything.
#[inline(always)]
pub(super) fn any_hit<L: Lanes>(bvh: &Bvh, ray: &Ray) -> bool {
    if is_parallel(ray) { any_hit_of::<L, true>(bvh, ray) } else { any_hit_of::<L, false>(bvh, ray) }
}

#[inline(always)]
fn any_hit_of<L: Lanes, const P: bool>(bvh: &Bvh, ray: &Ray) -> bool {
    let lanes = LaneRay::<L, P>::new(ray);
    let t_max = L::splat(ray.t_max);
    let (nodes, blocks): (&[Node], &[TriangleBlock]) = (&bvh.nodes, &bvh.blocks);
    let (mut stack, mut waiting) = (Stack::new(), 0);
    let mut current = bvh.root;
    loop {
        while !current.is_leaf() {
            // SAFETY: children that are no leaves are indices of nodes.
            let node = unsafe { nodes.get_unchecked(current.0 as usize) };
            let (mask, _) = lanes.enter(&node.bounds, t_max);
            if mask == 0 {
                break;
            }
            // The largest is the last, and is visited first.
            let last = (31 - mask.leading_zeros()) as usize & (WIDTH - 1);
            let others = mask ^ 1 << last;
            current = node.children[last];
            // SAFETY: all children but one wait.
            unsafe { stack.write_all(waiting, L::packed(bytemuck::cast_ref(&node.children), others)) };
            waiting += others.count_ones() as usize;
            if bvh.is_large && others != 0 {
                prefetch(nodes, blocks, node.children[31 - others.leading_zeros() as usize]);
            }
        }
        if current.is_leaf() && is_hit((bvh, blocks), current, ray, &lanes) {
            return true;
        }
        if waiting == 0 {
            return false;
        }
        waiting -= 1;
        if bvh.is_large && waiting > 0 {
            // SAFETY: what waits has been written.
            prefetch(nodes, blocks, Child(unsafe { stack.read(waiting - 1) }));
        }
        // SAFETY: what waits has been written.
        current = Child(unsafe { stack.read(waiting) });
    }
}

/// Whether anything in the leaf is hit.
#[inline(always)]
fn is_hit<L: Lanes, const P: bool>(
    (bvh, blocks): (&Bvh, &[TriangleBlock]),
    leaf: Child,
    ray: &Ray,
    lanes: &LaneRay<'_, L, P>,
) -> bool {
    if leaf.holds_spheres() {
        return is_solid_hit(bvh, leaf, ray);
    }
    // SAFETY: leaves without spheres are ranges of blocks.
    for block in unsafe { blocks.get_unchecked(leaf.range()) } {
        if block.any(lanes, ray.t_max) {
            return true;
        }
    }
    false
}

#[cold]
#[inline(never)]
fn is_solid_hit(bvh: &Bvh, leaf: Child, ray: &Ray) -> bool {
    if let Some(index) = leaf.as_instance() {
        return bvh.instances.occluded(index, ray);
    }
    bvh.spheres[leaf.range()].iter().any(|(s, _)| s.intersect(ray).is_some())
}
