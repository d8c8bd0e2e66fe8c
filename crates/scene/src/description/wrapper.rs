use serde::{Deserialize, Serialize};

use super::{MaterialId, Texture};

/// A material made of others. They may be wrappers too, up to 64 deep.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Wrapper {
    /// A material with holes: `null` where the opacity is zero.
    Mask {
        /// The share of the material, by its luminance, kept between 0 and 1.
        opacity: Texture,
        /// The material.
        inner: MaterialId,
    },
    /// Two materials side by side, too fine to be told apart.
    Blend {
        /// The share of the second one, by its luminance, kept between 0 and 1.
        weight: Texture,
        /// The two.
        inner: [MaterialId; 2],
    },
    /// A material for each side. Either sees itself from in front, and nothing passes.
    TwoSided {
        /// On the side of the normal.
        front: MaterialId,
        /// On its other side.
        back: MaterialId,
    },
    /// A material on a surface that is raised by a texture, as far as the normal tells.
    Bump {
        /// Heights by their luminance; only bilinear images have a slope.
        height: Texture,
        /// Factor on the heights, which gives the scene's unit of length.
        scale: f32,
        /// What is done about the normal.
        rule: BumpRule,
        /// The material.
        inner: MaterialId,
    },
    /// A material whose normal a texture tells.
    NormalMap {
        /// The normal as (colour·2 − 1), in the frame of ∂p/∂u, its perpendicular and the shading normal.
        normals: Texture,
        /// What is done about the normal.
        rule: BumpRule,
        /// The material.
        inner: MaterialId,
    },
}

impl Wrapper {
    /// The materials inside.
    pub fn inner(&self) -> impl Iterator<Item = MaterialId> + use<> {
        let (first, second) = match *self {
            Self::Mask { inner, .. } | Self::Bump { inner, .. } | Self::NormalMap { inner, .. } => {
                (inner, None)
            }
            Self::Blend { inner: [a, b], .. } => (a, Some(b)),
            Self::TwoSided { front, back } => (front, Some(back)),
        };
        std::iter::once(first).chain(second)
    }

    /// What it looks up.
    pub fn texture(&self) -> Option<&Texture> {
        match self {
            Self::Mask { opacity: t, .. }
            | Self::Blend { weight: t, .. }
            | Self::Bump { height: t, .. }
            | Self::NormalMap { normals: t, .. } => Some(t),
            Self::TwoSided { .. } => None,
        }
    }
}

/// What is done about a normal that is not the surface's own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct BumpRule {
    /// Whether a normal that points away from where light leaves is mirrored at the shading normal. (Schüßler et al.,
    /// "Microfacet-based normal mapping for robust Monte Carlo path tracing", 2017.) Nothing is scattered there
    /// otherwise.
    pub flips: bool,
    /// Whether arriving light is dimmed as if by the bumps' shadows. (Estevez et al., "A microfacet-based shadowing
    /// function to solve the bump terminator problem", Ray Tracing Gems, 2019.)
    pub shadows: bool,
}

impl Default for BumpRule {
    fn default() -> Self {
        Self { flips: true, shadows: true }
    }
}
