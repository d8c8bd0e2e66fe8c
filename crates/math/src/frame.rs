//! Orthonormal frames.

use crate::Vec3;

/// A right-handed orthonormal frame. At a surface, `z` is the shading normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// First tangent.
    pub x: Vec3,
    /// Second tangent.
    pub y: Vec3,
    /// The normal.
    pub z: Vec3,
}

impl Frame {
    /// A frame around the unit vector `z`, without branches.
    ///
    /// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
    #[inline]
    pub fn from_normal(z: Vec3) -> Self {
        let sign = 1.0_f32.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        Self {
            x: Vec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x),
            y: Vec3::new(b, sign + z.y * z.y * a, -z.y),
            z,
        }
    }

    /// World to local coordinates.
    #[inline]
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }

    /// Local to world coordinates.
    #[inline]
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warp;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn frames_are_orthonormal_and_right_handed(u in 0.0f32..1.0, v in 0.0f32..1.0) {
            let f = Frame::from_normal(warp::uniform_sphere([u, v]));
            prop_assert!(f.x.dot(f.y).abs() < 1e-5 && f.y.dot(f.z).abs() < 1e-5 && f.z.dot(f.x).abs() < 1e-5);
            prop_assert!((f.x.cross(f.y) - f.z).length() < 1e-5);
            let w = Vec3::new(0.3, -0.4, 0.8);
            prop_assert!((f.to_world(f.to_local(w)) - w).length() < 1e-5);
        }
    }
}
