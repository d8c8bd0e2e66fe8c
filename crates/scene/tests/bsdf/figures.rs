//! The figures that Nori's own tests of BSDFs hold, and robustness against all that can be asked.

use crate::registry::{WALKS, examples, next_3d, random, random_direction};
use caustica_math::stats::{Moments, sidak, student_t_test};
use caustica_math::{ONE_BELOW, Spectrum, Vec3, Wavelengths};
use caustica_scene::bsdf::{Bsdf, Dielectric, Microfacet, Walk};

/// A BSDF with its mean sample weight (of radiance, by luminance) at some angles of the camera in degrees.
struct Figures {
    bsdf: Bsdf,
    means: &'static [(f64, f64)],
}

/// F + (1 − F)·(n_camera/n_light)².
const GLASS_IN_AIR: &[(f64, f64)] = &[
    (0.0, 0.466_874),
    (15.0, 0.466_918),
    (30.0, 0.467_719),
    (45.0, 0.472_557),
    (60.0, 0.494_179),
    (75.0, 0.585_174),
    (105.0, 1.0),
    (120.0, 1.0),
    (135.0, 1.0),
    (150.0, 2.179_947),
    (165.0, 2.198_289),
    (180.0, 2.198_87),
];
const AIR_IN_DENSE_GLASS: &[(f64, f64)] = &[
    (0.0, 2.761_597),
    (15.0, 2.759_731),
    (30.0, 2.677_264),
    (45.0, 1.0),
    (60.0, 1.0),
    (75.0, 1.0),
    (105.0, 0.530_846),
    (120.0, 0.424_841),
    (135.0, 0.397_763),
    (150.0, 0.391_295),
    (165.0, 0.390_177),
    (180.0, 0.390_113),
];
const PLASTIC: &[(f64, f64)] =
    &[(0.0, 0.207_084), (45.0, 0.215_892), (60.0, 0.247_775), (80.0, 0.430_824), (85.0, 0.519_006)];

fn figures() -> [Figures; 3] {
    let air = 1.000_277;
    let glass = Bsdf::Dielectric(Dielectric::new(1.5, air));
    let inverse = Bsdf::Dielectric(Dielectric::new(air, 1.7));
    let plastic = Bsdf::Microfacet(Microfacet::new(Spectrum([0.1, 0.2, 0.15, 0.0]), 0.1, 1.5, air));
    [
        Figures { bsdf: glass, means: GLASS_IN_AIR },
        Figures { bsdf: inverse, means: AIR_IN_DENSE_GLASS },
        Figures { bsdf: plastic, means: PLASTIC },
    ]
}

/// A direction in the plane of x and z, as in Nori.
fn in_plane(degrees: f64) -> Vec3 {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    Vec3::new(sin as f32, 0.0, cos as f32)
}

fn luminance_weight(bsdf: &Bsdf, given: Vec3, u: [f32; 3]) -> f64 {
    let weight = |s: caustica_scene::bsdf::Scattered| s.value / s.pdf.get();
    let sample = bsdf.sample(Walk::FromCamera, given, u);
    sample.map_or(0.0, |s| f64::from(Wavelengths::Rgb.luminance(weight(s))))
}

/// Nori's `ttest`: 100 000 samples, two-sided, with the significance level 0.01 over the figures of one BSDF.
#[test]
fn mean_weights_pass_noris_t_test() {
    for Figures { bsdf, means } in figures() {
        let level = sidak(0.01, means.len());
        for &(degrees, reference) in means {
            let mut stream = random(9);
            let mut moments = Moments::default();
            (0..100_000).for_each(|_| {
                moments.push(luminance_weight(&bsdf, in_plane(degrees), next_3d(&mut stream)));
            });
            let p = student_t_test(&moments, reference);
            assert!(p > level, "{bsdf:?} at {degrees}°: {} is not {reference} (p = {p:e})", moments.mean);
        }
    }
}

/// A dielectric has two lobes, so that the mean over them is exact.
#[test]
fn dielectrics_match_the_figures_to_every_digit() {
    for Figures { bsdf, means } in figures() {
        if !bsdf.is_delta() {
            continue;
        }
        for &(degrees, reference) in means {
            let given = in_plane(degrees);
            let lobe = |u| bsdf.sample(Walk::FromCamera, given, [0.5, 0.5, u]);
            let reflected = lobe(0.0).filter(|s| s.direction.z * given.z > 0.0);
            let refracted = lobe(ONE_BELOW).filter(|s| s.direction.z * given.z < 0.0);
            // Probability times value/pdf is the value.
            let mean: f32 = [reflected, refracted].into_iter().flatten().map(|s| s.value[0]).sum();
            assert!((f64::from(mean) - reference).abs() < 3e-6, "{bsdf:?} at {degrees}°: {mean}");
        }
    }
}

/// Directions at which careless formulas divide by zero: normal, grazing, on the horizon, opposite.
fn awkward_directions() -> Vec<Vec3> {
    let mut all = vec![];
    for z in [0.0_f32, -0.0, 1e-45, 1e-38, 1e-20, 1e-7, 1e-4, 0.745_355_9, 1.0 - 1e-7, 1.0] {
        let r = (1.0 - z * z).max(0.0).sqrt();
        for sign in [1.0, -1.0] {
            all.extend([
                Vec3::new(r, 0.0, sign * z),
                Vec3::new(-r, 0.0, sign * z),
                Vec3::new(0.6 * r, -0.8 * r, sign * z),
            ]);
        }
    }
    all
}

fn check_sample(bsdf: &Bsdf, walk: Walk, given: Vec3, u: [f32; 3]) {
    let Some(s) = bsdf.sample(walk, given, u) else { return };
    let pdfs = [s.pdf.get(), s.reverse_pdf.get()];
    let sound = s.value.is_valid()
        && s.direction.is_finite()
        && (s.direction.length() - 1.0).abs() < 1e-4
        && s.direction.z != 0.0
        && pdfs[0] > 0.0
        && pdfs.iter().all(|p| p.is_finite() && *p >= 0.0)
        && (s.value / pdfs[0]).is_valid();
    assert!(sound, "{bsdf:?} {walk:?} given {given:?} with {u:?}: {s:?}");
}

fn check_eval(bsdf: &Bsdf, to_light: Vec3, to_camera: Vec3) {
    let e = bsdf.eval(to_light, to_camera);
    let pdfs = [e.to_light_pdf.get(), e.to_camera_pdf.get()];
    let sound = e.value.is_valid() && pdfs.iter().all(|p| p.is_finite() && *p >= 0.0);
    assert!(sound, "{bsdf:?} {to_light:?} {to_camera:?}: {e:?}");
}

/// Nothing is ever NaN, infinite or negative: not at awkward directions and corners of the unit cube, in all
/// combinations, and not in a million random calls.
#[test]
fn everything_is_finite() {
    let awkward = awkward_directions();
    let corners = [0.0, 1e-7, 0.5, ONE_BELOW];
    let examples = examples();
    let per_example = 1_000_000 / (4 * examples.len());
    for bsdf in examples.iter().map(|e| &e.bsdf) {
        for given in &awkward {
            awkward.iter().for_each(|other| check_eval(bsdf, *given, *other));
            for i in 0..64 {
                let u = [corners[i % 4], corners[i / 4 % 4], corners[i / 16]];
                WALKS.iter().for_each(|walk| check_sample(bsdf, *walk, *given, u));
            }
        }
        let mut stream = random(10);
        for _ in 0..per_example {
            let (a, b) = (random_direction(&mut stream), random_direction(&mut stream));
            check_eval(bsdf, a, b);
            // The mirrored and the opposite direction are where the lobes are.
            check_eval(bsdf, a, Vec3::new(-a.x, -a.y, a.z));
            check_eval(bsdf, a, -a);
            WALKS.iter().for_each(|walk| check_sample(bsdf, *walk, a, next_3d(&mut stream)));
        }
    }
}
