//! Each sentence that `explain` can say, on a scene of which it is true.

use caustica_math::Rgb;
use caustica_render::Control;
use caustica_scene::Description;
use caustica_scene::description::{Crop, Geometry, Integrator, LightKind, MaterialKind, Technique};
use caustica_testkit::agreement::flatten;
use caustica_testkit::build::{add, diffuse, ellipsoid, emit, glass, look, point_light, quad, scene, sphere};
use caustica_testkit::scenes::{
    ball, bulb, dark_box, furnace, glass_kind, lit_by, metal_kind, open_box, plastic_kind, under_the_sky,
};
use caustica_transport::Settings;
use caustica_verify::{Explanation, Question, explain};

fn ask(d: Description, settings: Settings, region: Option<Crop>) -> Explanation {
    let names: Vec<String> = d.shapes.iter().map(|s| s.name.clone()).collect();
    let question = Question { region, settings, samples: 64, threads: None, names: &names };
    let answer = explain(&flatten(d), &question, &Control::default(), |_| ()).unwrap();
    println!("{:#?}", answer.sentences);
    answer
}

fn says(d: Description, settings: Settings, words: &[&str]) -> Explanation {
    let answer = ask(d, settings, None);
    let all = answer.sentences.join("\n");
    for word in words {
        assert!(all.contains(word), "`{word}` is not in: {all}");
    }
    answer
}

fn to(depth: u32) -> Settings {
    Settings { max_depth: Some(depth), ..Settings::default() }
}

/// A glass ball under a lamp, seen in a mirror that stands before the camera.
fn ball_in_a_mirror(lamp: impl FnOnce(&mut Description)) -> Description {
    let mut d = scene(24);
    look(&mut d, [0.0, 0.3, -1.0], [0.0, 0.0, -3.0]);
    let (white, mirror, glass) = (
        diffuse(&mut d, 0.7),
        d.add_material(MaterialKind::Mirror { reflectance: Rgb::splat(0.9) }),
        glass(&mut d),
    );
    quad(&mut d, [-2.0, -0.6, -3.0], [0.0, 0.0, 5.0], [4.0, 0.0, 0.0], white);
    let standing = quad(&mut d, [-3.0, -1.0, -3.0], [6.0, 0.0, 0.0], [0.0, 4.0, 0.0], mirror);
    d.shapes[standing].name = "looking glass".into();
    let ball = sphere(&mut d, [0.0, 0.0, 0.5], 0.5, glass);
    d.shapes[ball].name = "crystal".into();
    lamp(&mut d);
    d
}

/// What is counted is what the picture has, also with a filter that reaches beyond a pixel and with lamps just outside
/// of the frame: of the whole picture, and of a region.
#[test]
fn the_light_is_that_of_the_picture() {
    let mut d = dark_box();
    let m = diffuse(&mut d, 0.5);
    let lamp = sphere(&mut d, [-0.55, 0.55, -0.4], 0.25, m);
    emit(&mut d, lamp, 20.0);
    look(&mut d, [0.0, 0.0, -1.9], [0.1, -0.1, 0.0]);
    (d.film.width, d.film.height) = (16, 16);
    d.film.filter = caustica_math::Filter::Tent { radius: 2.0 };
    let scene = flatten(d.clone());
    let options = caustica_render::RenderOptions { samples: 256, settings: to(4), ..Default::default() };
    let session = caustica_render::Session::new(&scene, options).unwrap();
    session.run(&Control::default(), |_| ()).unwrap();
    let picture = session.film().develop();
    for region in [Crop { x: 0, y: 0, width: 16, height: 16 }, Crop { x: 0, y: 0, width: 3, height: 4 }] {
        let pixels = (0..region.height).flat_map(|y| (0..region.width).map(move |x| (y * 16 + x) as usize));
        let sum: f64 = pixels.map(|i| f64::from((picture.eye[i] + picture.light[i]).luminance())).sum();
        let mean = sum / f64::from(region.width * region.height);
        let told = ask(d.clone(), to(4), Some(region)).mean;
        assert!((told / mean - 1.0).abs() < 0.05, "{region:?}: {told} for {mean}");
    }
}

#[test]
fn light_that_no_strategy_reaches_is_estimated_and_named() {
    let point = ball_in_a_mirror(|d| point_light(d, [0.0, 2.5, 0.5], 2.0));
    let words = [
        "is missing: LS+DS+E",
        "the point light at (0, 2.5, 0.5)",
        "smooth glass `crystal`",
        "mirror `looking glass`",
        "Give the lamp a size",
    ];
    let answer = says(point, to(8), &words);
    let missing: f64 = answer.missing.iter().filter(|m| m.pattern == "LS+DS+E").map(|m| m.share).sum();
    // The same with a lamp of a size: power 4π·2 = π·L·4πr².
    let radius = 0.1;
    let sized = ball_in_a_mirror(|d| {
        let black = diffuse(d, 0.0);
        let lamp = sphere(d, [0.0, 2.5, 0.5], radius, black);
        emit(d, lamp, 2.0 / (std::f32::consts::PI * radius * radius));
    });
    let names: Vec<String> = sized.shapes.iter().map(|s| s.name.clone()).collect();
    let question = Question { region: None, settings: to(8), samples: 1024, threads: None, names: &names };
    let truth = explain(&flatten(sized), &question, &Control::default(), |_| ()).unwrap();
    // Lamps seen in mirrors are light that a point does not have.
    let share =
        |pattern: &str| truth.rows.iter().filter(|r| r.pattern == pattern).map(|r| r.light).sum::<f64>();
    let expected = share("LS+DS+E") / (1.0 - share("LS+E") - share("LE"));
    println!("{missing} against {expected}");
    assert!(missing > 0.5 * expected && missing < 2.0 * expected, "{missing} against {expected}");
    assert!(truth.missing.is_empty());
}

#[test]
fn a_scene_without_lamps() {
    says(dark_box(), to(8), &["The scene has no light"]);
}

#[test]
fn rays_that_leave_the_scene() {
    let mut d = open_box();
    look(&mut d, [0.0, 0.0, -3.2], [0.0, 0.0, -9.0]);
    says(d, to(8), &["leave the scene without meeting anything"]);
}

#[test]
fn black_surfaces_and_dark_sides() {
    let mut d = open_box();
    d.materials.iter_mut().for_each(|m| m.kind = MaterialKind::Diffuse { albedo: Rgb::BLACK.into() });
    look(&mut d, [0.0, 0.0, -1.5], [0.0, -0.2, 0.0]);
    says(d, to(8), &["scatter nothing towards the camera"]);
    let mut d = open_box();
    look(&mut d, [0.0, 0.99, 0.0], [0.01, 0.0, 0.0]);
    d.shapes.remove(3);
    let answer = says(d, to(8), &["the dark side of a lamp"]);
    assert_eq!(answer.sentences.len(), 1);
}

#[test]
fn lamps_that_face_away() {
    let mut d = dark_box();
    let m = diffuse(&mut d, 0.5);
    // Below the floor, shining down.
    let lamp = quad(&mut d, [-0.5, -1.2, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], m);
    d.shapes[lamp].name = "cellar lamp".into();
    emit(&mut d, lamp, 5.0);
    says(d, to(8), &["No light path from the lamp `cellar lamp` meets any surface", "reverse its triangles"]);
}

#[test]
fn a_camera_inside_an_object() {
    let mut d = open_box();
    let m = diffuse(&mut d, 0.5);
    let shell = add(&mut d, "shell", Geometry::Mesh(ellipsoid(8, [0.5; 3])), m);
    d.shapes[shell].to_world = caustica_math::Transform::translate([0.0, 0.0, -3.2]);
    says(d, to(8), &["the camera is inside an object"]);
    let mut d = open_box();
    let m = glass(&mut d);
    sphere(&mut d, [0.0, 0.0, -3.2], 0.5, m);
    says(d, to(8), &["The camera is inside a transparent object"]);
}

#[test]
fn paths_that_are_cut_too_short() {
    let mut d = open_box();
    // A hole in no wall: what the camera sees is lit by the walls alone.
    let m = diffuse(&mut d, 0.0);
    quad(&mut d, [-1.0, 0.8, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 1.9], m);
    says(d, to(2), &["comes by paths longer than the 2 edges", "--max-depth"]);
}

#[test]
fn integrators_that_cannot_reach_it() {
    let mut d = dark_box();
    point_light(&mut d, [0.0, 0.5, 0.0], 2.0);
    let naive = Settings { integrator: Integrator::Path(Technique::Materials), ..to(8) };
    says(d, naive, &["`naive` cannot reach 100 %", "render it by `bdpt`"]);
}

#[test]
fn noise_is_told_with_its_paths_and_what_helps() {
    let mut d = dark_box();
    let m = glass(&mut d);
    let ball = sphere(&mut d, [0.1, -0.5, 0.0], 0.4, m);
    d.shapes[ball].name = "ball".into();
    let lamp = LightKind::Spot {
        position: [0.1, 0.9, 0.0],
        direction: [0.0, -1.0, 0.0],
        intensity: Rgb::splat(5.0),
        inner_angle: 12.0,
        outer_angle: 14.0,
    };
    caustica_testkit::build::light(&mut d, lamp);
    let region = Some(Crop { x: 6, y: 11, width: 6, height: 4 });
    let answer = ask(d, to(8), region);
    let told = answer.sentences.join("\n");
    assert!(told.contains("of bdpt's noise") && told.contains("the spot at (0.1, 0.9, 0)"), "{told}");
    assert!(told.contains("over the smooth glass `ball`") && !told.contains("larger lamp"), "{told}");
    assert_eq!(answer.region, [6, 11, 6, 4]);
    let light: f64 = answer.rows.iter().map(|r| r.light).sum();
    let noise: f64 = answer.rows.iter().map(|r| r.noise).sum();
    assert!((light - 1.0).abs() < 1e-9 && (noise - 1.0).abs() < 1e-9);
}

#[test]
fn answers_do_not_depend_on_threads() {
    let d = ball_in_a_mirror(|d| point_light(d, [0.0, 2.5, 0.5], 2.0));
    let names: Vec<String> = d.shapes.iter().map(|s| s.name.clone()).collect();
    let scene = flatten(d);
    let run = |threads| {
        let question =
            Question { region: None, settings: to(6), samples: 16, threads: Some(threads), names: &names };
        let answer = explain(&scene, &question, &Control::default(), |_| ()).unwrap();
        format!("{answer:?}")
    };
    assert_eq!(run(1), run(3));
}

fn row<'a>(answer: &'a Explanation, pattern: &str) -> &'a caustica_verify::Row {
    let row = answer.rows.iter().find(|r| r.pattern == pattern);
    row.unwrap_or_else(|| panic!("no {pattern} in {:#?}", answer.rows))
}

/// Noise is variance: light that every sample finds alike has none, however much of it there is.
#[test]
fn constant_light_is_no_noise() {
    // A sky of one brightness, seen by a camera in parallel projection, which only eye paths can do.
    let mut d = scene(16);
    d.camera.kind = caustica_scene::description::CameraKind::Orthographic;
    caustica_testkit::build::light(&mut d, LightKind::Constant { radiance: Rgb::WHITE });
    let answer = ask(d.clone(), to(8), None);
    assert!((answer.mean - 1.0).abs() < 1e-6 && answer.per_sample == 0.0, "{answer:?}");
    assert_eq!((row(&answer, "LE").noise, row(&answer, "LE").per_sample), (0.0, 0.0));
    assert!(answer.sentences.join("").contains("There is no noise"));
    // A dim lamp before it: all noise, little light.
    let black = diffuse(&mut d, 0.0);
    let grey = diffuse(&mut d, 0.05);
    look(&mut d, [0.0, 0.0, -3.0], [0.0, 0.0, 0.0]);
    sphere(&mut d, [0.0, 0.0, 0.0], 0.3, grey);
    let lamp = sphere(&mut d, [0.0, 3.0, -1.0], 0.2, black);
    emit(&mut d, lamp, 1.0);
    let answer = ask(d, to(8), None);
    let (bright, dim) = (row(&answer, "LE"), row(&answer, "LDE"));
    assert!(bright.light > 10.0 * dim.light && dim.per_sample > 0.0, "{answer:#?}");
}

/// What a sample's standard deviation is said to be is what pictures of fresh seeds show.
#[test]
fn the_noise_is_that_of_the_picture() {
    let d = ball(plastic_kind());
    let told = ask(d.clone(), to(6), None).per_sample;
    let scene = flatten(d);
    let samples = 4;
    let picture = |seed| {
        let settings = Settings { seed, ..to(6) };
        let options = caustica_render::RenderOptions { samples, settings, ..Default::default() };
        let session = caustica_render::Session::new(&scene, options).unwrap();
        session.run(&Control::default(), |_| ()).unwrap();
        let p = session.film().develop();
        p.eye.iter().zip(&p.light).map(|(a, b)| f64::from((*a + *b).luminance())).collect::<Vec<_>>()
    };
    let (mut squares, mut sum, mut count) = (0.0, 0.0, 0.0);
    for pair in 0..32 {
        for (a, b) in picture(2 * pair + 100).into_iter().zip(picture(2 * pair + 101)) {
            squares += (a - b) * (a - b) / 2.0;
            sum += (a + b) / 2.0;
            count += 1.0;
        }
    }
    let true_one = (squares / count * f64::from(samples)).sqrt() / (sum / count);
    assert!((told / true_one - 1.0).abs() < 0.15, "{told} for {true_one}");
}

#[test]
fn mirrors_alone_under_a_point_light() {
    let mut d = dark_box();
    let mirror = || MaterialKind::Mirror { reflectance: Rgb::splat(0.9) };
    d.materials.iter_mut().for_each(|m| m.kind = mirror());
    point_light(&mut d, [0.3, 0.5, 0.0], 2.0);
    let answer = says(d.clone(), to(8), &["shows mirrors or glass", "lamps without extent are not seen"]);
    assert_eq!(answer.sentences.len(), 1);
    // A lamp with a size is seen in them.
    d.lights.clear();
    let black = diffuse(&mut d, 0.0);
    let lamp = sphere(&mut d, [0.3, 0.5, 0.0], 0.1, black);
    emit(&mut d, lamp, 2.0);
    says(d, to(8), &["LS+E", "seen in the mirror", "It is the lamp itself"]);
}

#[test]
fn glass_on_the_eye_s_side_casts_nothing() {
    let mut d = open_box();
    let m = glass(&mut d);
    let ball = sphere(&mut d, [0.0, 0.0, -1.2], 0.6, m);
    d.shapes[ball].name = "lens".into();
    look(&mut d, [0.0, 0.0, -2.6], [0.0, 0.0, 0.0]);
    let region = Some(Crop { x: 6, y: 6, width: 4, height: 4 });
    let answer = ask(d, to(4), region);
    let told = answer.sentences.join(" ");
    assert!(told.contains("seen in the smooth glass `lens`") && !told.contains("over the"), "{told}");
}

#[test]
fn lamps_that_shine_on_nothing() {
    let mut d = scene(16);
    let m = diffuse(&mut d, 0.5);
    quad(&mut d, [-1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], m);
    let up = LightKind::Spot {
        position: [0.0, 0.5, 0.0],
        direction: [0.0, 1.0, 0.0],
        intensity: Rgb::splat(5.0),
        inner_angle: 12.0,
        outer_angle: 14.0,
    };
    caustica_testkit::build::light(&mut d, up);
    says(d, to(8), &["No light path from the spot at (0, 0.5, 0)", "turn it"]);
}

/// What a lighting designer would hear of a dozen scenes, to be read with `--nocapture`; and words that never fit.
#[test]
fn what_is_said_of_a_dozen_scenes() {
    let sun = LightKind::Directional { direction: [0.2, -1.0, 0.4], irradiance: Rgb::splat(3.0) };
    let point = || LightKind::Point { position: [0.3, 0.6, -0.2], intensity: Rgb::splat(3.0) };
    let with_glass = |kind: LightKind| {
        let mut d = lit_by(kind);
        let m = glass(&mut d);
        sphere(&mut d, [0.1, -0.5, 0.0], 0.4, m);
        d
    };
    let cases = [
        ("furnace, seen at once", furnace(), to(1)),
        ("furnace", furnace(), to(8)),
        ("box", open_box(), to(8)),
        ("plastic ball", ball(plastic_kind()), to(8)),
        ("glass ball", ball(glass_kind(false)), to(8)),
        ("metal ball", ball(metal_kind(None)), to(8)),
        ("lamp in glass", bulb(), to(12)),
        ("sky over glass", under_the_sky(glass_kind(false)), to(8)),
        ("sky over plastic", under_the_sky(plastic_kind()), to(8)),
        ("point", lit_by(point()), to(8)),
        ("point over glass", with_glass(point()), to(8)),
        ("sun over glass", with_glass(sun), to(8)),
    ];
    for (name, d, settings) in cases {
        println!("== {name}");
        let pointlike = !d.lights.is_empty() && d.shapes.iter().all(|s| s.emission.is_none());
        let answer = ask(d, settings, None);
        let told = answer.sentences.join(" ");
        assert!(!told.is_empty() && answer.per_sample.is_finite(), "{name}");
        assert!(!pointlike || !told.contains("larger lamp"), "{name}: {told}");
        for r in answer.rows.iter().take(5) {
            println!(
                "{:<14} {:.3} {:.3} {:.2} {} {:?}",
                r.pattern, r.light, r.noise, r.per_sample, r.lamp, r.strategies
            );
        }
    }
}
