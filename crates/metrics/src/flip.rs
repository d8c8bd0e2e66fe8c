//! ꟻLIP: the difference that an observer sees who flips between a picture and its reference.
//!
//! LDR-ꟻLIP is that of P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström and M. D.
//! Fairchild, “ꟻLIP: A Difference Evaluator for Alternating Images”, High Performance Graphics 2020
//! ([`ldr`]). HDR-ꟻLIP is the greatest LDR-ꟻLIP over a range of exposures: P. Andersson, J. Nilsson, P.
//! Shirley and T. Akenine-Möller, “Visualizing Errors in Rendered High Dynamic Range Images”,
//! Eurographics 2021 ([`hdr`]).
//!
//! Where the papers leave a choice, the evaluator that their authors publish is followed (version 1.7):
//! beyond the edge a picture goes on as at the edge, and the median luminance, if zero, is taken to be
//! that of a faint grey. The tests compare with it. Three things are our own: negative light counts as
//! none, a pixel that is not finite is as wrong as can be (1) and black to its neighbours, and a
//! reference fainter than the faint grey has one exposure instead of an error.

mod colour;
mod exposure;
mod kernel;
mod observer;

use caustica_math::Rgb;
use serde::Serialize;

pub use exposure::{Curve, Exposures, MAX_EXPOSURES};

use crate::image::{Image, MetricsError, check, is_finite};
use observer::Observer;

/// Pixels per degree of a display 0.7 m wide with 3840 pixels across, seen from 0.7 m: 67.02.
pub const PIXELS_PER_DEGREE: f32 = 3840.0 * std::f32::consts::PI / 180.0;

/// How the observer looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Pixels of the display in a degree of the field of view, 1 to 1000: the more, the less detail is seen.
    pub pixels_per_degree: f32,
    /// The tone curve of [`hdr`]; [`ldr`] needs none.
    pub curve: Curve,
    /// The first and lowest exposure of [`hdr`] in stops; where `None`, it is chosen from the reference.
    pub start: Option<f32>,
    /// The last and highest exposure, likewise.
    pub stop: Option<f32>,
    /// The number of exposures, likewise: about one in each stop.
    pub count: Option<u32>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            pixels_per_degree: PIXELS_PER_DEGREE,
            curve: Curve::Aces,
            start: None,
            stop: None,
            count: None,
        }
    }
}

/// The differences that are seen.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FlipMap {
    /// The difference at each pixel, row by row from the top, from 0 (none) to 1.
    pub values: Vec<f32>,
    /// Their mean.
    pub mean: f64,
    /// The exposures looked at; `None` for LDR-ꟻLIP.
    pub exposures: Option<Exposures>,
}

/// LDR-ꟻLIP of two pictures as a display shows them, without a tone curve: light is clamped to [0, 1].
///
/// # Errors
/// [`MetricsError::Sizes`], [`MetricsError::BadReference`] and [`MetricsError::PixelsPerDegree`].
pub fn ldr(image: Image, reference: Image, options: &Options) -> Result<FlipMap, MetricsError> {
    check(image, reference)?;
    let mut observer = Observer::new(image, reference, options.pixels_per_degree)?;
    observer.look(|light| light.0.map(|c| c.clamp(0.0, 1.0)));
    Ok(finish(observer.into_values(), image, None))
}

/// HDR-ꟻLIP of two pictures of any brightness: at each pixel the greatest LDR-ꟻLIP of all exposures. It
/// takes as long as [`ldr`] for each of them.
///
/// # Errors
/// Those of [`ldr`] and of [`exposures`].
pub fn hdr(image: Image, reference: Image, options: &Options) -> Result<FlipMap, MetricsError> {
    check(image, reference)?;
    let exposures = exposures(reference, options)?;
    let mut observer = Observer::new(image, reference, options.pixels_per_degree)?;
    for gain in exposures.gains() {
        observer.look(|light| options.curve.shown(light * gain));
    }
    Ok(finish(observer.into_values(), image, Some(exposures)))
}

/// The exposures at which [`hdr`] looks: those of `options`, and what they leave open by the reference.
/// The first one brings the reference's greatest luminance to 85 % of white, the last one its median;
/// there are as many as there are stops between them, rounded up, and at least two.
///
/// # Errors
/// [`MetricsError::BadReference`], [`MetricsError::BlackReference`] and [`MetricsError::Exposures`].
pub fn exposures(reference: Image, options: &Options) -> Result<Exposures, MetricsError> {
    check(reference, reference)?;
    let (start, stop) = match (options.start, options.stop) {
        (Some(start), Some(stop)) => (start, stop),
        (start, stop) => {
            let (first, last) = exposure::range(reference, options.curve)?;
            (start.unwrap_or(first), stop.unwrap_or(last))
        }
    };
    Exposures::new(start, stop, options.count)
}

/// The map of `values`, in which pixels that are not finite are as wrong as can be.
fn finish(mut values: Vec<f32>, image: Image, exposures: Option<Exposures>) -> FlipMap {
    for (value, pixel) in values.iter_mut().zip(image.pixels()) {
        if !is_finite(*pixel) {
            *value = 1.0;
        }
    }
    let sum: f64 = values.iter().map(|v| f64::from(*v)).sum();
    FlipMap { mean: sum / values.len() as f64, values, exposures }
}

/// The light of a pixel for the observer: black where it is not finite, and nowhere negative.
fn visible(pixel: Rgb) -> Rgb {
    if is_finite(pixel) { pixel.map(|c| c.max(0.0)) } else { Rgb::BLACK }
}
