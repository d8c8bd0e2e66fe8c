//! Affine and projective transforms, composed in `f64`.

use glam::{DAffine3, DMat4, DQuat, DVec3, DVec4};
use serde::{Deserialize, Serialize};

use crate::{Affine, Vec3};

/// A 4 × 4 transform with its inverse. Points are column vectors: `a.then(b)` applies `a` first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "[[f64; 4]; 4]", into = "[[f64; 4]; 4]")]
pub struct Transform {
    forward: DMat4,
    inverse: DMat4,
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl From<[[f64; 4]; 4]> for Transform {
    fn from(rows: [[f64; 4]; 4]) -> Self {
        Self::from_rows(rows)
    }
}

impl From<Transform> for [[f64; 4]; 4] {
    fn from(t: Transform) -> Self {
        t.forward.transpose().to_cols_array_2d()
    }
}

impl Transform {
    /// The transform that changes nothing.
    pub const IDENTITY: Self = Self { forward: DMat4::IDENTITY, inverse: DMat4::IDENTITY };

    fn new(forward: DMat4) -> Self {
        Self { forward, inverse: forward.inverse() }
    }

    /// From a matrix given row by row. A singular one is accepted: see [`Transform::is_invertible`].
    pub fn from_rows(rows: [[f64; 4]; 4]) -> Self {
        Self::new(DMat4::from_cols_array_2d(&rows).transpose())
    }

    /// A translation.
    pub fn translate(v: [f64; 3]) -> Self {
        Self::new(DMat4::from_translation(DVec3::from_array(v)))
    }

    /// A scaling along the axes.
    pub fn scale(v: [f64; 3]) -> Self {
        Self::new(DMat4::from_scale(DVec3::from_array(v)))
    }

    /// A rotation by `degrees` around `axis` (of any length but zero), by the right-hand rule.
    pub fn rotate(degrees: f64, axis: [f64; 3]) -> Self {
        let axis = DVec3::from_array(axis).normalize();
        let (sin, cos) = libm::sincos(degrees.to_radians() / 2.0);
        let v = axis * sin;
        Self::new(DMat4::from_quat(DQuat::from_xyzw(v.x, v.y, v.z, cos)))
    }

    /// Camera to world: +z looks from `origin` to `target`, +x is `up` × direction, as in Nori.
    pub fn look_at(origin: [f64; 3], target: [f64; 3], up: [f64; 3]) -> Self {
        let origin = DVec3::from_array(origin);
        let direction = (DVec3::from_array(target) - origin).normalize();
        let left = DVec3::from_array(up).cross(direction).normalize();
        let new_up = direction.cross(left);
        Self::new(DMat4::from_cols(
            left.extend(0.0),
            new_up.extend(0.0),
            direction.extend(0.0),
            origin.extend(1.0),
        ))
    }

    /// First this transform, then `next`.
    pub fn then(self, next: Self) -> Self {
        Self { forward: next.forward * self.forward, inverse: self.inverse * next.inverse }
    }

    /// The inverse transform.
    pub fn inverse(self) -> Self {
        Self { forward: self.inverse, inverse: self.forward }
    }

    /// Whether the matrix and its inverse are finite.
    pub fn is_invertible(&self) -> bool {
        self.forward.is_finite() && self.inverse.is_finite() && self.forward.determinant() != 0.0
    }

    /// The affine map that this is, and its inverse; `None` if it is projective or cannot be inverted.
    pub fn affine(&self) -> Option<[Affine; 2]> {
        let flat = self.forward.row(3) == DVec4::W && self.is_invertible();
        let rows = |a: DAffine3| {
            let [x, y, z] = [a.matrix3.row(0), a.matrix3.row(1), a.matrix3.row(2)].map(|r| r.to_array());
            let b = a.translation.to_array();
            let row = |[p, q, r]: [f64; 3], s| [p, q, r, s];
            Affine::from_rows([row(x, b[0]), row(y, b[1]), row(z, b[2])])
        };
        let forward = DAffine3::from_mat4(self.forward);
        flat.then(|| [rows(forward), rows(forward.inverse())])
    }

    /// Whether this mirrors space (a negative determinant of the linear part).
    pub fn mirrors(&self) -> bool {
        glam::DMat3::from_mat4(self.forward).determinant() < 0.0
    }

    /// A point, with the perspective division.
    pub fn point(&self, p: Vec3) -> Vec3 {
        let v = self.forward * DVec4::new(f64::from(p.x), f64::from(p.y), f64::from(p.z), 1.0);
        let w = if v.w == 1.0 { 1.0 } else { 1.0 / v.w };
        Vec3::new((v.x * w) as f32, (v.y * w) as f32, (v.z * w) as f32)
    }

    /// A direction or difference of points: not translated, not normalised.
    pub fn vector(&self, v: Vec3) -> Vec3 {
        let v = self.forward.transform_vector3(DVec3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z)));
        Vec3::new(v.x as f32, v.y as f32, v.z as f32)
    }

    /// A normal, by the inverse transpose; not normalised.
    pub fn normal(&self, n: Vec3) -> Vec3 {
        let n = DVec4::new(f64::from(n.x), f64::from(n.y), f64::from(n.z), 0.0);
        let v = self.inverse.transpose() * n;
        Vec3::new(v.x as f32, v.y as f32, v.z as f32)
    }

    /// If the linear part is a rotation (or reflection) times one scale, that scale.
    pub fn uniform_scale(&self) -> Option<f32> {
        let m = glam::DMat3::from_mat4(self.forward);
        let (a, b, c) = (m.x_axis, m.y_axis, m.z_axis);
        let s2 = a.length_squared();
        let tolerance = 1e-6 * s2;
        let close = |x: f64, y: f64| (x - y).abs() <= tolerance;
        (close(b.length_squared(), s2)
            && close(c.length_squared(), s2)
            && close(a.dot(b), 0.0)
            && close(b.dot(c), 0.0)
            && close(c.dot(a), 0.0))
        .then(|| s2.sqrt() as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_is_left_to_right() {
        let t = Transform::scale([2.0; 3]).then(Transform::translate([1.0, 0.0, 0.0]));
        assert_eq!(t.point(Vec3::X), Vec3::new(3.0, 0.0, 0.0));
        assert_eq!(t.inverse().point(Vec3::new(3.0, 0.0, 0.0)), Vec3::X);
    }

    #[test]
    fn rotation_is_right_handed() {
        let v = Transform::rotate(90.0, [0.0, 0.0, 2.0]).vector(Vec3::X);
        assert!((v - Vec3::Y).length() < 1e-6);
    }

    #[test]
    fn look_at_has_nori_s_axes() {
        let t = Transform::look_at([0.0, 0.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0]);
        assert!((t.vector(Vec3::Z) - Vec3::new(0.0, 0.0, -1.0)).length() < 1e-6);
        assert!((t.vector(Vec3::X) - Vec3::new(-1.0, 0.0, 0.0)).length() < 1e-6);
        assert!(!t.mirrors());
    }

    #[test]
    fn affine_maps_do_the_same() {
        let t = Transform::scale([2.0, 3.0, -0.5])
            .then(Transform::rotate(30.0, [1.0, 2.0, 3.0]))
            .then(Transform::translate([4.0, -5.0, 6.0]));
        let [there, back] = t.affine().unwrap();
        let p = Vec3::new(0.3, -0.7, 1.9);
        assert!((there.point(p) - t.point(p)).length() < 1e-6);
        assert!((there.vector(p) - t.vector(p)).length() < 1e-6);
        assert!((back.normal_back(p) - t.normal(p)).length() < 1e-6);
        assert!((back.point(there.point(p)) - p).length() < 1e-6);
        let room = there.magnitude(p) - there.point(p).abs();
        assert!(room.x >= 0.0 && room.y >= 0.0 && room.z >= 0.0);
        assert!((there.largest() - 3.0).abs() < 1.0);
        let mut rows: [[f64; 4]; 4] = t.into();
        rows[3] = [0.0, 0.1, 0.0, 1.0];
        assert!(Transform::from_rows(rows).affine().is_none());
        assert!(Transform::scale([1.0, 0.0, 1.0]).affine().is_none());
    }

    #[test]
    fn scale_is_recognised() {
        assert_eq!(Transform::scale([2.0, -2.0, 2.0]).uniform_scale(), Some(2.0));
        assert_eq!(Transform::scale([2.0, 1.0, 2.0]).uniform_scale(), None);
        assert!(Transform::scale([2.0, -2.0, 2.0]).mirrors());
    }
}
