//! Building the hierarchy: from the top down, by bins along all three axes.

use caustica_math::Vec3;

use super::cone::Cone;
use super::node::{Branch, Link, Node, WIDTH};
use super::{DEEPEST, Leaf, LightTree, sphere};
use crate::bvh::pages::Pages;

/// What becomes a leaf.
#[derive(Clone, Copy, Debug)]
pub struct Item {
    /// Which lamp, or part of one.
    pub leaf: Leaf,
    /// A box around it.
    pub min: Vec3,
    /// Its upper corner.
    pub max: Vec3,
    /// Where its light goes.
    pub cone: Cone,
    /// W·sr⁻¹ in the direction of most.
    pub intensity: f64,
}

impl Item {
    fn center(&self) -> Vec3 {
        (self.min + self.max) * 0.5
    }
}

/// How many bins an axis has.
const BINS: usize = 16;

/// Below this depth branches are halved, so that no way is longer than a trail's bits: there are at most 2³⁰ leaves, and
/// halving twice makes four.
const HALVED: u32 = DEEPEST - 16;

/// No leaf has a smaller share of all intensity: importances must stay numbers.
const LEAST_SHARE: f64 = 1e-15;

/// What a branch holds.
#[derive(Clone, Copy, Debug)]
struct Group {
    min: Vec3,
    max: Vec3,
    intensity: f64,
}

impl Group {
    const NONE: Self =
        Self { min: Vec3::splat(f32::INFINITY), max: Vec3::splat(f32::NEG_INFINITY), intensity: 0.0 };

    fn and(self, o: Self) -> Self {
        Self { min: self.min.min(o.min), max: self.max.max(o.max), intensity: self.intensity + o.intensity }
    }
}

/// A bin: a group, and the sum of its normals by intensity, which tells how far they spread.
#[derive(Clone, Copy, Debug)]
struct Bin {
    group: Group,
    normals: Vec3,
    count: usize,
}

impl Bin {
    const NONE: Self = Self { group: Group::NONE, normals: Vec3::ZERO, count: 0 };

    fn and(self, o: Self) -> Self {
        Self {
            group: self.group.and(o.group),
            normals: self.normals + o.normals,
            count: self.count + o.count,
        }
    }

    /// What it costs to choose from it: its extent, how far its light spreads, and its intensity. (Conty Estevez and Kulla
    /// take areas of boxes; squared diagonals are never zero, however flat a box is.) Normals that fill a cone of the half
    /// angle θ have a mean of the length (1 + cos θ)/2, and the measure of their light goes about from π to 4π.
    fn cost(&self) -> f64 {
        if self.count == 0 {
            return 0.0;
        }
        let spread = 1.0 - f64::from(self.normals.length()) / self.group.intensity;
        let extent = f64::from((self.group.max - self.group.min).length_squared());
        extent * self.group.intensity * (1.0 + 3.0 * spread.clamp(0.0, 1.0))
    }
}

/// A tree in the making.
struct Builder {
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    trails: Vec<u64>,
}

impl LightTree {
    /// From at least two items, some for each of `lights` lamps that is not at infinity; each lamp's items have all parts
    /// from 0 up, one after the other. `None` if there are too few items.
    pub fn new(mut items: Vec<Item>, lights: usize) -> Option<Self> {
        if items.len() < 2 {
            return None;
        }
        let mut first = vec![0; lights];
        for (index, item) in items.iter().enumerate().filter(|(_, item)| item.leaf.part == 0) {
            first[item.leaf.light as usize] = index as u32;
        }
        let total: f64 = items.iter().map(|i| i.intensity).sum();
        for item in &mut items {
            item.intensity = (item.intensity / total).max(LEAST_SHARE);
        }
        let n = items.len();
        let mut builder = Builder {
            nodes: Vec::with_capacity(2 * n / 3 + 1),
            leaves: Vec::with_capacity(n),
            trails: Vec::with_capacity(n),
        };
        let (whole, ..) = builder.node(&mut items, 0, 0);
        drop(items);
        let Builder { nodes: built, leaves, trails } = builder;
        let mut nodes = Pages::zeroed(built.len());
        nodes.copy_from_slice(&built);
        let mut order = vec![0; n];
        for (index, leaf) in leaves.iter().enumerate() {
            order[(first[leaf.light as usize] + leaf.part) as usize] = index as u32;
        }
        let size = (whole.max - whole.min).length_squared();
        let scale = 1.0 / size.clamp(f32::MIN_POSITIVE, f32::MAX);
        let unit = (total * f64::from(scale)).min(f32::MAX.into()) as f32;
        Some(Self { nodes, leaves, trails, first, order, scale, unit })
    }
}

impl Builder {
    /// Makes the node for two items or more, and all below it.
    fn node(&mut self, items: &mut [Item], depth: u32, trail: u64) -> (Group, Cone, u32) {
        let index = self.nodes.len();
        // Its place comes before those of its children.
        self.nodes.push(Node::new(&[]));
        let mut parts: [&mut [Item]; WIDTH] = [items, &mut [], &mut [], &mut []];
        let mut count = 1;
        while count < WIDTH {
            // The first of the largest.
            let largest = (1..count).fold(0, |a, b| if parts[b].len() > parts[a].len() { b } else { a });
            if parts[largest].len() < 2 {
                break;
            }
            let part = std::mem::take(&mut parts[largest]);
            let middle = split(part, depth);
            (parts[largest], parts[count]) = part.split_at_mut(middle);
            count += 1;
        }
        let mut branches = Vec::with_capacity(WIDTH);
        let (mut group, mut cone) = (Group::NONE, None::<Cone>);
        for (i, part) in parts.into_iter().enumerate().take(count) {
            let way = trail | (i as u64) << (2 * depth);
            let (branch, below) = self.branch(part, depth + 1, way);
            cone = Some(cone.map_or(branch.cone, |cone| cone.around(branch.cone)));
            group = group.and(below);
            branches.push(branch);
        }
        self.nodes[index] = Node::new(&branches);
        (group, cone.unwrap_or(Cone::ALL), index as u32)
    }

    fn branch(&mut self, items: &mut [Item], depth: u32, trail: u64) -> (Branch, Group) {
        let (group, cone, link) = if let [item] = items {
            self.leaves.push(item.leaf);
            self.trails.push(trail);
            (group_of(item), item.cone, Link::Leaf(self.leaves.len() as u32 - 1))
        } else {
            let (group, cone, index) = self.node(items, depth, trail);
            (group, cone, Link::Node(index))
        };
        let sphere = sphere(group.min, group.max);
        (Branch { sphere, cone, intensity: group.intensity as f32, link }, group)
    }
}

fn group_of(item: &Item) -> Group {
    Group { min: item.min, max: item.max, intensity: item.intensity }
}

/// Puts the items of the first part first and returns how many they are: at least one, and not all.
fn split(items: &mut [Item], depth: u32) -> usize {
    let half = items.len() / 2;
    if items.len() == 2 {
        return half;
    }
    let (low, high) = items
        .iter()
        .fold((Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY)), |(low, high), item| {
            (low.min(item.center()), high.max(item.center()))
        });
    let size = high - low;
    let widest = (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
    if size[widest] <= 0.0 || !size.is_finite() {
        return half;
    }
    if depth >= HALVED {
        items.select_nth_unstable_by(half, |a, b| {
            let key = |item: &Item| (item.leaf.light, item.leaf.part);
            a.center()[widest].total_cmp(&b.center()[widest]).then(key(a).cmp(&key(b)))
        });
        return half;
    }
    let Some((axis, cut)) = best_cut(items, low, size) else { return half };
    let mut middle = 0;
    for i in 0..items.len() {
        if bin(&items[i], axis, low, size) <= cut {
            items.swap(i, middle);
            middle += 1;
        }
    }
    if middle == 0 || middle == items.len() { half } else { middle }
}

/// The bin of an item along an axis.
fn bin(item: &Item, axis: usize, low: Vec3, size: Vec3) -> usize {
    let place = (item.center()[axis] - low[axis]) / size[axis];
    ((place * BINS as f32) as usize).min(BINS - 1)
}

/// The axis and the last bin of the first part, at the least cost.
fn best_cut(items: &[Item], low: Vec3, size: Vec3) -> Option<(usize, usize)> {
    let mut bins = [[Bin::NONE; BINS]; 3];
    let axes = (0..3).filter(|axis| size[*axis] > 0.0);
    for item in items {
        let one =
            Bin { group: group_of(item), normals: mean_normal(item) * (item.intensity as f32), count: 1 };
        for axis in axes.clone() {
            let bin = &mut bins[axis][bin(item, axis, low, size)];
            *bin = bin.and(one);
        }
    }
    let mut best: Option<(f64, usize, usize)> = None;
    for axis in axes {
        // Most groups are small: a cut beside an empty bin is as good as the one before.
        let occupied = |i: &usize| bins[axis][*i].count > 0;
        let (mut above, mut cost_above) = ([f64::INFINITY; BINS], f64::INFINITY);
        let mut sum = Bin::NONE;
        for i in (1..BINS).rev() {
            if occupied(&i) {
                sum = sum.and(bins[axis][i]);
                cost_above = sum.cost();
            }
            above[i - 1] = cost_above;
        }
        let mut below = Bin::NONE;
        for i in (0..BINS - 1).filter(occupied) {
            below = below.and(bins[axis][i]);
            let cost = below.cost() + above[i];
            if cost < best.map_or(f64::INFINITY, |b| b.0) {
                best = Some((cost, axis, i));
            }
        }
    }
    best.map(|(_, axis, cut)| (axis, cut))
}

/// The mean of the normals of a cone's light, about.
fn mean_normal(item: &Item) -> Vec3 {
    if item.cone.spread > 0.0 { item.cone.axis * (0.5 + 0.5 * item.cone.sin_cos().1) } else { item.cone.axis }
}
