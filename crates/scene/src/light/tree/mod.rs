//! A hierarchy of lamps, by which next-event estimation finds those that matter to a place.
//!
//! After Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018, without the
//! splitting; see also Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th edition, 12.6.3. A leaf is a lamp, or
//! one triangle of one. A descent goes to the one or the other child by what may come from each at most; the same
//! descent, led by a leaf's trail, tells the probability of having come there.

mod build;
mod cone;
mod node;

use caustica_math::{Mass, Vec3};

use super::Receiver;
use node::{Link, Node};

pub use build::Item;
pub use cone::Cone;

/// A lamp, or a part of one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Leaf {
    /// Index of the lamp.
    pub light: u32,
    /// Index of the triangle in a lamp that is a mesh; else zero.
    pub part: u32,
}

/// The hierarchy.
#[derive(Debug)]
pub struct LightTree {
    /// Siblings side by side; the first two are the root's.
    pairs: Vec<[Node; 2]>,
    leaves: Vec<Leaf>,
    /// The way to each leaf: bit i is set if the descent goes to the second child at depth i.
    trails: Vec<u64>,
    /// Of each lamp, where its leaves begin in `order`.
    first: Vec<u32>,
    /// Of each part of each lamp, its leaf.
    order: Vec<u32>,
    /// One over the squared size of it all.
    scale: f32,
}

/// The longest way to a leaf: a trail's bits.
const DEEPEST: u32 = 64;

/// A branch that may give light is never less likely than this beside its sibling: its importance is but a guess.
const LEAST: f32 = 1.0 / 1024.0;

/// The probability of the first child; `None` if no light comes from either.
#[inline]
fn share([a, b]: &[Node; 2], to: &Receiver, scale: f32) -> Option<f32> {
    let (a, b) = (a.importance(to, scale), b.importance(to, scale));
    if a == 0.0 {
        return (b != 0.0).then_some(0.0);
    }
    Some(if b == 0.0 { 1.0 } else { (a / (a + b)).clamp(LEAST, 1.0 - LEAST) })
}

impl LightTree {
    /// Chooses a leaf for a place by `u` in [0, 1); `None` if no leaf's light arrives there.
    #[inline]
    pub fn choose(&self, to: &Receiver, mut u: f64) -> Option<(Leaf, Mass)> {
        let (mut pair, mut mass) = (0, 1.0_f32);
        loop {
            let nodes = &self.pairs[pair as usize];
            let first = share(nodes, to, self.scale)?;
            let wide = f64::from(first);
            let node = if u < wide {
                u /= wide;
                mass *= first;
                &nodes[0]
            } else {
                u = (u - wide) / (1.0 - wide);
                mass *= 1.0 - first;
                &nodes[1]
            };
            match node.link() {
                Link::Pair(next) => pair = next,
                Link::Leaf(leaf) => return Some((self.leaves[leaf as usize], Mass(mass))),
            }
        }
    }

    /// The probability with which [`LightTree::choose`] comes to that part of a lamp.
    #[inline]
    pub fn mass(&self, to: &Receiver, leaf: Leaf) -> Mass {
        let index = self.order[(self.first[leaf.light as usize] + leaf.part) as usize];
        let mut trail = self.trails[index as usize];
        let (mut pair, mut mass) = (0, 1.0_f32);
        loop {
            let nodes = &self.pairs[pair as usize];
            let Some(first) = share(nodes, to, self.scale) else { return Mass(0.0) };
            let side = (trail & 1) as usize;
            mass *= if side == 0 { first } else { 1.0 - first };
            match nodes[side].link() {
                Link::Pair(next) if mass > 0.0 => pair = next,
                _ => return Mass(mass),
            }
            trail >>= 1;
        }
    }

    /// All leaves.
    pub fn leaves(&self) -> &[Leaf] {
        &self.leaves
    }
}

/// The sphere around a box.
fn sphere(min: Vec3, max: Vec3) -> (Vec3, f32) {
    let center = (min + max) * 0.5;
    // Rounded up: the centre is off by a rounding of the coordinates.
    let rounding = (min.abs().max(max.abs())).max_element() * 1e-6;
    (center, (max - center).length() * (1.0 + 1e-5) + rounding)
}
