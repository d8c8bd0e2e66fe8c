//! Ways to render a scene that are compared with each other.

use caustica_scene::description::{Integrator, Technique};
use caustica_transport::{Heuristic, Settings};

/// A way to render, as tests name them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// Unidirectional, by hitting lamps.
    Naive,
    /// Unidirectional, by hits and next-event estimation.
    Path,
    /// Unidirectional, by next-event estimation alone where it can.
    Emitters,
    /// Light tracing.
    Light,
    /// Bidirectional.
    Bdpt,
    /// Bidirectional, by the power heuristic.
    Power,
    /// Bidirectional without the light image, with the weights of that set.
    NoLightImage,
    /// Bidirectional by one strategy or a few, with the weights of that set.
    Only(&'static str),
}

/// A set of strategies that reaches everything but is no union of classes, so that its weights are added up.
pub const ODD: Way = Way::Only("s=0;s=1;t>=3;s=2&t=2");

impl Way {
    /// Its settings, for paths of at most nine edges. The seed is changed by [`crate::seed::seed`].
    ///
    /// # Panics
    /// If [`Way::Only`] names no set.
    pub fn settings(self, seed: u64) -> Settings {
        let base = Settings { seed: crate::seed::seed(seed), max_depth: Some(9), ..Settings::default() };
        let integrator = |integrator| Settings { integrator, ..base.clone() };
        let strategies = |text: &str| match text.parse() {
            Ok(strategies) => Settings { strategies, ..base.clone() },
            Err(e) => panic!("{e}"),
        };
        match self {
            Self::Naive => integrator(Integrator::Path(Technique::Materials)),
            Self::Path => integrator(Integrator::Path(Technique::Mis)),
            Self::Emitters => integrator(Integrator::Path(Technique::Emitters)),
            Self::Light => integrator(Integrator::Light),
            Self::Bdpt => base,
            Self::Power => Settings { heuristic: Heuristic::Power, ..base },
            Self::NoLightImage => strategies("t>=2"),
            Self::Only(text) => strategies(text),
        }
    }
}
