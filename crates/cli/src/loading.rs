use std::path::Path;

use caustica::scene::Diagnostic;
use caustica::scene::bvh::TreeQuality;
use caustica::{Description, Scene, default_scene, import};

use crate::console::Console;
use crate::failure::Failure;

/// The scene of that file, or the built-in one.
pub fn description(path: Option<&Path>, console: &mut Console) -> Result<Description, Failure> {
    let Some(path) = path else { return Ok(default_scene::description()) };
    let loaded = import::load(path)?;
    console.warn(loaded.warnings);
    loaded.scene.ok_or_else(|| {
        Diagnostic::error(format!("`{}` carries tests but no scene", path.display()))
            .hint("run it with `caustica test`")
            .into()
    })
}

/// The description made ready.
pub fn scene(description: Description, tree: TreeQuality, console: &mut Console) -> Result<Scene, Failure> {
    let (scene, warnings) = Scene::with_tree(description, tree)?;
    console.warn(warnings);
    Ok(scene)
}
