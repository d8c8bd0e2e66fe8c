//! What a film is a film of.

use std::collections::BTreeMap;

use caustica_film::Provenance;
use caustica_scene::Description;
use caustica_scene::description::Integrator;
use caustica_transport::Settings;

use crate::names::integrator_name;
use crate::session::{heuristic_name, sampler_name};

/// Films of different numbers do not add up: raise it when a change gives samples other bits.
const SAMPLING: u32 = 3;

/// All that a sample depends on beside the scene and its own number, by name.
pub(crate) fn facts(settings: &Settings) -> BTreeMap<String, String> {
    let integrator = settings.integrator;
    let mut facts = vec![
        ("integrator", integrator_name(&integrator).to_owned()),
        ("seed", settings.seed.to_string()),
        ("sampler", sampler_name(settings.sampler).to_owned()),
        ("strategies", settings.strategies.to_string().split_whitespace().collect()),
        ("heuristic", heuristic_name(settings.heuristic).to_owned()),
        ("rouletteDepth", settings.roulette_start().to_string()),
        ("aimedRays", settings.aimed_rays.to_string()),
        ("sharedLightPaths", settings.shared_light_paths.to_string()),
        ("maxDepth", settings.max_depth.map_or_else(|| "unlimited".to_owned(), |d| d.to_string())),
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
        ("sampling", SAMPLING.to_string()),
    ];
    if settings.exhaustive_weights {
        facts.push(("weights", "exhaustive".to_owned()));
    }
    if matches!(
        integrator,
        Integrator::Av { .. } | Integrator::Simple { .. } | Integrator::Directional { .. }
    ) {
        facts.push(("parameters", format!("{integrator:?}")));
    }
    facts.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// What a film of a scene by those settings is a film of: films of the same can be merged. The scene has a name, for
/// people, and the hash of what it holds by [`content_hash`].
pub fn provenance(name: &str, content_hash: &str, settings: &Settings) -> Provenance {
    Provenance { scene: name.to_owned(), scene_hash: content_hash.to_owned(), settings: facts(settings) }
}

/// The BLAKE3 hash of all that a scene holds, as hexadecimal digits. Names, the items' places in their files, and the
/// integrator and number of samples that the scene asks for do not count.
///
/// The description is taken apart while it is hashed, and is whole again afterwards.
pub fn content_hash(description: &mut Description) -> String {
    let (integrator, samples) = (description.integrator, description.samples);
    (description.integrator, description.samples) = (Integrator::default(), 0);
    let (camera, crop) = (description.camera.origin.take(), description.film.crop);
    // A crop of everything is none.
    let (width, height) = (description.film.width, description.film.height);
    description.film.crop = crop.filter(|c| [c.width, c.height] != [width, height]);
    let materials: Vec<_> = description.materials.iter_mut().map(|m| m.origin.take()).collect();
    let lights: Vec<_> = description.lights.iter_mut().map(|l| l.origin.take()).collect();
    let mut shapes: Vec<_> = Vec::new();
    let Description { shapes: own, groups, instances, .. } = &mut *description;
    let all = own.iter_mut().chain(groups.iter_mut().flat_map(|g| &mut g.shapes));
    shapes.extend(all.map(|s| (s.origin.take(), std::mem::take(&mut s.name))));
    let names: Vec<_> = groups.iter_mut().map(|g| (g.origin.take(), std::mem::take(&mut g.name))).collect();
    let places: Vec<_> = instances.iter_mut().map(|i| i.origin.take()).collect();

    let mut hasher = blake3::Hasher::new();
    // Nothing in a description fails to be serialised, and a hash takes all that is written to it.
    let written =
        ciborium::into_writer(&*description, std::io::BufWriter::with_capacity(1 << 16, &mut hasher));
    debug_assert!(written.is_ok(), "{written:?}");

    (description.integrator, description.samples, description.camera.origin) = (integrator, samples, camera);
    description.film.crop = crop;
    description.materials.iter_mut().zip(materials).for_each(|(m, origin)| m.origin = origin);
    description.lights.iter_mut().zip(lights).for_each(|(l, origin)| l.origin = origin);
    let Description { shapes: own, groups, instances, .. } = &mut *description;
    let all = own.iter_mut().chain(groups.iter_mut().flat_map(|g| &mut g.shapes));
    all.zip(shapes).for_each(|(s, known)| (s.origin, s.name) = known);
    groups.iter_mut().zip(names).for_each(|(g, known)| (g.origin, g.name) = known);
    instances.iter_mut().zip(places).for_each(|(i, origin)| i.origin = origin);
    hasher.finalize().to_hex().to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use caustica_scene::Origin;
    use caustica_scene::description::Crop;
    use caustica_testkit::scenes;

    #[test]
    fn groups_and_instances_count() {
        let mut scene = scenes::instanced();
        let (hash, before) = (content_hash(&mut scene), scene.clone());
        let origin = Some(Origin { file: "a.xml".into(), line: 3, column: 1, span: None });
        scene.instances[0].origin = origin.clone();
        (scene.groups[0].origin, scene.groups[0].shapes[0].origin) = (origin.clone(), origin);
        (scene.groups[0].name, scene.groups[0].shapes[0].name) = ("a".into(), "b".into());
        let moved = scene.clone();
        assert_eq!(content_hash(&mut scene), hash);
        assert_eq!(scene, moved);
        for change in [
            &(|d: &mut Description| _ = d.instances.pop()) as &dyn Fn(&mut Description),
            &|d| d.instances.swap(0, 1),
            &|d| _ = d.groups[0].shapes.pop(),
        ] {
            let mut changed = before.clone();
            change(&mut changed);
            assert_ne!(content_hash(&mut changed), hash);
        }
    }

    #[test]
    fn places_and_names_do_not_count_and_all_else_does() {
        let mut scene = scenes::open_box();
        let of = content_hash;
        let hash = of(&mut scene);
        let before = scene.clone();
        let origin = Some(Origin { file: "a.xml".into(), line: 3, column: 1, span: None });
        (scene.camera.origin, scene.shapes[0].origin) = (origin.clone(), origin.clone());
        (scene.materials[0].origin, scene.samples) = (origin, 77);
        scene.shapes[1].name = "another".into();
        let moved = scene.clone();
        assert_eq!(of(&mut scene), hash);
        assert_eq!(scene, moved);
        let (width, height) = (scene.film.width, scene.film.height);
        scene.film.crop = Some(Crop { x: 0, y: 0, width, height });
        assert_eq!(of(&mut scene), hash);
        for change in [
            &(|d: &mut Description| d.film.width += 1) as &dyn Fn(&mut Description),
            &|d| d.camera.near *= 1.0001,
            &|d| d.film.crop = Some(Crop { x: 0, y: 0, width: 1, height: 1 }),
            &|d| _ = d.shapes.pop(),
            &|d| _ = d.materials.pop(),
        ] {
            let mut changed = before.clone();
            change(&mut changed);
            assert_ne!(of(&mut changed), hash);
        }
    }

    #[test]
    fn settings_that_change_the_film_are_told_apart() {
        let of = |settings: &Settings| provenance("a", "0", settings);
        let usual = Settings::default();
        let first = of(&usual);
        assert_eq!(of(&usual).difference(&first), None);
        let seed = Settings { seed: 1, ..usual.clone() };
        assert_eq!(first.difference(&of(&seed)).as_deref(), Some("the seed (0 and 1)"));
        let depth = Settings { max_depth: Some(3), ..usual };
        assert_eq!(first.difference(&of(&depth)).as_deref(), Some("the maxDepth (unlimited and 3)"));
    }
}
