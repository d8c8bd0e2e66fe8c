//! OBJ meshes.

use std::fmt::Write;

use caustica_import::{ObjMesh, load_obj, read_obj};
use caustica_math::{Vec2, Vec3};
use caustica_scene::description::Mesh;

fn read(text: &str) -> ObjMesh {
    read_obj(text.as_bytes(), "m.obj").unwrap_or_else(|e| panic!("{e}"))
}

fn good(text: &str) -> Mesh {
    let read = read(text);
    assert_eq!(read.warnings, []);
    read.mesh
}

/// Four corners of a unit square, counter-clockwise.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// Asserts an error at the `§` of the text, or on its last line without a column if there is none.
fn refused(marked: &str, fragment: &str) {
    let (before, after) = marked.split_once('§').unwrap_or((marked, ""));
    let error = read_obj(format!("{before}{after}").as_bytes(), "m.obj").expect_err(fragment);
    let shown = error.to_string();
    assert!(shown.contains(fragment), "{shown} does not contain {fragment}");
    let origin = error.origin.unwrap_or_else(|| panic!("no place: {shown}"));
    if !marked.contains('§') {
        assert_eq!(origin.line as usize, marked.lines().count().max(1), "{shown}");
    } else {
        assert_eq!(origin.line as usize, before.matches('\n').count() + 1, "{shown}");
        let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
        assert_eq!(origin.column as usize, column, "{shown}");
        assert_eq!(origin.span.unwrap().0, before.len(), "{shown}");
    }
}

fn warned(text: &str, fragment: &str, line: u32) -> Mesh {
    let read = read(text);
    assert_eq!(read.warnings.len(), 1, "{:?}", read.warnings);
    let shown = read.warnings[0].to_string();
    assert!(shown.contains(fragment), "{shown} does not contain {fragment}");
    assert_eq!(read.warnings[0].origin.as_ref().unwrap().line, line);
    read.mesh
}

#[test]
fn all_forms_of_corners() {
    let pools = "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n";
    for face in [
        "f 1 2 3",
        "f 1/1 2/2 3/3",
        "f 1//1 2//1 3//1",
        "f 1/1/1 2/2/1 3/3/1",
        "f -4/-3/-1 -3/-2/-1 -2/-1/-1",
    ] {
        let mesh = good(&format!("{SQUARE}{pools}{face}\n"));
        assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0)]);
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
        let with_uvs = face.contains("1/1") || face.contains("-4/-3");
        let uvs = [Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.0), Vec2::new(1.0, 1.0)];
        assert_eq!(mesh.uvs, if with_uvs { &uvs[..] } else { &[] }, "{face}");
        let with_normals = face.contains("1//1") || face.matches('/').count() == 6;
        assert_eq!(mesh.normals, if with_normals { &[Vec3::Z; 3][..] } else { &[] }, "{face}");
    }
}

#[test]
fn equal_corners_are_one_vertex_and_others_are_not() {
    let mesh = good(&format!(
        "{SQUARE}vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\nf 1/2 3/1 4/1\nf 1/2 3/1 2/1\n"
    ));
    assert_eq!(mesh.positions.len(), 5);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [4, 2, 3], [4, 2, 1]]);
}

#[test]
fn layout_of_the_text_does_not_matter() {
    let text = "# comment \\\r\n\u{feff}\n\r\n  v\t0 0 0 1.0\r\nv 1 0 0 .5 .5 .5\r\nv 1 \\\r\n 1 0\r\nmtllib a.mtl\r\n\
        o x\ng y\ns off\nusemtl z\nvp 0\nl 1 2\np 1\nvt .5\nvt 1 2 3\nf 1/1 \\\n2/2 3/1 # end\nf 1 2 3";
    let read = read(text);
    assert_eq!(read.mesh.triangles.len(), 2);
    assert_eq!(read.mesh.uvs[0], Vec2::new(0.5, 0.0));
    assert_eq!(read.mesh.uvs[1], Vec2::new(1.0, 2.0));
}

#[test]
fn polygons() {
    let mesh = good(&format!("{SQUARE}f 1 2 3 4\n"));
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    // A notch at the second corner: a fan from the first would cover what is outside.
    let mesh = good("v -2 0 0\nv 0 1 0\nv 2 0 0\nv 0 3 0\nf 1 2 3 4\n");
    let area: f32 = mesh
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
            (b - a).cross(c - a).length() / 2.0
        })
        .sum();
    assert!((area - 4.0).abs() < 1e-6);
}

#[test]
fn polygons_on_every_plane_keep_their_winding() {
    let hexagon = [(2.0, 0.0), (1.0, 1.0), (0.0, 0.2), (-1.0, 1.0), (-2.0, 0.0), (0.0, -1.0)];
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            let mut text = String::new();
            for (u, v) in hexagon {
                let mut p = [0.0; 3];
                (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (u, v * sign);
                writeln!(text, "v {} {} {}", p[0], p[1], p[2]).unwrap();
            }
            let mesh = good(&format!("{text}f 1 2 3 4 5 6\n"));
            assert_eq!(mesh.triangles.len(), 4);
            for t in &mesh.triangles {
                let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
                let n = (b - a).cross(c - a);
                assert!([n.x, n.y, n.z][axis] * sign as f32 > 0.0);
            }
        }
    }
}

#[test]
fn faces_without_normals_get_their_own_if_others_have_some() {
    let mesh = good(&format!("{SQUARE}v 0 0 1\nvn 1 0 0\nf 1//1 2//1 3//1\nf 1 3 4\nf 1 4 5\n"));
    assert_eq!(mesh.normals.len(), mesh.positions.len());
    let normals = |t: usize| mesh.triangles[t].map(|v| mesh.normals[v as usize]);
    assert_eq!(normals(0), [Vec3::X; 3]);
    assert_eq!(normals(1), [Vec3::Z; 3]);
    assert_eq!(normals(2), [Vec3::X; 3]);
}

#[test]
fn normals_without_length_are_replaced() {
    let text = format!("{SQUARE}vn 0 0 0\nvn 0 1 0\nf 1//1 2//2 3//2\n");
    let mesh = warned(&text, "1 normal of zero length", 5);
    assert_eq!(mesh.normals, [Vec3::Z, Vec3::Y, Vec3::Y]);
    let text = format!("{SQUARE}vn 0 0 0\nf 1//1 2//1 3//1\n");
    assert!(warned(&text, "1 normal of zero length", 5).normals.is_empty());
}

#[test]
fn missing_texture_coordinates_are_zero() {
    let mesh = warned(&format!("{SQUARE}vt 1 1\nf 1/1 2/1 3/1\nf 1 3 4\n"), "only some faces", 1);
    assert_eq!(mesh.uvs[mesh.triangles[0][0] as usize], Vec2::new(1.0, 1.0));
    assert_eq!(mesh.uvs[mesh.triangles[1][0] as usize], Vec2::new(0.0, 0.0));
}

#[test]
fn faces_without_area_are_left_out() {
    let mesh = warned(&format!("{SQUARE}f 1 1 2\nf 1 2 1 2\nf 1 2 3\n"), "2 faces without area", 5);
    assert_eq!(mesh.triangles.len(), 1);
}

#[test]
fn unknown_statements() {
    let text = format!("{SQUARE}curv2 1 2\nhello\nf 1 2 3\n");
    warned(&text, "2 unknown statements, first `curv2`", 5);
}

#[test]
fn errors() {
    refused("v 0 0 §x\n", "`x` is not a number");
    refused("v 0 §NaN 0\n", "finite");
    refused("v 0 0 §inf\n", "finite");
    refused("v 0 0 §1e99\n", "finite");
    refused("vt §nan\n", "finite");
    refused("vn 0 0 §-inf\n", "finite");
    refused("v 0 0 0 §y\n", "`y` is not a number");
    refused("\n §v 0 0\n", "`v` needs 3 numbers, and here are 2");
    refused("§vn\n", "`vn` needs 3 numbers");
    refused("§vt\n", "`vt` needs 1 numbers");
    let face = |marked: &str| format!("{SQUARE}{marked}\n");
    refused(&face("§f 1 2"), "at least 3 corners, and this one has 2");
    refused(&face("§f"), "this one has 0");
    refused(&face("f 1 2 §5"), "there is no vertex 5: there are 4 so far");
    refused(&face("f 1 2 §-5"), "there is no vertex -5");
    refused(&face("f 1 §0 2"), "indices count from 1");
    refused(&face("f 1/§1 2 3"), "there is no texture coordinate 1");
    refused(&face("f 1 2 3//§1"), "there is no normal 1");
    refused(&face("f 1 2 §x"), "`x` is not an index");
    refused(&face("f 1 2 §/1"), "is not an index");
    refused(&face("f 1 2 §1/2/3/4"), "at most three indices");
    refused(&face("f 1 2 §99999999999999999999"), "is not an index");
    refused(&face("f 1 2 §4294967297"), "there is no vertex 4294967297");
    refused(&face("f 1 \\\n  §0 2"), "indices count from 1");
    refused("# é\nv é§0\n".replace("é§0", "0 §é").as_str(), "`é` is not a number");
}

#[test]
fn meshes_without_faces() {
    refused("", "the mesh has no faces");
    refused(SQUARE, "the mesh has no faces");
    refused(&format!("{SQUARE}f 1 1 1\n"), "no face with an area");
    refused("\0\u{1}binary\n", "no faces");
}

#[test]
fn a_line_without_end_is_refused() {
    let error =
        read_obj(std::io::Read::take(std::io::repeat(b'x'), 1 << 30).buffered(), "m.obj").unwrap_err();
    assert!(error.message.contains("longer than 16 MiB"), "{error}");
}

trait Buffered: std::io::Read + Sized {
    fn buffered(self) -> std::io::BufReader<Self> {
        std::io::BufReader::new(self)
    }
}
impl<R: std::io::Read> Buffered for R {}

/// Found by fuzzing: the place of the error was a line that the file does not have.
#[test]
fn a_continued_last_line_is_counted_once() {
    for text in ["g\n \\\n ", "g\n \\\n\\\n", "g\n\\\r\n"] {
        let line = read_obj(text.as_bytes(), "m.obj").unwrap_err().origin.unwrap().line as usize;
        assert_eq!(line, text.lines().count(), "{text:?}");
    }
}

/// Found with the one above: a line of blanks after a backslash went on into the next statement.
#[test]
fn a_line_of_blanks_ends_a_continued_line() {
    let mesh = good("v 0 0 0 \\\n \nv 1 0 0\nv 0 1 0\nf 1 2 \\\n3\n");
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (3, 1));
}

#[test]
fn files_that_are_none() {
    let folder = tempfile::tempdir().unwrap();
    let error = load_obj(folder.path()).unwrap_err();
    assert!(error.message.contains("not a regular file"), "{error}");
    let error = load_obj(&folder.path().join("x.obj")).unwrap_err();
    assert!(error.message.contains("there is no such file"), "{error}");
}

/// Also a coarse guard of the speed: the time it takes is far below the limit in optimised builds.
#[test]
fn a_million_triangles() {
    let side = 708;
    let mut text = String::new();
    for y in 0..=side {
        for x in 0..=side {
            writeln!(text, "v {}.125 {}.25 0.5\nvt 0.{x} 0.{y}\nvn 0 0 1", x, y).unwrap();
        }
    }
    for y in 0..side {
        for x in 0..side {
            let i = y * (side + 1) + x + 1;
            let [a, b, c, d] = [i, i + 1, i + side + 2, i + side + 1];
            writeln!(text, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c} {d}/{d}/{d}").unwrap();
        }
    }
    let mesh = crate::common::in_time(20.0, "a large mesh", || good(&text));
    assert_eq!(mesh.triangles.len(), 2 * side * side);
    assert_eq!(mesh.positions.len(), (side + 1) * (side + 1));
}
