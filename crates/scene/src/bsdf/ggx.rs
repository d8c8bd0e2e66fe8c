//! The GGX distribution of microfacet normals.

use std::f32::consts::FRAC_1_PI;

use caustica_math::Vec3;
use caustica_math::elementary::{safe_sqrt, sin_cos_turns};

/// D = 1/(π·αx·αy·(x²/αx² + y²/αy² + z²)²), without dividing by a roughness.
#[inline]
pub(super) fn density([ax, ay]: [f32; 2], h: Vec3) -> f32 {
    let area = ax * ay;
    // x and y know a small angle better than z does.
    let (x, y, z) = (h.x * ay, h.y * ax, h.z * area);
    let ratio = area / (x * x + y * y + z * z);
    area * ratio * ratio * FRAC_1_PI
}

/// A visible normal.
///
/// Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023.
#[inline]
pub(super) fn sample_visible([ax, ay]: [f32; 2], v: Vec3, u: [f32; 2]) -> Vec3 {
    // Seen from the hemisphere that the microfacets are stretched to, reflections of `v` fill a spherical cap
    // evenly.
    let v = Vec3::new(v.x * ax, v.y * ay, v.z).normalized();
    let depth = u[1] * (1.0 + v.z);
    let radius = safe_sqrt(depth * (2.0 - depth));
    let (sin, cos) = sin_cos_turns(u[0]);
    // The cap's height is 1 − depth, to which v.z is added.
    let z = (1.0 - u[1]) * (1.0 + v.z);
    Vec3::new((radius * cos + v.x) * ax, (radius * sin + v.y) * ay, z).normalized()
}
