use bytemuck::{Pod, Zeroable};
use caustica_math::Vec3;
use caustica_math::elementary::cos;
use wide::f32x4;

use super::cone::Cone;
use crate::light::Receiver;

/// How many branches a node has.
pub const WIDTH: usize = 4;

/// What lies below a branch of the tree, as far as it matters from outside.
#[derive(Clone, Copy, Debug)]
pub struct Branch {
    /// A sphere around all of it.
    pub sphere: (Vec3, f32),
    /// Where its light goes.
    pub cone: Cone,
    /// What it sends to where it sends most, as a share of the whole.
    pub intensity: f32,
    /// What it leads to.
    pub link: Link,
}

/// What a branch leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Link {
    /// A node.
    Node(u32),
    /// A leaf.
    Leaf(u32),
}

/// Branches side by side.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub struct Node {
    center: [f32x4; 3],
    radius: f32x4,
    axis: [f32x4; 3],
    cos_spread: f32x4,
    sin_spread: f32x4,
    /// Cosine of the angle from the normals beyond which there is no light, rounding allowed for.
    cos_reach: f32x4,
    intensity: f32x4,
    /// Twice the index of what is below, and one more if that is a leaf.
    links: [u32; WIDTH],
}

/// By how much cosines are off at most: some roundings, the square roots of them where angles are small.
const MARGIN: f32 = 2e-3;

/// Cosines count as this at least: what is found there is little, but is to be found.
const LEAST_COS: f32 = 0.02;

/// Squared distances, in units of the tree's size, are held between these, so that importances are numbers.
const NEAREST: f32 = 1e-12;
const FARTHEST: f32 = 1e16;

impl Node {
    /// Of some branches. What it lacks is never chosen, as it has no intensity.
    pub fn new(branches: &[Branch]) -> Self {
        let lanes = |f: &dyn Fn(&Branch) -> f32| {
            let mut lanes = [0.0; WIDTH];
            lanes.iter_mut().zip(branches).for_each(|(lane, branch)| *lane = f(branch));
            f32x4::new(lanes)
        };
        let axes = [0, 1, 2];
        let mut links = [1; WIDTH];
        links.iter_mut().zip(branches).for_each(|(link, branch)| {
            *link = match branch.link {
                Link::Node(index) => 2 * index,
                Link::Leaf(index) => 2 * index + 1,
            }
        });
        let cos_reach = |reach: f32| if reach >= std::f32::consts::PI { -2.0 } else { cos(reach) - MARGIN };
        Self {
            center: axes.map(|axis| lanes(&|b| b.sphere.0[axis])),
            radius: lanes(&|b| b.sphere.1),
            axis: axes.map(|axis| lanes(&|b| b.cone.axis[axis])),
            cos_spread: lanes(&|b| b.cone.sin_cos().1),
            sin_spread: lanes(&|b| b.cone.sin_cos().0),
            cos_reach: lanes(&|b| cos_reach(b.cone.reach)),
            intensity: lanes(&|b| b.intensity),
            links,
        }
    }

    /// What a branch leads to.
    #[inline]
    pub fn link(&self, branch: usize) -> Link {
        let link = self.links[branch];
        if link & 1 == 0 { Link::Node(link >> 1) } else { Link::Leaf(link >> 1) }
    }

    /// How much light may come from each branch, about; zero only if none can. `scale` is one over the tree's squared
    /// size.
    ///
    /// The bound of Conty Estevez and Kulla: the smallest angle that a direction from the sphere can have to a normal of
    /// the cone, over the squared distance; and the smallest angle to the receiver's normal.
    #[inline]
    pub fn importances(&self, to: &Receiver, scale: f32) -> [f32; WIDTH] {
        let splat = f32x4::splat;
        let (zero, one) = (splat(0.0), splat(1.0));
        let d = [0, 1, 2].map(|axis| splat(to.at[axis]) - self.center[axis]);
        let dot = |v: [f32x4; 3]| v[0] * d[0] + v[1] * d[1] + v[2] * d[2];
        let (squared, within) = (dot(d), self.radius * self.radius);
        let held =
            |squared: f32x4| (squared * splat(scale)).fast_max(splat(NEAREST)).fast_min(splat(FARTHEST));
        let inverse = one / squared.sqrt();
        let sin_size = self.radius * inverse;
        let cos_size = (one - sin_size * sin_size).fast_max(zero).sqrt();
        let leaving = narrowed(dot(self.axis) * inverse, self.cos_spread, self.sin_spread);
        let leaving = narrowed(leaving, cos_size, sin_size);
        let mut dark = leaving.simd_le(self.cos_reach);
        let mut importance = self.intensity * leaving.fast_max(splat(LEAST_COS)) / held(squared);
        if to.normal != Vec3::ZERO {
            let normal = to.normal.to_array().map(|n| splat(-n));
            let arriving = narrowed(dot(normal) * inverse, cos_size, sin_size);
            dark |= arriving.simd_le(splat(-MARGIN));
            importance *= arriving.fast_max(splat(LEAST_COS));
        }
        let inside = squared.simd_le(within);
        let outside = dark.select(zero, importance);
        inside.select(self.intensity / held(within), outside).to_array()
    }
}

/// The cosine of an angle less another one, or one if the other is larger.
#[inline]
fn narrowed(cos: f32x4, by_cos: f32x4, by_sin: f32x4) -> f32x4 {
    let one = f32x4::splat(1.0);
    let sin = (one - cos * cos).fast_max(f32x4::splat(0.0)).sqrt();
    cos.simd_ge(by_cos).select(one, cos * by_cos + sin * by_sin)
}
