//! Scene files that cannot be rendered: one error each, with its place, and nothing written.

use crate::bench::{Bench, SCENE};

const BALL: &str = r#"<bsdf type="dielectric"/>"#;

#[test]
fn errors_in_a_scene_have_a_place_and_a_hint() {
    let bench = Bench::new();
    let sized = r#"<integer name="width" value="24"/>"#;
    for (from, to, words) in [
        ("</scene>", "", &["malformed XML", "before all of its tags are closed"][..]),
        ("</camera>", "</cam>", &["scene.xml:9:3", "malformed XML: expected </camera>"]),
        (
            r#"<integrator type="bdpt"/>"#,
            r#"<integrator type="bdtp"/>"#,
            &["scene.xml:2:21", "`bdtp`", "did you mean `bdpt`?"],
        ),
        (BALL, "<bsfd/>", &["scene.xml:14:", "<bsfd>", "did you mean <bsdf>?"]),
        (BALL, "<bsdf/>", &["scene.xml:14:", "type"]),
        (BALL, r#"<bsdf type="velvet"/>"#, &["scene.xml:14:", "`velvet`", "help: known are diffuse"]),
        (BALL, "loose text", &["scene.xml:14:", "text"]),
        (r#"value="floor.obj""#, r#"value="flor.obj""#, &["scene.xml:11:", "`flor.obj`"]),
        (sized, r#"<integer name="width" value="0"/>"#, &["scene.xml:6:", "`width`"]),
        (sized, r#"<integer name="width" value="99999999"/>"#, &["scene.xml:6:", "65536"]),
        (sized, r#"<string name="width" value="24"/>"#, &["scene.xml:6:", "`width`"]),
        (r#"name="radius" value="0.2""#, r#"name="radius" value="0""#, &["scene.xml:17:", "`radius`"]),
        (r#"name="radius" value="0.2""#, r#"name="radius" value="nan""#, &["scene.xml:17:", "nan"]),
        (r#"value="20, 18, 15""#, r#"value="20, -18, 15""#, &["scene.xml:18:"]),
        (r#"<integrator type="bdpt"/>"#, "", &["scene.xml:1:", "no integrator"]),
    ] {
        bench.write_changed(from, to);
        bench.run(&["render", "scene.xml"]).fails(3, &[words, &["scene.xml:"]].concat());
        bench.run(&["info", "scene.xml"]).fails(3, words);
    }
    assert!(bench.made().is_empty());
}

#[test]
fn a_picture_of_four_thousand_million_pixels() {
    let bench = Bench::new();
    let both =
        SCENE.replace(r#"value="24""#, r#"value="65536""#).replace(r#"value="16""#, r#"value="65536""#);
    bench.write("scene.xml", both);
    bench.run(&["render", "scene.xml"]).fails(3, &["scene.xml:3:", "65536 × 65536 pixels are more than"]);
}

#[test]
fn what_is_not_supported_yet_says_so() {
    let bench = Bench::new();
    let integrator = r#"<integrator type="bdpt"/>"#;
    for (from, to) in [
        (BALL, r#"<bsdf type="disney"/>"#),
        (BALL, r#"<bsdf type="thindielectric"/>"#),
        (integrator, r#"<integrator type="photonmapper"/>"#),
        (BALL, r#"<medium type="homogeneous"/>"#),
    ] {
        bench.write_changed(from, to);
        let line = if from == BALL { "scene.xml:14:" } else { "scene.xml:2:" };
        bench.run(&["render", "scene.xml"]).fails(3, &["not supported yet", line]);
    }
    assert!(bench.made().is_empty());
}

#[test]
fn errors_in_a_mesh_have_a_place_too() {
    let bench = Bench::new();
    for (mesh, words) in [
        ("v -3 0 -3\nv nan 0 3\nv 3 0 3\nf 1 2 3\n", &["floor.obj:2:3", "^^^"][..]),
        ("v -3 0 -3\nv inf 0 3\nv 3 0 3\nf 1 2 3\n", &["floor.obj:2:3"]),
        ("v -3 0 -3\nv 0 0 3\nf 1 2 3\n", &["floor.obj:3:7"]),
        ("v 0 0\n", &["floor.obj:1"]),
        ("", &["floor.obj"]),
        ("\u{0}\u{1}\u{2}", &["floor.obj:1"]),
    ] {
        bench.write("floor.obj", mesh);
        bench.run(&["render", "scene.xml"]).fails(3, words);
    }
    assert!(bench.made().is_empty());
}

#[test]
fn a_lamp_without_area() {
    let bench = Bench::new();
    bench.write("floor.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    bench.write_changed(
        r#"value="floor.obj"/></mesh>"#,
        r#"value="floor.obj"/><emitter type="area"><color name="radiance" value="1 1 1"/></emitter></mesh>"#,
    );
    bench.run(&["render", "scene.xml"]).fails(3, &["floor.obj:4", "no face with an area"]);
    assert!(bench.made().is_empty());
}

#[test]
fn scenes_that_are_no_scene_files() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("folder.xml")).unwrap();
    bench.write("empty.xml", "");
    bench.write("binary.xml", b"\x7fELF\x02\x01\xff\xfe\x00\x00");
    bench.write("root.xml", "<html/>");
    for (name, words) in [
        ("none.xml", &["cannot read the scene `none.xml`: there is no such file"][..]),
        ("folder.xml", &["cannot read the scene `folder.xml`: it is not a regular file"]),
        ("empty.xml", &["empty.xml:1:1", "malformed XML"]),
        ("binary.xml", &["binary.xml:1:7", "not UTF-8 text", "help: save the file with the encoding UTF-8"]),
        ("root.xml", &["root.xml:1:", "<html>"]),
    ] {
        for command in ["render", "info", "test"] {
            bench.run(&[command, name]).fails(3, words);
        }
    }
    assert_eq!(bench.made(), ["binary.xml", "empty.xml", "folder.xml", "root.xml"]);
}

#[test]
fn errors_are_told_in_json_with_the_warnings_before_them() {
    let bench = Bench::new();
    bench.write("scene.xml", SCENE.replace("velvet", "").replace(BALL, r#"<bsdf type="velvet"/>"#));
    let ran = bench.run(&["render", "scene.xml", "--json"]);
    assert_eq!(ran.code, Some(3));
    let json = ran.json();
    assert_eq!((&json["exit_code"], &json["warnings"]), (&3.into(), &serde_json::json!([])));
    let error = &json["error"];
    assert_eq!([&error["origin"]["line"], &error["origin"]["column"]], [14, 17]);
    assert!(error["hint"].as_str().unwrap().starts_with("known are"), "{error}");
    bench.write_changed(r#"<float name="fov""#, r#"<float name="fovv""#);
    let json = bench.run(&["render", "scene.xml", "--json", "-o", "none/x"]).json();
    assert_eq!((&json["exit_code"], json["warnings"].as_array().unwrap().len()), (&4.into(), 1));
}

#[test]
fn untrusted_scenes_stay_in_their_folder() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("inner")).unwrap();
    bench.write("inner/scene.xml", SCENE.replace("floor.obj", "../floor.obj"));
    bench.run(&["info", "inner/scene.xml"]).ok();
    for command in
        [&["info", "inner/scene.xml", "--untrusted"][..], &["render", "inner/scene.xml", "--untrusted"]]
    {
        bench.run(command).fails(3, &["scene.xml:11:", "`../floor.obj`", "outside of the scene's folder"]);
    }
    bench.run(&["info", "scene.xml", "--untrusted"]).ok();
}
