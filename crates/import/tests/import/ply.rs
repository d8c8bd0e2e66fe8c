//! Stanford PLY files.

use caustica_import::read_ply;
use caustica_math::{Rgb, Vec2, Vec3};
use caustica_scene::description::Domain;
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

/// A square whose vertices and faces have those properties, each counted from the first: in rows of 0 0.1 0.2 …, of
/// bytes 0 51 102 ….
fn with_properties(kind: &str, of_vertices: &str, of_faces: &str) -> Vec<u8> {
    let properties = |names: &str| -> String {
        names.split_whitespace().map(|n| format!("property {kind} {n}\n")).collect()
    };
    let values = |names: &str| -> String {
        let value = |i: usize| if kind == "uchar" { (51 * i).to_string() } else { format!("0.{i}") };
        names.split_whitespace().enumerate().map(|(i, _)| format!(" {}", value(i))).collect()
    };
    let corner = |at: &str| format!("{at}{}\n", values(of_vertices));
    format!(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n{}\
         element face 2\nproperty list uchar int vertex_indices\n{}end_header\n{}4 0 1 2 3{}\n2 0 1{}\n",
        properties(of_vertices),
        properties(of_faces),
        ["0 0 0", "1 0 0", "1 1 0", "0 1 0"].map(corner).concat(),
        values(of_faces),
        values(of_faces),
    )
    .into_bytes()
}

/// Names and first values as Mitsuba 3.9 has them, but for bytes, which it does not divide.
#[test]
fn attributes_are_named_as_mitsuba_names_them() {
    let found = |kind: &str, properties: &str| -> Vec<(String, [f32; 3])> {
        let mesh = read_ply(&with_properties(kind, properties, ""), "m.ply").unwrap().mesh;
        assert!(mesh.attributes.iter().all(|a| a.domain == Domain::Vertex && a.values.len() == 4));
        mesh.attributes.into_iter().map(|a| (a.name, a.values[0].0)).collect()
    };
    for (properties, name, value) in [
        ("r g b", "vertex_color", [0.0, 0.1, 0.2]),
        ("b g r", "vertex_color", [0.2, 0.1, 0.0]),
        ("red green blue", "vertex_color", [0.0, 0.1, 0.2]),
        ("red green blue r g b", "vertex_color", [0.3, 0.4, 0.5]),
        ("k r g b", "vertex_color", [0.1, 0.2, 0.3]),
        ("k heat_x", "vertex_heat", [0.1; 3]),
        ("k heat_1", "vertex_heat", [0.1; 3]),
        ("k heat_r", "vertex_heat_color", [0.1; 3]),
        ("heat_r heat_g heat_b", "vertex_heat_color", [0.0, 0.1, 0.2]),
        ("long_name_x long_name_y long_name_z", "vertex_long_name", [0.0, 0.1, 0.2]),
        ("heat_0 heat_1 heat_2", "vertex_heat", [0.0, 0.1, 0.2]),
        ("heat_1 heat_2 heat_3", "vertex_heat", [0.0, 0.1, 0.2]),
    ] {
        assert_eq!(found("float", properties), [(name.to_owned(), value)], "{properties}");
    }
    for none in
        ["k", "color", "r g", "heat_x heat_y", "heat_y", "heat_r heat_g heat_b heat_a", "texture_u nx"]
    {
        assert_eq!(found("float", none), [], "{none}");
    }
    let two = found("float", "a_r b_r");
    assert_eq!(two, [("vertex_a_color".into(), [0.0; 3]), ("vertex_b_color".into(), [0.1; 3])]);
    // No name comes twice.
    assert_eq!(found("float", "r g b color_x"), [("vertex_color".into(), [0.0, 0.1, 0.2])]);
    // Colours in bytes are parts of 255, other numbers are not.
    assert_eq!(found("uchar", "r g b"), [("vertex_color".into(), [0.0, 0.2, 0.4])]);
    assert_eq!(found("uchar", "k heat_x"), [("vertex_heat".into(), [51.0; 3])]);
}

/// A face of four corners has the value of both its triangles; one without triangles has none.
#[test]
fn attributes_of_faces() {
    let mesh = read_ply(&with_properties("float", "", "r g b h_1"), "m.ply").unwrap().mesh;
    assert_eq!(mesh.triangles.len(), 2);
    let [colour, number] = &mesh.attributes[..] else { panic!("{:?}", mesh.attributes) };
    assert_eq!((colour.name.as_str(), colour.domain), ("face_color", Domain::Face));
    assert_eq!(colour.values, [Rgb([0.0, 0.1, 0.2]); 2]);
    assert_eq!((number.name.as_str(), &number.values[..]), ("face_h", &[Rgb::splat(0.3); 2][..]));
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

/// Also in what nobody asks for.
#[test]
fn all_numbers_of_a_text_are_numbers() {
    let extra = TEXT.replacen("element face", "element edge 1\nproperty list int int pair\nelement face", 1);
    let with = |row: &str| extra.replacen("4 0 1 2 3", &format!("{row}\n4 0 1 2 3"), 1);
    read_ply(with("2 0 1").as_bytes(), "m.ply").unwrap();
    let error = read_ply(with("2 0 one").as_bytes(), "m.ply").unwrap_err().to_string();
    assert!(error.contains("`one` is not a number"), "{error}");
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
        which in 0..5_usize,
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        kept in 0.0..1.2_f64,
    ) {
        let attributed = ["float", "uchar"].map(|kind| with_properties(kind, "r g b h_0", "red green blue k_x"));
        let [floats, bytes] = attributed;
        let mut bytes =
            [TEXT.as_bytes().to_vec(), binary(false), binary(true), floats, bytes][which].clone();
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
                let names: std::collections::BTreeSet<&str> =
                    read.mesh.attributes.iter().map(|a| a.name.as_str()).collect();
                prop_assert_eq!(names.len(), read.mesh.attributes.len());
            }
            Err(error) => prop_assert!(error.origin.is_some(), "{error}"),
        }
    }
}
