//! Collapsing the binary tree: of all eight-wide trees that keep its order, the cheapest.
//!
//! For every subtree and every number of children i, the least cost of hanging it under a node as at most i
//! children is found bottom up (dynamic programming as in Ylitie, Karras and Laine, "Efficient Incoherent Ray
//! Traversal on GPUs Through Compressed Wide BVHs", HPG 2017).

use std::ops::Range;

use super::super::sphere::SphereData;
use super::super::triangle::BLOCK;
use super::super::{Bounds, Child, Node, WIDTH};
use super::Primitives;

/// Expected time of a node and of a leaf's block or sphere, by measurement.
const NODE_COST: f32 = 1.0;
const BLOCK_COST: f32 = 0.4;
const SPHERE_COST: f32 = 0.15;
/// Most blocks or spheres of a leaf.
const LEAF_BLOCKS: usize = 4;
const LEAF_SPHERES: usize = 4;

/// A binary tree with what it costs to collapse it.
pub(super) struct Tree {
    bounds: Bounds,
    /// The first of its references.
    first: u32,
    triangles: u32,
    spheres: u32,
    /// The least cost as at most 1 to 7 children.
    costs: [f32; WIDTH - 1],
    /// How many children the left part gets where that many are allowed in all: 1 to 8.
    lefts: [u8; WIDTH],
    /// Whether as one child it is a leaf.
    is_leaf: bool,
    children: Option<Box<[Tree; 2]>>,
}

/// `lefts` says that fewer children are as good.
const FEWER: u8 = 0;

impl Tree {
    /// A range that is not split.
    pub(super) fn leaf(bounds: Bounds, first: usize, [triangles, spheres]: [usize; 2]) -> Self {
        let mut tree = Self {
            bounds,
            first: first as u32,
            triangles: triangles as u32,
            spheres: spheres as u32,
            costs: [0.0; WIDTH - 1],
            lefts: [FEWER; WIDTH],
            is_leaf: true,
            children: None,
        };
        tree.costs = [tree.leaf_cost(); WIDTH - 1];
        tree
    }

    /// Two subtrees, the first of which has the lower references.
    pub(super) fn inner(bounds: Bounds, children: [Tree; 2]) -> Self {
        let [a, b] = &children;
        let mut tree = Self {
            bounds,
            first: a.first,
            triangles: a.triangles + b.triangles,
            spheres: a.spheres + b.spheres,
            costs: [f32::INFINITY; WIDTH - 1],
            lefts: [FEWER; WIDTH],
            is_leaf: false,
            children: None,
        };
        let distribute = |among: usize| {
            (1..among)
                .map(|left| (a.costs[left - 1] + b.costs[among - left - 1], left as u8))
                .min_by(|x, y| x.0.total_cmp(&y.0))
                .unwrap_or((f32::INFINITY, FEWER))
        };
        let (inside, left) = distribute(WIDTH);
        tree.lefts[WIDTH - 1] = left;
        let (as_node, as_leaf) = (inside + bounds.half_area() * NODE_COST, tree.leaf_cost());
        tree.is_leaf = as_leaf <= as_node;
        tree.costs[0] = as_leaf.min(as_node);
        for among in 2..WIDTH {
            let (cost, left) = distribute(among);
            let fewer = tree.costs[among - 2];
            (tree.costs[among - 1], tree.lefts[among - 1]) =
                if cost < fewer { (cost, left) } else { (fewer, FEWER) };
        }
        tree.children = Some(Box::new(children));
        tree
    }

    /// The cost as a leaf; infinite if it cannot be one.
    fn leaf_cost(&self) -> f32 {
        let (blocks, spheres) = ((self.triangles as usize).div_ceil(BLOCK), self.spheres as usize);
        if blocks > LEAF_BLOCKS || spheres > LEAF_SPHERES || (blocks > 0 && spheres > 0) {
            return f32::INFINITY;
        }
        self.bounds.half_area() * (blocks as f32 * BLOCK_COST + spheres as f32 * SPHERE_COST)
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

/// The flat tree as it grows.
pub(super) struct Flat<'a> {
    pub nodes: Vec<Node>,
    /// The triangles of each block, as a range of `ids`.
    pub blocks: Vec<Range<u32>>,
    pub spheres: Vec<(SphereData, u32)>,
    ids: &'a [u32],
    primitives: &'a Primitives<'a>,
}

impl<'a> Flat<'a> {
    pub(super) fn new(ids: &'a [u32], primitives: &'a Primitives<'a>) -> Self {
        Self { nodes: Vec::new(), blocks: Vec::new(), spheres: Vec::new(), ids, primitives }
    }

    /// Adds everything; returns where rays begin.
    pub(super) fn root(&mut self, tree: &Tree) -> Child {
        if tree.is_leaf {
            // A box around it keeps rays away from it.
            self.nodes.push(EMPTY_NODE);
            let child = self.child(tree);
            set_child(&mut self.nodes[0], 0, tree.bounds, child);
            return Child::node(0);
        }
        self.inner(tree)
    }

    fn child(&mut self, tree: &Tree) -> Child {
        if !tree.is_leaf {
            return self.inner(tree);
        }
        let end = tree.first + tree.triangles + tree.spheres;
        if tree.spheres > 0 {
            let start = self.spheres.len();
            let ids = &self.ids[tree.first as usize..end as usize];
            let first_sphere = self.primitives.triangles.len();
            self.spheres
                .extend(ids.iter().map(|id| (self.primitives.spheres[*id as usize - first_sphere], *id)));
            return Child::leaf(start, ids.len(), true);
        }
        let start = self.blocks.len();
        let ranges = (tree.first..end).step_by(BLOCK).map(|i| i..(i + BLOCK as u32).min(end));
        self.blocks.extend(ranges);
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
        roots.sort_by(|a, b| b.bounds.half_area().total_cmp(&a.bounds.half_area()));
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
};

fn set_child(node: &mut Node, lane: usize, bounds: Bounds, child: Child) {
    for axis in 0..3 {
        node.bounds[axis][lane] = bounds.min[axis];
        node.bounds[axis + 3][lane] = bounds.max[axis];
    }
    node.children[lane] = child;
}
