//! What was rendered, and its measures.

use caustica_film::{Metadata, Picture};
use caustica_math::Rgb;
use caustica_metrics::{Image, MetricsError, errors, flip, relative_error_map};
use caustica_render::{RenderError, Report};
use caustica_report::{Comparison, CurvePoint, Entry, Inset, Metrics, Shown, Speedup};

use crate::curve::{Point, slope, time_to_reach};
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
    Render(RenderError),
    /// Measuring.
    #[error(transparent)]
    Metrics(#[from] MetricsError),
}

/// What the pictures should look like.
#[derive(Clone, Debug)]
pub struct Reference {
    /// What it is called.
    pub name: String,
    /// Its pixels.
    pub pixels: Vec<Rgb>,
    /// Those of its two independent halves, if it was made here.
    pub halves: Option<[Vec<Rgb>; 2]>,
    /// Samples per pixel and seconds, if it was made here.
    pub made: Option<(u64, f64)>,
}

/// One method's picture.
#[derive(Clone, Debug)]
pub struct Entrant {
    /// The method.
    pub method: Method,
    /// Its picture at the end.
    pub picture: Picture,
    /// How it was made.
    pub metadata: Metadata,
    /// What the session tells.
    pub report: Report,
    pub(crate) moments: Vec<Moment>,
}

/// The picture at one moment.
#[derive(Clone, Debug)]
pub(crate) struct Moment {
    pub seconds: f64,
    pub samples: u64,
    pub pixels: Vec<Rgb>,
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
}

/// Insets on a page.
const INSETS: usize = 4;

impl Outcome {
    /// Measures everything: what a page shows. `notes` are added to those about the reference.
    ///
    /// # Errors
    /// A reference that is not finite.
    pub fn page(
        &self,
        title: &str,
        scene: &str,
        notes: Vec<(String, String)>,
    ) -> Result<Comparison, CompareError> {
        let mut all_notes = notes;
        all_notes.extend(self.reference_notes()?);
        let mut entries = Vec::new();
        let mut maps = Vec::new();
        for entrant in &self.entrants {
            entries.push(self.entry(entrant)?);
            maps.push(relative_error_map(
                self.image(&entrant.last().pixels)?,
                self.image(&self.reference.pixels)?,
            )?);
        }
        let insets = most_different(self.size, &maps, INSETS);
        Ok(Comparison {
            title: title.to_owned(),
            scene: scene.to_owned(),
            notes: all_notes,
            reference: Some(self.shown(&self.reference.name, &self.reference.pixels)),
            speedups: speedups(&entries, self.mean()?),
            entries,
            insets: insets.into_iter().enumerate().map(inset).collect(),
        })
    }

    /// The reference's mean luminance.
    fn mean(&self) -> Result<f64, CompareError> {
        let reference = self.image(&self.reference.pixels)?;
        Ok(errors(reference, reference)?.mean)
    }

    fn image<'a>(&self, pixels: &'a [Rgb]) -> Result<Image<'a>, MetricsError> {
        Image::new(self.size[0], self.size[1], pixels)
    }

    fn shown(&self, name: &str, pixels: &[Rgb]) -> Shown {
        let [width, height] = self.size;
        Shown { name: name.to_owned(), width, height, pixels: pixels.to_vec() }
    }

    /// How the reference was made, and its own error: that of the mean of two halves is a quarter of what they differ
    /// by.
    fn reference_notes(&self) -> Result<Vec<(String, String)>, CompareError> {
        let mut notes = Vec::new();
        if let Some((samples, seconds)) = self.reference.made {
            notes.push(("reference".into(), format!("bdpt, {samples} samples a pixel, {seconds:.0} s")));
        }
        if let Some([a, b]) = &self.reference.halves {
            let between = errors(self.image(a)?, self.image(b)?)?;
            notes.push(("reference's own relMSE".into(), format!("about {:.2e}", between.rel_mse / 4.0)));
        }
        Ok(notes)
    }

    fn entry(&self, entrant: &Entrant) -> Result<Entry, CompareError> {
        let reference = self.image(&self.reference.pixels)?;
        let last = entrant.last();
        let image = self.image(&last.pixels)?;
        let e = errors(image, reference)?;
        // A black reference has no exposure to look at it by.
        let map = flip::hdr(image, reference, &flip::Options::default()).ok();
        let curve = self.curve(entrant)?;
        let seconds = last.seconds;
        Ok(Entry {
            shown: self.shown(&entrant.method.name, &last.pixels),
            label: entrant.method.label.clone(),
            metrics: Metrics {
                rel_mse: Some(e.rel_mse),
                trimmed_rel_mse: Some(e.trimmed_rel_mse),
                rmse: Some(e.rmse),
                flip: map.as_ref().map(|m| m.mean),
                mean: e.mean,
                samples: last.samples as f64,
                seconds,
                efficiency: Some(1.0 / (e.rel_mse * seconds)).filter(|x| x.is_finite()),
            },
            flip_map: map.map(|m| m.values),
            slope: slope(&curve),
            curve: curve.iter().map(curve_point).collect(),
        })
    }

    fn curve(&self, entrant: &Entrant) -> Result<Vec<Point>, CompareError> {
        let reference = self.image(&self.reference.pixels)?;
        let point = |m: &Moment| {
            let e = errors(self.image(&m.pixels)?, reference)?;
            let (rel_mse, trimmed_rel_mse) = (e.rel_mse, e.trimmed_rel_mse);
            Ok(Point { seconds: m.seconds, samples: m.samples, rel_mse, trimmed_rel_mse })
        };
        entrant.moments.iter().map(point).collect()
    }
}

impl Entrant {
    /// The picture at the end: rendering makes one moment at least.
    fn last(&self) -> &Moment {
        &self.moments[self.moments.len() - 1]
    }
}

fn curve_point(p: &Point) -> CurvePoint {
    CurvePoint {
        seconds: p.seconds,
        samples: p.samples as f64,
        rel_mse: p.rel_mse,
        trimmed_rel_mse: p.trimmed_rel_mse,
    }
}

fn inset((i, r): (usize, Region)) -> Inset {
    let label = format!("{}", i + 1);
    Inset { label, x: r.x, y: r.y, width: r.width, height: r.height }
}

/// A method whose mean is farther off than this share does not reach all light: its error does not fall for long.
const LOST: f64 = 0.05;

/// How much sooner the best method of those that reach all light has the error that each other one ends with.
fn speedups(entries: &[Entry], mean: f64) -> Vec<Speedup> {
    let error = |e: &Entry| e.metrics.rel_mse.filter(|x| !x.is_nan()).unwrap_or(f64::INFINITY);
    let whole = |e: &&Entry| (e.metrics.mean - mean).abs() <= LOST * mean;
    let best = entries.iter().filter(whole).min_by(|a, b| error(a).total_cmp(&error(b)));
    let Some(best) = best else { return Vec::new() };
    let curve: Vec<Point> = best
        .curve
        .iter()
        .map(|p| Point {
            seconds: p.seconds,
            samples: p.samples as u64,
            rel_mse: p.rel_mse,
            trimmed_rel_mse: p.trimmed_rel_mse,
        })
        .collect();
    entries
        .iter()
        .filter(|e| e.shown.name != best.shown.name)
        .filter_map(|e| {
            let factor = e.metrics.seconds / time_to_reach(&curve, error(e))?;
            let (faster, slower) = (best.shown.name.clone(), e.shown.name.clone());
            Some(Speedup { faster, slower, factor })
        })
        .collect()
}
