//! Wavefront OBJ files.
//!
//! Read are `v`, `vt`, `vn` and `f`; materials, groups, smoothing groups, points and lines do not matter
//! here. Faces may have any number of corners.

mod builder;
mod lines;
mod statements;
pub(crate) mod triangulate;

use std::io::{BufRead, BufReader};
use std::path::Path;

use caustica_scene::description::Mesh;
use caustica_scene::memory::shortage;
use caustica_scene::{Diagnostic, MemoryLimit, Origin};

use crate::files;
use lines::{LineError, Lines};
use statements::Statements;

/// A mesh and what is worth knowing about its file.
#[derive(Clone, Debug)]
pub struct ObjMesh {
    /// The mesh.
    pub mesh: Mesh,
    /// What was left out or made up.
    pub warnings: Vec<Diagnostic>,
}

/// Reads an OBJ file.
pub fn load_obj(path: &Path) -> Result<ObjMesh, Diagnostic> {
    load_obj_within(path, MemoryLimit::Machine)
}

/// The same in so much memory: a file is refused as soon as it is clear that it takes more.
pub fn load_obj_within(path: &Path, memory: MemoryLimit) -> Result<ObjMesh, Diagnostic> {
    let (file, size) = files::open(path)
        .map_err(|why| Diagnostic::error(format!("cannot read the mesh `{}`: {why}", path.display())))?;
    read_within(BufReader::with_capacity(1 << 18, file), &path.display().to_string(), (size, memory))
}

/// Reads the text of an OBJ file; `file_name` is for messages.
pub fn read_obj(reader: impl BufRead, file_name: &str) -> Result<ObjMesh, Diagnostic> {
    read_within(reader, file_name, (0, MemoryLimit::Machine))
}

/// So many lines are read between two looks at the memory.
const LINES: u32 = 1 << 14;

/// Reads a text of about `size` bytes, if that is known.
fn read_within(
    reader: impl BufRead,
    file_name: &str,
    (size, memory): (u64, MemoryLimit),
) -> Result<ObjMesh, Diagnostic> {
    let mut lines = Lines::new(reader);
    let mut statements = Statements::default();
    let place = |line, column, span| Some(Origin { file: file_name.to_owned(), line, column, span });
    loop {
        match lines.advance() {
            Ok(true) => {}
            Ok(false) => break,
            Err(LineError::Io(error)) => {
                let message = format!("the mesh cannot be read: {error}");
                return Err(Diagnostic::error(message).at(place(lines.line, 0, None)));
            }
            Err(LineError::TooLong) => {
                let message = "this line is longer than 16 MiB; this is no OBJ file";
                return Err(Diagnostic::error(message).at(place(lines.line, 0, None)));
            }
        }
        if lines.line.is_multiple_of(LINES) {
            let needed = statements.memory_for(size as f64 / lines.offset.max(1) as f64);
            memory.check(needed).map_err(|e| {
                let error = shortage(&format!("the mesh `{file_name}`"), e);
                error.at(place(lines.line, 0, None)).hint("use a mesh of fewer triangles")
            })?;
        }
        statements.read(&lines.buffer, lines.line).map_err(|bad| {
            let (line, column) = lines.position(bad.at);
            let span = Some((lines.offset + bad.at, bad.length));
            let error = Diagnostic::error(bad.message).at(place(line, column, span));
            match bad.hint {
                Some(hint) => error.hint(hint),
                None => error,
            }
        })?;
    }
    let last_line = lines.line.saturating_sub(1).max(1);
    statements.finish(|line| place(line, 0, None)).map_err(|e| e.at(place(last_line, 0, None)))
}
