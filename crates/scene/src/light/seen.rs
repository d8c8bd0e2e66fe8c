//! From where a flat lamp is looked for by area, and from where by the solid angle that it covers.

use caustica_math::spherical::{Relative, SphericalTriangle, between, cross, dot};
use caustica_math::{AreaPdf, Vec3};

use super::LightPoint;
use crate::surface::{POSITION_ERROR, Surfaces};

/// A flat lamp is sampled by solid angle from places whose squared distance from its centre is less than this
/// many times the sum of its squared sides (a square: the squared diagonal).
///
/// From farther away cos/d² varies so little over the lamp that solid angles, which take three times as long, do
/// not pay. Measured by relative error × time of `path` and `direct_ems` in boxes with five lamps: between 0.5 and 1
/// is best, and flat.
pub const NEAR: f32 = 0.75;

/// From a lower height above a lamp than that many times the rounding of positions, nobody can say how it is seen.
const LEAST_HEIGHT: f32 = 64.0;

/// The least height from which a surface is sampled by solid angle whose rays start off by `offset`.
#[inline]
pub fn least_height(offset: f32) -> f64 {
    f64::from(LEAST_HEIGHT * offset)
}

/// How a flat lamp is looked for from somewhere. Sampling and densities ask the same question.
pub enum Seen<S> {
    /// Not at all: it emits from its other side.
    Behind,
    /// By area.
    ByArea,
    /// By solid angle.
    Near(Near<S>),
}

/// A flat shape seen by its solid angle.
pub struct Near<S> {
    /// The shape.
    pub shape: S,
    /// The distance of its plane.
    pub height: f32,
    /// In sr.
    pub solid_angle: f32,
}

impl<S> Near<S> {
    /// The density of a point, per area: cos/d² over the solid angle.
    #[inline]
    pub fn area_pdf(&self, from: Vec3, point: &LightPoint) -> AreaPdf {
        let squared = point.at.distance_squared(from);
        let pdf = self.height / squared.sqrt() / (squared * self.solid_angle);
        // At the place itself nothing is found.
        AreaPdf(if squared > 0.0 { pdf } else { 0.0 })
    }
}

/// A shape of that solid angle. One that is seen edge-on covers none that could be sampled.
#[inline]
pub fn near<S>(shape: S, height: f64, solid_angle: f32) -> Seen<S> {
    if solid_angle >= LEAST_SOLID_ANGLE {
        Seen::Near(Near { shape, height: height as f32, solid_angle })
    } else {
        Seen::ByArea
    }
}

/// Smaller solid angles are rounding.
const LEAST_SOLID_ANGLE: f32 = 1e-12;

/// `corner` as it is seen from `from`.
#[inline]
pub fn relative(corner: Vec3, from: Vec3) -> Relative {
    between(from, corner)
}

/// Where the triangles of a lamp may be near: a sphere around all of it. From elsewhere nobody needs to look at
/// single triangles.
#[derive(Debug)]
pub struct Reach {
    center: Vec3,
    squared: f32,
}

impl Reach {
    /// Of some triangles.
    pub fn new(triangles: std::ops::Range<u32>, surfaces: &Surfaces) -> Self {
        let corners = || triangles.clone().flat_map(|t| surfaces.corners(t));
        let (low, high) = corners()
            .fold((Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY)), |(low, high), corner| {
                (low.min(corner), high.max(corner))
            });
        let center = (low + high) * 0.5;
        let radius = corners().map(|c| c.distance_squared(center)).fold(0.0, f32::max).sqrt();
        let sides = triangles.clone().map(|t| sides(surfaces.corners(t))).fold(0.0, f32::max);
        let reach = radius + (NEAR * sides).sqrt();
        Self { center, squared: reach * reach * 1.001 }
    }

    /// How one of the triangles is looked for.
    #[inline]
    pub fn triangle(&self, corners: impl FnOnce() -> [Vec3; 3], from: Vec3) -> Seen<SphericalTriangle> {
        if from.distance_squared(self.center) < self.squared {
            triangle(corners(), from)
        } else {
            Seen::ByArea
        }
    }
}

/// The sum of two squared sides.
#[inline]
fn sides([a, b, c]: [Vec3; 3]) -> f32 {
    (b - a).length_squared() + (c - a).length_squared()
}

/// How a triangle is looked for.
#[inline]
fn triangle(corners: [Vec3; 3], from: Vec3) -> Seen<SphericalTriangle> {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a);
    if normal.dot(from - a) < 0.0 {
        return Seen::Behind;
    }
    let center = (a + b + c) * (1.0 / 3.0);
    if center.distance_squared(from) < NEAR * sides(corners) {
        near_triangle(corners, from)
    } else {
        Seen::ByArea
    }
}

/// A triangle from near by.
fn near_triangle(corners: [Vec3; 3], from: Vec3) -> Seen<SphericalTriangle> {
    let [a, b, c] = corners.map(|corner| relative(corner, from));
    let [u, v] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
    let normal = cross(u, v);
    let height = -dot(normal, a) / dot(normal, normal).sqrt();
    let extent = corners.iter().fold(0.0, |m: f32, p| m.max(p.abs().max_element()));
    if height.is_nan() || height <= least_height(extent * POSITION_ERROR) {
        return Seen::ByArea;
    }
    let shape = SphericalTriangle::new([a, b, c]);
    near(shape, height, shape.solid_angle())
}
