//! s = 0, aimed: more rays at mirrors and glass, from where no other strategy makes a path.
//!
//! Light that comes through glass onto a wall which is itself seen through glass or in a mirror is found by s = 0
//! alone: each edge of such a path has a Dirac lobe at an end, so that nothing can be joined. The walk finds it by
//! chance. So from each eye vertex without an edge that could be joined, further rays go into the cones of mirrors and
//! glass, and follow Dirac lobes as long as there are any.
//!
//! Such a path is made by the walk with the density p of its direction at that vertex, and by each of n aimed rays with
//! q; all else is alike. By the balance heuristic of these (Veach, "Robust Monte Carlo Methods for Light Transport
//! Simulation", 1997, 9.2) each of the n + 1 estimates is f/(p + n·q): that of the walk, f/p, times p/(p + n·q).

use caustica_math::Spectrum;
use caustica_scene::bsdf::Walk;
use caustica_scene::bvh::Ray;
use caustica_scene::casters::Aim;
use caustica_scene::light::LightPoint;

use super::Sample;
use crate::kernel::Kernel;
use crate::numbers::{Bounces, EyeNumbers};
use crate::sink::{Contribution, PathView, Sink};
use crate::strategy::Strategy;
use crate::vertex::Vertex;
use crate::weight::RunningSums;

/// A ray that is aimed, and what follows it.
struct Chain<'a> {
    /// The vertices that it starts from, the last of them where it is aimed; for sinks that probe also those that it
    /// finds.
    eye: &'a mut Vec<Vertex>,
    ray: Ray,
    /// Throughput without the density, over that of all ways to make the path.
    throughput: Spectrum,
    /// How often the walk makes the path, of all times that it is made.
    share: f32,
    /// The product of (n_camera/n_light)², and what is left beside it, which roulette goes by.
    radiance_scale: f32,
    left: Spectrum,
}

impl Kernel<'_> {
    /// All contributions of aimed rays.
    pub(super) fn aimed_hits<S: Sink>(
        &self,
        sample: &Sample<'_>,
        (numbers, eye): (&mut EyeNumbers, &mut Vec<Vertex>),
        sink: &mut S,
    ) -> Spectrum {
        let mut sum = Spectrum::ZERO;
        if self.aimed_rays == 0 {
            return sum;
        }
        // At least one more vertex lies between, and one is on the lamp.
        let count = sample.eye.vertices.len().min(self.max_edges.saturating_sub(2));
        for (i, vertex) in sample.eye.vertices[..count].iter().enumerate() {
            let Some(aim) = self.aim(vertex) else { continue };
            let u = numbers.aimed(i);
            for ray in 0..self.aimed_rays {
                let Some(direction) = aim.sample(spread(u, ray, self.aimed_rays)) else { continue };
                let Some(scatter) = vertex.scatter(Walk::FromCamera, direction) else { continue };
                let aimed = aim.pdf(direction).0;
                if aimed <= 0.0 {
                    // At the very border of a cone, by rounding: counted as beyond it.
                    continue;
                }
                let density = scatter.forward.0 + self.aimed_rays as f32 * aimed;
                eye.clear();
                if S::PROBES {
                    eye.extend_from_slice(&sample.eye.vertices[..=i]);
                    eye[i].delta = false;
                }
                let chain = Chain {
                    eye: &mut *eye,
                    ray: Ray { origin: vertex.point.off_surface(direction), direction, t_max: f32::INFINITY },
                    throughput: vertex.throughput * scatter.value * (1.0 / density),
                    share: scatter.forward.0 / density,
                    radiance_scale: 1.0,
                    left: Spectrum::ONE,
                };
                sum += self.follow(sample, (i, ray), (chain, numbers), sink);
            }
        }
        sum
    }

    /// Follows an aimed ray through Dirac lobes, and adds up the lamps that it meets behind the first of them.
    fn follow<S: Sink>(
        &self,
        sample: &Sample<'_>,
        (start, ray): (usize, u32),
        (mut chain, numbers): (Chain<'_>, &mut EyeNumbers),
        sink: &mut S,
    ) -> Spectrum {
        let lights = self.scene.lights(self.wavelengths);
        let mut sum = Spectrum::ZERO;
        // One edge leads to the first vertex of the eye path.
        for edges in start + 2..=self.max_edges {
            let passed = edges - start - 2;
            let Some(point) = self.scene.closest(&chain.ray) else {
                for index in lights.lights.environments().iter().filter(|_| passed > 0) {
                    let lamp = LightPoint::infinite(*index, chain.ray.direction);
                    sum += self.found(sample, (&chain, edges), lamp, sink);
                }
                break;
            };
            let number = aimed_vertex(start, ray, passed);
            let label = || numbers.label(number);
            let mut vertex = Vertex::new(self.scene, point, -chain.ray.direction, self.wavelengths, label);
            vertex.delta = true;
            if S::PROBES {
                chain.eye.push(vertex);
            }
            if passed > 0
                && let Some(lamp) = self.scene.lamp_at(&point)
            {
                sum += self.found(sample, (&chain, edges), lamp, sink);
            }
            if edges == self.max_edges || !vertex.bsdf.has_dirac() {
                break;
            }
            let roulette = edges >= self.roulette_start;
            let bounce = numbers.bounce(number, &vertex, roulette);
            let Some((direction, s, delta)) = vertex.sample(Walk::FromCamera, bounce.u) else { break };
            if !delta {
                break;
            }
            chain.radiance_scale *= vertex.radiance_scale(direction);
            chain.left *= s.value * (1.0 / s.forward.0);
            chain.throughput *= s.value * (1.0 / s.forward.0);
            if !chain.throughput.is_valid() {
                sink.invalid();
                break;
            }
            if roulette {
                let survival = (chain.left.max_lane() / chain.radiance_scale).min(0.99);
                if bounce.survival >= survival {
                    break;
                }
                chain.left *= 1.0 / survival;
                chain.throughput *= 1.0 / survival;
            }
            chain.ray = Ray { origin: vertex.point.off_surface(direction), direction, t_max: f32::INFINITY };
        }
        sum
    }

    /// The lamp at the end of a chain whose path has that many edges.
    fn found<S: Sink>(
        &self,
        sample: &Sample<'_>,
        (chain, edges): (&Chain<'_>, usize),
        lamp: LightPoint,
        sink: &mut S,
    ) -> Spectrum {
        let radiance = self.scene.lights(self.wavelengths).radiance(&lamp, -chain.ray.direction);
        let value = chain.throughput * radiance;
        if value.is_black() {
            return value;
        }
        if !value.is_valid() {
            sink.invalid();
            return Spectrum::ZERO;
        }
        if S::PROBES {
            let mut weights = sample.weights.borrow_mut();
            weights.clear();
            if S::WEIGHS_ALL {
                weights.push(chain.share);
                weights.resize(edges + 1, 0.0);
            }
            sink.contribution(&Contribution {
                strategy: Strategy { s: 0, t: edges as u32 + 1 },
                unweighted: value,
                weight: 1.0,
                film: sample.film,
                filter_weight: sample.filter_weight,
                light_path: 0,
                path: PathView { lamp, light: &[], eye: chain.eye, camera: sample.camera },
                weights: &weights,
            });
        }
        value
    }

    /// Where rays are aimed from a vertex of an eye path: nowhere if a part of that path can be joined with a lamp.
    #[inline]
    fn aim(&self, vertex: &Vertex) -> Option<Aim<'_>> {
        if self.aimed_rays == 0 || vertex.sums != RunningSums::default() || !vertex.is_connectible() {
            return None;
        }
        let normal = vertex.point.normal;
        let above = (!vertex.bsdf.transmits()).then(|| normal * 1.0_f32.copysign(normal.dot(vertex.prev)));
        self.scene.casters().seen_from(vertex.point.position, above)
    }

    /// The share that the walk has in a path whose vertices lead to a lamp from the last of `eye`: one, unless aimed rays
    /// may find it too.
    pub(super) fn walk_share(&self, eye: &[Vertex]) -> f32 {
        if self.aimed_rays == 0 {
            return 1.0;
        }
        let share = || {
            let start = eye.iter().rposition(|v| !v.delta)?;
            let direction = -eye.get(start + 1)?.prev;
            let aim = self.aim(&eye[start])?;
            let walk = eye[start].scatter(Walk::FromCamera, direction)?.forward.0;
            Some(walk / (walk + self.aimed_rays as f32 * aim.pdf(direction).0))
        };
        share().unwrap_or(1.0)
    }
}

/// The point of one of several rays: a lattice (Fibonacci's, by the golden ratio) that is moved as a whole.
fn spread([u, v]: [f32; 2], ray: u32, rays: u32) -> [f32; 2] {
    const GOLDEN: f32 = 0.618_034;
    let fraction = |x: f32| (x - x.floor()).min(caustica_math::ONE_BELOW);
    [fraction(u + ray as f32 / rays as f32), fraction(v + ray as f32 * GOLDEN)]
}

/// Under which number a vertex of an aimed ray's chain draws, with `passed` vertices before it.
fn aimed_vertex(start: usize, ray: u32, passed: usize) -> usize {
    EyeNumbers::AIMED_VERTICES + ((start << 6 | ray as usize) << 11 | passed)
}
