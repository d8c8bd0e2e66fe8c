//! Where inputs start from.

use caustica_film::{
    DualFilm, FilmFacts, FilmLayout, LightImage, Metadata, Picture, Provenance, Window, write_film,
};
use caustica_math::Rgb;

use crate::folder;

/// The smallest mesh.
pub const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// What faces, corners and lines may look like.
const MESH: &str = "# a mesh\nv 0 0 0\nv 1.5 0 -.5\nv 1 1e0 0\nv 0 1 0\nv .5 .5 .1\nvt 0 0\nvt 1 1\nvn 0 0 1\n\
    f 1/1/1 2/2/1 3/1/1 \\\n 4/2/1\ng x\nf -5//1 -4//1 -1//1\nf 1 2 5 3 4\n";

/// Scenes of the gallery.
const GALLERY: [&str; 7] = [
    include_str!("../../../scenes/cornell/cornell.xml"),
    include_str!("../../../scenes/furnace/furnace.xml"),
    include_str!("../../../scenes/final/final.xml"),
    include_str!("../../../scenes/glass/glass.xml"),
    include_str!("../../../scenes/gap/gap.xml"),
    include_str!("../../../scenes/bulb/bulb.xml"),
    include_str!("../../../scenes/veach-mi/veach-mi.xml"),
];

/// Most plugins and properties in one scene.
const FEATURES: &str = r#"<?xml version="1.0"?>
<scene>
  <integrator type="path_mis"/>
  <sampler type="independent"><integer name="sampleCount" value="4"/></sampler>
  <camera type="thinlens">
    <float name="fov" value="45.5"/><integer name="width" value="80"/><integer name="height" value="60"/>
    <float name="lensRadius" value=".1"/><float name="focalDistance" value="4"/>
    <transform name="toWorld"><lookat target="0, 0, 0" origin="1, 2, 3" up="0, 1, 0"/>
      <matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"/><rotate angle="3" axis="0,0,1"/></transform>
    <rfilter type="mitchell"><float name="B" value=".5"/></rfilter>
  </camera>
  <mesh type="sphere"><point name="center" value="1 2 3"/><float name="radius" value="0.5"/>
    <bsdf type="diffuse"><texture type="checkerboard_color" name="albedo">
      <vector name="scale" value=".1 .1"/></texture></bsdf>
    <emitter type="area"><color name="radiance" value="10, 20.5, 3e1"/></emitter></mesh>
  <mesh type="obj"><string name="filename" value="tri.obj"/>
    <transform name="toWorld"><scale value="2,2,-2"/><translate value="0,0,5"/></transform>
    <bsdf type="microfacet"><float name="alpha" value=".3"/>
      <texture type="image_texture" name="kd"><string name="filename" value="tile.png"/></texture></bsdf></mesh>
  <emitter type="spotlight"><point name="target" value="1 0 0"/><float name="power" value="3"/>
    <float name="outerAngle" value="40"/></emitter>
  <emitter type="envmap"><string name="filename" value="sky.exr"/><float name="scale" value="0.5"/></emitter>
</scene>"#;

/// A scene file that carries tests.
const TESTS: &str = r#"<scene>
  <test type="ttest"><string name="angles" value="0 1"/><string name="references" value=".1 .2"/>
    <bsdf type="roughconductor"><string name="material" value="Au"/></bsdf></test>
  <test type="ttest"><string name="references" value="1"/>
    <scene><camera type="orthographic"/><integrator type="av"><float name="length" value="1"/></integrator>
      <mesh type="sphere"><bsdf type="roughdielectric"/></mesh><emitter type="constant">
      <color name="radiance" value="1,1,1"/></emitter></scene></test>
  <test type="chi2test"><integer name="resolution" value="8"/><bsdf type="dielectric"/></test>
</scene>"#;

/// Most of what Mitsuba's scenes are made of.
const MITSUBA: [&str; 3] = [
    include_str!("solids.xml"),
    r##"<?xml version="1.0"?>
<scene version="3.0.0">
  <default name="spp" value="16"/><default name="kind" value="thinlens"/><path value="."/>
  <integrator type="aov"><string name="aovs" value="dd.y:depth,nn:sh_normal"/><integrator type="path" name="a">
    <integer name="max_depth" value="-1"/></integrator></integrator>
  <sensor type="$kind">
    <float name="fov" value="45.5"/><string name="fov_axis" value="smaller"/>
    <float name="aperture_radius" value=".1"/><float name="focus_distance" value="4"/>
    <transform name="to_world"><lookat target="0, 0, 0" origin="1, 2, 3" up="0, 1, 0"/><rotate angle="3" z="1"/></transform>
    <sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>
    <film type="hdrfilm"><integer name="width" value="80"/><rfilter type="mitchell"/></film>
  </sensor>
  <bsdf type="dielectric" id="glass"><string name="int_ior" value="bk7"/></bsdf><alias id="glass" as="g"/>
  <shape type="sphere"><point name="center" x="1" y="2"/><boolean name="flip_normals" value="true"/><ref id="g"/></shape>
  <shape type="rectangle"><bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
    <rgb name="color0" value="#102030"/><transform name="to_uv"><scale value="4"/></transform></texture></bsdf>
    <emitter type="area"><spectrum name="radiance" value="400:0, 500:8, 600:15.6"/></emitter></shape>
  <shape type="shapegroup" id="group"><shape type="cube"/><shape type="disk"><ref id="glass"/></shape></shape>
  <shape type="instance"><ref id="group"/><transform name="to_world"><scale x="-2"/><translate value="0 3 1"/></transform></shape>
  <emitter type="point"><rgb name="intensity" value="3 2 1"/></emitter>
  <emitter type="envmap"><string name="filename" value="sky.exr"/><float name="scale" value="0.5"/></emitter>
</scene>"##,
    r#"<scene version="0.6.0">
  <integrator type="bdpt"/><sensor type="perspective"><float name="fov" value="30"/><transform name="toWorld">
    <matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"/></transform></sensor>
  <include filename="part.xml"/>
  <shape type="serialized"><string name="filename" value="m.serialized"/><integer name="shapeIndex" value="1"/>
    <bsdf type="roughconductor"><string name="material" value="Au"/><float name="alpha" value=".2"/></bsdf></shape>
  <shape type="ply"><string name="filename" value="m.ply"/><boolean name="faceNormals" value="true"/></shape>
  <shape type="obj"><string name="filename" value="tri.obj"/><bsdf type="twosided"><bsdf type="diffuse">
    <texture type="bitmap" name="reflectance"><string name="filename" value="tile.png"/></texture></bsdf></bsdf></shape>
  <shape type="cylinder"><point name="p0" x="1" y="2" z="3"/><float name="radius" value="0.5"/>
    <bsdf type="diffuse"><spectrum name="reflectance" filename="curve.spd"/></bsdf></shape>
  <emitter type="directional"><vector name="direction" x="1"/><blackbody name="irradiance" temperature="5000"/></emitter>
</scene>"#,
];

/// A part that a scene includes.
pub const PART: &str =
    "<scene version=\"3.0.0\"><shape type=\"sphere\"><bsdf type=\"plastic\" id=\"inner\"/></shape></scene>";

/// Scene files of Mitsuba's.
pub fn mitsuba_xml() -> Vec<Vec<u8>> {
    MITSUBA.iter().map(|text| text.as_bytes().to_vec()).collect()
}

/// Scene files; their meshes become the one that is there.
pub fn nori_xml() -> Vec<Vec<u8>> {
    let small = |text: &str| {
        let parts: Vec<&str> = text.split("value=\"meshes/").collect();
        let rest = parts[1..].iter().map(|part| part.split_once(".obj").map_or(*part, |(_, rest)| rest));
        std::iter::once(parts[0].to_owned()).chain(rest.map(|r| format!("value=\"tri.obj{r}"))).collect()
    };
    let gallery = GALLERY.iter().map(|text| -> String { small(text) });
    gallery.chain([FEATURES.to_owned(), TESTS.to_owned()]).map(String::into_bytes).collect()
}

/// Meshes.
pub fn obj() -> Vec<Vec<u8>> {
    let gallery = [
        include_str!("../../../scenes/cornell/meshes/white.obj"),
        include_str!("../../../scenes/gap/meshes/door.obj"),
        include_str!("../../../scenes/long-way/meshes/shaft.obj"),
    ];
    let star = "v 0 3 0\nv -2 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3 4\n";
    gallery.into_iter().chain([TRIANGLE, MESH, star]).map(|text| text.as_bytes().to_vec()).collect()
}

/// Rendered pictures: a whole one, a crop, and one of a single pixel.
pub fn exr() -> Vec<Vec<u8>> {
    let windows = [[0, 0, 8, 6], [3, 2, 4, 3], [0, 0, 1, 1]];
    windows.iter().map(|window| film([8, 6], *window)).collect()
}

fn film([width, height]: [u32; 2], [x, y, w, h]: [u32; 4]) -> Vec<u8> {
    let ramp = |step: f32| (0..w * h).map(|i| Rgb::splat(i as f32 * step)).collect();
    let picture = Picture {
        width,
        height,
        window: Window { x, y, width: w, height: h },
        eye_samples: 4,
        light_samples: 4,
        eye: ramp(0.25),
        light: ramp(0.5),
        error: None,
        channels: Vec::new(),
    };
    let mut facts = Metadata::new();
    facts.set("seed", 7);
    let path = folder().path().join("seed.exr");
    caustica_film::write_exr(&path, &picture, LightImage::On, &facts).expect("a small picture");
    std::fs::read(path).expect("a small picture")
}

/// Film files; the first has sums beyond 64 bits, the last is larger than a chunk of them.
pub fn films() -> Vec<Vec<u8>> {
    let path = folder().path().join("seed.film");
    [[8, 6], [1, 1], [300, 220]]
        .into_iter()
        .map(|[width, height]| {
            let window = Window { x: 0, y: 0, width, height };
            let film = DualFilm::new(FilmLayout { width, height, window, quantum_exponent: -20 });
            let film = film.expect("a small film");
            for pass in 0..3 {
                (0..width * height).for_each(|i| {
                    film.half(pass).add_eye([i % width, i / width], Rgb::splat(i as f32));
                });
            }
            let huge = if height == 6 { 9 } else { 0 };
            for _ in 0..huge {
                film.half(0).add_eye([1, 2], Rgb::new(1e30, -1e30, 1.0));
                film.half(1).add_eye([3, 4], Rgb::new(-1e30, 1e30, 1.0));
            }
            film.finish_passes(0..3, true, true);
            let settings = [("seed".to_owned(), "3".to_owned())].into();
            let provenance = Provenance { scene: "s.xml".into(), scene_hash: "ab".into(), settings };
            let facts = FilmFacts { provenance, samples: (0..3).into(), seconds: 1.5 };
            write_film(&path, &film, &facts).expect("a temporary file");
            std::fs::read(&path).expect("a film that was just written")
        })
        .collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_seed_is_good() {
        let folder = tempfile::tempdir().unwrap();
        for seed in super::obj() {
            caustica_import::read_obj(&seed[..], "m.obj").unwrap();
        }
        for seed in super::exr() {
            let path = folder.path().join("f.exr");
            std::fs::write(&path, seed).unwrap();
            caustica_film::read_exr(&path).unwrap();
        }
        for seed in super::films() {
            caustica_film::FilmRecord::parse(&seed).unwrap();
        }
        std::fs::write(folder.path().join("tri.obj"), super::TRIANGLE).unwrap();
        for (name, bytes) in crate::images::named() {
            std::fs::write(folder.path().join(name), bytes).unwrap();
        }
        for (name, bytes) in crate::meshes::named() {
            std::fs::write(folder.path().join(name), bytes).unwrap();
        }
        std::fs::write(folder.path().join("part.xml"), super::PART).unwrap();
        std::fs::write(folder.path().join("curve.spd"), "400 0.1\n700 0.9\n").unwrap();
        for seed in super::mitsuba_xml() {
            let text = String::from_utf8(seed).unwrap();
            let loaded = caustica_import::parse_mitsuba(&text, "m.xml", folder.path(), &[]);
            loaded.unwrap_or_else(|e| panic!("{e}\n{text}"));
        }
        for seed in super::nori_xml() {
            let text = String::from_utf8(seed).unwrap();
            let loaded = caustica_import::parse_nori(&text, "s.xml", folder.path());
            loaded.unwrap_or_else(|e| panic!("{e}\n{text}"));
        }
    }
}
