//! Path vertices on surfaces.

use caustica_math::{SolidAnglePdf, Spectrum, Vec3, Wavelengths};
use caustica_scene::Scene;
use caustica_scene::bsdf::{Bsdf, Walk};
use caustica_scene::light::Receiver;
use caustica_scene::surface::SurfacePoint;

use crate::fault::{Fault, is_planted};
use crate::weight::RunningSums;

/// A vertex of a subpath, on a surface.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// Where, with its normals.
    pub point: SurfacePoint,
    /// How it scatters.
    pub bsdf: Bsdf,
    /// Unit direction to the previous vertex of the walk.
    pub prev: Vec3,
    /// The same in the shading frame.
    local_prev: Vec3,
    /// The product of f·cos/pdf (for a light path: times emission over its density) up to here, without
    /// this vertex's own scattering.
    pub throughput: Spectrum,
    /// Density of this vertex by its own walk, in its own (area) measure. For a Dirac scattering before it,
    /// with that distribution's coefficient.
    pub forward: f32,
    /// Density of this vertex by the opposite walk, coming from the next vertex. Set when that is known.
    pub reverse: f32,
    /// Jacobian from this vertex to the previous one's measure.
    pub back: f32,
    /// Whether the walk went on from here by a Dirac lobe.
    pub delta: bool,
    /// What the weights need to know of the subpath before here.
    pub sums: RunningSums,
}

/// A vertex's scattering into a given direction, seen along a walk.
#[derive(Clone, Copy, Debug)]
pub struct Scatter {
    /// The factor on the throughput, without the density: f·|cos| on the light side in the shading frame,
    /// times, along a light walk, |cos| of the geometric normal on the camera side over that on the light
    /// side. (The last ratio times the first is Veach's adjoint correction for shading normals; here it
    /// comes from writing the path integral down with f·|cos_s|/|cos_g|.)
    pub value: Spectrum,
    /// Density of the given direction, by this walk.
    pub forward: SolidAnglePdf,
    /// Density of the previous direction, by the opposite walk.
    pub reverse: SolidAnglePdf,
}

impl Vertex {
    /// The vertex where a ray of direction `-prev` arrives. If it arrives on a side of the shading normal that is
    /// not that of the geometric one, nothing is scattered, whichever walk asks; but a lamp still shines.
    #[inline]
    pub fn new(scene: &Scene, point: SurfacePoint, prev: Vec3, wavelengths: Wavelengths) -> Self {
        let mut local_prev = point.frame.to_local(prev);
        if local_prev.z * point.normal.dot(prev) <= 0.0 {
            // No BSDF scatters along the horizon.
            local_prev.z = 0.0;
        }
        Self {
            bsdf: scene.bsdf(&point, wavelengths),
            point,
            prev,
            local_prev,
            throughput: Spectrum::ZERO,
            forward: 0.0,
            reverse: 0.0,
            back: 0.0,
            delta: false,
            sums: RunningSums::default(),
        }
    }

    /// |cos| of a direction to the geometric normal.
    #[inline]
    pub fn cos(&self, direction: Vec3) -> f32 {
        self.point.normal.dot(direction).abs()
    }

    /// Scattering between the previous vertex and the unit direction `next`, the Dirac part left out.
    /// `None` if it is zero.
    #[inline]
    pub fn scatter(&self, walk: Walk, next: Vec3) -> Option<Scatter> {
        let cos = self.point.normal.dot(next);
        let local = self.point.frame.to_local(next);
        if cos * local.z <= 0.0 || self.local_prev.z == 0.0 {
            return None;
        }
        let scatter = match walk {
            Walk::FromCamera => {
                let e = self.bsdf.eval(local, self.local_prev);
                if is_planted(Fault::SwappedDensities) {
                    return (!e.value.is_black()).then_some(Scatter {
                        value: e.value,
                        forward: e.to_camera_pdf,
                        reverse: e.to_light_pdf,
                    });
                }
                Scatter { value: e.value, forward: e.to_light_pdf, reverse: e.to_camera_pdf }
            }
            Walk::FromLight => {
                let e = self.bsdf.eval(self.local_prev, local);
                let ratio = if is_planted(Fault::Adjoint) { 1.0 } else { cos.abs() / self.cos(self.prev) };
                let value = e.value * ratio;
                Scatter { value, forward: e.to_camera_pdf, reverse: e.to_light_pdf }
            }
        };
        (!scatter.value.is_black()).then_some(scatter)
    }

    /// Samples the next direction; also returns whether it came from a Dirac lobe.
    #[inline]
    pub fn sample(&self, walk: Walk, u: [f32; 3]) -> Option<(Vec3, Scatter, bool)> {
        if self.local_prev.z == 0.0 {
            return None;
        }
        let s = self.bsdf.sample(walk, self.local_prev, u)?;
        let next = self.point.frame.to_world(s.direction);
        let cos = self.point.normal.dot(next);
        if cos * s.direction.z <= 0.0 {
            return None;
        }
        let value = match walk {
            Walk::FromCamera => s.value,
            Walk::FromLight => s.value * (cos.abs() / self.cos(self.prev)),
        };
        Some((next, Scatter { value, forward: s.pdf, reverse: s.reverse_pdf }, s.delta))
    }

    /// The factor (n_camera/n_light)² by which refraction from the direction `to_light` to the previous vertex
    /// scales radiance; one for reflection.
    #[inline]
    pub fn radiance_scale(&self, to_light: Vec3) -> f32 {
        self.bsdf.radiance_scale(self.point.normal.dot(to_light), self.local_prev.z)
    }

    /// How the vertex looks for lamps. (Of what scatters on one side alone, both ends of a path are on that side: whichever
    /// of them `prev` leads to, the normal is the same.)
    #[inline]
    pub fn receiver(&self) -> Receiver {
        let normal = match self.bsdf.transmits() {
            true => Vec3::ZERO,
            false if self.local_prev.z < 0.0 => -self.point.frame.z,
            false => self.point.frame.z,
        };
        Receiver { at: self.point.position, normal }
    }

    /// Whether the vertex can be joined with another.
    #[inline]
    pub fn is_connectible(&self) -> bool {
        !self.bsdf.is_delta()
    }
}
