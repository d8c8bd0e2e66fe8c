use super::*;
use crate::stats::{Moments, chi_square_test, student_t_test};
use crate::stream::{SampleStream, StreamId};

const GAUSSIAN: Filter = Filter::Gaussian { radius: 2.0, stddev: 0.5 };
const MITCHELL: Filter = Filter::Mitchell { radius: 2.0, b: 1.0 / 3.0, c: 1.0 / 3.0 };

const LANCZOS: Filter = Filter::Lanczos { lobes: 3 };

const ALL: [Filter; 10] = [
    Filter::Box { radius: 0.5 },
    Filter::Box { radius: 1.3 },
    Filter::Tent { radius: 1.0 },
    GAUSSIAN,
    Filter::Gaussian { radius: 1.5, stddev: 30.0 },
    Filter::Gaussian { radius: 3.0, stddev: 0.02 },
    MITCHELL,
    Filter::Mitchell { radius: 3.0, b: 0.0, c: 0.75 },
    LANCZOS,
    Filter::Lanczos { lobes: 1 },
];

fn stream(seed: u64) -> SampleStream {
    SampleStream::new(StreamId { seed, pixel: 0, sample: 0, walk: 0 })
}

/// The integral of `f` over [−radius, radius] by the midpoint rule.
fn integrate(radius: f32, mut f: impl FnMut(f32) -> f64) -> f64 {
    let n = 400_000;
    let step = 2.0 * f64::from(radius) / f64::from(n);
    (0..n).map(|i| f((step * (f64::from(i) + 0.5)) as f32 - radius)).sum::<f64>() * step
}

#[test]
fn every_filter_is_normalised() {
    for filter in ALL {
        let prepared = PixelFilter::new(&filter);
        let integral = integrate(filter.radius(), |x| f64::from(prepared.eval_axis(x)));
        assert!((integral - 1.0).abs() < 1e-5, "{filter:?}: {integral}");
        let (x, y) = (0.3, -0.7);
        assert_eq!(prepared.eval(x, y), prepared.eval_axis(x) * prepared.eval_axis(y));
        assert_eq!(prepared.eval_axis(filter.radius() * 1.001), 0.0);
        assert_eq!(filter.eval1d(-filter.radius() * 1.001), 0.0);
    }
}

#[test]
fn the_table_follows_the_formula() {
    for filter in ALL {
        let prepared = PixelFilter::new(&filter);
        let norm = integrate(filter.radius(), |x| f64::from(filter.eval1d(x)));
        let peak = f64::from(filter.eval1d(0.0)) / norm;
        for i in 0..20_000 {
            let x = filter.radius() * (i as f32 - 9_999.5) / 10_000.0;
            let error = f64::from(prepared.eval_axis(x)) - f64::from(filter.eval1d(x)) / norm;
            assert!(error.abs() < 1e-4 * peak, "{filter:?} at {x}: {error}");
        }
    }
}

#[test]
fn textbook_values() {
    let lowered = libm::exp(-0.5) - libm::exp(-8.0);
    assert!((f64::from(GAUSSIAN.eval1d(0.5)) - lowered).abs() < 1e-7);
    assert!((MITCHELL.eval1d(0.0) - 8.0 / 9.0).abs() < 1e-6);
    assert!((MITCHELL.eval1d(1.0) - 1.0 / 18.0).abs() < 1e-6);
    assert!(MITCHELL.eval1d(1.5) < -0.02 && GAUSSIAN.eval1d(2.0) == 0.0 && MITCHELL.eval1d(2.0) == 0.0);
    let wide = Filter::Mitchell { radius: 4.0, b: 1.0 / 3.0, c: 1.0 / 3.0 };
    assert_eq!(wide.eval1d(2.0), MITCHELL.eval1d(1.0));
    assert_eq!(Filter::Tent { radius: 2.0 }.eval1d(-0.5), 0.75);
    // sin(π/2)/(π/2)·sin(π/6)/(π/6) = 6/π².
    assert!((LANCZOS.eval1d(0.5) - 0.607_927_1).abs() < 1e-6 && LANCZOS.eval1d(0.0) == 1.0);
    assert!(LANCZOS.eval1d(1.0).abs() < 1e-7 && LANCZOS.eval1d(1.5) < -0.13 && LANCZOS.eval1d(2.5) > 0.02);
}

/// 400 cells in two dimensions against integrals of |filter|.
#[test]
fn samples_follow_the_magnitude() {
    let (n, cells) = (400_000, 20usize);
    for (k, filter) in ALL.into_iter().enumerate() {
        let (prepared, mut s) = (PixelFilter::new(&filter), stream(17 + k as u64));
        let radius = filter.radius();
        let mut counts = vec![0.0; cells * cells];
        let cell = |x: f32| (((x / radius + 1.0) * 0.5 * cells as f32) as usize).min(cells - 1);
        for _ in 0..n {
            let (p, _) = prepared.sample(s.next_2d());
            assert!(p.x.abs() <= radius && p.y.abs() <= radius);
            counts[cell(p.y) * cells + cell(p.x)] += 1.0;
        }
        let mut axis = vec![0.0; cells];
        integrate(radius, |x| {
            axis[cell(x)] += f64::from(prepared.eval_axis(x).abs());
            0.0
        });
        let total: f64 = axis.iter().sum();
        let expected: Vec<f64> = (0..cells * cells)
            .map(|i| axis[i / cells] * axis[i % cells] * f64::from(n) / (total * total))
            .collect();
        let outcome = chi_square_test(&counts, &expected, 5.0, f64::from(n));
        assert!(outcome.p_value > 1e-3, "{filter:?}: {outcome:?}");
    }
}

/// E[weight·g] = ∫∫ f g for a few g.
#[test]
fn weighted_samples_integrate_the_filter() {
    for (k, filter) in ALL.into_iter().enumerate() {
        let (prepared, mut s) = (PixelFilter::new(&filter), stream(91 + k as u64));
        let r = filter.radius();
        let square = |x: f32| f64::from(x / r) * f64::from(x / r);
        let mut moments = [Moments::default(); 4];
        for _ in 0..200_000 {
            let (p, w) = prepared.sample(s.next_2d());
            let w = f64::from(w);
            moments[0].push(w);
            moments[1].push(w * f64::from(p.x / r));
            moments[2].push(w * square(p.y));
            moments[3].push(w * square(p.x) * square(p.y));
        }
        let second = integrate(r, |x| square(x) * f64::from(prepared.eval_axis(x)));
        for (m, reference) in moments.iter().zip([1.0, 0.0, second, second * second]) {
            assert!(student_t_test(m, reference) > 1e-4, "{filter:?}: {} for {reference}", m.mean);
        }
    }
}

#[test]
fn weights_have_one_magnitude_and_the_filters_sign() {
    for filter in ALL {
        let (prepared, mut s) = (PixelFilter::new(&filter), stream(5));
        let magnitude = integrate(filter.radius(), |x| f64::from(prepared.eval_axis(x).abs()));
        let mut negative = 0;
        for _ in 0..20_000 {
            let (p, w) = prepared.sample(s.next_2d());
            assert!((f64::from(w.abs()) - magnitude * magnitude).abs() < 1e-4, "{filter:?}: {w}");
            let density = prepared.eval(p.x, p.y);
            // Within rounding of a zero of the filter either sign will do.
            assert!(density * w > 0.0 || density.abs() < 1e-3, "{filter:?} at {p:?}");
            negative += u32::from(w < 0.0);
            if !filter.has_lobes() {
                assert_eq!(w, 1.0);
            }
        }
        // One lobe of Lanczos' is the middle one.
        let lobes = filter.has_lobes() && filter != Filter::Lanczos { lobes: 1 };
        assert_eq!(negative > 0, lobes, "{filter:?}");
    }
}

/// Within a cell, too small for statistics: the magnitude's integral up to the answer is what was asked.
#[test]
fn cells_are_inverted_exactly() {
    for (a, b) in [(1.0, 1.0), (0.0, 2.0), (2.0, 0.0), (1.0, 3.0), (-1.0, -0.5), (1.0, -0.5), (-0.2, 0.6)] {
        for i in 0..=20 {
            let mass = cell_magnitude(a, b) * f64::from(i) / 20.0;
            let (t, sign) = invert_cell(a, b, mass);
            let at = a + (b - a) * t;
            let integral = t * cell_magnitude(a, at);
            assert!((integral - mass).abs() < 1e-12, "{a} to {b}: {integral} for {mass}");
            assert!(f64::from(sign) * at > -1e-7, "{a} to {b} at {t}: {sign}");
        }
    }
    assert_eq!(invert_cell(0.0, 0.0, 0.0), (0.0, 1.0));
}

#[test]
fn the_box_passes_samples_through() {
    let pixel = PixelFilter::new(&Filter::Box { radius: 0.5 });
    for u in [0.0, 1e-7, 0.25, 0.3, 0.5, crate::ONE_BELOW] {
        assert_eq!(pixel.sample([u, 0.5]), (Vec2::new(u - 0.5, 0.0), 1.0));
    }
}

#[test]
fn boxes_are_partitions_of_unity() {
    for radius in [0.5, 1.0, 1.5] {
        let prepared = PixelFilter::new(&Filter::Box { radius });
        for position in [3.0, 3.25, 3.5, 3.999_999_8, 2.999_999_8, 1e-10] {
            let sum: f32 = (-3..9).map(|i| prepared.eval_axis(i as f32 + 0.5 - position)).sum();
            assert!((sum - 1.0).abs() < 1e-6, "radius {radius}, position {position}: {sum}");
        }
    }
}

#[test]
fn impossible_filters_become_the_pixel() {
    let pixel = PixelFilter::new(&Filter::Box { radius: 0.5 });
    for filter in [
        Filter::Box { radius: 0.0 },
        Filter::Box { radius: f32::INFINITY },
        Filter::Tent { radius: f32::NAN },
        Filter::Gaussian { radius: 2.0, stddev: 0.0 },
        Filter::Gaussian { radius: f32::INFINITY, stddev: 1.0 },
        Filter::Mitchell { radius: -1.0, b: 0.3, c: 0.3 },
        Filter::Lanczos { lobes: 0 },
    ] {
        assert_eq!(PixelFilter::new(&filter), pixel, "{filter:?}");
    }
}

/// Found by fuzzing random scenes: lobes so large that the weight of a sample overflowed.
#[test]
fn lobes_that_cancel_give_the_pixel_itself() {
    let pixel = PixelFilter::new(&Filter::Box { radius: 0.5 });
    for (b, c) in [(1e30, 0.3), (-1e30, 0.3), (0.3, 1e38), (1e6, 1.0), (f32::NAN, 0.0)] {
        assert_eq!(PixelFilter::new(&Filter::Mitchell { radius: 2.0, b, c }), pixel, "{b}, {c}");
    }
    assert_ne!(PixelFilter::new(&Filter::Mitchell { radius: 2.0, b: 30.0, c: -30.0 }), pixel);
}
