//! Images as text in a page.
//!
//! Linear light becomes half floats. Their bit patterns grow like logarithms, so that noise which is alike
//! in all channels cancels in the differences to green. Each channel is predicted from the pixels on the
//! left and above; the rests go, high bytes before low bytes, through zlib and base64.
//! `templates/codec.js` undoes all that.

use std::io::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use caustica_math::Rgb;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use half::f16;

/// Linear pixels, row by row, as halves. What is finite stays finite: it is clamped to ±65504.
pub fn encode_rgb(pixels: &[Rgb], width: u32) -> String {
    let halves: Vec<[u16; 3]> = pixels.iter().map(|p| p.0.map(to_half)).collect();
    let green = halves.iter().map(|[_, g, _]| *g).collect();
    let red = halves.iter().map(|[r, g, _]| r.wrapping_sub(*g)).collect();
    let blue = halves.iter().map(|[_, g, b]| b.wrapping_sub(*g)).collect();
    pack(&[green, red, blue], width as usize)
}

/// Values in [0, 1] in steps of 1/255. NaN becomes 1: the worst error.
pub fn encode_unit(values: &[f32], width: u32) -> String {
    let byte = |v: &f32| if v.is_nan() { 255 } else { (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u16 };
    pack(&[values.iter().map(byte).collect()], width as usize)
}

fn to_half(value: f32) -> u16 {
    let value = if value.is_finite() { value.clamp(-65504.0, 65504.0) } else { value };
    f16::from_f32(value).to_bits()
}

fn pack(planes: &[Vec<u16>], width: usize) -> String {
    let mut bytes = Vec::with_capacity(planes.iter().map(|p| 2 * p.len()).sum());
    for plane in planes {
        let rests = rests(plane, width);
        bytes.extend(rests.iter().map(|r| r.to_be_bytes()[0]));
        bytes.extend(rests.iter().map(|r| r.to_be_bytes()[1]));
    }
    let mut zlib = ZlibEncoder::new(Vec::new(), Compression::default());
    zlib.write_all(&bytes).and_then(|()| zlib.finish()).map(|z| STANDARD.encode(z)).expect("memory takes all")
}

/// What is left of each value after prediction, signs folded so that small rests have empty high bytes.
fn rests(plane: &[u16], width: usize) -> Vec<u16> {
    let rest = |i: usize| {
        let difference = plane[i].wrapping_sub(predict(plane, i, width)) as i16;
        ((difference << 1) ^ (difference >> 15)) as u16
    };
    (0..plane.len()).map(rest).collect()
}

/// The mean of the left and the upper neighbour, as signed numbers; one of them at the edges.
fn predict(plane: &[u16], i: usize, width: usize) -> u16 {
    let signed = |i: usize| i32::from(plane[i] as i16);
    match (!i.is_multiple_of(width), i >= width) {
        (true, true) => ((signed(i - 1) + signed(i - width)) >> 1) as u16,
        (true, false) => plane[i - 1],
        (false, true) => plane[i - width],
        (false, false) => 0,
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::*;

    /// The planes that `pack` was given.
    fn unpack(text: &str, width: usize, count: usize) -> Vec<Vec<u16>> {
        let mut bytes = Vec::new();
        let zipped = STANDARD.decode(text).unwrap();
        flate2::read::ZlibDecoder::new(&zipped[..]).read_to_end(&mut bytes).unwrap();
        assert_eq!(bytes.len() % (2 * count), 0);
        let undo = |halves: &[u8]| {
            let (high, low) = halves.split_at(count);
            let mut plane = vec![0; count];
            for i in 0..count {
                let folded = u16::from_be_bytes([high[i], low[i]]);
                let rest = (folded >> 1) ^ (folded & 1).wrapping_neg();
                plane[i] = rest.wrapping_add(predict(&plane, i, width));
            }
            plane
        };
        bytes.chunks(2 * count).map(undo).collect()
    }

    fn decode_rgb(text: &str, width: usize, count: usize) -> Vec<[f32; 3]> {
        let planes = unpack(text, width, count);
        let pixel = |i: usize| {
            let g = planes[0][i];
            [planes[1][i].wrapping_add(g), g, planes[2][i].wrapping_add(g)]
                .map(|h| f16::from_bits(h).to_f32())
        };
        (0..count).map(pixel).collect()
    }

    #[test]
    fn all_halves_survive() {
        // Each bit pattern once in each channel, with neighbours far away.
        let pixel = |i: u32| Rgb([i, i.wrapping_mul(40_503), i.wrapping_mul(9_001)].map(half_value));
        let pixels: Vec<Rgb> = (0..65_536).map(pixel).collect();
        let decoded = decode_rgb(&encode_rgb(&pixels, 256), 256, pixels.len());
        for (before, after) in pixels.iter().zip(&decoded) {
            for (b, a) in before.0.iter().zip(after) {
                assert!(b.to_bits() == a.to_bits() || b.is_nan() && a.is_nan(), "{b} became {a}");
            }
        }
    }

    fn half_value(bits: u32) -> f32 {
        f16::from_bits(bits as u16).to_f32()
    }

    #[test]
    fn floats_are_rounded_to_the_nearest_half_and_stay_finite() {
        let pixels = [Rgb::new(0.1, 1e9, -1e9), Rgb::new(f32::NAN, f32::INFINITY, 1e-9)];
        let decoded = decode_rgb(&encode_rgb(&pixels, 2), 2, 2);
        assert!((decoded[0][0] - 0.1).abs() < 0.1 / 2048.0);
        assert_eq!(decoded[0][1..], [65504.0, -65504.0]);
        assert!(decoded[1][0].is_nan());
        assert_eq!(decoded[1][1..], [f32::INFINITY, 0.0]);
    }

    #[test]
    fn error_maps_are_bytes() {
        let map = [0.0, 0.5, 1.0, 7.0, f32::NAN, -1.0];
        assert_eq!(unpack(&encode_unit(&map, 3), 3, 6), [vec![0, 128, 255, 255, 255, 0]]);
    }
}
