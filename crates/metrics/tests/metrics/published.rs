//! Figures of others for pictures that can be made again: ꟻLIP of the evaluator that its authors publish
//! (version 1.7), and relative errors of `benches/peers`. `published.py` prints both tables.

use crate::pictures::{Picture, checks, night, ramps, room};
use caustica_math::Rgb;
use caustica_metrics::flip::{self, Curve, Options};
use caustica_metrics::{errors, relative_error_map};

/// The evaluator reckons in single precision, so that it finds faint edges in flat pictures; the root
/// that ꟻLIP takes of them makes a few millionths of what would be 10⁻⁷. Otherwise means agree to their
/// six digits.
const MEAN_TOLERANCE: f64 = 1e-5;

/// Single pixels agree about as well; their figures have five digits.
const PIXEL_TOLERANCE: f32 = 2e-5;

type Flip = (&'static str, f64, [f32; 3], Option<(f32, f32, u32)>);

/// Mean, the values of three pixels, and first exposure, last exposure and number of exposures.
const FLIP: [Flip; 14] = [
    ("ldr_edges", 0.414124, [0.06235, 0.40063, 0.76483], None),
    ("ldr_ramps", 0.360400, [0.10305, 0.30765, 0.31470], None),
    ("ldr_noise", 0.226724, [0.29485, 0.12967, 0.34558], None),
    ("ldr_faint", 0.016354, [0.07764, 0.01365, 0.03005], None),
    ("ldr_opposite", 0.967388, [0.96739, 0.96739, 0.96739], None),
    ("ldr_near", 0.342334, [0.16701, 0.44142, 0.40577], None),
    ("hdr_noise", 0.434632, [0.42206, 0.37451, 0.43074], Some((-8.9167, 2.9981, 12))),
    ("hdr_fireflies", 0.070642, [0.00000, 0.00993, 0.00301], Some((-8.9167, 2.9981, 12))),
    ("hdr_night", 0.866504, [0.03853, 0.97312, 0.97907], Some((-0.1512, 24.083, 25))),
    ("hdr_same", 0.000000, [0.00000, 0.00000, 0.00000], Some((-8.9167, 2.9981, 12))),
    ("hdr_small", 0.479195, [0.93430, 0.71147, 0.41199], Some((-1.9167, 2.9353, 5))),
    ("hdr_reinhard", 0.426787, [0.59790, 0.36098, 0.40365], Some((-7.4975, 4.4173, 12))),
    ("hdr_hable", 0.358013, [0.54915, 0.30740, 0.36746], Some((-8.3549, 3.5599, 12))),
    ("hdr_given", 0.429917, [0.42257, 0.37455, 0.43085], Some((-2.0, 3.0, 4))),
];

/// relMSE, trimmed relMSE, RMSE, and mean luminance.
const ERRORS: [(&str, [f64; 4]); 9] = [
    ("ldr_edges", [1.222430674e+01, 1.214130526e+01, 2.700308624e-01, 3.121750000e-01]),
    ("ldr_ramps", [1.137875857e-01, 1.122378456e-01, 6.526022962e-02, 4.465250000e-01]),
    ("ldr_noise", [3.975389767e-01, 3.898540612e-01, 1.347347173e-01, 4.940159525e-01]),
    ("ldr_faint", [6.257803184e-04, 6.167750848e-04, 4.511271925e-03, 4.933172136e-01]),
    ("ldr_opposite", [9.900990099e-01, 9.900990099e-01, 1.000000000e+00, 0.000000000e+00]),
    ("hdr_noise", [1.893506226e-02, 1.889659678e-02, 1.371261224e-01, 9.433674619e+00]),
    ("hdr_fireflies", [8.701459166e+04, 6.969623743e+04, 2.909288652e+02, 3.009251159e+01]),
    ("hdr_night", [6.688608983e-01, 6.657855253e-01, 2.731465967e-02, 3.081298542e-01]),
    ("hdr_same", [0.000000000e+00, 0.000000000e+00, 0.000000000e+00, 9.427192702e+00]),
];

/// The picture and the reference of that name.
fn pair(name: &str) -> (Picture, Picture) {
    let (flat, lit, dark) = (ramps(96, 64, 128), room(96, 64, 1024.0), night(96, 64));
    let small = room(37, 23, 8.0);
    let grey = |level: f32| Picture::new(96, 64, |_, _| Rgb::splat(level));
    match name {
        "ldr_edges" => (checks(96, 64, 2), checks(96, 64, 0)),
        "ldr_ramps" => (ramps(96, 64, 8), flat),
        "ldr_noise" => (flat.speckled(0.5, 1).up_to_white(), flat),
        "ldr_faint" => (flat.speckled(1.0 / 64.0, 2).up_to_white(), flat),
        "ldr_opposite" => (grey(0.0), grey(1.0)),
        "ldr_near" => (small.speckled(0.25, 3).up_to_white(), small.up_to_white()),
        "hdr_fireflies" => (lit.with_fireflies(4096.0, 5), lit),
        "hdr_night" => (dark.speckled(0.125, 6), dark),
        "hdr_same" => (lit.clone(), lit),
        "hdr_small" => (small.speckled(0.5, 7), small),
        _ => (lit.speckled(0.5, 4), lit),
    }
}

/// What differs from the defaults.
fn options(name: &str) -> Options {
    let usual = Options::default();
    match name {
        "ldr_near" => Options { pixels_per_degree: 20.0, ..usual },
        "hdr_small" => Options { pixels_per_degree: 40.0, ..usual },
        "hdr_reinhard" => Options { curve: Curve::Reinhard, ..usual },
        "hdr_hable" => Options { curve: Curve::Hable, ..usual },
        "hdr_given" => Options { start: Some(-2.0), stop: Some(3.0), count: Some(4), ..usual },
        _ => usual,
    }
}

#[test]
fn flip_agrees_with_the_published_evaluator() {
    for (name, mean, pixels, exposures) in FLIP {
        let (image, reference) = pair(name);
        let evaluate = if name.starts_with("hdr") { flip::hdr } else { flip::ldr };
        let found = evaluate(image.image(), reference.image(), &options(name)).unwrap();
        assert!((found.mean - mean).abs() < MEAN_TOLERANCE, "{name}: {} instead of {mean}", found.mean);
        let (w, h) = (image.width as usize, image.height as usize);
        for ((x, y), expected) in [(0, 0), (w / 3, h / 2), (w / 2, h / 4 + 3)].into_iter().zip(pixels) {
            let value = found.values[y * w + x];
            let near = (value - expected).abs() < PIXEL_TOLERANCE;
            assert!(near, "{name} at ({x}, {y}): {value} instead of {expected}");
        }
        assert_eq!(found.exposures.is_some(), exposures.is_some(), "{name}");
        if let (Some(found), Some((start, stop, count))) = (found.exposures, exposures) {
            assert!(
                (found.start - start).abs() < 1e-3 && (found.stop - stop).abs() < 1e-3,
                "{name}: {found:?}"
            );
            assert_eq!(found.count, count, "{name}");
        }
    }
}

#[test]
fn relative_errors_agree_with_those_of_the_peers() {
    for (name, expected) in ERRORS {
        let (image, reference) = pair(name);
        let found = errors(image.image(), reference.image()).unwrap();
        let found = [found.rel_mse, found.trimmed_rel_mse, found.rmse, found.mean];
        for (a, b) in found.into_iter().zip(expected) {
            assert!((a - b).abs() <= 1e-9 * b, "{name}: {found:?} instead of {expected:?}");
        }
        let map = relative_error_map(image.image(), reference.image()).unwrap();
        let mean = map.iter().map(|e| f64::from(*e)).sum::<f64>() / map.len() as f64;
        assert!((mean - expected[0]).abs() <= 1e-6 * expected[0], "{name}: the map's mean is {mean}");
    }
}
