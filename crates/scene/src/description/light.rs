use caustica_math::{Rgb, Transform};
use serde::{Deserialize, Serialize};

use super::{ImageId, Texture};
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
    /// A point that lights a cone. The intensity falls from the inner to the outer angle in proportion to the angle.
    LinearSpot {
        /// The axis is +z of this frame, the place its origin; only rotation and place count.
        to_world: Transform,
        /// Radiant intensity on the axis.
        intensity: Rgb,
        /// A factor on it for each direction d: of a square that just holds the cone, at
        /// ½ + x/(2z·tan outer), ½ − y/(2z·tan outer). Only for outer angles below 90°.
        picture: Option<Texture>,
        /// Half angle of the full-intensity cone, in degrees.
        inner_angle: f32,
        /// Half angle beyond which there is no light, in degrees; at least the inner one.
        outer_angle: f32,
    },
    /// A point that throws a picture along +z of its frame, +x to the picture's left, +y up.
    Projector {
        /// Its frame; only rotation and place count.
        to_world: Transform,
        /// The irradiance on a plane across the axis at distance one; the unit square is the whole picture.
        irradiance: Texture,
        /// A factor on it.
        scale: f32,
        /// The horizontal angle, in degrees.
        fov: f32,
        /// The picture's width over its height.
        aspect: f32,
    },
    /// A shape that emits along its geometric normals alone: as much as a lamp of that radiance over π would in all.
    /// Light paths alone find it, and no camera sees it.
    Collimated {
        /// The index of the shape in [`super::Description::shapes`]. It may not be a lamp otherwise.
        shape: u32,
        /// The radiant exitance (W·m⁻²), which is the irradiance on a parallel surface in front.
        exitance: Texture,
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
        /// Where its rows lie.
        rows: EnvironmentRows,
    },
    /// A clear sky, without its sun, by the model of Hosek and Wilkie (2012). Below the horizon it is black.
    Sky {
        /// Where the sun is, and how hazy it is.
        daylight: Daylight,
        /// Of the ground, at most 1: it lights the sky.
        albedo: Rgb,
        /// A factor on its radiance.
        scale: f32,
    },
    /// The sun's disc, by the model of Hosek and Wilkie (2013). What of it is below the horizon is black.
    Sun {
        /// Where it is, and how hazy it is.
        daylight: Daylight,
        /// Its diameter in degrees, from 0.01 and less than 180. The irradiance does not depend on it, but where the
        /// horizon cuts it.
        aperture: f32,
        /// A factor on its radiance.
        scale: f32,
        /// Whether it is darker towards its edge and the horizon, as the model tells. Otherwise it is the same
        /// everywhere, with the irradiance that the model tells for every third degree of elevation from 2° on, and
        /// straight lines between: near the horizon that is far too much, but what Mitsuba renders.
        darkened: bool,
    },
}

/// The place of the sun and the state of the air. Radiance is that of the models in W·m⁻²·sr⁻¹·nm⁻¹, in colours: a
/// spectrum of one has luminance one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Daylight {
    /// The sky's frame, whose +z is up, to the world; only its rotation counts.
    pub to_world: Transform,
    /// The direction to the middle of the sun, in the world; of any length but zero. Below the horizon there is no light.
    pub to_sun: [f32; 3],
    /// How hazy it is: from 1 (as clear as can be) to 10.
    pub turbidity: f32,
}

/// Where the rows of pixels of an environment map lie, from the pole +y (0) to the pole −y (1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum EnvironmentRows {
    /// The middle of row r of h at (r + ½)/h.
    #[default]
    Inside,
    /// The middle of row r of h at r/(h − 1): those of the first and the last are the poles.
    OnPoles,
}
