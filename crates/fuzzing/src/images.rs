//! Small images of every kind that is read.

use caustica_math::stream::mix64;
use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    LineOrder, SmallVec, Vec2, WritableImage, f16,
};
use png::{BitDepth, ColorType};

const JPEGS: [&[u8]; 3] = [
    include_bytes!("../../import/tests/data/two_colours.jpg"),
    include_bytes!("../../import/tests/data/two_colours_progressive.jpg"),
    include_bytes!("../../import/tests/data/two_greys.jpg"),
];

/// Images of every format, with every way to store pixels.
pub fn seeds() -> Vec<Vec<u8>> {
    let mut seeds: Vec<Vec<u8>> = JPEGS.iter().map(|bytes| bytes.to_vec()).collect();
    for color in [ColorType::Grayscale, ColorType::GrayscaleAlpha, ColorType::Rgb, ColorType::Rgba] {
        seeds.extend([BitDepth::Eight, BitDepth::Sixteen].map(|depth| png(color, depth)));
    }
    for depth in [BitDepth::One, BitDepth::Two, BitDepth::Four, BitDepth::Eight] {
        seeds.extend([ColorType::Indexed, ColorType::Grayscale].map(|color| png(color, depth)));
    }
    for compression in COMPRESSIONS {
        for blocks in [Blocks::ScanLines, Blocks::Tiles(Vec2(4, 4))] {
            seeds.push(exr(
                &["R", "G", "B"],
                Encoding { compression, blocks, line_order: LineOrder::Increasing },
            ));
        }
    }
    seeds.push(exr(&["Y"], Encoding::UNCOMPRESSED));
    seeds
}

const COMPRESSIONS: [Compression; 8] = [
    Compression::Uncompressed,
    Compression::RLE,
    Compression::ZIP1,
    Compression::ZIP16,
    Compression::PIZ,
    Compression::PXR24,
    Compression::B44,
    Compression::B44A,
];

/// Those that scenes name.
pub fn named() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("tile.png", png(ColorType::Rgb, BitDepth::Eight)),
        ("tile.jpg", JPEGS[0].to_vec()),
        ("sky.exr", exr(&["R", "G", "B"], Encoding::SMALL_LOSSLESS)),
    ]
}

fn noise(index: usize) -> u8 {
    mix64(index as u64) as u8
}

/// 8 × 8 pixels.
fn png(color: ColorType, depth: BitDepth) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 8, 8);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let bits = color.samples() * depth as usize;
    if color == ColorType::Indexed {
        encoder.set_palette((0..3 << (depth as usize)).map(noise).collect::<Vec<u8>>());
        encoder.set_trns(vec![0, 255]);
    }
    let data: Vec<u8> = (0..8 * bits).map(noise).collect();
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&data)).expect("a small image");
    bytes
}

/// 8 × 6 pixels in channels of halves, floats and whole numbers in turn.
fn exr(names: &[&str], encoding: Encoding) -> Vec<u8> {
    let floats = || (0..48).map(|i| f32::from(noise(i)) / 64.0);
    let channel = |(i, name): (usize, &&str)| {
        let samples = match i {
            0 => FlatSamples::F16(floats().map(f16::from_f32).collect()),
            1 => FlatSamples::F32(floats().collect()),
            _ => FlatSamples::U32((0..48).map(|i| u32::from(noise(i))).collect()),
        };
        AnyChannel::new(*name, samples)
    };
    let list: SmallVec<[AnyChannel<FlatSamples>; 4]> = names.iter().enumerate().map(channel).collect();
    let attributes = LayerAttributes::named("first");
    let layer = Layer::new((8, 6), attributes, encoding, AnyChannels::sort(list));
    let mut bytes = std::io::Cursor::new(Vec::new());
    Image::from_layer(layer).write().non_parallel().to_buffered(&mut bytes).expect("a small image");
    bytes.into_inner()
}

/// Sets the checksums of all chunks right, so that what is in them is looked at.
pub fn repair_png(data: &mut [u8]) {
    if !data.starts_with(&[0x89, b'P', b'N', b'G']) {
        return;
    }
    let mut at = 8;
    while let Some(head) = data.get(at..at + 8) {
        let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
        let Some(body) = data.get(at + 4..at + 8 + length) else { return };
        let sum = crc(body).to_be_bytes();
        let Some(place) = data.get_mut(at + 8 + length..at + 12 + length) else { return };
        place.copy_from_slice(&sum);
        at += 12 + length;
    }
}

/// The checksum of PNG (ISO/IEC 15948, annex D).
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { 0xEDB8_8320 ^ (c >> 1) } else { c >> 1 })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_seed_is_read() {
        for (i, seed) in seeds().iter().enumerate() {
            caustica_import::decode_image(seed, "seed").unwrap_or_else(|e| panic!("seed {i}: {e}"));
        }
    }

    #[test]
    fn repaired_is_as_written() {
        let whole = png(ColorType::Rgb, BitDepth::Eight);
        let mut damaged = whole.clone();
        damaged[29..33].fill(0);
        repair_png(&mut damaged);
        assert_eq!(damaged, whole);
    }
}
