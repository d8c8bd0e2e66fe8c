//! Construction: a binary tree by binned surface-area heuristic ([`split`]), collapsed into the cheapest
//! eight-wide one ([`collapse`]); with [`spatial`] splits if they are asked for.

mod clip;
mod collapse;
mod reference;
mod spatial;
mod split;

use caustica_math::Vec3;
use rayon::prelude::*;

use super::pages::Pages;
use super::sphere::SphereData;
use super::triangle::TriangleBlock;
use super::{Bounds, Bvh, Child, Instances, Kernels, TreeQuality};
use collapse::{Flat, NO_TRIANGLE};
use reference::{Extents, Reference};
use spatial::Spatial;
use split::{Place, Splitter};

/// The deepest that a tree gets. Past [`split::SAH_DEPTH`] binary levels the ranges are halved at the
/// median, which adds at most 27 more.
pub(super) const MAX_DEPTH: usize = split::SAH_DEPTH + 28;

/// Bytes of a tree past which what waits is asked for beforehand.
const LARGE: usize = 16 << 20;

/// What the tree is built over.
pub(super) struct Primitives<'a> {
    pub positions: &'a [Vec3],
    pub triangles: &'a [[u32; 3]],
    pub spheres: &'a [SphereData],
    /// The boxes around instances.
    pub instances: &'a [Bounds],
}

impl Primitives<'_> {
    fn corners(&self, id: u32) -> [Vec3; 3] {
        self.triangles[id as usize].map(|v| self.positions[v as usize])
    }

    fn is_triangle(&self, id: u32) -> bool {
        (id as usize) < self.triangles.len()
    }

    /// The number of the instance, if it is one.
    fn instance(&self, id: u32) -> Option<usize> {
        let index = (id as usize).checked_sub(self.triangles.len() + self.spheres.len())?;
        (index < self.instances.len()).then_some(index)
    }

    fn references(&self) -> Vec<Reference> {
        let triangle = |id: usize| {
            let id = id as u32;
            Reference::new(self.corners(id).into_iter().fold(Bounds::EMPTY, Bounds::with), id)
        };
        let mut references: Vec<_> = (0..self.triangles.len()).into_par_iter().map(triangle).collect();
        let boxes = self.spheres.iter().map(SphereData::bounds).chain(self.instances.iter().copied());
        let ids = self.triangles.len() as u32..;
        references.extend(boxes.zip(ids).map(|(bounds, id)| Reference::new(bounds, id)));
        references
    }
}

/// Builds the tree.
pub(super) fn build(primitives: &Primitives<'_>, quality: TreeQuality) -> Bvh {
    let mut references = primitives.references();
    let count = references.len();
    let extent = Extents::of(&references).boxes;
    let mut bvh = Bvh {
        nodes: Pages::zeroed(0),
        blocks: Pages::zeroed(0),
        spheres: Vec::new(),
        instances: Instances::default(),
        first_instance: (primitives.triangles.len() + primitives.spheres.len()) as u32,
        root: Child::NONE,
        bounds: extent.bounds(),
        kernels: Kernels::best(),
        is_large: false,
    };
    if references.is_empty() {
        return bvh;
    }
    let spatial = match quality {
        TreeQuality::Fast => None,
        TreeQuality::Spatial => {
            references.resize(spatial::room(count), Reference::new(Bounds::EMPTY, 0));
            Some(Spatial::new(primitives, &extent))
        }
    };
    let splitter = Splitter { primitives, spatial };
    let (tree, _) = splitter.split(&mut references, count, Place { first: 0, depth: 0 });
    let mut flat = Flat::new(&references, primitives);
    bvh.root = flat.root(&tree);
    let Flat { nodes, blocks, spheres, .. } = flat;
    // What is not needed any more makes room for the blocks.
    drop((tree, references));
    bvh.nodes = Pages::zeroed(nodes.len());
    bvh.nodes.copy_from_slice(&nodes);
    drop(nodes);
    bvh.spheres = spheres;
    bvh.blocks = Pages::zeroed(blocks.len());
    bvh.blocks.par_iter_mut().zip(blocks).for_each(|(block, ids)| {
        let used = ids.into_iter().filter(|id| *id != NO_TRIANGLE);
        *block = TriangleBlock::new(used.map(|id| (id, primitives.corners(id))));
    });
    bvh.is_large = bvh.memory() > LARGE;
    bvh
}
