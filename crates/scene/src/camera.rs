//! Cameras as the renderer samples them.
//!
//! A camera maps film positions to rays. Its density is the film area (in pixels) per unit of its rays'
//! measure: with one eye path a pixel, that is the number of eye paths that leave per solid angle (or, for
//! parallel projection, per area), and at the same time the factor by which a light path that arrives
//! contributes to the film.

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use caustica_math::elementary::{atan2, sin_cos, tan};
use caustica_math::{SolidAnglePdf, Vec2, Vec3, warp};

use crate::description::{self, CameraKind, FilmSettings};
use crate::diagnostic::Diagnostic;
use crate::surface::{FARTHEST, is_reachable, unreachable};

/// A camera in world space.
#[derive(Clone, Debug)]
pub struct Camera {
    projection: Projection,
    origin: Vec3,
    /// Left, up and forward, of length one.
    axes: [Vec3; 3],
    width: f32,
    height: f32,
    near: f32,
    far: f32,
}

#[derive(Clone, Copy, Debug)]
enum Projection {
    /// Pinhole (radius 0) and thin lens. `pixel` is the size of a pixel on the plane z = 1.
    Lens { pixel: f32, radius: f32, focus: f32 },
    /// `pixel` is the size of a pixel in the world.
    Orthographic { pixel: f32 },
    /// Equirectangular.
    Environment,
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
    /// pixels.
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

impl Camera {
    /// From its description.
    ///
    /// # Errors
    /// A transform that cannot be inverted, or figures out of range.
    pub fn new(camera: &description::Camera, film: &FilmSettings) -> Result<Self, Diagnostic> {
        let error = |what: &str| Diagnostic::error(what).at(camera.origin.clone());
        if !camera.to_world.is_invertible() {
            return Err(error("the camera's transform cannot be inverted"));
        }
        let origin = camera.to_world.point(Vec3::ZERO);
        if !is_reachable(origin) {
            return Err(error(&format!("the camera's position is {}", unreachable(origin))));
        }
        if !(camera.near >= 0.0 && camera.far > camera.near) {
            return Err(error("the camera's far clip must lie beyond its near clip, and both be positive"));
        }
        let column = |axis| camera.to_world.vector(axis);
        let unit = |axis| {
            column(axis).try_normalized().ok_or_else(|| error("the camera's transform flattens space"))
        };
        let axes = [unit(Vec3::X)?, unit(Vec3::Y)?, unit(Vec3::Z)?];
        if shears(axes) {
            return Err(error("the camera's transform shears space: its axes must be at right angles"));
        }
        let width = film.width as f32;
        let projection = match camera.kind {
            CameraKind::Perspective { fov } => lens(fov, (0.0, 1.0), film).map_err(|m| error(&m))?,
            CameraKind::ThinLens { fov, aperture_radius, focus_distance } => {
                lens(fov, (aperture_radius, focus_distance), film).map_err(|m| error(&m))?
            }
            CameraKind::Orthographic => {
                let pixel = 2.0 * column(Vec3::X).length() / width;
                let message = "the camera's transform scales so much that its pixels have no size";
                is_resolved(pixel, 1.0)
                    .then_some(Projection::Orthographic { pixel })
                    .ok_or_else(|| error(message))?
            }
            CameraKind::Environment => Projection::Environment,
        };
        Ok(Self {
            projection,
            origin,
            axes,
            width,
            height: film.height as f32,
            near: camera.near,
            far: camera.far,
        })
    }

    /// Whether all rays have one direction.
    pub fn is_parallel(&self) -> bool {
        matches!(self.projection, Projection::Orthographic { .. })
    }

    fn to_world(&self, v: Vec3) -> Vec3 {
        self.axes[0] * v.x + self.axes[1] * v.y + self.axes[2] * v.z
    }

    /// World direction to the camera frame.
    fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.axes[0]), v.dot(self.axes[1]), v.dot(self.axes[2]))
    }

    /// A film position to the plane z = 1 (or, for parallel projection, the plane of the film).
    fn to_plane(&self, film: Vec2, pixel: f32) -> Vec2 {
        Vec2::new((0.5 * self.width - film.x) * pixel, (0.5 * self.height - film.y) * pixel)
    }

    /// The inverse of `to_plane`.
    fn to_film(&self, x: f32, y: f32, pixel: f32) -> Vec2 {
        Vec2::new(0.5 * self.width - x / pixel, 0.5 * self.height - y / pixel)
    }

    /// The ray through a film position (in pixels) and, with a lens, the point of the lens that `u` gives.
    pub fn ray(&self, film: Vec2, u: [f32; 2]) -> CameraRay {
        match self.projection {
            Projection::Lens { pixel, radius, focus } => {
                let p = self.to_plane(film, pixel);
                let lens = lens_point(radius, u);
                let local = Vec3::new(p.x * focus - lens.x, p.y * focus - lens.y, focus).normalized();
                let start = self.origin + self.to_world(Vec3::new(lens.x, lens.y, 0.0));
                let direction = self.to_world(local);
                CameraRay {
                    point: CameraPoint { at: start, infinite: false },
                    origin: start + direction * (self.near / local.z),
                    direction,
                    t_max: (self.far - self.near) / local.z,
                    pdf: lens_pdf(local.z, pixel),
                }
            }
            Projection::Orthographic { pixel } => {
                let p = self.to_plane(film, pixel);
                CameraRay {
                    point: CameraPoint { at: -self.axes[2], infinite: true },
                    origin: self.origin + self.to_world(Vec3::new(p.x, p.y, self.near)),
                    direction: self.axes[2],
                    t_max: self.far - self.near,
                    pdf: SolidAnglePdf(1.0 / (pixel * pixel)),
                }
            }
            Projection::Environment => {
                let (sin_theta, cos_theta) = sin_cos(PI * film.y / self.height);
                let (sin_phi, cos_phi) = sin_cos(TAU * (0.5 - film.x / self.width));
                let direction = self.to_world(Vec3::new(sin_phi * sin_theta, cos_theta, cos_phi * sin_theta));
                CameraRay {
                    point: CameraPoint { at: self.origin, infinite: false },
                    origin: self.origin + direction * self.near,
                    direction,
                    t_max: self.far - self.near,
                    pdf: self.environment_pdf(sin_theta),
                }
            }
        }
    }

    fn environment_pdf(&self, sin_theta: f32) -> SolidAnglePdf {
        // The pole itself has no density; keep it finite.
        SolidAnglePdf(self.width * self.height * (0.5 * FRAC_1_PI * FRAC_1_PI) / sin_theta.abs().max(1e-6))
    }

    /// Joins a point with the camera, through the point of the lens that `u` gives. `None` if the point is
    /// behind the camera or beyond a clip plane. Whether it falls into the picture is not tested.
    pub fn connect(&self, from: Vec3, u: [f32; 2]) -> Option<CameraLink> {
        let relative = self.to_local(from - self.origin);
        match self.projection {
            Projection::Lens { pixel, radius, focus } => {
                if relative.z <= self.near || relative.z > self.far {
                    return None;
                }
                let lens = lens_point(radius, u);
                let d = Vec3::new(relative.x - lens.x, relative.y - lens.y, relative.z);
                let distance = d.length();
                let k = focus / d.z;
                let film = self.to_film((lens.x + d.x * k) / focus, (lens.y + d.y * k) / focus, pixel);
                let start = self.origin + self.to_world(Vec3::new(lens.x, lens.y, 0.0));
                let direction = (start - from) * (1.0 / distance);
                Some(CameraLink {
                    point: CameraPoint { at: start, infinite: false },
                    direction,
                    end: start - direction * (self.near * distance / d.z),
                    film,
                    pdf: lens_pdf(d.z / distance, pixel),
                    falloff: 1.0 / (distance * distance),
                    t_max: f32::INFINITY,
                })
            }
            Projection::Orthographic { pixel } => {
                if relative.z <= self.near || relative.z > self.far {
                    return None;
                }
                Some(CameraLink {
                    point: CameraPoint { at: -self.axes[2], infinite: true },
                    direction: -self.axes[2],
                    end: from - self.axes[2] * (relative.z - self.near),
                    film: self.to_film(relative.x, relative.y, pixel),
                    pdf: SolidAnglePdf(1.0 / (pixel * pixel)),
                    falloff: 1.0,
                    t_max: f32::INFINITY,
                })
            }
            Projection::Environment => {
                let distance = relative.length();
                if distance <= self.near || distance > self.far {
                    return None;
                }
                let d = relative * (1.0 / distance);
                let sin_theta = sin_theta(d);
                let direction = (self.origin - from) * (1.0 / distance);
                Some(CameraLink {
                    point: CameraPoint { at: self.origin, infinite: false },
                    direction,
                    end: self.origin - direction * self.near,
                    film: self.direction_to_film(d),
                    pdf: self.environment_pdf(sin_theta),
                    falloff: 1.0 / (distance * distance),
                    t_max: f32::INFINITY,
                })
            }
        }
    }

    /// Joins a point at infinity, in the unit direction `towards` it, with the camera. `None` if it is behind
    /// the camera, or if that too is at infinity.
    pub fn connect_direction(&self, towards: Vec3, u: [f32; 2]) -> Option<CameraLink> {
        let d = self.to_local(towards);
        let (lens, film, pdf, per_z) = match self.projection {
            Projection::Lens { pixel, radius, focus } => {
                if d.z <= 0.0 {
                    return None;
                }
                let lens = lens_point(radius, u);
                // Where the ray from the lens crosses the plane that is in focus, at the scale of z = 1.
                let film = self.to_film(lens.x / focus + d.x / d.z, lens.y / focus + d.y / d.z, pixel);
                (lens, film, lens_pdf(d.z, pixel), d.z)
            }
            Projection::Orthographic { .. } => return None,
            Projection::Environment => {
                let sin_theta = sin_theta(d);
                (Vec2::default(), self.direction_to_film(d), self.environment_pdf(sin_theta), 1.0)
            }
        };
        let start = self.origin + self.to_world(Vec3::new(lens.x, lens.y, 0.0));
        Some(CameraLink {
            point: CameraPoint { at: start, infinite: false },
            direction: -towards,
            end: start + towards * (self.near / per_z),
            film,
            pdf,
            falloff: 1.0,
            t_max: (self.far - self.near) / per_z,
        })
    }

    /// Where a 360° picture shows a unit direction of the camera frame.
    fn direction_to_film(&self, d: Vec3) -> Vec2 {
        Vec2::new(
            (0.5 - atan2(d.x, d.z) * (0.5 * FRAC_1_PI)) * self.width,
            atan2(sin_theta(d), d.y) * FRAC_1_PI * self.height,
        )
    }

    /// Whether it makes use of the point of the lens that it is given.
    pub fn has_lens(&self) -> bool {
        matches!(self.projection, Projection::Lens { radius, .. } if radius > 0.0)
    }

    /// Whether the picture goes on beyond its edges: see [`Camera::aliases`].
    #[inline]
    pub fn wraps(&self) -> bool {
        matches!(self.projection, Projection::Environment)
    }

    /// All film positions within `margin` pixels of the picture that show the same as `film`: itself, and
    /// for a 360° picture those beyond its seams and poles, which pixel filters reach across.
    pub fn aliases(&self, film: Vec2, margin: f32) -> impl Iterator<Item = Vec2> + use<> {
        let around = self.wraps();
        let (w, h) = (self.width, self.height);
        let rows = [film.y, -film.y, 2.0 * h - film.y];
        let columns = [0.0, w, -w, 0.5 * w, -0.5 * w, 1.5 * w];
        let inside =
            move |p: &Vec2| p.x >= -margin && p.x <= w + margin && p.y >= -margin && p.y <= h + margin;
        let candidates = rows.into_iter().enumerate().flat_map(move |(r, y)| {
            columns.into_iter().enumerate().filter_map(move |(c, dx)| {
                // Across a pole the picture continues half a turn away.
                let same = (r == 0 && c < 3) || (r > 0 && c >= 3);
                (same && (around || (r == 0 && c == 0))).then(|| Vec2::new(film.x + dx, y))
            })
        });
        candidates.filter(inside)
    }

    /// Where the camera looks: a unit vector.
    pub fn forward(&self) -> Vec3 {
        self.axes[2]
    }

    /// The near and the far clip plane.
    pub fn clips(&self) -> (f32, f32) {
        (self.near, self.far)
    }

    /// Where the camera is.
    pub fn position(&self) -> Vec3 {
        self.origin
    }
}

/// Pixels that cover a smaller angle could not be told apart by directions in single precision.
const SHARPEST: f32 = 1e-8;

/// A lens of that field of view, radius and focus distance.
fn lens(fov: f32, (radius, focus): (f32, f32), film: &FilmSettings) -> Result<Projection, String> {
    let valid = fov > 0.0 && fov < 180.0 && (0.0..=FARTHEST).contains(&radius);
    if !(valid && (1.0 / FARTHEST..=FARTHEST).contains(&focus)) {
        return Err(format!(
            "the camera's field of view must lie between 0 and 180 degrees, its lens radius be zero or more and its focus distance positive, and neither beyond {FARTHEST:e}"
        ));
    }
    let pixel = 2.0 * tan(0.5 * fov.to_radians()) / film.width as f32;
    // At the picture's corners pixels are seen at the greatest angle.
    let (x, y) = (0.5 * pixel * film.width as f32, 0.5 * pixel * film.height as f32);
    let cos = 1.0 / (1.0 + x * x + y * y).sqrt();
    if pixel >= SHARPEST && is_resolved(pixel, cos) {
        Ok(Projection::Lens { pixel, radius, focus })
    } else {
        Err(format!("the camera's field of view of {fov} degrees is too near to 0 or 180 to be rendered"))
    }
}

/// Whether the density of a pixel of that size, seen at that cosine, can be counted with.
fn is_resolved(pixel: f32, cos: f32) -> bool {
    let density = lens_pdf(cos, pixel).0;
    pixel > 0.0 && (1e-30..=1e30).contains(&density)
}

/// Whether three unit vectors are not at right angles.
pub(crate) fn shears([x, y, z]: [Vec3; 3]) -> bool {
    x.dot(y).abs().max(y.dot(z).abs()).max(z.dot(x).abs()) > 1e-4
}

/// The sine of the angle to the upper pole of a 360° picture.
fn sin_theta(d: Vec3) -> f32 {
    (d.x * d.x + d.z * d.z).sqrt()
}

fn lens_point(radius: f32, u: [f32; 2]) -> Vec2 {
    if radius == 0.0 { Vec2::default() } else { warp::concentric_disk(u) * radius }
}

/// Film area in pixels per solid angle: a pixel covers pixel²·cos³ at distance one.
fn lens_pdf(cos: f32, pixel: f32) -> SolidAnglePdf {
    SolidAnglePdf(1.0 / (pixel * pixel * cos * cos * cos))
}
