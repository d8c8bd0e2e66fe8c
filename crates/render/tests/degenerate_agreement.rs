//! Integrators agree on scenes that are asking for trouble: block by block by Welch's t-test at a significance of 10⁻³
//! a pair, Šidák-corrected; seeds are fixed.

use caustica_math::Rgb;
use caustica_scene::Description;
use caustica_scene::description::{LightKind, MaterialKind, Roughness};
use caustica_testkit::agreement::{Estimate, Plan, agree, estimate, flatten};
use caustica_testkit::build::{diffuse, emit, glass, look, point_light, quad, scene, sphere};
use caustica_testkit::scaled::scaled;
use caustica_testkit::scenes;
use caustica_testkit::ways::{Way, Way::*};

fn estimates(name: &str, d: Description, passes: u32, ways: &[Way]) -> Vec<Estimate> {
    let scene = flatten(d);
    let plan = Plan { passes, block: 4, only: None };
    let render = |(i, way): (usize, &Way)| {
        let e = estimate(&scene, &way.settings(31 + i as u64), plan);
        println!("{name} {way:?}: {:.5} ± {:.5}", e.whole.mean, e.whole.variance_of_mean().sqrt());
        e
    };
    ways.iter().enumerate().map(render).collect()
}

/// All ways agree with the first.
fn check(name: &str, d: Description, passes: u32, ways: &[Way]) {
    let estimates = estimates(name, d, passes, ways);
    for (e, way) in estimates.iter().zip(ways).skip(1) {
        if let Err(message) = agree(&estimates[0], e) {
            panic!("{name}: {way:?} differs from {:?} in {message}", ways[0]);
        }
    }
}

#[test]
fn other_scales() {
    let d = scenes::ball(scenes::rough_glass_kind());
    let reference = &estimates("as it is", d.clone(), 300, &[Bdpt])[0];
    for k in [1e-6, 1e6] {
        for (e, way) in
            estimates(&format!("× {k}"), scaled(d.clone(), k), 300, &[Bdpt, Power, Path, Light])[..]
                .iter()
                .zip([Bdpt, Power, Path, Light])
        {
            if let Err(message) = agree(reference, e) {
                panic!("× {k} by {way:?}: {message}");
            }
        }
    }
}

/// Two quads in one plane, of one material and of two; a ball twice, of clay and of glass.
#[test]
fn coincident_surfaces() {
    let twice = |kinds: [MaterialKind; 2]| {
        let mut d = scenes::open_box();
        let [a, b] = kinds.map(|kind| d.add_material(kind));
        for m in [a, b] {
            quad(&mut d, [-0.8, -0.5, 0.5], [0.0, 0.0, -1.0], [0.7, 0.0, 0.0], m);
            quad(&mut d, [-0.8, -0.5, 0.5], [0.7, 0.0, 0.0], [0.0, 0.0, -1.0], m);
            sphere(&mut d, [0.4, -0.4, 0.1], 0.4, m);
        }
        d
    };
    let grey = |albedo| MaterialKind::Diffuse { albedo: Rgb::splat(albedo).into() };
    check("clay twice", twice([grey(0.5), grey(0.5)]), 300, &[Bdpt, Naive, Path, Light]);
    check("light and dark clay", twice([grey(0.8), grey(0.1)]), 300, &[Bdpt, Naive, Path, Light]);
    check("glass on glass", twice([scenes::glass_kind(false); 2]), 1500, &[Bdpt, Naive, NoLightImage]);
}

/// A room with a glass ball around the middle.
fn glass_around(center: [f32; 3], radius: f32) -> Description {
    let mut d = scenes::open_box();
    let m = glass(&mut d);
    sphere(&mut d, center, radius, m);
    d
}

#[test]
fn cameras_inside_glass() {
    let mut d = glass_around([0.0, 0.0, -1.2], 0.5);
    look(&mut d, [0.1, 0.05, -1.3], [0.0, 0.0, 0.0]);
    let clay = diffuse(&mut d, 0.6);
    sphere(&mut d, [0.1, -0.1, -1.0], 0.1, clay);
    check("camera in glass", d, 1500, &[Bdpt, Naive, Path, NoLightImage]);
    let mut rough = glass_around([0.0, 0.0, -1.2], 0.5);
    look(&mut rough, [0.1, 0.05, -1.3], [0.0, 0.0, 0.0]);
    rough.materials.last_mut().unwrap().kind = scenes::rough_glass_kind();
    check("camera in rough glass", rough, 400, &[Bdpt, Naive, Path, Light]);
}

#[test]
fn lamps_inside_glass() {
    let mut d = scenes::dark_box();
    let (m, clay) = (d.add_material(scenes::rough_glass_kind()), diffuse(&mut d, 0.4));
    sphere(&mut d, [0.0, 0.1, 0.0], 0.5, m);
    let lamp = sphere(&mut d, [0.1, 0.1, 0.0], 0.2, clay);
    emit(&mut d, lamp, 4.0);
    check("lamp in rough glass", d.clone(), 600, &[Bdpt, Naive, Path, Light]);
    d.shapes[lamp].emission = None;
    point_light(&mut d, [-0.2, 0.1, 0.0], 1.0);
    check("point in rough glass", d.clone(), 600, &[Bdpt, Path, Light]);
    // A camera in the same glass as the lamp.
    look(&mut d, [0.3, 0.1, -0.2], [-0.2, 0.1, 0.1]);
    d.shapes[lamp].emission = Some(Rgb::splat(4.0).into());
    check("camera and lamps in rough glass", d, 600, &[Bdpt, Path, Light]);
}

/// A lamp shines outwards only: from inside it is as dark as its surface.
#[test]
fn cameras_inside_lamps() {
    let mut d = scenes::open_box();
    let clay = diffuse(&mut d, 0.5);
    let lamp = sphere(&mut d, [0.0, 0.0, -3.2], 0.3, clay);
    emit(&mut d, lamp, 2.0);
    for e in estimates("camera in a lamp", d, 20, &[Bdpt, Naive, Path, Light]) {
        assert_eq!(e.whole.mean, 0.0);
    }
}

#[test]
fn materials_at_the_ends_of_their_ranges() {
    let dielectric = |interior_ior| MaterialKind::dielectric(interior_ior, 1.0);
    let rough =
        |alpha, interior_ior| MaterialKind::rough_dielectric(Roughness::ggx(alpha), interior_ior, 1.0);
    let plastic = |alpha, interior_ior| MaterialKind::Microfacet {
        alpha,
        interior_ior,
        exterior_ior: 1.0,
        kd: Rgb::splat(0.3).into(),
    };
    for (name, kind) in [
        ("no glass", dielectric(1.0)),
        ("glass of 10⁶", dielectric(1e6)),
        ("glass of 10⁻⁶", dielectric(1e-6)),
        ("rough, no glass", rough(0.3, 1.0)),
        ("rough glass of 10⁶", rough(0.3, 1e6)),
        ("dull glass", rough(1.0, 1.5)),
        ("dull plastic", plastic(1.0, 1e6)),
        ("dull metal", scenes::metal_kind(Some(1.0))),
    ] {
        check(name, scenes::ball(kind), 300, &[Bdpt, Naive, NoLightImage]);
    }
    // Almost smooth: next to nothing is found by chance but along the mirror's direction.
    for (name, kind) in [
        ("smoothest glass", rough(1e-9, 1.5)),
        ("smoothest metal", scenes::metal_kind(Some(1e-9))),
        ("smoothest plastic", plastic(1e-9, 1.5)),
    ] {
        check(name, scenes::ball(kind), 300, &[Naive, Path]);
    }
}

/// Colours of nothing, beside others of all.
#[test]
fn colours_at_the_ends() {
    let mut d = scenes::ball(MaterialKind::Diffuse { albedo: Rgb::BLACK.into() });
    d.materials[1].kind = MaterialKind::Mirror { reflectance: Rgb::new(1.0, 0.0, 0.5) };
    check("black and red", d, 300, &[Bdpt, Naive, Path]);
    let mut furnace = scene(8);
    let white = diffuse(&mut furnace, 1.0);
    sphere(&mut furnace, [0.0, 0.0, 3.0], 0.5, white);
    caustica_testkit::build::light(&mut furnace, LightKind::Constant { radiance: Rgb::splat(1e20) });
    check("white under a bright sky", furnace, 300, &[Bdpt, Naive, Path, Light]);
}
