//! Scene files to descriptions: Nori's and Mitsuba's XML, OBJ, PLY and serialized meshes, and PNG, JPEG and OpenEXR images.
//!
//! Whatever is wrong with a file is told with its line and column where it has any; no file makes these
//! readers panic, hang or allocate without bound.

mod files;
mod image;
mod mitsuba;
mod nori;
mod obj;
mod ply;
mod serialized;
mod source;
mod suggest;

use std::path::Path;

use caustica_scene::description::Layer;
use caustica_scene::{Description, Diagnostic, MemoryLimit};

use files::Folder;

pub use files::Trust;
pub use image::{ReadImage, decode_image, read_image, read_image_within};
pub use nori::{SceneTest, TestKind};
pub use obj::{ObjMesh, load_obj, load_obj_within, read_obj};
pub use ply::{PlyMesh, read_ply};
pub use serialized::read_serialized;

/// What a scene file holds.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene, if the file describes one beside its tests.
    pub scene: Option<Description>,
    /// The statistical tests that the file carries, in its order.
    pub tests: Vec<SceneTest>,
    /// What is worth knowing.
    pub warnings: Vec<Diagnostic>,
    /// The most edges that a path may have, if the file says so.
    pub max_depth: Option<u32>,
    /// After how many bounces roulette begins, if the file says so.
    pub roulette_start: Option<u32>,
    /// What the file wants written beside the picture.
    pub layers: Vec<Layer>,
}

/// What a scene is given beside its own file.
#[derive(Clone, Copy, Debug, Default)]
pub struct Provision<'a> {
    /// Which files it may name.
    pub trust: Trust,
    /// Values for its variables (`$name` in Mitsuba's files), as (name, value). A name that the scene does not know is
    /// an error.
    pub variables: &'a [(String, String)],
}

/// The most bytes that a scene file may have.
const LARGEST_SCENE_FILE: u64 = 64 << 20;

/// Reads a scene file and all files that it names, wherever they are.
pub fn load(path: &Path) -> Result<Loaded, Diagnostic> {
    load_file(path, &Provision::default(), MemoryLimit::Machine)
}

/// The same in so much memory: images and meshes that take more are refused, images before they are decoded and
/// meshes while they are read.
pub fn load_within(path: &Path, memory: MemoryLimit) -> Result<Loaded, Diagnostic> {
    load_file(path, &Provision::default(), memory)
}

/// Reads a scene file and the files that it names, as far as they are provided.
pub fn load_with(path: &Path, provision: &Provision<'_>) -> Result<Loaded, Diagnostic> {
    load_file(path, provision, MemoryLimit::Machine)
}

fn load_file(path: &Path, provision: &Provision<'_>, memory: MemoryLimit) -> Result<Loaded, Diagnostic> {
    let Provision { trust, variables } = *provision;
    let name = path.display().to_string();
    let bytes = files::read(path, LARGEST_SCENE_FILE)
        .map_err(|why| Diagnostic::error(format!("cannot read the scene `{name}`: {why}")))?;
    let text = match std::str::from_utf8(&bytes) {
        Ok(text) => text,
        Err(error) => {
            let valid = error.valid_up_to();
            // What precedes the error is UTF-8, so that nothing is replaced in it.
            let origin =
                source::Source::new(&name, &String::from_utf8_lossy(&bytes[..valid])).origin(valid..valid);
            return Err(Diagnostic::error("this is not UTF-8 text")
                .at(Some(origin))
                .hint("save the file with the encoding UTF-8"));
        }
    };
    let folder = Folder { base: path.parent().unwrap_or(Path::new("")), embedded: &[], trust, memory };
    parse_with(text, &name, folder, variables)
}

/// Reads a scene from the text of a Mitsuba scene file. `file_name` is for messages; relative paths start
/// at `base_dir`; `variables` are (name, value).
pub fn parse_mitsuba(
    text: &str,
    file_name: &str,
    base_dir: &Path,
    variables: &[(String, String)],
) -> Result<Loaded, Diagnostic> {
    let (trust, memory) = (Trust::Full, MemoryLimit::Machine);
    let folder = Folder { base: base_dir, embedded: &[], trust, memory };
    mitsuba::read(&source::Source::new(file_name, text), folder, variables)
}

/// Reads a scene from the text of a Nori scene file. `file_name` is for messages; relative paths start
/// at `base_dir`.
pub fn parse_nori(text: &str, file_name: &str, base_dir: &Path) -> Result<Loaded, Diagnostic> {
    parse_nori_with(text, file_name, base_dir, Trust::Full)
}

/// The same with a choice of the files that the scene may name.
pub fn parse_nori_with(
    text: &str,
    file_name: &str,
    base_dir: &Path,
    trust: Trust,
) -> Result<Loaded, Diagnostic> {
    parse(text, file_name, Folder { base: base_dir, embedded: &[], trust, memory: MemoryLimit::Machine })
}

/// Reads a scene that comes with the program: its text, and its meshes as (name, OBJ text).
pub fn parse_embedded(text: &str, file_name: &str, meshes: &[(&str, &str)]) -> Result<Loaded, Diagnostic> {
    let (trust, memory) = (Trust::Full, MemoryLimit::Machine);
    parse(text, file_name, Folder { base: Path::new(""), embedded: meshes, trust, memory })
}

fn parse(text: &str, file_name: &str, folder: Folder<'_>) -> Result<Loaded, Diagnostic> {
    parse_with(text, file_name, folder, &[])
}

/// Reads a text by the reader of its format, which its root tells.
fn parse_with(
    text: &str,
    file_name: &str,
    folder: Folder<'_>,
    variables: &[(String, String)],
) -> Result<Loaded, Diagnostic> {
    if text.len() as u64 > LARGEST_SCENE_FILE {
        return Err(Diagnostic::error(format!(
            "`{file_name}` is larger than {} MiB",
            LARGEST_SCENE_FILE >> 20
        )));
    }
    let source = source::Source::new(file_name, text);
    if mitsuba::is_mitsuba(text) {
        return mitsuba::read(&source, folder, variables);
    }
    if let Some((name, _)) = variables.first() {
        return Err(Diagnostic::error(format!("the scene has no variable `{}`", suggest::shorten(name)))
            .hint("only scenes of Mitsuba have variables"));
    }
    nori::read(&source, folder)
}
