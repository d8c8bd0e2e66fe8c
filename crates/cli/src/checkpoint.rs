//! Films that are kept while a render runs, and continued by the next one.

use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::time::Duration;

use caustica::film::{FilmRecord, Provenance, check_writable, remove_leftovers, write_film};
use caustica::{RenderOptions, Report, Scene, Session};

use crate::args;
use crate::failure::Failure;
use crate::outputs::is_film;

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
        if !is_film(&path) {
            return Err(Failure::Usage(format!("the checkpoint `{}` must end in .film", path.display())));
        }
        let record = match (path.try_exists(), args.resume) {
            (Ok(true), _) if is_empty(&path) => None,
            (Ok(true), true) => Some(FilmRecord::read(&path).map_err(|e| Failure::input(&path, e))?),
            (Ok(true), false) => {
                return Err(Failure::Output(format!(
                    "the checkpoint `{}` is there already: go on with it by `--resume`, or remove it",
                    path.display()
                )));
            }
            _ => None,
        };
        // What a render that was killed was writing.
        let cleared = check_writable(&path).and_then(|()| remove_leftovers(&path));
        cleared.map_err(|e| Failure::output(&path, e))?;
        Ok(Some((Self { path, every: args.every, failed: Cell::new(false) }, record)))
    }

    /// Keeps the film as it is now.
    pub fn write(
        &self,
        session: &Session<'_>,
        (provenance, report): (&Provenance, &Report),
    ) -> Result<(), Failure> {
        write_output(&self.path, session, (provenance, report))
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
    (record, provenance): (Option<FilmRecord>, &Provenance),
) -> Result<Session<'a>, Failure> {
    Ok(match record {
        Some(film) => Session::resume(scene, options, (film, provenance))?,
        None => Session::new(scene, options)?,
    })
}

/// Writes a film.
pub fn write_output(
    path: &Path,
    session: &Session<'_>,
    (provenance, report): (&Provenance, &Report),
) -> Result<(), Failure> {
    write_film(path, session.film(), &session.facts(provenance, report.seconds))
        .map_err(|e| Failure::output(path, e))
}

/// What could not be written where it was asked for is written to the folder of temporary files, so that it is not lost.
pub fn rescue(
    failure: Failure,
    session: &Session<'_>,
    (provenance, report): (&Provenance, &Report),
) -> Failure {
    let Failure::Output(why) = failure else { return failure };
    let path = std::env::temp_dir().join(format!("caustica-{}.film", std::process::id()));
    match write_output(&path, session, (provenance, report)) {
        Ok(()) => Failure::Output(format!(
            "{why}; the film is saved as `{}`: go on with it by `--checkpoint` and `--resume`, or make a picture of it \
             by `caustica develop`",
            path.display()
        )),
        Err(_) => Failure::Output(why),
    }
}
