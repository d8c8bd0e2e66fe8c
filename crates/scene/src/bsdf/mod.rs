//! How surfaces scatter: BSDFs with their textures looked up.
//!
//! Directions are in the local frame whose +z is the shading normal, and point away from the surface.
//! Evaluation is in the one physical orientation, as light travels: from where `to_light` points, out to
//! where `to_camera` points, whichever walk asks.

mod beckmann;
pub mod bump;
pub mod coat;
pub mod conductor;
pub mod diffuse;
pub mod facets;
pub mod fresnel;
mod ggx;
pub mod metals;
pub mod microfacet;
pub mod plastic;
pub mod principled;
pub mod rough_dielectric;
pub mod specular;
pub mod thin;

use caustica_math::{SolidAnglePdf, Spectrum, Vec3};

pub use bump::Bump;
pub use coat::{RoughCoat, SmoothCoat};
pub use conductor::{Conductor, RoughConductor};
pub use diffuse::Diffuse;
pub use facets::Facets;
pub use microfacet::Microfacet;
pub use plastic::{Plastic, PlasticColours, RoughPlastic};
pub use principled::{Principled, PrincipledThin};
pub use rough_dielectric::RoughDielectric;
pub use specular::Dielectric;
pub use thin::ThinDielectric;

use specular::sample_mirror;
use thin::sample_null;

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

/// How a point of a surface scatters light: a material with its textures looked up. Sides are told by the
/// shading normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bsdf {
    /// Lambertian.
    Diffuse(Diffuse),
    /// A perfect mirror on the side of the normal; black on the other.
    Mirror {
        /// The reflected share, in [0, 1].
        reflectance: Spectrum,
    },
    /// A smooth interface between two dielectrics.
    Dielectric(Dielectric),
    /// A rough interface between two dielectrics.
    RoughDielectric(RoughDielectric),
    /// A smooth metal.
    Conductor(Conductor),
    /// A rough metal.
    RoughConductor(RoughConductor),
    /// Nori's plastic.
    Microfacet(Microfacet),
    /// A diffuse base under a smooth coat.
    Plastic(Plastic),
    /// A diffuse base under a rough coat.
    RoughPlastic(RoughPlastic),
    /// Disney's principled surface.
    Principled(Principled),
    /// The same of something thin.
    PrincipledThin(PrincipledThin),
    /// A thin sheet of glass.
    ThinDielectric(ThinDielectric),
    /// No surface at all.
    Null,
}

// One lies in every path vertex: a cache line and no more.
const _: () = assert!(size_of::<Bsdf>() <= 64);

impl Bsdf {
    /// Evaluates all but the Dirac lobes.
    #[inline]
    pub fn eval(&self, to_light: Vec3, to_camera: Vec3) -> Evaluated {
        match self {
            Self::Diffuse(b) => b.eval(to_light, to_camera),
            Self::RoughDielectric(b) => b.eval(to_light, to_camera),
            Self::RoughConductor(b) => b.eval(to_light, to_camera),
            Self::Microfacet(b) => b.eval(to_light, to_camera),
            Self::Plastic(b) => b.eval(to_light, to_camera),
            Self::RoughPlastic(b) => b.eval(to_light, to_camera),
            Self::Principled(b) => b.eval(to_light, to_camera),
            Self::PrincipledThin(b) => b.eval(to_light, to_camera),
            Self::Mirror { .. }
            | Self::Dielectric(_)
            | Self::Conductor(_)
            | Self::ThinDielectric(_)
            | Self::Null => Evaluated::default(),
        }
    }

    /// Samples the direction that is not `given`: `given` is `to_camera` if the walk is from the camera, and
    /// `to_light` if it is from the light. `u` is uniform in [0, 1)³.
    ///
    /// `None` if light is absorbed or the sample failed; its densities are never zero.
    #[inline]
    pub fn sample(&self, walk: Walk, given: Vec3, u: [f32; 3]) -> Option<Scattered> {
        let direction = match self {
            Self::Mirror { reflectance } => return lit(sample_mirror(*reflectance, given)?),
            Self::Conductor(b) => return lit(b.sample(given)?),
            Self::Dielectric(b) => return lit(b.sample(walk, given, u)?),
            Self::ThinDielectric(b) => return lit(b.sample(given, u)?),
            Self::Null => return sample_null(given),
            Self::RoughDielectric(b) if b.is_matched() => return lit(b.sample_matched(walk, given, u)?),
            Self::Diffuse(b) => b.sample_direction(given, u),
            Self::RoughDielectric(b) => b.sample_direction(given, u),
            Self::RoughConductor(b) => b.sample_direction(given, u),
            Self::Microfacet(b) => b.sample_direction(given, u),
            Self::Plastic(b) => match b.sample_coat(given, u[2]) {
                Some(coat) => return lit(coat),
                None => b.sample_base(given, u),
            },
            Self::RoughPlastic(b) => b.sample_direction(given, u),
            Self::Principled(b) => b.sample_direction(given, u),
            Self::PrincipledThin(b) => b.sample_direction(given, u),
        }?;
        // Evaluated like any other pair, so that the densities agree with `eval` to the bit.
        let (evaluated, pdf, reverse_pdf) = match walk {
            Walk::FromCamera => {
                let e = self.eval(direction, given);
                (e, e.to_light_pdf, e.to_camera_pdf)
            }
            Walk::FromLight => {
                let e = self.eval(given, direction);
                (e, e.to_camera_pdf, e.to_light_pdf)
            }
        };
        // Dividing by a subnormal density would overflow.
        if pdf.get() < f32::MIN_POSITIVE {
            return None;
        }
        lit(Scattered { direction, value: evaluated.value, pdf, reverse_pdf, delta: false })
    }

    /// Whether all of it is Dirac: such a surface can never be connected to.
    #[inline]
    pub fn is_delta(&self) -> bool {
        match self {
            Self::Mirror { .. }
            | Self::Dielectric(_)
            | Self::Conductor(_)
            | Self::ThinDielectric(_)
            | Self::Null => true,
            Self::RoughDielectric(b) => b.is_matched(),
            Self::Diffuse(_)
            | Self::RoughConductor(_)
            | Self::Microfacet(_)
            | Self::Plastic(_)
            | Self::RoughPlastic(_)
            | Self::Principled(_)
            | Self::PrincipledThin(_) => false,
        }
    }

    /// Whether it has Dirac lobes beside smooth ones: a walk that went on from there may have done so by either.
    #[inline]
    pub fn is_partly_delta(&self) -> bool {
        matches!(self, Self::Plastic(_))
    }

    /// Whether any of it is Dirac.
    #[inline]
    pub fn has_dirac(&self) -> bool {
        self.is_delta() || self.is_partly_delta()
    }

    /// Whether [`Bsdf::sample`] asks for its third number.
    #[inline]
    pub fn has_lobes(&self) -> bool {
        match self {
            Self::Dielectric(_)
            | Self::RoughDielectric(_)
            | Self::Microfacet(_)
            | Self::ThinDielectric(_)
            | Self::Plastic(_)
            | Self::RoughPlastic(_)
            | Self::Principled(_)
            | Self::PrincipledThin(_) => true,
            Self::Diffuse(_)
            | Self::Mirror { .. }
            | Self::Conductor(_)
            | Self::RoughConductor(_)
            | Self::Null => false,
        }
    }

    /// The factor by which passing from the side of `to_light` to that of `to_camera` scales radiance, given
    /// the cosines of the two: (n_camera/n_light)², or one on the same side.
    #[inline]
    pub fn radiance_scale(&self, to_light_cos: f32, to_camera_cos: f32) -> f32 {
        if to_light_cos * to_camera_cos > 0.0 {
            return 1.0;
        }
        let (interior, exterior) = match self {
            Self::Dielectric(b) => (b.interior_ior, b.exterior_ior),
            Self::RoughDielectric(b) => b.indices(),
            Self::Principled(b) => (b.eta, 1.0),
            _ => return 1.0,
        };
        let ratio = if to_light_cos > 0.0 { interior / exterior } else { exterior / interior };
        ratio * ratio
    }

    /// Whether it has an inside, which is another medium than what is around.
    #[inline]
    pub fn bounds_a_medium(&self) -> bool {
        matches!(self, Self::Dielectric(_) | Self::RoughDielectric(_))
    }

    /// Whether light can pass from one side to the other.
    #[inline]
    pub fn transmits(&self) -> bool {
        match self {
            Self::Dielectric(_) | Self::RoughDielectric(_) | Self::ThinDielectric(_) | Self::Null => true,
            Self::Principled(b) => b.transmits(),
            Self::PrincipledThin(b) => b.transmits(),
            Self::Diffuse(_)
            | Self::Mirror { .. }
            | Self::Conductor(_)
            | Self::RoughConductor(_)
            | Self::Microfacet(_)
            | Self::Plastic(_)
            | Self::RoughPlastic(_) => false,
        }
    }
}

/// A sample that carries no light is absorbed.
#[inline]
fn lit(s: Scattered) -> Option<Scattered> {
    (!s.value.is_black()).then_some(s)
}
