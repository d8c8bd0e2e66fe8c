//! How surfaces lie under their texture coordinates.

use std::f32::consts::PI;

use caustica_math::{Frame, Vec2, Vec3};

use crate::bvh::Hit;

use super::attributes::barycentrics;
use super::{FlatSphere, NONE, SurfacePoint, Surfaces};

impl Surfaces {
    /// The texture coordinates at a point, whether or not its material asks for them. `None` where the shape has none.
    pub fn texture_coordinates(&self, point: &SurfacePoint) -> Option<Vec2> {
        if point.instance != Hit::NO_INSTANCE {
            let (surfaces, inside) = self.inside_of(point)?;
            return surfaces.texture_coordinates(&inside);
        }
        if let Some(sphere) = (point.primitive as usize).checked_sub(self.triangles.len()) {
            return Some(self.spheres[sphere].uv(point.normal));
        }
        let weights = barycentrics(self.corners(point.primitive), point.position);
        let [a, b, c] = self.corner_uvs(point.primitive)?;
        Some(a * weights[0] + b * weights[1] + c * weights[2])
    }

    /// The texture coordinates of a triangle's corners, if it has any.
    fn corner_uvs(&self, primitive: u32) -> Option<[Vec2; 3]> {
        let flat = &self.shapes[self.triangle_shapes[primitive as usize] as usize];
        let uv = |v: u32| self.uvs[(v - flat.first_position + flat.first_uv) as usize];
        (flat.first_uv != NONE).then(|| self.triangles[primitive as usize].map(uv))
    }

    /// ∂p/∂u and ∂p/∂v at a point, in the world. `None` where texture coordinates are missing or say nothing, as at
    /// the poles of a sphere.
    pub fn derivatives(&self, point: &SurfacePoint) -> Option<[Vec3; 2]> {
        if point.instance != Hit::NO_INSTANCE {
            return self.derivatives_inside(point);
        }
        match (point.primitive as usize).checked_sub(self.triangles.len()) {
            None => self.triangle_derivatives(point.primitive, &self.corners(point.primitive)),
            Some(sphere) => self.spheres[sphere].derivatives(point.normal),
        }
    }

    /// The same of a triangle, where they are constant.
    #[inline(never)]
    pub(super) fn triangle_derivatives(&self, primitive: u32, &[a, b, c]: &[Vec3; 3]) -> Option<[Vec3; 2]> {
        let uvs = self.corner_uvs(primitive)?;
        let (s, t) = (uvs[1] - uvs[0], uvs[2] - uvs[0]);
        let inverse = 1.0 / (s.x * t.y - s.y * t.x);
        let (p, q) = (b - a, c - a);
        let by_u = (p * t.y - q * s.y) * inverse;
        let by_v = (q * s.x - p * t.x) * inverse;
        // Of degenerate coordinates the inverse is infinite.
        (by_u.is_finite() && by_v.is_finite()).then_some([by_u, by_v])
    }
}

impl FlatSphere {
    /// ∂p/∂u and ∂p/∂v where the outward normal is that.
    #[inline(never)]
    pub(super) fn derivatives(&self, normal: Vec3) -> Option<[Vec3; 2]> {
        let [x, y, z] = self.rows.map(|row| row.dot(normal));
        let around = Vec2::new(x, y);
        let distance = (x * x + y * y).sqrt();
        if distance < 1e-6 {
            return None;
        }
        // The rows are orthonormal: their transpose leads back.
        let to_world =
            |v: Vec3| (self.rows[0] * v.x + self.rows[1] * v.y + self.rows[2] * v.z) * self.data.radius;
        let by_u = to_world(Vec3::new(-around.y, around.x, 0.0) * (2.0 * PI));
        let climb = around * (-z / distance);
        Some([by_u, to_world(Vec3::new(climb.x, climb.y, distance) * PI)])
    }
}

/// The frame around a shading normal whose x follows ∂p/∂u, or an arbitrary one where that is not known.
#[inline(never)]
pub(super) fn frame(shading: Vec3, derivatives: Option<[Vec3; 2]>) -> Frame {
    let along = derivatives.and_then(|[by_u, _]| Frame::with_tangent(shading, by_u));
    along.unwrap_or_else(|| Frame::from_normal(shading))
}
