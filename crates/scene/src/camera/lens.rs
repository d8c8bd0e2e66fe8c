//! Pinholes and thin lenses.

use caustica_math::elementary::tan;
use caustica_math::{SolidAnglePdf, Vec2, Vec3, warp};

use super::film::Film;
use super::{Camera, CameraLink, CameraPoint, CameraRay};
use crate::surface::FARTHEST;

/// A lens; one of no radius is a pinhole.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lens {
    /// The size of a pixel on the plane z = 1.
    pixel: f32,
    radius: f32,
    focus: f32,
}

/// Pixels that cover a smaller angle could not be told apart by directions in single precision.
const SHARPEST: f32 = 1e-8;

impl Lens {
    /// A lens of that horizontal field of view in degrees, radius and focus distance.
    pub fn new(fov: f32, (radius, focus): (f32, f32), film: &Film) -> Result<Self, String> {
        let valid = fov > 0.0 && fov < 180.0 && (0.0..=FARTHEST).contains(&radius);
        if !(valid && (1.0 / FARTHEST..=FARTHEST).contains(&focus)) {
            return Err(format!(
                "the camera's field of view must lie between 0 and 180 degrees, its lens radius be zero or more and its focus distance positive, and neither beyond {FARTHEST:e}"
            ));
        }
        let pixel = 2.0 * tan(0.5 * fov.to_radians()) / film.width;
        // At the picture's corners pixels are seen at the greatest angle.
        let [x, y] = film.reach().map(|side| side * pixel);
        let cos = 1.0 / (1.0 + x * x + y * y).sqrt();
        if pixel >= SHARPEST && is_resolved(pixel, cos) {
            Ok(Self { pixel, radius, focus })
        } else {
            Err(format!("the camera's field of view of {fov} degrees is too near to 0 or 180 to be rendered"))
        }
    }

    /// Whether its points differ.
    pub fn is_open(&self) -> bool {
        self.radius > 0.0
    }

    fn point(&self, u: [f32; 2]) -> Vec2 {
        if self.radius == 0.0 { Vec2::default() } else { warp::concentric_disk(u) * self.radius }
    }

    /// Film area in pixels per solid angle: a pixel covers pixel²·cos³ at distance one.
    fn pdf(&self, cos: f32) -> SolidAnglePdf {
        lens_pdf(cos, self.pixel)
    }
}

/// Whether the density of a pixel of that size, seen at that cosine, can be counted with.
pub(super) fn is_resolved(pixel: f32, cos: f32) -> bool {
    let density = lens_pdf(cos, pixel).0;
    pixel > 0.0 && (1e-30..=1e30).contains(&density)
}

fn lens_pdf(cos: f32, pixel: f32) -> SolidAnglePdf {
    SolidAnglePdf(1.0 / (pixel * pixel * cos * cos * cos))
}

impl Camera {
    pub(super) fn lens_ray(&self, lens: &Lens, film: Vec2, u: [f32; 2]) -> CameraRay {
        let (place, focus) = (&self.place, lens.focus);
        let p = self.film.to_plane(film, lens.pixel);
        let on_lens = lens.point(u);
        let local = Vec3::new(p.x * focus - on_lens.x, p.y * focus - on_lens.y, focus).normalized();
        let start = place.origin + place.to_world(Vec3::new(on_lens.x, on_lens.y, 0.0));
        let direction = place.to_world(local);
        CameraRay {
            point: CameraPoint { at: start, infinite: false },
            origin: start + direction * (place.near / local.z),
            direction,
            t_max: (place.far - place.near) / local.z,
            pdf: lens.pdf(local.z),
        }
    }

    pub(super) fn lens_link(&self, lens: &Lens, from: Vec3, u: [f32; 2]) -> Option<CameraLink> {
        let (place, focus) = (&self.place, lens.focus);
        let relative = place.to_local(from - place.origin);
        if !place.sees(relative) {
            return None;
        }
        let on_lens = lens.point(u);
        let d = Vec3::new(relative.x - on_lens.x, relative.y - on_lens.y, relative.z);
        let distance = d.length();
        let k = focus / d.z;
        let plane = [(on_lens.x + d.x * k) / focus, (on_lens.y + d.y * k) / focus];
        let start = place.origin + place.to_world(Vec3::new(on_lens.x, on_lens.y, 0.0));
        let direction = (start - from) * (1.0 / distance);
        Some(CameraLink {
            point: CameraPoint { at: start, infinite: false },
            direction,
            end: start - direction * (place.near * distance / d.z),
            film: self.film.of_plane(plane[0], plane[1], lens.pixel),
            pdf: lens.pdf(d.z / distance),
            falloff: 1.0 / (distance * distance),
            t_max: f32::INFINITY,
        })
    }

    pub(super) fn lens_link_to_infinity(
        &self,
        lens: &Lens,
        towards: Vec3,
        u: [f32; 2],
    ) -> Option<CameraLink> {
        let place = &self.place;
        let d = place.to_local(towards);
        if d.z <= 0.0 {
            return None;
        }
        let on_lens = lens.point(u);
        // Where the ray from the lens crosses the plane that is in focus, at the scale of z = 1.
        let plane = [on_lens.x / lens.focus + d.x / d.z, on_lens.y / lens.focus + d.y / d.z];
        let start = place.origin + place.to_world(Vec3::new(on_lens.x, on_lens.y, 0.0));
        Some(CameraLink {
            point: CameraPoint { at: start, infinite: false },
            direction: -towards,
            end: start + towards * (place.near / d.z),
            film: self.film.of_plane(plane[0], plane[1], lens.pixel),
            pdf: lens.pdf(d.z),
            falloff: 1.0,
            t_max: (place.far - place.near) / d.z,
        })
    }
}
