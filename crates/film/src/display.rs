//! Pictures for displays.

use std::io::{BufWriter, Write};
use std::path::Path;

use caustica_math::Rgb;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::tonemap::{ToneMap, to_display};
use crate::{FilmError, output};

/// How linear light is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Develop {
    /// Powers of two by which the picture is made brighter.
    pub exposure: f32,
    /// How it is brought into the range of a display.
    pub tone_map: ToneMap,
}

/// Writes linear pixels, row by row, as an 8-bit PNG that says it is sRGB.
pub fn write_png(
    path: &Path,
    width: u32,
    height: u32,
    pixels: &[Rgb],
    develop: Develop,
) -> Result<(), FilmError> {
    check_count(width, height, pixels.len())?;
    let bytes: Vec<[u8; 3]> =
        pixels.par_iter().map(|p| to_display(*p, develop.exposure, develop.tone_map)).collect();
    write_srgb_png(path, width, height, &bytes)
}

/// Writes display values, row by row, as an 8-bit PNG that says it is sRGB: the same pixels give the
/// same bytes. The file is replaced whole or not at all.
pub fn write_srgb_png(path: &Path, width: u32, height: u32, pixels: &[[u8; 3]]) -> Result<(), FilmError> {
    check_count(width, height, pixels.len())?;
    output::write_atomically(path, |file| {
        let mut buffered = BufWriter::new(file);
        encode(&mut buffered, width, height, pixels.as_flattened()).map_err(|e| match e {
            png::EncodingError::IoError(e) => FilmError::io(path, e),
            other => FilmError::format(path, other.to_string()),
        })?;
        buffered.flush().map_err(|e| FilmError::io(path, e))
    })
}

fn check_count(width: u32, height: u32, count: usize) -> Result<(), FilmError> {
    if count == 0 || count as u64 != u64::from(width) * u64::from(height) {
        return Err(FilmError::Layout(format!("{count} pixels for a picture of {width} × {height}")));
    }
    Ok(())
}

fn encode(to: impl Write, width: u32, height: u32, bytes: &[u8]) -> Result<(), png::EncodingError> {
    let mut encoder = png::Encoder::new(to, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(bytes)?;
    writer.finish()
}

#[cfg(test)]
mod tests {
    use std::fs::File;
    use std::io::BufReader;

    use super::*;

    #[test]
    fn a_png_round_trips() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.png");
        let pixels =
            [Rgb::BLACK, Rgb::WHITE, Rgb::new(0.18, 0.0, 1.0), Rgb::splat(0.09), Rgb::BLACK, Rgb::WHITE];
        let develop = Develop { exposure: 1.0, tone_map: ToneMap::Srgb };
        write_png(&path, 3, 2, &pixels, develop).unwrap();
        let mut reader = png::Decoder::new(BufReader::new(File::open(&path).unwrap())).read_info().unwrap();
        let info = reader.info();
        assert_eq!((info.width, info.height, info.bit_depth), (3, 2, png::BitDepth::Eight));
        assert_eq!(info.color_type, png::ColorType::Rgb);
        assert_eq!(info.srgb, Some(png::SrgbRenderingIntent::Perceptual));
        let mut bytes = [0; 18];
        reader.next_frame(&mut bytes).unwrap();
        assert_eq!(&bytes[..9], [0, 0, 0, 255, 255, 255, 162, 0, 255]);
        assert_eq!(bytes[9..12], [118; 3]);
        let first = std::fs::read(&path).unwrap();
        write_png(&path, 3, 2, &pixels, develop).unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), first);
    }

    #[test]
    fn sizes_must_fit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.png");
        for (width, height) in [(2, 2), (0, 0), (u32::MAX, u32::MAX)] {
            let error = write_png(&path, width, height, &[Rgb::WHITE; 3], Develop::default()).unwrap_err();
            assert!(matches!(error, FilmError::Layout(_)), "{error:?}");
            let error = write_srgb_png(&path, width, height, &[[255; 3]; 3]).unwrap_err();
            assert!(matches!(error, FilmError::Layout(_)), "{error:?}");
        }
        assert!(matches!(write_png(&path, 0, 7, &[], Develop::default()), Err(FilmError::Layout(_))));
        assert!(!path.exists());
    }
}
