//! Writing.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;

use caustica_math::Rgb;
use exr::meta::attribute::Chromaticities;
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Blocks, Compression, Encoding, FlatSamples, Image,
    ImageAttributes, IntegerBounds, Layer, LayerAttributes, LineOrder, SmallVec, Text, Vec2, WritableImage,
};

use super::{COMBINED, ERROR, LIGHT_IMAGE, LIGHT_PASSES, Metadata, PREFIX, SAMPLES};
use crate::layout::{Window, check_layer, check_window};
use crate::picture::{LightImage, Picture};
use crate::{FilmError, output};

/// The longest name of an attribute in the format, in bytes.
const LONGEST_NAME: usize = 255;

/// The longest name of a layer, in bytes: `.R` follows it.
const LONGEST_LAYER: usize = LONGEST_NAME - 2;

/// Writes a picture and what is known about it. The same picture and facts give the same bytes.
pub fn write_exr(
    path: &Path,
    picture: &Picture,
    light_image: LightImage,
    metadata: &Metadata,
) -> Result<(), FilmError> {
    picture.check()?;
    let mut facts = metadata.clone();
    facts.set(SAMPLES, picture.eye_samples);
    facts.set(LIGHT_PASSES, picture.light_samples);
    facts.set(LIGHT_IMAGE, light_image);
    let combined = picture.combined(light_image);
    let mut layers = vec![(COMBINED, combined.as_slice()), ("eye", &picture.eye), ("light", &picture.light)];
    layers.extend(picture.error.as_ref().map(|error| (ERROR, error.as_slice())));
    let mut names: Vec<&str> = picture.channels.iter().map(|c| c.name.as_str()).collect();
    names.sort_unstable();
    let is_taken = |name: &str| layers.iter().any(|(l, _)| split(name).0 == *l);
    if let Some(name) = names.iter().find(|n| n.is_empty() || n.len() > LONGEST_NAME || is_taken(n)) {
        return Err(FilmError::Layout(format!("`{name}` cannot be the name of a channel")));
    }
    if let Some(twice) = names.windows(2).find(|n| n[0] == n[1]) {
        return Err(FilmError::Layout(format!("two channels are called `{}`", twice[0])));
    }
    let mut channels = channels_of(&layers);
    channels.extend(picture.channels.iter().map(|c| {
        AnyChannel::new(Text::from_slice_unchecked(c.name.as_bytes()), FlatSamples::F32(c.values.clone()))
    }));
    write(path, [picture.width, picture.height], picture.window, (channels, &facts))
}

/// The name of a channel's layer, and the rest.
pub(super) fn split(channel: &str) -> (&str, &str) {
    channel.rsplit_once('.').unwrap_or(("", channel))
}

/// Writes layers of linear pixels by their names, each of which holds the window of a picture of that width and
/// height, row by row. A layer's channels are `NAME.R`, `NAME.G` and `NAME.B`; `combined` is what
/// Caustica shows of a file. The same layers and facts give the same bytes.
///
/// # Errors
/// Layers that do not fit the window, names that are empty or not plain ASCII, and what the system says.
pub fn write_layers(
    path: &Path,
    size: [u32; 2],
    window: Window,
    (layers, metadata): (&[(&str, &[Rgb])], &Metadata),
) -> Result<(), FilmError> {
    check_window(size[0], size[1], window)?;
    for (i, (name, pixels)) in layers.iter().enumerate() {
        if layers[..i].iter().any(|(other, _)| other == name) {
            return Err(FilmError::Layout(format!("two layers are called `{name}`")));
        }
        if name.is_empty() || !name.bytes().all(|b| b.is_ascii_graphic()) || name.len() > LONGEST_LAYER {
            return Err(FilmError::Layout(format!("`{name}` cannot be the name of a layer")));
        }
        check_layer(pixels.len(), window)?;
    }
    write(path, size, window, (channels_of(layers), metadata))
}

fn write(
    path: &Path,
    size: [u32; 2],
    window: Window,
    (channels, facts): (Channels, &Metadata),
) -> Result<(), FilmError> {
    let mut image = describe(size, window, channels);
    for (name, value) in facts.iter() {
        image.layer_data.attributes.other.insert(attribute_name(name)?, text(value));
    }
    output::write_atomically(path, |file| {
        let mut buffered = BufWriter::new(&mut *file);
        image.write().to_buffered(&mut buffered).map_err(|e| match e {
            exr::error::Error::Io(e) => FilmError::io(path, e),
            other => FilmError::format(path, other.to_string()),
        })?;
        buffered.flush().map_err(|e| FilmError::io(path, e))?;
        drop(buffered);
        sort_attributes(file).map_err(|e| FilmError::io(path, e))
    })
}

/// Text as bytes of UTF-8: the format itself says nothing about what they mean.
fn text(value: &str) -> AttributeValue {
    AttributeValue::Text(Text::from_slice_unchecked(value.as_bytes()))
}

fn attribute_name(name: &str) -> Result<Text, FilmError> {
    let full = format!("{PREFIX}{name}");
    if name.is_empty() || !full.bytes().all(|b| b.is_ascii_graphic()) || full.len() > LONGEST_NAME {
        return Err(FilmError::Layout(format!("`{full}` cannot be the name of an attribute of a picture")));
    }
    Ok(Text::from_slice_unchecked(full.as_bytes()))
}

/// Channels in the terms of the format.
type Channels = SmallVec<[AnyChannel<FlatSamples>; 4]>;

/// The channels of layers of colours.
fn channels_of(layers: &[(&str, &[Rgb])]) -> Channels {
    let mut channels = Channels::new();
    for (layer, pixels) in layers {
        for (index, channel) in ["R", "G", "B"].into_iter().enumerate() {
            let samples = pixels.iter().map(|Rgb(p)| p[index]).collect();
            let name = format!("{layer}.{channel}");
            channels.push(AnyChannel::new(name.as_str(), FlatSamples::F32(samples)));
        }
    }
    channels
}

/// A picture in the terms of the format.
fn describe(
    [width, height]: [u32; 2],
    window: Window,
    channels: Channels,
) -> Image<Layer<AnyChannels<FlatSamples>>> {
    // Lines in order, because otherwise the threads that compress them would race for the file.
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let position = Vec2(window.x as i32, window.y as i32);
    let layer = Layer::new(
        (window.width as usize, window.height as usize),
        LayerAttributes { layer_position: position, ..LayerAttributes::default() },
        encoding,
        AnyChannels::sort(channels),
    );
    let full = IntegerBounds::from_dimensions((width as usize, height as usize));
    Image::new(ImageAttributes { chromaticities: Some(bt709()), ..ImageAttributes::new(full) }, layer)
}

/// The primaries and white of ITU-R BT.709.
fn bt709() -> Chromaticities {
    Chromaticities {
        red: Vec2(0.64, 0.33),
        green: Vec2(0.3, 0.6),
        blue: Vec2(0.15, 0.06),
        white: Vec2(0.3127, 0.329),
    }
}

/// Puts the header's attributes into the order of their names. The library keeps ours in a hash map
/// and writes them in an order that differs from run to run; a header of the same length leaves all
/// that follows in its place.
fn sort_attributes(file: &mut File) -> io::Result<()> {
    // The magic number and the version come first.
    const START: u64 = 8;
    file.seek(SeekFrom::Start(START))?;
    let mut reader = BufReader::new(&mut *file);
    let mut attributes = BTreeMap::new();
    loop {
        let mut name = Vec::new();
        reader.read_until(0, &mut name)?;
        if name.len() <= 1 {
            break;
        }
        let mut rest = Vec::new();
        reader.read_until(0, &mut rest)?;
        let mut size = [0; 4];
        reader.read_exact(&mut size)?;
        rest.extend_from_slice(&size);
        (&mut reader).take(u32::from_le_bytes(size).into()).read_to_end(&mut rest)?;
        attributes.insert(name, rest);
    }
    file.seek(SeekFrom::Start(START))?;
    let sorted: Vec<u8> = attributes.into_iter().flat_map(|(name, rest)| [name, rest].concat()).collect();
    file.write_all(&sorted)
}
