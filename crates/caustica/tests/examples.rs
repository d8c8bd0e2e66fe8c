//! The examples are compiled by `cargo test`; what they do is called here, on small pictures.

#[allow(dead_code)]
#[path = "../examples/glass_ball.rs"]
mod glass_ball;

use caustica::film::read_exr;

#[test]
fn the_glass_ball_throws_a_caustic() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("ball");
    glass_ball::render(glass_ball::glass_ball([40, 30]), 16, output.to_str().unwrap()).unwrap();
    let (picture, facts) = read_exr(&output.with_extension("exr")).unwrap();
    assert_eq!((picture.eye_samples, picture.light_samples), (16, 16));
    assert_eq!(facts.get("integrator"), Some("bdpt"));
    let brightest = |layer: &[caustica::Rgb]| layer.iter().map(|p| p.max_channel()).fold(0.0, f32::max);
    assert!(brightest(&picture.light) > 0.5, "{}", brightest(&picture.light));
    assert!(std::fs::read(output.with_extension("png")).unwrap().starts_with(b"\x89PNG"));
}
