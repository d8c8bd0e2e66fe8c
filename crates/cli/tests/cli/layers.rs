//! `--layers`, and the list of a Mitsuba scene.

use crate::bench::{Bench, channels};

/// The channels of a file beside those that every picture has.
fn further(bench: &Bench, file: &str) -> Vec<String> {
    let usual = ["combined.", "error.", "eye.", "light."];
    channels(&bench.path(file)).into_iter().filter(|c| !usual.iter().any(|u| c.starts_with(u))).collect()
}

#[test]
fn layers_lie_beside_the_picture() {
    let bench = Bench::new();
    let list = "albedo,normal,dd.y:depth,shape_index";
    let expected =
        ["albedo.B", "albedo.G", "albedo.R", "dd.y.T", "normal.X", "normal.Y", "normal.Z", "shape_index.I"];
    bench.run(&["render", "scene.xml", "--layers", list, "--threads", "1"]).ok();
    assert_eq!(further(&bench, "scene.exr"), expected);
    let (picture, _) = bench.film("scene.exr");
    // The lower edge shows the floor, and the middle the glass ball.
    let of = |name: &str, x: usize, y: usize| {
        picture.channels.iter().find(|c| c.name == name).unwrap().values[y * 24 + x]
    };
    assert_eq!((of("normal.Y", 2, 15), of("shape_index.I", 2, 15)), (1.0, 1.0));
    assert_eq!((of("albedo.R", 12, 7), of("shape_index.I", 12, 7)), (1.0, 2.0));
    assert!((of("dd.y.T", 12, 7) - 3.6).abs() < 0.2);
    // They change nothing of the picture, and a developed file keeps them.
    let (plain, _) = bench.render("plain", &[]);
    assert_eq!((&plain.eye, &plain.light, plain.channels.len()), (&picture.eye, &picture.light, 0));
    bench.run(&["develop", "scene.exr", "--light-image", "off", "-o", "off.exr"]).ok();
    assert_eq!(bench.film("off.exr").0.channels, picture.channels);
}

/// A render in parts has the layers of one in a piece.
#[test]
fn layers_of_resumed_renders() {
    let bench = Bench::new();
    let (whole, _) = bench.render("whole", &["--spp", "6", "--layers", "position"]);
    bench.run(&["render", "scene.xml", "--spp", "2", "--checkpoint", "c.film", "-o", "a.exr"]).ok();
    let rest = ["--spp", "6", "--checkpoint", "c.film", "--resume", "--layers", "position", "--threads", "1"];
    let (resumed, _) = bench.render("b", &rest);
    assert_eq!(whole.channels, resumed.channels);
    // Of a film that others made, too.
    bench.run(&["render", "scene.xml", "--samples", "0..4", "-o", "p.film"]).ok();
    bench.run(&["render", "scene.xml", "--samples", "4..6", "-o", "q.film"]).ok();
    bench.run(&["merge", "p.film", "q.film", "-o", "all.film"]).ok();
    let of_film = ["--spp", "6", "--checkpoint", "all.film", "--resume", "--layers", "position"];
    assert_eq!(bench.render("c", &of_film).0, whole);
}

#[test]
fn lists_that_make_no_layers() {
    let bench = Bench::new();
    let fails = |list: &str, words: &[&str]| {
        bench.run(&["render", "scene.xml", "--layers", list]).fails(2, words);
    };
    fails("albedo,colour", &["there is no layer `colour`", "choose among normal, albedo"]);
    fails("a:depth,a:depth", &["two layers are called `a`"]);
    fails("eye:depth", &["is there already"]);
    let many: Vec<String> = (0..65).map(|i| format!("a{i}:depth")).collect();
    fails(&many.join(","), &["more than 64 layers"]);
    bench
        .run(&["render", "scene.xml", "--layers", "depth", "-o", "a.film"])
        .fails(2, &["films hold no layers", "--resume"]);
}

#[test]
fn the_scene_lists_them() {
    let bench = Bench::new();
    let scene = "<scene version='3.0.0'>
  <integrator type='aov'><string name='aovs' value='dd.y:depth,nn:sh_normal,b:boundary_test'/>
    <integrator type='path'/></integrator>
  <sensor type='perspective'><film type='hdrfilm'><integer name='width' value='8'/><integer name='height' value='6'/></film>
    <sampler type='independent'><integer name='sample_count' value='2'/></sampler></sensor>
  <shape type='sphere'><point name='center' z='5'/></shape><emitter type='constant'/>
</scene>";
    bench.write("scene.xml", scene);
    let ran = bench.run(&["render", "scene.xml"]).ok();
    assert!(ran.err.contains("scene.xml:2:") && ran.err.contains("no layer `boundary_test`"), "{}", ran.err);
    assert_eq!(further(&bench, "scene.exr"), ["dd.y.T", "nn.X", "nn.Y", "nn.Z"]);
    bench.run(&["render", "scene.xml", "--layers", "none"]).ok();
    assert_eq!(further(&bench, "scene.exr"), [""; 0]);
    bench.run(&["render", "scene.xml", "--layers", "uv"]).ok();
    assert_eq!(further(&bench, "scene.exr"), ["uv.U", "uv.V"]);
    // A film has none, and nobody asked for them there.
    bench.run(&["render", "scene.xml", "-o", "a.film"]).ok();
}
