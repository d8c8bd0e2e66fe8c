use super::*;
use crate::stats::chi_square_test;
use crate::stream::{SampleStream, Sampler};

/// Of each test here that asks for a probability.
const SIGNIFICANCE: f64 = 1e-4;

fn point(seed: u64, pixel: [u32; 2], sample: u32, slot: u64) -> [u32; 2] {
    Strata::new(SampleId { seed, pixel, sample }, 0).point(slot)
}

fn unit(bits: u32) -> f64 {
    f64::from(bits) / 4_294_967_296.0
}

/// Whether every elementary interval of 2^−m holds as many of the points as the others, m being log₂ of their number.
fn is_net(points: &[[u32; 2]]) -> bool {
    let m = points.len().trailing_zeros();
    assert_eq!(1 << m, points.len());
    (0..=m).all(|a| {
        let mut seen = vec![false; points.len()];
        points.iter().all(|[x, y]| {
            let cell = u64::from(*x) >> (32 - a) << (m - a) | u64::from(*y) >> (32 - (m - a));
            !std::mem::replace(&mut seen[cell as usize], true)
        })
    })
}

/// Slots of all members of several groups, one of them far out.
fn slots() -> impl Iterator<Item = u64> {
    [0, 1, 2, 3, 4, 5, 6, 7, 4_000_000_001].into_iter()
}

#[test]
fn aligned_ranges_of_a_pixel_are_nets() {
    for slot in slots() {
        for (pixel, seed) in [([0, 0], 0), ([3, 250], 1), ([65_535, 65_535], 2)] {
            for m in 0..=12 {
                for block in [0, 1, 5, 16, 0x000f_ffff >> m, u32::MAX >> m] {
                    let points: Vec<_> =
                        (0..1 << m).map(|i| point(seed, pixel, block << m | i, slot)).collect();
                    assert!(is_net(&points), "slot {slot}, pixel {pixel:?}, block {block} of 2^{m}");
                }
            }
        }
    }
}

#[test]
fn squares_of_pixels_are_nets_at_every_power_of_two_of_samples() {
    for slot in slots() {
        for j in 0..=4u32 {
            for k in 0..=6 {
                for ([x, y], block) in [([0, 0], 0), ([7, 2], 1), ([1, 5], 10)] {
                    let mut points = Vec::new();
                    for pixel in 0..1u32 << (2 * j) {
                        let pixel = [(x << j) + pixel % (1 << j), (y << j) + (pixel >> j)];
                        points.extend((0..1 << k).map(|i| point(4, pixel, block << k | i, slot)));
                    }
                    assert!(is_net(&points), "slot {slot}, 2^{j} pixels at {x}, {y}, block {block} of 2^{k}");
                }
            }
        }
    }
    // A whole tile.
    let tile: Vec<_> = (0..65_536).map(|i| point(4, [256 + i % 256, 512 + i / 256], 0, 0)).collect();
    assert!(is_net(&tile));
}

/// The t of the samples of two members of a group as a net in four dimensions.
fn quality(slots: [u64; 2], m: u32) -> u32 {
    let points: Vec<[u32; 4]> = (0..1 << m)
        .map(|i| {
            let [[a, b], [c, d]] = slots.map(|slot| point(9, [17, 4], i, slot));
            [a, b, c, d]
        })
        .collect();
    let even = |cells: u32| {
        (0..=cells).all(|a| {
            (0..=cells - a).all(|b| {
                (0..=cells - a - b).all(|c| {
                    let bits = [a, b, c, cells - a - b - c];
                    let mut counts = vec![0u32; 1 << cells];
                    for p in &points {
                        let cell =
                            p.iter().zip(bits).fold(0, |cell, (x, n)| cell << n | u64::from(*x) >> (32 - n));
                        counts[cell as usize] += 1;
                    }
                    counts.iter().all(|n| *n == 1 << (m - cells))
                })
            })
        })
    };
    (0..=m).find(|t| even(m - t)).unwrap_or(m)
}

/// Any two slots of a group are stratified in their four dimensions. (Sobol's first four have t = 3 in the long run.)
#[test]
fn slots_of_a_group_are_stratified_together() {
    let worst = |m| {
        let pairs = (4..8).flat_map(|a| (4..a).map(move |b| [a, b]));
        pairs.map(|pair| quality(pair, m)).max()
    };
    let found: Vec<_> = (2..=10).map(worst).collect();
    assert_eq!(found, [1, 2, 2, 2, 2, 3, 3, 4, 4].map(Some));
}

fn p_value(counts: &[f64]) -> f64 {
    let samples: f64 = counts.iter().sum();
    let expected = vec![samples / counts.len() as f64; counts.len()];
    chi_square_test(counts, &expected, 5.0, samples).p_value
}

/// χ² of pairs of numbers over 16 × 16 cells.
fn joint(n: u32, draw: impl Fn(u32) -> [u32; 2]) -> f64 {
    let mut counts = vec![0.0; 256];
    for i in 0..n {
        let [a, b] = draw(i);
        counts[(a >> 28 << 4 | b >> 28) as usize] += 1.0;
    }
    p_value(&counts)
}

#[test]
fn every_point_is_uniform_over_seeds() {
    for (pixel, sample) in [([0, 0], 0), ([0, 0], 1), ([200, 131], 77), ([40_000, 3], 1 << 20)] {
        for slot in slots() {
            let p = joint(50_000, |seed| point(u64::from(seed), pixel, sample, slot));
            assert!(p > SIGNIFICANCE, "{pixel:?}, sample {sample}, slot {slot}: {p}");
            // Finer digits.
            let p = joint(50_000, |seed| point(u64::from(seed), pixel, sample, slot).map(|x| x << 12));
            assert!(p > SIGNIFICANCE, "{pixel:?}, sample {sample}, slot {slot}, low bits: {p}");
        }
    }
}

/// What is not meant to be stratified together is independent: over seeds at one place, and over the pixels of a
/// picture and the samples of a pixel at one seed. (Those two move in blocks, so that their counts vary more than
/// independent ones; but what hangs together is far off.)
#[test]
fn slots_walks_seeds_and_far_pixels_are_independent() {
    let first = |seed: u32, pixel: [u32; 2], sample: u32, walk: u32, slot: u64| {
        Strata::new(SampleId { seed: u64::from(seed), pixel, sample }, walk).point(slot)[0]
    };
    let check = |name: &str, a: &dyn Fn(u32) -> u32, b: &dyn Fn(u32) -> u32| {
        let p = joint(1 << 16, |i| [a(i), b(i)]);
        let in_blocks = !name.starts_with("seeds");
        assert!(p > if in_blocks { 1e-12 } else { SIGNIFICANCE }, "{name}: {p}");
    };
    let at = |i: u32| [i % 256, i / 256];
    for other in [1, 2, 3, 4, 5, 11, 1 << 33] {
        check("seeds, slots", &|i| first(i, [5, 6], 3, 0, 0), &|i| first(i, [5, 6], 3, 0, other));
        check("pixels, slots", &|i| first(1, at(i), 3, 0, 0), &|i| first(1, at(i), 3, 0, other));
        if other >= GROUP {
            check("samples, slots", &|i| first(1, [9, 8], i, 0, 0), &|i| first(1, [9, 8], i, 0, other));
        }
    }
    check("seeds, walks", &|i| first(i, [5, 6], 3, 0, 4), &|i| first(i, [5, 6], 3, 1, 4));
    check("pixels, walks", &|i| first(1, at(i), 3, 0, 4), &|i| first(1, at(i), 3, 1, 4));
    check("samples, walks", &|i| first(1, [9, 8], i, 0, 4), &|i| first(1, [9, 8], i, 1, 4));
    check("seeds, next seeds", &|i| first(2 * i, [5, 6], 3, 0, 4), &|i| first(2 * i + 1, [5, 6], 3, 0, 4));
    check("pixels, next seeds", &|i| first(1, at(i), 3, 0, 4), &|i| first(2, at(i), 3, 0, 4));
    check("samples, next seeds", &|i| first(1, [9, 8], i, 0, 4), &|i| first(2, [9, 8], i, 0, 4));
    check("tiles", &|i| first(1, at(i), 3, 0, 4), &|i| first(1, [i % 256 + 256, i / 256], 3, 0, 4));
    check("tiles below", &|i| first(1, at(i), 3, 0, 4), &|i| first(1, [i % 256, i / 256 + 256], 3, 0, 4));
    check("samples, tiles", &|i| first(1, [9, 8], i, 0, 4), &|i| first(1, [265, 8], i, 0, 4));
}

/// The whole sequences of pixels of a large picture differ, tile by tile and within a tile.
#[test]
fn no_two_pixels_share_a_stream() {
    let mut seen = std::collections::HashSet::new();
    for y in (0..65_536).step_by(251) {
        for x in (0..65_536).step_by(253) {
            let s = Strata::new(SampleId { seed: 0, pixel: [x, y], sample: 0 }, 0);
            assert!(seen.insert((s.key, s.pixel)), "{x}, {y}");
        }
    }
    let tile =
        (0..65_536).map(|i| Strata::new(SampleId { seed: 0, pixel: [i % 256, i / 256], sample: 0 }, 0));
    assert_eq!(tile.map(|s| s.pixel).collect::<std::collections::HashSet<_>>().len(), 65_536);
}

/// A smooth function whose integral is one.
fn smooth([x, y]: [u32; 2]) -> f64 {
    let (x, y) = (unit(x), unit(y));
    (0.5 + x) * (0.25 + 2.25 * y * y)
}

/// The mean square error of the mean of [`smooth`] over what `points` gives for each of `trials`.
fn error(trials: u32, points: impl Fn(u32) -> Vec<[u32; 2]>) -> f64 {
    let square = |trial| {
        let points = points(trial);
        (points.iter().map(|p| smooth(*p)).sum::<f64>() / points.len() as f64 - 1.0).powi(2)
    };
    (0..trials).map(square).sum::<f64>() / f64::from(trials)
}

/// The error of n independent points: (∫f² − 1)/n, with ∫(½ + x)² = 13/12 and ∫(¼ + 2¼y²)² = 1/16 + 3/8 + 81/80.
fn independent(n: f64) -> f64 {
    (13.0 / 12.0 * (1.0 / 16.0 + 0.375 + 81.0 / 80.0) - 1.0) / n
}

#[test]
fn errors_of_smooth_functions_fall_faster() {
    let of = |n: u32| error(400, |seed| (0..n).map(|i| point(u64::from(seed), [8, 1], i, 5)).collect());
    let errors = [1, 16, 256].map(of);
    assert!((errors[0] / independent(1.0) - 1.0).abs() < 0.3, "{errors:?}");
    // Independent points gain 16 each time, scrambled nets almost 16³.
    assert!(errors[0] / errors[1] > 100.0 && errors[1] / errors[2] > 500.0, "{errors:?}");
}

#[test]
fn any_range_of_samples_is_usable() {
    for (first, count) in [(1u32, 30u32), (37, 128), (1000, 100), (65_500, 200), (u32::MAX - 99, 100)] {
        let range = move |seed| (0..count).map(|i| point(seed, [8, 1], first + i, 6)).collect();
        let gain = independent(f64::from(count)) / error(400, |seed| range(u64::from(seed)));
        assert!(gain > 5.0, "from {first}, {count} samples: {gain}");
    }
}

#[test]
fn neighbouring_pixels_make_up_for_each_other() {
    for samples in [1u32, 4, 16, 3] {
        for (edge, least) in [(2u32, 2.5), (4, 6.0), (8, 10.0)] {
            let block = |seed| {
                let pixels = (0..edge * edge).map(|i| [16 + i % edge, 24 + i / edge]);
                pixels.flat_map(|p| (0..samples).map(move |s| point(seed, p, s, 7))).collect()
            };
            let alone =
                error(300, |seed| (0..samples).map(|s| point(u64::from(seed), [17, 25], s, 7)).collect());
            let gain = alone / f64::from(edge * edge) / error(300, |seed| block(u64::from(seed)));
            assert!(gain > least, "{samples} samples, {edge}² pixels: {gain}");
        }
    }
}

#[test]
fn streams_repeat_and_seek() {
    let id = SampleId { seed: 5, pixel: [70_000, 12], sample: 9 };
    for sampler in [Sampler::Sobol, Sampler::Independent] {
        let mut a = SampleStream::of_sample(sampler, id, 1);
        let mut b = a.clone();
        let drawn = [a.next_2d(), a.next_2d(), a.next_2d()];
        assert_eq!(b.seek(2).next_2d(), drawn[2]);
        assert_eq!(b.seek(0).next_1d(), drawn[0][0]);
        assert_ne!(drawn[0], drawn[1]);
        for other in [
            SampleId { seed: 6, ..id },
            SampleId { pixel: [70_001, 12], ..id },
            SampleId { pixel: [70_000, 13], ..id },
            SampleId { pixel: [12, 70_000], ..id },
            SampleId { sample: 10, ..id },
        ] {
            assert_ne!(SampleStream::of_sample(sampler, other, 1).next_2d(), drawn[0], "{other:?}");
        }
        assert_ne!(SampleStream::of_sample(sampler, id, 0).next_2d(), drawn[0]);
    }
}
