//! Images.

use std::path::{Path, PathBuf};

use caustica_import::{Trust, parse_nori, read_image};
use caustica_math::Rgb;
use caustica_scene::description::{Image, LightKind, MaterialKind, Texture};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, LayerAttributes, SmallVec, WritableImage,
};
use tempfile::TempDir;

fn write(folder: &TempDir, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

fn read(bytes: &[u8]) -> Result<Image, String> {
    let folder = tempfile::tempdir().unwrap();
    // The name says nothing about the content.
    let path = write(&folder, "image.bin", bytes);
    let read = read_image(&path).map_err(|e| e.to_string())?;
    assert_eq!(read.warnings, []);
    Ok(read.image)
}

fn close(a: Rgb, b: [f32; 3], tolerance: f32) -> bool {
    a.0.iter().zip(b).all(|(x, y)| (x - y).abs() <= tolerance)
}

fn png(color: png::ColorType, depth: png::BitDepth, size: (u32, u32), data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size.0, size.1);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if color == png::ColorType::Indexed {
        encoder.set_palette(vec![0, 0, 0, 255, 128, 0]);
        encoder.set_trns(vec![0, 255]);
    }
    encoder.write_header().unwrap().write_image_data(data).unwrap();
    bytes
}

/// What 128 of 255 is in linear light.
const MIDDLE: f32 = 0.215_860_5;

#[test]
fn all_kinds_of_png() {
    use png::{BitDepth::*, ColorType::*};
    for (color, depth, data, expected) in [
        (Grayscale, Eight, &[128_u8, 255] as &[u8], [[MIDDLE; 3], [1.0; 3]]),
        (Grayscale, One, &[0b0100_0000], [[0.0; 3], [1.0; 3]]),
        (Grayscale, Sixteen, &[0x80, 0x80, 0xFF, 0xFF], [[MIDDLE; 3], [1.0; 3]]),
        (GrayscaleAlpha, Eight, &[128, 0, 255, 9], [[MIDDLE; 3], [1.0; 3]]),
        (Rgb, Eight, &[255, 128, 0, 0, 0, 255], [[1.0, MIDDLE, 0.0], [0.0, 0.0, 1.0]]),
        (Rgba, Eight, &[255, 128, 0, 0, 0, 0, 255, 7], [[1.0, MIDDLE, 0.0], [0.0, 0.0, 1.0]]),
        (Indexed, Eight, &[1, 0], [[1.0, MIDDLE, 0.0], [0.0; 3]]),
        (
            Rgb,
            Sixteen,
            &[255, 255, 0x80, 0x80, 0, 0, 0, 0, 0, 0, 255, 255],
            [[1.0, MIDDLE, 0.0], [0.0, 0.0, 1.0]],
        ),
    ] {
        let image = read(&png(color, depth, (2, 1), data)).unwrap();
        assert_eq!((image.width, image.height), (2, 1));
        for (pixel, expected) in image.pixels.iter().zip(expected) {
            assert!(close(*pixel, expected, 1e-6), "{color:?} {depth:?}: {pixel:?}");
        }
    }
}

#[test]
fn rows_start_at_the_top() {
    let image = read(&png(png::ColorType::Grayscale, png::BitDepth::Eight, (1, 2), &[255, 0])).unwrap();
    assert_eq!(image.pixels[..], [Rgb::WHITE, Rgb::BLACK]);
}

const COLOURS: &[u8] = include_bytes!("../data/two_colours.jpg");
const PROGRESSIVE: &[u8] = include_bytes!("../data/two_colours_progressive.jpg");
const GREYS: &[u8] = include_bytes!("../data/two_greys.jpg");

#[test]
fn jpegs() {
    // (200, 100, 50) on the left and (10, 220, 128) on the right, within the losses of the format.
    for bytes in [COLOURS, PROGRESSIVE] {
        let image = read(bytes).unwrap();
        assert_eq!((image.width, image.height), (24, 16));
        assert!(close(image.pixels[2], [0.5776, 0.1274, 0.0319], 0.01), "{:?}", image.pixels[2]);
        assert!(close(image.pixels[20], [0.0030, 0.7157, MIDDLE], 0.01), "{:?}", image.pixels[20]);
    }
    let image = read(GREYS).unwrap();
    let [r, g, b] = image.pixels[2].0;
    assert!(r == g && g == b && (r - 0.206).abs() < 0.01, "{r}");
}

fn exr(channels: &[(&str, FlatSamples)]) -> Vec<u8> {
    let list: SmallVec<[AnyChannel<FlatSamples>; 4]> =
        channels.iter().map(|(name, samples)| AnyChannel::new(*name, samples.clone())).collect();
    let layer = exr::prelude::Layer::new(
        (2, 1),
        LayerAttributes::named("first"),
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(list),
    );
    let mut bytes = std::io::Cursor::new(Vec::new());
    exr::prelude::Image::from_layer(layer).write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

fn floats(values: [f32; 2]) -> FlatSamples {
    FlatSamples::F32(values.to_vec())
}

#[test]
fn exrs() {
    let channels = [("R", [0.5, 7.0]), ("G", [0.25, 1e9]), ("B", [0.0, 1e-9]), ("A", [0.0, 0.0])];
    let bytes = exr(&channels.map(|(name, values)| (name, floats(values))));
    let image = read(&bytes).unwrap();
    assert_eq!(image.pixels[..], [Rgb::new(0.5, 0.25, 0.0), Rgb::new(7.0, 1e9, 1e-9)]);
    let halves = [0.5, 3.0].map(exr::prelude::f16::from_f32).to_vec();
    let image = read(&exr(&[("Y", FlatSamples::F16(halves))])).unwrap();
    assert_eq!(image.pixels[..], [Rgb::splat(0.5), Rgb::splat(3.0)]);
    let error = read(&exr(&[("Z", floats([1.0, 2.0]))])).unwrap_err();
    assert!(error.contains("neither R, G, B nor Y, but Z"), "{error}");
}

#[test]
fn values_that_light_cannot_have() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = exr(&[
        ("R", floats([f32::NAN, 1.0])),
        ("G", floats([-1.0, 1.0])),
        ("B", floats([f32::INFINITY, 1.0])),
    ]);
    let read = read_image(&write(&folder, "a.exr", &bytes)).unwrap();
    assert_eq!(read.image.pixels[..], [Rgb::new(0.0, 0.0, 65504.0), Rgb::WHITE]);
    assert!(read.warnings[0].message.starts_with("3 values"), "{:?}", read.warnings);
}

fn samples() -> Vec<Vec<u8>> {
    let data: Vec<u8> = (0..16 * 16 * 3).map(|i| (i * 37 % 251) as u8).collect();
    let png = png(png::ColorType::Rgb, png::BitDepth::Eight, (16, 16), &data);
    let exr = exr(&["R", "G", "B"].map(|name| (name, floats([0.3, 0.7]))));
    vec![png, exr, COLOURS.to_vec(), PROGRESSIVE.to_vec(), GREYS.to_vec()]
}

#[test]
fn files_that_are_cut_off_are_errors() {
    for bytes in samples() {
        read(&bytes).unwrap();
        // The last bytes may be a mark of the end that carries nothing.
        for length in (0..bytes.len() - 16).step_by(1 + bytes.len() / 150) {
            assert!(read(&bytes[..length]).is_err(), "{length} of {} bytes: {:?}", bytes.len(), &bytes[..4]);
        }
    }
}

#[test]
fn damaged_files_do_no_harm() {
    for bytes in samples() {
        for at in (0..bytes.len()).step_by(1 + bytes.len() / 150) {
            for value in [0, 0x7F, 0xFF] {
                let mut damaged = bytes.clone();
                damaged[at] = value;
                let folder = tempfile::tempdir().unwrap();
                let _ = read_image(&write(&folder, "image", &damaged));
            }
        }
    }
}

#[test]
fn sizes_are_checked_before_memory_is_taken() {
    let mut bytes = png(png::ColorType::Grayscale, png::BitDepth::Eight, (1, 1), &[0]);
    bytes[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]);
    let sum = crc(&bytes[12..29]);
    bytes[29..33].copy_from_slice(&sum.to_be_bytes());
    let error = read(&bytes).unwrap_err();
    assert!(error.contains("65536 × 65536 pixels are more than"), "{error}");
    bytes[16..24].copy_from_slice(&[0, 0, 0x40, 0, 0, 0, 0x40, 0]);
    let sum = crc(&bytes[12..29]);
    bytes[29..33].copy_from_slice(&sum.to_be_bytes());
    let error = read(&bytes).unwrap_err();
    assert!(error.contains("cut off, or its size is wrong"), "{error}");
}

/// The checksum of PNG.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { 0xEDB8_8320 ^ (c >> 1) } else { c >> 1 })
    })
}

/// 2²⁶ pixels: by two images, or by one.
#[test]
fn untrusted_scenes_have_fewer_pixels() {
    let folder = tempfile::tempdir().unwrap();
    let mut huge = png(png::ColorType::Grayscale, png::BitDepth::Eight, (1, 1), &[0]);
    huge[16..24].copy_from_slice(&[0, 0, 0x20, 0, 0, 0, 0x20, 0]);
    let sum = crc(&huge[12..29]);
    huge[29..33].copy_from_slice(&sum.to_be_bytes());
    write(&folder, "huge.png", &huge);
    write(&folder, "dot.png", &png(png::ColorType::Grayscale, png::BitDepth::Eight, (1, 1), &[0]));
    let read = |names: &[&str], trust| {
        let lamp = |n| format!("<emitter type='envmap'><string name='filename' value='{n}'/></emitter>");
        let lamps: String = names.iter().map(lamp).collect();
        let text = format!("<scene><camera type='perspective'/><integrator type='path'/>{lamps}</scene>");
        caustica_import::parse_nori_with(&text, "s.xml", folder.path(), trust).unwrap_err()
    };
    // The file is too short for its size in any case: the limit is asked first.
    for (names, trust, words) in [
        (&["huge.png"][..], Trust::OwnFolder, "cut off, or its size is wrong"),
        (&["dot.png", "huge.png"], Trust::Full, "cut off, or its size is wrong"),
        (&["dot.png", "huge.png"], Trust::OwnFolder, "8192 × 8192 pixels are more than the 67108863"),
    ] {
        let error = read(names, trust);
        assert!(error.message.contains(words) && error.origin.is_some(), "{error}");
    }
}

/// Found by fuzzing: a block of B44 made the decoder panic on a thread of its own, which ended the process.
#[test]
fn a_decoder_that_panics_is_an_error() {
    let halves = || FlatSamples::F16(vec![exr::prelude::f16::ONE; 16]);
    let list = ["R", "G", "B"].map(|name| AnyChannel::new(name, halves()));
    let encoding = Encoding { compression: exr::prelude::Compression::B44, ..Encoding::UNCOMPRESSED };
    let attributes = LayerAttributes::named("first");
    let channels = AnyChannels::sort(list.into_iter().collect());
    let layer = exr::prelude::Layer::new((4, 4), attributes, encoding, channels);
    let mut bytes = std::io::Cursor::new(Vec::new());
    exr::prelude::Image::from_layer(layer).write().to_buffered(&mut bytes).unwrap();
    let mut bytes = bytes.into_inner();
    // Differences below zero: the decoder's arithmetic wraps around, or panics where that is checked.
    let last_block = bytes.len() - 14;
    bytes[last_block..].fill(0);
    if let Err(error) = read(&bytes) {
        assert!(error.contains("its decoder failed"), "{error}");
    }
}

/// Found by reading: a header of a few bytes asked for gigabytes.
#[test]
fn no_format_packs_pixels_closer_than_it_can() {
    let mut jpeg = COLOURS.to_vec();
    let frame = jpeg.windows(2).position(|w| w == [0xFF, 0xC0]).unwrap();
    jpeg[frame + 5..frame + 9].copy_from_slice(&[0x3F, 0xFF, 0x3F, 0xFF]);
    assert!(read(&jpeg).unwrap_err().contains("cut off, or its size is wrong"));
    let mut exr = exr(&[("Y", floats([0.5, 1.0]))]);
    let name = b"dataWindow\0box2i\0";
    let window = exr.windows(name.len()).position(|w| w == name).unwrap() + name.len() + 4;
    exr[window + 8..window + 16].copy_from_slice(&[0xFF, 0x3F, 0, 0, 0xFF, 0x3F, 0, 0]);
    assert!(read(&exr).unwrap_err().contains("cut off, or its size is wrong"));
}

#[test]
fn what_is_no_image() {
    assert!(read(b"hello").unwrap_err().contains("neither PNG nor JPEG nor OpenEXR"));
    assert!(read(b"").unwrap_err().contains("neither"));
    let error = read_image(Path::new("/nowhere/a.png")).unwrap_err();
    assert_eq!(error.message, "cannot read the image `/nowhere/a.png`: there is no such file");
    assert!(read_image(Path::new("/")).unwrap_err().message.contains("not a regular file"));
}

#[test]
fn an_image_named_twice_is_one() {
    let folder = tempfile::tempdir().unwrap();
    write(&folder, "a.png", &png(png::ColorType::Grayscale, png::BitDepth::Eight, (1, 1), &[255]));
    let text = "<scene><camera type='perspective'/><integrator type='path'/>\
        <emitter type='envmap'><string name='filename' value='a.png'/><float name='scale' value='2'/></emitter>\
        <mesh type='sphere'><bsdf type='diffuse'><texture type='image_texture' name='albedo'>\
        <string name='filename' value='a.png'/><float name='scale' value='3'/></texture></bsdf></mesh></scene>";
    let scene = parse_nori(text, "s.xml", folder.path()).unwrap().scene.unwrap();
    assert_eq!(scene.images.len(), 1);
    let LightKind::Environment { image, scale, .. } = scene.lights[0].kind else { panic!() };
    assert_eq!((image.0, scale), (0, 2.0));
    let MaterialKind::Diffuse { albedo: Texture::Image { image, transform } } = scene.materials[0].kind
    else {
        panic!()
    };
    assert_eq!((image.0, transform.scale), (0, [3.0; 2]));
}
