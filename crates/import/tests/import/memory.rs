//! What does not fit into memory is refused before it is allocated, with the figures.

use std::path::PathBuf;

use caustica_import::{load_obj_within, load_within, read_image_within};
use caustica_scene::{Cause, Diagnostic, MemoryLimit};
use tempfile::TempDir;

const MEGABYTE: u64 = 1_000_000;

fn write(folder: &TempDir, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

#[track_caller]
fn is_shortage(e: &Diagnostic, fragment: &str) {
    assert!(e.cause == Cause::Memory && e.message.contains(fragment), "{e}");
}

fn png(width: u32, height: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().unwrap().write_image_data(data).unwrap();
    bytes
}

fn exr(width: usize, height: usize) -> Vec<u8> {
    use exr::prelude::*;
    let mut bytes = std::io::Cursor::new(Vec::new());
    let channels = SpecificChannels::rgb(|_: Vec2<usize>| (0.5_f32, 0.5_f32, 0.5_f32));
    Image::from_channels((width, height), channels).write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

#[test]
fn images() {
    let folder = tempfile::tempdir().unwrap();
    let files = [
        ("a.png", png(200, 100, &vec![7; 200 * 100 * 3])),
        ("a.exr", exr(200, 100)),
        ("a.jpg", include_bytes!("../data/two_colours.jpg").to_vec()),
    ];
    for (name, bytes) in files {
        let path = write(&folder, name, bytes);
        let pixels =
            read_image_within(&path, MemoryLimit::Bytes(MEGABYTE)).unwrap().image.pixels.len() as u64;
        // The colours themselves, twice, are the least that is needed.
        let e = read_image_within(&path, MemoryLimit::Bytes(24 * pixels)).unwrap_err();
        is_shortage(&e, &format!("{name}` needs 1 MB of memory, and 0 MB are there"));
    }
}

/// Heads of files that promise 100 000 × 100 000 pixels are refused at once, however much memory there is.
#[test]
fn ten_thousand_million_pixels() {
    let folder = tempfile::tempdir().unwrap();
    let mut large_png = png(1, 1, &[0; 3]);
    let side = 100_000_u32.to_be_bytes();
    large_png[16..20].copy_from_slice(&side);
    large_png[20..24].copy_from_slice(&side);
    let sum = crc(&large_png[12..29]).to_be_bytes();
    large_png[29..33].copy_from_slice(&sum);
    // Both windows of an OpenEXR file hold two corners of two numbers each.
    let mut large_exr = exr(1, 1);
    for name in [&b"dataWindow\0box2i\0"[..], b"displayWindow\0box2i\0"] {
        let at = large_exr.windows(name.len()).position(|w| w == name).unwrap() + name.len() + 4;
        large_exr[at + 8..at + 12].copy_from_slice(&99_999_u32.to_le_bytes());
        large_exr[at + 12..at + 16].copy_from_slice(&99_999_u32.to_le_bytes());
    }
    for (name, bytes) in [("a.png", large_png), ("a.exr", large_exr)] {
        let path = write(&folder, name, bytes);
        let read = || read_image_within(&path, MemoryLimit::Bytes(u64::MAX)).unwrap_err();
        let e = crate::common::in_time(2.0, name, read);
        assert!(e.message.contains("100000 × 100000 pixels are more than"), "{e}");
    }
}

/// The checksum of PNG.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { 0xEDB8_8320 ^ (c >> 1) } else { c >> 1 })
    })
}

/// The text of a strip of `n` squares.
fn strip(n: u32) -> String {
    let corners = (0..=n).map(|i| format!("v {i} 0 0\nv {i} 1 0\n"));
    let faces = (0..n).map(|i| 2 * i + 1).map(|a| format!("f {a} {} {} {}\n", a + 2, a + 3, a + 1));
    corners.chain(faces).collect()
}

#[test]
fn meshes() {
    let folder = tempfile::tempdir().unwrap();
    let path = write(&folder, "strip.obj", strip(100_000));
    assert_eq!(
        load_obj_within(&path, MemoryLimit::Bytes(100 * MEGABYTE)).unwrap().mesh.triangles.len(),
        200_000
    );
    let e = load_obj_within(&path, MemoryLimit::Bytes(3 * MEGABYTE)).unwrap_err();
    is_shortage(&e, "strip.obj` needs ");
    assert!(e.message.ends_with(" and 3 MB are there") && e.hint.is_some(), "{e}");
    // It is clear from the beginning.
    let e = load_obj_within(&path, MemoryLimit::Bytes(MEGABYTE / 10)).unwrap_err();
    assert_eq!(e.origin.map(|o| o.line), Some(1 << 14));
}

/// A fan of `n` corners around the first, in binary with indices of one or two bytes.
fn fan(n: u32, faces: u32, index: &str) -> Vec<u8> {
    let count = if n > 255 { "ushort" } else { "uchar" };
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {n}\nproperty float x\nproperty float y\n\
         property float z\nelement face {faces}\nproperty list {count} {index} vertex_indices\nend_header\n"
    )
    .into_bytes();
    for i in 0..n {
        // Of a circle, roughly: corners of a convex outline.
        let t = i as f32 / n as f32 - 0.5;
        [t, t * t, 0.0_f32].iter().for_each(|c| bytes.extend(c.to_le_bytes()));
    }
    let number = |kind: &str, value: u32| match kind {
        "uchar" => vec![value as u8],
        _ => (value as u16).to_le_bytes().to_vec(),
    };
    for _ in 0..faces {
        bytes.extend(number(count, n));
        (0..n).for_each(|i| bytes.extend(number(index, i)));
    }
    bytes
}

/// Short indices and large faces make meshes of many times the file: what is needed is told from the lists' lengths.
#[test]
fn meshes_that_grow() {
    let folder = tempfile::tempdir().unwrap();
    let scene = |name: &str| {
        let shape = format!("<shape type='ply'><string name='filename' value='{name}'/></shape>");
        write(&folder, "s.xml", format!("<scene version='3.0.0'><sensor type='perspective'/>{shape}</scene>"))
    };
    // By (corners, faces, the type of indices): bytes of the mesh for one of the file.
    let cases = [
        (3, 200_000, "uchar", 3.0),
        (4, 200_000, "uchar", 4.8),
        (200, 4000, "uchar", 11.8),
        (300, 300, "ushort", 5.9),
    ];
    for (corners, faces, index, growth) in cases {
        let bytes = fan(corners, faces, index);
        let mesh = 12 * u64::from(faces) * u64::from(corners - 2) + 12 * u64::from(corners);
        let found = mesh as f64 / bytes.len() as f64;
        assert!((found / growth - 1.0).abs() < 0.05, "{found}");
        // The file, its mesh, and a copy of that.
        let needed = 2 * mesh + bytes.len() as u64;
        write(&folder, "fan.ply", &bytes);
        load_within(&scene("fan.ply"), MemoryLimit::Bytes(needed)).unwrap();
        let e = load_within(&scene("fan.ply"), MemoryLimit::Bytes(needed - 1)).unwrap_err();
        is_shortage(&e, &format!("fan.ply` needs {} MB of memory", needed.div_ceil(MEGABYTE)));
        assert!(e.hint.is_some());
    }
    // Text, with attributes, normals and texture coordinates; and tables that it does not need.
    let text = "ply\nformat ascii 1.0\nelement other 2\nproperty list uchar int a\nproperty float b\n\
        element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n\
        property float nz\nproperty float u\nproperty float v\nproperty float r\nproperty float g\nproperty float b\n\
        element face 2\nproperty list uchar int vertex_indices\nproperty float heat_r\nend_header\n\
        2 7 7 1\n0 1\n0 0 0 0 0 1 0 0 1 1 1\n1 0 0 0 0 1 0 0 1 1 1\n1 1 0 0 0 1 0 0 1 1 1\n0 1 0 0 0 1 0 0 1 1 1\n\
        4 0 1 2 3 0.5\n3 0 1 2 0.25\n";
    write(&folder, "all.ply", text);
    let needed = 2 * (4 * (12 + 12 + 8 + 12) + 3 * (12 + 12)) + text.len() as u64;
    load_within(&scene("all.ply"), MemoryLimit::Bytes(needed)).unwrap();
    is_shortage(
        &load_within(&scene("all.ply"), MemoryLimit::Bytes(needed - 1)).unwrap_err(),
        "all.ply` needs",
    );
}

/// Scenes hand the limit on to what they name, and every copy of a mesh counts.
#[test]
fn scenes() {
    let folder = tempfile::tempdir().unwrap();
    write(&folder, "strip.obj", strip(30_000));
    write(&folder, "a.png", png(300, 200, &vec![7; 300 * 200 * 3]));
    let scene = |inner: &str| {
        let text = format!(
            "<scene><camera type='perspective'/><integrator type='bdpt'/>\n{inner}\n\
             <emitter type='point'><point name='position' value='0,0,0'/>\
             <color name='power' value='1,1,1'/></emitter></scene>"
        );
        write(&folder, "scene.xml", text)
    };
    let mesh = "<mesh type='obj'><string name='filename' value='strip.obj'/></mesh>";
    let texture = "<mesh type='sphere'><bsdf type='diffuse'><texture type='image_texture' name='albedo'>\
        <string name='filename' value='a.png'/></texture></bsdf></mesh>";
    for (inner, fragment) in [(mesh, "the mesh"), (texture, "the image")] {
        let path = scene(inner);
        load_within(&path, MemoryLimit::Bytes(100 * MEGABYTE)).unwrap();
        let e = load_within(&path, MemoryLimit::Bytes(MEGABYTE / 2)).unwrap_err();
        is_shortage(&e, fragment);
        assert!(e.origin.is_some(), "{e}");
    }
}

/// A few bytes ask for each mesh that stands for a stretched sphere.
#[test]
fn meshes_that_mitsuba_scenes_ask_for() {
    let folder = tempfile::tempdir().unwrap();
    let ball = "<shape type='sphere'><boolean name='flip_normals' value='true'/></shape>";
    let camera = "<sensor type='perspective'/>";
    let text = format!("<scene version='3.0.0'>{camera}{}</scene>", ball.repeat(50));
    let path = write(&folder, "balls.xml", text);
    is_shortage(&load_within(&path, MemoryLimit::Bytes(20 * MEGABYTE)).unwrap_err(), "the scene's meshes");
    assert!(load_within(&path, MemoryLimit::Bytes(500 * MEGABYTE)).is_ok());
}
