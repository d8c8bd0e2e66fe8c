//! Exposures and tone curves: what of a picture's brightness a display shows at a time.

use caustica_math::Rgb;
use serde::Serialize;

use super::visible;
use crate::image::{Image, MetricsError};

/// The most exposures that can be asked for; from the faintest to the brightest light that single
/// precision knows there are fewer.
pub const MAX_EXPOSURES: u32 = 256;

/// The part of white to which the curves bring the reference's maximum and median.
const SHOWN: f64 = 0.85;

/// The least median luminance.
const FAINT: f32 = f32::EPSILON;

/// Below this luminance a reference is black: no exposure brings it up.
const BLACK: f32 = 1e-30;

/// Light above this is white on every curve, and its square is still finite.
const BRIGHT: f32 = 1e15;

/// Weights of linear Rec. 709 channels in the luminance.
const LUMINANCE: [f32; 3] = [0.2126, 0.7152, 0.0722];

/// A tone curve, by which a display shows light of any brightness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Curve {
    /// K. Narkowicz's fit (2015) of the filmic curve of ACES, as bright as the original.
    #[default]
    Aces,
    /// J. Hable's curve of “Uncharted 2” (2010) for twice the light, white at 5.6.
    Hable,
    /// c / (1 + luminance), after E. Reinhard et al. (2002).
    Reinhard,
}

impl Curve {
    /// (p₂ x² + p₁ x) / (q₂ x² + q₁ x + q₀): p₂, p₁, q₂, q₁, q₀. For Reinhard's, that of a grey.
    fn coefficients(self) -> [f32; 5] {
        match self {
            // Narkowicz's constants for 0.6 times the light.
            Self::Aces => [0.36 * 2.51, 0.6 * 0.03, 0.36 * 2.43, 0.6 * 0.59, 0.14],
            Self::Hable => [0.231_683, 0.013_791, 0.18, 0.3, 0.018],
            Self::Reinhard => [0.0, 1.0, 0.0, 1.0, 1.0],
        }
    }

    /// Linear light of the display, in [0, 1], for the linear light `c` of a picture.
    #[inline]
    pub(super) fn shown(self, light: Rgb) -> [f32; 3] {
        let light = light.map(|c| c.min(BRIGHT));
        if self == Self::Reinhard {
            let white = 1.0 + luminance(light);
            return light.0.map(|c| (c / white).clamp(0.0, 1.0));
        }
        let [p2, p1, q2, q1, q0] = self.coefficients();
        light.0.map(|x| ((x * x * p2 + x * p1) / (x * x * q2 + x * q1 + q0)).clamp(0.0, 1.0))
    }

    /// The light of a grey that the curve brings to [`SHOWN`]: the greater root of p(x) = 0.85 q(x).
    fn light_shown(self) -> f64 {
        let [p2, p1, q2, q1, q0] = self.coefficients().map(f64::from);
        let (a, b, c) = (p2 - SHOWN * q2, p1 - SHOWN * q1, -SHOWN * q0);
        if a == 0.0 { -c / b } else { -b / (2.0 * a) + (b * b / (4.0 * a * a) - c / a).sqrt() }
    }
}

/// Exposures at equal distances, in stops: powers of two by which light is multiplied.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Exposures {
    /// The lowest, which shows the brightest light.
    pub start: f32,
    /// The highest, which shows the faintest.
    pub stop: f32,
    /// How many there are, from the lowest to the highest.
    pub count: u32,
}

impl Exposures {
    /// Exposures from `start` to `stop`: `count` of them, or one for each stop between them, but at
    /// least two.
    pub(super) fn new(start: f32, stop: f32, count: Option<u32>) -> Result<Self, MetricsError> {
        let count = count.unwrap_or_else(|| (stop - start).ceil().max(2.0) as u32);
        let fewest = if start == stop { 1 } else { 2 };
        let possible = start.is_finite() && stop.is_finite() && start <= stop;
        if possible && (fewest..=MAX_EXPOSURES).contains(&count) {
            Ok(Self { start, stop, count })
        } else {
            Err(MetricsError::Exposures { start, stop, count })
        }
    }

    /// What light is multiplied by at each exposure.
    pub(super) fn gains(self) -> impl Iterator<Item = f32> {
        let step = (self.stop - self.start) / self.count.saturating_sub(1).max(1) as f32;
        (0..self.count).map(move |i| libm::exp2f(self.start + i as f32 * step))
    }
}

/// The first and the last exposure for `reference`, as the HDR-ꟻLIP paper chooses them.
pub(super) fn range(reference: Image, curve: Curve) -> Result<(f32, f32), MetricsError> {
    let mut brightness: Vec<f32> = reference.pixels().iter().map(|p| luminance(visible(*p))).collect();
    let middle = brightness.len() / 2;
    let (_, median, brighter) = brightness.select_nth_unstable_by(middle, f32::total_cmp);
    let greatest = brighter.iter().copied().fold(*median, f32::max);
    if greatest < BLACK {
        return Err(MetricsError::BlackReference);
    }
    let stops = |light: f32| libm::log2f(curve.light_shown() as f32 / light);
    Ok((stops(greatest), stops(median.max(FAINT).min(greatest))))
}

fn luminance(Rgb([r, g, b]): Rgb) -> f32 {
    LUMINANCE[0] * r + LUMINANCE[1] * g + LUMINANCE[2] * b
}

#[cfg(test)]
mod tests {
    use super::*;

    const CURVES: [Curve; 3] = [Curve::Aces, Curve::Hable, Curve::Reinhard];

    fn range_of(greys: &[f32], curve: Curve) -> Result<(f32, f32), MetricsError> {
        let pixels: Vec<Rgb> = greys.iter().map(|g| Rgb::splat(*g)).collect();
        range(Image::new(greys.len() as u32, 1, &pixels)?, curve)
    }

    #[test]
    fn the_maximum_and_the_median_are_brought_to_the_same_grey() {
        for curve in CURVES {
            let (start, stop) = range_of(&[0.5, 300.0, 2.0, 0.1, 7.0], curve).unwrap();
            for (stops, grey) in [(start, 300.0), (stop, 2.0)] {
                let shown = curve.shown(Rgb::splat(grey * libm::exp2f(stops)))[1];
                assert!((shown - 0.85).abs() < 1e-4, "{curve:?}: {grey} is shown as {shown}");
            }
        }
    }

    #[test]
    fn curves_keep_to_the_display() {
        for curve in CURVES {
            for light in [0.0, 1e-20, 1.0, 1e10, f32::MAX, f32::INFINITY] {
                let shown = curve.shown(Rgb::splat(light));
                assert!(shown.iter().all(|c| (0.0..=1.0).contains(c)), "{curve:?} of {light}: {shown:?}");
            }
        }
    }

    #[test]
    fn dark_references() {
        assert_eq!(range_of(&[0.0; 4], Curve::Aces), Err(MetricsError::BlackReference));
        let (start, stop) = range_of(&[0.0, 0.0, 1.0], Curve::Aces).unwrap();
        assert!((stop - start - 23.0).abs() < 1e-5, "the median is 2⁻²³: {start} to {stop}");
        let (start, stop) = range_of(&[0.0, 0.0, 1e-20], Curve::Aces).unwrap();
        assert_eq!(start, stop);
    }

    #[test]
    fn exposures_reach_both_ends() {
        let gains =
            |start, stop, count| Exposures::new(start, stop, count).unwrap().gains().collect::<Vec<_>>();
        assert_eq!(gains(-1.0, 2.0, Some(4)), [0.5, 1.0, 2.0, 4.0]);
        assert_eq!(gains(-1.0, 1.5, None).len(), 3);
        assert_eq!(gains(1.0, 1.0, Some(1)), [2.0]);
        assert_eq!(gains(1.0, 1.0, None), [2.0, 2.0]);
    }

    #[test]
    fn impossible_exposures() {
        let tries = [
            (2.0, 1.0, None),
            (0.0, 1.0, Some(1)),
            (0.0, 1.0, Some(0)),
            (0.0, 1.0, Some(1000)),
            (f32::NAN, 1.0, None),
            (0.0, f32::INFINITY, None),
        ];
        for (start, stop, count) in tries {
            assert!(matches!(Exposures::new(start, stop, count), Err(MetricsError::Exposures { .. })));
        }
    }
}
