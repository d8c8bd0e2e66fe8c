//! Every scene in `scenes/` can be rendered as it is, and its meshes are what the generator writes.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use caustica::import::{Loaded, load};
use caustica::{RenderOptions, Rendered, Rgb, Scene, render};

fn gallery() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

/// The scene files, by name.
fn scenes() -> BTreeMap<String, PathBuf> {
    let folders = fs::read_dir(gallery()).unwrap().map(|entry| entry.unwrap().file_name());
    let named = folders.map(|name| {
        let name = name.into_string().unwrap();
        (name.clone(), gallery().join(&name).join(format!("{name}.xml")))
    });
    named.filter(|(_, path)| path.is_file()).collect()
}

fn read(path: &Path) -> Loaded {
    let loaded = load(path).unwrap_or_else(|e| panic!("{e}"));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    loaded
}

fn small(path: &Path, samples: u32) -> Rendered {
    let mut description = read(path).scene.unwrap();
    (description.film.width, description.film.height) = (12, 9);
    render(description, RenderOptions { samples, threads: Some(1), ..RenderOptions::default() }).unwrap()
}

/// The eye and the light image, added up.
fn pixels(rendered: &Rendered) -> Vec<Rgb> {
    let picture = &rendered.picture;
    picture.eye.iter().zip(&picture.light).map(|(eye, light)| *eye + *light).collect()
}

#[test]
fn all_scenes_render_without_warnings() {
    let scenes = scenes();
    assert!(scenes.len() >= 10, "{:?}", scenes.keys());
    for (name, path) in &scenes {
        let (_, warnings) = Scene::new(read(path).scene.unwrap()).unwrap();
        assert!(warnings.is_empty(), "{name}: {warnings:?}");
        let pixels = pixels(&small(path, 4));
        assert!(pixels.iter().all(|p| p.0.iter().all(|c| c.is_finite() && *c >= 0.0)), "{name}");
        assert!(pixels.iter().any(|p| p.max_channel() > 0.05), "{name} is dark");
    }
}

/// Whatever stands in the furnace, each pixel is one half.
#[test]
fn the_furnace_is_grey() {
    let pixels = pixels(&small(&scenes()["furnace"], 256));
    for p in pixels {
        assert!(p.0.iter().all(|c| (c - 0.5).abs() < 0.1), "{p:?}");
    }
}

#[test]
fn the_generator_writes_the_files_that_are_here() {
    let folder = tempfile::tempdir().unwrap();
    let script = gallery().join("generate.py");
    let output = match Command::new("python3").arg("-B").arg(script).arg(folder.path()).output() {
        Ok(output) => output,
        Err(e) => return eprintln!("skipped, as there is no python3: {e}"),
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let made = files(folder.path(), folder.path());
    for (name, text) in &made {
        let kept = fs::read(gallery().join(name)).unwrap_or_default();
        assert!(kept == *text, "run scenes/generate.py: {name} is not what it writes");
    }
    let meshes = files(&gallery(), &gallery());
    let meshes = meshes.keys().filter(|name| name.ends_with(".obj") && !name.starts_with("final/"));
    let stray: Vec<_> = meshes.filter(|name| !made.contains_key(*name)).collect();
    assert!(stray.is_empty(), "nothing writes {stray:?}");
}

/// All files in a folder, by their paths relative to `root` with forward slashes.
fn files(folder: &Path, root: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path, root));
        } else {
            let parts = path.strip_prefix(root).unwrap().iter().map(|p| p.to_string_lossy());
            found.insert(parts.collect::<Vec<_>>().join("/"), fs::read(&path).unwrap());
        }
    }
    found
}
