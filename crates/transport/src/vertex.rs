//! Path vertices on surfaces.

use caustica_math::{Frame, SolidAnglePdf, Spectrum, Vec3, Wavelengths};
use caustica_scene::Scene;
use caustica_scene::bsdf::{Bsdf, Bump, Evaluated, Walk};
use caustica_scene::description::BumpRule;
use caustica_scene::light::Receiver;
use caustica_scene::surface::SurfacePoint;

use crate::fault::{Fault, is_planted};
use crate::weight::RunningSums;

/// A vertex of a subpath, on a surface.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// Where, with its normals. (The shading frame of a surface that is seen turned around is turned; its geometric
    /// normal never is, because lamps know their side by it.)
    pub point: SurfacePoint,
    /// How it scatters.
    pub bsdf: Bsdf,
    /// Unit direction to the previous vertex of the walk.
    pub prev: Vec3,
    /// The same in the shading frame. Where the BSDF has a normal of its own, that normal is here instead.
    local: Vec3,
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
    /// Whether the surface counts as turned around.
    turned: bool,
    /// What is done about the normal, if it is the BSDF's own.
    bump: Option<BumpRule>,
    /// What the weights need to know of the subpath before here.
    pub sums: RunningSums,
}

// Connections run over all of them.
const _: () = assert!(size_of::<Vertex>() <= 224);

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

impl Scatter {
    /// With its densities mixed up, if that fault is planted.
    #[inline]
    pub(crate) fn perhaps_swapped(self) -> Self {
        if is_planted(Fault::SwappedDensities) {
            Self { forward: self.reverse, reverse: self.forward, ..self }
        } else {
            self
        }
    }
}

impl Vertex {
    /// The vertex where a ray of direction `-prev` arrives. If it arrives on a side of the shading normal that is
    /// not that of the geometric one, nothing is scattered, whichever walk asks; but a lamp still shines. `label` is
    /// asked for a uniform number in [0, 1) where the material is a mixture: the vertex is one of its parts.
    ///
    /// All strategies make an inner vertex of a path by exactly one walk, and the choice depends on the place alone. So
    /// its probability is a factor of all their densities, and of the integrand: it cancels everywhere.
    #[inline]
    pub fn new(
        scene: &Scene,
        point: SurfacePoint,
        prev: Vec3,
        wavelengths: Wavelengths,
        label: impl FnOnce() -> f64,
    ) -> Self {
        let mut local = point.frame.to_local(prev);
        if scene.is_wrapped(&point) {
            let label = if scene.is_mixed(&point) { label() } else { 0.0 };
            return Self::wrapped(scene, point, prev, (label, wavelengths));
        }
        if local.z * point.normal.dot(prev) <= 0.0 {
            // No BSDF scatters along the horizon.
            local.z = 0.0;
        }
        Self::of(scene.bsdf(&point, wavelengths), point, prev, local)
    }

    /// The same where the material is more than a BSDF.
    #[inline(never)]
    fn wrapped(
        scene: &Scene,
        mut point: SurfacePoint,
        prev: Vec3,
        (label, wavelengths): (f64, Wavelengths),
    ) -> Self {
        let placed = scene.placed(&point, prev, label, wavelengths);
        if placed.bsdf == Bsdf::Null {
            // Where there is nothing, there are no shading normals.
            point.frame = Frame::from_normal(point.normal);
            return Self::of(placed.bsdf, point, prev, point.frame.to_local(prev));
        }
        if placed.turned {
            point.frame.z = -point.frame.z;
        }
        let local = point.frame.to_local(prev);
        let mut vertex = Self { turned: placed.turned, ..Self::of(placed.bsdf, point, prev, local) };
        if local.z * vertex.side(prev) <= 0.0 {
            vertex.local.z = 0.0;
        } else if let Some(Bump { normal, rule }) = placed.bump {
            (vertex.local, vertex.bump) = (normal, Some(rule));
        }
        vertex
    }

    #[inline]
    fn of(bsdf: Bsdf, point: SurfacePoint, prev: Vec3, local: Vec3) -> Self {
        Self {
            point,
            bsdf,
            prev,
            local,
            throughput: Spectrum::ZERO,
            forward: 0.0,
            reverse: 0.0,
            back: 0.0,
            delta: false,
            turned: false,
            bump: None,
            sums: RunningSums::default(),
        }
    }

    /// The cosine of a direction to the geometric normal, turned with the surface.
    #[inline]
    pub fn side(&self, direction: Vec3) -> f32 {
        let cos = self.point.normal.dot(direction);
        if self.turned { -cos } else { cos }
    }

    /// The normal that the BSDF has, if it is not the surface's own.
    #[inline]
    pub fn bump(&self) -> Option<Bump> {
        self.bump.map(|rule| Bump { normal: self.local, rule })
    }

    /// The shading normal in the world, on the side of the geometric one's front: that of the BSDF, if it has its own.
    pub fn shading_normal(&self) -> Vec3 {
        let normal = self.bump().map_or(self.point.frame.z, |b| self.point.frame.to_world(b.normal));
        if self.turned { -normal } else { normal }
    }

    /// The direction to the previous vertex, in the shading frame. On the horizon where nothing is scattered.
    #[inline]
    fn local_prev(&self) -> Vec3 {
        if self.bump.is_some() { self.point.frame.to_local(self.prev) } else { self.local }
    }

    /// Whether sampling asks for the number of the lobe.
    #[inline]
    pub fn has_lobes(&self) -> bool {
        self.bsdf.has_lobes() || self.bump.is_some()
    }

    /// The BSDF, for directions in the shading frame.
    #[inline]
    fn eval(&self, to_light: Vec3, to_camera: Vec3) -> Evaluated {
        match self.bump() {
            None => self.bsdf.eval(to_light, to_camera),
            Some(bump) => bump.eval(&self.bsdf, to_light, to_camera),
        }
    }

    /// |cos| of a direction to the geometric normal.
    #[inline]
    pub fn cos(&self, direction: Vec3) -> f32 {
        self.point.normal.dot(direction).abs()
    }

    /// Whether the vertex may scatter in a direction of any length: what reflects alone does not scatter to the side of the
    /// surface that the walk did not come from.
    #[inline]
    pub fn faces(&self, next: Vec3) -> bool {
        let normal = self.point.normal;
        normal.dot(next) * normal.dot(self.prev) > 0.0 || self.bsdf.transmits()
    }

    /// Scattering between the previous vertex and the unit direction `next`, the Dirac part left out.
    /// `None` if it is zero.
    #[inline]
    pub fn scatter(&self, walk: Walk, next: Vec3) -> Option<Scatter> {
        let cos = self.side(next);
        let (local, local_prev) = (self.point.frame.to_local(next), self.local_prev());
        if cos * local.z <= 0.0 || local_prev.z == 0.0 {
            return None;
        }
        let scatter = match walk {
            Walk::FromCamera => {
                let e = self.eval(local, local_prev);
                Scatter { value: e.value, forward: e.to_light_pdf, reverse: e.to_camera_pdf }
                    .perhaps_swapped()
            }
            Walk::FromLight => {
                let e = self.eval(local_prev, local);
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
        let local_prev = self.local_prev();
        if local_prev.z == 0.0 {
            return None;
        }
        let s = match self.bump() {
            None => self.bsdf.sample(walk, local_prev, u),
            Some(bump) => bump.sample(&self.bsdf, walk, local_prev, u),
        }?;
        let next = self.point.frame.to_world(s.direction);
        let cos = self.side(next);
        if cos * s.direction.z <= 0.0 {
            return None;
        }
        let value = match walk {
            Walk::FromCamera => s.value,
            Walk::FromLight if is_planted(Fault::Adjoint) => s.value,
            Walk::FromLight => s.value * (cos.abs() / self.cos(self.prev)),
        };
        Some((next, Scatter { value, forward: s.pdf, reverse: s.reverse_pdf }, s.delta))
    }

    /// The factor (n_camera/n_light)² by which refraction from the direction `to_light` to the previous vertex
    /// scales radiance; one for reflection.
    #[inline]
    pub fn radiance_scale(&self, to_light: Vec3) -> f32 {
        self.bsdf.radiance_scale(self.side(to_light), self.local_prev().z)
    }

    /// How the vertex looks for lamps. (Of what scatters on one side alone, both ends of a path are on that side: whichever
    /// of them `prev` leads to, the normal is the same.)
    #[inline]
    pub fn receiver(&self) -> Receiver {
        // A bump scatters towards what is below the surface's own horizon, too.
        let normal = match self.bsdf.transmits() || self.bump.is_some() {
            true => Vec3::ZERO,
            false if self.local.z < 0.0 => -self.point.frame.z,
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
