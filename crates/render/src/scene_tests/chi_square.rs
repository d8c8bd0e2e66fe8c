use std::f64::consts::PI;

use caustica_import::TestKind;
use caustica_math::chi_square::{Cell, Integrand, spherical};
use caustica_math::stats::{chi_square_test, sidak};
use caustica_math::{SampleStream, StreamId, Vec3, warp};
use caustica_scene::Diagnostic;
use caustica_scene::bsdf::{Bsdf, Walk};

use super::parallel::for_all;
use super::{Job, Outcome, bsdf, bsdf_name, figure, stream_seed};

/// Samples a cell where the file does not say how many.
const SAMPLES_PER_CELL: u64 = 5000;
/// How many samples are held at a time.
const BATCH: u64 = 1 << 16;
/// How many samples guide the quadrature.
const GUIDES: u64 = 1 << 20;

/// Runs a `chi2test`.
pub(super) fn run(job: &Job<'_>, tell: &mut dyn FnMut(Outcome)) {
    let TestKind::Chi2Test { resolution, min_exp_frequency, sample_count, test_count } = job.test.kind else {
        return;
    };
    let stage = &job.test.stage;
    let rows = resolution as usize;
    let plan = Plan {
        rows,
        samples: sample_count.unwrap_or((2 * rows * rows) as u64 * SAMPLES_PER_CELL),
        minimum: f64::from(min_exp_frequency),
        alpha: sidak(job.test.significance, test_count as usize * stage.materials.len()),
        threads: job.threads,
    };
    for (index, material) in stage.materials.iter().enumerate() {
        let (name, origin) = (bsdf_name(stage, index), material.origin.as_ref());
        let bsdf = match bsdf(stage, index) {
            Ok(bsdf) if bsdf.is_delta() => Err(Diagnostic::error(
                "it scatters into single directions only, and has no density that could be tested",
            )
            .hint("a `ttest` with `angles` can test it")),
            bsdf => bsdf,
        };
        let bsdf = match bsdf {
            Ok(bsdf) => bsdf,
            Err(why) => {
                tell(job.refusal(&name, origin, &why));
                continue;
            }
        };
        let seed = stream_seed(job.seed, index as u64);
        for direction in 0..test_count {
            let verdict = plan.verdict(&bsdf, stream_seed(seed, direction.into()));
            tell(job.outcome(&format!("{name}, direction {}", direction + 1), origin, verdict));
        }
    }
}

/// How one direction is tested.
struct Plan {
    /// Cells in cos θ; there are twice as many in φ.
    rows: usize,
    samples: u64,
    /// Cells that expect fewer samples are pooled.
    minimum: f64,
    alpha: f64,
    threads: usize,
}

/// The samples in a cell.
#[derive(Clone, Default)]
struct Bin {
    observed: f64,
    expected: f64,
    /// Those that guide the quadrature.
    points: Vec<[f64; 2]>,
}

impl Plan {
    /// Tests one direction.
    fn verdict(&self, bsdf: &Bsdf, seed: u64) -> (bool, String) {
        // The batches of samples take the other numbers of pixels.
        let mut stream = SampleStream::new(StreamId { seed, pixel: u32::MAX, sample: 0, walk: 0 });
        let given = warp::uniform_sphere(stream.next_2d());
        let given = if bsdf.transmits() { given } else { Vec3::new(given.x, given.y, given.z.abs()) };
        let mut bins = self.count(bsdf, given, seed);
        self.integrate(&mut bins, bsdf, given);
        let observed: Vec<f64> = bins.iter().map(|b| b.observed).collect();
        let expected: Vec<f64> = bins.iter().map(|b| b.expected).collect();
        let o = chi_square_test(&observed, &expected, self.minimum, self.samples as f64);
        let passed = o.statistic.is_finite() && o.degrees > 0 && o.p_value >= self.alpha;
        let figures = if o.statistic.is_infinite() {
            "samples where the density is zero, or a density that is no number".to_owned()
        } else if o.degrees == 0 {
            "fewer than two cells expect enough samples to be compared".to_owned()
        } else {
            let [chi, p, a] = [o.statistic, o.p_value, self.alpha].map(figure);
            format!("χ² {chi}, {} degrees of freedom, p-value {p}, α {a}", o.degrees)
        };
        let Vec3 { x, y, z } = given;
        (passed, format!("{figures}, {} samples, given ({x:.4}, {y:.4}, {z:.4})", self.samples))
    }

    /// The samples by cells, row by row. Those that carry no light are left out.
    fn count(&self, bsdf: &Bsdf, given: Vec3, seed: u64) -> Vec<Bin> {
        let mut bins = vec![Bin::default(); 2 * self.rows * self.rows];
        let mut batch = vec![None; self.samples.min(BATCH) as usize];
        for number in 0..self.samples.div_ceil(BATCH) {
            let done = number * BATCH;
            let batch = &mut batch[..(self.samples - done).min(BATCH) as usize];
            for_all(batch, self.threads, &|first, part| {
                for (i, point) in part.iter_mut().enumerate() {
                    let (pixel, sample) = (number as u32, (first + i) as u32);
                    let mut stream = SampleStream::new(StreamId { seed, pixel, sample, walk: 0 });
                    let [u0, u1] = stream.next_2d();
                    *point = bsdf
                        .sample(Walk::FromCamera, given, [u0, u1, stream.next_1d()])
                        // What comes from a Dirac lobe is not in the density.
                        .filter(|s| !s.delta)
                        .map(|s| spherical(s.direction));
                }
            });
            for (i, point) in batch.iter().enumerate() {
                let Some(point) = *point else { continue };
                let bin = &mut bins[self.index(point)];
                bin.observed += 1.0;
                if done + (i as u64) < GUIDES {
                    bin.points.push(point);
                }
            }
        }
        bins
    }

    /// Finds how many samples each bin expects.
    fn integrate(&self, bins: &mut [Bin], bsdf: &Bsdf, given: Vec3) {
        let samples = self.samples as f64;
        let pdf = |direction| f64::from(bsdf.eval(direction, given).to_light_pdf.get());
        let integrand = Integrand {
            pdf: &pdf,
            samples: self.samples.min(GUIDES) as f64,
            // A fiftieth of a sample: far below the noise of the counts.
            tolerance: (0.02 / samples).min(1e-7),
        };
        for_all(bins, self.threads, &|first, part| {
            for (i, bin) in part.iter_mut().enumerate() {
                bin.expected = samples * integrand.over(self.cell(first + i), &mut bin.points);
            }
        });
    }

    /// The cell of that index.
    fn cell(&self, index: usize) -> Cell {
        let columns = 2 * self.rows;
        let (row, column) = ((index / columns) as f64, (index % columns) as f64);
        let cos = |row: f64| 2.0 * row / self.rows as f64 - 1.0;
        let phi = |column: f64| PI * (2.0 * column / columns as f64 - 1.0);
        Cell { cos: [cos(row), cos(row + 1.0)], phi: [phi(column), phi(column + 1.0)] }
    }

    /// The index of the cell around cos θ and φ.
    fn index(&self, [cos, phi]: [f64; 2]) -> usize {
        let place = |share: f64, cells: usize| ((share * cells as f64) as usize).min(cells - 1);
        let columns = 2 * self.rows;
        let row = place(0.5 * (cos + 1.0), self.rows);
        row * columns + place(0.5 * (phi / PI + 1.0), columns)
    }
}
