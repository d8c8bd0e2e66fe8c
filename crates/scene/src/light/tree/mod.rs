//! A hierarchy of lamps, by which next-event estimation finds those that matter to a place.
//!
//! After Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree Splitting", 2018, without the
//! splitting; see also Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th edition, 12.6.3. A leaf is a lamp, or
//! one triangle of one. A descent goes to one of a node's four branches by what may come from each at most; the same
//! descent, led by a leaf's trail, tells the probability of having come there.

mod build;
mod cone;
mod node;

use caustica_math::{Mass, ONE_BELOW, Vec3};

use super::Receiver;
use crate::bvh::pages::Pages;
use node::{Link, Node, WIDTH};

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
    /// The first is the root.
    nodes: Pages<Node>,
    leaves: Vec<Leaf>,
    /// The way to each leaf: the branches that are taken, two bits for each depth.
    trails: Vec<u64>,
    /// Of each lamp, where its leaves begin in `order`.
    first: Vec<u32>,
    /// Of each part of each lamp, its leaf.
    order: Vec<u32>,
    /// One over the squared size of it all.
    scale: f32,
    /// The irradiance in W·m⁻² that an importance of one stands for.
    unit: f32,
}

/// The longest way to a leaf: a trail's bits, by two.
const DEEPEST: u32 = 32;

/// A branch that may give light is never less likely than this: its importance is but a guess.
const LEAST: f32 = 1.0 / 1024.0;

/// What the branches' probabilities are in proportion to, and the sum of that. `None` if no light comes from any.
#[inline]
fn shares(node: &Node, to: &Receiver, scale: f32) -> Option<([f32; WIDTH], f32)> {
    let importances = node.importances(to, scale);
    let sum = importances[0] + importances[1] + importances[2] + importances[3];
    if sum.is_nan() || sum <= 0.0 {
        return None;
    }
    let inverse = 1.0 / sum;
    let shares = importances.map(|i| if i > 0.0 { (i * inverse).max(LEAST) } else { 0.0 });
    Some((shares, shares[0] + shares[1] + shares[2] + shares[3]))
}

impl LightTree {
    /// Chooses a leaf for a place by `u` in [0, 1); `None` if no leaf's light arrives there.
    #[inline]
    pub fn choose(&self, to: &Receiver, mut u: f64) -> Option<(Leaf, Mass)> {
        let (mut index, mut mass) = (0, 1.0_f32);
        loop {
            let node = &self.nodes[index as usize];
            let (shares, total) = shares(node, to, self.scale)?;
            let mut left = u * f64::from(total);
            // Rounding may leave something beyond all: that is the last one's.
            let (mut branch, mut before) = (WIDTH, 0.0);
            for (i, share) in shares.iter().enumerate().filter(|(_, share)| **share > 0.0) {
                (branch, before) = (i, left);
                left -= f64::from(*share);
                if left < 0.0 {
                    break;
                }
            }
            let share = shares[branch];
            mass *= share / total;
            match node.link(branch) {
                Link::Node(next) => index = next,
                Link::Leaf(leaf) => return Some((self.leaves[leaf as usize], Mass(mass))),
            }
            u = (before / f64::from(share)).min(ONE_BELOW.into());
        }
    }

    /// The probability with which [`LightTree::choose`] comes to that part of a lamp.
    #[inline]
    pub fn mass(&self, to: &Receiver, leaf: Leaf) -> Mass {
        let index = self.order[(self.first[leaf.light as usize] + leaf.part) as usize];
        let mut trail = self.trails[index as usize];
        let (mut index, mut mass) = (0, 1.0_f32);
        loop {
            let node = &self.nodes[index as usize];
            let Some((shares, total)) = shares(node, to, self.scale) else { return Mass(0.0) };
            let branch = trail as usize % WIDTH;
            mass *= shares[branch] / total;
            match node.link(branch) {
                Link::Node(next) if mass > 0.0 => index = next,
                _ => return Mass(mass),
            }
            trail /= WIDTH as u64;
        }
    }

    /// The irradiance of a place by all lamps together, in W·m⁻², about.
    #[inline]
    pub fn irradiance(&self, to: &Receiver) -> f32 {
        self.nodes[0].importances(to, self.scale).iter().sum::<f32>() * self.unit
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
