//! The ways to render that are compared, and what each can reach.

use caustica_scene::camera::Joins;
use caustica_scene::description::{Integrator, Technique};
use caustica_transport::{Heuristic, Settings, Strategy, StrategySet};

use crate::class::PathClass;

/// A way to render a scene by itself.
#[derive(Clone, Debug)]
pub struct Estimator {
    /// A short name, the same for no two of a run.
    pub name: String,
    /// What it can reach, in a few words.
    pub reach: &'static str,
    /// The integrator with its settings.
    pub settings: Settings,
    /// The strategies that it amounts to.
    strategies: StrategySet,
}

/// The strategy sets of `bdpt` that are rendered apart. They are disjoint, and together all.
const SETS: [(&str, &str); 4] = [
    ("s=0", "lamps that eye paths hit"),
    ("s=1&t>=2", "D next to the lamp"),
    ("t=1", "D next to the camera, and lamps in view"),
    ("s>=2&t>=2", "two D in a row"),
];

impl Estimator {
    /// All that are compared, with all else as in `base`: `bdpt` by both heuristics, and without its light image; each
    /// set of its strategies; and the other integrators of light transport.
    pub fn all(base: &Settings) -> Vec<Self> {
        let other = match base.heuristic {
            Heuristic::Balance => (Heuristic::Power, "bdpt, power heuristic"),
            Heuristic::Power => (Heuristic::Balance, "bdpt, balance heuristic"),
        };
        let whole =
            Settings { integrator: Integrator::Bdpt, strategies: StrategySet::default(), ..base.clone() };
        let weighed = Settings { heuristic: other.0, ..whole.clone() };
        let mut all = vec![
            Self::new("bdpt", "all that any strategy reaches", whole.clone(), "all"),
            Self::new(other.1, "all that any strategy reaches", weighed, "all"),
        ];
        let eye = ("t>=2", "all but single D next to the camera, of lamps without extent");
        for (set, reach) in SETS.into_iter().chain([eye]) {
            // Conditions that are well formed.
            let strategies: StrategySet = set.parse().unwrap_or_default();
            let settings = Settings { strategies, ..whole.clone() };
            all.push(Self::new(&format!("bdpt, {set}"), reach, settings, set));
        }
        let path = "s=0;s=1&t>=2";
        for (name, integrator, set, reach) in [
            (
                "path",
                Integrator::Path(Technique::Mis),
                path,
                "lamps that eye paths hit, and D next to the lamp",
            ),
            ("path_ems", Integrator::Path(Technique::Emitters), path, "as path"),
            ("naive", Integrator::Path(Technique::Materials), "s=0", "lamps that eye paths hit"),
            ("light", Integrator::Light, "t=1", "D next to the camera, and lamps in view"),
        ] {
            all.push(Self::new(name, reach, Settings { integrator, ..whole.clone() }, set));
        }
        all
    }

    fn new(name: &str, reach: &'static str, settings: Settings, set: &str) -> Self {
        let strategies = set.parse().unwrap_or_default();
        Self { name: name.to_owned(), reach, settings, strategies }
    }

    /// The strategy of a path of `edges` edges with `s` light vertices, if this estimator has it.
    fn has(&self, s: u32, edges: u32) -> Option<Strategy> {
        let strategy = Strategy { s, t: edges + 1 - s };
        self.strategies.contains(strategy).then_some(strategy)
    }

    /// Whether it finds paths of that class, seen by a camera of which so much can be joined.
    pub fn reaches(&self, class: &PathClass, camera: Joins) -> bool {
        let made = |s| self.has(s, class.edges()).is_some_and(|s| class.is_made_by(s, camera));
        (0..=class.edges()).any(made)
    }

    /// How often its eye paths make a path by themselves, how often they do by joining a light path, and how often its
    /// light image does, over how often all strategies together do, given the weights that all strategies have for it;
    /// roulette aside.
    pub fn shares(&self, weights: &[f32]) -> [f64; 3] {
        let edges = weights.len() as u32 - 1;
        let weight = |s: u32| f64::from(weights[s as usize]);
        let emitters = matches!(self.settings.integrator, Integrator::Path(Technique::Emitters));
        // It leaves hits to next-event estimation wherever that can be.
        if emitters && edges > 1 && weights[1] > 0.0 {
            return [weight(1), 0.0, 0.0];
        }
        let share = |s: std::ops::Range<u32>| s.filter(|s| self.has(*s, edges).is_some()).map(weight).sum();
        let alone = edges.min(2);
        [share(0..alone), share(alone..edges), share(edges..edges + 1)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::class::LampEnd;

    #[test]
    fn integrators_reach_what_their_strategies_make() {
        let all = Estimator::all(&Settings::default());
        let who = |lamp, text: &str| -> Vec<&str> {
            let class = PathClass::new(lamp, text.chars().map(|c| c == 'D'));
            all.iter().filter(|e| e.reaches(&class, Joins::All)).map(|e| e.name.as_str()).skip(2).collect()
        };
        let (area, point) = (LampEnd::Surface, LampEnd::Dirac);
        assert_eq!(who(area, "SDS"), ["bdpt, s=0", "bdpt, t>=2", "path", "path_ems", "naive"]);
        assert_eq!(who(point, "SD"), ["bdpt, t=1", "light"]);
        assert_eq!(who(point, "DS"), ["bdpt, s=1&t>=2", "bdpt, t>=2", "path", "path_ems"]);
        assert_eq!(who(point, "SDDS"), ["bdpt, s>=2&t>=2", "bdpt, t>=2"]);
        assert!(who(point, "SDS").is_empty() && who(point, "").is_empty());
        assert_eq!(who(LampEnd::Collimated, "D"), ["bdpt, t=1", "light"]);
        assert!(who(LampEnd::Collimated, "DS").is_empty());
        assert_eq!(who(area, "").len(), 7);
    }

    #[test]
    fn shares_are_those_of_its_strategies() {
        let all = Estimator::all(&Settings::default());
        let shares = |name: &str, weights: &[f32]| {
            all.iter().find(|e| e.name == name).map(|e| e.shares(weights)).unwrap_or_default()
        };
        let weights = [0.125, 0.25, 0.375, 0.25];
        assert_eq!(shares("bdpt", &weights), [0.375, 0.375, 0.25]);
        assert_eq!(shares("naive", &weights), [0.125, 0.0, 0.0]);
        assert_eq!(shares("path_ems", &weights), [0.25, 0.0, 0.0]);
        assert_eq!(shares("path_ems", &[0.125, 0.0, 0.5, 0.375]), [0.125, 0.0, 0.0]);
        assert_eq!(shares("light", &weights), [0.0, 0.0, 0.25]);
        assert_eq!(shares("bdpt, s>=2&t>=2", &weights), [0.0, 0.375, 0.0]);
        assert_eq!(shares("bdpt, t>=2", &[0.5, 0.25, 0.25]), [0.75, 0.0, 0.0]);
        assert_eq!(shares("light", &[1.0, 0.0, 0.0, 0.0]), [0.0, 0.0, 0.0]);
    }
}
