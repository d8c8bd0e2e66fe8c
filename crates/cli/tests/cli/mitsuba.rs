//! Scenes of Mitsuba on the command line.

use crate::bench::Bench;

const SCENE: &str = "<scene version='3.0.0'><default name='size' value='8'/>
  <integrator type='path'><integer name='max_depth' value='3'/></integrator>
  <sensor type='perspective'><film type='hdrfilm'><integer name='width' value='$size'/><integer name='height' value='6'/></film>
    <sampler type='independent'><integer name='sample_count' value='2'/></sampler></sensor>
  <shape type='sphere'><point name='center' z='5'/><bsdf type='hair'/></shape>
  <emitter type='constant'/>
</scene>";

#[test]
fn variables_and_depths_are_followed() {
    let bench = Bench::new();
    bench.write("scene.xml", SCENE);
    let (picture, facts) = bench.render("a", &[]);
    assert_eq!((picture.width, facts.get("maxDepth"), picture.eye_samples), (8, Some("3"), 2));
    let (picture, facts) = bench.render("b", &["-D", "size=10", "--max-depth", "5"]);
    assert_eq!((picture.width, facts.get("maxDepth")), (10, Some("5")));
}

#[test]
fn info_tells_what_is_approximated() {
    let bench = Bench::new();
    bench.write("scene.xml", SCENE);
    let ran = bench.run(&["info", "scene.xml", "--define", "size=4"]).ok();
    assert!(ran.err.contains("scene.xml:5:64: the bsdf `hair` is not supported yet"), "{}", ran.err);
    assert!(ran.out.contains("4 × 6 pixels"), "{}", ran.out);
}

#[test]
fn cameras_of_one_ray_and_light_paths() {
    let bench = Bench::new();
    let meter = "<sensor type='radiancemeter'><film type='hdrfilm'><integer name='width' value='1'/>\
        <integer name='height' value='1'/><rfilter type='box'/></film></sensor>";
    let rest = "<shape type='sphere'><point name='center' z='5'/></shape><emitter type='constant'/>";
    bench.write("scene.xml", format!("<scene version='3.0.0'>{meter}{rest}</scene>"));
    let ran = bench.run(&["render", "scene.xml", "--spp", "1", "--integrator", "light", "-o", "a.exr"]).ok();
    assert!(ran.err.contains("no light path meets a camera of one ray"), "{}", ran.err);
    let (picture, _) = bench.render("b", &["--spp", "4", "--integrator", "bdpt"]);
    assert!(picture.width == 1 && picture.eye[0].0[0] > 0.1, "{:?}", picture.eye);
}

#[test]
fn variables_that_nobody_asks_for_are_refused() {
    let bench = Bench::new();
    bench.write("scene.xml", SCENE);
    bench
        .run(&["info", "scene.xml", "-D", "siez=4"])
        .fails(3, &["no variable `siez`", "did you mean `size`?"]);
    bench.run(&["info", "scene.xml", "-D", "size"]).fails(2, &["use NAME=VALUE"]);
    bench.run(&["info", "-D", "size=4"]).fails(2, &["no variables"]);
    let nori = Bench::new();
    nori.run(&["info", "scene.xml", "-D", "size=4"]).fails(3, &["only scenes of Mitsuba"]);
}
