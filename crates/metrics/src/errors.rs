//! Squared errors, relative to the reference and absolute.

use caustica_math::Rgb;
use serde::Serialize;

use crate::image::{Image, MetricsError, check, count_not_finite, is_finite};

/// The share of the pixels, the worst, that [`Errors::trimmed_rel_mse`] leaves out.
pub const TRIMMED_SHARE: f64 = 0.001;

/// ε of the relative error as a share of the reference's squared mean luminance.
const EPSILON_SHARE: f64 = 0.01;

/// The weights of linear Rec. 709 channels in the luminance (BT.709).
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// How far a picture is from its reference, over all pixels.
///
/// A pixel with a channel that is infinite or not a number counts as infinitely wrong: it makes
/// `rel_mse` and `rmse` infinite, and `trimmed_rel_mse` too unless it is among the pixels left out.
/// Formats without infinities (JSON) show nothing there; `not_finite` tells why.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Errors {
    /// The mean over pixels and channels of (x − r)² / (r² + ε), ε being 1 % of the reference's squared
    /// mean luminance. It does not change if both pictures are scaled by the same number.
    pub rel_mse: f64,
    /// The same without the worst [`TRIMMED_SHARE`] of the pixels, their number rounded to the nearest,
    /// halves to even.
    pub trimmed_rel_mse: f64,
    /// The square root of the mean over pixels and channels of (x − r)², in the pictures' unit.
    pub rmse: f64,
    /// The picture's mean luminance, in its unit, over the pixels that are finite; 0 where none is.
    pub mean: f64,
    /// The number of pixels with a channel that is infinite or not a number.
    pub not_finite: usize,
}

/// The errors of `image` against `reference`; figures can be compared with those of `benches/peers`.
///
/// # Errors
/// [`MetricsError::Sizes`] and [`MetricsError::BadReference`].
pub fn errors(image: Image, reference: Image) -> Result<Errors, MetricsError> {
    check(image, reference)?;
    let mut relative = relative_errors(image, reference);
    let squares = pairs(image, reference).map(|(x, r)| mean_of(x, r, |x, r| (x - r) * (x - r)));
    let rmse = mean(squares, relative.len()).sqrt();
    let not_finite = count_not_finite(image);
    let finite = image.pixels().iter().filter(|p| is_finite(**p)).map(|p| luminance(*p));
    let rel_mse = mean(relative.iter().copied(), relative.len());
    let left_out = (TRIMMED_SHARE * relative.len() as f64).round_ties_even() as usize;
    let kept = relative.len() - left_out;
    relative.sort_unstable_by(f64::total_cmp);
    Ok(Errors {
        rel_mse,
        trimmed_rel_mse: mean(relative[..kept].iter().copied(), kept),
        rmse,
        mean: mean(finite, (image.pixels().len() - not_finite).max(1)),
        not_finite,
    })
}

/// The squared relative error of each pixel, averaged over the channels, as [`Errors::rel_mse`] defines
/// it; +∞ where the picture is not finite.
///
/// # Errors
/// Those of [`errors`].
pub fn relative_error_map(image: Image, reference: Image) -> Result<Vec<f32>, MetricsError> {
    check(image, reference)?;
    Ok(relative_errors(image, reference).into_iter().map(|e| e as f32).collect())
}

/// [`relative_error_map`] in double precision.
fn relative_errors(image: Image, reference: Image) -> Vec<f64> {
    let brightness = reference.pixels().iter().map(|p| luminance(*p));
    let epsilon = EPSILON_SHARE * mean(brightness, reference.pixels().len()).powi(2);
    // Only beside a black reference can both terms of the divisor be zero; what is right there has no error.
    let relative = |x: f64, r: f64| if x == r { 0.0 } else { (x - r) * (x - r) / (r * r + epsilon) };
    pairs(image, reference).map(|(x, r)| mean_of(x, r, relative)).collect()
}

fn pairs<'a>(image: Image<'a>, reference: Image<'a>) -> impl Iterator<Item = (Rgb, Rgb)> + 'a {
    image.pixels().iter().copied().zip(reference.pixels().iter().copied())
}

/// The mean over the channels of `error`, infinite where the picture is not finite.
fn mean_of(x: Rgb, r: Rgb, error: impl Fn(f64, f64) -> f64) -> f64 {
    if !is_finite(x) {
        return f64::INFINITY;
    }
    (0..3).map(|c| error(x.0[c].into(), r.0[c].into())).sum::<f64>() / 3.0
}

fn luminance(Rgb(channels): Rgb) -> f64 {
    channels.iter().zip(LUMINANCE).map(|(c, weight)| f64::from(*c) * weight).sum()
}

/// The mean, summed in the given order.
fn mean(values: impl Iterator<Item = f64>, count: usize) -> f64 {
    values.sum::<f64>() / count as f64
}
