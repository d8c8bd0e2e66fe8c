//! The binary tree, top down and in parallel.

use wide::f32x4;

use super::super::Bounds;
use super::Primitives;
use super::collapse::Tree;
use super::reference::{Extent, Extents, Reference};

/// Levels that are split by the surface-area heuristic.
pub(super) const SAH_DEPTH: usize = 48;
/// Ranges of at most as many are not split further.
const LEAF_SIZE: usize = 4;
const PARALLEL_SIZE: usize = 4096;

/// The tree over `references`, which are sorted into its order; the first of them is number `offset` of all.
pub(super) fn split(
    references: &mut [Reference],
    offset: usize,
    depth: usize,
    primitives: &Primitives<'_>,
) -> Tree {
    let count = references.len();
    let is_sphere = |r: &Reference| primitives.is_sphere(r.id());
    let extents = Extents::of(references);
    let bounds = extents.boxes.bounds();
    let spheres =
        if primitives.spheres.is_empty() { 0 } else { references.iter().filter(|r| is_sphere(r)).count() };
    let mixed = spheres != 0 && spheres != count;
    if count <= LEAF_SIZE && !mixed {
        return Tree::leaf(bounds, offset, [count - spheres, spheres]);
    }
    let middle = if count <= LEAF_SIZE {
        partition(references, |r| !is_sphere(r))
    } else if depth < SAH_DEPTH {
        sah_middle(references, &extents.centers2).unwrap_or(count / 2)
    } else {
        median(references, &bounds)
    };
    let (left, right) = references.split_at_mut(middle);
    let build_left = |l: &mut [Reference]| split(l, offset, depth + 1, primitives);
    let build_right = |r: &mut [Reference]| split(r, offset + middle, depth + 1, primitives);
    let children = if count > PARALLEL_SIZE {
        let (a, b) = rayon::join(|| build_left(left), || build_right(right));
        [a, b]
    } else {
        [build_left(left), build_right(right)]
    };
    Tree::inner(bounds, children)
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
            let cost = sum.0.half_area() * sum.1 as f32 + area * beyond as f32;
            if best.is_none_or(|b| cost < b.0) {
                best = Some((cost, i));
            }
        }
        best
    }

    /// Partitions by the cheapest of the planes between bins; `None` if all centres coincide.
    fn partition(references: &mut [Reference], centers2: &Extent) -> Option<usize> {
        let bins = Self::new(references, centers2);
        let mut best: Option<(f32, usize, usize)> = None;
        for axis in 0..3 {
            if bins.scale.to_array()[axis] > 0.0
                && let Some((cost, last)) = bins.best_plane(axis)
                && best.is_none_or(|b| cost < b.0)
            {
                best = Some((cost, axis, last));
            }
        }
        let (_, axis, last) = best?;
        Some(partition(references, |r| bins.place(r)[axis] <= last))
    }
}

#[inline(always)]
fn together(a: Bin, b: Bin) -> Bin {
    (a.0.union(b.0.min, b.0.max), a.1 + b.1)
}

/// Partitions by the surface-area heuristic, with as many bins as the number of references is worth.
fn sah_middle(references: &mut [Reference], centers2: &Extent) -> Option<usize> {
    match references.len() {
        0..16 => Bins::<8>::partition(references, centers2),
        16..64 => Bins::<16>::partition(references, centers2),
        _ => Bins::<32>::partition(references, centers2),
    }
}
