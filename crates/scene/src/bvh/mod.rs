//! The ray-intersection tree: a four-wide bounding volume hierarchy over triangles and spheres.
//!
//! The tree is built by binned surface-area heuristic (`build`) and walked by `traverse`. What a ray
//! hits does not depend on the shape of the tree: boxes are conservative, and of two surfaces at the same
//! distance the one with the lower id is hit.

mod build;
mod sphere;
mod traverse;
mod triangle;

use caustica_math::Vec3;

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

/// What a ray hit first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance, in units of the direction's length.
    pub t: f32,
    /// The primitive's id: triangles come first, then spheres.
    pub primitive: u32,
    /// Barycentric coordinate of the triangle's second corner (0 on a sphere).
    pub b1: f32,
    /// Barycentric coordinate of the triangle's third corner (0 on a sphere).
    pub b2: f32,
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
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
struct Node {
    /// Lower x, y, z, then upper x, y, z.
    bounds: [[f32; 4]; 6],
    children: [Child; 4],
}

/// A packed reference to a node or a leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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

/// The most triangles and spheres that a tree can refer to.
pub const MAX_PRIMITIVES: usize = Child::INDEX as usize;

/// The tree.
#[derive(Debug)]
pub struct Bvh {
    nodes: Vec<Node>,
    blocks: Vec<TriangleBlock>,
    spheres: Vec<(SphereData, u32)>,
    bounds: Bounds,
    /// Entries that a stack needs to walk it.
    stack: usize,
}

impl Bvh {
    /// Builds the tree over `triangles`, given by their corners as indices of `positions`, and `spheres`.
    /// Ids count the triangles first, then the spheres.
    pub fn new(positions: &[Vec3], triangles: &[[u32; 3]], spheres: &[SphereData]) -> Self {
        build::build(positions, triangles, spheres)
    }

    /// The box around everything.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// How many bytes it takes.
    pub fn memory(&self) -> usize {
        size_of_val(&*self.nodes) + size_of_val(&*self.blocks) + size_of_val(&*self.spheres)
    }

    /// The first hit along the ray.
    #[inline]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        traverse::closest(self, ray)
    }

    /// Whether the ray hits anything.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        traverse::occluded(self, ray)
    }
}
