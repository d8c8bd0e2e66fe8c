//! Unidirectional path tracing in its three techniques, direct light, and Whitted's chains. Written apart from
//! the bidirectional integrator, so that the two check each other.

use caustica_math::{SampleId, Spectrum};
use caustica_scene::bsdf::Walk;
use caustica_scene::bvh::Ray;
use caustica_scene::description::Technique;
use caustica_scene::light::{LightPoint, Receiver};

use crate::edge::Edge;
use crate::kernel::{EyeSample, Kernel};
use crate::numbers::Bounces;
use crate::sink::Sink;
use crate::vertex::Vertex;

/// Roulette spares paths whose throughput is above 1/`LIVES`. Of 1, 2, 4 and 8, relMSE times instructions was least
/// at 4 in a plain box (by a sixth less than at 1), and near the least among mirrors and glass.
const LIVES: f32 = 4.0;

/// How the eye path came to where it is, for weighing what it hits.
enum Arrival {
    /// From the camera, or by a Dirac lobe: next-event estimation could not have made this path.
    Sure,
    /// From a place, by a direction of that solid-angle density.
    Sampled { from: Receiver, pdf: f32 },
}

/// What a path does after its first surface without Dirac lobes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Chain {
    /// Goes on scattering.
    Scatters,
    /// Ends there, after collecting direct light (Whitted).
    Ends,
}

impl Kernel<'_> {
    pub(crate) fn path<S: Sink>(&self, id: SampleId, technique: Technique, sink: &mut S) {
        self.trace_eye(id, (technique, self.max_edges, Chain::Scatters), sink);
    }

    pub(crate) fn direct<S: Sink>(&self, id: SampleId, technique: Technique, sink: &mut S) {
        self.trace_eye(id, (technique, self.max_edges.min(2), Chain::Scatters), sink);
    }

    pub(crate) fn whitted<S: Sink>(&self, id: SampleId, sink: &mut S) {
        self.trace_eye(id, (Technique::Emitters, self.max_edges, Chain::Ends), sink);
    }

    fn trace_eye<S: Sink>(
        &self,
        id: SampleId,
        (technique, max_edges, chain): (Technique, usize, Chain),
        sink: &mut S,
    ) {
        let EyeSample { filter_weight, ray, mut numbers, .. } = self.eye_sample(id);
        let mut ray = Ray { origin: ray.origin, direction: ray.direction, t_max: ray.t_max };
        let (mut throughput, mut radiance_scale) = (Spectrum::ONE, 1.0);
        let mut sum = Spectrum::ZERO;
        let mut arrival = Arrival::Sure;
        for edges in 1..=max_edges {
            let found = if edges == 1 { self.first_seen(&ray) } else { self.scene.closest(&ray) };
            let Some(point) = found else {
                if edges > 1 || !self.scene.camera.hides_lamps() {
                    sum += throughput * self.environment(&ray, &arrival, technique);
                }
                break;
            };
            let label = || numbers.label(edges - 1);
            let vertex = Vertex::new(self.scene, point, -ray.direction, self.wavelengths, label);
            if let Some(lamp) = self.scene.lamp_at(&point) {
                sum += throughput * self.lamp(&lamp, &ray, (&arrival, technique));
            }
            if edges == max_edges {
                break;
            }
            if technique != Technique::Materials && vertex.is_connectible() {
                sum += throughput * self.direct_light(&vertex, technique, numbers.next_event(edges - 1));
            }
            if chain == Chain::Ends && vertex.is_connectible() {
                break;
            }
            let roulette = edges >= self.roulette_start;
            let bounce = numbers.bounce(edges - 1, &vertex, roulette);
            let Some((direction, s, delta)) = vertex.sample(Walk::FromCamera, bounce.u) else { break };
            throughput *= s.value * (1.0 / s.forward.0);
            if !throughput.is_valid() {
                sink.invalid();
                break;
            }
            radiance_scale *= vertex.radiance_scale(direction);
            arrival = if delta {
                Arrival::Sure
            } else {
                Arrival::Sampled { from: vertex.receiver(), pdf: s.forward.0 }
            };
            if roulette {
                // The throughput without the radiance scale of refraction.
                let survival = (LIVES * throughput.max_lane() / radiance_scale).min(0.99);
                if bounce.survival >= survival {
                    break;
                }
                throughput *= 1.0 / survival;
            }
            ray = Ray { origin: vertex.point.off_surface(direction), direction, t_max: f32::INFINITY };
        }
        self.deliver(sum, filter_weight, sink);
    }

    /// The weighted radiance of a lamp that the ray hit.
    fn lamp(&self, lamp: &LightPoint, ray: &Ray, how: (&Arrival, Technique)) -> Spectrum {
        let radiance = self.scene.lights(self.wavelengths).radiance(lamp, -ray.direction);
        if radiance.is_black() { radiance } else { radiance * self.hit_weight(lamp, how) }
    }

    /// The weighted radiance of all environments behind the ray.
    fn environment(&self, ray: &Ray, arrival: &Arrival, technique: Technique) -> Spectrum {
        let lights = self.scene.lights(self.wavelengths);
        let mut sum = Spectrum::ZERO;
        for index in lights.lights.environments() {
            let lamp = LightPoint::infinite(*index, ray.direction);
            let weight = self.hit_weight(&lamp, (arrival, technique));
            sum += lights.radiance(&lamp, -ray.direction) * weight;
        }
        sum
    }

    /// The weight of hitting a lamp against finding it by next-event estimation.
    fn hit_weight(&self, lamp: &LightPoint, (arrival, technique): (&Arrival, Technique)) -> f32 {
        let Arrival::Sampled { from, pdf } = arrival else { return 1.0 };
        match technique {
            Technique::Materials => 1.0,
            Technique::Emitters => 0.0,
            Technique::Mis => {
                let (direction, distance) = lamp.direction_from(from.at);
                let hit = pdf * Edge::of_length(distance).jacobian(lamp.cos(direction));
                let found = self.scene.lights(self.wavelengths).towards_pdf(*from, lamp);
                self.heuristic.share(hit, found.0)
            }
        }
    }

    /// Next-event estimation, weighed against hitting the lamp.
    fn direct_light(
        &self,
        vertex: &Vertex,
        technique: Technique,
        (choice, u): ([f32; 2], [f32; 2]),
    ) -> Spectrum {
        let lights = self.scene.lights(self.wavelengths);
        let Some(found) = lights.sample_towards(vertex.receiver(), choice, u) else {
            return Spectrum::ZERO;
        };
        let Some(scatter) = vertex.scatter(Walk::FromCamera, found.direction) else { return Spectrum::ZERO };
        if !self.is_lit(vertex, &found) {
            return Spectrum::ZERO;
        }
        let to_lamp = Edge::of_length(found.distance).jacobian(found.point.cos(found.direction));
        let value = scatter.value * found.radiance * (to_lamp / found.pdf.0);
        if technique == Technique::Emitters || lights.lights.get(found.point.light).is_delta() {
            return value;
        }
        value * self.heuristic.share(found.pdf.0, scatter.forward.0 * to_lamp)
    }
}
