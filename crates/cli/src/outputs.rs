use std::path::{Path, PathBuf};

use caustica::film::{FilmFacts, FilmLayout, FilmRecord, check_writable};

use crate::args::Render;
use crate::failure::{Failure, reason};

/// Extensions of pictures that are not written.
const OTHER_PICTURES: [&str; 10] = ["jpg", "jpeg", "tif", "tiff", "bmp", "gif", "webp", "hdr", "pfm", "ppm"];

/// The files that a render writes.
#[derive(Debug, PartialEq, Eq)]
pub enum Outputs {
    /// What it looks like, with all layers and to look at.
    Pictures { exr: PathBuf, png: PathBuf },
    /// A film that can be merged with others.
    Film(PathBuf),
}

impl Outputs {
    /// The files that the arguments ask for; all can be written.
    pub fn new(args: &Render) -> Result<Self, Failure> {
        let stem = match (&args.output, &args.source.scene) {
            (Some(output), _) => stem(output)?,
            (None, Some(scene)) => scene.with_extension(""),
            (None, None) => PathBuf::from("caustica"),
        };
        let outputs = match &args.output {
            Some(film) if is_film(film) => Self::Film(film.clone()),
            _ => Self::Pictures { exr: with(&stem, ".exr"), png: with(&stem, ".png") },
        };
        for file in outputs.files() {
            check_writable(file).map_err(|e| Failure::output(file, e))?;
        }
        Ok(outputs)
    }

    /// All of them.
    pub fn files(&self) -> Vec<&Path> {
        match self {
            Self::Pictures { exr, png } => vec![exr, png],
            Self::Film(film) => vec![film],
        }
    }
}

/// Whether a file is a film by its name.
pub fn is_film(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("film"))
}

/// Refuses to replace a film whose samples would be lost, which may be the work of hours: one of something else, or of
/// samples that the new one does not have. A film that can be made again by the same command can be replaced.
///
/// # Errors
/// What would be lost.
pub fn check_replaceable(path: &Path, (layout, facts): (&FilmLayout, &FilmFacts)) -> Result<(), Failure> {
    if !path.metadata().is_ok_and(|there| there.is_file() && there.len() > 0) {
        return Ok(());
    }
    let lost = match FilmRecord::read_facts(path) {
        Err(e) => format!("is no film ({})", reason(&e, "it is gone")),
        Ok((other, _)) if other != *layout => format!("is a film of {other}, not of {layout}"),
        Ok((_, other)) => match other.provenance.difference(&facts.provenance) {
            Some(what) => format!("is another film: they differ in {what}"),
            None if facts.samples.contains(&other.samples) => return Ok(()),
            None => format!("holds the samples {}, not all of which the new one has", other.samples),
        },
    };
    Err(Failure::Output(format!(
        "`{}` is there and {lost}: choose another name, or replace it by `--force`",
        path.display()
    )))
}

/// The output without its extension, if it is a picture's.
fn stem(output: &Path) -> Result<PathBuf, Failure> {
    let shown = output.display();
    let ends_in_slash = output.as_os_str().as_encoded_bytes().last().is_none_or(|b| *b == b'/');
    if output.is_dir() || ends_in_slash || output.file_name().is_none() {
        return Err(Failure::Output(format!("cannot write `{shown}`: it is a folder, so name a file in it")));
    }
    let extension = output.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    match extension.as_deref() {
        Some("exr" | "png") => Ok(output.with_extension("")),
        Some(other) if OTHER_PICTURES.contains(&other) => Err(Failure::Usage(format!(
            "`{shown}` cannot be written: pictures are OpenEXR and PNG files, so leave out `.{other}`"
        ))),
        _ => Ok(output.to_owned()),
    }
}

fn with(stem: &Path, extension: &str) -> PathBuf {
    let mut name = stem.as_os_str().to_owned();
    name.push(extension);
    name.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_extensions_of_pictures_are_cut_off() {
        for (given, expected) in
            [("a.exr", "a"), ("a.PNG", "a"), ("b/a", "b/a"), ("a.v2", "a.v2"), ("a.v2.exr", "a.v2")]
        {
            assert_eq!(stem(Path::new(given)).unwrap(), PathBuf::from(expected));
        }
        assert_eq!(with(Path::new("a.v2"), ".exr"), PathBuf::from("a.v2.exr"));
        assert!(matches!(stem(Path::new("a.jpg")), Err(Failure::Usage(_))));
        for folder in ["", ".", "..", "/", "none/"] {
            assert!(matches!(stem(Path::new(folder)), Err(Failure::Output(_))), "{folder}");
        }
    }
}
