use std::ffi::OsStr;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use caustica::Picture;
use caustica::film::{FilmRecord, Metadata, check_writable, read_exr, write_exr};

use crate::args::Develop;
use crate::console::{Console, print};
use crate::failure::Failure;
use crate::{prompt, render};

pub fn run(args: &Develop, _: &Console) -> Result<ExitCode, Failure> {
    let output: PathBuf = args.output.clone().unwrap_or_else(|| args.film.with_extension("png"));
    let to_exr = args.output.as_deref().map_or(Ok(false), is_exr)?;
    let (picture, metadata) = read(&args.film)?;
    check_writable(&output).map_err(|e| Failure::output(&output, e))?;
    let light_image = prompt::light_image(args.light_image, picture.light_samples > 0);
    if to_exr {
        write_exr(&output, &picture, light_image, &metadata).map_err(|e| Failure::output(&output, e))?;
    } else {
        render::save_png(&output, &picture, light_image, args.look)?;
    }
    print(format_args!("wrote {}", output.display()))?;
    Ok(ExitCode::SUCCESS)
}

/// The picture of a film or an OpenEXR file, and what is known about it.
fn read(path: &Path) -> Result<(Picture, Metadata), Failure> {
    let unreadable = |e| Failure::input(path, e);
    if !is_film_file(path) {
        return read_exr(path).map_err(unreadable);
    }
    let FilmRecord { film, facts } = FilmRecord::read(path).map_err(unreadable)?;
    let mut metadata: Metadata = facts.provenance.settings.into_iter().collect();
    metadata.set("scene", facts.provenance.scene);
    metadata.set("seconds", format!("{:.3}", facts.seconds));
    if let Some(bars) = film.error_bars() {
        metadata.set("noise", format!("{:.5}", bars.relative()));
    }
    Ok((film.develop(), metadata))
}

/// Whether a file is a film by its first bytes.
pub fn is_film_file(path: &Path) -> bool {
    let mut start = [0; 16];
    let read = std::fs::metadata(path).is_ok_and(|m| m.is_file())
        && File::open(path).is_ok_and(|mut file| file.read_exact(&mut start).is_ok());
    read && FilmRecord::is_film(&start)
}

/// Whether the output is an OpenEXR file and not a PNG.
fn is_exr(output: &Path) -> Result<bool, Failure> {
    match output.extension().map(OsStr::to_ascii_lowercase).as_deref().and_then(OsStr::to_str) {
        Some("png") => Ok(false),
        Some("exr") => Ok(true),
        _ => Err(Failure::Usage(format!("the output `{}` must end in .png or .exr", output.display()))),
    }
}
