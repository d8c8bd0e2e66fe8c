//! Stanford PLY files: text, and binary in both byte orders.
//!
//! Read are the positions, normals and texture coordinates of `vertex`, the corners of `face`, and attributes of both;
//! other elements and properties are skipped. Faces may have any number of corners.

mod attributes;
mod body;
mod header;
mod sizes;

use std::path::Path;

use caustica_scene::description::Mesh;
use caustica_scene::memory::shortage;
use caustica_scene::{Diagnostic, MemoryLimit, Origin};

use crate::files;
use sizes::Sizes;

/// The most bytes that a file may have.
const LARGEST_FILE: u64 = 1 << 36;

/// A mesh and what is worth knowing about its file.
#[derive(Clone, Debug)]
pub struct PlyMesh {
    /// The mesh. Texture coordinates are as in the file.
    pub mesh: Mesh,
    /// What was left out.
    pub warnings: Vec<Diagnostic>,
}

/// What is wrong with a file, in which line, if lines are known.
struct Fault {
    message: String,
    line: u32,
}

fn fault<T>(message: impl Into<String>, line: u32) -> Result<T, Fault> {
    Err(Fault { message: message.into(), line })
}

/// Reads a PLY file in so much memory.
pub(crate) fn load(path: &Path, memory: MemoryLimit) -> Result<PlyMesh, Diagnostic> {
    let name = path.display().to_string();
    let unreadable = |why| Diagnostic::error(format!("cannot read the mesh `{name}`: {why}"));
    let (file, size) = files::open(path).map_err(unreadable)?;
    drop(file);
    let check = |needed| {
        let error = |e| shortage(&format!("the mesh `{name}`"), e).hint("use a mesh of fewer triangles");
        memory.check(needed).map_err(error)
    };
    check(size)?;
    let bytes = files::read(path, LARGEST_FILE).map_err(unreadable)?;
    read_checked(&bytes, &name, |mesh| {
        // Its mesh, and the copy of it that other shapes of the same file are made from. Of a limit that is given the
        // file takes its part; what the machine has left is told without it.
        let file = if memory == MemoryLimit::Machine { 0 } else { size };
        check(mesh.saturating_mul(2).saturating_add(file))
    })
}

/// Reads a PLY file; `file_name` is for messages.
pub fn read_ply(bytes: &[u8], file_name: &str) -> Result<PlyMesh, Diagnostic> {
    read_checked(bytes, file_name, |_| Ok(()))
}

/// The same if `fits` agrees to so many bytes of a mesh, before they are taken.
fn read_checked(
    bytes: &[u8],
    file_name: &str,
    fits: impl FnOnce(u64) -> Result<(), Diagnostic>,
) -> Result<PlyMesh, Diagnostic> {
    let origin = |line| Some(Origin { file: file_name.to_owned(), line, column: 0, span: None });
    let placed = |Fault { message, line }| Diagnostic::error(message).at(origin(line.max(1)));
    let header = header::parse(bytes).map_err(placed)?;
    let body = &bytes[header.length..];
    let sizes = Sizes::of(&header, body);
    fits(sizes.bytes(&header))?;
    match body::read(&header, body, sizes) {
        Ok((mesh, 0)) => Ok(PlyMesh { mesh, warnings: Vec::new() }),
        Ok((mesh, left_out)) => {
            let message =
                format!("{left_out} faces have fewer than three corners or no area; they are left out");
            Ok(PlyMesh { mesh, warnings: vec![Diagnostic::warning(message).at(origin(1))] })
        }
        Err(fault) => Err(placed(fault)),
    }
}
