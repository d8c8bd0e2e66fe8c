//! Nori's XML scenes.
//!
//! A file is read in two steps: XML to objects with typed properties ([`tree`]), the same for all
//! plugins; then each plugin reads its object through [`fields::Fields`], which keeps account of what
//! nobody asked for.

mod bsdf;
pub(crate) mod camera;
mod class;
mod context;
pub(crate) mod document;
mod emitter;
mod fields;
mod integrator;
pub(crate) mod range;
mod scene;
mod shape;
mod test;
mod texture;
pub(crate) mod transform;
mod tree;
pub(crate) mod value;

use caustica_scene::Diagnostic;

use crate::Loaded;
use crate::files::Folder;
use crate::source::Source;
use class::Class;
use context::Warnings;
use tree::Place;

pub use test::{SceneTest, TestKind};

/// Reads the scene and the tests of a file.
pub(crate) fn read(source: &Source, folder: Folder<'_>) -> Result<Loaded, Diagnostic> {
    let document = document::parse(source)?;
    let place = Place { source };
    let root = document.root_element();
    let object = tree::object(place, root, 0)?;
    let mut warnings = Warnings::default();
    let (scene, tests) = match object.class {
        Class::Scene => scene::read_file(&object, place, folder, &mut warnings)?,
        Class::Test => (None, vec![test::read(&object, place, folder, &mut warnings)?]),
        other => {
            let message =
                format!("a scene file must start with <scene> or <test>, not with <{}>", other.tag());
            return Err(place.error(message, object.range));
        }
    };
    Ok(Loaded {
        scene,
        tests,
        warnings: warnings.into_vec(),
        max_depth: None,
        roulette_start: None,
        layers: Vec::new(),
    })
}
