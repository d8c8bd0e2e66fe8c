//! A lamp of two triangles that are a parallelogram: most lamps are. It is sampled as a whole.

use caustica_math::spherical::{Relative, SphericalRectangle, SphericalTriangle, cross, dot};
use caustica_math::{AreaPdf, ONE_BELOW, Vec2, Vec3};

use super::seen::{NEAR, Seen, least_height, near, relative};
use super::{Anchor, LightPoint};
use crate::surface::{SurfacePoint, Surfaces};

/// By how much of its sides two triangles may fall short of a parallelogram. (Every point is on one of the
/// triangles and has the density that belongs to it, however large this is.)
const PARALLELOGRAM: f32 = 1e-4;

/// The same for rectangles whose solid angle is that of the true rectangle.
const RECTANGLE: f32 = 1e-5;

/// A parallelogram that emits from the side of its normal.
#[derive(Debug)]
pub struct Quad {
    /// Below and above the diagonal.
    halves: [Half; 2],
    center: Vec3,
    normal: Vec3,
    /// Squared distance of the centre within which it is sampled by solid angle.
    near: f32,
    least_height: f64,
    /// If it is a rectangle.
    rectangle: Option<Axes>,
}

/// One of the two triangles: the corner away from the diagonal and its two sides.
#[derive(Clone, Copy, Debug)]
struct Half {
    primitive: u32,
    corner: Vec3,
    sides: [Vec3; 2],
    normal: Vec3,
    uv: Vec2,
    uv_sides: [Vec2; 2],
    offset: f32,
    density: f32,
}

/// Unit vectors along the sides and across, and the lengths of the sides.
#[derive(Debug)]
struct Axes {
    x: Relative,
    y: Relative,
    normal: Relative,
    size: [f64; 2],
    inverse_size: [f64; 2],
}

/// A parallelogram as it is seen from near by.
pub enum Shape {
    /// At once; with one over the lengths of its sides.
    Rectangle(SphericalRectangle, [f64; 2]),
    /// In two parts.
    Triangles([SphericalTriangle; 2]),
}

impl Quad {
    /// From two triangles, if they are one.
    pub fn new(triangles: [u32; 2], surfaces: &Surfaces) -> Option<Self> {
        let [p, q] = triangles.map(|t| surfaces.corners(t));
        let at = |i: usize| i % 3;
        // The corner of each from which the common diagonal is opposite.
        let (i, j) = (0..9)
            .map(|k| (k / 3, k % 3))
            .find(|(i, j)| p[at(i + 1)] == q[at(j + 2)] && p[at(i + 2)] == q[at(j + 1)])?;
        let halves = [half(triangles[0], i, surfaces), half(triangles[1], j, surfaces)];
        let [u, v] = halves[0].sides;
        let gap = (p[i] + q[j] - p[at(i + 1)] - p[at(i + 2)]).length();
        let short = u.length().min(v.length());
        let closes = gap <= PARALLELOGRAM * short && halves.iter().all(|h| h.density.is_finite());
        closes.then(|| Self {
            halves,
            center: (p[at(i + 1)] + p[at(i + 2)]) * 0.5,
            normal: halves[0].normal,
            near: NEAR * (u.length_squared() + v.length_squared()),
            least_height: least_height(halves[0].offset.max(halves[1].offset)),
            rectangle: Axes::new([u, v]).filter(|_| gap <= RECTANGLE * short),
        })
    }

    /// Its two triangles.
    pub fn primitives(&self) -> [u32; 2] {
        self.halves.map(|h| h.primitive)
    }

    /// The density of points by area.
    #[inline]
    pub fn area_pdf(&self, primitive: u32) -> AreaPdf {
        let [first, second] = &self.halves;
        AreaPdf(if primitive == first.primitive { first.density } else { second.density })
    }

    /// The point with those shares of the sides, in [0, 1]: uniform by area if they are.
    #[inline]
    pub fn point(&self, light: u32, [u, v]: [f32; 2]) -> LightPoint {
        let beyond = u + v > 1.0;
        let half = &self.halves[usize::from(beyond)];
        // Seen from the corner beyond, the sides run back.
        let [u, v] = if beyond { [1.0 - u, 1.0 - v] } else { [u, v] };
        LightPoint {
            light,
            anchor: Anchor::Surface,
            at: half.corner + half.sides[0] * u + half.sides[1] * v,
            normal: half.normal,
            uv: half.uv + half.uv_sides[0] * u + half.uv_sides[1] * v,
            primitive: half.primitive,
            offset: half.offset,
        }
    }

    /// How it is looked for.
    #[inline]
    pub fn seen(&self, from: Vec3) -> Seen<Shape> {
        let d = from - self.center;
        if self.normal.dot(d) < 0.0 {
            Seen::Behind
        } else if d.length_squared() < self.near {
            self.seen_from_near(from)
        } else {
            Seen::ByArea
        }
    }

    fn seen_from_near(&self, from: Vec3) -> Seen<Shape> {
        let [first, second] = &self.halves;
        let corner = relative(first.corner, from);
        let normal = self.rectangle.as_ref().map_or_else(|| wide(self.normal), |axes| axes.normal);
        let height = -dot(normal, corner);
        if height <= self.least_height {
            return Seen::ByArea;
        }
        let (shape, solid_angle) = if let Some(axes) = &self.rectangle {
            let place = [dot(axes.x, corner), dot(axes.y, corner)];
            let shape = SphericalRectangle::new(place, axes.size, height);
            (Shape::Rectangle(shape, axes.inverse_size), shape.solid_angle())
        } else {
            let triangles = [first, second].map(|h| {
                let corners = [h.corner, h.corner + h.sides[0], h.corner + h.sides[1]];
                SphericalTriangle::new(corners.map(|c| relative(c, from)))
            });
            (Shape::Triangles(triangles), triangles[0].solid_angle() + triangles[1].solid_angle())
        };
        near(shape, height, solid_angle)
    }
}

fn wide(v: Vec3) -> Relative {
    v.to_array().map(f64::from)
}

impl Shape {
    /// Shares of the sides, uniform in solid angle.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> [f32; 2] {
        match self {
            Self::Rectangle(rectangle, [a, b]) => {
                let [x, y] = rectangle.sample(u);
                [(x * a) as f32, (y * b) as f32]
            }
            Self::Triangles([first, second]) => {
                let [a, b] = [first.solid_angle(), second.solid_angle()];
                let t = u[0] * (a + b);
                if t < a {
                    first.sample([t / a, u[1]])
                } else {
                    second.sample([((t - a) / b).min(ONE_BELOW), u[1]]).map(|share| 1.0 - share)
                }
            }
        }
    }
}

impl Axes {
    /// `None` if the sides are not at right angles.
    fn new(sides: [Vec3; 2]) -> Option<Self> {
        let [u, v] = sides.map(wide);
        let size = [u, v].map(|s| dot(s, s).sqrt());
        let (x, y) = (u.map(|c| c / size[0]), v.map(|c| c / size[1]));
        (dot(x, y).abs() <= f64::from(RECTANGLE)).then_some(Self {
            x,
            y,
            normal: cross(x, y),
            size,
            inverse_size: size.map(|s| 1.0 / s),
        })
    }
}

/// The half of that triangle, with its corner of that number (0, 1 or 2) away from the diagonal.
fn half(primitive: u32, corner: usize, surfaces: &Surfaces) -> Half {
    let at = |i: usize| {
        let [b1, b2] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]][i % 3];
        surfaces.triangle_point(primitive, b1, b2)
    };
    let [p, q, r]: [SurfacePoint; 3] = [at(corner), at(corner + 1), at(corner + 2)];
    let sides = [q.position - p.position, r.position - p.position];
    Half {
        primitive,
        corner: p.position,
        sides,
        normal: p.normal,
        uv: p.uv,
        uv_sides: [q.uv - p.uv, r.uv - p.uv],
        offset: p.offset,
        // Half of all samples are on it.
        density: 1.0 / sides[0].cross(sides[1]).length(),
    }
}
