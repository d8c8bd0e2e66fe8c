//! No Mitsuba file makes the reader panic, hang or lose the place of an error.

use std::path::Path;

use caustica_import::parse_mitsuba;
use proptest::prelude::*;

const SCENE: &str = r##"<?xml version="1.0"?>
<scene version="3.0.0">
  <default name="spp" value="16"/><default name="kind" value="thinlens"/>
  <integrator type="path"><integer name="max_depth" value="-1"/></integrator>
  <sensor type="$kind">
    <float name="fov" value="45.5"/><string name="fov_axis" value="smaller"/>
    <float name="aperture_radius" value=".1"/><float name="focus_distance" value="4"/>
    <transform name="to_world"><lookat target="0, 0, 0" origin="1, 2, 3" up="0, 1, 0"/><rotate angle="3" z="1"/></transform>
    <sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>
    <film type="hdrfilm"><integer name="width" value="80"/><rfilter type="mitchell"/></film>
  </sensor>
  <bsdf type="dielectric" id="glass"><string name="int_ior" value="bk7"/></bsdf><alias id="glass" as="g"/>
  <shape type="sphere"><point name="center" x="1" y="2"/><ref id="g"/></shape>
  <shape type="rectangle"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
    <rgb name="color0" value="#102030"/><transform name="to_uv"><scale value="4"/></transform></texture></bsdf>
    <emitter type="area"><spectrum name="radiance" value="400:0, 500:8, 600:15.6"/></emitter></shape>
  <emitter type="point"><rgb name="intensity" value="3 2 1"/></emitter>
</scene>"##;

const WORDS: &[&str] = &[
    "<",
    ">",
    "/",
    "\"",
    "&",
    "-",
    "0",
    "nan",
    "1e999",
    "$",
    "$spp",
    "id=",
    "<ref id='g'/>",
    "<include filename='x'/>",
    "<shape type='cube'>",
    "#",
    ":",
];

fn check(text: &str) {
    let Err(error) = parse_mitsuba(text, "s.xml", Path::new("/nowhere"), &[]) else { return };
    crate::common::check_place(&error, text);
}

#[test]
fn the_original_is_valid_and_no_part_of_it_is() {
    let loaded = parse_mitsuba(SCENE, "s.xml", Path::new("/nowhere"), &[]).unwrap();
    assert_eq!(loaded.warnings, []);
    for length in 0..SCENE.len() {
        check(&SCENE[..length]);
        assert!(parse_mitsuba(&SCENE[..length], "s.xml", Path::new("/nowhere"), &[]).is_err());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn edited_scenes(edits in crate::common::edits(WORDS)) {
        let bytes = crate::common::edited(SCENE, &edits);
        check(&String::from_utf8_lossy(&bytes));
    }
}

#[test]
fn hostile_scenes_end_in_time() {
    let in_time = |what: &str, text: String| {
        crate::common::in_time(20.0, what, || check(&text));
    };
    let scene = |inner: &str| format!("<scene version='3.0.0'><sensor type='perspective'/>{inner}</scene>");
    in_time("deep nesting", "<scene version='3.0.0'>".repeat(200_000));
    let mut doubling = "<default name='a0' value='xxxxxxxx'/>".to_owned();
    (1..60).for_each(|i| doubling += &format!("<default name='a{i}' value='$a{0}$a{0}'/>", i - 1));
    in_time("doubling variables", scene(&doubling));
    let mut chain = "<bsdf type='diffuse' id='b0'/>".to_owned();
    (1..50_000)
        .for_each(|i| chain += &format!("<bsdf type='twosided' id='b{i}'><ref id='b{}'/></bsdf>", i - 1));
    in_time("a chain of references", scene(&chain));
    in_time("many shapes", scene(&"<shape type='rectangle'/>".repeat(50_000)));
    in_time("many spheres as meshes", scene(&"<shape type='disk'/>".repeat(2000)));
}
