use crate::bench::Bench;

const SHORT: [&str; 5] = ["--seconds", "0.4", "--fps", "10", "-q"];

#[test]
fn each_kind_of_video_is_an_mp4() {
    let bench = Bench::new();
    for (kind, more) in [
        ("converge", &["--spp", "3", "--hold", "0.2"][..]),
        ("pyramid", &["--spp", "2", "--rows", "2", "--hold", "0"]),
        ("orbit", &["--spp", "1", "--degrees", "360"]),
    ] {
        bench.run(&[&["video", kind, "scene.xml"], &SHORT[..], more].concat()).ok();
        let bytes = bench.bytes(&format!("scene-{kind}.mp4"));
        assert_eq!(&bytes[4..8], b"ftyp", "{kind}");
    }
    let json =
        bench.run(&["video", "orbit", "--seconds", "0.1", "--resolution", "24x16", "--spp", "1", "--json"]);
    let json = json.ok().json();
    assert_eq!((&json["width"], &json["frames"]), (&24.into(), &2.into()));
    assert_eq!(json["output"], "caustica-orbit.mp4");
}

#[test]
fn pictures_without_a_light_image_are_shown_alone() {
    let bench = Bench::new();
    for (integrator, what) in [("path", "no light image"), ("light", "no eye image")] {
        let args = ["video", "converge", "scene.xml", "--spp", "2", "--integrator", integrator];
        let ran = bench.run(&[&args[..], &["--seconds", "0.2", "--layout", "side"]].concat()).ok();
        assert!(ran.err.contains("warning") && ran.err.contains(what), "{}", ran.err);
        assert!(ran.out.starts_with("24 × 16"), "{}", ran.out);
    }
    let ran = bench.run(&[
        "video",
        "orbit",
        "scene.xml",
        "--integrator",
        "path",
        "--strategies",
        "s=0",
        "--seconds",
        "0.1",
    ]);
    assert!(ran.ok().err.contains("`--strategies` has no effect"));
}

#[test]
fn wrong_videos() {
    let bench = Bench::new();
    bench.run(&["video", "orbit", "scene.xml", "-o", "x.avi"]).fails(2, &["must end in .mp4"]);
    bench.run(&["video", "orbit", "scene.xml", "-o", "none/x.mp4"]).fails(4, &["the folder does not exist"]);
    bench.run(&["video", "converge", "scene.xml", "--fps", "0"]).fails(2, &["0 is not in 1..=60"]);
    bench.run(&["video", "converge", "scene.xml", "--seconds", "-1"]).fails(2, &["unexpected argument"]);
    bench
        .run(&["video", "pyramid", "scene.xml", "--resolution", "24x8"])
        .fails(2, &["48 × 8", "at least 16"]);
    bench.run(&["video", "orbit", "scene.xml", "--degrees", "nan"]).fails(2, &["number of degrees"]);
    bench.run(&["video", "orbit", "scene.xml", "--centre", "1,2"]).fails(2, &["X,Y,Z"]);
    assert!(bench.made().is_empty());
}
