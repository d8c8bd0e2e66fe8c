use crate::bench::Bench;

/// The bench's scene under a point light: what is seen through the glass of the caustic below it cannot be found.
fn under_a_point(bench: &Bench) {
    let lamp = r#"<mesh type="sphere">
    <point name="center" value="0.8, 1.2, 0"/><float name="radius" value="0.2"/>
    <emitter type="area"><color name="radiance" value="20, 18, 15"/></emitter>
  </mesh>"#;
    let point = r#"<emitter type="point">
    <point name="position" value="0, 2, 0"/><color name="power" value="60, 60, 60"/>
  </emitter>"#;
    bench.write_changed(lamp, point);
}

#[test]
fn the_light_of_a_scene_is_explained() {
    let bench = Bench::new();
    let ran = bench.run(&["explain", "scene.xml", "--spp", "32"]).ok();
    for words in ["24 × 16 pixels from 0,0", "LDE", "LS+DE", "found by strategies", "of bdpt's noise"] {
        assert!(ran.out.contains(words), "{words}: {}", ran.out);
    }
    assert!(bench.made().is_empty());
}

#[test]
fn missing_light_is_told_with_what_would_help() {
    let bench = Bench::new();
    under_a_point(&bench);
    let ran = bench.run(&["explain", "scene.xml", "--spp", "32", "--region", "8,4,8,10", "--json"]).ok();
    let json = ran.json();
    assert_eq!(json["region"], serde_json::json!([8, 4, 8, 10]));
    assert_eq!(json["missing"][0]["pattern"], "LS+DS+E", "{json}");
    let told = json["sentences"].to_string();
    for words in
        ["the point light at (0, 2, 0)", "smooth glass", "No strategy reaches it", "Give the lamp a size"]
    {
        assert!(told.contains(words), "{words}: {told}");
    }
    let naive = bench.run(&["explain", "scene.xml", "--spp", "8", "--integrator", "naive"]).ok();
    assert!(naive.out.contains("`naive` cannot reach 100 %"), "{}", naive.out);
}

#[test]
fn regions_must_lie_in_the_picture() {
    let bench = Bench::new();
    bench.run(&["explain", "scene.xml", "--region", "20,0,8,8"]).fails(2, &["beyond the picture of 24 × 16"]);
    bench.run(&["explain", "scene.xml", "--region", "20,0"]).fails(2, &["X,Y,WIDTH,HEIGHT"]);
    bench.run(&["explain", "scene.xml", "--integrator", "depth"]).fails(2, &["depth"]);
}

#[test]
fn more_samples_than_asked_for_are_told() {
    let bench = Bench::new();
    let ran = bench.run(&["explain", "scene.xml", "--spp", "17"]).ok();
    assert!(ran.err.contains("32 samples a pixel were taken instead of 17"), "{}", ran.err);
    assert!(ran.out.contains("32 samples each"), "{}", ran.out);
    assert!(!bench.run(&["explain", "scene.xml", "--spp", "16"]).ok().err.contains("instead"));
    let ran = bench.run(&["verify", "scene.xml", "--spp", "33", "--max-depth", "3", "-o", "out"]).ok();
    assert!(ran.err.contains("64 samples a pixel were taken instead of 33"), "{}", ran.err);
}

/// As for `render`: the figure, before anything is rendered.
#[test]
fn pictures_that_do_not_fit_are_refused() {
    let bench = Bench::new();
    for command in ["verify", "explain"] {
        let start = std::time::Instant::now();
        let args = [command, "scene.xml", "--resolution", "16000x16000", "--spp", "8", "--threads", "500"];
        let ran = bench.run(&args);
        ran.fails(5, &[&format!("to {command} 16000 × 16000 pixels needs"), "MB of memory", "--resolution"]);
        assert!(start.elapsed().as_secs() < 60, "{command}");
    }
}
