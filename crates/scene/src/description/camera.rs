use caustica_math::{Filter, Transform};
use serde::{Deserialize, Serialize};

use crate::Origin;

/// A camera: its projection and its place.
///
/// In its own frame it looks along +z with +y up and **+x to the left** of the picture (Nori's
/// convention).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// The projection.
    pub kind: CameraKind,
    /// Camera frame to world. Its scale does not matter except to [`CameraKind::Orthographic`].
    pub to_world: Transform,
    /// Surfaces nearer than this along +z, in the scene's units, are not seen (by any but the environment camera, which takes
    /// it as a distance).
    pub near: f32,
    /// Surfaces farther than this along +z are not seen.
    pub far: f32,
    /// Where on the picture +z is seen, in shares of its width and height from the upper left corner: the middle
    /// unless the lens is shifted. Within a thousand. (Without effect on [`CameraKind::Environment`] and meters.)
    pub principal_point: [f32; 2],
    /// Whether lamps are invisible to it: rays from the camera pass through surfaces that are lamps, and see no
    /// environment. What lamps light, and their reflections, are seen all the same.
    pub hides_lamps: bool,
    /// Where it stands in the file.
    pub origin: Option<Origin>,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            kind: CameraKind::Perspective { fov: 30.0 },
            to_world: Transform::IDENTITY,
            near: 1e-4,
            far: 1e4,
            principal_point: [0.5; 2],
            hides_lamps: false,
            origin: None,
        }
    }
}

/// How a camera projects.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum CameraKind {
    /// A pinhole.
    Perspective {
        /// Horizontal field of view, in degrees: between 0 and 180, and such that a pixel covers at least 10⁻⁸ of
        /// the distance.
        fov: f32,
    },
    /// A thin lens.
    ThinLens {
        /// Horizontal field of view, in degrees.
        fov: f32,
        /// Radius of the lens.
        aperture_radius: f32,
        /// Distance along +z of the plane that is in focus.
        focus_distance: f32,
    },
    /// Parallel projection: the picture spans x from −1 to 1 of the camera frame, so that the width of
    /// what it sees is set by a scale in `to_world`.
    Orthographic,
    /// All directions around the camera as an equirectangular picture: +y of the camera frame is up,
    /// the picture's centre is +z.
    Environment,
    /// One ray, along +z: every pixel shows its radiance. Light paths cannot be joined with it.
    RadianceMeter,
    /// The irradiance (in W·m⁻² where radiance is in W·m⁻²·sr⁻¹) of a surface of the scene, its mean over the
    /// area: every pixel shows it. The pixel filter has no effect, nor have transform and clip planes. Up to 4096
    /// pixels.
    IrradianceMeter {
        /// Index of the shape, on the side of whose normals light is measured.
        shape: u32,
    },
}

impl CameraKind {
    /// Whether all pixels show one number.
    pub fn is_meter(&self) -> bool {
        matches!(self, Self::RadianceMeter | Self::IrradianceMeter { .. })
    }
}

/// The size, crop and filter of a film.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FilmSettings {
    /// Width of the full picture in pixels.
    pub width: u32,
    /// Height of the full picture in pixels.
    pub height: u32,
    /// The part of it to render; all of it if `None`.
    pub crop: Option<Crop>,
    /// The pixel (reconstruction) filter, of a radius up to 32.
    pub filter: Filter,
}

impl Default for FilmSettings {
    fn default() -> Self {
        Self { width: 1280, height: 720, crop: None, filter: Filter::default() }
    }
}

impl FilmSettings {
    /// The part of the picture that is rendered.
    pub fn window(&self) -> Crop {
        self.crop.unwrap_or(Crop { x: 0, y: 0, width: self.width, height: self.height })
    }
}

/// A rectangle of pixels; (0, 0) is the upper left corner of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Crop {
    /// Left edge.
    pub x: u32,
    /// Upper edge.
    pub y: u32,
    /// Width, at least 1.
    pub width: u32,
    /// Height, at least 1.
    pub height: u32,
}
