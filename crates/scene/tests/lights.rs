//! Every lamp sends out the power that it should, and lights what it should.
//!
//! Together the tests of each function have the significance level 0.01 (Šidák); seeds are fixed, so a test
//! that passes once passes always.

mod lights_registry;

use caustica_math::stats::{Moments, sidak, student_t_test};
use caustica_math::{Spectrum, Wavelengths};
use caustica_scene::light::{Anchor, Emission, LightQuery};
use lights_registry::{KINDS, View, examples, kind_of, random};

const SIGNIFICANCE: f64 = 0.01;

fn y(s: Spectrum) -> f64 {
    f64::from(Wavelengths::Rgb.luminance(s))
}

#[test]
fn the_list_holds_every_kind() {
    let all = examples();
    for kind in 0..KINDS {
        assert!(all.iter().any(|e| kind_of(e) == kind), "no lamp of kind {kind} is tested");
    }
}

/// What a sample of emission says of its densities is what is said when asked.
#[test]
fn emission_tells_its_densities() {
    for e in examples() {
        let (query, mut s, mut valid) = (e.query(), random(1), 0);
        for _ in 0..5000 {
            let Some(x) = query.sample_emission(s.next_2d(), s.next_2d(), s.next_2d()) else { continue };
            valid += 1;
            let told = query.emission_pdf(&x.point, x.direction);
            let near = |a: f32, b: f32| (a - b).abs() <= 1e-4 * b;
            assert!(near(x.pdf.point.0, told.point.0), "{}: {:?} {told:?}", e.name, x.pdf);
            assert!(near(x.pdf.direction.0, told.direction.0), "{}: {:?} {told:?}", e.name, x.pdf);
            assert_eq!(x.radiance, query.radiance(&x.point, x.direction), "{}", e.name);
            assert!((x.direction.length() - 1.0).abs() < 1e-5, "{}", e.name);
            assert!((x.cos - x.point.cos(x.direction)).abs() < 1e-6 && x.cos > 0.0, "{}", e.name);
            assert_eq!(x.point.anchor, e.anchor(), "{}", e.name);
        }
        assert!(valid > 0, "{}: no emission", e.name);
    }
}

/// E[radiance·cos/pdf] over emission is the power; and the power by which lamps are chosen is about that.
#[test]
fn emission_carries_the_power() {
    let all = examples();
    let alpha = sidak(SIGNIFICANCE, all.len());
    for e in &all {
        let (query, mut s, mut m) = (e.query(), random(2), Moments::default());
        for _ in 0..60_000 {
            let x = query.sample_emission(s.next_2d(), s.next_2d(), s.next_2d());
            let flux = |x: Emission| {
                y(x.radiance) * f64::from(x.cos) / f64::from(x.pdf.point.0) / f64::from(x.pdf.direction.0)
            };
            m.push(x.map_or(0.0, flux) / e.power);
        }
        let p = student_t_test(&m, 1.0);
        assert!(p > alpha, "{}: {} of its power, p = {p:e}", e.name, m.mean);
        assert!(m.variance_of_mean() < 0.1_f64.powi(2), "{}: the test is blunt", e.name);
        let told = e.scene.lamps().power() / e.power;
        // Textures and daylight are only probed; that is good enough to choose by.
        let probed = ["map", "spark", "textured", "sky", "sun"].iter().any(|probed| e.name.contains(probed));
        let tolerance = if e.name.contains("spark") {
            1.0
        } else if probed {
            0.15
        } else {
            1e-5
        };
        assert!((told - 1.0).abs() < tolerance, "{}: chosen as if it had {told} of its power", e.name);
    }
}

/// One estimate of the irradiance at a place by looking for a lamp. Nothing stands in the way here.
fn towards_irradiance(query: &LightQuery<'_>, v: &View, s: &mut caustica_math::SampleStream) -> f64 {
    let Some(t) = query.sample_towards(v.from, s.next_2d(), s.next_2d()) else { return 0.0 };
    let falloff = match t.point.anchor {
        Anchor::Surface => f64::from(t.point.cos(t.direction)) / f64::from(t.distance).powi(2),
        Anchor::Point => f64::from(t.distance).powi(-2),
        Anchor::Infinite => 1.0,
    };
    y(t.radiance) * f64::from(v.normal.dot(t.direction).max(0.0)) * falloff / f64::from(t.pdf.0)
}

fn irradiance(query: &LightQuery<'_>, v: &View, samples: u32) -> Moments {
    let (mut s, mut m) = (random(3), Moments::default());
    (0..samples).for_each(|_| m.push(towards_irradiance(query, v, &mut s)));
    m
}

/// The irradiance of lamps of all kinds is in the same unit: it is what geometry tells.
#[test]
fn looking_for_a_lamp_finds_its_irradiance() {
    let all = examples();
    let views = || all.iter().flat_map(|e| e.views.iter().map(move |v| (e, v)));
    let known: Vec<_> = views().filter_map(|(e, v)| Some((e, v, v.irradiance?))).collect();
    let alpha = sidak(SIGNIFICANCE, known.len());
    for (e, v, expected) in &known {
        let m = irradiance(&e.query(), v, 40_000);
        if *expected == 0.0 {
            assert_eq!(m.mean, 0.0, "{} at {:?}", e.name, v.from);
            continue;
        }
        let mut relative = Moments::default();
        let mut s = random(4);
        (0..40_000).for_each(|_| relative.push(towards_irradiance(&e.query(), v, &mut s) / expected));
        let p = student_t_test(&relative, 1.0);
        assert!(
            p > alpha,
            "{} at {:?}: {} times what it should be, p = {p:e}",
            e.name,
            v.from,
            relative.mean
        );
        assert!(relative.variance_of_mean() < 0.03_f64.powi(2), "{} at {:?}: blunt", e.name, v.from);
    }
    assert!(known.len() > 20);
}

/// What comes from all lamps together is the sum of what comes from each.
#[test]
fn lamps_add_up() {
    use caustica_scene::description::LightKind;
    use caustica_testkit::build;
    let mut d = build::scene(8);
    let m = build::diffuse(&mut d, 0.0);
    let s = build::sphere(&mut d, [0.0, 0.0, 4.0], 0.5, m);
    build::emit(&mut d, s, 8.0);
    let q = build::quad(&mut d, [-1.0, -1.0, 5.0], [0.0, 2.0, 0.0], [2.0, 0.0, 0.0], m);
    build::emit(&mut d, q, 0.5);
    build::point_light(&mut d, [0.0, 0.0, 2.0], 1.0);
    let grey = caustica_math::Rgb::splat;
    let direction = [0.0, 0.0, -1.0];
    build::light(&mut d, LightKind::Directional { direction, irradiance: grey(0.2) });
    build::light(&mut d, LightKind::Constant { radiance: grey(0.01) });
    let position = [0.0, 0.0, 3.0];
    let (inner_angle, outer_angle) = (10.0, 20.0);
    build::light(
        &mut d,
        LightKind::Spot { position, direction, intensity: grey(2.0), inner_angle, outer_angle },
    );
    let view = View { from: Default::default(), normal: caustica_math::Vec3::Z, irradiance: None };
    let scene = |d| caustica_scene::Scene::new(d).unwrap().0;
    let mut sum = Moments::default();
    let mut parts = (0.0, 0.0);
    for lamp in 0..6 {
        let mut alone = d.clone();
        for (i, shape) in alone.shapes.iter_mut().enumerate() {
            shape.emission = shape.emission.filter(|_| i == lamp);
        }
        alone.lights =
            alone.lights.into_iter().enumerate().filter(|(i, _)| i + 2 == lamp).map(|x| x.1).collect();
        let alone = scene(alone);
        assert_eq!(alone.lamps().len(), 1);
        let m = irradiance(&alone.lights(Wavelengths::Rgb), &view, 40_000);
        parts = (parts.0 + m.mean, parts.1 + m.variance_of_mean());
    }
    let together = scene(d);
    assert_eq!(together.lamps().len(), 6);
    let mut s = random(5);
    for _ in 0..200_000 {
        sum.push(towards_irradiance(&together.lights(Wavelengths::Rgb), &view, &mut s));
    }
    let sigma = (sum.variance_of_mean() + parts.1).sqrt();
    // 2.58 σ is the level 0.01 of this one test.
    assert!((sum.mean - parts.0).abs() < 2.58 * sigma, "{} together, {} one by one", sum.mean, parts.0);
    assert!(sigma < 0.01 * parts.0);
    let power: f64 = together.lamps().power();
    assert!(power.is_finite() && power > 0.0);
}
