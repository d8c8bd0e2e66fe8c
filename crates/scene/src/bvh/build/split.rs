//! The binary tree, top down and in parallel.

use wide::f32x4;

use super::super::Bounds;
use super::super::triangle::BLOCK;
use super::Primitives;
use super::collapse::{Costs, INSTANCE, Tree};
use super::reference::{Extent, Extents, Reference};
use super::spatial::{Spatial, share};

/// Levels that are split by the surface-area heuristic.
pub(super) const SAH_DEPTH: usize = 48;
/// Ranges of at most as many are not split further.
const LEAF_SIZE: usize = 4;
const PARALLEL_SIZE: usize = 4096;

/// What builds the binary tree.
pub(super) struct Splitter<'a> {
    pub primitives: &'a Primitives<'a>,
    /// Spatial splits, if they are wanted.
    pub spatial: Option<Spatial<'a>>,
}

/// Where a range of references stands.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// The number of its first reference among all.
    pub first: usize,
    pub depth: usize,
}

impl Splitter<'_> {
    /// The tree over the first `count` references, which are sorted into its order; the others are room for more.
    pub(super) fn split(&self, references: &mut [Reference], count: usize, place: Place) -> (Tree, Costs) {
        let is_triangle = |r: &Reference| self.primitives.is_triangle(r.id());
        let is_instance = |r: &Reference| self.primitives.instance(r.id()).is_some();
        let number = |of: &dyn Fn(&Reference) -> bool, references: &[Reference]| {
            references[..count].iter().filter(|r| of(r)).count()
        };
        let extents = Extents::of(&references[..count]);
        let bounds = extents.boxes.bounds();
        let Primitives { spheres, instances, .. } = self.primitives;
        let triangles =
            if spheres.is_empty() && instances.is_empty() { count } else { number(&is_triangle, references) };
        let instances = if instances.is_empty() { 0 } else { number(&is_instance, references) };
        let spheres = count - triangles - instances;
        let mixed = ![triangles, spheres, instances].contains(&count);
        if instances == 1 && count == 1 {
            return Tree::leaf(bounds, place.first, INSTANCE);
        }
        if count <= LEAF_SIZE && !mixed && instances == 0 {
            return Tree::leaf(bounds, place.first, [triangles, spheres]);
        }
        let [left, right] = if count <= LEAF_SIZE && mixed {
            let first = |r: &Reference| if triangles > 0 { is_triangle(r) } else { !is_instance(r) };
            sides(partition(&mut references[..count], first), count)
        } else if place.depth < SAH_DEPTH {
            self.sah(references, count, &extents).unwrap_or([count / 2, count - count / 2])
        } else {
            sides(median(&mut references[..count], &bounds), count)
        };
        let room = references.len() - left - right;
        let (front, back) = references[..left + right].split_at(left);
        let middle = left + share(room, [front, back]);
        references.copy_within(left..left + right, middle);
        let (a, b) = references.split_at_mut(middle);
        let below = Place { depth: place.depth + 1, ..place };
        let beyond = Place { first: place.first + middle, ..below };
        let build_a = |a| self.split(a, left, below);
        let build_b = |b| self.split(b, right, beyond);
        let children = if count > PARALLEL_SIZE {
            rayon::join(|| build_a(a), || build_b(b))
        } else {
            (build_a(a), build_b(b))
        };
        let id = |i: u32| references[i as usize - place.first].id();
        Tree::inner(bounds, children, self.spatial.is_some().then_some(&id))
    }

    /// Splits by the surface-area heuristic, with as many bins as the number of references is worth; returns how
    /// many lie on each side. `None` if all centres coincide.
    fn sah(&self, references: &mut [Reference], count: usize, extents: &Extents) -> Option<[usize; 2]> {
        match count {
            0..16 => self.sah_in_bins::<8>(references, count, extents),
            16..64 => self.sah_in_bins::<16>(references, count, extents),
            _ => self.sah_in_bins::<32>(references, count, extents),
        }
    }

    fn sah_in_bins<const N: usize>(
        &self,
        references: &mut [Reference],
        count: usize,
        extents: &Extents,
    ) -> Option<[usize; 2]> {
        let bins = Bins::<N>::new(&references[..count], &extents.centers2);
        let plane = bins.best()?;
        if let Some(spatial) = &self.spatial
            && spatial.is_worth_it(count, bins.overlap(&plane))
            && let Some(sides) = spatial.split(references, count, &extents.boxes, plane.cost)
        {
            return Some(sides);
        }
        let is_below = |r: &Reference| bins.place(r)[plane.axis] <= plane.last;
        Some(sides(partition(&mut references[..count], is_below), count))
    }
}

/// How many lie on either side, if that many of all lie on the first.
fn sides(left: usize, count: usize) -> [usize; 2] {
    [left, count - left]
}

/// Halves the range at the median of the widest axis.
fn median(references: &mut [Reference], bounds: &Bounds) -> usize {
    let d = bounds.max - bounds.min;
    let axis = (0..3).max_by(|a, b| d[*a].total_cmp(&d[*b])).unwrap_or(0);
    let middle = references.len() / 2;
    references.select_nth_unstable_by(middle, |a, b| {
        a.center2_along(axis).total_cmp(&b.center2_along(axis)).then(a.id().cmp(&b.id()))
    });
    middle
}

/// Moves those for which `left` holds to the front; returns how many there are.
fn partition(references: &mut [Reference], left: impl Fn(&Reference) -> bool) -> usize {
    let mut middle = 0;
    for i in 0..references.len() {
        if left(&references[i]) {
            references.swap(middle, i);
            middle += 1;
        }
    }
    middle
}

/// What that many triangles are expected to cost: between their number and that of the lanes that they will take, as
/// nearly full blocks are worth having.
#[inline(always)]
pub(super) fn weight(count: u32) -> f32 {
    (count + count.next_multiple_of(BLOCK as u32)) as f32 * 0.5
}

/// A plane between bins.
struct Plane {
    cost: f32,
    axis: usize,
    /// The last bin before it.
    last: usize,
}

/// A bin: the box around references, and how many they are.
type Bin = (Extent, u32);

/// References by where their centres lie in the range of centres, in `N` equal parts along each axis.
struct Bins<const N: usize> {
    low: f32x4,
    /// Bins over the range of centres; zero along axes on which all centres coincide.
    scale: f32x4,
    bins: [[Bin; N]; 3],
}

impl<const N: usize> Bins<N> {
    fn new(references: &[Reference], centers2: &Extent) -> Self {
        let mut scale = [0.0; 4];
        for (axis, s) in scale.iter_mut().enumerate().take(3) {
            let range = (centers2.max - centers2.min).to_array()[axis];
            let bins = N as f32 / range;
            if range > 0.0 && range.is_finite() && bins.is_finite() {
                *s = bins;
            }
        }
        let mut bins =
            Self { low: centers2.min, scale: f32x4::new(scale), bins: [[(Extent::EMPTY, 0); N]; 3] };
        for r in references {
            let place = bins.place(r);
            for (axis, at) in place.into_iter().enumerate() {
                let bin = &mut bins.bins[axis][at];
                *bin = (bin.0.union(r.min, r.max), bin.1 + 1);
            }
        }
        bins
    }

    /// The bins of a reference along all axes.
    #[inline(always)]
    fn place(&self, r: &Reference) -> [usize; 3] {
        let [x, y, z, _] = ((r.center2() - self.low) * self.scale).fast_trunc_int().to_array();
        [x, y, z].map(|bin| (bin as u32 as usize).min(N - 1))
    }

    /// The cheapest plane between bins along an axis: its cost and the last bin before it.
    fn best_plane(&self, axis: usize) -> Option<(f32, usize)> {
        let bins = &self.bins[axis];
        let mut right = [(0.0_f32, 0u32); N];
        let mut sum = (Extent::EMPTY, 0);
        for i in (1..N).rev() {
            sum = together(sum, bins[i]);
            right[i] = (sum.0.half_area(), sum.1);
        }
        sum = (Extent::EMPTY, 0);
        let mut best: Option<(f32, usize)> = None;
        for i in 0..N - 1 {
            sum = together(sum, bins[i]);
            let (area, beyond) = right[i + 1];
            if sum.1 == 0 || beyond == 0 {
                continue;
            }
            let cost = sum.0.half_area() * weight(sum.1) + area * weight(beyond);
            if best.is_none_or(|b| cost < b.0) {
                best = Some((cost, i));
            }
        }
        best
    }

    /// The cheapest of the planes between bins; `None` if all centres coincide.
    fn best(&self) -> Option<Plane> {
        let mut best: Option<Plane> = None;
        for axis in 0..3 {
            if self.scale.to_array()[axis] > 0.0
                && let Some((cost, last)) = self.best_plane(axis)
                && best.as_ref().is_none_or(|b| cost < b.cost)
            {
                best = Some(Plane { cost, axis, last });
            }
        }
        best
    }

    /// The surface of what the boxes of both sides have in common.
    fn overlap(&self, plane: &Plane) -> f32 {
        let (below, above) = self.bins[plane.axis].split_at(plane.last + 1);
        let [a, b] =
            [below, above].map(|bins| bins.iter().fold((Extent::EMPTY, 0), |sum, bin| together(sum, *bin)).0);
        Extent { min: a.min.fast_max(b.min), max: a.max.fast_min(b.max) }.bounds().half_area()
    }
}

#[inline(always)]
fn together(a: Bin, b: Bin) -> Bin {
    (a.0.union(b.0.min, b.0.max), a.1 + b.1)
}
