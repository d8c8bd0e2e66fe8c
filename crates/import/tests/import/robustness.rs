//! No input makes the readers panic, hang or lose the place of an error.

use std::path::Path;

use caustica_import::{parse_nori, read_obj};
use proptest::prelude::*;

const SCENE: &str = r#"<?xml version="1.0"?>
<scene>
  <integrator type="path_mis"/>
  <sampler type="independent"><integer name="sampleCount" value="4"/></sampler>
  <camera type="thinlens">
    <float name="fov" value="45.5"/><integer name="width" value="800"/>
    <float name="lensRadius" value=".1"/><float name="focalDistance" value="4"/>
    <transform name="toWorld"><lookat target="0, 0, 0" origin="1, 2, 3" up="0, 1, 0"/>
      <matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"/><rotate angle="3" axis="0,0,1"/></transform>
    <rfilter type="mitchell"><float name="B" value=".5"/></rfilter>
  </camera>
  <mesh type="sphere"><point name="center" value="1 2 3"/>
    <bsdf type="diffuse"><texture type="checkerboard_color" name="albedo"><vector name="scale" value=".1 .1"/></texture></bsdf>
    <emitter type="area"><color name="radiance" value="10, 20.5, 3e1"/></emitter></mesh>
  <emitter type="spotlight"><point name="target" value="1 0 0"/><float name="power" value="3"/>
    <float name="outerAngle" value="40"/></emitter>
  <test type="ttest"><string name="angles" value="0 1"/><string name="references" value=".1 .2"/>
    <bsdf type="microfacet"/></test>
</scene>"#;

const MESH: &str = "# a mesh\nv 0 0 0\nv 1.5 0 -.5\nv 1 1e0 0\nv 0 1 0\nv .5 .5 .1\nvt 0 0\nvt 1 1\nvn 0 0 1\n\
    f 1/1/1 2/2/1 3/1/1 \\\n 4/2/1\ng x\nf -5//1 -4//1 -1//1\nf 1 2 5 3 4\n";

const WORDS: &[&str] =
    &["<", ">", "/", "\"", "&", "-", "0", "nan", "1e999", "\\\n", "<!--", "<mesh type='obj'>"];

fn check_scene(text: &str) {
    if let Err(error) = parse_nori(text, "s.xml", Path::new("/nowhere")) {
        crate::common::check_place(&error, text);
    }
}

fn check_mesh(bytes: &[u8]) {
    match read_obj(bytes, "m.obj") {
        Err(error) => {
            let line = error.origin.as_ref().unwrap_or_else(|| panic!("no place: {error}")).line as usize;
            assert!((1..=bytes.iter().filter(|b| **b == b'\n').count() + 1).contains(&line), "{error}");
        }
        Ok(read) => {
            let mesh = read.mesh;
            let vertices = mesh.positions.len();
            assert!(!mesh.triangles.is_empty());
            assert!(mesh.triangles.iter().flatten().all(|v| (*v as usize) < vertices));
            assert!(mesh.positions.iter().all(|p| p.is_finite()));
            assert!(mesh.normals.is_empty() || mesh.normals.len() == vertices);
            assert!(mesh.normals.iter().all(|n| n.try_normalized().is_some()));
            assert!(mesh.uvs.is_empty() || mesh.uvs.len() == vertices);
        }
    }
}

#[test]
fn the_originals_are_valid() {
    assert_eq!(crate::common::parse(SCENE).unwrap().warnings, []);
    read_obj(MESH.as_bytes(), "m.obj").unwrap();
}

#[test]
fn every_truncation() {
    for length in 0..SCENE.len() {
        check_scene(&SCENE[..length]);
        assert!(crate::common::parse(&SCENE[..length]).is_err(), "{length}");
    }
    for length in 0..MESH.len() {
        check_mesh(&MESH.as_bytes()[..length]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn edited_scenes(edits in crate::common::edits(WORDS)) {
        check_scene(&String::from_utf8_lossy(&crate::common::edited(SCENE, &edits)));
    }

    #[test]
    fn edited_meshes(edits in crate::common::edits(WORDS)) {
        check_mesh(&crate::common::edited(MESH, &edits));
    }

    #[test]
    fn noise(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        check_scene(&String::from_utf8_lossy(&bytes));
        check_mesh(&bytes);
    }

    #[test]
    fn random_polygons(points in prop::collection::vec((-4..4_i8, -4..4_i8, -1..2_i8), 3..40)) {
        let mut text: String = points.iter().map(|(x, y, z)| format!("v {x} {y} {z}\n")).collect();
        text.push('f');
        (1..=points.len()).for_each(|i| text.push_str(&format!(" {i}")));
        check_mesh(text.as_bytes());
    }
}

fn in_time(what: &str, run: impl FnOnce()) {
    crate::common::in_time(20.0, what, run);
}

#[test]
fn large_hostile_scenes() {
    let long_line = crate::common::scene(&"<mesh type='sphere' name='a'/>".repeat(50_000));
    in_time("a scene on one line", || check_scene(&long_line));
    in_time("deep nesting", || check_scene(&"<scene>".repeat(300_000)));
    in_time("deep transforms", || {
        let (open, close) = ("<scale value='1,1,1'>", "</scale>");
        check_scene(&format!("{}{}", open.repeat(100_000), close.repeat(100_000)));
    });
    in_time("a long name", || check_scene(&format!("<scene><{}/></scene>", "m".repeat(4 << 20))));
    in_time("a long value", || {
        let value = "1 ".repeat(2 << 20);
        check_scene(&crate::common::scene(&format!(
            "<mesh type='sphere'><point name='c' value='{value}'/></mesh>"
        )));
    });
    in_time("references", || {
        let value = "&#49;".repeat(500_000);
        check_scene(&crate::common::scene(&format!("<float name='{value}' value='{value}'/>")));
    });
}

#[test]
fn large_hostile_meshes() {
    in_time("one position with many texture coordinates", || {
        let mut text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n".to_owned() + &"vt 0 0\n".repeat(200_000);
        (1..=200_000).for_each(|i| text.push_str(&format!("f 1/{i} 2/{i} 3/{i}\n")));
        check_mesh(text.as_bytes());
    });
    in_time("a jagged polygon", || {
        let mut text = String::new();
        (0..4096).for_each(|i| text.push_str(&format!("v {i} {} 0\n", if i == 0 { 9 } else { i % 2 })));
        text.push('f');
        (1..=4096).for_each(|i| text.push_str(&format!(" {i}")));
        check_mesh(text.as_bytes());
    });
    in_time("many line continuations", || check_mesh("f \\\n".repeat(1 << 20).as_bytes()));
    in_time("one long polygon", || {
        check_mesh(format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf{}\n", " 1 2 3".repeat(500_000)).as_bytes());
    });
}
