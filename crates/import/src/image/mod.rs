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
    read_within(path, (MOST_PIXELS, Codes::Srgb), memory)
}

/// The same of the bytes of a file; `file_name` is for messages.
pub fn decode_image(bytes: &[u8], file_name: &str) -> Result<ReadImage, Diagnostic> {
    let (pixels, memory) = (MOST_PIXELS, MemoryLimit::Machine);
    let room = Room { file: bytes.len() as u64, pixels, memory, codes: Codes::Srgb };
    decode_within(bytes, file_name, room)
}

/// What the codes of PNG and JPEG files are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Codes {
    /// Colours by sRGB's curve.
    Srgb,
    /// Values from 0 to 1.
    Raw,
}

impl Codes {
    /// The linear values of all codes up to `largest`.
    fn table(self, largest: u16) -> Vec<f32> {
        match self {
            Self::Srgb => srgb::table(largest),
            Self::Raw => (0..=largest).map(|code| f32::from(code) / f32::from(largest)).collect(),
        }
    }
}

/// Reads an image of at most so many pixels.
pub(crate) fn read_within(
    path: &Path,
    (most_pixels, codes): (u64, Codes),
    memory: MemoryLimit,
) -> Result<ReadImage, Diagnostic> {
    let name = path.display().to_string();
    let bytes = files::read(path, LARGEST_FILE).map_err(|why| cannot_read(&name, why.into()))?;
    let room = Room { file: bytes.len() as u64, pixels: most_pixels.min(MOST_PIXELS), memory, codes };
    decode_within(&bytes, &name, room)
}

fn decode_within(bytes: &[u8], file_name: &str, room: Room) -> Result<ReadImage, Diagnostic> {
    // The decoders are other people's code, and no file may bring the program down.
    let decoded = catch_unwind(AssertUnwindSafe(|| decode(bytes, room)))
        .unwrap_or_else(|_| Err("its decoder failed; the file is damaged".into()));
    let mut image = decoded.map_err(|fault| cannot_read(file_name, fault))?;
    let changed = image.pixels.iter_mut().flat_map(|p| p.0.iter_mut()).map(clean).filter(|c| *c).count();
    let mut warnings = Vec::new();
    if changed > 0 {
        let message = format!("{changed} values of the image `{file_name}` are negative or not finite");
        warnings.push(
            Diagnostic::warning(message)
                .hint(format!("infinity is read as {LARGEST_HALF}, all others of them as 0")),
        );
    }
    let Pixels { width, height, pixels } = image;
    Ok(ReadImage { image: Image { width, height, pixels: pixels.into() }, warnings })
}

fn cannot_read(name: &str, fault: Fault) -> Diagnostic {
    match fault {
        Fault::File(why) => Diagnostic::error(format!("cannot read the image `{name}`: {why}")),
        Fault::Memory(e) => shortage(&format!("the image `{name}`"), e)
            .hint("make it smaller, or render where there is more memory"),
    }
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

fn decode(bytes: &[u8], room: Room) -> Result<Pixels, Fault> {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => png::decode(bytes, room),
        [0xFF, 0xD8, 0xFF, ..] => jpeg::decode(bytes, room),
        [0x76, 0x2F, 0x31, 0x01, ..] => exr::decode(bytes, room),
        _ => Err("it is neither PNG nor JPEG nor OpenEXR".into()),
    }
}

/// What limits the size of an image.
#[derive(Clone, Copy)]
struct Room {
    /// Length of the file in bytes.
    file: u64,
    /// The most pixels that are taken.
    pixels: u64,
    /// What there is for it.
    memory: MemoryLimit,
    /// How it is read.
    codes: Codes,
}

impl Room {
    /// Refuses sizes that no picture has, before anything is allocated for them.
    fn check(self, width: u64, height: u64) -> Result<(u32, u32), String> {
        if width == 0 || height == 0 {
            return Err("it has no pixels".into());
        }
        match (u32::try_from(width), u32::try_from(height), width.checked_mul(height)) {
            (Ok(w), Ok(h), Some(pixels)) if pixels <= self.pixels => Ok((w, h)),
            _ => Err(format!("{width} × {height} pixels are more than the {} that are taken", self.pixels)),
        }
    }

    /// Whether an image fits that has so many bytes a pixel in what its decoder gives: beside that there are its
    /// colours, and, where they are put together, a copy of them.
    fn fits(self, (width, height): (u32, u32), decoded: u64) -> Result<(), Fault> {
        let pixels = u64::from(width) * u64::from(height);
        self.memory.check(pixels * (decoded + 2 * size_of::<Rgb>() as u64)).map_err(Fault::Memory)
    }

    /// Refuses so many bits of pixels, of which the format cannot pack more than `closest` into one bit.
    fn holds(self, bits: u64, closest: u64) -> Result<(), String> {
        let most = self.file.saturating_mul(8).saturating_mul(closest);
        if bits <= most { Ok(()) } else { Err("it is cut off, or its size is wrong".into()) }
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
