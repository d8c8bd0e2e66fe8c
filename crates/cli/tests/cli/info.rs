use serde_json::json;

use crate::bench::Bench;

#[test]
fn a_scene_is_told_in_figures() {
    let bench = Bench::new();
    let ran = bench.run(&["info", "scene.xml"]).ok();
    assert_eq!(ran.err, "");
    for line in [
        "picture     24 × 16 pixels, 2 samples per pixel, integrator bdpt\n",
        "camera      perspective\n",
        "shapes      3 (2 triangles, 2 spheres)\n",
        "lights      1 area (sphere) (",
        "bounds      (-3, 0, -3) to (3, 1.4, 3)\n",
        "memory      ",
    ] {
        assert!(ran.out.contains(line), "{line}{}", ran.out);
    }
    assert!(bench.made().is_empty());
}

#[test]
fn the_same_figures_in_json() {
    let bench = Bench::new();
    bench.write_changed(
        r#"<rfilter type="box"/>"#,
        r#"<integer name="cropHeight" value="8"/><float name="Fov" value="1"/>"#,
    );
    let info = bench.run(&["info", "scene.xml", "--json"]).ok().json();
    assert_eq!(info["resolution"], json!([24, 16]));
    assert_eq!(info["crop"], json!([0, 0, 24, 8]));
    assert_eq!((&info["camera"], &info["integrator"]), (&json!("perspective"), &json!("bdpt")));
    assert_eq!([&info["samples"], &info["triangles"], &info["spheres"]], [2, 2, 2]);
    assert_eq!(info["lights"], json!([["area (sphere)", 1]]));
    let materials = info["materials"].as_array().unwrap();
    assert!(materials.contains(&json!(["dielectric", 1])), "{info}");
    // π · 4πr² · radiance
    let power = info["power"].as_f64().unwrap();
    let expected =
        std::f64::consts::PI.powi(2) * 4.0 * 0.04 * (20.0 * 0.2126 + 18.0 * 0.7152 + 15.0 * 0.0722);
    assert!((power / expected - 1.0).abs() < 1e-3, "{power} {expected}");
    assert_eq!(info["memory"]["film"], 24 * 8 * 96);
    assert_eq!(info["warnings"].as_array().unwrap().len(), 1);
    assert!(info["warnings"][0]["message"].as_str().unwrap().contains("Fov"));
}

#[test]
fn instances_are_counted() {
    let bench = Bench::new();
    let instance = "<shape type='instance'><ref id='g'/></shape>";
    let scene = format!(
        "<scene version='3.0.0'><sensor type='perspective'/><emitter type='constant'/>\
         <shape type='shapegroup' id='g'><shape type='cube'/><shape type='sphere'/></shape>{}</scene>",
        instance.repeat(3)
    );
    bench.write("i.xml", scene);
    let out = bench.run(&["info", "i.xml"]).ok().out;
    assert!(out.contains("shapes      2 (12 triangles, 1 sphere)\n"), "{out}");
    assert!(out.contains("instances   3 instances of 1 group: 36 triangles are seen\n"), "{out}");
    let info = bench.run(&["info", "i.xml", "--json"]).ok().json();
    assert_eq!([&info["groups"], &info["instances"], &info["placed_triangles"]], [1, 3, 36]);
}

#[test]
fn the_built_in_scene_has_figures_too() {
    let bench = Bench::new();
    let info = bench.run(&["info", "--json"]).ok().json();
    assert_eq!((&info["resolution"], &info["warnings"]), (&json!([800, 600]), &json!([])));
}

/// A reader that goes away is no error, and no panic.
#[test]
fn a_closed_pipe_is_no_error() {
    use std::process::Stdio;
    let bench = Bench::new();
    let mut child = bench.command(&["info", "scene.xml"]).stdout(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), String::from_utf8_lossy(&output.stderr).as_ref()), (Some(0), ""));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_an_error() {
    let bench = Bench::new();
    let full = std::fs::File::create("/dev/full").unwrap();
    let output = bench.command(&["info", "scene.xml"]).stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(4));
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot write to the standard output"));
}
