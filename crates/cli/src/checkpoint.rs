//! Films that are kept while a render runs, and continued by the next one.

use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::time::Duration;

use caustica::film::{FilmError, FilmRecord, Provenance, check_writable, write_film};
use caustica::{RenderOptions, Report, Scene, Session};

use crate::args;
use crate::failure::Failure;

/// Where a render's film is kept.
pub struct Checkpoint {
    path: PathBuf,
    pub every: Duration,
    /// Whether the last attempt to write it failed.
    failed: Cell<bool>,
}

impl Checkpoint {
    /// The checkpoint that the arguments ask for, and the film in it that is to be continued.
    ///
    /// # Errors
    /// A file that is there without a wish to continue it: it may hold the work of hours.
    pub fn open(args: &args::Checkpoint) -> Result<Option<(Self, Option<FilmRecord>)>, Failure> {
        let Some(path) = args.file.clone() else { return Ok(None) };
        let record = match (path.try_exists(), args.resume) {
            (Ok(true), true) => Some(FilmRecord::read(&path).map_err(|e| Failure::input(&path, e))?),
            (Ok(true), false) if !is_empty(&path) => {
                return Err(Failure::Output(format!(
                    "the checkpoint `{}` is there already: go on with it by `--resume`, or remove it",
                    path.display()
                )));
            }
            _ => None,
        };
        check_writable(&path).map_err(|e| Failure::output(&path, e))?;
        Ok(Some((Self { path, every: args.every, failed: Cell::new(false) }, record)))
    }

    /// Keeps the film as it is now.
    pub fn write(
        &self,
        session: &Session<'_>,
        (provenance, report): (&Provenance, &Report),
    ) -> Result<(), Failure> {
        write_film(&self.path, session.film(), &session.facts(provenance, report.seconds))
            .map_err(|e| Failure::output(&self.path, e))
    }

    /// The same while the render runs, which goes on whatever happens. Returns what to tell people, once for a row
    /// of failures.
    pub fn try_write(&self, session: &Session<'_>, what: (&Provenance, &Report)) -> Option<String> {
        let result = self.write(session, what);
        let first = !self.failed.replace(result.is_err());
        result.err().filter(|_| first).map(|e| {
            let why = e.into_diagnostic().message;
            format!("warning: {why}; the render goes on, and tries again after {:?}", self.every)
        })
    }
}

/// Whether there is nothing in a file that could be lost.
fn is_empty(path: &Path) -> bool {
    path.metadata().is_ok_and(|m| m.is_file() && m.len() == 0)
}

/// A session that continues that film, or begins a new one.
pub fn session<'a>(
    scene: &'a Scene,
    options: RenderOptions,
    (record, provenance): (Option<FilmRecord>, Option<&Provenance>),
) -> Result<Session<'a>, Failure> {
    Ok(match record.zip(provenance) {
        Some(film) => Session::resume(scene, options, film)?,
        None => Session::new(scene, options)?,
    })
}

/// Writes a film that was asked for.
pub fn write_output(
    path: &Path,
    session: &Session<'_>,
    (provenance, report): (&Provenance, &Report),
) -> Result<(), Failure> {
    write_film(path, session.film(), &session.facts(provenance, report.seconds))
        .map_err(|e: FilmError| Failure::output(path, e))
}
