//! Identities that hold for each pair of directions: between sampling and evaluating, between the two walks,
//! and between rough surfaces and smooth ones.

use crate::registry::{
    Example, INDICES, WALKS, at_angle, close, examples, given_directions, metal, next_3d, random,
    random_direction,
};
use caustica_math::{ONE_BELOW, Spectrum, Vec3};
use caustica_scene::bsdf::{
    Bsdf, Conductor, Dielectric, Evaluated, Facets, Plastic, PlasticColours, RoughCoat, RoughConductor,
    RoughDielectric, RoughPlastic, Scattered, SmoothCoat, Walk,
};
use caustica_scene::description::{Distribution, Shadowing};

/// The evaluated pair, with the two densities in the order of the walk.
fn evaluate(bsdf: &Bsdf, walk: Walk, given: Vec3, sampled: Vec3) -> (Evaluated, f32, f32) {
    match walk {
        Walk::FromCamera => {
            let e = bsdf.eval(sampled, given);
            (e, e.to_light_pdf.get(), e.to_camera_pdf.get())
        }
        Walk::FromLight => {
            let e = bsdf.eval(given, sampled);
            (e, e.to_camera_pdf.get(), e.to_light_pdf.get())
        }
    }
}

/// What a sample tells is what `eval` tells of its directions; and no smooth sample comes from a BSDF that
/// says that all of it is Dirac.
#[test]
fn samples_agree_with_eval() {
    for example in examples() {
        for walk in WALKS {
            let mut stream = random(1);
            for _ in 0..5_000 {
                let given = random_direction(&mut stream);
                let Some(s) = example.bsdf.sample(walk, given, next_3d(&mut stream)) else { continue };
                assert!(
                    s.delta == example.bsdf.is_delta() || example.bsdf.is_partly_delta(),
                    "{}",
                    example.name
                );
                assert!((s.direction.length() - 1.0).abs() < 1e-5, "{}: {:?}", example.name, s.direction);
                let transmitted = given.z * s.direction.z < 0.0;
                assert!(!transmitted || example.bsdf.transmits(), "{}", example.name);
                let (e, pdf, reverse) = evaluate(&example.bsdf, walk, given, s.direction);
                if example.bsdf.is_delta() {
                    assert!(e.value.is_black() && pdf == 0.0 && reverse == 0.0, "{}", example.name);
                } else if !s.delta {
                    let same = (e.value, pdf, reverse) == (s.value, s.pdf.get(), s.reverse_pdf.get());
                    assert!(same, "{} {walk:?}: {e:?} is not {s:?}", example.name);
                }
            }
        }
    }
}

/// Helmholtz's reciprocity, with the n² that radiance carries through refraction: f(l → c)/n_c² = f(c → l)/n_l².
/// The densities depend on which direction is given, not on which of them the light is.
#[test]
fn light_can_be_turned_around() {
    for example in examples() {
        let mut stream = random(2);
        let (mut tried, mut lit) = (0, 0);
        while tried < 5_000 {
            let (l, c) = (random_direction(&mut stream), random_direction(&mut stream));
            let (there, back) = (example.bsdf.eval(l, c), example.bsdf.eval(c, l));
            let radiance = |e: Evaluated, l: Vec3, c: Vec3| e.value / (l.z.abs() * example.ior(c).powi(2));
            let (a, b) = (radiance(there, l, c), radiance(back, c, l));
            for lane in 0..4 {
                assert!(close(a[lane], b[lane], 2e-3), "{}: {l:?} {c:?}: {a:?} {b:?}", example.name);
            }
            assert!(close(there.to_light_pdf.get(), back.to_camera_pdf.get(), 2e-3), "{}", example.name);
            assert!(close(there.to_camera_pdf.get(), back.to_light_pdf.get(), 2e-3), "{}", example.name);
            tried += 1;
            lit += usize::from(!a.is_black());
        }
        // Beckmann's distribution has no tails: most of a narrow one's values are too small for a number.
        let few = if example.name.contains("0.02") { 5 } else { 500 };
        assert!(example.bsdf.is_delta() || lit > few, "{}: only {lit} pairs are lit", example.name);
    }
}

/// The two lobes of a Dirac BSDF, reflection first.
fn lobes(bsdf: &Bsdf, walk: Walk, given: Vec3) -> Vec<Scattered> {
    let mut found: Vec<Scattered> = vec![];
    for u in [0.0, ONE_BELOW] {
        let s = bsdf.sample(walk, given, [0.5, 0.5, u]).filter(|s| s.delta);
        let known = |s: &Scattered| found.iter().any(|f| f.direction == s.direction);
        found.extend(s.filter(|s| !known(s)));
    }
    found
}

/// A walk from the camera and one from the light know the same Dirac lobe by different solid angles, whose
/// ratio is dω_c/dω_l = n_l²·|cos l|/(n_c²·|cos c|).
#[test]
fn dirac_lobes_are_the_same_for_both_walks() {
    for example in examples().iter().filter(|e| e.bsdf.is_delta() || e.bsdf.is_partly_delta()) {
        for c in given_directions(&example.bsdf) {
            for from_camera in lobes(&example.bsdf, Walk::FromCamera, c) {
                let l = from_camera.direction;
                let back = lobes(&example.bsdf, Walk::FromLight, l);
                let from_light =
                    back.iter().find(|b| (b.direction - c).length() < 2e-3).expect("the way back");
                let reflected = l.z * c.z > 0.0;
                let ratio = example.ior(l).powi(2) * l.z.abs() / (example.ior(c).powi(2) * c.z.abs());
                let spread = if reflected { 1.0 } else { ratio };
                check_lobe(example, &from_camera, from_light, spread);
            }
        }
    }
}

/// `spread` is dω_c/dω_l.
fn check_lobe(example: &Example, from_camera: &Scattered, from_light: &Scattered, spread: f32) {
    let pairs = [
        ("value", from_light.value[1], from_camera.value[1] * spread),
        ("pdf from the light", from_light.pdf.get(), from_camera.reverse_pdf.get() * spread),
        ("pdf from the camera", from_camera.pdf.get(), from_light.reverse_pdf.get() / spread),
    ];
    for (what, a, b) in pairs {
        assert!(close(a, b, 1e-3), "{}: {what}: {a} is not {b}", example.name);
    }
}

/// Refraction bends by Snell's law and has the weights of radiance and of flux.
#[test]
fn refraction_by_the_book() {
    let glass = Bsdf::Dielectric(Dielectric::new(1.5, 1.0));
    let given = at_angle(30.0);
    let refract = |walk| glass.sample(walk, given, [0.5, 0.5, ONE_BELOW]).unwrap();
    let s = refract(Walk::FromCamera);
    assert!((s.direction - Vec3::new(-given.x / 1.5, -given.y / 1.5, -0.942_809)).length() < 1e-5);
    assert!(close(s.value[0] / s.pdf.get(), 1.0 / 2.25, 1e-5));
    let flux = refract(Walk::FromLight);
    assert!(close(flux.value[0] / flux.pdf.get(), given.z / 0.942_809, 1e-5));
}

/// Where the indices are the same, light goes straight through, however rough.
#[test]
fn matched_indices_are_nothing() {
    for bsdf in [
        Bsdf::Dielectric(Dielectric::new(1.4, 1.4)),
        Bsdf::RoughDielectric(RoughDielectric::new(Facets::ggx(0.3), Dielectric::new(1.4, 1.4))),
        Bsdf::RoughDielectric(RoughDielectric::new(Facets::ggx(0.3), Dielectric::new(1.400_01, 1.4))),
    ] {
        assert!(bsdf.is_delta() && bsdf.transmits());
        for walk in WALKS {
            for given in given_directions(&bsdf) {
                let s = bsdf.sample(walk, given, [0.3, 0.6, 0.0]).unwrap();
                assert!((s.direction + given).length() < 1e-6 && s.delta);
                assert!(s.value == Spectrum::ONE && s.pdf.get() == 1.0 && s.reverse_pdf.get() == 1.0);
                assert!(bsdf.eval(s.direction, given).value.is_black());
            }
        }
    }
}

/// As α → 0, samples of a rough surface approach the smooth one: in direction, in weight, and in the ratio of
/// the two densities.
#[test]
fn rough_surfaces_become_smooth() {
    let gold = metal("Au", Spectrum([0.9, 0.5, 0.2, 0.0]));
    let mut pairs = vec![];
    for facets in [Facets::ggx(5e-4), Facets::new(Distribution::Beckmann, Shadowing::Separable, [5e-4, 1e-3])]
    {
        let rough = Bsdf::RoughConductor(RoughConductor::new(gold, facets));
        pairs.push((Bsdf::Conductor(gold), rough, [60.0, 10.0]));
        for (interior_ior, exterior_ior) in INDICES {
            let (reflectance, transmittance) =
                (Spectrum([0.7, 0.8, 0.9, 0.0]), Spectrum([0.9, 0.7, 0.8, 0.0]));
            let smooth = Dielectric { interior_ior, exterior_ior, reflectance, transmittance };
            let rough = Bsdf::RoughDielectric(RoughDielectric::new(facets, smooth));
            // Below the critical angle on each side.
            pairs.push((Bsdf::Dielectric(smooth), rough, [40.0, 20.0]));
            pairs.push((Bsdf::Dielectric(smooth), rough, [165.0, 145.0]));
        }
    }
    for (smooth, rough, angles) in pairs {
        for given in angles.map(at_angle) {
            for walk in WALKS {
                let mut stream = random(3);
                for _ in 0..500 {
                    check_limit(&smooth, &rough, walk, (given, next_3d(&mut stream)));
                }
            }
        }
    }
}

fn check_limit(smooth: &Bsdf, rough: &Bsdf, walk: Walk, (given, u): (Vec3, [f32; 3])) {
    let Some(r) = rough.sample(walk, given, u) else { return };
    // Where the microfacet is turned far, in the long tail of GGX, nothing is small.
    let Some(s) =
        lobes(smooth, walk, given).into_iter().find(|s| (s.direction - r.direction).length() < 0.02)
    else {
        assert!(u[1] > 0.98, "{rough:?} {given:?}: {r:?} is far from all lobes");
        return;
    };
    let weight = |s: &Scattered| s.value * (1.0 / s.pdf.get());
    for lane in 0..4 {
        assert!(close(weight(&s)[lane], weight(&r)[lane], 0.05), "{rough:?} {walk:?}: {s:?} {r:?}");
    }
    let ratio = |s: &Scattered| s.reverse_pdf.get() / s.pdf.get();
    assert!(close(ratio(&s), ratio(&r), 0.1), "{rough:?} {walk:?}: densities of {s:?} {r:?}");
}

/// As α → 0, what a rough plastic scatters apart from its highlight is what a smooth one does.
#[test]
fn rough_plastic_becomes_smooth() {
    let (diffuse, specular) = (Spectrum([0.1, 0.5, 0.9, 0.0]), Spectrum::ONE);
    for nonlinear in [false, true] {
        let colours = PlasticColours { diffuse, specular, nonlinear };
        let smooth = Plastic::new(SmoothCoat::new(1.5), colours);
        for distribution in [Distribution::Ggx, Distribution::Beckmann] {
            let rough = RoughPlastic::new(&RoughCoat::new(distribution, 1e-3, 1.5), colours);
            for (l, c) in [(20.0, 50.0), (70.0, 35.0), (10.0, 80.0)] {
                let [s, r] = [Bsdf::Plastic(smooth), Bsdf::RoughPlastic(rough)]
                    .map(|b| b.eval(at_angle(l), at_angle(c)));
                for lane in 0..3 {
                    // The sum that stands for the internal reflectance is less by a part of 1/64.
                    let ratio = r.value[lane] / s.value[lane];
                    assert!((0.97..1.005).contains(&ratio), "{distribution:?} {l} {c}: {ratio}");
                }
                assert!(close(r.to_light_pdf.get(), s.to_light_pdf.get(), 0.01), "{l} {c}: {r:?} {s:?}");
            }
        }
    }
}

/// A rough mirror keeps the colour of its metal: at α → 0 the weight is reflectance·F.
#[test]
fn mirrors_have_their_reflectance() {
    let reflectance = Spectrum([0.9, 0.5, 0.2, 0.0]);
    let perfect = Conductor { eta: Spectrum::ZERO, k: Spectrum::ONE, reflectance };
    for bsdf in [Bsdf::Mirror { reflectance }, Bsdf::Conductor(perfect)] {
        let s = bsdf.sample(Walk::FromCamera, at_angle(70.0), [0.5; 3]).unwrap();
        assert!((0..4).all(|i| close(s.value[i], reflectance[i], 1e-5)));
        assert!(bsdf.sample(Walk::FromCamera, at_angle(110.0), [0.5; 3]).is_none());
    }
}
