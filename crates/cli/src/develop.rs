use std::path::PathBuf;
use std::process::ExitCode;

use caustica::film::{self, read_exr, write_exr, write_png};

use crate::args::Develop;
use crate::failure::Failure;
use crate::prompt;

pub fn run(args: &Develop) -> Result<ExitCode, Failure> {
    let (picture, metadata) = read_exr(&args.film).map_err(Failure::input)?;
    let output: PathBuf = args.output.clone().unwrap_or_else(|| args.film.with_extension("png"));
    let light_image = prompt::light_image(args.light_image);
    match output.extension().and_then(|e| e.to_str()) {
        Some("png") => {
            let develop = film::Develop { exposure: args.look.exposure, tone_map: args.look.tone_map };
            let (w, pixels) = (picture.window, picture.combined(light_image));
            write_png(&output, w.width, w.height, &pixels, develop)
        }
        Some("exr") => write_exr(&output, &picture, light_image, &metadata),
        _ => {
            return Err(Failure::Usage(format!("`{}` must end in .png or .exr", output.display())));
        }
    }
    .map_err(Failure::output)?;
    println!("wrote {}", output.display());
    Ok(ExitCode::SUCCESS)
}
