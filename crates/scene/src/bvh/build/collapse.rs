//! Collapsing the binary tree: of all eight-wide trees that keep its order, the cheapest.
//!
//! For every subtree and every number of children i, the least cost of hanging it under a node as at most i
//! children is found bottom up (dynamic programming as in Ylitie, Karras and Laine, "Efficient Incoherent Ray
//! Traversal on GPUs Through Compressed Wide BVHs", HPG 2017).

use super::super::sphere::SphereData;
use super::super::triangle::BLOCK;
use super::super::{Bounds, Child, Node, WIDTH};
use super::Primitives;
use super::reference::Reference;

/// Expected time of a node and of a leaf's block or sphere, by measurement.
const NODE_COST: f32 = 1.0;
const BLOCK_COST: f32 = 0.25;
const SPHERE_COST: f32 = 0.15;
/// Of an instance: of the way into it, and some nodes there.
const INSTANCE_COST: f32 = 4.0;
/// Most blocks or spheres of a leaf.
const LEAF_BLOCKS: usize = 4;
const LEAF_SPHERES: usize = 4;

/// Most distinct triangles that are counted in a search for leaves.
const COUNTED: usize = 2 * LEAF_BLOCKS * BLOCK;

/// The least cost of a subtree as at most 1 to 7 children.
pub(super) type Costs = [f32; WIDTH - 1];

/// A binary tree with how to collapse it.
pub(super) struct Tree {
    bounds: Bounds,
    /// The first of its references, if it has no children.
    first: u32,
    /// Triangles and spheres, or [`u16::MAX`] of them if there are more; or [`INSTANCE`].
    counts: [u16; 2],
    /// How many children the left part gets where that many are allowed in all: 1 to 8. For one child, whether it
    /// is no leaf.
    lefts: [u8; WIDTH],
    children: Option<Box<[Tree; 2]>>,
}

/// The counts of one instance, of which every leaf has a single one.
pub(super) const INSTANCE: [usize; 2] = [0, 1 << 15];

/// `lefts` says that fewer children are as good; or that one is a leaf.
const FEWER: u8 = 0;
const NO_LEAF: u8 = 1;

impl Tree {
    /// A range that is not split.
    pub(super) fn leaf(bounds: Bounds, first: usize, counts: [usize; 2]) -> (Self, Costs) {
        let tree = Self {
            bounds,
            first: first as u32,
            counts: counts.map(|n| n as u16),
            lefts: [FEWER; WIDTH],
            children: None,
        };
        let cost = tree.leaf_cost();
        (tree, [cost; WIDTH - 1])
    }

    /// Two subtrees, the first of which has the lower references. If they may share triangles, `ids` tells them.
    pub(super) fn inner(
        bounds: Bounds,
        ((a, cost_a), (b, cost_b)): ((Tree, Costs), (Tree, Costs)),
        ids: Option<&impl Fn(u32) -> u32>,
    ) -> (Self, Costs) {
        let counts = [0, 1].map(|i| a.counts[i].saturating_add(b.counts[i]));
        let children = Some(Box::new([a, b]));
        let mut tree = Self { bounds, first: 0, counts, lefts: [FEWER; WIDTH], children };
        if let Some(ids) = ids
            && (2..=COUNTED).contains(&(counts[0] as usize))
            && counts[1] == 0
        {
            let mut found = Leaf::new();
            tree.gather(ids, &mut found);
            tree.counts[0] = found.count as u16;
        }
        let distribute = |among: usize| {
            (1..among)
                .map(|left| (cost_a[left - 1] + cost_b[among - left - 1], left as u8))
                .min_by(|x, y| x.0.total_cmp(&y.0))
                .unwrap_or((f32::INFINITY, FEWER))
        };
        let (inside, left) = distribute(WIDTH);
        tree.lefts[WIDTH - 1] = left;
        let (as_node, as_leaf) = (inside + bounds.half_area() * NODE_COST, tree.leaf_cost());
        tree.lefts[0] = if as_leaf <= as_node { FEWER } else { NO_LEAF };
        let mut costs = [as_leaf.min(as_node); WIDTH - 1];
        for among in 2..WIDTH {
            let (cost, left) = distribute(among);
            let fewer = costs[among - 2];
            (costs[among - 1], tree.lefts[among - 1]) =
                if cost < fewer { (cost, left) } else { (fewer, FEWER) };
        }
        (tree, costs)
    }

    /// Whether as one child it is a leaf.
    fn is_leaf(&self) -> bool {
        self.lefts[0] != NO_LEAF
    }

    /// The cost as a leaf; infinite if it cannot be one.
    fn leaf_cost(&self) -> f32 {
        let [triangles, spheres] = self.counts.map(usize::from);
        if [triangles, spheres] == INSTANCE && self.children.is_none() {
            return self.bounds.half_area() * INSTANCE_COST;
        }
        let blocks = triangles.div_ceil(BLOCK);
        if blocks > LEAF_BLOCKS || spheres > LEAF_SPHERES || (blocks > 0 && spheres > 0) {
            return f32::INFINITY;
        }
        self.bounds.half_area() * (blocks as f32 * BLOCK_COST + spheres as f32 * SPHERE_COST)
    }

    /// The primitives in it, in order, each once; at most [`COUNTED`].
    fn gather(&self, ids: &impl Fn(u32) -> u32, out: &mut Leaf) {
        if let Some(children) = &self.children {
            children.iter().for_each(|c| c.gather(ids, out));
            return;
        }
        let count = match self.counts.map(usize::from) {
            INSTANCE => 1,
            [triangles, spheres] => (triangles + spheres) as u32,
        };
        (self.first..self.first + count).for_each(|i| out.add(ids(i)));
    }

    /// Appends what stands for this subtree as at most `among` children.
    fn roots<'a>(&'a self, among: usize, out: &mut Vec<&'a Tree>) {
        let among = (1..=among).rev().find(|n| *n == 1 || self.lefts[n - 1] != FEWER).unwrap_or(1);
        match &self.children {
            Some(children) if among > 1 => {
                let left = self.lefts[among - 1] as usize;
                children[0].roots(left, out);
                children[1].roots(among - left, out);
            }
            _ => out.push(self),
        }
    }
}

/// The primitives of a leaf, or of what may become one.
struct Leaf {
    ids: [u32; COUNTED],
    count: usize,
}

impl Leaf {
    fn new() -> Self {
        Self { ids: [0; COUNTED], count: 0 }
    }

    fn add(&mut self, id: u32) {
        if !self.ids[..self.count].contains(&id) {
            self.ids[self.count] = id;
            self.count += 1;
        }
    }
}

/// The flat tree as it grows.
pub(super) struct Flat<'a> {
    pub nodes: Vec<Node>,
    /// The triangles of each block; those that are missing are [`NO_TRIANGLE`].
    pub blocks: Vec<[u32; BLOCK]>,
    pub spheres: Vec<(SphereData, u32)>,
    references: &'a [Reference],
    primitives: &'a Primitives<'a>,
}

/// No id.
pub(super) const NO_TRIANGLE: u32 = u32::MAX;

impl<'a> Flat<'a> {
    pub(super) fn new(references: &'a [Reference], primitives: &'a Primitives<'a>) -> Self {
        Self { nodes: Vec::new(), blocks: Vec::new(), spheres: Vec::new(), references, primitives }
    }

    /// Adds everything; returns where rays begin.
    pub(super) fn root(&mut self, tree: &Tree) -> Child {
        if tree.is_leaf() {
            // A box around it keeps rays away from it.
            self.nodes.push(EMPTY_NODE);
            let child = self.child(tree);
            set_child(&mut self.nodes[0], 0, tree.bounds, child);
            return Child::node(0);
        }
        self.inner(tree)
    }

    fn child(&mut self, tree: &Tree) -> Child {
        if !tree.is_leaf() {
            return self.inner(tree);
        }
        let mut leaf = Leaf::new();
        tree.gather(&|i| self.references[i as usize].id(), &mut leaf);
        let ids = &leaf.ids[..leaf.count];
        if let Some(instance) = ids.first().and_then(|id| self.primitives.instance(*id)) {
            return Child::instance(instance);
        }
        if tree.counts[1] > 0 {
            let start = self.spheres.len();
            let first_sphere = self.primitives.triangles.len();
            self.spheres
                .extend(ids.iter().map(|id| (self.primitives.spheres[*id as usize - first_sphere], *id)));
            return Child::leaf(start, ids.len(), true);
        }
        let start = self.blocks.len();
        self.blocks.extend(ids.chunks(BLOCK).map(|ids| {
            let mut block = [NO_TRIANGLE; BLOCK];
            block[..ids.len()].copy_from_slice(ids);
            block
        }));
        Child::leaf(start, self.blocks.len() - start, false)
    }

    /// Adds a node; returns it.
    fn inner(&mut self, tree: &Tree) -> Child {
        let mut roots = Vec::with_capacity(WIDTH);
        if let Some(children) = &tree.children {
            let left = tree.lefts[WIDTH - 1] as usize;
            children[0].roots(left, &mut roots);
            children[1].roots(WIDTH - left, &mut roots);
        }
        // Stable: equal ones stay in order.
        roots.sort_by(|a, b| a.bounds.half_area().total_cmp(&b.bounds.half_area()));
        let index = self.nodes.len();
        self.nodes.push(EMPTY_NODE);
        for (lane, root) in roots.into_iter().enumerate() {
            let child = self.child(root);
            set_child(&mut self.nodes[index], lane, root.bounds, child);
        }
        Child::node(index)
    }
}

const EMPTY_NODE: Node = Node {
    // An inverted box is never entered: its near plane is beyond every far one.
    bounds: [
        [f32::INFINITY; WIDTH],
        [f32::INFINITY; WIDTH],
        [f32::INFINITY; WIDTH],
        [f32::NEG_INFINITY; WIDTH],
        [f32::NEG_INFINITY; WIDTH],
        [f32::NEG_INFINITY; WIDTH],
    ],
    children: [Child::NONE; WIDTH],
    padding: [0; WIDTH],
};

fn set_child(node: &mut Node, lane: usize, bounds: Bounds, child: Child) {
    for axis in 0..3 {
        node.bounds[axis][lane] = bounds.min[axis];
        node.bounds[axis + 3][lane] = bounds.max[axis];
    }
    node.children[lane] = child;
}
