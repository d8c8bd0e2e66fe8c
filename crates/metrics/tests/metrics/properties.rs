//! What must hold for any two pictures.

use crate::pictures::{Picture, night, ramps, room};
use caustica_math::Rgb;
use caustica_metrics::flip::{self, Curve, FlipMap, Options};
use caustica_metrics::{Errors, Image, MetricsError, errors, relative_error_map};
use proptest::prelude::*;

fn errors_of(image: &Picture, reference: &Picture) -> Errors {
    errors(image.image(), reference.image()).unwrap()
}

fn ldr_of(image: &Picture, reference: &Picture) -> FlipMap {
    flip::ldr(image.image(), reference.image(), &Options::default()).unwrap()
}

fn hdr_of(image: &Picture, reference: &Picture) -> FlipMap {
    flip::hdr(image.image(), reference.image(), &Options::default()).unwrap()
}

/// Two pictures of the same size, from 1 × 1 up, with light of every order and some that is negative.
fn two_pictures() -> impl Strategy<Value = (Picture, Picture)> {
    let channel =
        prop_oneof![Just(0.0), 0.0..1.0, -0.5..0.5, 0.0..1e4, 0.0..1e-4].prop_map(|c: f64| c as f32);
    let pixel = (channel.clone(), channel.clone(), channel).prop_map(|(r, g, b)| Rgb::new(r, g, b));
    (1_u32..12, 1_u32..12).prop_flat_map(move |(width, height)| {
        let pixels = || prop::collection::vec(pixel.clone(), (width * height) as usize);
        (pixels(), pixels()).prop_map(move |(a, b)| {
            let of = |pixels| Picture { width, height, pixels };
            (of(a), of(b))
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(64) })]

    #[test]
    fn differences_seen_are_from_0_to_1((image, reference) in two_pictures()) {
        for map in [ldr_of(&image, &reference), flip::hdr(image.image(), reference.image(), &Options {
            start: Some(-3.0), stop: Some(3.0), ..Options::default()
        }).unwrap()] {
            prop_assert!(map.values.iter().all(|v| (0.0..=1.0).contains(v)), "{:?}", map.values);
            prop_assert!((0.0..=1.0).contains(&map.mean));
        }
    }

    #[test]
    fn a_picture_does_not_differ_from_itself((image, _) in two_pictures()) {
        let found = errors_of(&image, &image);
        prop_assert_eq!((found.rel_mse, found.trimmed_rel_mse, found.rmse), (0.0, 0.0, 0.0));
        prop_assert_eq!(ldr_of(&image, &image).mean, 0.0);
        match flip::hdr(image.image(), image.image(), &Options::default()) {
            Ok(map) => prop_assert_eq!(map.mean, 0.0),
            Err(error) => prop_assert_eq!(error, MetricsError::BlackReference),
        }
    }

    #[test]
    fn the_trimmed_error_is_never_greater((image, reference) in two_pictures()) {
        let found = errors_of(&image, &reference);
        prop_assert!(found.trimmed_rel_mse <= found.rel_mse * (1.0 + 1e-12));
    }
}

#[test]
fn relative_errors_do_not_depend_on_the_unit() {
    let (image, reference) = (room(60, 50, 40.0).speckled(0.5, 1), room(60, 50, 40.0));
    let (small, large) = (errors_of(&image, &reference), {
        let scaled = |p: &Picture| p.map(|c| c * 1024.0);
        errors_of(&scaled(&image), &scaled(&reference))
    });
    assert_eq!((small.rel_mse, small.trimmed_rel_mse), (large.rel_mse, large.trimmed_rel_mse));
    assert_eq!((small.rmse * 1024.0, small.mean * 1024.0), (large.rmse, large.mean));
}

#[test]
fn a_tenth_more_is_an_error_of_a_hundredth() {
    let flat = |v| Picture::new(10, 10, |_, _| Rgb::splat(v));
    let found = errors_of(&flat(2.25), &flat(2.0));
    assert!((found.rel_mse - 0.125 * 0.125 / 1.01).abs() < 1e-15, "{found:?}");
    assert!(found.rmse == 0.25 && (found.mean - 2.25).abs() < 1e-14, "{found:?}");
}

#[test]
fn the_worst_pixels_are_left_out() {
    let reference = ramps(50, 50, 25);
    let mut image = reference.clone();
    // Of 2500 pixels the 2.5 worst are left out: rounded to even, 2.
    for (wrong, trimmed_is_zero) in [(1, true), (2, true), (3, false)] {
        image.pixels[wrong * 400] = Rgb::splat(1e6);
        let found = errors_of(&image, &reference);
        assert!(
            found.rel_mse > 1e6 && (found.trimmed_rel_mse == 0.0) == trimmed_is_zero,
            "{wrong}: {found:?}"
        );
    }
}

#[test]
fn pixels_that_are_not_finite_do_not_hide() {
    let reference = ramps(50, 50, 25);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut image = reference.clone();
        image.pixels[1275] = Rgb::new(0.0, bad, 0.0);
        let found = errors_of(&image, &reference);
        assert_eq!((found.rel_mse, found.rmse, found.not_finite), (f64::INFINITY, f64::INFINITY, 1));
        assert_eq!(found.trimmed_rel_mse, 0.0);
        assert!((found.mean - errors_of(&reference, &reference).mean).abs() < 1e-3, "{found:?}");
        assert_eq!(relative_error_map(image.image(), reference.image()).unwrap()[1275], f32::INFINITY);
        let mut hole = image.clone();
        hole.pixels[1275] = Rgb::BLACK;
        for seen in [ldr_of, hdr_of] {
            // As wrong as can be, and black to its neighbours.
            let mut expected = seen(&hole, &reference).values;
            expected[1275] = 1.0;
            assert_eq!(seen(&image, &reference).values, expected);
        }
        assert!(matches!(
            errors(reference.image(), image.image()),
            Err(MetricsError::BadReference { x: 25, y: 25 })
        ));
    }
    let nothing = reference.map(|_| f32::NAN);
    let found = errors_of(&nothing, &reference);
    assert_eq!((found.trimmed_rel_mse, found.mean, found.not_finite), (f64::INFINITY, 0.0, 2500));
    assert_eq!(ldr_of(&nothing, &reference).mean, 1.0);
}

#[test]
fn a_black_reference() {
    let black = Picture::new(8, 8, |_, _| Rgb::BLACK);
    let mut spot = black.clone();
    spot.pixels[9] = Rgb::new(0.0, 1.0, 0.0);
    assert_eq!(errors_of(&black, &black).rel_mse, 0.0);
    assert_eq!(errors_of(&spot, &black).rel_mse, f64::INFINITY);
    let seen = |options| flip::hdr(spot.image(), black.image(), &options);
    assert_eq!(seen(Options::default()).unwrap_err(), MetricsError::BlackReference);
    let given = Options { start: Some(0.0), stop: Some(0.0), count: Some(1), ..Options::default() };
    assert!(seen(given).unwrap().mean > 0.0);
}

#[test]
fn bad_options_and_sizes_are_told() {
    let (wide, high) = (ramps(8, 4, 4), ramps(4, 8, 4));
    let sizes = MetricsError::Sizes { image: (8, 4), reference: (4, 8) };
    let usual = Options::default();
    assert_eq!(errors(wide.image(), high.image()).unwrap_err(), sizes);
    assert_eq!(relative_error_map(wide.image(), high.image()).unwrap_err(), sizes);
    assert_eq!(flip::ldr(wide.image(), high.image(), &usual).unwrap_err(), sizes);
    assert_eq!(flip::hdr(wide.image(), high.image(), &usual).unwrap_err(), sizes);
    assert!(sizes.to_string().contains("8×4") && sizes.to_string().contains("4×8"), "{sizes}");
    let dense = Options { pixels_per_degree: 1e6, ..usual };
    assert_eq!(
        flip::ldr(wide.image(), wide.image(), &dense).unwrap_err(),
        MetricsError::PixelsPerDegree(1e6)
    );
    let turned = Options { start: Some(2.0), stop: Some(-2.0), ..usual };
    let error = flip::hdr(wide.image(), wide.image(), &turned).unwrap_err();
    assert!(error.to_string().contains("from 2 to -2 stops"), "{error}");
}

#[test]
fn hdr_of_one_exposure_is_ldr_of_what_is_shown() {
    // Reinhard's curve of a grey c is c / (1 + c), so that c / (1 − c) is shown as c.
    let (image, reference) =
        (Picture::new(40, 30, |x, _| Rgb::splat(x as f32 / 64.0)), ramps(40, 30, 32).map(|_| 0.25));
    let bright = |p: &Picture| p.map(|c| c / (1.0 - c));
    let once = Options {
        curve: Curve::Reinhard,
        start: Some(0.0),
        stop: Some(0.0),
        count: Some(1),
        ..Options::default()
    };
    let hdr = flip::hdr(bright(&image).image(), bright(&reference).image(), &once).unwrap();
    let ldr = ldr_of(&image, &reference);
    assert!(hdr.values.iter().zip(&ldr.values).all(|(a, b)| (a - b).abs() < 1e-4));
    assert!(ldr.mean > 0.1);
}

#[test]
fn only_hdr_minds_which_is_the_reference() {
    let (a, b) = (room(48, 32, 16.0).speckled(0.5, 2), night(48, 32));
    assert_eq!(ldr_of(&a, &b), ldr_of(&b, &a));
    assert_ne!(hdr_of(&a, &b).exposures, hdr_of(&b, &a).exposures);
}

#[test]
fn negative_light_counts_as_none() {
    let reference = room(48, 32, 16.0);
    let dark =
        Picture::new(48, 32, |x, y| if x < y { Rgb::BLACK } else { reference.pixels[(y * 48 + x) as usize] });
    let negative = dark.map(|c| if c == 0.0 { -3.0 } else { c });
    assert_eq!(ldr_of(&negative, &reference), ldr_of(&dark, &reference));
    assert_eq!(hdr_of(&negative, &reference), hdr_of(&dark, &reference));
    assert!(errors_of(&negative, &reference).rel_mse > errors_of(&dark, &reference).rel_mse);
}

#[test]
fn more_noise_is_seen_more() {
    let reference = room(96, 64, 16.0);
    let seen =
        [1.0 / 64.0, 1.0 / 16.0, 0.25].map(|amount| hdr_of(&reference.speckled(amount, 9), &reference).mean);
    assert!(seen[0] > 0.0 && seen.is_sorted(), "{seen:?}");
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let (image, reference) = (night(96, 64).speckled(0.125, 6), night(96, 64));
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| (hdr_of(&image, &reference), errors_of(&image, &reference)))
    };
    let one = on(1);
    assert!(one == on(2) && one == on(5));
}

#[test]
fn results_can_be_written() {
    let (image, reference) = (ramps(2, 1, 2), ramps(2, 1, 1));
    let found = serde_json::to_value(errors_of(&image, &reference)).unwrap();
    assert!(found["rel_mse"].is_f64() && found["not_finite"] == 0, "{found}");
    let map = serde_json::to_value(hdr_of(&image, &reference)).unwrap();
    assert!(map["mean"].is_f64() && map["exposures"]["count"].is_u64(), "{map}");
}

#[test]
fn a_wrong_number_of_pixels_is_told() {
    let error = Image::new(3, 3, &[Rgb::WHITE; 8]).unwrap_err();
    assert_eq!(error.to_string(), "a picture of 3 × 3 pixels cannot be made of 8 pixels");
}
