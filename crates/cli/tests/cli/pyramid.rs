use crate::bench::Bench;

#[test]
fn a_pyramid_is_two_sheets_layers_and_a_page() {
    let bench = Bench::new();
    let ran = bench.run(&["pyramid", "scene.xml", "--spp", "3", "--rows", "3", "--json"]).ok();
    assert_eq!(ran.json()["strategies"], 2 + 3 + 4);
    let files =
        ["scene-pyramid-unweighted.png", "scene-pyramid.exr", "scene-pyramid.html", "scene-pyramid.png"];
    assert_eq!(bench.made(), files);
    for png in [files[0], files[3]] {
        assert!(bench.bytes(png).starts_with(b"\x89PNG\r\n\x1a\n"));
    }
    let page = String::from_utf8(bench.bytes(files[2])).unwrap();
    assert!(page.starts_with("<!doctype html>") || page.starts_with("<!DOCTYPE html>"), "{}", &page[..40]);
    // What programs show that know one layer is the whole.
    let ran = bench.run(&[
        "compare",
        "scene.xml",
        "--integrators",
        "bdpt",
        "--spp",
        "3",
        "--reference",
        files[1],
        "--json",
    ]);
    let error = ran.ok().json()["entries"][0]["metrics"]["rel_mse"].as_f64().unwrap();
    assert!(error < 0.01, "{error}");
}

#[test]
fn longer_paths_are_shown_too() {
    let bench = Bench::new();
    let args = ["pyramid", "scene.xml", "--spp", "3", "--crop", "3,2,17,9", "-q"];
    for (rows, longer) in [("2", "\"longer\":true"), ("5", "\"longer\":false")] {
        let depth = if rows == "2" { "5" } else { "4" };
        bench.run(&[&args[..], &["--rows", rows, "--max-depth", depth]].concat()).ok();
        let page = String::from_utf8(bench.bytes("scene-pyramid.html")).unwrap();
        assert!(page.contains(longer), "{rows} rows");
    }
}

#[test]
fn wrong_pyramids() {
    let bench = Bench::new();
    bench.run(&["pyramid", "scene.xml", "--rows", "0"]).fails(2, &["0 is not in 1..=16"]);
    bench.run(&["pyramid", "scene.xml", "-o", "none/x"]).fails(4, &["the folder does not exist"]);
    let huge = ["pyramid", "scene.xml", "--resolution", "30000x30000", "--rows", "16"];
    bench.run(&huge).fails(5, &["30000"]);
    assert!(bench.made().is_empty());
}
