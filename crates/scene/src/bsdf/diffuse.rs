//! The Lambertian reflector.

use std::f32::consts::FRAC_1_PI;

use caustica_math::{Spectrum, Vec3, warp};

use super::Evaluated;

/// Reflects a share of the light, the same radiance in all directions on the side of the normal; black on
/// the other side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diffuse {
    /// The reflected share, in [0, 1].
    pub albedo: Spectrum,
}

impl Diffuse {
    #[inline]
    pub(super) fn eval(&self, to_light: Vec3, to_camera: Vec3) -> Evaluated {
        if to_light.z <= 0.0 || to_camera.z <= 0.0 {
            return Evaluated::default();
        }
        Evaluated {
            value: self.albedo * (to_light.z * FRAC_1_PI),
            to_light_pdf: warp::cosine_hemisphere_pdf(to_light.z),
            to_camera_pdf: warp::cosine_hemisphere_pdf(to_camera.z),
        }
    }

    #[inline]
    pub(super) fn sample_direction(&self, given: Vec3, u: [f32; 3]) -> Option<Vec3> {
        (given.z > 0.0).then(|| warp::cosine_hemisphere([u[0], u[1]]))
    }
}
