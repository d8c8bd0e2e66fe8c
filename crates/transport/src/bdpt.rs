//! Bidirectional path tracing: all strategies of one sample.

use std::cell::RefCell;

use caustica_math::{SampleStream, Spectrum, StreamId, Vec2};
use caustica_scene::bsdf::Walk;
use caustica_scene::bvh::Ray;
use caustica_scene::camera::{CameraLink, CameraPoint};
use caustica_scene::light::{Anchor, Emission, LightPoint, Towards};

use crate::edge::Edge;
use crate::kernel::{EyeSample, Kernel, Scratch, streams};
use crate::sink::{Contribution, PathView, Sink};
use crate::strategy::Strategy;
use crate::vertex::{Scatter, Vertex};
use crate::walk::{Flight, Start, Subpath};
use crate::weight::{Ends, VertexDensities, exhaustive, weight};

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

impl Kernel<'_> {
    pub(crate) fn bdpt<S: Sink>(&self, pixel: [u32; 2], id: StreamId, scratch: &mut Scratch, sink: &mut S) {
        let EyeSample { film, filter_weight, ray, mut stream } = self.eye_sample(pixel, id);
        let classes = self.classes;
        if classes.hit || classes.next_event || classes.inner {
            self.grow(Self::camera_flight(&ray), &Start::Camera, &mut stream, &mut scratch.eye);
        }
        let emission =
            if classes.splat || classes.inner { self.light_path(id, &mut scratch.light) } else { None };
        let Scratch { eye, light, densities } = scratch;
        let densities = RefCell::new(densities);
        let sample = Sample { eye, light, emission, camera: ray.point, film, densities };
        let mut sum = Spectrum::ZERO;
        if classes.hit {
            sum += self.hits(&sample, sink);
        }
        let mut stream = SampleStream::new(StreamId { walk: streams::JOIN, ..id });
        if classes.next_event {
            sum += self.next_events(&sample, &mut stream, sink);
        }
        if classes.inner {
            sum += self.connections(&sample, sink);
        }
        if classes.splat {
            self.splats(&sample, &mut stream, sink);
        }
        sink.eye(self.wavelengths.rgb(sum * filter_weight));
    }

    /// Emits and grows the light path.
    fn light_path(&self, id: StreamId, path: &mut Subpath) -> Option<Emission> {
        path.vertices.clear();
        let mut stream = SampleStream::new(StreamId { walk: streams::LIGHT, ..id });
        let (choice, u, v) = (stream.next_1d(), stream.next_2d(), stream.next_2d());
        let emission = self.scene.lights(self.wavelengths).sample_emission(choice, u, v)?;
        self.grow(emission_flight(&emission), &Start::Light(&emission), &mut stream, path);
        Some(emission)
    }

    /// s = 0: eye vertices on lamps, and the environment.
    fn hits<S: Sink>(&self, sample: &Sample<'_>, sink: &mut S) -> Spectrum {
        let lights = self.scene.lights(self.wavelengths);
        let mut sum = Spectrum::ZERO;
        for (i, vertex) in sample.eye.vertices.iter().enumerate() {
            let Some(lamp) = self.scene.lamp_at(&vertex.point) else { continue };
            let radiance = lights.radiance(&lamp, vertex.prev);
            if !radiance.is_black() {
                sum += self.hit(sample, i + 2, &lamp, vertex.throughput * radiance, sink);
            }
        }
        if let Some(escape) = sample.eye.escape {
            for index in lights.lights.environments() {
                let lamp = LightPoint::infinite(*index, escape.direction);
                let value = escape.throughput * lights.radiance(&lamp, -escape.direction);
                if !value.is_black() {
                    sum += self.hit(sample, sample.eye.vertices.len() + 2, &lamp, value, sink);
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
        lamp: &LightPoint,
        value: Spectrum,
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

    /// s = 1: next-event estimation at every eye vertex.
    fn next_events<S: Sink>(&self, sample: &Sample<'_>, stream: &mut SampleStream, sink: &mut S) -> Spectrum {
        let lights = self.scene.lights(self.wavelengths);
        let mut sum = Spectrum::ZERO;
        // One more edge joins the lamp.
        let count = sample.eye.vertices.len().min(self.max_edges - 1);
        for i in 0..count {
            let vertex = &sample.eye.vertices[i];
            let (choice, u) = (stream.next_1d(), stream.next_2d());
            if !vertex.is_connectible() {
                continue;
            }
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
        let joined = Joined {
            strategy: Strategy { s: 1, t: t as u32 },
            lamp: found.point,
            emitted: pdf.point.0,
            junction: Junction { light: (from_camera, 0.0), eye: (from_light, scatter.reverse.0) },
            value,
            film: sample.film,
            camera: sample.camera,
        };
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

    /// s ≥ 2, t ≥ 2: every light vertex with every eye vertex.
    fn connections<S: Sink>(&self, sample: &Sample<'_>, sink: &mut S) -> Spectrum {
        let mut sum = Spectrum::ZERO;
        let (eye, light) = (sample.eye, sample.light);
        for (i, z) in eye.vertices.iter().enumerate() {
            if !z.is_connectible() {
                continue;
            }
            for (j, y) in light.vertices.iter().enumerate() {
                // Edges: i + 1 of the eye path, j + 1 of the light path, and the one that joins.
                if i + j + 3 > self.max_edges {
                    break;
                }
                if y.is_connectible() {
                    sum += self.connection(sample, (j + 2, i + 2), (y, z), sink).unwrap_or(Spectrum::ZERO);
                }
            }
        }
        sum
    }

    #[inline]
    fn connection<S: Sink>(
        &self,
        sample: &Sample<'_>,
        (s, t): (usize, usize),
        (y, z): (&Vertex, &Vertex),
        sink: &mut S,
    ) -> Option<Spectrum> {
        let strategy = Strategy { s: s as u32, t: t as u32 };
        if self.exhaustive && !self.settings.strategies.contains(strategy) {
            return None;
        }
        let d = z.point.position - y.point.position;
        let length_squared = d.length_squared();
        if length_squared <= 0.0 {
            return None;
        }
        let direction = d * (1.0 / length_squared.sqrt());
        let at_eye: Scatter = z.scatter(Walk::FromCamera, -direction)?;
        let at_light: Scatter = y.scatter(Walk::FromLight, direction)?;
        let edge = Edge::finite(length_squared);
        let value = y.throughput * at_light.value * at_eye.value * z.throughput * edge.falloff;
        if value.is_black()
            || !self.scene.visible(y.point.off_surface(direction), z.point.off_surface(-direction))
        {
            return None;
        }
        let junction = Junction {
            light: (at_eye.forward.0 * edge.jacobian(y.cos(direction)), at_light.reverse.0),
            eye: (at_light.forward.0 * edge.jacobian(z.cos(direction)), at_eye.reverse.0),
        };
        let emission = sample.emission.as_ref()?;
        let joined = Joined {
            strategy,
            lamp: emission.point,
            emitted: emission.pdf.point.0,
            junction,
            value,
            film: sample.film,
            camera: sample.camera,
        };
        Some(self.finish(
            sample,
            &joined,
            || {
                let h = self.heuristic;
                weight(
                    y.sums.total(junction.light.0, junction.light.1, h),
                    z.sums.total(junction.eye.0, junction.eye.1, h),
                )
            },
            sink,
        ))
    }

    /// t = 1: the lamp's point and every light vertex, into the light image.
    fn splats<S: Sink>(&self, sample: &Sample<'_>, stream: &mut SampleStream, sink: &mut S) {
        let Some(emission) = sample.emission else { return };
        let lens = stream.next_2d();
        if let Some(value) = self.splat_lamp(sample, &emission, lens, sink) {
            self.splat(value.1, value.0, sink);
        }
        for i in 0..sample.light.vertices.len() {
            let lens = stream.next_2d();
            if sample.light.vertices[i].is_connectible()
                && let Some((value, film)) = self.splat_vertex(sample, i, lens, sink)
            {
                self.splat(film, value, sink);
            }
        }
    }

    /// (1, 1): the lamp as the camera sees it.
    fn splat_lamp<S: Sink>(
        &self,
        sample: &Sample<'_>,
        emission: &Emission,
        lens: [f32; 2],
        sink: &mut S,
    ) -> Option<(Spectrum, Vec2)> {
        let (lamp, link, radiance) = self.lamp_link(emission, lens)?;
        let from_camera = link.pdf.0 * link.falloff * lamp.cos(link.direction);
        let value = radiance * (from_camera / (emission.pdf.point.0 * self.light_paths));
        let joined = Joined {
            strategy: Strategy { s: 1, t: 1 },
            lamp,
            emitted: emission.pdf.point.0,
            junction: Junction { light: (from_camera, 0.0), eye: (0.0, 0.0) },
            value,
            film: link.film,
            camera: link.point,
        };
        let value = self.finish(
            sample,
            &joined,
            || {
                let h = self.heuristic;
                let hit = h.of(from_camera / (self.light_paths * emission.pdf.point.0));
                weight(if self.classes.hit { hit } else { 0.0 }, 0.0)
            },
            sink,
        );
        Some((value, link.film))
    }

    /// How the camera sees the point of an emission; `None` if it does not, or if the lamp has no extent.
    pub(crate) fn lamp_link(
        &self,
        emission: &Emission,
        lens: [f32; 2],
    ) -> Option<(LightPoint, CameraLink, Spectrum)> {
        let lights = self.scene.lights(self.wavelengths);
        let lamp = emission.point;
        let light = lights.lights.get(lamp.light);
        if light.is_delta() {
            return None;
        }
        let link = if light.is_infinite() {
            self.scene.camera.connect_direction(lamp.at, lens)?
        } else {
            self.scene.camera.connect(lamp.at, lens)?
        };
        let radiance = lights.radiance(&lamp, link.direction);
        if radiance.is_black() || !self.is_seen(link.film) {
            return None;
        }
        let free = if light.is_infinite() {
            !self.scene.occluded(&Ray { origin: link.end, direction: lamp.at, t_max: link.t_max })
        } else {
            self.scene.visible(lamp.off_surface(link.direction), link.end)
        };
        free.then_some((lamp, link, radiance))
    }

    fn splat_vertex<S: Sink>(
        &self,
        sample: &Sample<'_>,
        i: usize,
        lens: [f32; 2],
        sink: &mut S,
    ) -> Option<(Spectrum, Vec2)> {
        let strategy = Strategy { s: i as u32 + 2, t: 1 };
        let y = &sample.light.vertices[i];
        let (link, at_light) = self.camera_link(y, lens)?;
        let value = y.throughput * at_light.value * (link.pdf.0 * link.falloff / self.light_paths);
        if value.is_black() || !self.scene.visible(y.point.off_surface(link.direction), link.end) {
            return None;
        }
        let from_camera = link.pdf.0 * link.falloff * y.cos(link.direction);
        let junction = Junction { light: (from_camera, at_light.reverse.0), eye: (0.0, 0.0) };
        let emission = sample.emission.as_ref()?;
        let joined = Joined {
            strategy,
            lamp: emission.point,
            emitted: emission.pdf.point.0,
            junction,
            value,
            film: link.film,
            camera: link.point,
        };
        let value = self.finish(
            sample,
            &joined,
            || {
                let h = self.heuristic;
                let sums = sample.light.vertices[i].sums;
                weight(sums.total(from_camera / self.light_paths, at_light.reverse.0, h), 0.0)
            },
            sink,
        );
        Some((value, link.film))
    }

    /// How the camera sees a light vertex, with the scattering towards it; visibility is not tested.
    pub(crate) fn camera_link(&self, y: &Vertex, lens: [f32; 2]) -> Option<(CameraLink, Scatter)> {
        let link = self.scene.camera.connect(y.point.position, lens)?;
        if !self.is_seen(link.film) {
            return None;
        }
        let scatter = y.scatter(Walk::FromLight, link.direction)?;
        Some((link, scatter))
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

    /// The weight by adding up all strategies.
    fn exhaustive_weight(&self, sample: &Sample<'_>, joined: &Joined) -> f32 {
        let lights = self.scene.lights(self.wavelengths);
        let (s, t) = (joined.strategy.s as usize, joined.strategy.t as usize);
        let Junction { light: (light_end, before_light), eye: (eye_end, before_eye) } = joined.junction;
        let light = &sample.light.vertices[..s.saturating_sub(1)];
        let escaped = s == 0 && t - 1 > sample.eye.vertices.len();
        let eye = &sample.eye.vertices[..t - 1 - usize::from(escaped)];
        let delta_lamp = lights.lights.get(joined.lamp.light).is_delta();
        let mut all = sample.densities.borrow_mut();
        all.clear();
        if s >= 1 {
            let from_camera = match s {
                1 => light_end,
                2 => before_light * light[0].back,
                _ => sample.light.origin_reverse,
            };
            all.push(VertexDensities { from_light: joined.emitted, from_camera, delta: delta_lamp });
        }
        for (j, v) in light.iter().enumerate() {
            let last = light.len() - 1;
            let from_camera = match last - j {
                0 => light_end,
                1 => before_light * light[last].back,
                _ => v.reverse,
            };
            all.push(VertexDensities { from_light: v.forward, from_camera, delta: j < last && v.delta });
        }
        if escaped && let Some(e) = sample.eye.escape {
            all.push(VertexDensities { from_light: eye_end, from_camera: e.forward, delta: false });
        }
        for (j, v) in eye.iter().enumerate().rev() {
            // How many vertices lie between this one and the joining edge.
            let inward = t - 2 - j;
            let from_light = match inward {
                0 => eye_end,
                1 if escaped => before_eye * sample.eye.escape.map_or(0.0, |e| e.back),
                1 => before_eye * eye[j + 1].back,
                _ => v.reverse,
            };
            all.push(VertexDensities { from_light, from_camera: v.forward, delta: inward > 0 && v.delta });
        }
        let next_to_lamp = match (light.first(), eye.len()) {
            (Some(v), _) => Some(v.point.position),
            (None, n) => {
                let skip = usize::from(s == 0 && !escaped);
                n.checked_sub(1 + skip).map(|i| eye[i].point.position)
            }
        };
        let found = next_to_lamp.map_or(0.0, |from| lights.towards_pdf(from, &joined.lamp).0);
        let ends = Ends { next_event: found, light_paths: self.light_paths };
        let set = &self.settings.strategies;
        let k = (s + t - 1) as u32;
        // A parallel projection and an environment seen directly: (1, 1) cannot join them.
        let unjoinable = joined.camera.infinite && escaped && k == 1;
        exhaustive(&all, ends, s, self.heuristic, |i| {
            set.contains(Strategy { s: i as u32, t: k + 1 - i as u32 }) && !(unjoinable && i == 1)
        })
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
