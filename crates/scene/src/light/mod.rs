//! Lamps as the renderer samples them.
//!
//! Two densities must not be mixed up. *Emission* starts a light path: a lamp is chosen, then a point on it
//! and a direction. *Next-event estimation* looks for a lamp from a given place, and may choose otherwise.
//! Both include the probability of choosing the lamp.

mod area;
mod daylight;
mod delta;
mod environment;
mod lights;
mod projector;
mod quad;
mod receiver;
mod seen;
mod table;
mod tree;

use caustica_math::{AreaPdf, SolidAnglePdf, Spectrum, Vec2, Vec3, Wavelengths};

use crate::surface::{SurfacePoint, Surfaces};
use crate::texture::TextureTable;

pub use area::AreaLight;
pub use daylight::{Heaven, LEAST_APERTURE, SUN_DIAMETER, SkyLight, SunLight};
pub use delta::{DirectionalLight, Falloff, SpotLight};
pub use environment::{EnvironmentLight, EnvironmentMap};
pub use lights::{FEWEST_PARTS, Lights};
pub use projector::ProjectorLight;
pub use receiver::Receiver;
pub use table::LightQuery;
pub(crate) use table::power_through_disk;
pub use tree::Leaf;

/// What a point on a lamp is attached to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// A place on a surface, with a normal.
    Surface,
    /// A place in space, without extent.
    Point,
    /// A direction: a point infinitely far away.
    Infinite,
}

/// A point on a lamp: the first vertex of a light path.
#[derive(Clone, Copy, Debug)]
pub struct LightPoint {
    /// Index of the lamp.
    pub light: u32,
    /// What it is attached to.
    pub anchor: Anchor,
    /// Its position or, at infinity, the unit direction *towards* it.
    pub at: Vec3,
    /// The normal of the emitting side; zero without a surface.
    pub normal: Vec3,
    /// Texture coordinates on a surface.
    pub uv: Vec2,
    /// Primitive that it lies on, if on a surface.
    pub primitive: u32,
    /// Distance by which rays start off the surface.
    pub offset: f32,
}

impl LightPoint {
    /// A point in space.
    pub(crate) fn point(light: u32, at: Vec3) -> Self {
        Self {
            light,
            anchor: Anchor::Point,
            at,
            normal: Vec3::ZERO,
            uv: Vec2::default(),
            primitive: u32::MAX,
            offset: 0.0,
        }
    }

    /// A point at infinity, in the unit direction `towards` it.
    pub fn infinite(light: u32, towards: Vec3) -> Self {
        Self { anchor: Anchor::Infinite, ..Self::point(light, towards) }
    }

    /// A point on an emitting surface.
    #[inline]
    pub fn on_surface(light: u32, p: &SurfacePoint) -> Self {
        Self {
            light,
            anchor: Anchor::Surface,
            at: p.position,
            normal: p.normal,
            uv: p.uv,
            primitive: p.primitive,
            offset: p.offset,
        }
    }

    /// The unit direction from `from` to this point and the distance (infinite at infinity).
    #[inline]
    pub fn direction_from(&self, from: Vec3) -> (Vec3, f32) {
        if self.anchor == Anchor::Infinite {
            return (self.at, f32::INFINITY);
        }
        let d = self.at - from;
        let distance = d.length();
        (d * (1.0 / distance), distance)
    }

    /// |cos| between a direction and the surface's normal; one where there is no surface.
    #[inline]
    pub fn cos(&self, direction: Vec3) -> f32 {
        if self.anchor == Anchor::Surface { self.normal.dot(direction).abs() } else { 1.0 }
    }

    /// The start of a ray that leaves in `direction`.
    #[inline]
    pub fn off_surface(&self, direction: Vec3) -> Vec3 {
        self.at + self.normal * self.offset.copysign(self.normal.dot(direction))
    }
}

/// The beginning of a light path.
#[derive(Clone, Copy, Debug)]
pub struct Emission {
    /// Where it begins.
    pub point: LightPoint,
    /// Start of the first ray; for lamps at infinity a point outside of the scene's bounds.
    pub origin: Vec3,
    /// The unit direction in which the light travels.
    pub direction: Vec3,
    /// Radiance (surfaces and environments), intensity (points) or irradiance (directional).
    pub radiance: Spectrum,
    /// |cos θ| at the surface that emits; one elsewhere.
    pub cos: f32,
    /// Densities.
    pub pdf: EmissionPdf,
}

/// The two densities of emission.
#[derive(Clone, Copy, Debug, Default)]
pub struct EmissionPdf {
    /// Of the first vertex in its own measure, times the probability of the lamp.
    pub point: AreaPdf,
    /// Of the direction, per solid angle; at infinity of the origin, per area across the direction.
    pub direction: SolidAnglePdf,
}

/// A point on a lamp found from somewhere.
#[derive(Clone, Copy, Debug)]
pub struct Towards {
    /// The point.
    pub point: LightPoint,
    /// Unit direction to it.
    pub direction: Vec3,
    /// Distance to it; infinite at infinity.
    pub distance: f32,
    /// Radiance, intensity or irradiance that leaves it towards the asker.
    pub radiance: Spectrum,
    /// Density in the point's own measure, times the probability of the lamp.
    pub pdf: AreaPdf,
}

/// The parts of a scene that lamps refer to.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a> {
    /// Surfaces.
    pub surfaces: &'a Surfaces,
    /// Textures.
    pub textures: TextureTable<'a>,
    /// Centre of a sphere around all surfaces.
    pub center: Vec3,
    /// Radius of that sphere.
    pub radius: f32,
    /// What spectra mean.
    pub wavelengths: Wavelengths,
}

impl Surroundings<'_> {
    /// The density over the disk across the scene from which lamps at infinity emit, in m⁻².
    #[inline]
    pub(crate) fn disk_pdf(&self) -> SolidAnglePdf {
        SolidAnglePdf(std::f32::consts::FRAC_1_PI / (self.radius * self.radius))
    }

    /// A point of that disk for light travelling in `direction`.
    pub(crate) fn disk_point(&self, direction: Vec3, u: [f32; 2]) -> Vec3 {
        let p = caustica_math::warp::concentric_disk(u);
        let frame = caustica_math::Frame::from_normal(direction);
        self.center + (frame.x * p.x + frame.y * p.y - direction) * self.radius
    }
}

/// A lamp.
#[derive(Debug)]
pub enum Light {
    /// A surface that emits.
    Area(AreaLight),
    /// A point of equal intensity in all directions.
    Point {
        /// Where it is.
        position: Vec3,
        /// W·sr⁻¹.
        intensity: Spectrum,
    },
    /// A point that lights a cone.
    Spot(SpotLight),
    /// A point that throws a picture.
    Projector(Box<ProjectorLight>),
    /// A surface that emits along its normals alone.
    Collimated(AreaLight),
    /// Parallel light.
    Directional(DirectionalLight),
    /// Light from infinitely far away that a path can meet: from everywhere, or from a disc.
    Environment(EnvironmentLight),
}

impl Light {
    /// Whether a path can never hit it by chance.
    #[inline]
    pub fn is_delta(&self) -> bool {
        match self {
            Self::Point { .. }
            | Self::Spot(_)
            | Self::Projector(_)
            | Self::Collimated(_)
            | Self::Directional(_) => true,
            Self::Area(_) | Self::Environment(_) => false,
        }
    }

    /// Whether it is infinitely far away.
    #[inline]
    pub fn is_infinite(&self) -> bool {
        matches!(self, Self::Directional(_) | Self::Environment(_))
    }
}
