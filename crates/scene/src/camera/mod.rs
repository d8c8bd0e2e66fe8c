//! Cameras as the renderer samples them.
//!
//! A camera maps film positions to rays. Its density is the film area (in pixels) per unit of its rays'
//! measure: with one eye path a pixel, that is the number of eye paths that leave per solid angle (or, for
//! parallel projection, per area), and at the same time the factor by which a light path that arrives
//! contributes to the film.

mod around;
mod film;
mod lens;
mod meter;
mod parallel;

use std::sync::Arc;

use caustica_math::{SolidAnglePdf, Vec2, Vec3};

use crate::description::{self, CameraKind, FilmSettings};
use crate::diagnostic::Diagnostic;
use crate::surface::{Surfaces, is_reachable, unreachable};
use film::Film;
pub(crate) use film::film_settings;
use lens::Lens;
use meter::Patch;

/// A camera in world space.
#[derive(Clone, Debug)]
pub struct Camera {
    projection: Projection,
    place: Place,
    film: Film,
    hides_lamps: bool,
}

/// Where a camera stands, and how far it sees.
#[derive(Clone, Copy, Debug)]
struct Place {
    origin: Vec3,
    /// Left, up and forward, of length one.
    axes: [Vec3; 3],
    near: f32,
    far: f32,
}

#[derive(Clone, Debug)]
enum Projection {
    /// Pinhole (radius 0) and thin lens.
    Lens(Lens),
    /// `pixel` is the size of a pixel in the world.
    Orthographic { pixel: f32 },
    /// Equirectangular.
    Environment,
    /// One ray.
    Ray,
    /// All directions above a surface.
    Patch(Arc<Patch>),
}

/// The first vertex of an eye path: a place on the lens or, for parallel projection, a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraPoint {
    /// Its position or, at infinity, the unit direction towards the camera.
    pub at: Vec3,
    /// Whether it is infinitely far away.
    pub infinite: bool,
}

/// A ray from the camera.
#[derive(Clone, Copy, Debug)]
pub struct CameraRay {
    /// The vertex that it comes from.
    pub point: CameraPoint,
    /// Where it starts: on the near plane.
    pub origin: Vec3,
    /// The unit direction.
    pub direction: Vec3,
    /// Where it ends: on the far plane.
    pub t_max: f32,
    /// Density of its direction (at infinity: of its origin across the direction), with film positions in
    /// pixels. (A single ray has a Dirac distribution, whose coefficient is one.)
    pub pdf: SolidAnglePdf,
}

/// A connection of a point to the camera.
#[derive(Clone, Copy, Debug)]
pub struct CameraLink {
    /// The vertex that it joins.
    pub point: CameraPoint,
    /// Unit direction from the given point to the camera.
    pub direction: Vec3,
    /// Where the segment that must be free ends: on the near plane.
    pub end: Vec3,
    /// Where the point is seen, in pixels from the upper left corner of the full picture.
    pub film: Vec2,
    /// As [`CameraRay::pdf`], for the ray through the point.
    pub pdf: SolidAnglePdf,
    /// What turns `pdf` into a density per area that faces the ray: 1/d², or 1 at infinity.
    pub falloff: f32,
    /// For a point at infinity, how far from `end` surfaces are seen; otherwise infinite.
    pub t_max: f32,
}

/// What a camera can be joined with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joins {
    /// All that it sees.
    All,
    /// All but what is at infinity: all its rays have one direction.
    Near,
    /// Nothing: it has no extent, neither in place nor in direction.
    Nothing,
}

impl Camera {
    /// From its description.
    ///
    /// # Errors
    /// A transform that cannot be inverted, or figures out of range; and an irradiance meter, which stands on
    /// the surfaces of a scene: see [`Camera::among`].
    pub fn new(camera: &description::Camera, film: &FilmSettings) -> Result<Self, Diagnostic> {
        Self::among(&Surfaces::default(), camera, film)
    }

    /// From its description, and the surfaces of the scene that it is in.
    ///
    /// # Errors
    /// As [`Camera::new`], but for irradiance meters that stand on one of them.
    pub fn among(
        surfaces: &Surfaces,
        camera: &description::Camera,
        film: &FilmSettings,
    ) -> Result<Self, Diagnostic> {
        let error = |what: &str| Diagnostic::error(what).at(camera.origin.clone());
        if !camera.to_world.is_invertible() {
            return Err(error("the camera's transform cannot be inverted"));
        }
        if !(camera.near >= 0.0 && camera.far > camera.near) {
            return Err(error("the camera's far clip must lie beyond its near clip, and both be positive"));
        }
        let flat = Film::new(film, camera.principal_point).map_err(error)?;
        let mut place = place(camera).map_err(|m| error(&m))?;
        let with_lens = |fov, thin| Lens::new(fov, thin, &flat).map_err(|m| error(&m));
        let projection = match camera.kind {
            CameraKind::Perspective { fov } => Projection::Lens(with_lens(fov, (0.0, 1.0))?),
            CameraKind::ThinLens { fov, aperture_radius, focus_distance } => {
                Projection::Lens(with_lens(fov, (aperture_radius, focus_distance))?)
            }
            CameraKind::Orthographic => {
                let width = 2.0 * camera.to_world.vector(Vec3::X).length();
                Projection::Orthographic { pixel: parallel::pixel(width, &flat).map_err(error)? }
            }
            CameraKind::Environment => Projection::Environment,
            CameraKind::RadianceMeter => Projection::Ray,
            CameraKind::IrradianceMeter { shape } => {
                let patch = Patch::new(surfaces, shape, &flat).map_err(error)?;
                (place.origin, place.axes) = patch.middle();
                Projection::Patch(Arc::new(patch))
            }
        };
        Ok(Self { projection, place, film: flat, hides_lamps: camera.hides_lamps })
    }

    /// What light paths can be joined with it.
    #[inline]
    pub fn joins(&self) -> Joins {
        match self.projection {
            Projection::Orthographic { .. } => Joins::Near,
            Projection::Ray => Joins::Nothing,
            _ => Joins::All,
        }
    }

    /// Whether its rays pass through lamps, and see no environment.
    #[inline]
    pub fn hides_lamps(&self) -> bool {
        self.hides_lamps
    }

    /// What the film shows for a radiance of one from everywhere: π for an irradiance meter, one for all others.
    #[inline]
    pub fn response(&self) -> f32 {
        match self.projection {
            Projection::Patch(_) => std::f32::consts::PI,
            _ => 1.0,
        }
    }

    /// The ray through a film position (in pixels) and, with a lens, the point of the lens that `u` gives.
    pub fn ray(&self, film: Vec2, u: [f32; 2]) -> CameraRay {
        match &self.projection {
            Projection::Lens(lens) => self.lens_ray(lens, film, u),
            Projection::Orthographic { pixel } => self.parallel_ray(*pixel, film),
            Projection::Environment => self.ray_around(film),
            Projection::Ray => self.only_ray(),
            Projection::Patch(patch) => patch.ray(film, u),
        }
    }

    /// Joins a point with the camera, through the point of the lens that `u` gives. `None` if the point is
    /// behind the camera or beyond a clip plane. Whether it falls into the picture is not tested.
    pub fn connect(&self, from: Vec3, u: [f32; 2]) -> Option<CameraLink> {
        match &self.projection {
            Projection::Lens(lens) => self.lens_link(lens, from, u),
            Projection::Orthographic { pixel } => self.parallel_link(*pixel, from),
            Projection::Environment => self.link_around(from),
            Projection::Ray => None,
            Projection::Patch(patch) => patch.link(from, u),
        }
    }

    /// Joins a point at infinity, in the unit direction `towards` it, with the camera. `None` if it is behind
    /// the camera, or if that too is at infinity.
    pub fn connect_direction(&self, towards: Vec3, u: [f32; 2]) -> Option<CameraLink> {
        match &self.projection {
            Projection::Lens(lens) => self.lens_link_to_infinity(lens, towards, u),
            Projection::Environment => Some(self.link_around_to_infinity(towards)),
            Projection::Patch(patch) => patch.link_to_infinity(towards, u),
            Projection::Orthographic { .. } | Projection::Ray => None,
        }
    }

    /// Whether it makes use of the point of the lens that it is given.
    pub fn has_lens(&self) -> bool {
        match &self.projection {
            Projection::Lens(lens) => lens.is_open(),
            Projection::Patch(_) => true,
            _ => false,
        }
    }

    /// Whether the film shows things more than once: see [`Camera::aliases`].
    #[inline]
    pub fn wraps(&self) -> bool {
        matches!(self.projection, Projection::Environment | Projection::Patch(_))
    }

    /// All film positions within `margin` pixels of the picture that show the same as `film`: itself; for a 360°
    /// picture those beyond its seams and poles, which pixel filters reach across; and for an irradiance meter,
    /// all of whose pixels are the same, the place of each.
    pub fn aliases(&self, film: Vec2, margin: f32) -> impl Iterator<Item = Vec2> + use<> {
        let (everywhere, around) = match self.projection {
            Projection::Patch(_) => (true, false),
            Projection::Environment => (false, true),
            _ => (false, false),
        };
        let flat = self.film;
        let once = (!everywhere).then(|| flat.seams(film, margin, around));
        once.into_iter().flatten().chain(flat.tiles(film, everywhere))
    }

    /// Where the camera looks: a unit vector.
    pub fn forward(&self) -> Vec3 {
        self.place.axes[2]
    }

    /// The near and the far clip plane.
    pub fn clips(&self) -> (f32, f32) {
        (self.place.near, self.place.far)
    }

    /// Where the camera is.
    pub fn position(&self) -> Vec3 {
        self.place.origin
    }
}

impl Place {
    /// Camera frame to world direction.
    fn to_world(self, v: Vec3) -> Vec3 {
        self.axes[0] * v.x + self.axes[1] * v.y + self.axes[2] * v.z
    }

    /// World direction to the camera frame.
    fn to_local(self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.axes[0]), v.dot(self.axes[1]), v.dot(self.axes[2]))
    }

    /// Whether a point of the camera frame lies between the clip planes.
    fn sees(self, relative: Vec3) -> bool {
        relative.z > self.near && relative.z <= self.far
    }
}

fn place(camera: &description::Camera) -> Result<Place, String> {
    let origin = camera.to_world.point(Vec3::ZERO);
    if !is_reachable(origin) {
        return Err(format!("the camera's position is {}", unreachable(origin)));
    }
    let unit = |axis| {
        let column = camera.to_world.vector(axis);
        column.try_normalized().ok_or("the camera's transform flattens space")
    };
    let axes = [unit(Vec3::X)?, unit(Vec3::Y)?, unit(Vec3::Z)?];
    if shears(axes) {
        return Err("the camera's transform shears space: its axes must be at right angles".into());
    }
    Ok(Place { origin, axes, near: camera.near, far: camera.far })
}

/// Whether three unit vectors are not at right angles.
pub(crate) fn shears([x, y, z]: [Vec3; 3]) -> bool {
    x.dot(y).abs().max(y.dot(z).abs()).max(z.dot(x).abs()) > 1e-4
}
