//! No Mitsuba file makes the reader panic, hang or lose the place of an error.

use std::path::Path;
use std::time::{Duration, Instant};

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

/// A change of a text: bytes from one place replaced by others.
fn edits() -> impl Strategy<Value = Vec<(prop::sample::Index, usize, Vec<u8>)>> {
    let words = [
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
    let fresh = prop_oneof![
        prop::collection::vec(any::<u8>(), 0..4),
        prop::sample::select(words.to_vec()).prop_map(|s| s.as_bytes().to_vec()),
    ];
    prop::collection::vec((any::<prop::sample::Index>(), 0..6_usize, fresh), 1..5)
}

fn check(text: &str) {
    let Err(error) = parse_mitsuba(text, "s.xml", Path::new("/nowhere"), &[]) else { return };
    let origin = error.origin.as_ref().unwrap_or_else(|| panic!("no place: {error}"));
    assert!(origin.line >= 1 && origin.line as usize <= text.matches('\n').count() + 1, "{error}");
    if let Some((start, length)) = origin.span {
        assert!(start + length <= text.len() + 1, "{error}");
    }
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
    fn edited_scenes(edits in edits()) {
        let mut bytes = SCENE.as_bytes().to_vec();
        for (index, removed, added) in edits {
            let at = index.index(bytes.len() + 1);
            let end = (at + removed).min(bytes.len());
            bytes.splice(at..end, added);
        }
        check(&String::from_utf8_lossy(&bytes));
    }
}

#[test]
fn hostile_scenes_end_in_time() {
    let in_time = |what: &str, text: String| {
        let start = Instant::now();
        check(&text);
        assert!(start.elapsed() < Duration::from_secs(20), "{what} took {:?}", start.elapsed());
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
