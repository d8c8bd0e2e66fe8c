//! Mitsuba's serialized meshes.

use std::io::Write;

use caustica_import::read_serialized;
use caustica_math::{MemoryLimit, Vec2, Vec3};
use caustica_scene::Cause;
use caustica_scene::description::Mesh;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use proptest::prelude::*;

const NORMALS: u32 = 1;
const UVS: u32 = 2;
const COLORS: u32 = 8;
const DOUBLES: u32 = 0x2000;

fn zlib(body: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(body).unwrap();
    encoder.finish().unwrap()
}

/// What is compressed of a square at that height.
fn body(version: u16, flags: u32, height: f64) -> Vec<u8> {
    let mut b = flags.to_le_bytes().to_vec();
    if version == 4 {
        b.extend(b"square\0");
    }
    b.extend(4_u64.to_le_bytes());
    b.extend(2_u64.to_le_bytes());
    let mut number = |x: f64| match flags & DOUBLES {
        0 => b.extend((x as f32).to_le_bytes()),
        _ => b.extend(x.to_le_bytes()),
    };
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    corners.iter().for_each(|[x, y]| [*x, *y, height].map(&mut number).into_iter().collect());
    if flags & NORMALS != 0 {
        corners.iter().for_each(|_| [0.0, 0.0, 1.0].map(&mut number).into_iter().collect());
    }
    if flags & UVS != 0 {
        corners.iter().for_each(|c| c.map(&mut number).into_iter().collect());
    }
    if flags & COLORS != 0 {
        corners.iter().for_each(|_| [0.25, 0.5, 1.0].map(&mut number).into_iter().collect());
    }
    [0_u32, 1, 2, 0, 2, 3].iter().for_each(|i| b.extend(i.to_le_bytes()));
    b
}

/// A file of meshes, given by what is compressed.
fn file(version: u16, bodies: &[Vec<u8>]) -> Vec<u8> {
    let (mut bytes, mut places) = (Vec::new(), Vec::new());
    for body in bodies {
        places.push(bytes.len() as u64);
        bytes.extend([0x041C_u16, version].iter().flat_map(|n| n.to_le_bytes()));
        bytes.extend(zlib(body));
    }
    for place in &places {
        match version {
            4 => bytes.extend(place.to_le_bytes()),
            _ => bytes.extend((*place as u32).to_le_bytes()),
        }
    }
    bytes.extend((places.len() as u32).to_le_bytes());
    bytes
}

fn squares(version: u16, flags: u32) -> Vec<u8> {
    file(version, &[body(version, flags, 0.0), body(version, flags, 1.0), body(version, flags, 2.0)])
}

fn read(bytes: &[u8], index: u32) -> Result<Mesh, String> {
    read_serialized(bytes, "m.serialized", index, MemoryLimit::Bytes(1 << 20)).map_err(|e| e.to_string())
}

#[test]
fn all_kinds_hold_the_same() {
    for version in [3, 4] {
        for flags in [0, NORMALS, UVS, COLORS, NORMALS | UVS | COLORS] {
            for doubles in [0x1000, DOUBLES] {
                let bytes = squares(version, flags | doubles);
                for index in 0..3 {
                    let mesh = read(&bytes, index).unwrap();
                    assert_eq!(mesh.positions[2], Vec3::new(1.0, 1.0, index as f32));
                    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
                    let normals = if flags & NORMALS != 0 { vec![Vec3::Z; 4] } else { vec![] };
                    assert_eq!(mesh.normals, normals);
                    assert_eq!(mesh.uvs.get(2).copied(), (flags & UVS != 0).then_some(Vec2::new(1.0, 1.0)));
                }
            }
        }
    }
}

#[test]
fn errors_say_what_is_wrong() {
    let good = squares(4, NORMALS);
    let message = |bytes: &[u8], index, expected: &str| {
        let error = read(bytes, index).expect_err(expected);
        assert!(error.contains("m.serialized") && error.contains(expected), "{error}");
    };
    message(&good, 3, "no mesh of number 3; the last one is number 2");
    message(&[], 0, "ends too early");
    message(b"ply\nformat", 0, "0x041C");
    let mut other = good.clone();
    other[2] = 5;
    message(&other, 0, "its version is 5");
    message(&good[..good.len() - 9], 1, "the list of its meshes is damaged");
    let changed = |change: fn(&mut Vec<u8>)| {
        let mut b = body(4, 0, 0.0);
        change(&mut b);
        file(4, &[b])
    };
    message(&changed(|b| b.truncate(60)), 0, "ends too early");
    message(&changed(|b| b[23] = 9), 0, "has more than");
    message(&changed(|b| b[22] = 9), 0, "4 vertices and 150994946 triangles");
    message(&changed(|b| *b.last_mut().unwrap() = 1), 0, "there is no vertex");
    message(&changed(|b| b[29..31].copy_from_slice(&[0x80, 0x7F])), 0, "not finite");
    message(&changed(|b| b[19] = 0), 0, "no triangles");
    let mut named = 0_u32.to_le_bytes().to_vec();
    named.resize(100_000, b'x');
    message(&file(4, &[named]), 0, "its name does not end");
}

/// A few kilobytes that unpack to a large mesh are refused before it is made.
#[test]
fn bombs_are_refused() {
    let count = 300_000_u64;
    let mut b = 0_u32.to_le_bytes().to_vec();
    b.extend(count.to_le_bytes());
    b.extend(count.to_le_bytes());
    b.resize(b.len() + count as usize * 24, 0);
    let bytes = file(3, &[b]);
    assert!(bytes.len() < 8000, "{}", bytes.len());
    let error = read_serialized(&bytes, "m", 0, MemoryLimit::Bytes(10 << 20)).unwrap_err();
    assert_eq!(error.cause, Cause::Memory, "{error}");
    assert_eq!(
        read_serialized(&bytes, "m", 0, MemoryLimit::Bytes(20 << 20)).unwrap().triangles.len(),
        300_000
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_files(
        version in 3..5_u16,
        inside in any::<bool>(),
        index in 0..4_u32,
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        kept in 0.0..1.2_f64,
    ) {
        let flags = NORMALS | UVS;
        let mut bytes = if inside { body(version, flags, 0.0) } else { squares(version, flags) };
        for (at, byte) in edits {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        bytes.truncate((bytes.len() as f64 * kept.min(1.0)) as usize);
        if inside {
            bytes = file(version, &[bytes, body(version, flags, 1.0)]);
        }
        if let Ok(mesh) = read(&bytes, index) {
            let vertices = mesh.positions.len();
            prop_assert!(mesh.triangles.iter().flatten().all(|v| (*v as usize) < vertices));
            prop_assert!(mesh.positions.iter().all(|p| p.is_finite()));
            prop_assert!([0, vertices].contains(&mesh.normals.len()) && [0, vertices].contains(&mesh.uvs.len()));
        }
    }
}
