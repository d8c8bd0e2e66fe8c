//! Opening files that a scene names, without waiting on pipes or reading devices.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

use caustica_scene::MemoryLimit;

/// Which files a scene may name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trust {
    /// Any: `../meshes/x.obj` and absolute paths are common in scenes that people write for themselves.
    #[default]
    Full,
    /// Only files below the scene's own folder, named by relative paths, after symbolic links are followed.
    OwnFolder,
}

/// Where the files lie that a scene names.
#[derive(Clone, Copy)]
pub(crate) struct Folder<'a> {
    /// Relative paths start here.
    pub(crate) base: &'a Path,
    /// Meshes that come with the program, by name; they hide files.
    pub(crate) embedded: &'a [(&'a str, &'a str)],
    /// What all that is read may take.
    pub(crate) memory: MemoryLimit,
    /// Which files may be opened.
    pub(crate) trust: Trust,
}

impl<'a> Folder<'a> {
    /// The text of an embedded mesh.
    pub(crate) fn embedded(&self, name: &str) -> Option<&'a str> {
        self.embedded.iter().find(|(n, _)| *n == name).map(|(_, text)| *text)
    }

    /// The path of a file that the scene names; the error says why it may not be opened, in words.
    pub(crate) fn resolve(&self, name: &str) -> Result<PathBuf, String> {
        let path = self.base.join(name);
        if self.trust == Trust::Full {
            return Ok(path);
        }
        self.refuse_climbing(name)?;
        self.within(path)
    }

    /// Refuses a name that leads out of the scene's folder, if that is forbidden: by itself alone, so that the answer
    /// does not tell what exists elsewhere.
    pub(crate) fn refuse_climbing(&self, name: &str) -> Result<(), String> {
        if self.trust == Trust::OwnFolder && climbs_out(Path::new(name)) {
            return Err(OUTSIDE.into());
        }
        Ok(())
    }

    /// A path that is there, if it may be opened, after symbolic links are followed where that matters.
    pub(crate) fn within(&self, path: PathBuf) -> Result<PathBuf, String> {
        if self.trust == Trust::Full {
            return Ok(path);
        }
        let base = if self.base.as_os_str().is_empty() { Path::new(".") } else { self.base };
        let root = base.canonicalize().map_err(|e| reason(&e))?;
        let found = path.canonicalize().map_err(|e| reason(&e))?;
        if found.starts_with(&root) { Ok(found) } else { Err(OUTSIDE.into()) }
    }
}

/// Why a file is refused to a scene that is not trusted.
const OUTSIDE: &str = "it lies outside of the scene's folder, and the scene is not trusted";

/// Whether a path is absolute or leaves the folder that it starts in.
fn climbs_out(path: &Path) -> bool {
    let mut depth = 0_usize;
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::Normal(_) => depth += 1,
            Component::ParentDir if depth > 0 => depth -= 1,
            Component::ParentDir | Component::RootDir | Component::Prefix(_) => return true,
        }
    }
    false
}

/// What a scene may hold. A mesh that is named many times is there many times, and deflate shrinks a plain
/// image a thousandfold, so that a short file could fill any memory.
#[derive(Clone, Copy)]
pub(crate) struct Limits {
    /// Triangles of all shapes together.
    pub(crate) triangles: usize,
    /// Pixels of all images together.
    pub(crate) pixels: u64,
}

impl Limits {
    /// About 1 GB each where the scene is not trusted.
    pub(crate) fn of(trust: Trust) -> Self {
        match trust {
            Trust::Full => Self { triangles: 1 << 28, pixels: u64::MAX },
            Trust::OwnFolder => Self { triangles: 1 << 24, pixels: 1 << 26 },
        }
    }
}

/// Takes an amount from what is left; `None` if that is not enough.
pub(crate) fn take(left: &mut usize, amount: usize) -> Option<()> {
    *left = left.checked_sub(amount)?;
    Some(())
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
    if size > limit {
        return Err(too_large(limit));
    }
    // Room for one more tells the end of the file without another allocation.
    let mut bytes = Vec::with_capacity(size as usize + 1);
    // The file may grow while it is read, so the size alone is no bound.
    file.take(limit + 1).read_to_end(&mut bytes).map_err(|e| reason(&e))?;
    if bytes.len() as u64 > limit {
        return Err(too_large(limit));
    }
    Ok(bytes)
}

fn too_large(limit: u64) -> String {
    format!("it is larger than {} MiB", limit >> 20)
}

fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".into(),
        io::ErrorKind::PermissionDenied => "it may not be read".into(),
        _ => error.to_string(),
    }
}
