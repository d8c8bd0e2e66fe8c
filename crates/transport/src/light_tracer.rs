//! Pure light tracing: t = 1 alone, unweighted. Written apart from the bidirectional integrator, so that the
//! two check each other.

use caustica_math::{SampleId, Spectrum};
use caustica_scene::bsdf::Walk;
use caustica_scene::bvh::Ray;

use crate::kernel::Kernel;
use crate::numbers::{Bounces, LightNumbers};
use crate::sink::Sink;
use crate::vertex::Vertex;
use crate::walk::emission_flight;

impl Kernel<'_> {
    pub(crate) fn trace_light<S: Sink>(&self, id: SampleId, sink: &mut S) {
        let mut numbers = LightNumbers::new(self.settings.sampler, id, self.needs);
        let [choice, u, v] = numbers.emission();
        let lights = self.scene.lights(self.wavelengths);
        let Some(emission) = lights.sample_emission(choice, u, v) else { return };
        if let Some((lamp, link, radiance)) = self.lamp_link(&emission, numbers.lamp_lens()) {
            let arriving = link.pdf.0 * link.falloff * lamp.cos(link.direction);
            let value = radiance * (arriving / (emission.pdf.point.0 * self.light_paths));
            self.splat(link.film, value, sink);
        }
        let flight = emission_flight(&emission);
        let (mut ray, mut throughput) = (flight.ray, flight.throughput);
        if !throughput.is_valid() {
            return sink.invalid();
        }
        let first = throughput.max_lane();
        for bounce in 1..self.max_edges {
            let Some(point) = self.scene.closest(&ray) else { return };
            let label = || numbers.label(bounce - 1);
            let vertex = Vertex::new(self.scene, point, -ray.direction, self.wavelengths, label);
            self.splat_surface(&vertex, throughput, numbers.lens(bounce - 1), sink);
            let roulette = bounce >= self.roulette_start;
            let drawn = numbers.bounce(bounce - 1, &vertex, roulette);
            let Some((direction, s, _)) = vertex.sample(Walk::FromLight, drawn.u) else { return };
            throughput *= s.value * (1.0 / s.forward.0);
            if !throughput.is_valid() {
                return sink.invalid();
            }
            if roulette {
                let survival = (throughput.max_lane() / first).min(0.95);
                if drawn.survival >= survival {
                    return;
                }
                throughput *= 1.0 / survival;
            }
            ray = Ray { origin: vertex.point.off_surface(direction), direction, t_max: f32::INFINITY };
        }
    }

    fn splat_surface<S: Sink>(&self, vertex: &Vertex, throughput: Spectrum, lens: [f32; 2], sink: &mut S) {
        if !vertex.is_connectible() {
            return;
        }
        let Some((link, scatter)) = self.camera_link(vertex, lens) else { return };
        let value = throughput * scatter.value * (link.pdf.0 * link.falloff / self.light_paths);
        if self.is_seen_from_camera(&vertex.point, &link) {
            self.splat(link.film, value, sink);
        }
    }
}
