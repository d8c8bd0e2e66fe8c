use std::fs;
use std::path::Path;

use caustica_math::Rgb;
use exr::prelude::{Image, MetaData, SpecificChannels, WritableImage};

use super::*;
use crate::FilmError;
use crate::layout::Window;
use crate::picture::{Channel, LightImage, Picture};

/// A crop whose values have every kind of bits that a picture can have.
fn picture() -> Picture {
    let window = Window { x: 5, y: 7, width: 23, height: 37 };
    let value = |i: u32| f32::from_bits(0x3f80_0000 ^ i.wrapping_mul(0x9e37_79b9) >> 4);
    let pixel = |i: u32| Rgb::new(value(i), -value(i + 1), value(i + 2) * 1e-30);
    let layer = |seed: u32| (0..window.pixels() as u32).map(|i| pixel(i + seed)).collect();
    Picture {
        width: 64,
        height: 48,
        window,
        eye_samples: 16,
        light_samples: 9,
        eye: layer(0),
        light: layer(9999),
        error: None,
        channels: Vec::new(),
    }
}

fn facts_of_a_render() -> Metadata {
    let mut metadata = Metadata::new();
    metadata.set("integrator", "bdpt");
    metadata.set("seed", 42);
    metadata.set("scene", "Müllers Küche ☕.xml");
    metadata.set("a name that would be far too long for the old limit".replace(' ', "-"), "");
    metadata
}

fn bits(pixels: &[Rgb]) -> Vec<u32> {
    pixels.iter().flat_map(|p| p.0).map(f32::to_bits).collect()
}

fn message(result: Result<(Picture, Metadata), FilmError>) -> String {
    match result {
        Ok(_) => panic!("was read"),
        Err(error) => error.to_string(),
    }
}

fn write(path: &Path) -> Vec<u8> {
    write_exr(path, &picture(), LightImage::On, &facts_of_a_render()).unwrap();
    fs::read(path).unwrap()
}

#[test]
fn everything_round_trips_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.exr");
    let picture = picture();
    for light_image in [LightImage::On, LightImage::Off, LightImage::Only] {
        write_exr(&path, &picture, light_image, &facts_of_a_render()).unwrap();
        let (read, metadata) = read_exr(&path).unwrap();
        assert_eq!(bits(&read.eye), bits(&picture.eye));
        assert_eq!(bits(&read.light), bits(&picture.light));
        assert_eq!(Picture { eye: picture.eye.clone(), light: picture.light.clone(), ..read }, picture);
        let mut expected = facts_of_a_render();
        expected.set("samples", 16);
        expected.set("lightPasses", 9);
        expected.set("lightImage", light_image);
        assert_eq!(metadata, expected);
        let combined = exr::prelude::read_first_flat_layer_from_file(&path).unwrap().layer_data;
        let red = &combined.channel_data.list[2];
        assert_eq!(red.name.to_string(), "combined.R");
        let red: Vec<u32> = red.sample_data.values_as_f32().map(f32::to_bits).collect();
        let expected: Vec<u32> = picture.combined(light_image).iter().map(|p| p.0[0].to_bits()).collect();
        assert_eq!(red, expected);
    }
}

#[test]
fn error_bars_are_a_layer() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.exr");
    let bars: Vec<Rgb> = picture().eye.iter().map(|p| *p * 0.25).collect();
    let with = Picture { error: Some(bars.clone()), ..picture() };
    write_exr(&path, &with, LightImage::On, &facts_of_a_render()).unwrap();
    let (read, _) = read_exr(&path).unwrap();
    assert_eq!(bits(&read.error.unwrap()), bits(&bars));
    assert_eq!(bits(&read.light), bits(&with.light));
    let short = Picture { error: Some(Vec::new()), ..picture() };
    assert!(matches!(write_exr(&path, &short, LightImage::On, &Metadata::new()), Err(FilmError::Layout(_))));
}

/// What lies beside the picture goes with it, in the format's own order; names that are taken are refused.
#[test]
fn further_channels_round_trip() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.exr");
    let channel = |name: &str, seed: u32| Channel {
        name: name.into(),
        values: (0..picture().window.pixels() as u32).map(|i| (i + seed) as f32 * 0.1).collect(),
    };
    let names = ["albedo.B", "albedo.G", "albedo.R", "dd.y.T", "n.X", "plain"];
    let channels: Vec<Channel> = names.iter().zip(0..).map(|(name, seed)| channel(name, seed)).collect();
    let mut turned = channels.clone();
    turned.reverse();
    let whole = Picture { channels: turned, ..picture() };
    write_exr(&path, &whole, LightImage::On, &facts_of_a_render()).unwrap();
    let (read, _) = read_exr(&path).unwrap();
    assert_eq!(read.channels, channels);
    assert_eq!((bits(&read.eye), bits(&read.light)), (bits(&whole.eye), bits(&whole.light)));
    let header = &MetaData::read_from_file(&path, true).unwrap().headers[0];
    let found: Vec<String> = header.channels.list.iter().map(|c| c.name.to_string()).collect();
    let ours = found.iter().filter(|n| names.contains(&n.as_str()));
    assert_eq!(ours.collect::<Vec<_>>(), names);
    assert_eq!(found.len(), names.len() + 9);
    let refused = |channels: Vec<Channel>| {
        let picture = Picture { channels, ..picture() };
        let error = write_exr(&path, &picture, LightImage::On, &Metadata::new()).unwrap_err();
        assert!(matches!(error, FilmError::Layout(_)), "{error}");
    };
    refused(vec![channel("eye.T", 0)]);
    refused(vec![channel("", 0)]);
    refused(vec![channel("a.T", 0), channel("a.T", 1)]);
    refused(vec![Channel { name: "a.T".into(), values: vec![0.0; 3] }]);
}

#[test]
fn the_header_says_what_the_file_is() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.exr");
    write(&path);
    let meta = MetaData::read_from_file(&path, true).unwrap();
    assert_eq!(meta.headers.len(), 1);
    let header = &meta.headers[0];
    let names: Vec<String> = header.channels.list.iter().map(|c| c.name.to_string()).collect();
    let layers = ["combined", "eye", "light"];
    let expected: Vec<String> =
        layers.iter().flat_map(|l| ["B", "G", "R"].map(|c| format!("{l}.{c}"))).collect();
    assert_eq!(names, expected);
    assert!(header.channels.list.iter().all(|c| c.sample_type == exr::prelude::SampleType::F32));
    assert_eq!(header.compression, exr::prelude::Compression::ZIP16);
    let display = header.shared_attributes.display_window;
    assert_eq!((display.position.0, display.position.1, display.size.0, display.size.1), (0, 0, 64, 48));
    let data = header.data_window();
    assert_eq!((data.position.0, data.position.1, data.size.0, data.size.1), (5, 7, 23, 37));
    assert!((header.shared_attributes.chromaticities.unwrap().white.0 - 0.3127).abs() < 1e-6);
}

/// Eight attributes of our own come out of a hash map: equal by chance once in 40320.
#[test]
fn the_same_picture_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let first = write(&folder.path().join("a.exr"));
    for _ in 0..5 {
        assert!(write(&folder.path().join("b.exr")) == first);
    }
}

#[test]
fn truncated_files_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.exr");
    let whole = write(&path);
    let lengths = (0..2000).chain((2000..whole.len()).step_by(97)).chain(whole.len() - 50..whole.len());
    for length in lengths.filter(|n| *n < whole.len()) {
        fs::write(&path, &whole[..length]).unwrap();
        let error = message(read_exr(&path));
        assert!(error.starts_with(path.to_str().unwrap()), "{length}: {error}");
    }
    fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    assert!(message(read_exr(&path)).ends_with("the file is cut short"));
}

/// A damaged file may be refused or may give other pixels, but must not panic or take all memory.
#[test]
fn damaged_files_do_not_panic() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.exr");
    let whole = write(&path);
    for i in 0..6000u64 {
        let mut damaged = whole.clone();
        let hash = caustica_math::stream::mix64(i);
        // Half of the damage goes to the header, where most of the trouble is.
        let range = if i % 2 == 0 { 1500 } else { whole.len() as u64 };
        damaged[(hash % range) as usize] = (hash >> 56) as u8;
        fs::write(&path, &damaged).unwrap();
        let _ = read_exr(&path);
    }
}

#[test]
fn foreign_files_are_refused_with_a_reason() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.exr");
    fs::write(&path, "no picture at all").unwrap();
    assert!(message(read_exr(&path)).contains("not an OpenEXR file"));
    assert!(message(read_exr(&folder.path().join("missing.exr"))).contains("missing.exr"));
    assert!(read_exr(folder.path()).is_err());

    let plain = SpecificChannels::rgb(|_| (0.5f32, 0.25f32, 0.125f32));
    Image::from_channels((4, 4), plain).write().to_file(&path).unwrap();
    assert!(message(read_exr(&path)).contains("no layer `eye`: the channel `eye.R` is missing"));

    let eye_only = SpecificChannels::build()
        .with_channel::<f32>("eye.R")
        .with_channel::<f32>("eye.G")
        .with_channel::<f32>("eye.B")
        .with_pixel_fn(|_| (0.5f32, 0.25f32, 0.125f32));
    Image::from_channels((4, 4), eye_only).write().to_file(&path).unwrap();
    assert!(message(read_exr(&path)).contains("no layer `light`: the channel `light.R` is missing"));
}

/// A small file that announces 8 million × 8 million pixels.
#[test]
fn announcements_are_not_believed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.exr");
    let mut bytes = write(&path);
    for (name, first) in [("dataWindow", [5i32, 7]), ("displayWindow", [0, 0])] {
        let needle = [name.as_bytes(), b"\0box2i\0\x10\0\0\0"].concat();
        let start = bytes.windows(needle.len()).position(|w| w == needle).unwrap() + needle.len();
        for (i, v) in [first[0], first[1], 8_000_000, 8_000_000].into_iter().enumerate() {
            bytes[start + 4 * i..][..4].copy_from_slice(&v.to_le_bytes());
        }
    }
    fs::write(&path, bytes).unwrap();
    assert!(message(read_exr(&path)).contains("MB of pixels"), "{}", message(read_exr(&path)));
}

#[test]
fn names_and_sizes_are_checked_before_writing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.exr");
    for name in ["", "two words", "größe", "nul\0", &"x".repeat(300)] {
        let mut metadata = Metadata::new();
        metadata.set(name, 1);
        assert!(write_exr(&path, &picture(), LightImage::On, &metadata).is_err(), "{name}");
    }
    let short = Picture { eye: Vec::new(), ..picture() };
    assert!(write_exr(&path, &short, LightImage::On, &Metadata::new()).is_err());
    assert!(!path.exists());
    let nowhere = folder.path().join("no-such-folder/p.exr");
    let error = write_exr(&nowhere, &picture(), LightImage::On, &Metadata::new()).unwrap_err();
    assert!(error.to_string().contains("no-such-folder"), "{error}");
}

/// Any layers, read back channel by channel.
#[test]
fn layers_have_names() {
    use exr::prelude::*;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("layers.exr");
    let window = Window { x: 1, y: 2, width: 2, height: 1 };
    let [a, b] = [[Rgb::new(0.25, 1.0, 2.0), Rgb::WHITE], [Rgb::BLACK, Rgb::splat(-3.0)]];
    let mut facts = Metadata::new();
    facts.set("edges", 4);
    let layers: [(&str, &[Rgb]); 2] = [("s0t2", &a), ("combined", &b)];
    write_layers(&path, [5, 4], window, (&layers, &facts)).unwrap();
    let image = read_all_flat_layers_from_file(&path).unwrap();
    let channels = &image.layer_data[0].channel_data.list;
    let names: Vec<_> = channels.iter().map(|c| c.name.to_string()).collect();
    assert_eq!(names, ["combined.B", "combined.G", "combined.R", "s0t2.B", "s0t2.G", "s0t2.R"]);
    assert_eq!(channels[5].sample_data.values_as_f32().collect::<Vec<_>>(), [0.25, 1.0]);
    for (name, pixels) in [("", &a[..]), ("two words", &a), ("short", &a[..1]), (&"n".repeat(254), &a)] {
        assert!(write_layers(&path, [5, 4], window, (&[(name, pixels)], &facts)).is_err(), "{name}");
    }
    assert!(write_layers(&path, [2, 2], window, (&layers, &facts)).is_err());
    assert!(write_layers(&path, [5, 4], window, (&[layers[0], layers[0]], &facts)).is_err());
}

/// Found by fuzzing: a block of B44 made the decoder panic on a thread of its own, which ended the process.
#[test]
fn a_decoder_that_panics_is_an_error() {
    use exr::prelude::{
        AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Layer, LayerAttributes, f16,
    };
    let names = ["eye", "light"].into_iter().flat_map(|l| ["R", "G", "B"].map(|c| format!("{l}.{c}")));
    let halves = || FlatSamples::F16(vec![f16::ONE; 16]);
    let channels = AnyChannels::sort(names.map(|n| AnyChannel::new(n.as_str(), halves())).collect());
    let encoding = Encoding { compression: Compression::B44, ..Encoding::UNCOMPRESSED };
    let layer = Layer::new((4, 4), LayerAttributes::named("film"), encoding, channels);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.exr");
    Image::from_layer(layer).write().to_file(&path).unwrap();
    read_exr(&path).unwrap();
    let mut bytes = fs::read(&path).unwrap();
    // Differences below zero: the decoder's arithmetic wraps around, or panics where that is checked.
    let last_block = bytes.len() - 14;
    bytes[last_block..].fill(0);
    fs::write(&path, bytes).unwrap();
    if let Err(error) = read_exr(&path) {
        assert!(error.to_string().contains("decoder failed"), "{error}");
    }
}
