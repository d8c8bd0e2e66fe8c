//! What takes part in a comparison.

use caustica_render::integrator_name;
use caustica_scene::description::Integrator;
use caustica_transport::Settings;

/// The name of `bdpt` without its light image: strategies with two camera vertices or more, weighed among themselves.
pub const EYE_ONLY: &str = "bdpt-eye";

/// The names of the methods that are compared if nobody asks for others.
pub const DEFAULT_METHODS: [&str; 5] = ["naive", "path", "light", EYE_ONLY, "bdpt"];

/// A way to render.
#[derive(Clone, Debug)]
pub struct Method {
    /// A short name, the same for no two methods of a comparison.
    pub name: String,
    /// What it is, in a few words.
    pub label: String,
    /// The integrator with its settings.
    pub settings: Settings,
}

impl Method {
    /// The method of that integrator, with all else as in `base`.
    pub fn new(integrator: Integrator, base: &Settings) -> Self {
        let name = integrator_name(&integrator);
        let label = match name {
            "naive" => "Path tracing, material sampling only",
            "path" => "Path tracing with next-event estimation",
            "light" => "Light tracing",
            "bdpt" => "Bidirectional path tracing",
            other => other,
        };
        Self {
            name: name.to_owned(),
            label: label.to_owned(),
            settings: Settings { integrator, ..base.clone() },
        }
    }

    /// [`EYE_ONLY`], with all else as in `base`.
    pub fn eye_only(base: &Settings) -> Self {
        let settings = Settings {
            integrator: Integrator::Bdpt,
            // Two conditions that are well formed.
            strategies: "t>=2".parse().unwrap_or_default(),
            ..base.clone()
        };
        let label = "Bidirectional path tracing without its light image".to_owned();
        Self { name: EYE_ONLY.to_owned(), label, settings }
    }
}
