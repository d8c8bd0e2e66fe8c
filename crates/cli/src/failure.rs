use std::io::ErrorKind;
use std::path::Path;

use caustica::film::FilmError;
use caustica::scene::{Cause, Diagnostic};
use caustica::session::RenderError;

/// Why the program ends without what it was asked for. Each kind has an exit code.
#[derive(Debug)]
pub enum Failure {
    /// The arguments, alone or with the scene.
    Usage(String),
    /// The scene or film file.
    Input(Diagnostic),
    /// The output.
    Output(String),
    /// Memory or threads.
    Machine(String),
}

impl From<Diagnostic> for Failure {
    fn from(d: Diagnostic) -> Self {
        Self::Input(d)
    }
}

impl From<RenderError> for Failure {
    fn from(e: RenderError) -> Self {
        match e {
            RenderError::Continue(why) => Diagnostic::error(why)
                .hint("a film goes on with the scene, the size and the settings that it was begun with")
                .into(),
            other => Self::Machine(other.to_string()),
        }
    }
}

impl Failure {
    /// A file that was to be written.
    pub fn output(path: &Path, e: FilmError) -> Self {
        Self::Output(format!(
            "cannot write `{}`: {}",
            path.display(),
            reason(&e, "the folder does not exist")
        ))
    }

    /// A film that was to be read.
    pub fn input(path: &Path, e: FilmError) -> Self {
        let why = reason(&e, "there is no such file");
        Self::Input(Diagnostic::error(format!("cannot read the film `{}`: {why}", path.display())))
    }

    /// The exit code.
    pub fn code(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            Self::Input(d) if d.cause == Cause::Memory => 5,
            Self::Input(_) => 3,
            Self::Output(_) => 4,
            Self::Machine(_) => 5,
        }
    }

    /// What to tell.
    pub fn into_diagnostic(self) -> Diagnostic {
        match self {
            Self::Input(d) => d,
            Self::Usage(m) | Self::Output(m) | Self::Machine(m) => Diagnostic::error(m),
        }
    }
}

/// What went wrong with a file, without its name.
pub fn reason(e: &FilmError, not_found: &str) -> String {
    match e {
        FilmError::Io { source, .. } => match source.kind() {
            ErrorKind::NotFound => not_found.to_owned(),
            ErrorKind::IsADirectory => "it is a folder".to_owned(),
            ErrorKind::NotADirectory => "a part of its path is not a folder".to_owned(),
            ErrorKind::PermissionDenied => "permission denied".to_owned(),
            ErrorKind::ReadOnlyFilesystem => "the file system is read-only".to_owned(),
            _ => source.to_string(),
        },
        FilmError::Format { message, .. } => message.clone(),
        _ => e.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_the_machine_s_failure() {
        let error = Diagnostic::error("the scene needs 9 MB of memory, and 8 MB are there");
        assert_eq!(Failure::from(error.clone()).code(), 3);
        assert_eq!(Failure::from(Diagnostic { cause: Cause::Memory, ..error }).code(), 5);
    }
}
