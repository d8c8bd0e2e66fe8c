//! Parallel projection.

use caustica_math::{SolidAnglePdf, Vec2, Vec3};

use super::film::Film;
use super::lens::is_resolved;
use super::{Camera, CameraLink, CameraPoint, CameraRay};

/// The size of a pixel of a picture that is so wide in the world.
pub(super) fn pixel(width: f32, film: &Film) -> Result<f32, &'static str> {
    let pixel = width / film.width;
    let message = "the camera's transform scales so much that its pixels have no size";
    is_resolved(pixel, 1.0).then_some(pixel).ok_or(message)
}

impl Camera {
    pub(super) fn parallel_ray(&self, pixel: f32, film: Vec2) -> CameraRay {
        let place = &self.place;
        let p = self.film.to_plane(film, pixel);
        CameraRay {
            point: CameraPoint { at: -place.axes[2], infinite: true },
            origin: place.origin + place.to_world(Vec3::new(p.x, p.y, place.near)),
            direction: place.axes[2],
            t_max: place.far - place.near,
            pdf: SolidAnglePdf(1.0 / (pixel * pixel)),
        }
    }

    pub(super) fn parallel_link(&self, pixel: f32, from: Vec3) -> Option<CameraLink> {
        let place = &self.place;
        let relative = place.to_local(from - place.origin);
        place.sees(relative).then(|| CameraLink {
            point: CameraPoint { at: -place.axes[2], infinite: true },
            direction: -place.axes[2],
            end: from - place.axes[2] * (relative.z - place.near),
            film: self.film.of_plane(relative.x, relative.y, pixel),
            pdf: SolidAnglePdf(1.0 / (pixel * pixel)),
            falloff: 1.0,
            t_max: f32::INFINITY,
        })
    }
}
