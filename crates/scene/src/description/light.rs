use caustica_math::{Rgb, Transform};
use serde::{Deserialize, Serialize};

use super::ImageId;
use crate::Origin;

/// A lamp that is not a surface. One that emits nothing gets a warning; colours that are negative or not finite, and
/// directions of length 0, are errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Light {
    /// What it is.
    pub kind: LightKind,
    /// Where it stands in the file.
    pub origin: Option<Origin>,
}

/// The kinds of lamps that are not surfaces.
#[expect(clippy::large_enum_variant, reason = "a scene has a handful of them")]
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum LightKind {
    /// The same intensity in all directions.
    Point {
        /// Where it is.
        position: [f32; 3],
        /// Its radiant intensity, W·sr⁻¹ (power/4π).
        intensity: Rgb,
    },
    /// A point that lights a cone. The intensity falls from the inner to the outer angle by the
    /// smoothstep of the cosine.
    Spot {
        /// Where it is.
        position: [f32; 3],
        /// The axis of the cone, as the light travels; of any length but zero.
        direction: [f32; 3],
        /// Radiant intensity on the axis.
        intensity: Rgb,
        /// Half angle of the full-intensity cone, in degrees.
        inner_angle: f32,
        /// Half angle beyond which there is no light, in degrees; at least the inner one.
        outer_angle: f32,
    },
    /// Parallel light from infinitely far away.
    Directional {
        /// The direction in which the light travels; of any length but zero.
        direction: [f32; 3],
        /// Irradiance on a surface that faces it (what other programs call its radiance).
        irradiance: Rgb,
    },
    /// The same radiance from all directions.
    Constant {
        /// The radiance.
        radiance: Rgb,
    },
    /// An equirectangular map around the scene. In its own frame +y is up (the upper row of the image),
    /// +z is the image's centre and +x is left of it, as for the environment camera: direction d is
    /// found at (½ − atan2(x, z)/2π, acos(y)/π) from the upper left corner.
    Environment {
        /// The image.
        image: ImageId,
        /// Map frame to world; only its rotation counts.
        to_world: Transform,
        /// Factor on the image's values.
        scale: f32,
    },
}
