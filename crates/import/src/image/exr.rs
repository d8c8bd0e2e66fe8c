//! OpenEXR.

use std::io::Cursor;

use caustica_math::Rgb;
use exr::meta::MetaData;
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};

use super::{Fault, Pixels, Room};

/// No compression of the format packs pixels closer than this (deflate reaches 1032 to 1).
const CLOSEST_PACKING: u64 = 1100;

/// The most samples, over all channels, that the first layer may have.
const MOST_SAMPLES: u64 = 1 << 30;

pub(super) fn decode(bytes: &[u8], room: Room) -> Result<Pixels, Fault> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(|e| e.to_string())?;
    for header in &meta.headers {
        let (width, height) = (header.layer_size.x() as u64, header.layer_size.y() as u64);
        let size = room.check(width, height)?;
        room.holds(width * height * 8 * header.channels.bytes_per_pixel as u64, CLOSEST_PACKING)?;
        room.fits(size, 4 * header.channels.list.len() as u64)?;
        if width * height * header.channels.list.len() as u64 > MOST_SAMPLES {
            return Err("it has too many channels for its size".into());
        }
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        // A panic of the decoder on a thread of its own would end the process.
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|e| e.to_string())?;
    let layer = &image.layer_data;
    let (width, height) = room.check(layer.size.x() as u64, layer.size.y() as u64)?;
    let channels = &layer.channel_data.list;
    let find = |name: &str| {
        let channel = channels.iter().find(|c| c.name.eq_case_insensitive(name))?;
        (channel.sampling.x() == 1 && channel.sampling.y() == 1).then_some(&channel.sample_data)
    };
    let rgb = |prefix: &str| {
        Some([find(&format!("{prefix}R"))?, find(&format!("{prefix}G"))?, find(&format!("{prefix}B"))?])
    };
    // `combined` is what our own files hold beside the eye and the light image.
    let planes = match rgb("").or_else(|| find("Y").map(|y| [y; 3])).or_else(|| rgb("combined.")) {
        Some(planes) => planes,
        None => {
            let names: Vec<String> = channels.iter().take(16).map(|c| c.name.to_string()).collect();
            return Err(format!("its first layer has neither R, G, B nor Y, but {}", names.join(", ")).into());
        }
    };
    let count = width as usize * height as usize;
    let value = |plane: &FlatSamples, i: usize| match plane {
        FlatSamples::F16(v) => v.get(i).map(|v| v.to_f32()),
        FlatSamples::F32(v) => v.get(i).copied(),
        FlatSamples::U32(v) => v.get(i).map(|v| *v as f32),
    };
    let pixel = |i| Some(Rgb::new(value(planes[0], i)?, value(planes[1], i)?, value(planes[2], i)?));
    let pixels: Option<Vec<Rgb>> = (0..count).map(pixel).collect();
    Ok(Pixels { width, height, pixels: pixels.ok_or("it has too few pixels")? })
}
