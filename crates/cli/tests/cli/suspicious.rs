//! Scenes that are odd, and are rendered with a warning.

use crate::bench::Bench;

/// Renders and returns the only warning.
#[track_caller]
fn warning(bench: &Bench) -> String {
    let ran = bench.run(&["render", "scene.xml"]).ok();
    assert_eq!(ran.err.matches("warning: ").count(), 1, "{}", ran.err);
    assert_eq!(bench.made(), ["scene.exr", "scene.png"]);
    let info = bench.run(&["info", "scene.xml"]).ok();
    assert_eq!(info.err, ran.err, "info warns of the same");
    ran.err
}

#[test]
fn a_scene_without_light_is_black() {
    let bench = Bench::new();
    bench.write_changed(r#"<emitter type="area"><color name="radiance" value="20, 18, 15"/></emitter>"#, "");
    assert!(warning(&bench).starts_with("warning: the scene has no light: the picture will be black"));
    let (picture, _) = bench.film("scene.exr");
    assert!(picture.eye.iter().chain(&picture.light).all(|p| p.max_channel() == 0.0));
    assert_eq!(picture.eye_samples, 2);
}

#[test]
fn a_lamp_that_faces_away() {
    let bench = Bench::new();
    let ceiling = FLAT_LAMP.replace("LAMP", "floor.obj");
    bench.write_changed(r#"  <mesh type="sphere">"#, &format!("{ceiling}\n  <mesh type=\"sphere\">"));
    let text = warning(&bench);
    assert!(text.starts_with("warning: scene.xml:12:3: "), "{text}");
    assert!(
        text.contains("faces away") && text.contains("= help: a lamp emits on the side of its normal"),
        "{text}"
    );
}

/// A copy of a mesh, high above everything, whose front looks up.
const FLAT_LAMP: &str = r#"  <mesh type="obj"><string name="filename" value="LAMP"/><transform name="toWorld"><translate value="0, 9, 0"/></transform><emitter type="area"><color name="radiance" value="1, 1, 1"/></emitter></mesh>"#;

#[test]
fn glass_that_is_not_closed() {
    let bench = Bench::new();
    bench.write_changed(
        r#"value="floor.obj"/></mesh>"#,
        r#"value="floor.obj"/><bsdf type="dielectric"/></mesh>"#,
    );
    let text = warning(&bench);
    assert!(text.starts_with("warning: scene.xml:11:3: ") && text.contains("not closed"), "{text}");
    assert!(text.contains("11 |   <mesh type=\"obj\">") && text.contains("\n   |   ^^^"), "{text}");
}

#[test]
fn properties_that_nobody_reads() {
    let bench = Bench::new();
    bench.write_changed(r#"<float name="fov""#, r#"<float name="fovv""#);
    let text = warning(&bench);
    assert!(text.contains("`fovv`") && text.contains("did you mean `fov`?"), "{text}");
}
