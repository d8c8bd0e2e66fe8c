//! t = 1: the light image.

use caustica_math::{Spectrum, Vec2};
use caustica_scene::bsdf::Walk;
use caustica_scene::bvh::Ray;
use caustica_scene::camera::CameraLink;
use caustica_scene::light::{Emission, LightPoint};

use super::{Joined, Junction, Sample};
use crate::fault::{Fault, is_planted};
use crate::kernel::Kernel;
use crate::numbers::LightNumbers;
use crate::shared::LightPath;
use crate::sink::Sink;
use crate::strategy::Strategy;
use crate::vertex::{Scatter, Vertex};
use crate::weight::weight;

impl Kernel<'_> {
    /// t = 1: the lamp's point and every light vertex, into the light image.
    pub(super) fn splats<S: Sink>(
        &self,
        sample: &Sample<'_>,
        own: usize,
        numbers: &mut LightNumbers,
        sink: &mut S,
    ) {
        let LightPath { path, emission, .. } = &sample.lights[own];
        let Some(emission) = emission else { return };
        let light = (own, emission);
        if let Some(value) = self.splat_lamp(sample, light, numbers.lamp_lens(), sink) {
            self.splat(value.1, value.0, sink);
        }
        for (i, vertex) in path.vertices.iter().enumerate() {
            if vertex.is_connectible()
                && let Some((value, film)) =
                    self.splat_vertex(sample, light, (i, vertex, numbers.lens(i)), sink)
            {
                self.splat(film, value, sink);
            }
        }
    }

    /// (1, 1): the lamp as the camera sees it.
    fn splat_lamp<S: Sink>(
        &self,
        sample: &Sample<'_>,
        (own, emission): (usize, &Emission),
        lens: [f32; 2],
        sink: &mut S,
    ) -> Option<(Spectrum, Vec2)> {
        let strategy = Strategy { s: 1, t: 1 };
        if !self.is_wanted(strategy) {
            return None;
        }
        let (lamp, link, radiance) = self.lamp_link(emission, lens)?;
        let from_camera = link.pdf.0 * link.falloff * lamp.cos(link.direction);
        let value = radiance * (from_camera / (emission.pdf.point.0 * self.light_paths));
        let junction = Junction { light: (from_camera, 0.0), eye: (0.0, 0.0) };
        let joined = Joined::seen(strategy, (own, emission), junction, value, &link);
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
        if light.is_delta() || self.scene.camera.hides_lamps() {
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
        (own, emission): (usize, &Emission),
        (i, y, lens): (usize, &Vertex, [f32; 2]),
        sink: &mut S,
    ) -> Option<(Spectrum, Vec2)> {
        let strategy = Strategy { s: i as u32 + 2, t: 1 };
        if !self.is_wanted(strategy) {
            return None;
        }
        let (link, at_light) = self.camera_link(y, lens)?;
        let value = y.throughput * at_light.value * (link.pdf.0 * link.falloff / self.light_paths);
        if value.is_black() || !self.is_seen_from_camera(&y.point, &link) {
            return None;
        }
        let from_camera = link.pdf.0 * link.falloff * y.cos(link.direction);
        let junction = Junction { light: (from_camera, at_light.reverse.0), eye: (0.0, 0.0) };
        let joined = Joined::seen(strategy, (own, emission), junction, value, &link);
        let value = self.finish(
            sample,
            &joined,
            || {
                let h = self.heuristic;
                let paths = if is_planted(Fault::LightPaths) { 1.0 } else { self.light_paths };
                weight(y.sums.total(from_camera / paths, at_light.reverse.0, h), 0.0)
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
}
