//! Spatial splits: planes that cut the triangles in their way, so that both sides get a part of them (Stich,
//! Friedrich and Dietrich, "Spatial Splits in Bounding Volume Hierarchies", HPG 2009).

use caustica_math::Vec3;

use super::Primitives;
use super::clip::{cut, is_divisible};
use super::reference::{Extent, Extents, Reference};
use super::split::weight;

/// How many more references there may be than primitives.
const MORE_REFERENCES: f64 = 0.3;
/// Spatial splits are tried where the sides of the best object split overlap by more than this part of the
/// root's surface.
const LEAST_OVERLAP: f32 = 1e-5;
/// How much cheaper than the best object split a spatial one must be, because it uses up room that may serve
/// better further down.
const CHEAPER: f32 = 0.9;
/// Fewer references are not worth it: a leaf holds them.
const LEAST_COUNT: usize = 32;
const BINS: usize = 16;

/// References for which there is room, if there are `count` primitives.
pub(super) fn room(count: usize) -> usize {
    (count + (count as f64 * MORE_REFERENCES) as usize).min(super::super::MAX_PRIMITIVES).max(count)
}

/// How much of the `room` for more references the first of two ranges gets: by the surfaces of their boxes, as
/// what a cut gains is the larger the more rays come by.
pub(super) fn share(room: usize, [a, b]: [&[Reference]; 2]) -> usize {
    if room == 0 {
        return 0;
    }
    let [a, b] = [a, b].map(|side| f64::from(Extents::of(side).boxes.half_area()));
    // No share is larger than the room: a / (a + b) is at most one. Nothing by nothing is none.
    (room as f64 * (a / (a + b))) as usize
}

/// A plane across an axis, with the boxes and counts of both sides.
struct Plane {
    cost: f32,
    axis: usize,
    /// The last bin below it.
    last: usize,
    position: f32,
    sides: [Extent; 2],
    counts: [u32; 2],
}

/// What lies in a slab: the box around it, and how many references begin and end there.
#[derive(Clone, Copy)]
struct Bin {
    extent: Extent,
    begin: u32,
    end: u32,
}

/// A way to split references spatially.
pub(super) struct Spatial<'a> {
    primitives: &'a Primitives<'a>,
    least_overlap: f32,
}

impl<'a> Spatial<'a> {
    pub(super) fn new(primitives: &'a Primitives<'a>, root: &Extent) -> Self {
        Self { primitives, least_overlap: root.half_area() * LEAST_OVERLAP }
    }

    /// Whether a spatial split is worth a try, where the sides of the best object split overlap by that area.
    pub(super) fn is_worth_it(&self, count: usize, overlap: f32) -> bool {
        count >= LEAST_COUNT && overlap > self.least_overlap
    }

    /// Splits the first `count` references, the rest being room for more, if that is much cheaper than `cost`.
    /// Those below the plane come first, those above it follow; returns how many each are.
    pub(super) fn split(
        &self,
        references: &mut [Reference],
        count: usize,
        bounds: &Extent,
        cost: f32,
    ) -> Option<[usize; 2]> {
        let slabs = Slabs::new(bounds);
        let bins = self.fill(&slabs, &references[..count]);
        let plane = (0..3)
            .filter(|axis| slabs.scale[*axis] > 0.0)
            .filter_map(|axis| slabs.best_plane(axis, &bins[axis], references.len()))
            .min_by(|a, b| a.cost.total_cmp(&b.cost))
            .filter(|p| p.cost < CHEAPER * cost)?;
        Some(self.partition(references, count, plane, &slabs))
    }

    fn fill(&self, slabs: &Slabs, references: &[Reference]) -> [[Bin; BINS]; 3] {
        let mut bins = [[Bin { extent: Extent::EMPTY, begin: 0, end: 0 }; BINS]; 3];
        for r in references {
            let mut divisible = None;
            for (axis, bins) in bins.iter_mut().enumerate() {
                let [first, last] = slabs.range(r, axis);
                if first == last || !*divisible.get_or_insert_with(|| self.is_divisible(r)) {
                    let at = if first == last { first } else { slabs.middle(r, axis) };
                    bins[at].begin += 1;
                    bins[at].end += 1;
                    bins[at].extent = bins[at].extent.union(r.min, r.max);
                    continue;
                }
                self.chop(r, axis, slabs, bins);
            }
        }
        bins
    }

    /// Adds the parts of a reference to the bins that it meets.
    fn chop(&self, reference: &Reference, axis: usize, slabs: &Slabs, bins: &mut [Bin]) {
        let corners = self.primitives.corners(reference.id());
        let [first, last] = slabs.range(reference, axis);
        bins[first].begin += 1;
        bins[last].end += 1;
        let mut rest = *reference;
        for (i, bin) in bins.iter_mut().enumerate().take(last).skip(first) {
            let [part, above] = cut(&rest, &corners, axis, slabs.plane(axis, i));
            if let Some(part) = part {
                bin.extent = bin.extent.union(part.min, part.max);
            }
            let Some(above) = above else { return };
            rest = above;
        }
        bins[last].extent = bins[last].extent.union(rest.min, rest.max);
    }

    fn is_divisible(&self, r: &Reference) -> bool {
        self.primitives.is_triangle(r.id()) && is_divisible(&self.primitives.corners(r.id()))
    }

    fn partition(
        &self,
        references: &mut [Reference],
        count: usize,
        mut plane: Plane,
        slabs: &Slabs,
    ) -> [usize; 2] {
        let axis = plane.axis;
        let mut below = 0;
        let mut above = Vec::with_capacity(plane.counts[1] as usize);
        for i in 0..count {
            let r = references[i];
            let [first, last] = slabs.range(&r, axis);
            let parts = if last <= plane.last {
                [Some(r), None]
            } else if first > plane.last {
                [None, Some(r)]
            } else if !self.is_divisible(&r) {
                if slabs.middle(&r, axis) <= plane.last { [Some(r), None] } else { [None, Some(r)] }
            } else {
                plane.divide(&r, &self.primitives.corners(r.id()))
            };
            if let Some(part) = parts[0] {
                references[below] = part;
                below += 1;
            }
            above.extend(parts[1]);
        }
        references[below..below + above.len()].copy_from_slice(&above);
        [below, above.len()]
    }
}

impl Plane {
    /// The parts of a reference that both sides get; all of it is one side's if that is as cheap.
    fn divide(&mut self, r: &Reference, corners: &[Vec3; 3]) -> [Option<Reference>; 2] {
        let parts = cut(r, corners, self.axis, self.position);
        let [a, b] = self.sides;
        let [n, m] = self.counts.map(|n| n as f32);
        let [with_a, with_b] = [a, b].map(|side| side.union(r.min, r.max));
        let both = a.half_area() * n + b.half_area() * m;
        let all_below = with_a.half_area() * n + b.half_area() * (m - 1.0);
        let all_above = a.half_area() * (n - 1.0) + with_b.half_area() * m;
        match parts {
            [Some(_), Some(_)] if both < all_below.min(all_above) => parts,
            [Some(_), None] => self.keep(0, with_a, r),
            [None, Some(_)] => self.keep(1, with_b, r),
            _ if all_below <= all_above => self.keep(0, with_a, r),
            _ => self.keep(1, with_b, r),
        }
    }

    /// The whole reference on one side, whose box is now that one.
    fn keep(&mut self, side: usize, extent: Extent, r: &Reference) -> [Option<Reference>; 2] {
        self.sides[side] = extent;
        self.counts[1 - side] -= 1;
        let mut parts = [None; 2];
        parts[side] = Some(*r);
        parts
    }
}

/// Equal slabs across each axis.
struct Slabs {
    low: [f32; 3],
    /// How thick they are, and how many there are for a unit of length: zero along axes without extent.
    step: [f32; 3],
    scale: [f32; 3],
}

impl Slabs {
    fn new(bounds: &Extent) -> Self {
        let (low, high) = (bounds.min.to_array(), bounds.max.to_array());
        let mut slabs = Self { low: [low[0], low[1], low[2]], step: [0.0; 3], scale: [0.0; 3] };
        for axis in 0..3 {
            let range = high[axis] - low[axis];
            let scale = BINS as f32 / range;
            if range > 0.0 && scale.is_finite() {
                (slabs.step[axis], slabs.scale[axis]) = (range / BINS as f32, scale);
            }
        }
        slabs
    }

    fn slab(&self, axis: usize, at: f32) -> usize {
        (((at - self.low[axis]) * self.scale[axis]) as usize).min(BINS - 1)
    }

    /// The first and the last slab that a reference meets.
    fn range(&self, r: &Reference, axis: usize) -> [usize; 2] {
        [r.min, r.max].map(|v| self.slab(axis, v.as_array()[axis]))
    }

    /// The slab of a reference's centre.
    fn middle(&self, r: &Reference, axis: usize) -> usize {
        self.slab(axis, 0.5 * r.center2_along(axis))
    }

    /// The plane above a slab.
    fn plane(&self, axis: usize, slab: usize) -> f32 {
        self.low[axis] + self.step[axis] * (slab + 1) as f32
    }

    /// The cheapest plane across an axis that leaves no more references than there is `room` for.
    fn best_plane(&self, axis: usize, bins: &[Bin; BINS], room: usize) -> Option<Plane> {
        let mut above = [(Extent::EMPTY, 0); BINS];
        for i in (1..BINS).rev() {
            let (extent, count) = if i + 1 < BINS { above[i + 1] } else { (Extent::EMPTY, 0) };
            above[i] = (extent.union(bins[i].extent.min, bins[i].extent.max), count + bins[i].end);
        }
        let (mut extent, mut count) = (Extent::EMPTY, 0);
        let mut best: Option<Plane> = None;
        for i in 0..BINS - 1 {
            extent = extent.union(bins[i].extent.min, bins[i].extent.max);
            count += bins[i].begin;
            let (beyond, others) = above[i + 1];
            if count == 0 || others == 0 || (count + others) as usize > room {
                continue;
            }
            let cost = extent.half_area() * weight(count) + beyond.half_area() * weight(others);
            if best.as_ref().is_none_or(|b| cost < b.cost) {
                let (sides, counts) = ([extent, beyond], [count, others]);
                let position = self.plane(axis, i);
                best = Some(Plane { cost, axis, last: i, position, sides, counts });
            }
        }
        best
    }
}
