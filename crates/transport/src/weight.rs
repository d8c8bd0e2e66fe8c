//! Multiple importance sampling weights.
//!
//! Number the vertices of a path x₀ (lamp) to x_k (camera). The light walk makes xⱼ with density p→(xⱼ), the
//! camera walk with p←(xⱼ), each in xⱼ's own measure. Strategy s has the density
//! p_s = ∏_{j<s} p→(xⱼ) · ∏_{j≥s} p←(xⱼ), and the balance heuristic gives it the weight p_s/Σ pᵢ (Veach,
//! "Robust Monte Carlo Methods for Light Transport Simulation", 1997, 10.2). Two strategies have densities of
//! their own at an end: next-event estimation finds x₀ with another density than emission, and strategy
//! t = 1 is tried by every light path of a pass, N times as often as a pixel's eye path. An eye path is joined with n
//! light paths, so that the strategies with s ≥ 2 and t ≥ 2 are tried n times. Everywhere pₛ stands for a density times
//! how often it is tried.
//!
//! Roulette is left out of all densities: its probability belongs to a walk and not to the path, and weights
//! need only add up to one for each path. Every strategy's throughput is divided by it.
//!
//! Of the densities, the sum splits at the connection into what concerns light vertices and what concerns
//! camera vertices. Each side is known but for two numbers by the time its last vertex is made:
//! [`RunningSums`] carries it in two terms (Georgiev, "Implementing Vertex Connection and Merging", 2012;
//! van Antwerpen, "A Survey of Importance Sampling Applications in Unbiased Physically Based Rendering",
//! 2011). [`exhaustive`] adds up all strategies in O(n): the general case and the oracle of the tests.

/// The function of a density by which strategies are weighed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Heuristic {
    /// The density itself.
    #[default]
    Balance,
    /// Its square.
    Power,
}

impl Heuristic {
    /// The function. It is multiplicative, so that it can be applied factor by factor.
    #[inline]
    pub fn of(self, density: f32) -> f32 {
        match self {
            Self::Balance => density,
            Self::Power => density * density,
        }
    }

    /// The density of which the function is the sum of that of two.
    #[inline]
    fn sum(self, a: f32, b: f32) -> f32 {
        match self {
            Self::Balance => a + b,
            Self::Power => {
                // The larger is taken out, as squares leave the range of f32 where distances are small or large.
                let (most, least) = if a > b { (a, b) } else { (b, a) };
                let ratio = if most > 0.0 { least / most } else { 0.0 };
                most * (1.0 + ratio * ratio).sqrt()
            }
        }
    }

    /// The weight of a strategy with the density `own`, which is not zero, where there is one other.
    #[inline]
    pub fn share(self, own: f32, other: f32) -> f32 {
        match self {
            Self::Balance => own / (own + other),
            // By their ratio: the squares of densities on tiny lamps do not fit into an `f32`.
            Self::Power => 1.0 / (1.0 + self.of(other / own)),
        }
    }
}

/// What a subpath that ends at vertex i contributes to the sum of all strategies' densities, relative to the
/// density of the strategy that joins vertex i: `p←(xᵢ)·(recent + q·past)`, where p←(xᵢ) is the other walk's
/// density of xᵢ and q its solid-angle density at xᵢ of going on to vertex i−1. (So it is with the balance heuristic; for
/// another one, each term is the density whose function is the sum of the strategies' functions.)
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunningSums {
    /// 1/p→(xᵢ) if the edge before xᵢ can be the one that joins: the strategy that is one vertex shorter.
    pub recent: f32,
    /// All strategies that are shorter still, over p→(xᵢ) and without q.
    pub past: f32,
}

/// One step of a walk, as the sums need it.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Density of the new vertex, in its own measure.
    pub forward: f32,
    /// Solid-angle density at the old vertex of going back to the one before it.
    pub reverse: f32,
    /// Jacobian from the new vertex back to the old one's measure.
    pub back: f32,
    /// Whether the old vertex scattered by a Dirac lobe: then neither edge at it can join.
    pub delta: bool,
    /// How often strategies of class `inner` are tried; zero if they are not in the set.
    pub joins: f32,
}

impl RunningSums {
    /// The sums at the next vertex.
    #[inline]
    pub fn step(self, step: Step, h: Heuristic) -> Self {
        let recent = if step.delta { 0.0 } else { self.recent };
        let inverse = 1.0 / step.forward;
        Self {
            recent: if step.delta { 0.0 } else { step.joins * inverse },
            past: step.back * inverse * h.sum(recent, step.reverse * self.past),
        }
    }

    /// The side's part of the sum, with the other walk's density of this vertex (in its own measure) and of
    /// going on from it (per solid angle).
    #[inline]
    pub fn total(self, density: f32, onward: f32, h: Heuristic) -> f32 {
        h.of(density * h.sum(self.recent, onward * self.past))
    }
}

/// The weight of a strategy, given the two sides' sums relative to it.
#[inline]
pub fn weight(light_side: f32, eye_side: f32) -> f32 {
    1.0 / (1.0 + light_side + eye_side)
}

/// The densities of one vertex of a full path.
#[derive(Clone, Copy, Debug, Default)]
pub struct VertexDensities {
    /// p→: by the light walk, in its own measure.
    pub from_light: f32,
    /// p←: by the camera walk, in its own measure.
    pub from_camera: f32,
    /// Whether it scatters by a Dirac lobe, or cannot be hit (a lamp without extent).
    pub delta: bool,
}

/// The densities of the special ends.
#[derive(Clone, Copy, Debug)]
pub struct Ends {
    /// Density with which next-event estimation from x₁ finds x₀.
    pub next_event: f32,
    /// How many light paths try t = 1 for each eye path of a pixel.
    pub light_paths: f32,
    /// How many light paths an eye path is joined with, for s ≥ 2 and t ≥ 2.
    pub joins: f32,
}

/// The weight of strategy `s` for a path of `vertices` (x₀ to x_{k−1}: all but the one on the camera), by
/// adding up the densities of all strategies i for which `contains(i)`. O(n).
pub fn exhaustive(
    vertices: &[VertexDensities],
    ends: Ends,
    s: usize,
    h: Heuristic,
    contains: impl Fn(usize) -> bool,
) -> f32 {
    let (mut own, mut sum) = (0.0, 0.0);
    each_density(vertices, ends, (s, h), |i, density| {
        if i == s {
            own = density;
        }
        if i == s || contains(i) {
            sum += density;
        }
    });
    (own / sum) as f32
}

/// Tells the density of every strategy that can make a path of `vertices` (by the heuristic's function, and in one
/// unknown unit), that of strategy `s`, which can, first.
pub fn each_density(
    vertices: &[VertexDensities],
    ends: Ends,
    (s, h): (usize, Heuristic),
    mut tell: impl FnMut(usize, f64),
) {
    let k = vertices.len();
    let joins = |i: usize| !(i > 1 && vertices[i - 1].delta || i < k && vertices[i].delta);
    // What strategy i's density has beside the plain products.
    let special = |i: usize| {
        // A lamp beside others that are brighter by more than an `f32` can tell is never chosen, by either.
        let apart = i == 1 && k > 1 && vertices[0].from_light > 0.0;
        let next_event = if apart { ends.next_event / vertices[0].from_light } else { 1.0 };
        let tries = match i {
            _ if i == k => ends.light_paths,
            0 | 1 => 1.0,
            _ => ends.joins,
        };
        f64::from(next_event) * f64::from(tries)
    };
    // Densities relative to the plain product of strategy s, whose factors are positive; in f64, because
    // long paths span many decades.
    let square = |d: f64| if h == Heuristic::Power { d * d } else { d };
    tell(s, square(special(s)));
    let mut ratio = 1.0_f64;
    for i in (0..s).rev() {
        ratio *= f64::from(vertices[i].from_camera) / f64::from(vertices[i].from_light);
        if joins(i) {
            tell(i, square(ratio * special(i)));
        }
    }
    ratio = 1.0;
    for i in s + 1..=k {
        ratio *= f64::from(vertices[i - 1].from_light) / f64::from(vertices[i - 1].from_camera);
        if joins(i) {
            tell(i, square(ratio * special(i)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vertex(from_light: f32, from_camera: f32) -> VertexDensities {
        VertexDensities { from_light, from_camera, delta: false }
    }

    /// Found by fuzzing random scenes: the weight was no number.
    #[test]
    fn a_lamp_that_is_never_chosen_leaves_all_to_hits() {
        let path = [vertex(0.0, 0.25), vertex(3.0, 8e11)];
        let ends = Ends { next_event: 0.0, light_paths: 35.0, joins: 1.0 };
        for h in [Heuristic::Balance, Heuristic::Power] {
            assert_eq!(exhaustive(&path, ends, 0, h, |i| i <= 1), 1.0);
            assert_eq!(exhaustive(&path, ends, 0, h, |_| true), 1.0);
        }
    }

    /// Found by fuzzing random scenes: squares of densities overflowed, and the weight was no number.
    #[test]
    fn two_strategies_share_at_any_density() {
        for h in [Heuristic::Balance, Heuristic::Power] {
            for scale in [1e-30_f32, 1.0, 1e25] {
                let [a, b] = [h.share(2.0 * scale, scale), h.share(scale, 2.0 * scale)];
                let expected = h.of(2.0) / (1.0 + h.of(2.0));
                assert!(
                    (a - expected).abs() < 1e-6 && (a + b - 1.0).abs() < 1e-6,
                    "{h:?}, {scale}: {a}, {b}"
                );
            }
            assert!(h.share(1e-20, 1e20) < 1e-30);
            assert_eq!([h.share(1e20, 1e-20), h.share(1e-20, 0.0)], [1.0, 1.0]);
        }
    }

    /// Densities of powers of two, whose ratios are exact: p₀ = 2·4·8, p₁ = 16·4·8, p₂ = 8·32·8·5, p₃ = 8·32·2·3.
    #[test]
    fn the_strategies_are_tried_as_often_as_they_are() {
        let path = [vertex(8.0, 2.0), vertex(32.0, 4.0), vertex(2.0, 8.0)];
        let ends = Ends { next_event: 16.0, light_paths: 3.0, joins: 5.0 };
        let densities = [64.0, 512.0, 10240.0, 1536.0_f32];
        for (h, power) in [(Heuristic::Balance, 1), (Heuristic::Power, 2)] {
            let sum: f32 = densities.iter().map(|d| d.powi(power)).sum();
            for (s, density) in densities.iter().enumerate() {
                let weight = exhaustive(&path, ends, s, h, |_| true);
                assert!((weight - density.powi(power) / sum).abs() < 1e-6, "{s}: {weight}");
                assert_eq!(exhaustive(&path, ends, s, h, |i| i == s), 1.0);
            }
        }
    }
}
