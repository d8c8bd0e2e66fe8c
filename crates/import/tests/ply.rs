//! Stanford PLY files.

use caustica_import::read_ply;
use caustica_math::{Vec2, Vec3};
use proptest::prelude::*;

const TEXT: &str = "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty double y\n\
    property float z\nproperty uchar red\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float s\n\
    property float t\nelement face 1\nproperty list uchar int vertex_indices\nelement edge 1\nproperty int a\n\
    end_header\n0 0 0 255 0 0 1 0 0\n1 0 0 9 0 0 1 1 0\n1 1 0 9 0 0 1 1 1\n0 1 .5 9 0 0 1 0 1\n4 0 1 2 3\n7\n";

/// The same file in binary.
fn binary(big: bool) -> Vec<u8> {
    let (head, body) = TEXT.split_once("end_header\n").unwrap();
    let name = if big { "binary_big_endian" } else { "binary_little_endian" };
    let mut bytes = format!("{}end_header\n", head.replace("ascii", name)).into_bytes();
    let mut push = |value: &[u8]| {
        let mut value = value.to_vec();
        if big {
            value.reverse();
        }
        bytes.extend(value);
    };
    for line in body.lines() {
        let words: Vec<f64> = line.split(' ').map(|w| w.parse().unwrap()).collect();
        match words.len() {
            9 => words.iter().enumerate().for_each(|(i, w)| match i {
                1 => push(&w.to_le_bytes()),
                3 => push(&[*w as u8]),
                _ => push(&(*w as f32).to_le_bytes()),
            }),
            5 => {
                push(&[4]);
                words[1..].iter().for_each(|w| push(&(*w as i32).to_le_bytes()));
            }
            _ => push(&(words[0] as i32).to_le_bytes()),
        }
    }
    bytes
}

#[test]
fn all_encodings_hold_the_same() {
    let read = read_ply(TEXT.as_bytes(), "m.ply").unwrap();
    assert_eq!(read.warnings, []);
    let mesh = read.mesh;
    assert_eq!(mesh.positions[3], Vec3::new(0.0, 1.0, 0.5));
    assert!(mesh.normals.iter().all(|n| *n == Vec3::Z) && mesh.normals.len() == 4);
    assert_eq!(mesh.uvs[2], Vec2::new(1.0, 1.0));
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    for big in [false, true] {
        assert_eq!(read_ply(&binary(big), "m.ply").unwrap().mesh, mesh, "{big}");
    }
    let windows = TEXT.replace('\n', "\r\n");
    assert_eq!(read_ply(windows.as_bytes(), "m.ply").unwrap().mesh, mesh);
}

#[test]
fn errors_have_lines() {
    for (old, new, message, line) in [
        ("ply\n", "plx\n", "does not start with `ply`", 1),
        ("ascii", "binary", "unknown format `binary`", 2),
        ("element vertex 4", "element vertex four", "not a number of elements", 4),
        ("property double y", "property complex y", "unknown property", 6),
        ("property float x", "property float w", "no x, y and z", 1),
        ("vertex_indices", "corners", "no list `vertex_indices`", 1),
        ("end_header\n", "", "unknown line", 18),
        ("4 0 1 2 3", "4 0 1 2 9", "there is no vertex 9", 23),
        ("4 0 1 2 3", "4 0 1 two 3", "`two` is not a number", 23),
        ("4 0 1 2 3", "-1", "too long", 23),
        ("0 0 0 255", "nan 0 0 255", "not finite", 19),
        ("element face 1", "element face 0", "no triangles", 1),
    ] {
        let text = TEXT.replacen(old, new, 1);
        let error = read_ply(text.as_bytes(), "m.ply").expect_err(message);
        assert!(error.to_string().contains(message), "{error}");
        assert_eq!(error.origin.as_ref().unwrap().line, line, "{error}");
    }
    let truncated = binary(false);
    let error = read_ply(&truncated[..truncated.len() - 30], "m.ply").unwrap_err();
    assert!(error.to_string().contains("ends too early"), "{error}");
}

#[test]
fn large_claims_take_no_memory() {
    let head = "ply\nformat binary_little_endian 1.0\nelement vertex 4294967295\nproperty float x\n\
        property float y\nproperty float z\nelement face 99999999999\nproperty list uchar int vertex_index\nend_header\n";
    assert!(read_ply(head.as_bytes(), "m.ply").unwrap_err().to_string().contains("too early"));
    let empty = "ply\nformat ascii 1.0\nelement nothing 18446744073709551615\nend_header\n";
    assert!(read_ply(empty.as_bytes(), "m.ply").is_err());
}

#[test]
fn faces_without_triangles_are_told() {
    let text = TEXT.replace("element face 1", "element face 2").replace("4 0 1 2 3", "4 0 1 2 3\n2 0 1");
    let read = read_ply(text.as_bytes(), "m.ply").unwrap();
    assert!(read.warnings[0].to_string().contains("1 faces have fewer"), "{:?}", read.warnings);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_files(
        which in 0..3_usize,
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        kept in 0.0..1.2_f64,
    ) {
        let mut bytes = [TEXT.as_bytes().to_vec(), binary(false), binary(true)][which].clone();
        for (at, byte) in edits {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        bytes.truncate((bytes.len() as f64 * kept.min(1.0)) as usize);
        match read_ply(&bytes, "m.ply") {
            Ok(read) => {
                let vertices = read.mesh.positions.len();
                prop_assert!(read.mesh.triangles.iter().flatten().all(|v| (*v as usize) < vertices));
                prop_assert!(read.mesh.positions.iter().all(|p| p.is_finite()));
                prop_assert!([0, vertices].contains(&read.mesh.normals.len()));
            }
            Err(error) => prop_assert!(error.origin.is_some(), "{error}"),
        }
    }
}
