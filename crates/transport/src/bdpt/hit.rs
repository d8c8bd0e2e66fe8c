//! s = 0: the eye path meets a lamp.

use caustica_math::Spectrum;
use caustica_scene::light::LightPoint;

use super::{Joined, Junction, Sample};
use crate::kernel::Kernel;
use crate::sink::Sink;
use crate::strategy::Strategy;
use crate::weight::weight;

impl Kernel<'_> {
    /// s = 0: eye vertices on lamps, and the environment.
    pub(super) fn hits<S: Sink>(&self, sample: &Sample<'_>, sink: &mut S) -> Spectrum {
        let lights = self.scene.lights(self.wavelengths);
        let mut sum = Spectrum::ZERO;
        for (i, vertex) in sample.eye.vertices.iter().enumerate() {
            let Some(lamp) = self.scene.lamp_at(&vertex.point) else { continue };
            let radiance = lights.radiance(&lamp, vertex.prev);
            if !radiance.is_black() {
                sum += self.hit(sample, i + 2, (&lamp, vertex.throughput * radiance), sink);
            }
        }
        if let Some(escape) = sample.eye.escape {
            for index in lights.lights.environments() {
                let lamp = LightPoint::infinite(*index, escape.direction);
                let value = escape.throughput * lights.radiance(&lamp, -escape.direction);
                if !value.is_black() {
                    sum += self.hit(sample, sample.eye.vertices.len() + 2, (&lamp, value), sink);
                }
            }
        }
        sum
    }

    /// The path whose `t` camera vertices end on `lamp`.
    fn hit<S: Sink>(
        &self,
        sample: &Sample<'_>,
        t: usize,
        (lamp, value): (&LightPoint, Spectrum),
        sink: &mut S,
    ) -> Spectrum {
        let lights = self.scene.lights(self.wavelengths);
        let vertices = &sample.eye.vertices;
        // The lamp is eye vertex t − 2; seen from infinity it is not among the vertices.
        let direction = match vertices.get(t - 2) {
            Some(v) => v.prev,
            None => -lamp.at,
        };
        let pdf = lights.emission_pdf(lamp, direction);
        let joined = Joined {
            strategy: Strategy { s: 0, t: t as u32 },
            lamp: *lamp,
            emitted: pdf.point.0,
            junction: Junction { light: (0.0, 0.0), eye: (pdf.point.0, pdf.direction.0) },
            value,
            film: sample.film,
            camera: sample.camera,
        };
        self.finish(
            sample,
            &joined,
            || {
                let h = self.heuristic;
                let sums = match (sample.eye.vertices.get(t - 2), sample.eye.escape) {
                    (Some(v), _) => v.sums,
                    (None, Some(e)) => e.sums,
                    (None, None) => return 1.0,
                };
                let one_less = if t == 2 {
                    // (1, 1): the lamp's point by emission.
                    h.of(pdf.point.0) * sums.recent
                } else if self.classes.next_event {
                    let from = &sample.eye.vertices[t - 3];
                    let found = lights.towards_pdf(from.point.position, lamp);
                    let forward = sample
                        .eye
                        .vertices
                        .get(t - 2)
                        .map_or_else(|| sample.eye.escape.map_or(0.0, |e| e.forward), |v| v.forward);
                    if from.delta { 0.0 } else { h.of(found.0 / forward) }
                } else {
                    0.0
                };
                let further = h.of(pdf.point.0) * h.of(pdf.direction.0) * sums.past;
                weight(0.0, one_less + further)
            },
            sink,
        )
    }
}
