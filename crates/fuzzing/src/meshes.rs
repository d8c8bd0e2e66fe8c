//! Meshes as PLY and serialized files, and changes of them.

use std::io::{Read, Write};

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;

use crate::dice::Dice;
use crate::mutate::{self, LONGEST};
use crate::words;

const PLY: &str = "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty double y\n\
    property float z\nproperty uchar red\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float s\n\
    property float t\nelement face 1\nproperty list uchar int vertex_indices\nelement edge 1\nproperty short a\n\
    end_header\n0 0 0 255 0 0 1 0 0\n1 0 0 9 0 0 1 1 0\n1 1 0 9 0 0 1 1 1\n0 1 .5 9 0 0 1 0 1\n4 0 1 2 3\n7\n";

/// Those that scenes name.
pub fn named() -> Vec<(&'static str, Vec<u8>)> {
    vec![("m.ply", PLY.as_bytes().to_vec()), ("m.serialized", serialized_file(4, &[0x1003, 0x2000]))]
}

/// Colours of corners and a number of faces.
const COLOURED: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
    property float r\nproperty float g\nproperty float b\nelement face 1\nproperty uchar heat_x\n\
    property list uchar int vertex_indices\nend_header\n0 0 0 1 0 0\n1 0 0 0 1 0\n1 1 0 0 0 1\n7 3 0 1 2\n";

/// PLY files: text, both byte orders, one of plain rows, and one with attributes.
pub fn ply() -> Vec<Vec<u8>> {
    vec![
        PLY.as_bytes().to_vec(),
        binary_ply(false),
        binary_ply(true),
        plain_ply(),
        COLOURED.as_bytes().to_vec(),
    ]
}

/// The text in binary.
fn binary_ply(big: bool) -> Vec<u8> {
    let (head, body) = PLY.split_once("end_header\n").unwrap_or_default();
    let name = if big { "binary_big_endian" } else { "binary_little_endian" };
    let mut bytes = format!("{}end_header\n", head.replace("ascii", name)).into_bytes();
    for line in body.lines() {
        let words: Vec<f64> = line.split(' ').map(|w| w.parse().unwrap_or(0.0)).collect();
        for (i, word) in words.iter().enumerate() {
            let mut value = match (words.len(), i) {
                (9, 1) => word.to_le_bytes().to_vec(),
                (9, 3) | (5, 0) => vec![*word as u8],
                (9, _) => (*word as f32).to_le_bytes().to_vec(),
                (5, _) => (*word as i32).to_le_bytes().to_vec(),
                _ => (*word as i16).to_le_bytes().to_vec(),
            };
            if big {
                value.reverse();
            }
            bytes.extend(value);
        }
    }
    bytes
}

/// Triangles in the layout of most large files.
fn plain_ply() -> Vec<u8> {
    let mut bytes =
        b"ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
        property float z\nelement face 2\nproperty list uchar uint vertex_index\nend_header\n"
            .to_vec();
    bytes.extend((0..12).flat_map(|i| ((i % 5) as f32).to_le_bytes()));
    for corners in [[0_u32, 1, 2], [0, 2, 3]] {
        bytes.push(3);
        bytes.extend(corners.iter().flat_map(|c| c.to_le_bytes()));
    }
    bytes
}

/// Changes PLY files: lines of those that are text, bytes of the others.
pub fn change_ply(data: &mut Vec<u8>, dice: &mut Dice) {
    if dice.once_in(2) { mutate::lines(data, words::PLY, dice) } else { mutate::binary(data, dice) }
}

/// Files of both versions with all kinds of meshes.
pub fn serialized() -> Vec<Vec<u8>> {
    let flags = [&[0x1003, 0x2000][..], &[0x100B], &[0x200B, 0x1010, 0x1000]];
    [3, 4].iter().flat_map(|version| flags.map(|f| serialized_file(*version, f))).collect()
}

/// A file of squares with those flags.
fn serialized_file(version: u16, flags: &[u32]) -> Vec<u8> {
    join(version, &flags.iter().map(|f| square(version, *f)).collect::<Vec<_>>())
}

/// What is compressed of a square.
fn square(version: u16, flags: u32) -> Vec<u8> {
    let mut bytes = flags.to_le_bytes().to_vec();
    if version == 4 {
        bytes.extend(b"square\0");
    }
    bytes.extend([4_u64, 2].iter().flat_map(|n| n.to_le_bytes()));
    let rows = 3 + 3 * (flags & 1) + (flags & 2) + 3 * (flags >> 3 & 1);
    for i in 0..4 * rows {
        let number = (i * 7 % 5) as f32;
        match flags & 0x2000 {
            0 => bytes.extend(number.to_le_bytes()),
            _ => bytes.extend(f64::from(number).to_le_bytes()),
        }
    }
    bytes.extend([0_u32, 1, 2, 0, 2, 3].iter().flat_map(|c| c.to_le_bytes()));
    bytes
}

/// A file of meshes, given by what is compressed.
fn join(version: u16, bodies: &[Vec<u8>]) -> Vec<u8> {
    let (mut bytes, mut places) = (Vec::new(), Vec::new());
    for body in bodies {
        places.push(bytes.len() as u64);
        bytes.extend([0x041C, version].iter().flat_map(|n| n.to_le_bytes()));
        let mut encoder = ZlibEncoder::new(&mut bytes, Compression::fast());
        encoder.write_all(body).and_then(|()| encoder.finish()).expect("a vector");
    }
    for place in &places {
        let width = if version == 3 { 4 } else { 8 };
        bytes.extend(&place.to_le_bytes()[..width]);
    }
    bytes.extend((places.len() as u32).to_le_bytes());
    bytes
}

/// Changes serialized files, mostly what is compressed in them.
pub fn change_serialized(data: &mut Vec<u8>, dice: &mut Dice) {
    if dice.once_in(4) {
        mutate::binary(data, dice);
        return;
    }
    let version = if data.get(2) == Some(&3) { 3 } else { 4 };
    let starts = (0..data.len()).filter(|i| data[*i..].starts_with(&[0x1C, 0x04]));
    let unpack = |i: usize| {
        let mut body = Vec::new();
        // What can be unpacked of a damaged one will do.
        let _ = ZlibDecoder::new(data.get(i + 4..)?).take(LONGEST as u64).read_to_end(&mut body);
        Some(body)
    };
    let mut bodies: Vec<Vec<u8>> = starts.filter_map(unpack).take(4).collect();
    for body in &mut bodies {
        if dice.once_in(2) {
            mutate::binary(body, dice);
        }
    }
    *data = join(version, &bodies);
    data.truncate(LONGEST);
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_seed_is_read() {
        for seed in super::ply() {
            caustica_import::read_ply(&seed, "m.ply").unwrap();
        }
        for seed in super::serialized() {
            let memory = caustica_scene::MemoryLimit::Bytes(1 << 20);
            caustica_import::read_serialized(&seed, "m", 0, memory).unwrap();
        }
    }
}
