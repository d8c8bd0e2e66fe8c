//! s ≥ 2, t ≥ 2: inner connections.

use caustica_scene::bsdf::Walk;
use caustica_scene::bvh::Ray;

use super::candidate::Candidates;
use super::{Joined, Junction, Sample};
use crate::edge::Edge;
use crate::kernel::Kernel;
use crate::sink::Sink;
use crate::strategy::Strategy;
use crate::vertex::{Scatter, Vertex};
use crate::weight::weight;

impl Kernel<'_> {
    /// s ≥ 2, t ≥ 2: every eye vertex with every vertex of the light paths.
    pub(super) fn connections<S: Sink>(&self, sample: &Sample<'_>, candidates: &mut Candidates) {
        for light in 0..sample.lights.len() {
            self.connections_with::<S>(sample, light, candidates);
        }
    }

    fn connections_with<S: Sink>(&self, sample: &Sample<'_>, light: usize, candidates: &mut Candidates) {
        for (i, z) in sample.eye.vertices.iter().enumerate() {
            if !z.is_connectible() {
                continue;
            }
            for (j, y) in sample.lights[light].path.vertices.iter().enumerate() {
                // Edges: i + 1 of the eye path, j + 1 of the light path, and the one that joins.
                if i + j + 3 > self.max_edges {
                    break;
                }
                if y.is_connectible() {
                    self.connection::<S>(sample, (light, j + 2, i + 2), (y, z), candidates);
                }
            }
        }
    }

    #[inline]
    fn connection<S: Sink>(
        &self,
        sample: &Sample<'_>,
        (light, s, t): (usize, usize, usize),
        (y, z): (&Vertex, &Vertex),
        candidates: &mut Candidates,
    ) -> Option<()> {
        let strategy = Strategy { s: s as u32, t: t as u32 };
        if self.exhaustive && !self.settings.strategies.contains(strategy) {
            return None;
        }
        let d = z.point.position - y.point.position;
        // What is behind a surface is found out before anything is evaluated: it is most of all.
        if !y.faces(d) || !z.faces(-d) {
            return None;
        }
        let length_squared = d.length_squared();
        if length_squared <= 0.0 {
            return None;
        }
        let direction = d * (1.0 / length_squared.sqrt());
        let at_eye: Scatter = z.scatter(Walk::FromCamera, -direction)?;
        let at_light: Scatter = y.scatter(Walk::FromLight, direction)?;
        let edge = Edge::finite(length_squared);
        let value = y.throughput * at_light.value * at_eye.value * z.throughput * (edge.falloff / self.joins);
        if value.is_black() {
            return None;
        }
        let junction = Junction {
            light: (at_eye.forward.0 * edge.jacobian(y.cos(direction)), at_light.reverse.0),
            eye: (at_light.forward.0 * edge.jacobian(z.cos(direction)), at_eye.reverse.0),
        };
        let emission = sample.lights[light].emission.as_ref()?;
        let joined = sample.joined(strategy, (emission.point, emission.pdf.point.0), junction, value);
        let joined = Joined { light, ..joined };
        let running = || {
            let h = self.heuristic;
            weight(
                y.sums.total(junction.light.0 / self.joins, junction.light.1, h),
                z.sums.total(junction.eye.0 / self.joins, junction.eye.1, h),
            )
        };
        let ray = Ray::between(y.point.off_surface(direction), z.point.off_surface(-direction));
        self.offer::<S>(sample, (joined, ray), running, candidates);
        Some(())
    }
}
