//! Opening files that a scene names, without waiting on pipes or reading devices.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use caustica_scene::MemoryLimit;

/// Where the files lie that a scene names.
#[derive(Clone, Copy)]
pub(crate) struct Folder<'a> {
    /// Relative paths start here.
    pub(crate) base: &'a Path,
    /// Meshes that come with the program, by name; they hide files.
    pub(crate) embedded: &'a [(&'a str, &'a str)],
    /// What all that is read may take.
    pub(crate) memory: MemoryLimit,
}

impl<'a> Folder<'a> {
    /// The text of an embedded mesh.
    pub(crate) fn embedded(&self, name: &str) -> Option<&'a str> {
        self.embedded.iter().find(|(n, _)| *n == name).map(|(_, text)| *text)
    }
}

/// Opens a regular file and tells its size; the error says why that failed, in words.
pub(crate) fn open(path: &Path) -> Result<(File, u64), String> {
    // Asked before opening: opening a named pipe would wait for a writer.
    let metadata = std::fs::metadata(path).map_err(|e| reason(&e))?;
    if !metadata.is_file() {
        return Err("it is not a regular file".into());
    }
    let file = File::open(path).map_err(|e| reason(&e))?;
    Ok((file, metadata.len()))
}

/// The bytes of a regular file of at most `limit` bytes.
pub(crate) fn read(path: &Path, limit: u64) -> Result<Vec<u8>, String> {
    let (file, size) = open(path)?;
    let mut bytes = Vec::new();
    // The file may grow while it is read, so the size alone is no bound.
    file.take(limit + 1).read_to_end(&mut bytes).map_err(|e| reason(&e))?;
    if size > limit || bytes.len() as u64 > limit {
        return Err(format!("it is larger than {} MiB", limit >> 20));
    }
    Ok(bytes)
}

fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".into(),
        io::ErrorKind::PermissionDenied => "it may not be read".into(),
        _ => error.to_string(),
    }
}
