use std::time::{Duration, Instant};

use caustica::film::Window;

use crate::bench::{Bench, channels};

const INTEGRATORS: [&str; 18] = [
    "bdpt",
    "path",
    "path_ems",
    "naive",
    "light",
    "direct",
    "direct_ems",
    "direct_mats",
    "whitted",
    "ao",
    "av",
    "normals",
    "depth",
    "simple",
    "directional",
    "path_mis",
    "path_mats",
    "direct_mis",
];

#[test]
fn the_built_in_scene_needs_no_arguments_but_a_size() {
    let bench = Bench::new();
    let ran = bench.run(&["render", "--resolution", "16x12", "--spp", "1"]).ok();
    assert_eq!(ran.err, "");
    assert!(ran.out.starts_with("bdpt: 1 sample per pixel in "), "{}", ran.out);
    assert!(ran.out.ends_with("wrote caustica.exr and caustica.png\n"), "{}", ran.out);
    assert_eq!(bench.made(), ["caustica.exr", "caustica.png"]);
    assert!(bench.bytes("caustica.png").starts_with(b"\x89PNG\r\n\x1a\n"));
    let (picture, facts) = bench.film("caustica.exr");
    assert_eq!((picture.width, picture.height, picture.eye_samples), (16, 12, 1));
    assert_eq!(facts.get("scene"), Some("built-in"));
}

#[test]
fn files_lie_beside_the_scene_and_say_what_they_hold() {
    let bench = Bench::new();
    bench.run(&["render", "scene.xml", "--seed", "7"]).ok();
    assert_eq!(bench.made(), ["scene.exr", "scene.png"]);
    let mut expected = Vec::new();
    for layer in ["combined", "error", "eye", "light"] {
        expected.extend(["B", "G", "R"].map(|c| format!("{layer}.{c}")));
    }
    assert_eq!(channels(&bench.path("scene.exr")), expected);
    let (picture, facts) = bench.film("scene.exr");
    assert_eq!((picture.eye_samples, picture.light_samples), (2, 2));
    for (name, value) in [
        ("integrator", "bdpt"),
        ("seed", "7"),
        ("samples", "2"),
        ("lightPasses", "2"),
        ("lightImage", "on"),
        ("strategies", "all"),
        ("heuristic", "balance"),
        ("maxDepth", "unlimited"),
        ("rouletteDepth", "1"),
        ("scene", "scene.xml"),
        ("version", env!("CARGO_PKG_VERSION")),
    ] {
        assert_eq!(facts.get(name), Some(value), "{name}");
    }
    assert!(facts.get("seconds").unwrap().parse::<f64>().unwrap() > 0.0);
}

#[test]
fn films_tell_how_many_light_paths_were_shared() {
    let bench = Bench::new();
    let shared = |args: &[&str]| {
        let (_, facts) = bench.render("a", args);
        facts.get("sharedLightPaths").map(str::to_owned)
    };
    // Above a floor alone, hardly any light is found by joins.
    let advised = shared(&[]);
    assert_eq!(advised.as_deref(), Some("1"));
    assert_eq!(shared(&["--seed", "3", "--threads", "1"]), advised);
    assert_eq!(shared(&["--shared-light-paths", "8"]).as_deref(), Some("8"));
}

#[test]
fn every_integrator_renders_and_is_named() {
    let bench = Bench::new();
    for name in INTEGRATORS {
        let (picture, facts) = bench.render("a", &["--integrator", name, "--spp", "3"]);
        let canonical = match name {
            "path_mis" => "path",
            "path_mats" => "naive",
            "direct_mis" => "direct",
            other => other,
        };
        assert_eq!(facts.get("integrator"), Some(canonical));
        let expected = match name {
            "bdpt" => (3, 3),
            "light" => (0, 3),
            _ => (3, 0),
        };
        assert_eq!((picture.eye_samples, picture.light_samples), expected, "{name}");
        assert!(picture.eye.iter().chain(&picture.light).any(|p| p.max_channel() > 0.0), "{name} is black");
        assert!(picture.eye.iter().all(|p| p.is_valid()), "{name}");
    }
}

#[test]
fn a_scene_keeps_the_parameters_of_the_integrator_that_it_names() {
    let bench = Bench::new();
    bench.write_changed(
        r#"<integrator type="bdpt"/>"#,
        r#"<integrator type="av"><float name="length" value="1e-4"/></integrator>"#,
    );
    let (own, _) = bench.render("a", &["--spp", "1"]);
    let (named, _) = bench.render("b", &["--spp", "1", "--integrator", "av"]);
    assert_eq!(own.eye, named.eye);
    assert!(
        own.eye.iter().all(|p| [0.0, 1.0].contains(&p.0[0])),
        "nothing is within a tenth of a millimetre"
    );
}

#[test]
fn time_ends_a_render_and_samples_are_counted_truly() {
    let bench = Bench::new();
    let start = Instant::now();
    let ran = bench.run(&["render", "scene.xml", "--time", "300ms", "--json"]).ok();
    assert!(start.elapsed() < Duration::from_secs(8));
    let samples = ran.json()["samples"].as_u64().unwrap();
    let (picture, _) = bench.film("scene.exr");
    assert!(samples > 2, "the scene's own count is no limit beside --time");
    assert_eq!((picture.eye_samples, picture.light_samples), (samples, samples));
    let ran = bench.run(&["render", "scene.xml", "--time", "100ms", "--spp", "3", "--json"]).ok();
    assert!(ran.json()["samples"].as_u64().unwrap() <= 3);
    // Too short for anything but one pass.
    let ran = bench.run(&["render", "scene.xml", "--resolution", "200x200", "--time", "1ms", "--json"]).ok();
    assert!(ran.json()["samples"].as_u64().unwrap() >= 1);
}

#[test]
fn depth_is_limited() {
    let bench = Bench::new();
    let sum = |more: &[&str]| {
        let (picture, _) = bench.render("a", &[more, &["--integrator", "path", "--spp", "16"]].concat());
        picture.eye.iter().map(|p| f64::from(p.0[0])).sum::<f64>()
    };
    let (emitted, direct, all) = (sum(&["--max-depth", "1"]), sum(&["--max-depth", "2"]), sum(&[]));
    assert!(0.0 < emitted && emitted < direct && direct < all, "{emitted} {direct} {all}");
    let (_, facts) = bench.render("a", &["--max-depth", "5"]);
    assert_eq!(facts.get("maxDepth"), Some("5"));
}

#[test]
fn a_crop_is_the_same_as_that_part_of_the_whole() {
    let bench = Bench::new();
    let (whole, _) = bench.render("a", &["--integrator", "path"]);
    let (part, _) = bench.render("b", &["--integrator", "path", "--crop", "5,3,7,4"]);
    assert_eq!((part.width, part.height), (24, 16));
    assert_eq!(part.window, Window { x: 5, y: 3, width: 7, height: 4 });
    for y in 0..4 {
        let row = (3 + y) * 24 + 5;
        assert_eq!(part.eye[y * 7..(y + 1) * 7], whole.eye[row..row + 7]);
    }
    for outside in ["20,0,5,5", "0,0,1,17", "4294967295,0,1,1"] {
        let ran = bench.run(&["render", "scene.xml", "-o", "c", "--crop", outside]);
        ran.fails(2, &["the crop window reaches beyond the picture of 24 × 16 pixels"]);
    }
    assert_eq!(bench.made(), ["a.exr", "a.png", "b.exr", "b.png"]);
}

#[test]
fn a_resolution_of_ones_own_drops_the_scenes_crop() {
    let bench = Bench::new();
    bench.write_changed(r#"<rfilter type="box"/>"#, r#"<integer name="cropWidth" value="8"/>"#);
    let (own, _) = bench.render("a", &[]);
    assert_eq!((own.width, own.window.width), (24, 8));
    let ran = bench.run(&["render", "scene.xml", "-o", "b", "--resolution", "12X8"]).ok();
    assert!(ran.err.starts_with("warning: the scene's crop window"), "{}", ran.err);
    assert_eq!(bench.film("b.exr").0.window.width, 12);
}

#[test]
fn pictures_depend_on_the_seed_and_not_on_threads_or_the_tree() {
    let bench = Bench::new();
    let (one, _) = bench.render("1", &["--threads", "1", "--spp", "3"]);
    for threads in ["2", "7"] {
        let (other, _) = bench.render(threads, &["--threads", threads, "--spp", "3"]);
        assert_eq!(one, other, "{threads} threads");
        assert_eq!(bench.bytes("1.png"), bench.bytes(&format!("{threads}.png")));
    }
    let (other, _) = bench.render("spatial", &["--tree", "spatial", "--spp", "3"]);
    assert_eq!(one, other, "spatial splits");
    let (other, facts) = bench.render("seed", &["--seed", "1", "--spp", "3"]);
    assert!(one.eye != other.eye && one.light != other.light);
    assert_eq!(facts.get("seed"), Some("1"));
}

#[test]
fn strategies_are_restricted() {
    let bench = Bench::new();
    let layer_sums = |set: &str| {
        let (picture, facts) = bench.render("a", &["--strategies", set, "--spp", "8"]);
        assert_eq!(facts.get("strategies"), Some(set.replace(" ", "").as_str()));
        let sum = |layer: &[caustica::Rgb]| layer.iter().map(|p| f64::from(p.max_channel())).sum::<f64>();
        (sum(&picture.eye) > 0.0, sum(&picture.light) > 0.0, picture.light_samples)
    };
    assert_eq!(layer_sums("s=0"), (true, false, 0));
    assert_eq!(layer_sums("t>=2"), (true, false, 0));
    assert_eq!(layer_sums("t=1"), (false, true, 8));
    assert_eq!(layer_sums("1,2; 2,1"), (true, true, 8));
    let ran = bench.run(&["render", "scene.xml", "--strategies", "s=0", "--integrator", "path"]).ok();
    assert!(ran.err.starts_with("warning: `--strategies` has no effect on `path`"), "{}", ran.err);
}

#[test]
fn quiet_says_nothing() {
    let bench = Bench::new();
    bench.write_changed(
        r#"<bsdf type="dielectric"/>"#,
        r#"<bsdf type="dielectric"><float name="typo" value="1"/></bsdf>"#,
    );
    let ran = bench.run(&["render", "scene.xml", "--quiet"]).ok();
    assert_eq!((ran.out.as_str(), ran.err.as_str()), ("", ""));
    assert_eq!(bench.made(), ["scene.exr", "scene.png"]);
    bench.run(&["render", "none.xml", "--quiet"]).fails(3, &["there is no such file"]);
}

#[test]
fn json_holds_the_result_and_warnings() {
    let bench = Bench::new();
    bench.write_changed(
        r#"<bsdf type="dielectric"/>"#,
        r#"<bsdf type="dielectric"><float name="typo" value="1"/></bsdf>"#,
    );
    let args = ["render", "scene.xml", "--json", "--seed", "18446744073709551615", "--threads", "1"];
    let result = bench.run(&[&args[..], &["--crop", "1,2,3,4"]].concat()).ok().json();
    assert_eq!(result["integrator"], "bdpt");
    assert_eq!(result["samples"], 2);
    assert_eq!(result["seed"], u64::MAX);
    assert_eq!(result["threads"], 1);
    assert_eq!(result["stopped"], false);
    assert_eq!(result["light_image"], "on");
    assert_eq!(result["resolution"], serde_json::json!([24, 16]));
    assert_eq!(result["window"], serde_json::json!([1, 2, 3, 4]));
    assert_eq!(result["outputs"], serde_json::json!(["scene.exr", "scene.png"]));
    let [warning] = result["warnings"].as_array().unwrap().as_slice() else { panic!("{result}") };
    assert_eq!(warning["severity"], "warning");
    assert_eq!(warning["origin"]["line"], 14);
    assert!(warning["message"].as_str().unwrap().contains("typo"));
}
