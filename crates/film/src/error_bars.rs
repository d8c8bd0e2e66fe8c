//! How far a picture may be from the truth, told by the difference of its halves.

use std::ops::Range;

use caustica_math::Rgb;
use caustica_math::stats::{chi_square_quantile, t_quantile};

use crate::layout::Window;

/// Pixels on each side of one whose noise is taken together with its own: 25 in all.
const POOL: usize = 2;

/// Pixels on each side of one whose brightness is taken together with its own.
const SMOOTH: usize = 1;

/// The same for errors of the whole picture. Where light is so rare that most pixels have none, a pixel's own brightness
/// says nothing about the truth, and an error relative to it even less.
const AROUND: usize = 7;

/// Relative to the picture's mean, how bright a pixel counts at least in the error of the whole picture.
const DIM: f64 = 0.1;

/// The same for the error bars of single pixels.
const BLACK: f64 = 0.01;

/// What the errors of 19 in 20 normal numbers lie within, in standard deviations.
const NORMAL: f64 = 1.96;

/// Beyond these many degrees of freedom, χ² divided by them is one within a thousandth.
const MANY: f64 = 1e7;

/// Error bars of a picture that is the mean of two parts.
///
/// If A and B are the means of n_A and n_B of its N passes, the square of A − B tells the variance of the mean:
/// v = (A − B)² n_A n_B / N². That counts all noise alike, of eye and light image. (The halves are well spread over a
/// pixel each, and the film that is made of both is spread better still: the estimate errs to the safe side.) For a
/// single pixel it has one degree of freedom, too few to say anything. So the variances of the pixels around it are
/// taken together with its own, each relative to the brightness there.
///
/// What no sample has found yet, nothing can tell of: a caustic that one path in a million finds is not missed by
/// error bars of a hundred thousand.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorBars {
    window: Window,
    /// The picture.
    mean: Vec<Rgb>,
    /// The variance of each pixel and channel, by that pixel alone.
    variance: Vec<Rgb>,
    /// The variance of each pixel's luminance, by that pixel alone.
    of_luminance: Vec<f64>,
}

impl ErrorBars {
    /// Of two pictures of `window`, the means of so many passes; there is at least one in each.
    pub(crate) fn of_halves(window: Window, [a, b]: [Vec<Rgb>; 2], passes: [u64; 2]) -> Self {
        let [n, m] = passes.map(|n| n as f64);
        let (of_a, of_b) = (n / (n + m), m / (n + m));
        let scale = of_a * of_b;
        let pairs = || a.iter().zip(&b);
        let each = |f: &dyn Fn(f64, f64) -> f64| -> Vec<Rgb> {
            let pixel = |(a, b): (&Rgb, &Rgb)| Rgb([0, 1, 2].map(|c| f(a.0[c].into(), b.0[c].into()) as f32));
            pairs().map(pixel).collect()
        };
        Self {
            window,
            mean: each(&|a, b| a * of_a + b * of_b),
            variance: each(&|a, b| (a - b) * (a - b) * scale),
            of_luminance: pairs()
                .map(|(a, b)| {
                    let d = f64::from(a.luminance()) - f64::from(b.luminance());
                    d * d * scale
                })
                .collect(),
        }
    }

    /// Half the width of the 95 % interval of each pixel and channel, row by row: the truth lies that near to the
    /// picture, but for about one pixel in twenty.
    pub fn half_widths(&self) -> Vec<Rgb> {
        // Of pools that the border cuts off, too.
        let cells = 1..=(2 * POOL + 1) * (2 * POOL + 1);
        let quantiles: Vec<f64> = cells.map(|n| t_quantile(0.025, n as f64)).collect();
        let channels = [0, 1, 2].map(|c| self.channel(c, &quantiles));
        (0..self.mean.len()).map(|i| Rgb(channels.each_ref().map(|w| w[i]))).collect()
    }

    fn size(&self) -> [usize; 2] {
        [self.window.width as usize, self.window.height as usize]
    }

    /// The half widths of a channel, with the quantiles of pools by their number of pixels less one.
    fn channel(&self, c: usize, quantiles: &[f64]) -> Vec<f32> {
        let size = self.size();
        let brightness: Vec<f64> = self.mean.iter().map(|p| f64::from(p.0[c]).abs()).collect();
        let floor = BLACK * mean(&brightness);
        let brightness: Vec<f64> =
            pooled(&brightness, size, SMOOTH).into_iter().map(|x| x.max(floor)).collect();
        let relative = |(v, s): (&Rgb, &f64)| if *s > 0.0 { f64::from(v.0[c]) / (s * s) } else { 0.0 };
        let relative: Vec<f64> = self.variance.iter().zip(&brightness).map(relative).collect();
        let quantile = |i: usize| {
            let cells = |at: usize, count: usize| around(at, POOL, count).len();
            quantiles[cells(i % size[0], size[0]) * cells(i / size[0], size[1]) - 1]
        };
        let width = |(i, (v, s)): (usize, (f64, &f64))| (quantile(i) * v.sqrt() * s) as f32;
        pooled(&relative, size, POOL).into_iter().zip(&brightness).enumerate().map(width).collect()
    }

    /// The error of the whole picture: 1.96 times the root mean square of the errors of luminance, each relative to the
    /// mean brightness of the 15 × 15 pixels around, which counts as a tenth of the picture's mean at least. It is an
    /// upper bound of 95 % certainty, which matters for small pictures only (and counts pixels as independent of each
    /// other, which they are not quite where they share light paths). `None` of a black picture, about which
    /// nothing is known.
    pub fn relative(&self) -> Option<f64> {
        let degrees = self.of_luminance.len() as f64;
        let surplus =
            if degrees < MANY { (degrees / chi_square_quantile(0.05, degrees)).sqrt() } else { 1.0 };
        self.relative_error(&self.luminances(), &self.of_luminance).map(|e| e * surplus)
    }

    /// The same of the errors themselves, where the truth is known, row by row: what [`ErrorBars::relative`] bounds.
    pub fn relative_to(&self, truth: &[Rgb]) -> Option<f64> {
        let truth: Vec<f64> = truth.iter().map(|t| t.luminance().into()).collect();
        let squared: Vec<f64> =
            self.luminances().iter().zip(&truth).map(|(l, t)| (l - t) * (l - t)).collect();
        self.relative_error(&truth, &squared)
    }

    fn luminances(&self) -> Vec<f64> {
        self.mean.iter().map(|p| p.luminance().into()).collect()
    }

    /// 1.96 √(mean of variance / brightness²).
    fn relative_error(&self, luminance: &[f64], variance: &[f64]) -> Option<f64> {
        let dim = DIM * mean(luminance);
        let brightness = pooled(luminance, self.size(), AROUND);
        let relative =
            brightness.iter().zip(variance).map(|(l, v)| v / (l.max(dim) * l.max(dim))).collect::<Vec<_>>();
        (dim > 0.0).then(|| NORMAL * mean(&relative).sqrt())
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Those of `count` places that are at most `radius` from one.
fn around(at: usize, radius: usize, count: usize) -> Range<usize> {
    at.saturating_sub(radius)..(at + radius + 1).min(count)
}

/// The means over squares of 2 `radius` + 1 values around each, cut off at the borders.
fn pooled(values: &[f64], [width, height]: [usize; 2], radius: usize) -> Vec<f64> {
    let along = |values: &[f64], count: usize, stride: usize, start: usize, to: &mut [f64]| {
        for i in 0..count {
            let range = around(i, radius, count);
            let cells = range.len() as f64;
            to[start + i * stride] = range.map(|j| values[start + j * stride]).sum::<f64>() / cells;
        }
    };
    let (mut rows, mut both) = (vec![0.0; values.len()], vec![0.0; values.len()]);
    (0..height).for_each(|y| along(values, width, 1, y * width, &mut rows));
    (0..width).for_each(|x| along(&rows, height, width, x, &mut both));
    both
}

#[cfg(test)]
mod tests {
    use super::*;
    use caustica_math::elementary::{ln, sin_cos};
    use caustica_math::stream::{SampleStream, StreamId};

    const WINDOW: Window = Window { x: 0, y: 0, width: 64, height: 48 };

    /// A normal number by Box and Muller.
    fn normal(s: &mut SampleStream) -> f32 {
        let [u, v] = s.next_2d();
        let (sin, _) = sin_cos(std::f32::consts::TAU * v);
        (-2.0 * ln(1.0 - u)).sqrt() * sin
    }

    /// Brighter to the right, with an edge in the middle.
    fn truth(x: u32) -> f32 {
        if x < 32 { 0.05 + 0.01 * x as f32 } else { 4.0 }
    }

    /// Bars of a picture with so much noise relative to the truth for one pass.
    fn bars(seed: u64, noise: f32, passes: [u64; 2]) -> ErrorBars {
        let half = |h: u32, n: u64| -> Vec<Rgb> {
            (0..64 * 48)
                .map(|i| {
                    let mut s = SampleStream::new(StreamId { seed, pixel: i, sample: h, walk: 0 });
                    Rgb::splat(truth(i % 64) * (1.0 + noise * normal(&mut s) / (n as f32).sqrt()))
                })
                .collect()
        };
        ErrorBars::of_halves(WINDOW, [half(0, passes[0]), half(1, passes[1])], passes)
    }

    #[test]
    fn bars_cover_the_truth_nineteen_times_in_twenty() {
        for passes in [[50, 50], [64, 32]] {
            let (mut inside, mut all) = (0, 0);
            for seed in 0..8 {
                let bars = bars(seed, 0.5, passes);
                for (i, (width, mean)) in bars.half_widths().iter().zip(&bars.mean).enumerate() {
                    inside += i32::from((mean.0[1] - truth(i as u32 % 64)).abs() < width.0[1]);
                    all += 1;
                }
            }
            // With 24 576 pixels whose bars depend on each other within 25: ± 1.5 %.
            let coverage = f64::from(inside) / f64::from(all);
            assert!((0.93..0.97).contains(&coverage), "{passes:?}: {coverage}");
        }
    }

    #[test]
    fn the_error_of_the_whole_is_that_of_its_pixels() {
        let all: Vec<Rgb> = (0..64 * 48).map(|i| Rgb::splat(truth(i % 64))).collect();
        for (noise, passes) in [(0.5, [50, 50]), (0.1, [20, 10])] {
            let n = (passes[0] + passes[1]) as f64;
            let bars = bars(3, noise, passes);
            // Most of the left half is dimmer than a tenth of the mean: errors count less there.
            let (told, found) = (bars.relative().unwrap(), bars.relative_to(&all).unwrap());
            assert!(found < 1.96 * f64::from(noise) / n.sqrt());
            assert!((1.0..1.08).contains(&(told / found)), "{told} {found}");
        }
    }

    #[test]
    fn black_pictures_have_no_errors() {
        let black = vec![Rgb::BLACK; 64 * 48];
        let bars = ErrorBars::of_halves(WINDOW, [black.clone(), black.clone()], [1, 1]);
        assert_eq!(bars.relative(), None);
        assert!(bars.half_widths().iter().all(|w| *w == Rgb::BLACK));
    }

    /// A lamp that one path in a hundred finds: the error is some thousand per cent, and most pixels are black.
    #[test]
    fn rare_light_is_not_taken_for_darkness() {
        let half = |h: u32| -> Vec<Rgb> {
            (0..64 * 48)
                .map(|i| {
                    let mut s = SampleStream::new(StreamId { seed: 1, pixel: i, sample: h, walk: 0 });
                    Rgb::splat(if s.next_1d() < 0.01 { 100.0 } else { 0.0 })
                })
                .collect()
        };
        let bars = ErrorBars::of_halves(WINDOW, [half(0), half(1)], [1, 1]);
        let (told, found) = (bars.relative().unwrap(), bars.relative_to(&vec![Rgb::WHITE; 64 * 48]).unwrap());
        assert!((0.8..1.3).contains(&(told / found)), "{told} {found}");
    }

    /// What is told of a single pixel bounds its error for 19 in 20 seeds.
    #[test]
    fn small_pictures_err_to_the_safe_side() {
        let window = Window { x: 0, y: 0, width: 2, height: 1 };
        let bounded = (0..400u32)
            .filter(|seed| {
                let mut s =
                    SampleStream::new(StreamId { seed: (*seed).into(), pixel: 0, sample: 0, walk: 0 });
                let half =
                    std::array::from_fn(|_| (0..2).map(|_| Rgb::splat(1.0 + 0.1 * normal(&mut s))).collect());
                let bars = ErrorBars::of_halves(window, half, [8, 8]);
                bars.relative().unwrap() >= 1.96 * 0.1 / 2f64.sqrt()
            })
            .count();
        assert!((370..=392).contains(&bounded), "{bounded} of 400");
        // One pixel has one degree of freedom: 12.7 standard deviations.
        let one = Window { width: 1, ..window };
        let bars = ErrorBars::of_halves(one, [vec![Rgb::splat(1.1)], vec![Rgb::splat(0.9)]], [1, 1]);
        assert!((bars.half_widths()[0].0[0] - 1.2706).abs() < 1e-3);
    }

    #[test]
    fn pools_are_cut_off_at_the_borders() {
        let values: Vec<f64> = (0..12).map(f64::from).collect();
        let means = pooled(&values, [4, 3], 1);
        assert_eq!(means[0], (0.0 + 1.0 + 4.0 + 5.0) / 4.0);
        assert_eq!(means[5], 5.0);
        assert_eq!(means[11], (6.0 + 7.0 + 10.0 + 11.0) / 4.0);
        assert_eq!(pooled(&[3.0], [1, 1], 2), [3.0]);
    }
}
