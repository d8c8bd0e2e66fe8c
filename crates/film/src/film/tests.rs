use caustica_math::Filter;
use caustica_math::stream::{SampleStream, StreamId};
use proptest::prelude::*;
use rayon::prelude::*;

use super::*;
use crate::layout::Window;

fn layout(window: Window) -> FilmLayout {
    FilmLayout { width: 40, height: 30, window, quantum_exponent: -30 }
}

fn whole() -> FilmLayout {
    layout(Window { x: 0, y: 0, width: 40, height: 30 })
}

fn gaussian() -> PixelFilter {
    PixelFilter::new(&Filter::default())
}

fn stream(sample: u32) -> SampleStream {
    SampleStream::new(StreamId { seed: 3, pixel: 0, sample, walk: 0 })
}

/// Contribution number `i` to both layers, with values over sixteen orders of magnitude and signs.
fn contribute(film: &Film, filter: &PixelFilter, i: u32) {
    let mut s = stream(i);
    let [x, y] = s.next_2d();
    let position = Vec2::new(x * 40.0, y * 30.0);
    let size = 10f32.powi((s.next_1d() * 16.0) as i32 - 10);
    let value = Rgb::new(s.next_1d(), s.next_1d() - 0.5, s.next_1d()) * size;
    film.add_eye([position.x as u32, position.y as u32], value);
    film.splat_light(filter, position, value);
}

fn filled(range: impl Iterator<Item = u32>) -> Film {
    let (film, filter) = (Film::new(whole()).unwrap(), gaussian());
    range.for_each(|i| contribute(&film, &filter, i));
    film.finish_samples(1, 2);
    film
}

#[test]
fn order_and_threads_do_not_matter() {
    let forwards = filled(0..20_000);
    assert!(forwards.sums().any(|s| s[0] != 0) && forwards.sums().any(|s| s[4] < 0));
    assert!(filled((0..20_000).rev()).bits_equal(&forwards));
    for threads in [2, 7] {
        let (film, filter) = (Film::new(whole()).unwrap(), gaussian());
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| (0..20_000u32).into_par_iter().for_each(|i| contribute(&film, &filter, i)));
        film.finish_samples(1, 2);
        assert!(film.bits_equal(&forwards));
        assert_eq!(film.fingerprint(), forwards.fingerprint());
    }
    assert!(!filled(0..19_999).bits_equal(&forwards));
    assert_ne!(filled(0..19_999).fingerprint(), forwards.fingerprint());
}

#[test]
fn grouping_of_merges_does_not_matter() {
    let parts = || [0..500, 500..501, 501..3000].map(filled);
    let [a, b, c] = parts();
    a.merge(&b).unwrap();
    a.merge(&c).unwrap();
    let [d, e, f] = parts();
    f.merge(&e).unwrap();
    f.merge(&d).unwrap();
    assert!(a.bits_equal(&f));
    assert_eq!((a.eye_samples(), a.light_samples()), (3, 6));
    assert!(a.sums().eq(filled(0..3000).sums()));
    let other = Film::new(FilmLayout { quantum_exponent: -31, ..whole() }).unwrap();
    assert!(matches!(a.merge(&other), Err(FilmError::Layout(_))));
}

#[test]
fn sums_and_counts_restore_a_film() {
    let film = filled(0..1000);
    film.add_eye([0, 0], Rgb::splat(f32::NAN));
    let sums: Vec<_> = film.sums().collect();
    let restored = Film::restore(whole(), &sums, film.counts()).unwrap();
    assert!(restored.bits_equal(&film));
    assert!(Film::restore(whole(), &sums[1..], film.counts()).is_err());
}

#[test]
fn a_crop_holds_the_bits_of_the_whole() {
    let window = Window { x: 11, y: 5, width: 17, height: 9 };
    let (all, crop, filter) = (Film::new(whole()).unwrap(), Film::new(layout(window)).unwrap(), gaussian());
    for i in 0..5000 {
        contribute(&all, &filter, i);
        contribute(&crop, &filter, i);
    }
    let whole_sums: Vec<_> = all.sums().collect();
    for (i, sums) in crop.sums().enumerate() {
        let (x, y) = (11 + i % 17, 5 + i / 17);
        assert_eq!(sums, whole_sums[y * 40 + x], "at ({x}, {y})");
    }
}

/// The sum over the pixels of one splat. A discretised filter is no exact partition of unity: for the
/// default Gaussian the sum depends on the position by 3 in 100, and only its mean is exact.
#[test]
fn splats_carry_their_energy() {
    for filter in [
        Filter::default(),
        Filter::Gaussian { radius: 3.0, stddev: 0.75 },
        Filter::Box { radius: 0.5 },
        Filter::Tent { radius: 1.0 },
        Filter::Mitchell { radius: 2.0, b: 1.0 / 3.0, c: 1.0 / 3.0 },
    ] {
        let prepared = PixelFilter::new(&filter);
        let n = 50;
        let (mut mean, mut worst) = (0.0, 0.0f64);
        for k in 0..n * n {
            let film = Film::new(whole()).unwrap();
            let offset = |i: i32| (i as f32 + 0.5) / n as f32;
            let position = Vec2::new(20.0 + offset(k % n), 15.0 + offset(k / n));
            film.splat_light(&prepared, position, Rgb::splat(2.0));
            film.finish_samples(0, 1);
            let sum: f64 = film.develop().light.iter().map(|p| f64::from(p.0[1])).sum();
            mean += sum / f64::from(n * n);
            worst = worst.max((sum - 2.0).abs());
        }
        let tolerance = match filter {
            Filter::Gaussian { stddev, .. } if stddev < 0.75 => 0.06,
            Filter::Gaussian { .. } => 1e-3,
            _ => 1e-5,
        };
        assert!(worst < tolerance, "{filter:?}: {worst}");
        assert!((mean - 2.0).abs() < 1e-5, "{filter:?}: {mean}");
    }
}

#[test]
fn splats_beside_the_window_reach_into_it() {
    let window = Window { x: 10, y: 10, width: 4, height: 4 };
    let (film, filter) = (Film::new(layout(window)).unwrap(), gaussian());
    film.splat_light(&filter, Vec2::new(9.2, 11.5), Rgb::WHITE);
    film.finish_samples(0, 1);
    let light = film.develop().light;
    let expected = filter.eval(10.5 - 9.2, 0.0);
    assert!(expected > 1e-3 && (light[4].0[0] - expected).abs() < 1e-6);
    assert_eq!(light[6], Rgb::BLACK);

    let far = Film::new(layout(window)).unwrap();
    for p in [[8.4, 11.5], [15.6, 11.5], [11.5, 8.4], [11.5, 15.6], [-1e30, 11.5], [11.5, 1e30]] {
        far.splat_light(&filter, Vec2::new(p[0], p[1]), Rgb::WHITE);
    }
    assert!(far.sums().all(|s| s == [0; 6]));
    assert_eq!(far.invalid(), 0);
}

#[test]
fn what_is_not_finite_is_counted_and_skipped() {
    let (film, filter) = (Film::new(whole()).unwrap(), gaussian());
    film.add_eye([1, 1], Rgb::new(0.0, f32::NAN, 1.0));
    film.add_eye([1, 1], Rgb::new(f32::INFINITY, 0.0, 1.0));
    film.splat_light(&filter, Vec2::new(3.0, 3.0), Rgb::new(0.0, 0.0, f32::NEG_INFINITY));
    film.splat_light(&filter, Vec2::new(f32::NAN, 3.0), Rgb::WHITE);
    film.splat_light(&filter, Vec2::new(3.0, f32::INFINITY), Rgb::WHITE);
    assert_eq!((film.invalid(), film.clamped()), (5, 0));
    assert!(film.sums().all(|s| s == [0; 6]));
    film.add_eye([1, 1], Rgb::splat(1e30));
    assert_eq!((film.invalid(), film.clamped()), (5, 1));
}

#[test]
fn layers_are_divided_by_their_own_counts() {
    let film = Film::new(whole()).unwrap();
    let pixel = PixelFilter::new(&Filter::Box { radius: 0.5 });
    film.add_eye([3, 2], Rgb::new(1.0, 2.0, 4.0));
    film.add_eye([40, 2], Rgb::WHITE);
    film.splat_light(&pixel, Vec2::new(3.0, 2.999), Rgb::splat(6.0));
    assert_eq!(film.develop().eye[83], Rgb::BLACK);
    film.finish_samples(4, 3);
    let picture = film.develop();
    assert_eq!(picture.eye[83], Rgb::new(0.25, 0.5, 1.0));
    assert_eq!(picture.light[83], Rgb::splat(2.0));
    let black = |pixels: &[Rgb]| pixels.iter().filter(|p| **p == Rgb::BLACK).count();
    assert_eq!((black(&picture.eye), black(&picture.light)), (1199, 1199));
}

#[test]
fn impossible_sizes_are_refused() {
    let window = |x, y, width, height| Window { x, y, width, height };
    for bad in [window(0, 0, 0, 1), window(30, 0, 11, 1), window(0, 29, 1, 2), window(u32::MAX, 0, 2, 2)] {
        assert!(matches!(Film::new(layout(bad)), Err(FilmError::Layout(_))), "{bad:?}");
    }
    assert!(Film::new(FilmLayout { quantum_exponent: 2000, ..whole() }).is_err());
    let side = 1 << 23;
    let huge =
        FilmLayout { width: side, height: side, window: window(0, 0, side, side), quantum_exponent: 0 };
    let error = Film::new(huge).unwrap_err().to_string();
    assert!(error.contains("8388608 × 8388608") && error.contains("3377699721 MB"), "{error}");
}

#[test]
fn full_hd_fits_into_250_megabytes() {
    assert!(size_of::<Sums>() * 1920 * 1080 < 250_000_000);
    assert_eq!(size_of::<Sums>(), 48);
}

proptest! {
    /// A splat adds to each pixel what the definition says, wherever it falls.
    #[test]
    fn splats_follow_their_definition(x in -3.0f32..10.0, y in -3.0f32..10.0, radius in 0.3f32..2.6) {
        let window = Window { x: 2, y: 1, width: 5, height: 6 };
        let film = Film::new(layout(window)).unwrap();
        let filter = PixelFilter::new(&Filter::Mitchell { radius, b: 0.0, c: 0.5 });
        film.splat_light(&filter, Vec2::new(x, y), Rgb::WHITE);
        film.finish_samples(0, 1);
        for (i, pixel) in film.develop().light.iter().enumerate() {
            let (px, py) = (2.5 + (i % 5) as f32, 1.5 + (i / 5) as f32);
            let expected = filter.eval(px - x, py - y);
            prop_assert!((pixel.0[0] - expected).abs() < 1e-6, "{} for {expected}", pixel.0[0]);
        }
    }
}

/// Found by fuzzing random scenes: sums of bright splats wrapped around, and pixels came out negative.
#[test]
fn sums_beyond_64_bits_stay_at_the_largest_number() {
    let (filter, huge) = (PixelFilter::new(&Filter::Box { radius: 0.5 }), Rgb::splat(1e30));
    let bright = || {
        let film = Film::new(whole()).unwrap();
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    let mut buffer = film.light_buffer().unwrap();
                    for _ in 0..50 {
                        film.add_eye([3, 4], huge);
                        film.splat_light(&filter, Vec2::new(5.5, 6.5), huge);
                        film.splat_into(&mut buffer, &filter, Vec2::new(7.5, 8.5), huge);
                    }
                    film.flush(&mut buffer);
                });
            }
        });
        film.finish_samples(1, 1);
        film
    };
    let (film, other) = (bright(), bright());
    assert!(film.bits_equal(&other));
    film.merge(&other).unwrap();
    let sums: Vec<i64> = film.sums().flatten().filter(|sum| *sum != 0).collect();
    assert_eq!(sums, [i64::MAX; 9]);
    let picture = film.develop();
    assert!(picture.eye.iter().chain(&picture.light).all(|p| p.is_valid()));
}

/// With negative contributions (of a filter such as Mitchell's), sums can go beyond 64 bits and come back: in any order,
/// grouping and through files they are the same.
#[test]
fn sums_beyond_64_bits_depend_on_no_order() {
    let filter = PixelFilter::new(&Filter::Box { radius: 0.5 });
    let (huge, small) = (Rgb::splat(1e30), Rgb::splat(3.0));
    // In turn: up, up, …, down, down, … and both mixed; the last few decide.
    let up = [huge; 21];
    let down = [huge * -1.0; 18];
    let mixed = up.iter().zip(&down).flat_map(|(a, b)| [*a, *b]).chain([huge, huge, huge]);
    let orders: [Vec<Rgb>; 3] =
        [[&up[..], &down[..]].concat(), [&down[..], &up[..]].concat(), mixed.collect()];
    let films = orders.map(|order| {
        let film = Film::new(whole()).unwrap();
        let mut buffer = film.light_buffer().unwrap();
        for value in order.into_iter().chain([small]) {
            film.add_eye([3, 4], value);
            film.splat_light(&filter, Vec2::new(5.5, 6.5), value);
            film.splat_into(&mut buffer, &filter, Vec2::new(7.5, 8.5), value);
        }
        film.flush(&mut buffer);
        film
    });
    let parts = || {
        let (a, b) = (Film::new(whole()).unwrap(), Film::new(whole()).unwrap());
        for (film, values) in [(&a, &up[..]), (&b, &down[..]), (&b, &[small][..])] {
            for value in values {
                film.add_eye([3, 4], *value);
                film.splat_light(&filter, Vec2::new(5.5, 6.5), *value);
                film.splat_light(&filter, Vec2::new(7.5, 8.5), *value);
            }
        }
        (a, b)
    };
    let ((ab, b), (a, ba)) = (parts(), parts());
    assert!(ab.sums().flatten().filter(|s| *s == i64::MAX).count() == 9);
    assert!(b.sums().flatten().filter(|s| *s == i64::MIN).count() == 9);
    ab.merge(&b).unwrap();
    ba.merge(&a).unwrap();
    for film in films[1..].iter().chain([&ab, &ba]) {
        assert!(films[0].sums().eq(film.sums()));
        assert!(films[0].bits_equal(film) && films[0].fingerprint() == film.fingerprint());
    }
    // Three times the largest contribution, and a little.
    let three = films[0].sums().flatten().find(|s| *s != 0).unwrap();
    assert!(three > 3 << 61 && three < (3 << 61) + (1 << 60), "{three}");
}
