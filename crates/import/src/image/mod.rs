//! Image files to linear RGB.

mod exr;
mod jpeg;
mod png;
mod srgb;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use caustica_math::{MemoryShortage, Rgb};
use caustica_scene::description::Image;
use caustica_scene::memory::shortage;
use caustica_scene::{Diagnostic, MemoryLimit};

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
    read_image_within(path, MemoryLimit::Machine)
}

/// The same in so much memory. An image that would take more is refused when its size is known, before it is decoded.
pub fn read_image_within(path: &Path, memory: MemoryLimit) -> Result<ReadImage, Diagnostic> {
    let fail = |fault: Fault| match fault {
        Fault::File(why) => Diagnostic::error(format!("cannot read the image `{}`: {why}", path.display())),
        Fault::Memory(e) => shortage(&format!("the image `{}`", path.display()), e)
            .hint("make it smaller, or render where there is more memory"),
    };
    let bytes = files::read(path, LARGEST_FILE).map_err(|why| fail(why.into()))?;
    // The decoders are other people's code, and no file may bring the program down.
    let decoded = catch_unwind(AssertUnwindSafe(|| decode(&bytes, memory)))
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

/// Why an image is not read.
enum Fault {
    /// What is wrong with the file.
    File(String),
    /// It does not fit.
    Memory(MemoryShortage),
}

impl From<String> for Fault {
    fn from(why: String) -> Self {
        Self::File(why)
    }
}

impl From<&str> for Fault {
    fn from(why: &str) -> Self {
        Self::File(why.to_owned())
    }
}

/// Whether an image fits that has so many bytes a pixel in what its decoder gives: beside that there are its colours,
/// and, where they are put together, a copy of them.
fn check_memory((width, height): (u32, u32), decoded: u64, memory: MemoryLimit) -> Result<(), Fault> {
    let pixels = u64::from(width) * u64::from(height);
    memory.check(pixels * (decoded + 2 * size_of::<Rgb>() as u64)).map_err(Fault::Memory)
}

fn decode(bytes: &[u8], memory: MemoryLimit) -> Result<Pixels, Fault> {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => png::decode(bytes, memory),
        [0xFF, 0xD8, 0xFF, ..] => jpeg::decode(bytes, memory),
        [0x76, 0x2F, 0x31, 0x01, ..] => exr::decode(bytes, memory),
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
