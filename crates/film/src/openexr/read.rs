//! Reading.

use std::fs::File;
use std::io::{BufReader, Seek};
use std::panic::catch_unwind;
use std::path::Path;

use caustica_math::Rgb;
use exr::meta::header::Header;
use exr::prelude::{
    AnyChannel, AttributeValue, FlatSamples, MetaData, ReadChannels, ReadLayers, ReadSpecificChannel, Vec2,
    attribute::ChannelList, read,
};

use super::write::split;
use super::{COMBINED, ERROR, LAYERS, LIGHT_PASSES, Metadata, PREFIX, SAMPLES};
use crate::FilmError;
use crate::layout::{Window, check_window};
use crate::picture::{Channel, Picture};

/// No compression of the format packs lossless pixels closer than this (deflate reaches 1032 to 1).
const CLOSEST_PACKING: u64 = 1100;

/// Reads a picture that [`write_exr`](super::write_exr) wrote, and what is known about it. The layers
/// `eye` and `light` must be there; other channels go with the picture.
pub fn read_exr(path: &Path) -> Result<(Picture, Metadata), FilmError> {
    // The decoder is other people's code, and no file may bring the program down.
    catch_unwind(|| read_whole(path))
        .unwrap_or_else(|_| Err(FilmError::format(path, "the OpenEXR decoder failed; the file is damaged")))
}

fn read_whole(path: &Path) -> Result<(Picture, Metadata), FilmError> {
    let io = |e| FilmError::io(path, e);
    let mut file = File::open(path).map_err(io)?;
    let length = file.metadata().map_err(io)?.len();
    let meta =
        MetaData::read_from_buffered(BufReader::new(&mut file), false).map_err(|e| explain(path, e))?;
    let bad = |message: String| FilmError::format(path, message);
    let [header] = meta.headers.as_slice() else {
        return Err(bad(format!("has {} parts, but a picture has one", meta.headers.len())));
    };
    check_channels(&header.channels).map_err(bad)?;
    let (size, window) = windows(header).map_err(bad)?;
    check_length(header, window, length).map_err(bad)?;
    let metadata = facts(header);
    let eye_samples = count(&metadata, SAMPLES).map_err(bad)?;
    let light_samples = count(&metadata, LIGHT_PASSES).map_err(bad)?;
    file.rewind().map_err(io)?;
    let has_error = has_layer(&header.channels, ERROR);
    let others = header.channels.list.iter().any(|c| is_other(&c.name.to_string()));
    let channels = if others { other_channels(&file).map_err(|e| explain(path, e))? } else { Vec::new() };
    file.rewind().map_err(io)?;
    let [eye, light, error] = pixels(file).map_err(|e| explain(path, e))?;
    let ([width, height], error) = (size, has_error.then_some(error));
    let picture = Picture { width, height, window, eye_samples, light_samples, eye, light, error, channels };
    Ok((picture, metadata))
}

fn explain(path: &Path, error: exr::error::Error) -> FilmError {
    use exr::error::Error;
    match error {
        Error::Io(e) => FilmError::io(path, e),
        Error::Invalid(m) if m.contains("missing bytes") => FilmError::format(path, "the file is cut short"),
        other => FilmError::format(path, format!("not an OpenEXR file that can be read ({other})")),
    }
}

/// Whether all channels that are needed are there, at full resolution.
fn check_channels(channels: &ChannelList) -> Result<(), String> {
    for layer in LAYERS {
        for channel in ["R", "G", "B"] {
            let name = format!("{layer}.{channel}");
            match channels.list.iter().find(|c| c.name.eq(&name)) {
                None => return Err(format!("has no layer `{layer}`: the channel `{name}` is missing")),
                Some(c) if c.sampling != Vec2(1, 1) => {
                    return Err(format!("the channel `{name}` does not have every pixel"));
                }
                Some(_) => {}
            }
        }
    }
    Ok(())
}

/// Whether a layer is there, at full resolution.
fn has_layer(channels: &ChannelList, layer: &str) -> bool {
    ["R", "G", "B"].iter().all(|channel| {
        let name = format!("{layer}.{channel}");
        channels.list.iter().any(|c| c.name.eq(&name) && c.sampling == Vec2(1, 1))
    })
}

/// The sides of the full picture, and the part of it that is there.
fn windows(header: &Header) -> Result<([u32; 2], Window), String> {
    let display = header.shared_attributes.display_window;
    let offset = header.own_attributes.layer_position;
    let part = || {
        let size = [u32::try_from(display.size.0).ok()?, u32::try_from(display.size.1).ok()?];
        let window = Window {
            x: u32::try_from(i64::from(offset.0) - i64::from(display.position.0)).ok()?,
            y: u32::try_from(i64::from(offset.1) - i64::from(display.position.1)).ok()?,
            width: u32::try_from(header.layer_size.0).ok()?,
            height: u32::try_from(header.layer_size.1).ok()?,
        };
        Some((size, window))
    };
    let (size, window) = part().ok_or("its data window leaves its display window")?;
    check_window(size[0], size[1], window).map_err(|e| e.to_string())?;
    Ok((size, window))
}

/// Refuses headers that announce more pixels than the file can hold, before memory is taken for them.
fn check_length(header: &Header, window: Window, length: u64) -> Result<(), String> {
    let announced = u128::from(window.pixels()) * header.channels.bytes_per_pixel as u128;
    if announced > u128::from(length) * u128::from(CLOSEST_PACKING) {
        let megabytes = announced / 1_000_000;
        return Err(format!("announces {megabytes} MB of pixels, which {length} bytes cannot hold"));
    }
    Ok(())
}

/// Our attributes.
fn facts(header: &Header) -> Metadata {
    let mut metadata = Metadata::new();
    let attributes = header.own_attributes.other.iter().chain(&header.shared_attributes.other);
    for (name, value) in attributes {
        if let (Some(name), AttributeValue::Text(value)) = (name.to_string().strip_prefix(PREFIX), value) {
            metadata.set(name, String::from_utf8_lossy(value.as_slice()));
        }
    }
    metadata
}

/// A number of samples; zero where a file says nothing.
fn count(metadata: &Metadata, name: &str) -> Result<u64, String> {
    match metadata.get(name) {
        None => Ok(0),
        Some(value) => value.parse().map_err(|_| format!("`{PREFIX}{name}` is no number: `{value}`")),
    }
}

/// Whether a channel is none of those that every picture has.
fn is_other(name: &str) -> bool {
    !LAYERS.iter().chain(&[COMBINED, ERROR]).any(|layer| split(name).0 == *layer)
}

/// The channels beside the picture, as far as they have every pixel.
fn other_channels(file: &File) -> exr::error::Result<Vec<Channel>> {
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(BufReader::new(file))?;
    let list = image.layer_data.channel_data.list;
    let whole = list.into_iter().filter(|c| c.sampling == Vec2(1, 1) && is_other(&c.name.to_string()));
    let channel = |c: AnyChannel<FlatSamples>| Channel {
        name: c.name.to_string(),
        values: c.sample_data.values_as_f32().collect(),
    };
    Ok(whole.map(channel).collect())
}

/// The eye image, the light image and the error bars; black where there are none.
fn pixels(file: File) -> exr::error::Result<[Vec<Rgb>; 3]> {
    type Nine = (f32, f32, f32, f32, f32, f32, f32, f32, f32);
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels()
        .required("eye.R")
        .required("eye.G")
        .required("eye.B")
        .required("light.R")
        .required("light.G")
        .required("light.B")
        .optional("error.R", 0.0)
        .optional("error.G", 0.0)
        .optional("error.B", 0.0)
        .collect_pixels(
            |size, _| (size.0, std::array::from_fn(|_| vec![Rgb::BLACK; size.area()])),
            |(width, layers): &mut (usize, [Vec<Rgb>; 3]), Vec2(x, y), v: Nine| {
                let pixel = [Rgb::new(v.0, v.1, v.2), Rgb::new(v.3, v.4, v.5), Rgb::new(v.6, v.7, v.8)];
                for (layer, value) in layers.iter_mut().zip(pixel) {
                    layer[y * *width + x] = value;
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        // A panic of the decoder on a thread of its own would end the process.
        .non_parallel()
        .from_buffered(BufReader::new(file))?;
    Ok(image.layer_data.channel_data.pixels.1)
}
