//! PNG.

use std::io::Cursor;

use caustica_math::Rgb;
use png::{BitDepth, ColorType, Decoder, Limits, Transformations};

use super::{Fault, Pixels, Room};

/// Deflate cannot shrink data by more than this factor.
const BEST_COMPRESSION: u64 = 1032;

pub(super) fn decode(bytes: &[u8], room: Room) -> Result<Pixels, Fault> {
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: 1 << 30 });
    // Palettes become colours, and 1, 2 and 4 bits become 8; 16 stay.
    decoder.set_transformations(Transformations::EXPAND);
    let header = decoder.read_header_info().map_err(|e| e.to_string())?;
    let (width, height) = room.check(header.width.into(), header.height.into())?;
    room.holds(u64::from(width) * u64::from(height) * header.bits_per_pixel() as u64, BEST_COMPRESSION)?;
    room.fits((width, height), (header.bits_per_pixel() as u64).div_ceil(8).max(4))?;
    let mut reader = decoder.read_info().map_err(|e| e.to_string())?;
    let size = reader.output_buffer_size().ok_or("it is too large")?;
    let mut buffer = vec![0; size];
    let frame = reader.next_frame(&mut buffer).map_err(|e| e.to_string())?;
    let channels = match frame.color_type {
        ColorType::Grayscale => 1,
        ColorType::GrayscaleAlpha => 2,
        ColorType::Rgb => 3,
        ColorType::Rgba => 4,
        ColorType::Indexed => return Err("its palette is missing".into()),
    };
    let data = &buffer[..frame.buffer_size()];
    let pixels = match frame.bit_depth {
        BitDepth::Sixteen => {
            let table = room.codes.table(u16::MAX);
            let value = |p: &[u8], i: usize| table[usize::from(u16::from_be_bytes([p[2 * i], p[2 * i + 1]]))];
            data.chunks_exact(2 * channels).map(|p| rgb(channels, |i| value(p, i))).collect()
        }
        _ => {
            let table = room.codes.table(255);
            data.chunks_exact(channels).map(|p| rgb(channels, |i| table[usize::from(p[i])])).collect()
        }
    };
    Ok(Pixels { width, height, pixels })
}

fn rgb(channels: usize, value: impl Fn(usize) -> f32) -> Rgb {
    if channels < 3 { Rgb::splat(value(0)) } else { Rgb::new(value(0), value(1), value(2)) }
}
