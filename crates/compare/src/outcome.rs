//! What was rendered, and its measures.

use caustica_film::{Metadata, Picture};
use caustica_math::Rgb;
use caustica_metrics::flip::FlipMap;
use caustica_metrics::{Errors, Image, MetricsError, errors};
use caustica_render::{RenderError, Report};
use caustica_report::{Comparison, CurvePoint, Entry, Inset, Metrics, Shown, Speedup};
use caustica_scene::Scene;

use crate::curve::{Reached, slope, time_to_reach};
use crate::insets::{Region, most_different};
use crate::method::Method;

/// Why methods could not be compared.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// The reference is of another size.
    #[error("the reference has {found} pixels, but the picture is {width} × {height}")]
    Reference {
        /// Width of the picture.
        width: u32,
        /// Height of the picture.
        height: u32,
        /// Pixels of the reference.
        found: usize,
    },
    /// The budget allows for no sample.
    #[error("there is nothing to compare: no sample was rendered")]
    Nothing,
    /// Rendering.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// Measuring.
    #[error(transparent)]
    Metrics(#[from] MetricsError),
}

/// What the pictures should look like.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Where it is from.
    pub from: String,
    /// Its pixels.
    pub pixels: Vec<Rgb>,
    /// How it was made, if it was.
    pub made: Option<Made>,
}

/// How a reference was made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Made {
    /// Samples per pixel.
    pub samples: u64,
    /// Seconds of rendering.
    pub seconds: f64,
    /// Its own relMSE, from what its two independent halves differ by; `None` if it was stopped before the second.
    pub rel_mse: Option<f64>,
}

impl Reference {
    /// The mean of two independent halves, by their samples.
    pub(crate) fn of_halves(
        scene: &Scene,
        halves: &[(u64, Vec<Rgb>)],
        (samples, seconds): (u64, f64),
    ) -> Result<Self, CompareError> {
        let [(n, a), (m, b)] = [&halves[0], &halves[1]];
        let total = samples.max(1) as f32;
        let mean = |(a, b): (&Rgb, &Rgb)| *a * (*n as f32 / total) + *b * (*m as f32 / total);
        let pixels: Vec<Rgb> = a.iter().zip(b).map(mean).collect();
        let rel_mse = if *n > 0 && *m > 0 {
            let window = scene.film.window();
            let image = |pixels| Image::new(window.width, window.height, pixels);
            // a − mean = (a − b)·m/(n + m), and the variance of the mean is that of a − b times nm/(n + m)².
            Some(errors(image(a)?, image(&pixels)?)?.rel_mse * (*n as f64 / *m as f64))
        } else {
            None
        };
        Ok(Self { from: "bdpt".into(), pixels, made: Some(Made { samples, seconds, rel_mse }) })
    }
}

/// One method's picture, measured.
#[derive(Clone, Debug)]
pub struct Entrant {
    /// The method.
    pub method: Method,
    /// Its picture at the end.
    pub picture: Picture,
    /// How it was made.
    pub metadata: Metadata,
    /// What its session tells, of all its time.
    pub report: Report,
    /// The picture's errors.
    pub errors: Errors,
    /// Squared relative error of each pixel.
    pub relative_errors: Vec<f32>,
    /// HDR-ꟻLIP; `None` if the reference is black.
    pub flip: Option<FlipMap>,
    /// How the error fell.
    pub curve: Vec<CurvePoint>,
}

/// All pictures of a comparison.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Width and height of all pictures.
    pub size: [u32; 2],
    /// The reference.
    pub reference: Reference,
    /// The methods, in order; fewer than asked for if the comparison was stopped.
    pub entrants: Vec<Entrant>,
    /// Whether it was stopped: the last method may have rendered for less long than the others.
    pub stopped: bool,
}

/// Insets on a page.
const INSETS: usize = 4;

/// A method whose mean is farther off than this share does not reach all light: its error does not fall for long.
const LOST: f64 = 0.05;

impl Outcome {
    /// What a page shows. What is known of the reference is added to `notes`.
    ///
    /// # Errors
    /// None, of an outcome as [`compare`](crate::compare) makes it.
    pub fn page(
        &self,
        title: &str,
        scene: &str,
        notes: Vec<(String, String)>,
    ) -> Result<Comparison, CompareError> {
        let mut all_notes = notes;
        all_notes.extend(self.notes());
        let maps: Vec<&[f32]> = self.entrants.iter().map(|e| e.relative_errors.as_slice()).collect();
        let insets = most_different(self.size, &maps, INSETS);
        Ok(Comparison {
            title: title.to_owned(),
            scene: scene.to_owned(),
            notes: all_notes,
            reference: Some(self.shown("reference", &self.reference.pixels)),
            entries: self.entrants.iter().map(|e| self.entry(e)).collect(),
            insets: insets.into_iter().enumerate().map(inset).collect(),
            speedups: self.speedups()?,
        })
    }

    fn shown(&self, name: &str, pixels: &[Rgb]) -> Shown {
        let [width, height] = self.size;
        Shown { name: name.to_owned(), width, height, pixels: pixels.to_vec() }
    }

    fn notes(&self) -> Vec<(String, String)> {
        let mut notes = Vec::new();
        let mut note = |name: &str, value: String| notes.push((name.to_owned(), value));
        match &self.reference.made {
            Some(Made { samples, seconds, rel_mse }) => {
                note("reference", format!("bdpt, {samples} samples a pixel, {seconds:.0} s"));
                if let Some(own) = rel_mse {
                    note("reference's own relMSE", format!("{own:.2e}"));
                }
            }
            None => note("reference", self.reference.from.clone()),
        }
        if self.stopped {
            note("stopped early", "the last integrator has had less time than the others".to_owned());
        }
        notes
    }

    fn entry(&self, entrant: &Entrant) -> Entry {
        let Entrant { method, picture, report, errors: e, flip, curve, .. } = entrant;
        let seconds = report.seconds;
        Entry {
            shown: self.shown(&method.name, &picture.combined(caustica_film::LightImage::On)),
            label: method.label.clone(),
            metrics: Metrics {
                rel_mse: Some(e.rel_mse),
                trimmed_rel_mse: Some(e.trimmed_rel_mse),
                rmse: Some(e.rmse),
                flip: flip.as_ref().map(|m| m.mean),
                mean: e.mean,
                samples: report.samples as f64,
                seconds,
                efficiency: Some(1.0 / (e.rel_mse * seconds)).filter(|x| x.is_finite()),
            },
            flip_map: flip.as_ref().map(|m| m.values.clone()),
            slope: slope(curve),
            curve: curve.clone(),
        }
    }

    /// How much sooner each method has the error that each other one ends with, of those that reach all light.
    fn speedups(&self) -> Result<Vec<Speedup>, CompareError> {
        let [width, height] = self.size;
        let reference = Image::new(width, height, &self.reference.pixels)?;
        let mean = errors(reference, reference)?.mean;
        let whole = |e: &&Entrant| (e.errors.mean - mean).abs() <= LOST * mean;
        let racers: Vec<&Entrant> = self.entrants.iter().filter(whole).collect();
        let pairs = racers.iter().flat_map(|faster| racers.iter().map(move |slower| (*faster, *slower)));
        Ok(pairs.filter(|(a, b)| a.method.name != b.method.name).filter_map(speedup).collect())
    }
}

fn speedup((faster, slower): (&Entrant, &Entrant)) -> Option<Speedup> {
    let (seconds, at_least) = match time_to_reach(&faster.curve, slower.errors.rel_mse)? {
        Reached::At(seconds) => (seconds, false),
        Reached::Before(seconds) => (seconds, true),
    };
    let factor = slower.report.seconds / seconds;
    let (faster, slower) = (faster.method.name.clone(), slower.method.name.clone());
    Some(Speedup { faster, slower, factor, at_least })
}

fn inset((i, r): (usize, Region)) -> Inset {
    let label = format!("Region {}", i + 1);
    Inset { label, x: r.x, y: r.y, width: r.width, height: r.height }
}
