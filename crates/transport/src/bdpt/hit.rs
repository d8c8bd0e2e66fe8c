//! s = 0: the eye path meets a lamp.

use caustica_math::{Spectrum, Vec3};
use caustica_scene::light::LightPoint;

use super::{Junction, Sample};
use crate::fault::{Fault, is_planted};
use crate::kernel::Kernel;
use crate::sink::Sink;
use crate::strategy::Strategy;
use crate::weight::{RunningSums, weight};

/// The end of an eye path on a lamp: a surface vertex, or one at infinity.
struct End {
    lamp: LightPoint,
    /// The unit direction in which the lamp's light leaves along the path.
    direction: Vec3,
    /// Density of the vertex by the camera walk, in its own measure.
    forward: f32,
    sums: RunningSums,
}

impl Kernel<'_> {
    /// s = 0: eye vertices on lamps, and the environment.
    pub(super) fn hits<S: Sink>(&self, sample: &Sample<'_>, sink: &mut S) -> Spectrum {
        let lights = self.scene.lights(self.wavelengths);
        let mut sum = Spectrum::ZERO;
        for (i, vertex) in sample.eye.vertices.iter().enumerate() {
            let Some(lamp) = self.scene.lamp_at(&vertex.point) else { continue };
            let value = vertex.throughput * lights.radiance(&lamp, vertex.prev);
            let end = End { lamp, direction: vertex.prev, forward: vertex.forward, sums: vertex.sums };
            sum += self.hit(sample, i + 2, (&end, value), sink);
        }
        if let Some(escape) = sample.eye.escape {
            for index in lights.lights.environments() {
                let lamp = LightPoint::infinite(*index, escape.direction);
                let value = escape.throughput * lights.radiance(&lamp, -escape.direction);
                let end =
                    End { lamp, direction: -escape.direction, forward: escape.forward, sums: escape.sums };
                sum += self.hit(sample, sample.eye.vertices.len() + 2, (&end, value), sink);
            }
        }
        sum
    }

    /// The path whose `t` camera vertices end on a lamp.
    fn hit<S: Sink>(
        &self,
        sample: &Sample<'_>,
        t: usize,
        (end, value): (&End, Spectrum),
        sink: &mut S,
    ) -> Spectrum {
        if value.is_black() {
            return value;
        }
        let lights = self.scene.lights(self.wavelengths);
        let pdf = lights.emission_pdf(&end.lamp, end.direction);
        let junction = Junction { light: (0.0, 0.0), eye: (pdf.point.0, pdf.direction.0) };
        let strategy = Strategy { s: 0, t: t as u32 };
        // What aimed rays find too, they share.
        let share = if t > 2 { self.walk_share(&sample.eye.vertices[..t - 2]) } else { 1.0 };
        let joined = sample.joined(strategy, (end.lamp, pdf.point.0), junction, value * share);
        self.finish(
            sample,
            &joined,
            || {
                let h = self.heuristic;
                let one_less = if t == 2 {
                    // (1, 1): the lamp's point by emission.
                    h.of(pdf.point.0 * end.sums.recent)
                } else {
                    let from = &sample.eye.vertices[t - 3];
                    if from.delta || !self.classes.next_event {
                        0.0
                    } else {
                        let share = if is_planted(Fault::NextEventDensity) { 0.5 } else { 1.0 };
                        h.of(share * lights.towards_pdf(from.receiver(), &end.lamp).0 / end.forward)
                    }
                };
                let further = h.of(pdf.point.0 * pdf.direction.0 * end.sums.past);
                weight(0.0, one_less + further)
            },
            sink,
        )
    }
}
