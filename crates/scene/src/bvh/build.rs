//! Construction: a binary tree by binned surface-area heuristic, in parallel, then collapsed to four
//! children a node.

use caustica_math::Vec3;

use super::sphere::SphereData;
use super::traverse::stack_for;
use super::triangle::TriangleBlock;
use super::{Bounds, Bvh, Child, Node};

/// The deepest that a four-wide tree gets. Past [`SAH_DEPTH`] binary levels the ranges are halved at the
/// median, which adds at most 27 more.
pub(super) const MAX_DEPTH: usize = SAH_DEPTH + 28;
const SAH_DEPTH: usize = 28;
const BINS: usize = 16;
const LEAF_SIZE: usize = 4;
const PARALLEL_SIZE: usize = 4096;

#[derive(Clone, Copy)]
struct Reference {
    bounds: Bounds,
    id: u32,
}

impl Reference {
    /// Twice the centre, along one axis.
    fn center2(&self, axis: usize) -> f32 {
        self.bounds.min[axis] + self.bounds.max[axis]
    }
}

enum Tree {
    Leaf { bounds: Bounds, first: usize, count: usize },
    Inner { bounds: Bounds, children: Box<[Tree; 2]> },
}

impl Tree {
    fn bounds(&self) -> Bounds {
        match self {
            Tree::Leaf { bounds, .. } | Tree::Inner { bounds, .. } => *bounds,
        }
    }
}

pub(super) fn build(positions: &[Vec3], triangles: &[[u32; 3]], spheres: &[SphereData]) -> Bvh {
    let corners = |id: u32| triangles[id as usize].map(|v| positions[v as usize]);
    let mut references: Vec<Reference> = (0..triangles.len() as u32)
        .map(|id| Reference { bounds: corners(id).into_iter().fold(Bounds::EMPTY, Bounds::with), id })
        .collect();
    references.extend(
        spheres.iter().zip(triangles.len() as u32..).map(|(s, id)| Reference { bounds: s.bounds(), id }),
    );
    let bounds = references.iter().fold(Bounds::EMPTY, |b, r| b.union(r.bounds));
    let mut flat = Flat {
        bvh: Bvh { nodes: Vec::new(), blocks: Vec::new(), spheres: Vec::new(), bounds, stack: 0 },
        references: Vec::new(),
        corners: &corners,
        spheres,
        first_sphere: triangles.len(),
    };
    if !references.is_empty() {
        let tree = split(&mut references, 0, 0, triangles.len());
        flat.references = references;
        flat.root(&tree);
        flat.bvh.stack = stack_for(levels(&flat.bvh.nodes, Child::node(0)));
    }
    flat.bvh
}

/// How many nodes lie on the longest way from `child` to a leaf.
fn levels(nodes: &[Node], child: Child) -> usize {
    if child.is_leaf() {
        return 0;
    }
    let below = nodes[child.0 as usize].children.iter().map(|c| levels(nodes, *c)).max();
    1 + below.unwrap_or(0)
}

fn split(references: &mut [Reference], offset: usize, depth: usize, first_sphere: usize) -> Tree {
    let bounds = references.iter().fold(Bounds::EMPTY, |b, r| b.union(r.bounds));
    let count = references.len();
    let is_sphere = |r: &Reference| r.id as usize >= first_sphere;
    let mixed = references.iter().any(is_sphere) && !references.iter().all(is_sphere);
    if count <= LEAF_SIZE && !mixed {
        return Tree::Leaf { bounds, first: offset, count };
    }
    let middle = if count <= LEAF_SIZE {
        partition(references, |r| !is_sphere(r))
    } else if depth < SAH_DEPTH {
        sah_middle(references).unwrap_or(count / 2)
    } else {
        median(references, &bounds)
    };
    let (left, right) = references.split_at_mut(middle);
    let (a, b) = if count > PARALLEL_SIZE {
        rayon::join(
            || split(left, offset, depth + 1, first_sphere),
            || split(right, offset + middle, depth + 1, first_sphere),
        )
    } else {
        (split(left, offset, depth + 1, first_sphere), split(right, offset + middle, depth + 1, first_sphere))
    };
    Tree::Inner { bounds, children: Box::new([a, b]) }
}

/// Halves the range at the median of the widest axis.
fn median(references: &mut [Reference], bounds: &Bounds) -> usize {
    let d = bounds.max - bounds.min;
    let axis = (0..3).max_by(|a, b| d[*a].total_cmp(&d[*b])).unwrap_or(0);
    let middle = references.len() / 2;
    references.select_nth_unstable_by(middle, |a, b| {
        a.center2(axis).total_cmp(&b.center2(axis)).then(a.id.cmp(&b.id))
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

/// Partitions by the cheapest of the planes between bins; `None` if all centres coincide.
fn sah_middle(references: &mut [Reference]) -> Option<usize> {
    let mut low = [f32::INFINITY; 3];
    let mut high = [f32::NEG_INFINITY; 3];
    for r in references.iter() {
        for axis in 0..3 {
            low[axis] = low[axis].min(r.center2(axis));
            high[axis] = high[axis].max(r.center2(axis));
        }
    }
    let mut best: Option<(f32, usize, usize)> = None;
    let bin = |r: &Reference, axis: usize| {
        let x = (r.center2(axis) - low[axis]) / (high[axis] - low[axis]);
        ((x * BINS as f32) as usize).min(BINS - 1)
    };
    for axis in 0..3 {
        if high[axis] <= low[axis] || !(high[axis] - low[axis]).is_finite() {
            continue;
        }
        let mut bins = [(Bounds::EMPTY, 0usize); BINS];
        for r in references.iter() {
            let b = &mut bins[bin(r, axis)];
            *b = (b.0.union(r.bounds), b.1 + 1);
        }
        let mut right = [(0.0_f32, 0usize); BINS];
        let mut sum = (Bounds::EMPTY, 0);
        for i in (1..BINS).rev() {
            sum = (sum.0.union(bins[i].0), sum.1 + bins[i].1);
            right[i] = (sum.0.half_area(), sum.1);
        }
        let mut left = (Bounds::EMPTY, 0);
        for i in 0..BINS - 1 {
            left = (left.0.union(bins[i].0), left.1 + bins[i].1);
            let (area, count) = right[i + 1];
            // Whole blocks of four are what a leaf costs.
            let blocks = |n: usize| n.div_ceil(4) as f32;
            let cost = left.0.half_area() * blocks(left.1) + area * blocks(count);
            if left.1 > 0 && count > 0 && best.is_none_or(|b| cost < b.0) {
                best = Some((cost, axis, i));
            }
        }
    }
    let (_, axis, last) = best?;
    Some(partition(references, |r| bin(r, axis) <= last))
}

/// Turns the binary tree into the flat four-wide one.
struct Flat<'a, F> {
    bvh: Bvh,
    references: Vec<Reference>,
    corners: &'a F,
    spheres: &'a [SphereData],
    first_sphere: usize,
}

impl<F: Fn(u32) -> [Vec3; 3]> Flat<'_, F> {
    fn root(&mut self, tree: &Tree) {
        match tree {
            Tree::Inner { .. } => {
                self.inner(tree);
            }
            Tree::Leaf { bounds, .. } => {
                let mut node = EMPTY_NODE;
                set_child(&mut node, 0, *bounds, self.child(tree));
                self.bvh.nodes.push(node);
            }
        }
    }

    fn child(&mut self, tree: &Tree) -> Child {
        let Tree::Leaf { first, count, .. } = *tree else {
            return Child::node(self.inner(tree));
        };
        let leaf = &self.references[first..first + count];
        if leaf[0].id as usize >= self.first_sphere {
            let start = self.bvh.spheres.len();
            self.bvh
                .spheres
                .extend(leaf.iter().map(|r| (self.spheres[r.id as usize - self.first_sphere], r.id)));
            Child::leaf(start, count, true)
        } else {
            let triangles: Vec<_> = leaf.iter().map(|r| (r.id, (self.corners)(r.id))).collect();
            let start = self.bvh.blocks.len();
            self.bvh.blocks.extend(triangles.chunks(4).map(TriangleBlock::new));
            Child::leaf(start, self.bvh.blocks.len() - start, false)
        }
    }

    /// Adds a node whose children are the up to four largest descendants; returns its index.
    fn inner(&mut self, tree: &Tree) -> usize {
        let mut open: Vec<&Tree> = vec![tree];
        while open.len() < 4 {
            let largest = open
                .iter()
                .enumerate()
                .filter(|(_, t)| matches!(t, Tree::Inner { .. }))
                .max_by(|a, b| a.1.bounds().half_area().total_cmp(&b.1.bounds().half_area()))
                .map(|(i, _)| i);
            let Some(i) = largest else { break };
            if let Tree::Inner { children, .. } = open.swap_remove(i) {
                open.extend(children.iter());
            }
        }
        let index = self.bvh.nodes.len();
        self.bvh.nodes.push(EMPTY_NODE);
        let mut node = EMPTY_NODE;
        for (lane, child) in open.into_iter().enumerate() {
            let packed = self.child(child);
            set_child(&mut node, lane, child.bounds(), packed);
        }
        self.bvh.nodes[index] = node;
        index
    }
}

const EMPTY_NODE: Node = Node {
    // An inverted box is never entered: its near plane is beyond every far one.
    bounds: [
        [f32::INFINITY; 4],
        [f32::INFINITY; 4],
        [f32::INFINITY; 4],
        [f32::NEG_INFINITY; 4],
        [f32::NEG_INFINITY; 4],
        [f32::NEG_INFINITY; 4],
    ],
    children: [Child::NONE; 4],
};

fn set_child(node: &mut Node, lane: usize, bounds: Bounds, child: Child) {
    for axis in 0..3 {
        node.bounds[axis][lane] = bounds.min[axis];
        node.bounds[axis + 3][lane] = bounds.max[axis];
    }
    node.children[lane] = child;
}
