//! Lamps that the camera does not see.

use caustica_math::Vec3;
use caustica_scene::bvh::Ray;
use caustica_scene::camera::CameraLink;
use caustica_scene::surface::SurfacePoint;

use crate::kernel::Kernel;

/// So many lamps behind each other are passed by a ray.
const MOST_PASSED: u32 = 1 << 12;

impl Kernel<'_> {
    /// The first surface that a ray from the camera meets, but for lamps if it hides them.
    #[inline]
    pub(crate) fn first_seen(&self, ray: &Ray) -> Option<SurfacePoint> {
        if self.scene.camera.hides_lamps() { self.first_behind_lamps(ray) } else { self.scene.closest(ray) }
    }

    #[cold]
    fn first_behind_lamps(&self, ray: &Ray) -> Option<SurfacePoint> {
        let mut ray = *ray;
        for _ in 0..MOST_PASSED {
            let point = self.scene.closest(&ray)?;
            if !self.scene.is_on_lamp(&point) {
                return Some(point);
            }
            let beyond = point.off_surface(ray.direction);
            ray.t_max -= (beyond - ray.origin).dot(ray.direction) / ray.direction.length_squared();
            ray.origin = beyond;
        }
        None
    }

    /// Whether the camera sees a surface through a link: nothing stands between them, but for lamps if it hides
    /// them.
    #[inline]
    pub(crate) fn is_seen_from_camera(&self, point: &SurfacePoint, link: &CameraLink) -> bool {
        let start = point.off_surface(link.direction);
        if self.scene.camera.hides_lamps() {
            !self.scene.is_on_lamp(point) && self.is_free_but_for_lamps(start, link.end)
        } else {
            self.scene.visible(start, link.end)
        }
    }

    #[cold]
    fn is_free_but_for_lamps(&self, from: Vec3, to: Vec3) -> bool {
        self.first_behind_lamps(&Ray::between(from, to)).is_none()
    }
}
