use crate::bench::Bench;

#[test]
fn a_comparison_is_a_page_with_its_figures_and_pictures() {
    let bench = Bench::new();
    let ran = bench.run(&["compare", "scene.xml", "--spp", "4", "--threads", "2", "-q"]).ok();
    assert_eq!((ran.out.as_str(), ran.err.as_str()), ("", ""));
    assert_eq!(bench.made(), ["scene-compare"]);
    let mut files: Vec<_> = std::fs::read_dir(bench.path("scene-compare"))
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    files.sort();
    let pictures = ["bdpt-eye.exr", "bdpt.exr", "index.html", "light.exr", "naive.exr", "path.exr"];
    assert_eq!(files, [&pictures[..], &["reference.exr", "report.json"]].concat());
    let json: serde_json::Value = serde_json::from_slice(&bench.bytes("scene-compare/report.json")).unwrap();
    let entries = json["entries"].as_array().unwrap();
    assert_eq!(entries.len(), 5);
    for entry in entries {
        assert_eq!(entry["metrics"]["samples"], 4.0);
        assert_eq!(entry["curve"].as_array().unwrap().len(), 3);
        assert!(entry["metrics"]["rel_mse"].as_f64().unwrap() > 0.0);
    }
    // The picture is the one that `render` makes.
    let (rendered, _) = bench.render("bdpt", &["--spp", "4"]);
    assert_eq!(bench.film("scene-compare/bdpt.exr").0, rendered);
}

#[test]
fn a_reference_can_be_given() {
    let bench = Bench::new();
    bench.render("truth", &["--spp", "16", "--seed", "7"]);
    let args = ["compare", "scene.xml", "--integrators", "path,bdpt,path", "--spp", "2", "-o", "out"];
    let ran = bench.run(&[&args[..], &["--reference", "truth.exr", "--json"]].concat()).ok();
    let json = ran.json();
    let names: Vec<_> = json["entries"].as_array().unwrap().iter().map(|e| &e["shown"]["name"]).collect();
    assert_eq!(names, ["path", "bdpt"]);
    let told = json["notes"].as_array().unwrap().iter().any(|n| n[0] == "reference" && n[1] == "truth.exr");
    assert!(told, "{}", json["notes"]);
    assert!(!bench.path("out/reference.exr").exists());
    let again = bench.run(&[&args[..], &["--reference", "out/bdpt.exr"]].concat()).ok();
    assert!(again.out.ends_with("wrote out/index.html\n"), "{}", again.out);
    bench.render("small", &["--resolution", "8x8"]);
    bench
        .run(&[&args[..], &["--reference", "small.exr"]].concat())
        .fails(2, &["`small.exr` has 8 × 8 pixels", "24 × 16"]);
    bench.run(&[&args[..], &["--reference", "none.exr"]].concat()).fails(3, &["none.exr"]);
}

#[test]
fn what_cannot_be_is_told_before_rendering() {
    let bench = Bench::new();
    bench.write("file", "x");
    bench.run(&["compare", "scene.xml", "-o", "file/below"]).fails(4, &["cannot make the folder"]);
    bench.run(&["compare", "scene.xml", "--integrators", "bdtp"]).fails(2, &["bdtp"]);
    bench.run(&["compare", "scene.xml", "--integrators", "depth"]).fails(2, &["depth"]);
    bench.run(&["compare", "scene.xml", "--spp", "2", "--time", "3s"]).fails(2, &["--time"]);
    bench
        .run(&["compare", "scene.xml", "--reference", "a.exr", "--reference-time", "3s"])
        .fails(2, &["--reference-time"]);
}

#[test]
fn crops_are_compared_with_crops() {
    let bench = Bench::new();
    let crop = ["--crop", "3,2,17,9", "--spp", "2"];
    bench.run(&[&["compare", "scene.xml", "--integrators", "bdpt", "-q"], &crop[..]].concat()).ok();
    let (picture, _) = bench.film("scene-compare/bdpt.exr");
    assert_eq!((picture.window.width, picture.window.height, picture.width), (17, 9, 24));
    let reference = ["--reference", "scene-compare/reference.exr", "-o", "again", "-q"];
    bench.run(&[&["compare", "scene.xml", "--integrators", "path"], &crop[..], &reference].concat()).ok();
}
