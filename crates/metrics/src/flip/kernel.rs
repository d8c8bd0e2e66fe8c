//! The filters of the eye, all of them sums of products of one-dimensional ones.

use std::f64::consts::PI;

use crate::image::MetricsError;

/// Amplitude a and width b (in square degrees) of Gaussians a √(π/b) exp(−π² d²/b) in the distance d in
/// degrees: the contrast sensitivity of the eye by channel, as the paper's colour pipeline takes it from
/// G. M. Johnson and M. D. Fairchild.
const LIGHT_DARK: (f64, f64) = (1.0, 0.0047);
const RED_GREEN: (f64, f64) = (1.0, 0.0053);
const BLUE_YELLOW: [(f64, f64); 2] = [(34.1, 0.04), (13.5, 0.025)];

/// The widest of them, by which all are cut off at three standard deviations.
const WIDEST: f64 = 0.04;

/// The width of the edges and points that the eye notices first, in degrees (w in the paper).
const FEATURE_WIDTH: f64 = 0.082;

/// Half of a filter along a line; the other half mirrors it, or mirrors it with the sign changed.
pub(super) struct Kernel {
    /// Weights from the centre outwards.
    half: Vec<f32>,
    odd: bool,
}

impl Kernel {
    fn even(half: impl Iterator<Item = f64>) -> Self {
        Self { half: half.map(|w| w as f32).collect(), odd: false }
    }

    /// Adds to `out` the filtered values of lines: `line(d)` holds what lies `d` pixels after each place
    /// of `out`.
    #[inline]
    pub(super) fn add<'a>(&self, out: &mut [f32], line: impl Fn(isize) -> &'a [f32]) {
        if !self.odd {
            let weight = self.half[0];
            out.iter_mut().zip(line(0)).for_each(|(o, v)| *o += weight * v);
        }
        for (distance, weight) in self.half.iter().enumerate().skip(1) {
            let both = line(-(distance as isize)).iter().zip(line(distance as isize));
            if self.odd {
                out.iter_mut().zip(both).for_each(|(o, (before, after))| *o += weight * (after - before));
            } else {
                out.iter_mut().zip(both).for_each(|(o, (before, after))| *o += weight * (after + before));
            }
        }
    }
}

/// All filters for some number of pixels per degree.
pub(super) struct Kernels {
    /// What the eye blurs of differences between light and dark.
    pub(super) light_dark: Kernel,
    /// The same of red and green.
    pub(super) red_green: Kernel,
    /// The same of blue and yellow, of which the sum is taken.
    pub(super) blue_yellow: [Kernel; 2],
    /// A Gaussian along an edge.
    pub(super) along: Kernel,
    /// Its first derivative, across an edge.
    pub(super) edge: Kernel,
    /// Its second derivative, across a point.
    pub(super) point: Kernel,
    /// How far the filters reach, in pixels.
    pub(super) radius: usize,
}

impl Kernels {
    /// # Errors
    /// [`MetricsError::PixelsPerDegree`] outside of 1 to 1000.
    pub(super) fn new(pixels_per_degree: f32) -> Result<Self, MetricsError> {
        if !(1.0..=1000.0).contains(&pixels_per_degree) {
            return Err(MetricsError::PixelsPerDegree(pixels_per_degree));
        }
        let density = f64::from(pixels_per_degree);
        let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * density).ceil() as usize;
        let [light_dark] = blurs([LIGHT_DARK], density, radius);
        let [red_green] = blurs([RED_GREEN], density, radius);
        let blue_yellow = blurs(BLUE_YELLOW, density, radius);
        let [along, edge, point] = features(0.5 * FEATURE_WIDTH * density);
        Ok(Self { light_dark, red_green, blue_yellow, along, edge, point, radius })
    }
}

/// One filter for each Gaussian, for use both along rows and along columns, such that the sum of what
/// they give keeps a constant.
fn blurs<const N: usize>(terms: [(f64, f64); N], density: f64, radius: usize) -> [Kernel; N] {
    let at = |(a, b): (f64, f64), pixels: usize| {
        let degrees = pixels as f64 / density;
        // The root, since it is multiplied by that of the other direction.
        (a * (PI / b).sqrt()).sqrt() * libm::exp(-PI * PI * degrees * degrees / b)
    };
    let total = |term| at(term, 0) + 2.0 * (1..=radius).map(|d| at(term, d)).sum::<f64>();
    let norm = terms.iter().map(|term| total(*term) * total(*term)).sum::<f64>().sqrt();
    terms.map(|term| Kernel::even((0..=radius).map(|d| at(term, d) / norm)))
}

/// A Gaussian of the standard deviation `deviation` in pixels that adds up to one, and its first and
/// second derivative, of which the positive weights add up to one and the negative ones to minus one
/// (the paper's feature pipeline).
fn features(deviation: f64) -> [Kernel; 3] {
    let reach = (3.0 * deviation).ceil() as usize;
    let squared = |d: usize| (d as f64 / deviation) * (d as f64 / deviation);
    let gauss = |d: usize| libm::exp(-0.5 * squared(d));
    let first = |d: usize| d as f64 * gauss(d);
    let second = |d: usize| (squared(d) - 1.0) * gauss(d);
    let sum = |f: &dyn Fn(usize) -> f64| (1..=reach).map(f).sum::<f64>();
    let whole = gauss(0) + 2.0 * sum(&gauss);
    let rising = sum(&first);
    let above = 2.0 * sum(&|d| second(d).max(0.0));
    let below = 1.0 + 2.0 * sum(&|d| (-second(d)).max(0.0));
    [
        Kernel::even((0..=reach).map(|d| gauss(d) / whole)),
        Kernel { half: (0..=reach).map(|d| (first(d) / rising) as f32).collect(), odd: true },
        Kernel::even((0..=reach).map(|d| second(d) / if second(d) > 0.0 { above } else { below })),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filtered(kernel: &Kernel, line: &[f32; 41]) -> f32 {
        let mut out = [0.0];
        kernel.add(&mut out, |d| &line[(20 + d) as usize..][..1]);
        out[0]
    }

    #[test]
    fn constants_and_slopes() {
        let kernels = Kernels::new(crate::flip::PIXELS_PER_DEGREE).unwrap();
        assert_eq!(kernels.radius, 10);
        let (ones, slope) = ([1.0; 41], std::array::from_fn(|i| i as f32 - 20.0));
        for blur in [&kernels.light_dark, &kernels.red_green, &kernels.along] {
            assert!((filtered(blur, &ones) - 1.0).abs() < 1e-6 && filtered(blur, &slope).abs() < 1e-6);
        }
        let [wide, narrow] = kernels.blue_yellow.each_ref().map(|k| filtered(k, &ones));
        assert!((wide * wide + narrow * narrow - 1.0).abs() < 1e-6, "rows and columns: {wide}, {narrow}");
        assert!(filtered(&kernels.edge, &ones).abs() < 1e-6 && filtered(&kernels.edge, &slope) > 1.0);
        assert!(filtered(&kernels.point, &ones).abs() < 1e-6);
    }

    #[test]
    fn a_step_is_an_edge_of_one() {
        let kernels = Kernels::new(40.0).unwrap();
        let step = std::array::from_fn(|i| if i > 20 { 1.0 } else { 0.0 });
        assert!((filtered(&kernels.edge, &step) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn any_density_in_range_gives_weights() {
        for density in [1.0, 2.5, 1000.0] {
            let kernels = Kernels::new(density).unwrap();
            for kernel in [&kernels.light_dark, &kernels.along, &kernels.edge, &kernels.point] {
                assert!(kernel.half.iter().all(|w| w.is_finite()));
            }
        }
        for density in [0.0, -3.0, 1001.0, f32::NAN, f32::INFINITY] {
            assert!(matches!(Kernels::new(density), Err(MetricsError::PixelsPerDegree(_))));
        }
    }
}
