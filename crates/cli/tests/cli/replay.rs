use serde_json::Value;

use crate::bench::Bench;

fn rgb(value: &Value) -> [f64; 3] {
    [0, 1, 2].map(|i| value[i].as_f64().unwrap())
}

fn add(sum: [f64; 3], more: [f64; 3], factor: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| sum[i] + more[i] * factor)
}

#[track_caller]
fn assert_close(a: [f64; 3], b: [f64; 3]) {
    for (a, b) in a.into_iter().zip(b) {
        assert!((a - b).abs() <= 1e-5 * a.abs().max(b.abs()) + 1e-6, "{a} {b}");
    }
}

const PIXELS: [[u32; 2]; 8] = [[0, 15], [3, 13], [8, 9], [12, 14], [14, 8], [18, 13], [19, 3], [23, 14]];

/// The sum of a sample's weighted contributions to the eye image, and how many there are.
fn joined(replay: &Value) -> ([f64; 3], usize) {
    let (mut sum, mut count) = ([0.0; 3], 0);
    for c in replay["contributions"].as_array().unwrap() {
        let weight = c["weight"].as_f64().unwrap();
        assert!((0.0..=1.000_001).contains(&weight), "{c}");
        let (s, t) = (c["s"].as_u64().unwrap(), c["t"].as_u64().unwrap());
        assert_eq!(c["path"].as_array().unwrap().len() as u64, s + t, "{c}");
        if t >= 2 {
            sum = add(sum, rgb(&c["contribution"]), weight);
            count += 1;
        }
    }
    (sum, count)
}

/// All samples of a small render: what they find is what its film holds.
#[test]
fn contributions_add_up_and_are_what_a_render_holds() {
    let bench = Bench::new();
    let same = ["--resolution", "6x4", "--seed", "5"];
    let (picture, _) = bench.render("all", &[&same[..], &["--spp", "1"]].concat());
    let mut light = [[0.0; 3]; 24];
    let (mut contributions, mut splats) = (0, 0);
    for (index, in_film) in picture.eye.iter().enumerate() {
        let (x, y) = (index % 6, index / 6);
        let place = format!("{x},{y},0");
        let args = [&["render", "scene.xml", "--json", "--replay", &place][..], &same].concat();
        let replay = bench.run(&args).ok().json();
        assert_eq!((&replay["pixel"], &replay["integrator"]), (&serde_json::json!([x, y]), &"bdpt".into()));
        let (sum, count) = joined(&replay);
        assert_close(rgb(&replay["eye"]), sum);
        assert_close(in_film.0.map(f64::from), sum);
        contributions += count;
        for splat in replay["splats"].as_array().unwrap() {
            let [x, y] = [0, 1].map(|i| splat["film"][i].as_f64().unwrap().floor());
            // Filters wider than this one would reach in from outside.
            if (0.0..6.0).contains(&x) && (0.0..4.0).contains(&y) {
                let pixel = &mut light[y as usize * 6 + x as usize];
                *pixel = add(*pixel, rgb(&splat["value"]), 1.0);
                splats += 1;
            }
        }
    }
    assert!(contributions > 5 && splats > 5, "{contributions} contributions, {splats} splats");
    for (in_film, sum) in picture.light.iter().zip(light) {
        assert_close(in_film.0.map(f64::from), sum);
    }
}

#[test]
fn later_samples_and_signed_filters_agree_with_renders_too() {
    let bench = Bench::new();
    bench.write_changed(r#"<rfilter type="box"/>"#, r#"<rfilter type="mitchell"/>"#);
    for [x, y] in PIXELS {
        let crop = format!("{x},{y},1,1");
        let sum = |count: u32| {
            let (picture, _) = bench.render("sum", &["--crop", &crop, "--spp", &count.to_string()]);
            picture.eye[0].0.map(|c| f64::from(c) * f64::from(count))
        };
        let sample = format!("{x},{y},2");
        let replay =
            bench.run(&["render", "scene.xml", "--crop", &crop, "--json", "--replay", &sample]).ok().json();
        assert_close(rgb(&replay["eye"]), add(sum(3), sum(2), -1.0));
    }
}

#[test]
fn replays_can_be_read() {
    let bench = Bench::new();
    let ran = bench.run(&["render", "scene.xml", "--replay", "12,14,0"]).ok();
    assert!(ran.out.starts_with("pixel 12,14, sample 0, bdpt\neye image    ("), "{}", ran.out);
    assert!(ran.out.contains("× weight ") && ran.out.contains("camera at ("), "{}", ran.out);
    assert!(ran.out.contains(" forward, ") && ran.out.contains(" reverse"), "{}", ran.out);
    let ran = bench.run(&["render", "scene.xml", "--integrator", "path", "--replay", "12,14,0"]).ok();
    assert!(ran.out.contains("only bdpt tells its strategies"), "{}", ran.out);
    assert!(bench.made().is_empty());
}

#[test]
fn pixels_outside_of_the_picture_are_refused() {
    let bench = Bench::new();
    for place in ["24,0,0", "0,16,0", "4294967295,0,0"] {
        let ran = bench.run(&["render", "scene.xml", "--replay", place]);
        ran.fails(2, &["is not in the picture of 24 × 16 pixels"]);
    }
    let args = ["render", "scene.xml", "--crop", "4,4,2,2", "--json", "--replay", "3,4,0"];
    let ran = bench.run(&args);
    assert_eq!((ran.code, &ran.json()["exit_code"]), (Some(2), &2.into()));
}
