use std::path::Path;

use caustica::scene::Diagnostic;
use caustica::{Description, default_scene, import};

use crate::failure::Failure;

/// The scene of that file, or the built-in one.
pub fn description(path: Option<&Path>) -> Result<(Description, Vec<Diagnostic>), Failure> {
    let Some(path) = path else { return Ok((default_scene::description(), Vec::new())) };
    let loaded = import::load(path)?;
    match loaded.scene {
        Some(scene) => Ok((scene, loaded.warnings)),
        None => Err(Diagnostic::error(format!("`{}` carries tests but no scene", path.display()))
            .hint("run it with `caustica test`")
            .into()),
    }
}
