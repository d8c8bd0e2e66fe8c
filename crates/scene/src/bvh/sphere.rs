use caustica_math::Vec3;

use super::{Bounds, Ray};

/// A sphere in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereData {
    /// Centre.
    pub center: Vec3,
    /// Radius.
    pub radius: f32,
}

impl SphereData {
    pub(super) fn bounds(&self) -> Bounds {
        // A few ulps wider, for the rounding of centre ± radius and of the hit test.
        let r = Vec3::splat(self.radius * (1.0 + 1e-6)) + self.center.abs() * 1e-6;
        Bounds { min: self.center - r, max: self.center + r }
    }

    /// The nearest crossing in (0, t_max].
    ///
    /// The discriminant is taken from the ray's closest approach to the centre (Haines, Günther and
    /// Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019), so
    /// that far and small spheres stay round; the roots avoid cancellation.
    #[inline]
    pub(super) fn intersect(&self, ray: &Ray) -> Option<f32> {
        let f = self.center - ray.origin;
        let a = ray.direction.length_squared();
        let r2 = self.radius * self.radius;
        let c = f.length_squared() - r2;
        let b = f.dot(ray.direction);
        if c > 0.0 && b <= 0.0 {
            return None;
        }
        let discriminant = r2 - (f - ray.direction * (b / a)).length_squared();
        if discriminant < 0.0 && c > 0.0 {
            return None;
        }
        let root = (a * discriminant.max(0.0)).sqrt();
        // From the centre b is zero, of either sign.
        let q = if b < 0.0 { b - root } else { b + root };
        // Outside, the near root is c/q; inside (c ≤ 0) the positive root is the one wanted.
        let t = if c > 0.0 || b < 0.0 { c / q } else { q / a };
        (t > 0.0 && t <= ray.t_max).then_some(t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SPHERE: SphereData = SphereData { center: Vec3::new(1.0, 2.0, 3.0), radius: 0.5 };

    fn shoot(origin: Vec3, target: Vec3) -> Option<f32> {
        SPHERE.intersect(&Ray { origin, direction: target - origin, t_max: f32::INFINITY })
    }

    #[test]
    fn rays_from_the_centre_hit() {
        let sphere = SphereData { center: Vec3::ZERO, radius: 2.0 };
        for zero in [0.0, -0.0] {
            for direction in [Vec3::X, -Vec3::X, Vec3::new(0.3, -0.7, 0.6)] {
                let ray = Ray { origin: Vec3::splat(zero), direction, t_max: f32::INFINITY };
                let t = sphere.intersect(&ray).expect("a hit");
                assert!((t * direction.length() - 2.0).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn near_root_outside_far_root_inside() {
        assert!((shoot(Vec3::new(1.0, 2.0, 0.0), SPHERE.center).unwrap() * 3.0 - 2.5).abs() < 1e-5);
        assert!((shoot(SPHERE.center, Vec3::new(2.0, 2.0, 3.0)).unwrap() - 0.5).abs() < 1e-6);
        assert!(shoot(Vec3::new(1.0, 2.0, 0.0), Vec3::new(1.0, 2.0, -1.0)).is_none());
        let inside = Vec3::new(1.3, 2.0, 3.0);
        assert!((shoot(inside, inside + Vec3::X).unwrap() - 0.2).abs() < 1e-5);
        assert!((shoot(inside, inside - Vec3::X).unwrap() - 0.8).abs() < 1e-5);
    }

    proptest! {
        #[test]
        fn hits_lie_on_the_sphere(x in -9f32..9.0, y in -9f32..9.0, z in -9f32..9.0, u in 0f32..1.0, v in 0f32..1.0) {
            let origin = Vec3::new(x, y, z);
            let target = SPHERE.center + caustica_math::warp::uniform_sphere([u, v]) * 0.49;
            let t = shoot(origin, target).expect("a ray at an inner point hits");
            let p = origin + (target - origin) * t;
            prop_assert!(((p - SPHERE.center).length() - 0.5).abs() < 2e-5);
        }
    }
}
