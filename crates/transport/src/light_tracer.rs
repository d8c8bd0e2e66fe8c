//! Pure light tracing: t = 1 alone, unweighted. Written apart from the bidirectional integrator, so that the
//! two check each other.

use caustica_math::{SampleStream, Spectrum, StreamId};
use caustica_scene::bsdf::Walk;
use caustica_scene::bvh::Ray;

use crate::bdpt::emission_flight;
use crate::kernel::{Kernel, streams};
use crate::sink::Sink;
use crate::vertex::Vertex;

impl Kernel<'_> {
    pub(crate) fn trace_light<S: Sink>(&self, id: StreamId, sink: &mut S) {
        let mut stream = SampleStream::new(StreamId { walk: streams::LIGHT, ..id });
        let (choice, u, v) = (stream.next_2d(), stream.next_2d(), stream.next_2d());
        let lights = self.scene.lights(self.wavelengths);
        let Some(emission) = lights.sample_emission(choice, u, v) else { return };
        if let Some((lamp, link, radiance)) = self.lamp_link(&emission, stream.next_2d()) {
            let arriving = link.pdf.0 * link.falloff * lamp.cos(link.direction);
            let value = radiance * (arriving / (emission.pdf.point.0 * self.light_paths));
            self.splat(link.film, value, sink);
        }
        let flight = emission_flight(&emission);
        let (mut ray, mut throughput) = (flight.ray, flight.throughput);
        let first = throughput.max_lane();
        for bounce in 1..self.max_edges {
            let Some(point) = self.scene.closest(&ray) else { return };
            let vertex = Vertex::new(self.scene, point, -ray.direction, self.wavelengths);
            self.splat_surface(&vertex, throughput, &mut stream, sink);
            let [u0, u1] = stream.next_2d();
            let Some((direction, s, _)) = vertex.sample(Walk::FromLight, [u0, u1, stream.next_1d()]) else {
                return;
            };
            throughput *= s.value * (1.0 / s.forward.0);
            if bounce >= self.roulette_start {
                let survival = (throughput.max_lane() / first).min(0.95);
                if stream.next_1d() >= survival {
                    return;
                }
                throughput *= 1.0 / survival;
            }
            ray = Ray { origin: vertex.point.off_surface(direction), direction, t_max: f32::INFINITY };
        }
    }

    fn splat_surface<S: Sink>(
        &self,
        vertex: &Vertex,
        throughput: Spectrum,
        stream: &mut SampleStream,
        sink: &mut S,
    ) {
        let lens = stream.next_2d();
        if !vertex.is_connectible() {
            return;
        }
        let Some((link, scatter)) = self.camera_link(vertex, lens) else { return };
        let value = throughput * scatter.value * (link.pdf.0 * link.falloff / self.light_paths);
        if self.scene.visible(vertex.point.off_surface(link.direction), link.end) {
            self.splat(link.film, value, sink);
        }
    }
}
