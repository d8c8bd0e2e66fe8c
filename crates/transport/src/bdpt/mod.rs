//! Bidirectional path tracing: all strategies of one sample.

mod connection;
mod exhaustive;
mod hit;
mod next_event;
mod splat;

use std::cell::RefCell;

use caustica_math::{SampleId, Spectrum, Vec2};
use caustica_scene::bvh::Ray;
use caustica_scene::camera::{CameraLink, CameraPoint};
use caustica_scene::light::{Anchor, Emission, LightPoint};

use crate::kernel::{EyeSample, Kernel, Scratch};
use crate::numbers::LightNumbers;
use crate::sink::{Contribution, PathView, Sink};
use crate::strategy::Strategy;
use crate::walk::{Flight, Start, Subpath};
use crate::weight::VertexDensities;

/// One sample's subpaths.
struct Sample<'a> {
    eye: &'a Subpath,
    light: &'a Subpath,
    emission: Option<Emission>,
    camera: CameraPoint,
    film: Vec2,
    /// Room for the exhaustive weights.
    densities: RefCell<&'a mut Vec<VertexDensities>>,
}

/// Densities at the two ends of a joining edge, by the walks that did not make them, in the ends' own measures.
#[derive(Clone, Copy, Debug, Default)]
struct Junction {
    /// p← of the last light vertex, and the solid-angle density at it of going back to the one before.
    light: (f32, f32),
    /// p→ of the last eye vertex, and the solid-angle density at it of going back to the one before.
    eye: (f32, f32),
}

/// A path made by one strategy, before its weight is known.
struct Joined {
    strategy: Strategy,
    lamp: LightPoint,
    junction: Junction,
    /// Density of the lamp's point by emission.
    emitted: f32,
    value: Spectrum,
    film: Vec2,
    camera: CameraPoint,
}

impl Sample<'_> {
    /// A path of strategy (s, t) with t ≥ 2: it belongs to the sample's own pixel. The lamp comes with its density
    /// by emission.
    fn joined(
        &self,
        strategy: Strategy,
        (lamp, emitted): (LightPoint, f32),
        junction: Junction,
        value: Spectrum,
    ) -> Joined {
        Joined { strategy, lamp, emitted, junction, value, film: self.film, camera: self.camera }
    }
}

impl Joined {
    /// A path of strategy (s, 1), seen through `link`.
    fn seen(
        strategy: Strategy,
        emission: &Emission,
        junction: Junction,
        value: Spectrum,
        link: &CameraLink,
    ) -> Self {
        let (lamp, emitted) = (emission.point, emission.pdf.point.0);
        Self { strategy, lamp, emitted, junction, value, film: link.film, camera: link.point }
    }
}

impl Kernel<'_> {
    pub(crate) fn bdpt<S: Sink>(&self, id: SampleId, scratch: &mut Scratch, sink: &mut S) {
        let EyeSample { film, filter_weight, ray, mut numbers } = self.eye_sample(id);
        let mut light_numbers = LightNumbers::new(self.settings.sampler, id);
        let classes = self.classes;
        if classes.hit || classes.next_event || classes.inner {
            self.grow(Self::camera_flight(&ray), &Start::Camera, &mut numbers, &mut scratch.eye);
        }
        let emission = if classes.splat || classes.inner {
            self.light_path(&mut light_numbers, &mut scratch.light)
        } else {
            None
        };
        let Scratch { eye, light, densities } = scratch;
        let densities = RefCell::new(densities);
        let sample = Sample { eye, light, emission, camera: ray.point, film, densities };
        let mut sum = Spectrum::ZERO;
        if classes.hit {
            sum += self.hits(&sample, sink);
        }
        if classes.next_event {
            sum += self.next_events(&sample, &mut numbers, sink);
        }
        if classes.inner {
            sum += self.connections(&sample, sink);
        }
        if classes.splat {
            self.splats(&sample, &mut light_numbers, sink);
        }
        sink.eye(self.wavelengths.rgb(sum * filter_weight));
    }

    /// Emits and grows the light path.
    fn light_path(&self, numbers: &mut LightNumbers, path: &mut Subpath) -> Option<Emission> {
        path.vertices.clear();
        let [choice, u, v] = numbers.emission();
        let emission = self.scene.lights(self.wavelengths).sample_emission(choice, u, v)?;
        self.grow(emission_flight(&emission), &Start::Light(&emission), numbers, path);
        Some(emission)
    }

    /// Weighs a contribution and tells a sink that probes.
    #[inline]
    fn finish<S: Sink>(
        &self,
        sample: &Sample<'_>,
        joined: &Joined,
        running: impl Fn() -> f32,
        sink: &mut S,
    ) -> Spectrum {
        let weight = if self.exhaustive {
            if !self.settings.strategies.contains(joined.strategy) {
                return Spectrum::ZERO;
            }
            self.exhaustive_weight(sample, joined)
        } else {
            running()
        };
        if S::PROBES {
            let (s, t) = (joined.strategy.s as usize, joined.strategy.t as usize);
            let eye = &sample.eye.vertices;
            sink.contribution(&Contribution {
                strategy: joined.strategy,
                unweighted: joined.value,
                weight,
                film: joined.film,
                path: PathView {
                    lamp: joined.lamp,
                    light: &sample.light.vertices[..s.saturating_sub(1)],
                    eye: &eye[..(t - 1).min(eye.len())],
                    camera: joined.camera,
                },
            });
        }
        joined.value * weight
    }
}

/// The first flight of a light walk.
pub(crate) fn emission_flight(emission: &Emission) -> Flight {
    let pdf = emission.pdf;
    Flight {
        ray: Ray { origin: emission.origin, direction: emission.direction, t_max: f32::INFINITY },
        throughput: emission.radiance * (emission.cos / (pdf.point.0 * pdf.direction.0)),
        pdf: pdf.direction.0,
        from: (emission.point.anchor != Anchor::Infinite).then_some(emission.point.at),
        cos: emission.cos,
        reverse: 0.0,
        delta: false,
        radiance_scale: 1.0,
    }
}
