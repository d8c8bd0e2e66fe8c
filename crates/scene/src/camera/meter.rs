//! Meters: one ray, and the irradiance of a surface.

use caustica_math::spherical::{between, cross, dot};
use caustica_math::{Distribution1d, Frame, SolidAnglePdf, Vec2, Vec3, warp};

use super::film::Film;
use super::{Camera, CameraLink, CameraPoint, CameraRay};
use crate::surface::Surfaces;

/// The most pixels of an irradiance meter. All are the same, and every light path is joined with each.
const MOST_PIXELS: f32 = 4096.0;

/// Film positions keep so far off a pixel's edges, where directions have no density.
const EDGE: f32 = 2e-7;

/// The surface of an irradiance meter, whose points are chosen evenly by area. A place within a pixel, whichever,
/// is a direction above the surface, by its cosine.
#[derive(Debug)]
pub(super) struct Patch {
    body: Body,
}

#[derive(Debug)]
enum Body {
    Triangles { facets: Vec<Facet>, choice: Distribution1d },
    Sphere { center: Vec3, radius: f32, offset: f32 },
}

#[derive(Clone, Copy, Debug)]
struct Facet {
    corners: [Vec3; 3],
    normal: Vec3,
    offset: f32,
}

/// A point of the meter.
struct Spot {
    at: Vec3,
    frame: Frame,
    /// Where rays start.
    start: Vec3,
}

impl Spot {
    fn new(at: Vec3, normal: Vec3, offset: f32) -> Self {
        Self { at, frame: Frame::from_normal(normal), start: at + normal * offset }
    }

    /// The link to what is seen in a direction, at a squared distance or infinitely far away.
    fn link(&self, towards: Vec3, falloff: f32) -> Option<CameraLink> {
        let local = self.frame.to_local(towards);
        let [x, y] = warp::inverse_cosine_hemisphere(local).map(within);
        (local.z > 0.0).then(|| CameraLink {
            point: CameraPoint { at: self.at, infinite: false },
            direction: -towards,
            end: self.start,
            film: Vec2::new(x, y),
            pdf: warp::cosine_hemisphere_pdf(local.z),
            falloff,
            t_max: f32::INFINITY,
        })
    }
}

impl Patch {
    /// From a shape of the scene.
    pub fn new(surfaces: &Surfaces, shape: u32, film: &Film) -> Result<Self, &'static str> {
        if film.width * film.height > MOST_PIXELS {
            return Err(
                "an irradiance meter has 4096 pixels at most: they are all the same, and one will do",
            );
        }
        let message = "an irradiance meter needs a shape of the scene to stand on";
        let flat = surfaces.shapes.get(shape as usize).ok_or(message)?;
        let first = flat.first_primitive;
        if let Some(sphere) = surfaces.sphere(first) {
            let offset = surfaces.sphere_point(first, Vec3::Z).offset;
            let body = Body::Sphere { center: sphere.center, radius: sphere.radius, offset };
            return Ok(Self { body });
        }
        let facet = |primitive| {
            let point = surfaces.triangle_point(primitive, 0.25, 0.25);
            Facet { corners: surfaces.corners(primitive), normal: point.normal, offset: point.offset }
        };
        let facets: Vec<Facet> = (first..first + flat.primitive_count).map(facet).collect();
        let areas: Vec<f64> = facets.iter().map(|f| area(f.corners)).collect();
        let all: f64 = areas.iter().sum();
        let shares: Vec<f32> = areas.iter().map(|a| (a / all) as f32).collect();
        let choice = Distribution1d::new(&shares).ok_or(message)?;
        Ok(Self { body: Body::Triangles { facets, choice } })
    }

    /// A point in the midst of it, with axes that look off the surface.
    pub fn middle(&self) -> (Vec3, [Vec3; 3]) {
        let spot = self.spot([0.5; 2]);
        (spot.at, [spot.frame.x, spot.frame.y, spot.frame.z])
    }

    fn spot(&self, u: [f32; 2]) -> Spot {
        match &self.body {
            Body::Sphere { center, radius, offset } => {
                let normal = warp::uniform_sphere(u);
                Spot::new(*center + normal * *radius, normal, *offset)
            }
            Body::Triangles { facets, choice } => {
                let chosen = choice.sample(u[0]);
                let facet = &facets[chosen.index];
                let [b1, b2] = warp::uniform_triangle([chosen.remapped, u[1]]);
                let [a, b, c] = facet.corners;
                Spot::new(a * (1.0 - b1 - b2) + b * b1 + c * b2, facet.normal, facet.offset)
            }
        }
    }

    pub fn ray(&self, film: Vec2, u: [f32; 2]) -> CameraRay {
        let spot = self.spot(u);
        let local = warp::cosine_hemisphere([film.x - film.x.floor(), film.y - film.y.floor()].map(within));
        CameraRay {
            point: CameraPoint { at: spot.at, infinite: false },
            origin: spot.start,
            direction: spot.frame.to_world(local),
            t_max: f32::INFINITY,
            pdf: warp::cosine_hemisphere_pdf(local.z),
        }
    }

    pub fn link(&self, from: Vec3, u: [f32; 2]) -> Option<CameraLink> {
        let spot = self.spot(u);
        let d = from - spot.at;
        let squared = d.length_squared();
        (squared > 0.0).then(|| spot.link(d * (1.0 / squared.sqrt()), 1.0 / squared))?
    }

    pub fn link_to_infinity(&self, towards: Vec3, u: [f32; 2]) -> Option<CameraLink> {
        self.spot(u).link(towards, 1.0)
    }
}

fn within(c: f32) -> f32 {
    c.clamp(EDGE, 1.0 - EDGE)
}

fn area([a, b, c]: [Vec3; 3]) -> f64 {
    let normal = cross(between(a, b), between(a, c));
    0.5 * dot(normal, normal).sqrt()
}

impl Camera {
    /// The ray of a radiance meter.
    pub(super) fn only_ray(&self) -> CameraRay {
        let place = &self.place;
        CameraRay {
            point: CameraPoint { at: place.origin, infinite: false },
            origin: place.origin + place.axes[2] * place.near,
            direction: place.axes[2],
            t_max: place.far - place.near,
            pdf: SolidAnglePdf(1.0),
        }
    }
}
