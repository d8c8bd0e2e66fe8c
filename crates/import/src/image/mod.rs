//! Image files to linear RGB.

mod exr;
mod jpeg;
mod png;
mod srgb;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use caustica_math::Rgb;
use caustica_scene::Diagnostic;
use caustica_scene::description::Image;

use crate::files;

/// The most pixels that an image may have.
const MOST_PIXELS: u64 = 1 << 28;

/// The most bytes that an image file may have.
const LARGEST_FILE: u64 = 1 << 30;

/// The largest finite number of OpenEXR's 16-bit floats: what an overflow in one is read as.
const LARGEST_HALF: f32 = 65504.0;

/// An image and what is worth knowing about its file.
#[derive(Clone, Debug)]
pub struct ReadImage {
    /// The image.
    pub image: Image,
    /// What was changed in reading.
    pub warnings: Vec<Diagnostic>,
}

/// Reads a PNG, JPEG or OpenEXR image. The content tells which it is, not the name. PNG and JPEG are
/// taken as sRGB, OpenEXR as linear; transparency is ignored.
pub fn read_image(path: &Path) -> Result<ReadImage, Diagnostic> {
    let fail = |why: String| Diagnostic::error(format!("cannot read the image `{}`: {why}", path.display()));
    let bytes = files::read(path, LARGEST_FILE).map_err(fail)?;
    // The decoders are other people's code, and no file may bring the program down.
    let decoded = catch_unwind(AssertUnwindSafe(|| decode(&bytes)))
        .unwrap_or_else(|_| Err("its decoder failed; the file is damaged".into()));
    let mut image = decoded.map_err(fail)?;
    let changed = image.pixels.iter_mut().flat_map(|p| p.0.iter_mut()).map(clean).filter(|c| *c).count();
    let mut warnings = Vec::new();
    if changed > 0 {
        let message =
            format!("{changed} values of the image `{}` are negative or not finite", path.display());
        warnings.push(
            Diagnostic::warning(message)
                .hint(format!("infinity is read as {LARGEST_HALF}, all others of them as 0")),
        );
    }
    let Pixels { width, height, pixels } = image;
    Ok(ReadImage { image: Image { width, height, pixels: pixels.into() }, warnings })
}

/// What decoders give.
struct Pixels {
    width: u32,
    height: u32,
    pixels: Vec<Rgb>,
}

fn decode(bytes: &[u8]) -> Result<Pixels, String> {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => png::decode(bytes),
        [0xFF, 0xD8, 0xFF, ..] => jpeg::decode(bytes),
        [0x76, 0x2F, 0x31, 0x01, ..] => exr::decode(bytes),
        _ => Err("it is neither PNG nor JPEG nor OpenEXR".into()),
    }
}

/// Refuses sizes that no picture has, before anything is allocated for them.
fn check_size(width: u64, height: u64) -> Result<(u32, u32), String> {
    if width == 0 || height == 0 {
        return Err("it has no pixels".into());
    }
    match (u32::try_from(width), u32::try_from(height), width.checked_mul(height)) {
        (Ok(w), Ok(h), Some(pixels)) if pixels <= MOST_PIXELS => Ok((w, h)),
        _ => Err(format!("{width} × {height} pixels are more than the {MOST_PIXELS} that are taken")),
    }
}

/// Makes a value one that light can have; whether it had to be changed.
fn clean(value: &mut f32) -> bool {
    if value.is_finite() && *value >= 0.0 {
        return false;
    }
    *value = if *value == f32::INFINITY { LARGEST_HALF } else { 0.0 };
    true
}
