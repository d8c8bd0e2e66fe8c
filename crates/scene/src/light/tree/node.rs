use caustica_math::Vec3;
use caustica_math::elementary::{cos, safe_sqrt};

use super::cone::Cone;
use crate::light::Receiver;

/// What lies below a branch of the tree, as far as it matters from outside.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    center: Vec3,
    /// Of a sphere around all of it.
    radius: f32,
    axis: Vec3,
    cos_spread: f32,
    sin_spread: f32,
    /// Cosine of the angle from the normals beyond which there is no light, rounding allowed for.
    cos_reach: f32,
    /// What it sends to where it sends most, as a share of the whole.
    intensity: f32,
    /// Twice the index of what is below, and one more if that is a leaf.
    link: u32,
}

/// What a node leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Link {
    /// A pair of nodes.
    Pair(u32),
    /// A leaf.
    Leaf(u32),
}

/// By how much cosines are off at most: some roundings, the square roots of them where angles are small.
const MARGIN: f32 = 2e-3;

/// Cosines count as this at least: what is found there is little, but is to be found.
const LEAST_COS: f32 = 0.02;

/// Squared distances, in units of the tree's size, are held between these, so that importances are numbers.
const NEAREST: f32 = 1e-12;
const FARTHEST: f32 = 1e16;

impl Node {
    /// Of lamps in a sphere, in directions of a cone, with a share of all intensity.
    pub fn new((center, radius): (Vec3, f32), cone: Cone, intensity: f32, link: Link) -> Self {
        let (sin_spread, cos_spread) = cone.sin_cos();
        let link = match link {
            Link::Pair(index) => 2 * index,
            Link::Leaf(index) => 2 * index + 1,
        };
        let cos_reach = if cone.reach >= std::f32::consts::PI { -2.0 } else { cos(cone.reach) - MARGIN };
        Self { center, radius, axis: cone.axis, cos_spread, sin_spread, cos_reach, intensity, link }
    }

    /// What it leads to.
    #[inline]
    pub fn link(&self) -> Link {
        if self.link & 1 == 0 { Link::Pair(self.link >> 1) } else { Link::Leaf(self.link >> 1) }
    }

    /// How much light may come from it, about; zero only if none can. `scale` is one over the tree's squared size.
    ///
    /// The bound of Conty Estevez and Kulla: the smallest angle that a direction from the sphere can have to a normal of
    /// the cone, over the squared distance; and the smallest angle to the receiver's normal.
    #[inline]
    pub fn importance(&self, to: &Receiver, scale: f32) -> f32 {
        let d = to.at - self.center;
        let (squared, within) = (d.length_squared(), self.radius * self.radius);
        if squared <= within {
            return self.intensity / (within * scale).clamp(NEAREST, FARTHEST);
        }
        let inverse = 1.0 / squared.sqrt();
        let sin_size = self.radius * inverse;
        let cos_size = safe_sqrt(1.0 - sin_size * sin_size);
        let leaving = narrowed(self.axis.dot(d) * inverse, self.cos_spread, self.sin_spread);
        let leaving = narrowed(leaving, cos_size, sin_size);
        if leaving <= self.cos_reach {
            return 0.0;
        }
        let mut importance =
            self.intensity * leaving.max(LEAST_COS) / (squared * scale).clamp(NEAREST, FARTHEST);
        if to.normal != Vec3::ZERO {
            let arriving = narrowed(-to.normal.dot(d) * inverse, cos_size, sin_size);
            if arriving <= -MARGIN {
                return 0.0;
            }
            importance *= arriving.max(LEAST_COS);
        }
        importance
    }
}

/// The cosine of an angle less another one, or one if the other is larger.
#[inline]
fn narrowed(cos: f32, by_cos: f32, by_sin: f32) -> f32 {
    if cos >= by_cos { 1.0 } else { cos * by_cos + safe_sqrt(1.0 - cos * cos) * by_sin }
}
