//! What can go wrong with a film.

use std::io;
use std::path::{Path, PathBuf};

/// An error of a film or of a file of pictures.
#[derive(Debug, thiserror::Error)]
pub enum FilmError {
    /// A file could not be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The memory for a film cannot be had.
    #[error(
        "a film of {width} × {height} pixels needs {megabytes} MB of memory, more than there is; a crop needs less"
    )]
    TooLarge {
        /// Width of the window.
        width: u32,
        /// Height of the window.
        height: u32,
        /// Memory that the film needs, in millions of bytes.
        megabytes: u64,
    },
    /// Sizes that make no film, or that do not fit together.
    #[error("{0}")]
    Layout(String),
    /// Films that cannot be merged.
    #[error("{0}")]
    Merge(String),
    /// A file does not hold what it should.
    #[error("{}: {message}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        message: String,
    },
    /// A word that names none of the choices.
    #[error("`{name}` is not a {what}: choose {choices}")]
    UnknownName {
        /// What was to be chosen.
        what: &'static str,
        /// The word that was given.
        name: String,
        /// The words that there are.
        choices: &'static str,
    },
}

impl FilmError {
    pub(crate) fn io(path: &Path, source: io::Error) -> Self {
        Self::Io { path: path.to_owned(), source }
    }

    pub(crate) fn format(path: &Path, message: impl Into<String>) -> Self {
        Self::Format { path: path.to_owned(), message: message.into() }
    }

    pub(crate) fn unknown(what: &'static str, name: &str, choices: &'static str) -> Self {
        Self::UnknownName { what, name: name.to_owned(), choices }
    }
}
