//! Weights by adding up all strategies.

use super::{Joined, Junction, Sample};
use crate::kernel::Kernel;
use crate::strategy::Strategy;
use crate::weight::{Ends, Heuristic, VertexDensities, each_density, exhaustive};

impl Kernel<'_> {
    /// The weight by adding up all strategies.
    pub(super) fn exhaustive_weight(&self, sample: &Sample<'_>, joined: &Joined) -> f32 {
        let ends = self.gather(sample, joined);
        let contains = |i| self.makes(joined, sample, i);
        exhaustive(&sample.densities.borrow(), ends, joined.strategy.s as usize, self.heuristic, contains)
    }

    /// The weights by the balance heuristic of all strategies of the set that can make the path, by s.
    pub(super) fn all_weights(&self, sample: &Sample<'_>, joined: &Joined, weights: &mut Vec<f32>) {
        let ends = self.gather(sample, joined);
        let k = (joined.strategy.s + joined.strategy.t) as usize;
        let mut densities = vec![0.0; k];
        let own = (joined.strategy.s as usize, Heuristic::Balance);
        each_density(&sample.densities.borrow(), ends, own, |i, density| {
            if self.makes(joined, sample, i) {
                densities[i] = density;
            }
        });
        let sum: f64 = densities.iter().sum();
        weights.clear();
        weights.extend(densities.iter().map(|d| (d / sum) as f32));
    }

    /// Whether the set holds the strategy of the path's length with `s` light vertices, and it can make the path.
    fn makes(&self, joined: &Joined, sample: &Sample<'_>, s: usize) -> bool {
        let k = joined.strategy.s + joined.strategy.t - 1;
        let escaped = joined.strategy.s == 0 && joined.strategy.t as usize - 1 > sample.eye.vertices.len();
        // A parallel projection and an environment seen directly: (1, 1) cannot join them.
        let unjoinable = joined.camera.infinite && escaped && k == 1;
        self.settings.strategies.contains(Strategy { s: s as u32, t: k + 1 - s as u32 })
            && !(unjoinable && s == 1)
    }

    /// Gathers the densities of all vertices of the path in `sample.densities`.
    fn gather(&self, sample: &Sample<'_>, joined: &Joined) -> Ends {
        let lights = self.scene.lights(self.wavelengths);
        let (s, t) = (joined.strategy.s as usize, joined.strategy.t as usize);
        let Junction { light: (light_end, before_light), eye: (eye_end, before_eye) } = joined.junction;
        let light = sample.light_vertices(joined);
        let escaped = s == 0 && t - 1 > sample.eye.vertices.len();
        let eye = &sample.eye.vertices[..t - 1 - usize::from(escaped)];
        let delta_lamp = lights.lights.get(joined.lamp.light).is_delta();
        let mut all = sample.densities.borrow_mut();
        all.clear();
        if s >= 1 {
            let from_camera = match s {
                1 => light_end,
                2 => before_light * light[0].back,
                _ => sample.lights[joined.light].path.origin_reverse,
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
            (Some(v), _) => Some(v.receiver()),
            (None, n) => {
                let skip = usize::from(s == 0 && !escaped);
                n.checked_sub(1 + skip).map(|i| eye[i].receiver())
            }
        };
        let found = next_to_lamp.map_or(0.0, |from| lights.towards_pdf(from, &joined.lamp).0);
        Ends { next_event: found, light_paths: self.light_paths, joins: self.joins }
    }
}
