//! The ray-intersection tree: an eight-wide bounding volume hierarchy over triangles and spheres.
//!
//! The tree is built by binned surface-area heuristic (`build`) and walked by `traverse`, eight boxes or
//! triangles at a time: with AVX-512VL or AVX2 where the CPU has it, else by halves. What a ray hits depends neither on the
//! CPU nor on the shape of the tree: boxes are conservative, no operation is fused, and of two surfaces at the
//! same distance the one with the lower id is hit. Groups have trees of their own ([`Instances`]).

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod build;
mod instance;
mod lanes;
pub(crate) mod pages;
mod ray;
mod sphere;
mod traverse;
mod triangle;

use bytemuck::{Pod, Zeroable};
use caustica_math::Vec3;

pub use instance::{Instance, Instances};
use pages::Pages;
pub use sphere::SphereData;
use triangle::TriangleBlock;

/// A ray: the points `origin + t·direction` for t in (0, `t_max`]. The direction may have any length.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vec3,
    /// Where it goes.
    pub direction: Vec3,
    /// Where it ends, in units of the direction's length.
    pub t_max: f32,
}

impl Ray {
    /// The ray that ends at a point.
    #[inline]
    pub fn between(from: Vec3, to: Vec3) -> Self {
        Self { origin: from, direction: to - from, t_max: 1.0 }
    }
}

/// What a ray hit first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance, in units of the direction's length.
    pub t: f32,
    /// The primitive's id: triangles come first, then spheres. In an instance it is the id in the group.
    pub primitive: u32,
    /// The number of the instance in which it lies; [`Hit::NO_INSTANCE`] if in none.
    pub instance: u32,
    /// Barycentric coordinate of the triangle's second corner (0 on a sphere).
    pub b1: f32,
    /// Barycentric coordinate of the triangle's third corner (0 on a sphere).
    pub b2: f32,
    /// The triangle's corners (zero on a sphere): they are at hand when it is hit, and far away later.
    pub corners: [Vec3; 3],
}

impl Hit {
    /// No instance.
    pub const NO_INSTANCE: u32 = u32::MAX;

    /// Of a sphere of that id at that distance.
    fn of_sphere((t, primitive): (f32, u32)) -> Self {
        let instance = Self::NO_INSTANCE;
        Self { t, primitive, instance, b1: 0.0, b2: 0.0, corners: [Vec3::ZERO; 3] }
    }
}

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower corner.
    pub min: Vec3,
    /// Upper corner.
    pub max: Vec3,
}

impl Bounds {
    /// The box that contains nothing.
    pub const EMPTY: Self = Self { min: Vec3::splat(f32::INFINITY), max: Vec3::splat(f32::NEG_INFINITY) };

    /// The smallest box around this one and a point.
    #[must_use]
    pub fn with(self, p: Vec3) -> Self {
        Self { min: self.min.min(p), max: self.max.max(p) }
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, o: Self) -> Self {
        Self { min: self.min.min(o.min), max: self.max.max(o.max) }
    }

    /// Half the surface area; zero if empty.
    pub fn half_area(&self) -> f32 {
        let d = (self.max - self.min).max(Vec3::ZERO);
        d.x * d.y + d.y * d.z + d.z * d.x
    }

    /// Whether it contains nothing.
    pub fn is_empty(&self) -> bool {
        self.min.x > self.max.x
    }

    /// The centre.
    pub fn center(&self) -> Vec3 {
        self.min * 0.5 + self.max * 0.5
    }
}

/// An inner node: the boxes of its children, one lane each, and what they are.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C, align(64))]
struct Node {
    /// Lower x, y, z, then upper x, y, z.
    bounds: [[f32; WIDTH]; 6],
    /// The largest last.
    children: [Child; WIDTH],
    padding: [u32; WIDTH],
}

/// Children of a node.
const WIDTH: usize = 8;

/// A packed reference to a node or a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(transparent)]
struct Child(u32);

impl Child {
    /// A leaf with nothing in it.
    const NONE: Self = Self(Self::LEAF);
    const LEAF: u32 = 1 << 31;
    const SPHERES: u32 = 1 << 30;
    const COUNT_SHIFT: u32 = 27;
    const INDEX: u32 = (1 << Self::COUNT_SHIFT) - 1;

    fn node(index: usize) -> Self {
        debug_assert!(index < Self::LEAF as usize);
        Self(index as u32)
    }

    /// An instance: what is left to it is a leaf of no spheres.
    fn instance(index: usize) -> Self {
        debug_assert!(index <= Self::INDEX as usize);
        Self(Self::LEAF | Self::SPHERES | index as u32)
    }

    /// The number of the instance, if a leaf that [holds spheres](Child::holds_spheres) is one.
    #[inline]
    fn as_instance(self) -> Option<usize> {
        (self.range().is_empty()).then_some((self.0 & Self::INDEX) as usize)
    }

    /// `count` (1 to 7) triangle blocks or spheres from `first` on.
    fn leaf(first: usize, count: usize, spheres: bool) -> Self {
        debug_assert!((1..=7).contains(&count) && first <= Self::INDEX as usize);
        let kind = if spheres { Self::SPHERES } else { 0 };
        Self(Self::LEAF | kind | (count as u32) << Self::COUNT_SHIFT | first as u32)
    }

    #[inline]
    fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    /// Whether it has spheres in it, or an instance.
    #[inline]
    fn holds_spheres(self) -> bool {
        self.0 & Self::SPHERES != 0
    }

    #[inline]
    fn range(self) -> std::ops::Range<usize> {
        let first = (self.0 & Self::INDEX) as usize;
        first..first + ((self.0 >> Self::COUNT_SHIFT) & 7) as usize
    }
}

/// The most triangles, spheres and instances that a tree can refer to.
pub const MAX_PRIMITIVES: usize = Child::INDEX as usize;

/// How much care the tree is built with. What rays hit does not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TreeQuality {
    /// Every triangle is in one place.
    #[default]
    Fast,
    /// Large triangles may be in several, each with a smaller box: at most three in ten more references. It takes
    /// longer to build, and pays where long triangles lie across the axes; in a room of small even ones rays take up
    /// to a quarter longer.
    Spatial,
}

/// What code walks a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kernels {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Kernels {
    /// All that this CPU can run, the best first.
    fn available() -> impl Iterator<Item = Self> {
        #[cfg(target_arch = "x86_64")]
        let special =
            [avx512::is_available().then_some(Self::Avx512), avx2::is_available().then_some(Self::Avx2)];
        #[cfg(not(target_arch = "x86_64"))]
        let special: [Option<Self>; 0] = [];
        special.into_iter().flatten().chain([Self::Portable])
    }

    fn best() -> Self {
        Self::available().next().unwrap_or(Self::Portable)
    }
}

/// The tree.
#[derive(Debug)]
pub struct Bvh {
    nodes: Pages<Node>,
    blocks: Pages<TriangleBlock>,
    spheres: Vec<(SphereData, u32)>,
    instances: Instances,
    /// The id of the first of them.
    first_instance: u32,
    /// Where every ray begins: the first node, or nothing.
    root: Child,
    bounds: Bounds,
    kernels: Kernels,
    /// Whether it is larger than what CPUs keep near by.
    is_large: bool,
}

impl Bvh {
    /// Builds the tree over `triangles`, given by their corners as indices of `positions`, and `spheres`.
    /// Ids count the triangles first, then the spheres.
    pub fn new(positions: &[Vec3], triangles: &[[u32; 3]], spheres: &[SphereData]) -> Self {
        Self::with_quality(positions, triangles, spheres, TreeQuality::Fast)
    }

    /// The same, with a choice of how much care is taken.
    pub fn with_quality(
        positions: &[Vec3],
        triangles: &[[u32; 3]],
        spheres: &[SphereData],
        quality: TreeQuality,
    ) -> Self {
        let primitives = build::Primitives { positions, triangles, spheres, instances: &[] };
        build::build(&primitives, quality)
    }

    /// The same with instances; their ids follow those of the spheres.
    pub fn with_instances(
        (positions, triangles): (&[Vec3], &[[u32; 3]]),
        spheres: &[SphereData],
        instances: Instances,
        quality: TreeQuality,
    ) -> Self {
        let primitives = build::Primitives { positions, triangles, spheres, instances: instances.boxes() };
        let tree = build::build(&primitives, quality);
        Self { instances, ..tree }
    }

    /// The same tree, walked as on CPUs without AVX2. Rays hit the same things; tests see that they do.
    #[must_use]
    pub fn portable(self) -> Self {
        Self { kernels: Kernels::Portable, instances: self.instances.portable(), ..self }
    }

    /// The box around everything.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Some boxes that together are around everything.
    fn parts(&self) -> impl Iterator<Item = Bounds> {
        let corner =
            |rows: &[[f32; WIDTH]], lane: usize| Vec3::new(rows[0][lane], rows[1][lane], rows[2][lane]);
        let lanes = self.nodes.first().into_iter().flat_map(|node| (0..WIDTH).map(move |lane| (node, lane)));
        lanes
            .map(move |(n, lane)| Bounds {
                min: corner(&n.bounds[..3], lane),
                max: corner(&n.bounds[3..], lane),
            })
            .filter(|b| !b.is_empty())
    }

    /// The box around each instance.
    pub(crate) fn instance_boxes(&self) -> &[Bounds] {
        self.instances.boxes()
    }

    /// How many bytes it takes, its groups with it.
    pub fn memory(&self) -> usize {
        size_of_val(&*self.nodes)
            + size_of_val(&*self.blocks)
            + size_of_val(&*self.spheres)
            + self.instances.memory()
    }

    /// The first hit along the ray.
    #[inline]
    #[cfg_attr(target_arch = "x86_64", expect(unsafe_code))]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        match self.kernels {
            // SAFETY: the CPU has what the function needs.
            #[cfg(target_arch = "x86_64")]
            Kernels::Avx512 => unsafe { avx512::closest(self, ray) },
            // SAFETY: the CPU has what the function needs.
            #[cfg(target_arch = "x86_64")]
            Kernels::Avx2 => unsafe { avx2::closest(self, ray) },
            Kernels::Portable => traverse::closest(self, ray),
        }
    }

    /// Whether the ray hits anything.
    #[inline]
    #[cfg_attr(target_arch = "x86_64", expect(unsafe_code))]
    pub fn occluded(&self, ray: &Ray) -> bool {
        match self.kernels {
            // SAFETY: the CPU has what the function needs.
            #[cfg(target_arch = "x86_64")]
            Kernels::Avx512 => unsafe { avx512::occluded(self, ray) },
            // SAFETY: the CPU has what the function needs.
            #[cfg(target_arch = "x86_64")]
            Kernels::Avx2 => unsafe { avx2::occluded(self, ray) },
            Kernels::Portable => traverse::occluded(self, ray),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use caustica_math::{SampleStream, StreamId};

    /// A heap of triangles, large and small, and spheres.
    fn heap(s: &mut SampleStream) -> Bvh {
        let mut point = |scale: f32| {
            let [x, y] = s.next_2d();
            (Vec3::new(x, y, s.next_1d()) - Vec3::splat(0.5)) * scale
        };
        let (mut positions, mut spheres) = (Vec::new(), Vec::new());
        for i in 0..3000 {
            let at = point(4.0);
            positions.extend([(); 3].map(|()| at + point(if i % 10 == 0 { 2.0 } else { 0.2 })));
            if i % 20 == 0 {
                spheres.push(SphereData { center: point(4.0), radius: 0.1 });
            }
        }
        let triangles: Vec<_> = (0..3000).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        Bvh::new(&positions, &triangles, &spheres)
    }

    /// All kinds of lanes give the same bits.
    #[test]
    fn hits_do_not_depend_on_the_cpu() {
        let mut s = SampleStream::new(StreamId { seed: 1, pixel: 2, sample: 3, walk: 4 });
        let mut tree = heap(&mut s);
        let all: Vec<_> = Kernels::available().collect();
        if all.len() < 2 {
            println!("skipped: this CPU has one kind only");
            return;
        }
        let (mut hits, rays) = (0, 20_000);
        for i in 0..rays {
            let mut coordinates = [0.0; 6].map(|_: f32| s.next_1d() * 6.0 - 3.0);
            if i % 5 == 0 {
                coordinates[3 + i % 3] = if i % 2 == 0 { 0.0 } else { -0.0 };
            }
            let [x, y, z, u, v, w] = coordinates;
            let t_max = if i % 7 == 0 { 1.0 } else { f32::INFINITY };
            let ray = Ray { origin: Vec3::new(x, y, z), direction: Vec3::new(u, v, w), t_max };
            let found = all.iter().map(|kernels| {
                tree.kernels = *kernels;
                (tree.closest(&ray), tree.occluded(&ray))
            });
            let found: Vec<_> = found.collect();
            assert!(found.iter().all(|f| *f == found[0]), "{ray:?}: {found:?}");
            hits += usize::from(found[0].1);
        }
        assert!(hits > rays / 4 && hits < rays, "{hits} of {rays} rays hit");
    }
}
