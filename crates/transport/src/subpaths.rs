//! A sample's two subpaths, for whoever looks into paths instead of rendering them.

use caustica_math::{SampleId, Vec2, Vec3};
use caustica_scene::light::Emission;

use crate::kernel::{Kernel, Scratch};
use crate::vertex::Vertex;
use crate::walk::Start;

/// The two subpaths of a sample.
#[derive(Clone, Copy, Debug)]
pub struct Subpaths<'a> {
    /// Surface vertices after the camera.
    pub eye: &'a [Vertex],
    /// Where the eye path is on the film, in pixels.
    pub film: Vec2,
    /// The direction in which the eye path left the scene, if it did.
    pub escape: Option<Vec3>,
    /// How the light path began; `None` in a scene without lamps.
    pub emission: Option<Emission>,
    /// Surface vertices after the lamp. Their throughput is emission over density: power per light path.
    pub light: &'a [Vertex],
}

impl Kernel<'_> {
    /// Grows the two subpaths that `bdpt` would join for a sample of a pixel, whatever the integrator.
    pub fn subpaths<'s>(&self, pixel: [u32; 2], sample: u32, scratch: &'s mut Scratch) -> Subpaths<'s> {
        let id = SampleId { seed: self.settings.seed, pixel, sample };
        let mut eye = self.eye_sample(id);
        let flight = Self::camera_flight(&eye.ray);
        self.grow(flight, &Start::Camera, &mut eye.numbers, &mut scratch.eye);
        let emission = self.light_path(id, &mut scratch.looked_at);
        Subpaths {
            eye: &scratch.eye.vertices,
            film: eye.film,
            escape: scratch.eye.escape.map(|e| e.direction),
            emission,
            light: &scratch.looked_at.vertices,
        }
    }
}
