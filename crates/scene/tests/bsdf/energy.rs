//! White furnaces: no surface gives back more light than falls on it, and what should be lossless loses no more
//! than the light that would meet a second microfacet.
//!
//! Together the tests of each function have the significance level 0.01 (Šidák); seeds are fixed.

use std::f64::consts::PI;

use crate::registry::{
    ALPHAS, Example, INDICES, WALKS, at_angle, examples, given_directions, metal, next_3d, plastic, random,
};
use caustica_math::stats::{Moments, sidak, student_t_test, welch_t_test};
use caustica_math::{Spectrum, Vec3, warp};
use caustica_scene::bsdf::{Bsdf, Dielectric, Facets, PlasticColours, RoughConductor, RoughDielectric, Walk};

/// The share of a beam's power that a sample carries away, by the lane of green. A beam from the light at `given`
/// scatters f·cos(camera)/pdf of its power; by reciprocity, without the n² of radiance, so does the walk from
/// the camera.
fn share(example: &Example, walk: Walk, given: Vec3, u: [f32; 3]) -> f64 {
    let Some(s) = example.bsdf.sample(walk, given, u) else { return 0.0 };
    let weight = f64::from(s.value[1]) / f64::from(s.pdf.get());
    match walk {
        Walk::FromCamera => weight * f64::from(example.ior(s.direction) / example.ior(given)).powi(2),
        Walk::FromLight => weight * f64::from((s.direction.z / given.z).abs()),
    }
}

fn albedo(example: &Example, walk: Walk, given: Vec3, samples: u32) -> Moments {
    let mut stream = random(4 + walk as u32);
    let mut moments = Moments::default();
    (0..samples).for_each(|_| moments.push(share(example, walk, given, next_3d(&mut stream))));
    moments
}

/// No furnace is brighter than its walls, and it is the same furnace whichever way it is walked.
#[test]
fn energy_is_not_created() {
    let examples = examples();
    let cases: Vec<_> =
        examples.iter().flat_map(|e| given_directions(&e.bsdf).into_iter().map(move |g| (e, g))).collect();
    let level = sidak(0.01, cases.len());
    for (example, given) in cases {
        let [camera, light] = WALKS.map(|walk| albedo(example, walk, given, 8_000));
        let name = format!("{} at cos = {}: {} {}", example.name, given.z, camera.mean, light.mean);
        for m in [camera, light] {
            // Principled surfaces add up what their lobes reflect, and that may be a little more than there is.
            let principled = matches!(example.bsdf, Bsdf::Principled(_) | Bsdf::PrincipledThin(_));
            let most = if principled { 1.25 } else { 1.0 };
            assert!(m.mean <= most + 4.0 * m.variance_of_mean().sqrt() + 1e-5, "{name}");
        }
        let p = welch_t_test(&camera, &light, 1e-12);
        assert!(p > level, "{name}: p = {p:e}");
    }
}

/// Importance sampling finds all the light that blind integration of `eval` finds.
#[test]
fn sampling_integrates_eval() {
    let examples = examples();
    // Blind integration finds no narrow lobes.
    let narrow = |e: &&Example| ["0.02", "0.1"].iter().any(|alpha| e.name.contains(alpha));
    let wide = examples.iter().filter(|e| !e.bsdf.is_delta() && !narrow(e));
    let cases: Vec<_> =
        wide.flat_map(|e| given_directions(&e.bsdf).into_iter().map(move |g| (e, g))).collect();
    assert!(cases.len() > 40);
    let level = sidak(0.01, cases.len());
    for (example, given) in cases {
        let mut sampled = Moments::default();
        let mut stream = random(4);
        for _ in 0..20_000 {
            // A Dirac lobe is nothing to `eval`.
            let u = next_3d(&mut stream);
            let dirac = example.bsdf.sample(Walk::FromCamera, given, u).is_some_and(|s| s.delta);
            sampled.push(if dirac { 0.0 } else { share(example, Walk::FromCamera, given, u) });
        }
        let mut stream = random(6);
        let mut blind = Moments::default();
        for _ in 0..40_000 {
            let v = warp::uniform_sphere(stream.next_2d());
            let scale = f64::from(example.ior(v) / example.ior(given)).powi(2);
            blind.push(f64::from(example.bsdf.eval(v, given).value[1]) * 4.0 * PI * scale);
        }
        let p = welch_t_test(&sampled, &blind, 1e-12);
        assert!(p > level, "{} at {}: {} is not {}", example.name, given.z, sampled.mean, blind.mean);
    }
}

/// Smooth lossless surfaces lose nothing, and a diffuse one exactly its absorption, with each sample.
#[test]
fn smooth_surfaces_are_exact() {
    for example in examples() {
        let expected = match example.bsdf {
            Bsdf::Dielectric(_) | Bsdf::ThinDielectric(_) | Bsdf::Null => 1.0,
            Bsdf::Diffuse(d) => f64::from(d.albedo[1]),
            Bsdf::Mirror { reflectance } => f64::from(reflectance[1]),
            _ => continue,
        };
        let mut stream = random(5);
        for given in given_directions(&example.bsdf) {
            for _ in 0..100 {
                let u = next_3d(&mut stream);
                let from_camera = share(&example, Walk::FromCamera, given, u);
                assert!((from_camera - expected).abs() < 1e-5, "{}: {from_camera}", example.name);
                // From the light a diffuse surface's shares vary: cosines are sampled, not shares.
                let from_light = share(&example, Walk::FromLight, given, u);
                assert!(
                    (from_light - expected).abs() < 1e-4 || matches!(example.bsdf, Bsdf::Diffuse(_)),
                    "{}: {from_light}",
                    example.name
                );
            }
        }
    }
}

/// White plastic gives back all light if what is reflected on the way out is coloured again, and so does any
/// plastic of a white base; a coat of index n lets (1 − F)·n⁻² out again, and 1 − r is as much of all.
#[test]
fn white_plastic_loses_nothing() {
    let level = sidak(0.01, 4 * 2 * 2);
    for eta in [1.3, 1.49, 1.9, 0.8] {
        for nonlinear in [false, true] {
            let colours = PlasticColours { diffuse: Spectrum::ONE, specular: Spectrum::ONE, nonlinear };
            let example = plastic(eta, colours);
            for given in [20.0, 75.0].map(at_angle) {
                let kept = albedo(&example, Walk::FromCamera, given, 100_000);
                let p = student_t_test(&kept, 1.0);
                assert!(p > level, "{eta} {nonlinear}: {} at {} (p = {p:e})", kept.mean, given.z);
            }
        }
    }
}

/// What a single scattering keeps at least, by the roughness, at all angles up to 62°. (Measured for metal and
/// glass: 0.9978, 0.954, 0.760 and 0.430.)
const KEPT: [f64; ALPHAS.len()] = [0.997, 0.95, 0.75, 0.42];

/// Rough lossless surfaces lose what would meet a second microfacet, and no sample of theirs gains.
#[test]
fn rough_surfaces_lose_what_meets_a_second_microfacet() {
    for (alpha, least) in ALPHAS.into_iter().zip(KEPT) {
        let glass = INDICES
            .map(|(i, e)| {
                (
                    Bsdf::RoughDielectric(RoughDielectric::new(Facets::ggx(alpha), Dielectric::new(i, e))),
                    (i, e),
                )
            })
            .into_iter();
        for (bsdf, indices) in glass.chain([(white_metal(alpha), (1.0, 1.0))]) {
            let example = Example { name: format!("{bsdf:?}"), bsdf, indices };
            for given in given_directions(&bsdf) {
                let mut stream = random(8);
                let mut kept = Moments::default();
                for _ in 0..10_000 {
                    let share = share(&example, Walk::FromCamera, given, next_3d(&mut stream));
                    assert!(share <= 1.0 + 1e-3, "{}: {share}", example.name);
                    kept.push(share);
                }
                let grazing = given.z.abs() < 0.1;
                assert!(kept.mean > least || grazing, "{}: {} at {}", example.name, kept.mean, given.z);
            }
        }
    }
}

fn white_metal(alpha: f32) -> Bsdf {
    Bsdf::RoughConductor(RoughConductor::new(metal("none", Spectrum::ONE), Facets::ggx(alpha)))
}

/// At normal incidence a perfect mirror of GGX keeps ∫₀¹ α²/(α² + t)²·G₁(2θ) dt with t = tan² θ of the microfacet:
/// its normals have the density D·cos, and it is shadowed but not masked.
#[test]
fn rough_mirrors_keep_the_analytic_share() {
    let level = sidak(0.01, ALPHAS.len());
    for alpha in ALPHAS {
        let a2 = f64::from(alpha).powi(2);
        let n = 1_000_000;
        let integrand = |t: f64| {
            let shadowing = 2.0 / (1.0 + (1.0 + 4.0 * a2 * t / (1.0 - t).powi(2)).sqrt());
            a2 / (a2 + t).powi(2) * shadowing
        };
        let exact =
            (0..n).map(|i| integrand((f64::from(i) + 0.5) / f64::from(n))).sum::<f64>() / f64::from(n);
        let example = Example { name: String::new(), bsdf: white_metal(alpha), indices: (1.0, 1.0) };
        let kept = albedo(&example, Walk::FromCamera, Vec3::Z, 100_000);
        let p = student_t_test(&kept, exact);
        assert!(p > level, "α = {alpha}: {} is not {exact} (p = {p:e})", kept.mean);
    }
}
