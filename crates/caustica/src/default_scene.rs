//! The scene that is rendered where none is given: `scenes/final`, built into the program.

use caustica_import::parse_embedded;
use caustica_scene::Description;

const SCENE: &str = include_str!("../../../scenes/final/final.xml");

const MESHES: [(&str, &str); 6] = [
    ("meshes/floor.obj", include_str!("../../../scenes/final/meshes/floor.obj")),
    ("meshes/ceiling.obj", include_str!("../../../scenes/final/meshes/ceiling.obj")),
    ("meshes/back.obj", include_str!("../../../scenes/final/meshes/back.obj")),
    ("meshes/front.obj", include_str!("../../../scenes/final/meshes/front.obj")),
    ("meshes/left.obj", include_str!("../../../scenes/final/meshes/left.obj")),
    ("meshes/right.obj", include_str!("../../../scenes/final/meshes/right.obj")),
];

/// A Cornell box whose lamp is hidden behind a sphere, with glass and mirror spheres that cast caustics.
///
/// # Panics
/// Never: the tests read it.
pub fn description() -> Description {
    match parse_embedded(SCENE, "final.xml", &MESHES) {
        Ok(loaded) => loaded.scene.unwrap_or_default(),
        Err(e) => panic!("the built-in scene is broken: {e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_built_in_scene_reads_without_warnings() {
        let loaded = parse_embedded(SCENE, "final.xml", &MESHES).expect("it is well-formed");
        assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
        let (_, warnings) = caustica_scene::Scene::new(description()).expect("it is sound");
        assert!(warnings.is_empty(), "{warnings:?}");
    }
}
