//! Where files are looked for.

use std::path::{Path, PathBuf};

use crate::files::Folder;

/// The most folders that a scene may name.
const MOST_FOLDERS: usize = 1000;

/// The folders of a scene: its own, and those that it adds.
#[derive(Clone)]
pub(super) struct Paths<'p> {
    pub(super) folder: Folder<'p>,
    /// The later ones are looked into first.
    added: Vec<PathBuf>,
}

impl<'p> Paths<'p> {
    pub(super) fn new(folder: Folder<'p>) -> Self {
        Self { folder, added: Vec::new() }
    }

    /// Adds a folder, relative to the scene's own or to one that was added.
    pub(super) fn add(&mut self, name: &str) -> Result<(), String> {
        if self.added.len() == MOST_FOLDERS {
            return Err(format!("there are already {MOST_FOLDERS} such folders"));
        }
        self.folder.refuse_climbing(name)?;
        let own = self.folder.base.join(name);
        let path = if own.is_dir() { own } else { self.find(name)? };
        if !path.is_dir() {
            return Err("there is no such folder".into());
        }
        self.added.push(self.folder.within(path)?);
        Ok(())
    }

    /// The file of that name, where it exists or else beside the scene; the error says why it may not be opened.
    pub(super) fn find(&self, name: &str) -> Result<PathBuf, String> {
        self.folder.refuse_climbing(name)?;
        let beside = self.folder.base.join(name);
        if Path::new(name).is_absolute() {
            return Ok(beside);
        }
        let added = self.added.iter().rev().map(|folder| folder.join(name)).find(|path| path.exists());
        self.folder.within(added.unwrap_or(beside))
    }
}
