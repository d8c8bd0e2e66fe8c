//! 360° pictures.

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use caustica_math::elementary::{atan2, sin_cos};
use caustica_math::{SolidAnglePdf, Vec2, Vec3};

use super::{Camera, CameraLink, CameraPoint, CameraRay};

impl Camera {
    pub(super) fn ray_around(&self, film: Vec2) -> CameraRay {
        let place = &self.place;
        let (sin_theta, cos_theta) = sin_cos(PI * film.y / self.film.height);
        let (sin_phi, cos_phi) = sin_cos(TAU * (0.5 - film.x / self.film.width));
        let direction = place.to_world(Vec3::new(sin_phi * sin_theta, cos_theta, cos_phi * sin_theta));
        CameraRay {
            point: CameraPoint { at: place.origin, infinite: false },
            origin: place.origin + direction * place.near,
            direction,
            t_max: place.far - place.near,
            pdf: self.pdf_around(sin_theta),
        }
    }

    pub(super) fn link_around(&self, from: Vec3) -> Option<CameraLink> {
        let place = &self.place;
        let relative = place.to_local(from - place.origin);
        let distance = relative.length();
        if distance <= place.near || distance > place.far {
            return None;
        }
        let d = relative * (1.0 / distance);
        let direction = (place.origin - from) * (1.0 / distance);
        Some(CameraLink {
            point: CameraPoint { at: place.origin, infinite: false },
            direction,
            end: place.origin - direction * place.near,
            film: self.direction_to_film(d),
            pdf: self.pdf_around(sin_theta(d)),
            falloff: 1.0 / (distance * distance),
            t_max: f32::INFINITY,
        })
    }

    pub(super) fn link_around_to_infinity(&self, towards: Vec3) -> CameraLink {
        let place = &self.place;
        let d = place.to_local(towards);
        CameraLink {
            point: CameraPoint { at: place.origin, infinite: false },
            direction: -towards,
            end: place.origin + towards * place.near,
            film: self.direction_to_film(d),
            pdf: self.pdf_around(sin_theta(d)),
            falloff: 1.0,
            t_max: place.far - place.near,
        }
    }

    fn pdf_around(&self, sin_theta: f32) -> SolidAnglePdf {
        let pixels = self.film.width * self.film.height;
        // The pole itself has no density; keep it finite.
        SolidAnglePdf(pixels * (0.5 * FRAC_1_PI * FRAC_1_PI) / sin_theta.abs().max(1e-6))
    }

    /// Where the picture shows a unit direction of the camera frame.
    fn direction_to_film(&self, d: Vec3) -> Vec2 {
        Vec2::new(
            (0.5 - atan2(d.x, d.z) * (0.5 * FRAC_1_PI)) * self.film.width,
            atan2(sin_theta(d), d.y) * FRAC_1_PI * self.film.height,
        )
    }
}

/// The sine of the angle to the upper pole.
fn sin_theta(d: Vec3) -> f32 {
    (d.x * d.x + d.z * d.z).sqrt()
}
