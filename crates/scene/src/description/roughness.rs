//! How rough a surface is.

use serde::{Deserialize, Serialize};

use super::Texture;

/// A number that may vary over a surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Scalar {
    /// The same everywhere.
    Constant(f32),
    /// The luminance of a texture.
    Texture(Texture),
}

impl From<f32> for Scalar {
    fn from(x: f32) -> Self {
        Self::Constant(x)
    }
}

/// The distribution of microfacet normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Distribution {
    /// GGX (Trowbridge and Reitz): long tails.
    Ggx,
    /// Beckmann: slopes are normally distributed, with the variance α²/2 on each axis.
    Beckmann,
}

/// How the shadows that microfacets throw on the light's way and on the camera's depend on each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Shadowing {
    /// By height: what is deep is in shadow from both sides (Smith's G₂).
    Correlated,
    /// Not at all: G₁·G₁, which is darker. Mitsuba's way.
    Separable,
}

/// How rough a surface is. Values of α below 10⁻⁴ count as that.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Roughness {
    /// Of the microfacet normals.
    pub distribution: Distribution,
    /// Of light by other microfacets.
    pub shadowing: Shadowing,
    /// α along the tangent and the bitangent of the surface.
    pub alpha: [Scalar; 2],
}

impl Roughness {
    /// GGX of the same α in all directions, with correlated shadowing.
    pub fn ggx(alpha: impl Into<Scalar>) -> Self {
        let alpha = alpha.into();
        Self { distribution: Distribution::Ggx, shadowing: Shadowing::Correlated, alpha: [alpha; 2] }
    }
}
