//! Warps from the unit square, with their densities and inverses.

use std::f32::consts::{FRAC_1_PI, PI};

use crate::elementary::{atan2, safe_sqrt, sin_cos_turns};
use crate::{SolidAnglePdf, Vec2, Vec3};

/// A uniform point on the unit disk by the concentric map, which keeps neighbours together.
///
/// Shirley and Chiu, "A Low Distortion Map Between Disk and Square", JGT 2(3), 1997.
#[inline]
pub fn concentric_disk(u: [f32; 2]) -> Vec2 {
    let (x, y) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    if x == 0.0 && y == 0.0 {
        return Vec2::default();
    }
    // The angle in turns is an eighth of the ratio, plus a quarter turn for each quadrant passed.
    let (radius, turns) = if x.abs() > y.abs() { (x, y / x / 8.0) } else { (y, 0.25 - x / y / 8.0) };
    let (sin, cos) = sin_cos_turns(turns);
    Vec2::new(radius * cos, radius * sin)
}

/// The inverse of [`concentric_disk`].
pub fn inverse_concentric_disk(p: Vec2) -> [f32; 2] {
    let radius = (p.x * p.x + p.y * p.y).sqrt();
    let (x, y) = if p.x.abs() > p.y.abs() {
        let r = radius.copysign(p.x);
        (r, atan2(p.y * r.signum(), p.x * r.signum()) * 4.0 * FRAC_1_PI * r)
    } else if radius > 0.0 {
        let r = radius.copysign(p.y);
        (atan2(p.x * r.signum(), p.y * r.signum()) * 4.0 * FRAC_1_PI * r, r)
    } else {
        (0.0, 0.0)
    };
    [0.5 * (x + 1.0), 0.5 * (y + 1.0)]
}

/// A direction on the upper hemisphere with density cos θ/π.
#[inline]
pub fn cosine_hemisphere(u: [f32; 2]) -> Vec3 {
    let d = concentric_disk(u);
    Vec3::new(d.x, d.y, safe_sqrt(1.0 - d.x * d.x - d.y * d.y))
}

/// The density of [`cosine_hemisphere`] at cosine `cos`: cos/π above the horizon.
#[inline]
pub fn cosine_hemisphere_pdf(cos: f32) -> SolidAnglePdf {
    SolidAnglePdf(cos.max(0.0) * FRAC_1_PI)
}

/// The inverse of [`cosine_hemisphere`].
pub fn inverse_cosine_hemisphere(v: Vec3) -> [f32; 2] {
    inverse_concentric_disk(Vec2::new(v.x, v.y))
}

/// A uniform direction on the sphere; density 1/(4π).
#[inline]
pub fn uniform_sphere(u: [f32; 2]) -> Vec3 {
    let z = 1.0 - 2.0 * u[0];
    let r = safe_sqrt(1.0 - z * z);
    let (sin, cos) = sin_cos_turns(u[1]);
    Vec3::new(r * cos, r * sin, z)
}

/// The inverse of [`uniform_sphere`].
pub fn inverse_uniform_sphere(v: Vec3) -> [f32; 2] {
    let turns = atan2(v.y, v.x) * 0.5 * FRAC_1_PI;
    [(1.0 - v.z) * 0.5, if turns < 0.0 { turns + 1.0 } else { turns }]
}

/// The density of [`uniform_sphere`].
pub const UNIFORM_SPHERE_PDF: SolidAnglePdf = SolidAnglePdf(0.25 * FRAC_1_PI);

/// A uniform direction in the cone around +z whose half angle has the given 1 − cos. Passing 1 − cos
/// keeps narrow cones exact.
#[inline]
pub fn uniform_cone(u: [f32; 2], one_minus_cos: f32) -> Vec3 {
    let h = u[0] * one_minus_cos;
    let r = safe_sqrt(h * (2.0 - h));
    let (sin, cos) = sin_cos_turns(u[1]);
    Vec3::new(r * cos, r * sin, 1.0 - h)
}

/// The density of [`uniform_cone`] inside the cone.
#[inline]
pub fn uniform_cone_pdf(one_minus_cos: f32) -> SolidAnglePdf {
    SolidAnglePdf(1.0 / (2.0 * PI * one_minus_cos))
}

/// Uniform barycentric coordinates (of the first two corners) of a triangle by Heitz's low-distortion
/// map ("A Low-Distortion Map Between Triangle and Square", 2019). The density over the triangle is
/// 1/area.
#[inline]
pub fn uniform_triangle(u: [f32; 2]) -> [f32; 2] {
    let [mut a, mut b] = u;
    if b > a {
        a *= 0.5;
        b -= a;
    } else {
        b *= 0.5;
        a -= b;
    }
    [a, b]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn close(a: [f32; 2], b: [f32; 2]) -> bool {
        (a[0] - b[0]).abs() < 2e-4 && (a[1] - b[1]).abs() < 2e-4
    }

    proptest! {
        #[test]
        fn warps_round_trip(u in 0.001f32..0.999, v in 0.001f32..0.999) {
            let uv = [u, v];
            prop_assert!(close(inverse_concentric_disk(concentric_disk(uv)), uv));
            prop_assert!(close(inverse_uniform_sphere(uniform_sphere(uv)), uv));
        }

        #[test]
        fn cones_stay_inside(u in 0.0f32..1.0, v in 0.0f32..1.0, h in 1e-6f32..2.0) {
            let d = uniform_cone([u, v], h);
            prop_assert!(d.z >= 1.0 - h - 1e-6);
            prop_assert!((d.length() - 1.0).abs() < 1e-5);
        }

        #[test]
        fn triangle_coordinates_are_barycentric(u in 0.0f32..1.0, v in 0.0f32..1.0) {
            let [a, b] = uniform_triangle([u, v]);
            prop_assert!(a >= 0.0 && b >= 0.0 && a + b <= 1.0 + 1e-6);
        }
    }
}
