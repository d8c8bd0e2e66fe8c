//! Integrators that look at geometry: normals, depth, visibility, and light without materials.

use std::f32::consts::PI;

use caustica_math::{Rgb, SampleId, Vec3, warp};
use caustica_scene::bsdf::Walk;
use caustica_scene::bvh::Ray;
use caustica_scene::description::Integrator;
use caustica_scene::surface::SurfacePoint;

use crate::kernel::{EyeSample, Kernel};
use crate::numbers::{Bounces, EyeNumbers};
use crate::sink::Sink;
use crate::vertex::Vertex;

impl Kernel<'_> {
    pub(crate) fn direct_view<S: Sink>(&self, id: SampleId, sink: &mut S) {
        let EyeSample { filter_weight, ray, mut numbers, .. } = self.eye_sample(id);
        let camera_ray = Ray { origin: ray.origin, direction: ray.direction, t_max: ray.t_max };
        let seen = self.scene.closest(&camera_ray);
        let value = seen.map_or(Rgb::BLACK, |p| self.view(&p, &camera_ray, &mut numbers));
        sink.eye(value * filter_weight);
    }

    fn view(&self, p: &SurfacePoint, ray: &Ray, numbers: &mut EyeNumbers) -> Rgb {
        match self.settings.integrator {
            Integrator::Normals => Rgb(p.frame.z.abs().to_array()),
            Integrator::Depth => Rgb::splat((p.position - ray.origin).length()),
            Integrator::Ao => {
                let d = p.frame.to_world(warp::cosine_hemisphere(numbers.direction()));
                Rgb::splat(self.open(p, d, f32::INFINITY))
            }
            Integrator::Av { length } => {
                let mut local = warp::uniform_sphere(numbers.direction());
                local.z = local.z.abs();
                Rgb::splat(self.open(p, p.frame.to_world(local), length))
            }
            Integrator::Simple { position, energy } => self.simple(p, position.into(), energy),
            Integrator::Directional { direction, irradiance } => {
                self.sunlit((p, ray), direction.into(), irradiance, numbers)
            }
            _ => Rgb::BLACK,
        }
    }

    /// One if a ray of that length from `p` is free.
    fn open(&self, p: &SurfacePoint, direction: Vec3, length: f32) -> f32 {
        let ray = Ray { origin: p.off_surface(direction), direction, t_max: length };
        if self.scene.occluded(&ray) { 0.0 } else { 1.0 }
    }

    /// Nori's `simple`: Φ/(4π²)·max(0, cos θ)/d²·V.
    fn simple(&self, p: &SurfacePoint, light: Vec3, energy: Rgb) -> Rgb {
        let to_light = light - p.position;
        let d2 = to_light.length_squared();
        let cos = p.frame.z.dot(to_light) / d2.sqrt();
        // Where the light lies on the surface there is no cosine.
        if cos.is_nan() || cos <= 0.0 || !self.scene.visible(p.off_surface(to_light), light) {
            return Rgb::BLACK;
        }
        energy * (cos / (4.0 * PI * PI * d2))
    }

    /// The material's answer to one directional light, with its shadow.
    fn sunlit(
        &self,
        (p, ray): (&SurfacePoint, &Ray),
        direction: Vec3,
        irradiance: Rgb,
        numbers: &mut EyeNumbers,
    ) -> Rgb {
        let Some(towards) = (-direction).try_normalized() else { return Rgb::BLACK };
        let vertex = Vertex::new(self.scene, *p, -ray.direction, self.wavelengths, || numbers.label(0));
        let Some(scatter) = vertex.scatter(Walk::FromCamera, towards) else { return Rgb::BLACK };
        let arriving = self.wavelengths.spectrum(irradiance) * self.open(p, towards, f32::INFINITY);
        self.wavelengths.rgb(scatter.value * arriving)
    }
}
