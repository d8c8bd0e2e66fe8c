//! Bidirectional path tracing: all strategies of one sample.

mod aimed;
mod candidate;
mod connection;
mod exhaustive;
mod hit;
mod next_event;
mod splat;

use std::cell::RefCell;

use caustica_math::{SampleId, Spectrum, Vec2};
use caustica_scene::camera::{CameraLink, CameraPoint};
use caustica_scene::light::{Emission, LightPoint};

pub(crate) use candidate::Candidates;

use crate::kernel::{EyeSample, Kernel, Scratch};
use crate::shared::LightPath;
use crate::sink::{Contribution, PathView, Sink};
use crate::strategy::Strategy;
use crate::vertex::Vertex;
use crate::walk::{Start, Subpath};
use crate::weight::VertexDensities;

/// One sample's subpaths.
struct Sample<'a> {
    eye: &'a Subpath,
    /// The light paths that it is joined with.
    lights: &'a [LightPath],
    camera: CameraPoint,
    film: Vec2,
    filter_weight: f32,
    /// Room for the exhaustive weights.
    densities: RefCell<&'a mut Vec<VertexDensities>>,
    /// Room for the weights of all strategies.
    weights: RefCell<&'a mut Vec<f32>>,
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
#[derive(Clone, Copy, Debug)]
pub(crate) struct Joined {
    strategy: Strategy,
    /// Which light path has its light vertices, if there are any.
    light: usize,
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
        let light = 0;
        Joined { strategy, light, lamp, emitted, junction, value, film: self.film, camera: self.camera }
    }
}

impl Sample<'_> {
    /// The light vertices of a path.
    fn light_vertices(&self, joined: &Joined) -> &[Vertex] {
        match joined.strategy.s as usize {
            0 | 1 => &[],
            s => &self.lights[joined.light].path.vertices[..s - 1],
        }
    }
}

impl Joined {
    /// A path of strategy (s, 1), seen through `link`.
    fn seen(
        strategy: Strategy,
        (light, emission): (usize, &Emission),
        junction: Junction,
        value: Spectrum,
        link: &CameraLink,
    ) -> Self {
        let (lamp, emitted) = (emission.point, emission.pdf.point.0);
        Self { strategy, light, lamp, emitted, junction, value, film: link.film, camera: link.point }
    }
}

impl Kernel<'_> {
    pub(crate) fn bdpt<S: Sink>(&self, id: SampleId, scratch: &mut Scratch, sink: &mut S) {
        let EyeSample { film, filter_weight, ray, mut numbers } = self.eye_sample(id);
        let classes = self.classes;
        let Scratch { eye, lights, densities, weights, candidates, aimed, .. } = scratch;
        eye.clear();
        if classes.hit || classes.next_event || classes.inner {
            self.grow(Self::camera_flight(&ray), &Start::Camera, &mut numbers, eye);
        }
        let lights = if classes.splat || classes.inner { self.grow_light_paths(id, lights) } else { &[] };
        let own = lights.iter().position(|light| light.pixel == id.pixel);
        for failed in [eye.failed, own.is_some_and(|own| lights[own].path.failed)] {
            if failed {
                sink.invalid();
            }
        }
        let (densities, weights) = (RefCell::new(densities), RefCell::new(weights));
        let sample = Sample { eye, lights, camera: ray.point, film, filter_weight, densities, weights };
        let mut sum = Spectrum::ZERO;
        if classes.hit {
            sum += self.hits(&sample, sink);
            sum += self.aimed_hits(&sample, (&mut numbers, aimed), sink);
        }
        candidates.clear();
        if classes.next_event {
            self.next_events::<S>(&sample, &mut numbers, candidates);
        }
        if classes.inner {
            self.connections::<S>(&sample, candidates);
        }
        sum += self.settle(&sample, sum, (candidates, &mut numbers), sink);
        if let Some(own) = own.filter(|_| classes.splat) {
            self.splats(&sample, own, &mut self.light_numbers(id), sink);
        }
        self.deliver(sum, filter_weight, sink);
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
        let Some(weight) = self.weigh(sample, joined, running) else { return Spectrum::ZERO };
        let value = joined.value * weight;
        if !value.is_valid() {
            sink.invalid();
            return Spectrum::ZERO;
        }
        if S::PROBES {
            self.report(sample, joined, weight, sink);
        }
        value
    }

    /// A contribution's weight; `None` if its strategy is not in the set. (Running sums are used with sets of whole
    /// classes, whose other members are not asked.)
    #[inline]
    fn weigh(&self, sample: &Sample<'_>, joined: &Joined, running: impl Fn() -> f32) -> Option<f32> {
        if !self.exhaustive {
            return Some(running());
        }
        self.is_wanted(joined.strategy).then(|| self.exhaustive_weight(sample, joined))
    }

    /// Whether the strategy is in the set; where weights are running sums, all of its class are.
    fn is_wanted(&self, strategy: Strategy) -> bool {
        !self.exhaustive || self.settings.strategies.contains(strategy)
    }

    /// Tells a sink that probes.
    fn report<S: Sink>(&self, sample: &Sample<'_>, joined: &Joined, weight: f32, sink: &mut S) {
        let (s, t) = (joined.strategy.s as usize, joined.strategy.t as usize);
        let eye = &sample.eye.vertices;
        let mut weights = sample.weights.borrow_mut();
        if S::WEIGHS_ALL {
            self.all_weights(sample, joined, &mut weights);
            if s == 0 && t > 2 {
                weights[0] *= self.walk_share(&eye[..t - 2]);
            }
        } else {
            weights.clear();
        }
        sink.contribution(&Contribution {
            strategy: joined.strategy,
            unweighted: joined.value,
            weight,
            film: joined.film,
            filter_weight: if t == 1 { self.scene.camera.response() } else { sample.filter_weight },
            light_path: joined.light,
            path: PathView {
                lamp: joined.lamp,
                light: sample.light_vertices(joined),
                eye: &eye[..(t - 1).min(eye.len())],
                camera: joined.camera,
            },
            weights: &weights,
        });
    }
}
