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

    /// The frame around the unit vector `z` whose x follows `tangent`, of any length, as far as a direction across `z`
    /// can. `None` where the tangent is zero, not finite, or so nearly along `z` that rounding would decide.
    #[inline]
    pub fn with_tangent(z: Vec3, tangent: Vec3) -> Option<Self> {
        let tangent = tangent.try_normalized()?;
        let x = tangent - z * z.dot(tangent);
        let squared = x.length_squared();
        if squared <= 1e-6 {
            return None;
        }
        let x = x * (1.0 / squared.sqrt());
        Some(Self { x, y: z.cross(x), z })
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

    #[test]
    fn tangents_that_lead_nowhere_make_no_frame() {
        for tangent in [Vec3::ZERO, Vec3::Z * -3.0, Vec3::new(f32::NAN, 1.0, 0.0), Vec3::new(1e-4, 0.0, 1.0)]
        {
            assert_eq!(Frame::with_tangent(Vec3::Z, tangent), None, "{tangent:?}");
        }
    }

    proptest! {
        #[test]
        fn frames_are_orthonormal_and_right_handed(u in 0.0f32..1.0, v in 0.0f32..1.0) {
            let f = Frame::from_normal(warp::uniform_sphere([u, v]));
            prop_assert!(f.x.dot(f.y).abs() < 1e-5 && f.y.dot(f.z).abs() < 1e-5 && f.z.dot(f.x).abs() < 1e-5);
            prop_assert!((f.x.cross(f.y) - f.z).length() < 1e-5);
            let w = Vec3::new(0.3, -0.4, 0.8);
            prop_assert!((f.to_world(f.to_local(w)) - w).length() < 1e-5);
        }

        #[test]
        fn tangents_lead_the_first_axis(u in 0.0f32..1.0, v in 0.0f32..1.0, s in 0.0f32..1.0, t in 0.0f32..1.0) {
            let (z, tangent) = (warp::uniform_sphere([u, v]), warp::uniform_sphere([s, t]) * 1e-3);
            let Some(f) = Frame::with_tangent(z, tangent) else {
                prop_assert!(z.cross(tangent).length() < 2e-6);
                return Ok(());
            };
            prop_assert!(f.x.dot(f.z).abs() < 2e-4 && (f.x.length() - 1.0).abs() < 1e-5);
            prop_assert!((f.x.cross(f.y) - f.z).length() < 2e-4);
            prop_assert!(f.y.dot(tangent).abs() < 1e-6 && f.x.dot(tangent) > 0.0);
        }
    }
}
