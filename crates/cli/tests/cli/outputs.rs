use crate::bench::Bench;

/// A render that would take minutes, so that an error that comes after it is noticed.
fn long_render<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["render", "scene.xml", "--spp", "100000000"], more].concat()
}

#[test]
fn what_cannot_be_written_is_told_before_rendering() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("folder")).unwrap();
    std::fs::create_dir(bench.path("taken.png")).unwrap();
    for (output, words) in [
        ("none/picture", "cannot write `none/picture.exr`: the folder does not exist"),
        ("folder", "cannot write `folder`: it is a folder"),
        ("folder/", "cannot write `folder/`: it is a folder"),
        (".", "it is a folder"),
        ("taken", "cannot write `taken.png`: it is a folder"),
        ("scene.xml/picture", "cannot write `scene.xml/picture.exr`: a part of its path is not a folder"),
    ] {
        bench.run(&long_render(&["-o", output])).fails(4, &[words]);
    }
    bench.run(&long_render(&["-o", "picture.jpg"])).fails(2, &["leave out `.jpg`"]);
    let long_name = "x".repeat(300);
    bench.run(&long_render(&["-o", &long_name])).fails(4, &["cannot write"]);
    assert_eq!(bench.made(), ["folder", "taken.png"]);
    assert_eq!(std::fs::read_dir(bench.path("folder")).unwrap().count(), 0);
}

#[cfg(unix)]
#[test]
fn a_folder_without_the_right_to_write() {
    use std::os::unix::fs::PermissionsExt;
    let bench = Bench::new();
    let folder = bench.path("locked");
    std::fs::create_dir(&folder).unwrap();
    std::fs::set_permissions(&folder, std::fs::Permissions::from_mode(0o555)).unwrap();
    // The superuser may write everywhere.
    if std::fs::write(folder.join("probe"), "").is_err() {
        bench.run(&long_render(&["-o", "locked/picture"])).fails(4, &["permission denied"]);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_system_that_nobody_can_write() {
    let bench = Bench::new();
    let ran = bench.run(&long_render(&["-o", "/proc/picture"]));
    ran.fails(4, &["cannot write `/proc/picture.exr`"]);
}

#[test]
fn errors_of_outputs_are_told_in_json() {
    let bench = Bench::new();
    let ran = bench.run(&long_render(&["-o", "none/picture", "--json"]));
    assert_eq!(ran.code, Some(4));
    let json = ran.json();
    assert_eq!((&json["exit_code"], &json["warnings"]), (&4.into(), &serde_json::json!([])));
    assert_eq!(json["error"]["severity"], "error");
}

#[test]
fn extensions_are_understood() {
    let bench = Bench::new();
    for output in ["a.exr", "b.png", "c.v2", "d.EXR"] {
        bench.run(&["render", "scene.xml", "-o", output]).ok();
    }
    let expected = ["a.exr", "a.png", "b.exr", "b.png", "c.v2.exr", "c.v2.png", "d.exr", "d.png"];
    assert_eq!(bench.made(), expected);
}

#[test]
fn a_film_too_large_for_the_machine() {
    let bench = Bench::new();
    let ran = bench.run(&["render", "scene.xml", "--resolution", "65536x65536"]);
    ran.fails(5, &["a film of 65536 × 65536 pixels needs 412317 MB of memory, more than there is"]);
    // A small part of it is nothing special.
    let small = ["render", "scene.xml", "--resolution", "65536x65536", "--crop", "30000,30000,8,8"];
    bench.run(&small).ok();
    assert_eq!(bench.film("scene.exr").0.width, 65536);
}
