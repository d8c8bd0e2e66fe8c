//! What fuzz targets do with an input, and where their inputs come from.
//!
//! A [`Target`] is a plain function of bytes that panics when a promise is broken, with seeds to start from and a
//! way to change them. `fuzz/` hands them to cargo-fuzz, and `tests/short.rs` runs each for a few seconds by
//! deterministic changes, with a stable compiler and no other tool.

mod dice;
mod images;
mod meshes;
mod mutate;
mod readers;
mod scenes;
mod seeds;
mod words;
mod xml;

use std::sync::LazyLock;

use tempfile::TempDir;

pub use dice::Dice;

/// Something that takes arbitrary bytes and must survive them.
#[derive(Clone, Copy)]
pub struct Target {
    /// Its name, and that of its binary in `fuzz/`.
    pub name: &'static str,
    /// Takes one input.
    pub run: fn(&[u8]),
    /// Inputs to start from.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Changes an input in a way that keeps some of its structure.
    pub mutate: fn(&mut Vec<u8>, &mut Dice),
    /// Words of the format.
    pub words: &'static [&'static str],
}

/// All targets.
pub const TARGETS: &[Target] = &[
    Target {
        name: "nori_xml",
        run: readers::nori_xml,
        seeds: seeds::nori_xml,
        mutate: xml::nori,
        words: words::NORI,
    },
    Target {
        name: "mitsuba_xml",
        run: readers::mitsuba_xml,
        seeds: seeds::mitsuba_xml,
        mutate: xml::mitsuba,
        words: words::MITSUBA,
    },
    Target { name: "obj", run: readers::obj, seeds: seeds::obj, mutate: mutate::obj, words: words::OBJ },
    Target {
        name: "ply",
        run: readers::ply,
        seeds: meshes::ply,
        mutate: meshes::change_ply,
        words: words::PLY,
    },
    Target {
        name: "serialized",
        run: readers::serialized,
        seeds: meshes::serialized,
        mutate: meshes::change_serialized,
        words: &["\x1c\x04\x03", "\x1c\x04\x04"],
    },
    Target {
        name: "images",
        run: readers::images,
        seeds: images::seeds,
        mutate: mutate::images,
        words: words::IMAGES,
    },
    Target { name: "exr", run: readers::exr, seeds: seeds::exr, mutate: mutate::binary, words: words::EXR },
    Target {
        name: "film",
        run: readers::film,
        seeds: seeds::films,
        mutate: mutate::binary,
        words: words::FILM,
    },
    Target { name: "scenes", run: scenes::scenes, seeds: scenes::seeds, mutate: mutate::binary, words: &[] },
];

/// The target of that name.
///
/// # Panics
/// If there is none.
pub fn target(name: &str) -> &'static Target {
    TARGETS.iter().find(|t| t.name == name).unwrap_or_else(|| panic!("no target is called {name}"))
}

/// A folder of this process for files that inputs are written to or name.
///
/// # Panics
/// If none can be made.
fn folder() -> &'static TempDir {
    static FOLDER: LazyLock<TempDir> = LazyLock::new(|| tempfile::tempdir().expect("a temporary folder"));
    &FOLDER
}
