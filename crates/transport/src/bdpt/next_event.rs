//! s = 1: next-event estimation.

use caustica_scene::bsdf::Walk;
use caustica_scene::bvh::Ray;
use caustica_scene::light::Towards;

use super::candidate::Candidates;
use super::{Junction, Sample};
use crate::edge::Edge;
use crate::fault::{Fault, is_planted};
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
        candidates: &mut Candidates,
    ) {
        let lights = self.scene.lights(self.wavelengths);
        // One more edge joins the lamp.
        let count = sample.eye.vertices.len().min(self.max_edges - 1);
        for i in 0..count {
            let vertex = &sample.eye.vertices[i];
            if !vertex.is_connectible() {
                continue;
            }
            let (choice, u) = numbers.next_event(i);
            if let Some(found) = lights.sample_towards(vertex.receiver(), choice, u) {
                self.next_event::<S>(sample, i + 2, &found, candidates);
            }
        }
    }

    fn next_event<S: Sink>(
        &self,
        sample: &Sample<'_>,
        t: usize,
        found: &Towards,
        candidates: &mut Candidates,
    ) -> Option<()> {
        let vertex = &sample.eye.vertices[t - 2];
        let scatter = vertex.scatter(Walk::FromCamera, found.direction)?;
        let edge = Edge::of_length(found.distance);
        let to_lamp = edge.jacobian(found.point.cos(found.direction));
        let arriving = if is_planted(Fault::LampCosine) { edge.falloff } else { to_lamp };
        let value = vertex.throughput * scatter.value * found.radiance * (arriving / found.pdf.0);
        if value.is_black() {
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
        let running = || {
            let h = self.heuristic;
            let light_side = if self.classes.hit { h.of(from_camera / found.pdf.0) } else { 0.0 };
            // Longer light paths begin by emission.
            let eye_side =
                h.of(pdf.point.0 / found.pdf.0) * vertex.sums.total(from_light, scatter.reverse.0, h);
            weight(light_side, eye_side)
        };
        self.offer::<S>(sample, (joined, ray_to(vertex, found)), running, candidates);
        Some(())
    }

    /// Whether nothing stands between an eye vertex and a point found on a lamp.
    #[inline]
    pub(crate) fn is_lit(&self, vertex: &Vertex, found: &Towards) -> bool {
        !self.scene.occluded(&ray_to(vertex, found))
    }
}

/// The ray from an eye vertex to a point found on a lamp.
#[inline]
fn ray_to(vertex: &Vertex, found: &Towards) -> Ray {
    let origin = vertex.point.off_surface(found.direction);
    if found.distance.is_finite() {
        Ray::between(origin, found.point.off_surface(-found.direction))
    } else {
        Ray { origin, direction: found.direction, t_max: f32::INFINITY }
    }
}
