//! s = 1: next-event estimation.

use caustica_math::Spectrum;
use caustica_scene::bsdf::Walk;
use caustica_scene::bvh::Ray;
use caustica_scene::light::Towards;

use super::{Junction, Sample};
use crate::edge::Edge;
use crate::kernel::Kernel;
use crate::numbers::EyeNumbers;
use crate::sink::Sink;
use crate::strategy::Strategy;
use crate::vertex::Vertex;
use crate::weight::weight;

impl Kernel<'_> {
    /// s = 1: next-event estimation at every eye vertex.
    pub(super) fn next_events<S: Sink>(
        &self,
        sample: &Sample<'_>,
        numbers: &mut EyeNumbers,
        sink: &mut S,
    ) -> Spectrum {
        let lights = self.scene.lights(self.wavelengths);
        let mut sum = Spectrum::ZERO;
        // One more edge joins the lamp.
        let count = sample.eye.vertices.len().min(self.max_edges - 1);
        for i in 0..count {
            let vertex = &sample.eye.vertices[i];
            if !vertex.is_connectible() {
                continue;
            }
            let (choice, u) = numbers.next_event(i);
            let Some(found) = lights.sample_towards(vertex.point.position, choice, u) else { continue };
            sum += self.next_event(sample, i + 2, &found, sink).unwrap_or(Spectrum::ZERO);
        }
        sum
    }

    fn next_event<S: Sink>(
        &self,
        sample: &Sample<'_>,
        t: usize,
        found: &Towards,
        sink: &mut S,
    ) -> Option<Spectrum> {
        let vertex = &sample.eye.vertices[t - 2];
        let scatter = vertex.scatter(Walk::FromCamera, found.direction)?;
        let edge = Edge::of_length(found.distance);
        let to_lamp = edge.jacobian(found.point.cos(found.direction));
        let value = vertex.throughput * scatter.value * found.radiance * (to_lamp / found.pdf.0);
        if value.is_black() || !self.is_lit(vertex, found) {
            return None;
        }
        let lights = self.scene.lights(self.wavelengths);
        let pdf = lights.emission_pdf(&found.point, -found.direction);
        let from_light = pdf.direction.0 * edge.jacobian(vertex.cos(found.direction));
        let delta = lights.lights.get(found.point.light).is_delta();
        let from_camera = if delta { 0.0 } else { scatter.forward.0 * to_lamp };
        let strategy = Strategy { s: 1, t: t as u32 };
        let junction = Junction { light: (from_camera, 0.0), eye: (from_light, scatter.reverse.0) };
        let joined = sample.joined(strategy, (found.point, pdf.point.0), junction, value);
        Some(self.finish(
            sample,
            &joined,
            || {
                let h = self.heuristic;
                let light_side = if self.classes.hit { h.of(from_camera / found.pdf.0) } else { 0.0 };
                let sums = sample.eye.vertices[t - 2].sums;
                // Longer light paths begin by emission.
                let eye_side = h.of(pdf.point.0 / found.pdf.0) * sums.total(from_light, scatter.reverse.0, h);
                weight(light_side, eye_side)
            },
            sink,
        ))
    }

    /// Whether nothing stands between an eye vertex and a point found on a lamp.
    #[inline]
    pub(crate) fn is_lit(&self, vertex: &Vertex, found: &Towards) -> bool {
        let origin = vertex.point.off_surface(found.direction);
        if found.distance.is_finite() {
            self.scene.visible(origin, found.point.off_surface(-found.direction))
        } else {
            !self.scene.occluded(&Ray { origin, direction: found.direction, t_max: f32::INFINITY })
        }
    }
}
