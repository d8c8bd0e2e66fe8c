//! Files that are replaced whole or not at all.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::FilmError;

/// Whether a file can be written at `path`: to be asked before hours of work, not after. Nothing is
/// left behind, and a file that is there stays as it is.
pub fn check_writable(path: &Path) -> Result<(), FilmError> {
    temporary(&destination(path)?).map(drop)
}

/// Puts `bytes` in a file at `path`: under a temporary name first, so that whoever reads sees the old file
/// or the new one.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), FilmError> {
    write_atomically(path, |file| file.write_all(bytes).map_err(|e| FilmError::io(path, e)))
}

/// Writes a file under a temporary name in its folder and then renames it, so that a reader sees the
/// old file or the new one, and a failure leaves nothing behind.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut File) -> Result<(), FilmError>,
) -> Result<(), FilmError> {
    let target = destination(path)?;
    let mut file = temporary(&target)?;
    write(file.as_file_mut())?;
    // Otherwise a loss of power could keep the new name and lose what it names.
    file.as_file().sync_all().map_err(|e| FilmError::io(path, e))?;
    file.persist(&target).map_err(|e| FilmError::io(path, e.error))?;
    Ok(())
}

/// Where to write: the path itself, or what it links to. Folders and devices are refused, because
/// renaming would put a file in their place.
fn destination(path: &Path) -> Result<PathBuf, FilmError> {
    match fs::metadata(path) {
        Ok(there) if there.is_dir() => Err(FilmError::io(path, io::ErrorKind::IsADirectory.into())),
        Ok(there) if !there.is_file() => {
            let source = io::Error::new(io::ErrorKind::InvalidInput, "not an ordinary file");
            Err(FilmError::io(path, source))
        }
        Ok(_) => fs::canonicalize(path).map_err(|e| FilmError::io(path, e)),
        Err(e) if e.kind() == io::ErrorKind::NotFound && path.file_name().is_some() => Ok(path.to_owned()),
        Err(e) => Err(FilmError::io(path, e)),
    }
}

/// The folder of a file.
fn folder(target: &Path) -> &Path {
    target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// How the names of temporary files begin and end that become `target`.
fn temporary_name(target: &Path) -> (String, &'static str) {
    let name: String = target.file_name().unwrap_or_default().to_string_lossy().chars().take(50).collect();
    (format!(".{name}."), ".part")
}

/// Removes what writers of `path` left that were killed while they wrote. None may be writing it now.
///
/// # Errors
/// What the system says.
pub fn remove_leftovers(path: &Path) -> Result<(), FilmError> {
    let target = destination(path)?;
    let (folder, (start, end)) = (folder(&target), temporary_name(&target));
    let io = |e: io::Error| FilmError::io(folder, e);
    for entry in fs::read_dir(folder).map_err(io)? {
        let entry = entry.map_err(io)?;
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let random = name.strip_prefix(&start).and_then(|rest| rest.strip_suffix(end));
        if random.is_some_and(|r| r.len() == RANDOM && r.bytes().all(|b| b.is_ascii_alphanumeric())) {
            fs::remove_file(entry.path()).map_err(io)?;
        }
    }
    Ok(())
}

/// Characters of a temporary name that are chosen by chance.
const RANDOM: usize = 6;

/// A temporary file beside `target`, with the permissions of a file made in the ordinary way.
fn temporary(target: &Path) -> Result<NamedTempFile, FilmError> {
    let (folder, (start, end)) = (folder(target), temporary_name(target));
    let mut builder = tempfile::Builder::new();
    builder.prefix(&start).rand_bytes(RANDOM).suffix(end);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    // Only the kind of error, because its text would speak of the temporary name.
    builder.tempfile_in(folder).map_err(|e| FilmError::io(folder, e.kind().into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn put(path: &Path, text: &str) -> Result<(), FilmError> {
        write_file(path, text.as_bytes())
    }

    #[test]
    fn files_are_replaced_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture");
        put(&path, "old").unwrap();
        check_writable(&path).unwrap();
        let failed = write_atomically(&path, |f| {
            f.write_all(b"half").unwrap();
            Err(FilmError::Layout("stop".to_owned()))
        });
        assert!(failed.is_err());
        assert_eq!((fs::read_to_string(&path).unwrap().as_str(), names(folder.path()).len()), ("old", 1));
        put(&path, "new").unwrap();
        assert_eq!((fs::read_to_string(&path).unwrap().as_str(), names(folder.path()).len()), ("new", 1));
    }

    #[test]
    fn leftovers_of_a_file_are_removed_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.film");
        put(&path, "film").unwrap();
        let (file, left) = temporary(&path).unwrap().keep().unwrap();
        drop(file);
        let others = [".a.film.abc123.part2", ".b.film.abc123.part", ".a.film.longer1.part", "a.film.part"];
        for other in others {
            put(&folder.path().join(other), "mine").unwrap();
        }
        assert!(left.exists());
        remove_leftovers(&path).unwrap();
        assert!(!left.exists());
        assert_eq!(names(folder.path()).len(), 1 + others.len());
        assert!(remove_leftovers(&folder.path().join("none/a.film")).is_err());
    }

    #[test]
    fn the_check_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        check_writable(&folder.path().join("new.exr")).unwrap();
        assert!(names(folder.path()).is_empty());
    }

    #[test]
    fn impossible_places_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let plain = folder.path().join("plain");
        put(&plain, "x").unwrap();
        let missing = folder.path().join("no-such-folder");
        for (path, named, reason) in [
            (missing.join("a.exr"), missing.clone(), "not found"),
            (plain.join("a.exr"), plain.join("a.exr"), "ot a directory"),
            (folder.path().to_owned(), folder.path().to_owned(), "is a directory"),
        ] {
            for error in [check_writable(&path).unwrap_err(), put(&path, "x").unwrap_err()] {
                let FilmError::Io { path: reported, .. } = &error else { panic!("{error:?}") };
                assert_eq!(reported, &named, "{error}");
                let text = error.to_string();
                assert!(text.contains(reason) && !text.contains(".part"), "{text}");
            }
        }
        assert_eq!(names(folder.path()), ["plain"]);
    }

    #[cfg(unix)]
    #[test]
    fn permissions_are_those_of_an_ordinary_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (ours, ordinary) = (folder.path().join("ours"), folder.path().join("ordinary"));
        put(&ours, "x").unwrap();
        fs::write(&ordinary, "x").unwrap();
        let mode = |p: &Path| fs::metadata(p).unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&ordinary));
    }

    /// A folder without the right to write, except for users to whom that means nothing.
    #[cfg(unix)]
    #[test]
    fn unwritable_folders_are_errors() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).unwrap();
        if fs::write(folder.path().join("probe"), "x").is_err() {
            let error = check_writable(&folder.path().join("a.exr")).unwrap_err();
            assert!(error.to_string().contains("permission denied"), "{error}");
        }
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_devices_refused() {
        let folder = tempfile::tempdir().unwrap();
        let (target, link) = (folder.path().join("target"), folder.path().join("link"));
        put(&target, "old").unwrap();
        std::os::unix::fs::symlink(&target, &link).unwrap();
        put(&link, "new").unwrap();
        assert_eq!(fs::read_to_string(&target).unwrap(), "new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        let error = check_writable(Path::new("/dev/null")).unwrap_err();
        assert!(error.to_string().contains("not an ordinary file"), "{error}");
    }
}
