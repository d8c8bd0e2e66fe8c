use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use caustica::film::{check_writable, read_exr, write_exr};

use crate::args::Develop;
use crate::console::{Console, print};
use crate::failure::Failure;
use crate::{prompt, render};

pub fn run(args: &Develop, _: &Console) -> Result<ExitCode, Failure> {
    let output: PathBuf = args.output.clone().unwrap_or_else(|| args.film.with_extension("png"));
    let to_exr = args.output.as_deref().map_or(Ok(false), is_exr)?;
    let (picture, metadata) = read_exr(&args.film).map_err(|e| Failure::input(&args.film, e))?;
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

/// Whether the output is an OpenEXR file and not a PNG.
fn is_exr(output: &Path) -> Result<bool, Failure> {
    match output.extension().map(OsStr::to_ascii_lowercase).as_deref().and_then(OsStr::to_str) {
        Some("png") => Ok(false),
        Some("exr") => Ok(true),
        _ => Err(Failure::Usage(format!("the output `{}` must end in .png or .exr", output.display()))),
    }
}
