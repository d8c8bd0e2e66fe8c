use crate::bench::Bench;

#[test]
fn a_scene_is_verified_with_a_page_a_map_and_figures() {
    let bench = Bench::new();
    let ran =
        bench.run(&["verify", "scene.xml", "--spp", "16", "--block", "4", "--max-depth", "6", "-q"]).ok();
    assert_eq!((ran.out.as_str(), ran.err.as_str()), ("", ""));
    let mut files: Vec<_> = std::fs::read_dir(bench.path("scene-verify"))
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    files.sort();
    assert_eq!(files, ["heat.png", "index.html", "report.json"]);
    let json: serde_json::Value = serde_json::from_slice(&bench.bytes("scene-verify/report.json")).unwrap();
    assert_eq!(json["agrees"], true);
    let names: Vec<_> =
        json["estimators"].as_array().unwrap().iter().map(|e| e["name"].as_str().unwrap()).collect();
    for name in ["bdpt", "bdpt, s=0", "bdpt, t=1", "path", "naive", "light"] {
        assert!(names.contains(&name), "{names:?}");
    }
    // The ball is glass: light paths do not find what is seen in it.
    let light = &json["estimators"][names.iter().position(|n| *n == "light").unwrap()];
    assert!(light["missed"].as_array().unwrap().iter().any(|m| m[0] == "LDS+E"), "{light}");
    assert!(bench.bytes("scene-verify/heat.png").starts_with(b"\x89PNG"));
}

#[test]
fn verdicts_are_told_and_do_not_depend_on_threads() {
    let bench = Bench::new();
    let args = ["verify", "scene.xml", "--spp", "8", "--max-depth", "5", "-o", "out", "--json", "--threads"];
    let run = |threads: &str| bench.run(&[&args[..], &[threads]].concat()).ok().json();
    let (mut a, mut b) = (run("1"), run("3"));
    assert_eq!(a["agrees"], true);
    assert_eq!(a["outputs"].as_array().unwrap().len(), 3);
    for json in [&mut a, &mut b] {
        // They tell how many threads there were.
        json["notes"] = serde_json::Value::Null;
    }
    assert_eq!(a, b);
    let ran = bench.run(&["verify", "scene.xml", "--spp", "8", "--max-depth", "5", "-o", "out"]).ok();
    for words in ["verdict", "What carries the light here", "All that could be tested agree", "LDE"] {
        assert!(ran.out.contains(words), "{words}: {}", ran.out);
    }
}

#[test]
fn what_cannot_be_verified_is_told_at_once() {
    let bench = Bench::new();
    bench.write("file", "x");
    bench.run(&["verify", "scene.xml", "-o", "file/below"]).fails(4, &["cannot make the folder"]);
    bench.run(&["verify", "scene.xml", "--spp", "4"]).fails(2, &["--spp"]);
    bench.run(&["verify", "scene.xml", "--significance", "1.5"]).fails(2, &["between 0 and 1"]);
    bench.run(&["verify", "none.xml"]).fails(3, &["none.xml"]);
}
