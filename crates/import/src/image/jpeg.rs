//! JPEG.

use caustica_math::Rgb;
use zune_core::bytestream::ZCursor;
use zune_core::colorspace::ColorSpace;
use zune_core::options::DecoderOptions;
use zune_jpeg::JpegDecoder;

use super::{Fault, Pixels, Room};

/// The most pixels to a bit. Every block of 8 × 8 has a code of at least one bit, and with sampling factors of up
/// to 4 some component has a block for every 16 of the full grid.
const CLOSEST_PACKING: u64 = 64 * 16;

pub(super) fn decode(bytes: &[u8], room: Room) -> Result<Pixels, Fault> {
    // Strict: a file that is cut off is an error, not a picture with a grey part.
    let options = DecoderOptions::default()
        .set_strict_mode(true)
        .set_max_width(usize::from(u16::MAX))
        .set_max_height(usize::from(u16::MAX))
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(|e| e.to_string())?;
    let info = decoder.info().ok_or("it has no header")?;
    let (width, height) = room.check(info.width.into(), info.height.into())?;
    room.holds(u64::from(width) * u64::from(height), CLOSEST_PACKING)?;
    // The coefficients of progressive files are kept beside the colours.
    room.fits((width, height), 9)?;
    let data = decoder.decode().map_err(|e| e.to_string())?;
    let channels = decoder.output_colorspace().map_or(3, |c| c.num_components());
    let count = width as usize * height as usize;
    if data.len() != count * channels || !matches!(channels, 1 | 3) {
        return Err("its colours are stored in a way that is not supported".into());
    }
    let table = room.codes.table(255);
    let value = |p: &[u8], i: usize| table[usize::from(p[i])];
    let pixels = data
        .chunks_exact(channels)
        .map(|p| {
            if channels == 1 {
                Rgb::splat(value(p, 0))
            } else {
                Rgb::new(value(p, 0), value(p, 1), value(p, 2))
            }
        })
        .collect();
    Ok(Pixels { width, height, pixels })
}
