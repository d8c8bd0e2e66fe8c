//! What the first surfaces are like that a picture's own samples see.

use caustica_math::{Rgb, SampleId, Vec2, Vec3};
use caustica_scene::bvh::Ray;
use caustica_scene::description::{Layer, LayerKind};
use caustica_scene::surface::SurfacePoint;

use crate::kernel::{EyeSample, Kernel};
use crate::numbers::Bounces;
use crate::vertex::Vertex;

/// How a sample counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// The pixel filter's sign and size.
    pub weight: f32,
    /// Where the sample lies, in pixels from the centre of its pixel.
    pub offset: Vec2,
}

/// A surface that a sample sees.
struct First<'k, 'a> {
    kernel: &'k Kernel<'a>,
    eye: EyeSample,
    point: SurfacePoint,
}

impl Kernel<'_> {
    /// Looks at the first surface that a sample's eye path meets, by the very ray of [`Kernel::sample`]. `values` are
    /// those of the layers' channels in turn: zero where there is no surface, or no finite value.
    pub fn look(&self, pixel: [u32; 2], sample: u32, layers: &[Layer], values: &mut Vec<f32>) -> Seen {
        let eye = self.eye_sample(SampleId { seed: self.settings.seed, pixel, sample });
        let response = self.scene.camera.response();
        let [x, y] = pixel.map(|c| c as f32 + 0.5);
        let seen = Seen { weight: eye.filter_weight / response, offset: eye.film - Vec2::new(x, y) };
        let ray = Ray { origin: eye.ray.origin, direction: eye.ray.direction, t_max: eye.ray.t_max };
        values.clear();
        let mut first = self.first_seen(&ray).map(|point| First { kernel: self, eye, point });
        for layer in layers {
            let value = first.as_mut().map_or([0.0; 3], |f| f.value(layer));
            let finite = value.iter().all(|v| v.is_finite());
            let value = if finite { value } else { [0.0; 3] };
            values.extend_from_slice(&value[..layer.kind.channels().len()]);
        }
        seen
    }
}

impl First<'_, '_> {
    /// The channels of a layer, and zeros.
    fn value(&mut self, layer: &Layer) -> [f32; 3] {
        let (scene, point) = (self.kernel.scene, self.point);
        let prev = -self.eye.ray.direction;
        let down = if layer.v_down { -1.0 } else { 1.0 };
        let along = |i: usize| {
            let derivatives = scene.surfaces().derivatives(&point);
            derivatives.map_or(Vec3::ZERO, |d| d[i])
        };
        match layer.kind {
            LayerKind::Albedo => {
                let Rgb(albedo) = self.kernel.rgb(scene.albedo(&point, prev, self.kernel.wavelengths));
                albedo
            }
            LayerKind::Depth => [(point.position - self.eye.ray.origin).length(), 0.0, 0.0],
            LayerKind::Position => point.position.to_array(),
            LayerKind::Uv => match scene.surfaces().texture_coordinates(&point) {
                Some(uv) => [uv.x, if layer.v_down { 1.0 - uv.y } else { uv.y }, 0.0],
                None => [0.0; 3],
            },
            LayerKind::GeometricNormal => point.normal.to_array(),
            LayerKind::ShadingNormal => {
                let numbers = &mut self.eye.numbers;
                let vertex = Vertex::new(scene, point, prev, self.kernel.wavelengths, || numbers.label(0));
                vertex.shading_normal().to_array()
            }
            LayerKind::ByU => along(0).to_array(),
            LayerKind::ByV => (along(1) * down).to_array(),
            LayerKind::UvByX => self.uv_by(Vec2::new(1.0, 0.0), down),
            LayerKind::UvByY => self.uv_by(Vec2::new(0.0, 1.0), down),
            LayerKind::PrimitiveIndex => {
                let first = scene.surfaces().shapes[point.shape as usize].first_primitive;
                [(point.primitive - first) as f32, 0.0, 0.0]
            }
            LayerKind::ShapeIndex => [(point.shape + 1) as f32, 0.0, 0.0],
        }
    }

    /// How texture coordinates change by a step on the film: on the plane that touches the surface, and of all
    /// (du, dv) whose way ∂p/∂u·du + ∂p/∂v·dv is closest to that of the ray's end.
    fn uv_by(&mut self, step: Vec2, down: f32) -> [f32; 3] {
        let (scene, point) = (self.kernel.scene, &self.point);
        let Some([by_u, by_v]) = scene.surfaces().derivatives(point) else { return [0.0; 3] };
        let ray = scene.camera.ray(self.eye.film + step, self.eye.numbers.lens());
        let t = (point.position - ray.origin).dot(point.normal) / ray.direction.dot(point.normal);
        let moved = ray.origin + ray.direction * t - point.position;
        let (uu, uv, vv) = (by_u.dot(by_u), by_u.dot(by_v), by_v.dot(by_v));
        let (u, v) = (by_u.dot(moved), by_v.dot(moved));
        let inverse = 1.0 / (uu * vv - uv * uv);
        [(vv * u - uv * v) * inverse, (uu * v - uv * u) * inverse * down, 0.0]
    }
}
