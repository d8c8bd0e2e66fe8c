//! Pixel filters.

use serde::{Deserialize, Serialize};

/// A pixel filter; lengths are in pixels, from the centre of the pixel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Filter {
    /// One inside of the radius; 0.5 is the pixel itself.
    Box {
        /// Half width.
        radius: f32,
    },
    /// A triangle.
    Tent {
        /// Half width.
        radius: f32,
    },
    /// A Gaussian, lowered so that it ends at zero.
    Gaussian {
        /// Half width.
        radius: f32,
        /// Standard deviation.
        stddev: f32,
    },
    /// Mitchell and Netravali's cubic, stretched to the radius.
    Mitchell {
        /// Half width.
        radius: f32,
        /// Its B.
        b: f32,
        /// Its C.
        c: f32,
    },
}

impl Default for Filter {
    fn default() -> Self {
        Self::Gaussian { radius: 2.0, stddev: 0.5 }
    }
}

impl Filter {
    /// Half width in pixels.
    pub fn radius(&self) -> f32 {
        match *self {
            Self::Box { radius }
            | Self::Tent { radius }
            | Self::Gaussian { radius, .. }
            | Self::Mitchell { radius, .. } => radius,
        }
    }
}
