//! Disney's principled materials.

use caustica_math::Rgb;
use serde::{Deserialize, Serialize};

use super::{Scalar, Texture};

/// Mitsuba's `principled`: the surface of something solid. Numbers are shares, kept within [0, 1], if nothing else is
/// said.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Principled {
    /// Colour of the base, and of what is transmitted and reflected by metal.
    pub base_color: Texture,
    /// Roughness; its square is the α of GGX.
    pub roughness: Scalar,
    /// How much longer highlights are along the tangent.
    pub anisotropic: Scalar,
    /// The share of metal.
    pub metallic: Scalar,
    /// The share of what is not metal that transmits.
    pub spec_trans: Scalar,
    /// Index of refraction, relative to the outside.
    pub eta: f32,
    /// How much the reflection of what is not metal is coloured.
    pub spec_tint: Scalar,
    /// Strength of the sheen, not negative.
    pub sheen: Scalar,
    /// How much the sheen is coloured.
    pub sheen_tint: Scalar,
    /// From diffuse to subsurface scattering.
    pub flatness: Scalar,
    /// Strength of the clear coat, not negative.
    pub clearcoat: Scalar,
    /// From a dull to a glossy coat.
    pub clearcoat_gloss: Scalar,
}

/// Mitsuba's `principledthin`: a sheet that is the same from both sides and bends no light. Numbers are shares, kept
/// within [0, 1], if nothing else is said.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PrincipledThin {
    /// Colour of the base and of what is transmitted.
    pub base_color: Texture,
    /// Roughness; its square is the α of GGX.
    pub roughness: Scalar,
    /// How much longer highlights are along the tangent.
    pub anisotropic: Scalar,
    /// The share of what mirrors and transmits.
    pub spec_trans: Scalar,
    /// Index of refraction of the sheet, relative to what is around.
    pub eta: Scalar,
    /// How much the reflection is coloured.
    pub spec_tint: Scalar,
    /// Strength of the sheen, not negative.
    pub sheen: Scalar,
    /// How much the sheen is coloured.
    pub sheen_tint: Scalar,
    /// From diffuse to subsurface scattering.
    pub flatness: Scalar,
    /// From diffuse reflection (0) to diffuse transmission (2).
    pub diff_trans: Scalar,
}

const NOTHING: Scalar = Scalar::Constant(0.0);

impl Default for Principled {
    /// Grey, of roughness 0.5 and index 1.5, and nothing else.
    fn default() -> Self {
        Self {
            base_color: Rgb::splat(0.5).into(),
            roughness: 0.5.into(),
            anisotropic: NOTHING,
            metallic: NOTHING,
            spec_trans: NOTHING,
            eta: 1.5,
            spec_tint: NOTHING,
            sheen: NOTHING,
            sheen_tint: NOTHING,
            flatness: NOTHING,
            clearcoat: NOTHING,
            clearcoat_gloss: NOTHING,
        }
    }
}

impl Default for PrincipledThin {
    /// Grey, of roughness 0.5 and index 1.5, and nothing else.
    fn default() -> Self {
        Self {
            base_color: Rgb::splat(0.5).into(),
            roughness: 0.5.into(),
            anisotropic: NOTHING,
            spec_trans: NOTHING,
            eta: 1.5.into(),
            spec_tint: NOTHING,
            sheen: NOTHING,
            sheen_tint: NOTHING,
            flatness: NOTHING,
            diff_trans: NOTHING,
        }
    }
}

impl Principled {
    /// All that may be textured but the colour.
    pub fn scalars(&self) -> [&Scalar; 10] {
        [
            &self.roughness,
            &self.anisotropic,
            &self.metallic,
            &self.spec_trans,
            &self.spec_tint,
            &self.sheen,
            &self.sheen_tint,
            &self.flatness,
            &self.clearcoat,
            &self.clearcoat_gloss,
        ]
    }
}

impl PrincipledThin {
    /// All that may be textured but the colour.
    pub fn scalars(&self) -> [&Scalar; 9] {
        [
            &self.roughness,
            &self.anisotropic,
            &self.spec_trans,
            &self.eta,
            &self.spec_tint,
            &self.sheen,
            &self.sheen_tint,
            &self.flatness,
            &self.diff_trans,
        ]
    }
}
