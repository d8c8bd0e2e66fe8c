//! How surfaces scatter: BSDFs with their textures looked up.
//!
//! Directions are in the local frame whose +z is the shading normal, and point away from the surface.
//! Evaluation is in the one physical orientation, as light travels: from where `to_light` points, out to
//! where `to_camera` points, whichever walk asks.

use caustica_math::{SolidAnglePdf, Spectrum, Vec3};

/// The direction in which a path is being traced. (Light itself always travels to the camera.)
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Walk {
    /// `to_camera` is given, `to_light` is sampled.
    FromCamera,
    /// `to_light` is given, `to_camera` is sampled.
    FromLight,
}

/// A BSDF evaluated for a pair of directions. Dirac parts count as zero.
#[derive(Clone, Copy, Debug, Default)]
pub struct Evaluated {
    /// f(to_light → to_camera)·|cos θ| with θ the angle of `to_light` to the shading normal, in sr⁻¹. f is
    /// in radiance: refraction scales it by (n_camera/n_light)², n being the index on each one's side.
    pub value: Spectrum,
    /// Density of sampling `to_light` when `to_camera` is given.
    pub to_light_pdf: SolidAnglePdf,
    /// Density of sampling `to_camera` when `to_light` is given.
    pub to_camera_pdf: SolidAnglePdf,
}

/// A sampled direction.
#[derive(Clone, Copy, Debug)]
pub struct Scattered {
    /// The sampled direction: `to_light` or `to_camera`, by the walk.
    pub direction: Vec3,
    /// What [`Evaluated::value`] would be. For a Dirac lobe, its coefficient with respect to the solid
    /// angle of the sampled direction.
    pub value: Spectrum,
    /// Density of the sampled direction given the other; for a Dirac lobe its coefficient (a
    /// probability).
    pub pdf: SolidAnglePdf,
    /// Density of the given direction if the sampled one were given. For a Dirac lobe its coefficient
    /// with respect to the solid angle of the *sampled* direction, so that the ratio of the two
    /// densities is right.
    pub reverse_pdf: SolidAnglePdf,
    /// Whether it came from a Dirac lobe.
    pub delta: bool,
}
