//! Random walks: how subpaths grow.

use caustica_math::{Spectrum, Vec3};
use caustica_scene::bsdf::Walk;
use caustica_scene::bvh::Ray;
use caustica_scene::light::{Anchor, Emission};

use crate::edge::Edge;
use crate::fault::{Fault, is_planted};
use crate::kernel::Kernel;
use crate::numbers::{Bounce, Bounces};
use crate::vertex::Vertex;
use crate::weight::{RunningSums, Step};

/// A walk in flight: the segment that is about to be traced, and what is known of its start.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flight {
    pub ray: Ray,
    /// Throughput at the next vertex.
    pub throughput: Spectrum,
    /// Density of the ray's direction (from infinity: of its origin across the direction).
    pub pdf: f32,
    /// Where the edge starts; the ray may start further on. `None` at infinity.
    pub from: Option<Vec3>,
    /// |cos| at the start; one if it has no surface.
    pub cos: f32,
    /// Solid-angle density at the start of going back to the vertex before it.
    pub reverse: f32,
    /// Whether the start scattered by a Dirac lobe.
    pub delta: bool,
    /// Product of (n_camera/n_light)² so far, which roulette leaves out of account.
    pub radiance_scale: f32,
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

/// A subpath: its surface vertices, without the point on the lamp or the lens.
#[derive(Debug, Default)]
pub(crate) struct Subpath {
    pub vertices: Vec<Vertex>,
    /// Density of the point on the lamp or lens by the opposite walk.
    pub origin_reverse: f32,
    /// Whether a camera walk left the scene, and how.
    pub escape: Option<Escape>,
    /// Whether a numerical failure ended the walk.
    pub failed: bool,
}

impl Subpath {
    /// Makes room for another walk.
    pub(crate) fn clear(&mut self) {
        self.vertices.clear();
        self.escape = None;
        self.failed = false;
    }
}

/// A camera walk that left the scene: a vertex at infinity.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Escape {
    /// The unit direction in which it left.
    pub direction: Vec3,
    pub throughput: Spectrum,
    /// Density of the direction, per solid angle.
    pub forward: f32,
    /// Jacobian to the last surface vertex.
    pub back: f32,
    pub sums: RunningSums,
}

/// Where a walk starts.
pub(crate) enum Start<'a> {
    Camera,
    Light(&'a Emission),
}

impl Start<'_> {
    fn walk(&self) -> Walk {
        match self {
            Start::Camera => Walk::FromCamera,
            Start::Light(_) => Walk::FromLight,
        }
    }
}

/// Roulette lets a walk go on with this probability at most, so that every walk ends.
const MAX_SURVIVAL: f32 = 0.99;

impl Kernel<'_> {
    /// Grows a subpath until it leaves the scene, is absorbed, dies by roulette, or is `max_edges` long.
    pub(crate) fn grow(
        &self,
        mut flight: Flight,
        start: &Start<'_>,
        numbers: &mut impl Bounces,
        path: &mut Subpath,
    ) {
        path.clear();
        let walk = start.walk();
        // A light path still needs an edge to the camera.
        let max_edges = self.max_edges - usize::from(walk == Walk::FromLight);
        let first_throughput = flight.throughput.max_lane();
        while path.vertices.len() < max_edges {
            let first = walk == Walk::FromCamera && path.vertices.is_empty();
            let found = if first { self.first_seen(&flight.ray) } else { self.scene.closest(&flight.ray) };
            let Some(point) = found else {
                if walk == Walk::FromCamera && !(first && self.scene.camera.hides_lamps()) {
                    path.escape = Some(self.escape(&flight, path.vertices.last()));
                }
                return;
            };
            let label = || numbers.label(path.vertices.len());
            let mut vertex = Vertex::new(self.scene, point, -flight.ray.direction, self.wavelengths, label);
            let edge = match flight.from {
                Some(from) => Edge::finite(point.position.distance_squared(from)),
                None if is_planted(Fault::InfinityJacobian) => Edge::finite(4.0),
                None => Edge::INFINITE,
            };
            let cos = vertex.cos(vertex.prev);
            vertex.forward = flight.pdf * edge.jacobian(cos);
            vertex.back = edge.jacobian(flight.cos);
            vertex.throughput = flight.throughput;
            // Surfaces seen edge-on are never found; a density that is lost otherwise is a failure.
            let found = vertex.forward > 0.0 || cos == 0.0;
            if !(found
                && vertex.forward.is_finite()
                && vertex.back.is_finite()
                && vertex.throughput.is_valid())
            {
                path.failed = true;
                return;
            }
            if cos == 0.0 {
                return;
            }
            vertex.sums = match path.vertices.last() {
                None => self.first_sums(start, &vertex),
                Some(previous) => self.step(previous.sums, &flight, vertex.forward, vertex.back),
            };
            path.vertices.push(vertex);
            if path.vertices.len() == max_edges {
                return;
            }
            let roulette = path.vertices.len() >= self.roulette_start;
            let bounce = numbers.bounce(path.vertices.len() - 1, &vertex, roulette);
            if !self.scatter(walk, &mut flight, &bounce, path)
                || roulette && !survives(&mut flight, first_throughput, bounce.survival)
            {
                return;
            }
        }
    }

    /// Scatters at the last vertex: sets up the next flight, and tells the vertex before the last its density
    /// by the opposite walk. False if the walk ends.
    #[inline]
    fn scatter(&self, walk: Walk, flight: &mut Flight, bounce: &Bounce, path: &mut Subpath) -> bool {
        let Some((vertex, before)) = path.vertices.split_last_mut() else { return false };
        let Some((direction, scatter, delta)) = vertex.sample(walk, bounce.u) else { return false };
        vertex.delta = delta;
        flight.throughput *= scatter.value * (1.0 / scatter.forward.0);
        if !flight.throughput.is_valid() {
            path.failed = true;
            return false;
        }
        let scatter = if walk == Walk::FromCamera { scatter.perhaps_swapped() } else { scatter };
        flight.pdf = scatter.forward.0;
        flight.from = Some(vertex.point.position);
        flight.cos = vertex.cos(direction);
        flight.reverse = scatter.reverse.0;
        flight.delta = delta;
        flight.ray = Ray { origin: vertex.point.off_surface(direction), direction, t_max: f32::INFINITY };
        if walk == Walk::FromCamera {
            flight.radiance_scale *= vertex.radiance_scale(direction);
        }
        let reverse = scatter.reverse.0 * vertex.back;
        match before.last_mut() {
            Some(previous) => previous.reverse = reverse,
            None => path.origin_reverse = reverse,
        }
        true
    }

    /// The sums of the vertex at the end of the flight.
    #[inline]
    fn step(&self, sums: RunningSums, flight: &Flight, forward: f32, back: f32) -> RunningSums {
        let Flight { reverse, delta, .. } = *flight;
        sums.step(Step { forward, reverse, back, delta, joins: self.joins }, self.heuristic)
    }

    /// The sums of a walk's first surface vertex.
    #[inline]
    fn first_sums(&self, start: &Start<'_>, vertex: &Vertex) -> RunningSums {
        let inverse = 1.0 / vertex.forward;
        match start {
            // One vertex less is t = 1, which every light path tries.
            Start::Camera if self.classes.splat => {
                RunningSums { recent: self.light_paths * inverse, past: 0.0 }
            }
            Start::Camera => RunningSums::default(),
            Start::Light(emission) => {
                let lights = self.scene.lights(self.wavelengths);
                let emitted = 1.0 / emission.pdf.point.0;
                let mut sums = RunningSums::default();
                if self.classes.next_event {
                    // One vertex less is s = 1, which finds the lamp by another density.
                    let found = lights.towards_pdf(vertex.receiver(), &emission.point);
                    sums.recent = found.0 * emitted * inverse;
                }
                if self.classes.hit && !lights.lights.get(emission.point.light).is_delta() {
                    sums.past = vertex.back * emitted * inverse;
                }
                sums
            }
        }
    }

    /// The vertex at infinity at the end of a camera walk's flight.
    fn escape(&self, flight: &Flight, last: Option<&Vertex>) -> Escape {
        let (forward, back) = (flight.pdf, Edge::INFINITE.jacobian(flight.cos));
        let sums = match (last, flight.from) {
            (Some(previous), _) => self.step(previous.sums, flight, forward, back),
            // Seen directly: one vertex less is t = 1.
            (None, Some(_)) if self.classes.splat => {
                RunningSums { recent: self.light_paths / forward, past: 0.0 }
            }
            // A parallel projection sees one direction only; no light path can be joined with it there.
            (None, _) => RunningSums::default(),
        };
        let direction = flight.ray.direction;
        Escape { direction, throughput: flight.throughput, forward, back, sums }
    }
}

/// Russian roulette of both walks of `bdpt` spares paths of which more than 1/`LIVES` is left: of 1, 1.4, 2 and 3,
/// relative variance times time was least for 1.4, all in all. (Chains of aimed rays have one life.)
const LIVES: f32 = 1.4;

/// Russian roulette by what is left of the throughput.
#[inline]
fn survives(flight: &mut Flight, first_throughput: f32, u: f32) -> bool {
    let left = LIVES * flight.throughput.max_lane() / (flight.radiance_scale * first_throughput);
    let survival = if left > MAX_SURVIVAL { MAX_SURVIVAL } else { left };
    if !is_planted(Fault::Roulette) {
        flight.throughput *= 1.0 / survival;
    }
    u < survival
}
