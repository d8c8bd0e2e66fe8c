//! Estimates of a picture in blocks, with their variances, and tests that two of them agree.

use caustica_math::stats::{Moments, sidak, student_t_test, welch_t_test};
use caustica_math::{Rgb, Vec2};
use caustica_scene::{Description, Scene};
use caustica_transport::{Contribution, Kernel, Scratch, Settings, Sink, Strategy};
use rayon::prelude::*;

/// Sums of one pass, block by block.
struct Blocks<'k, 's> {
    kernel: &'k Kernel<'s>,
    size: u32,
    columns: usize,
    sums: Vec<f64>,
    pixel: [u32; 2],
    /// Adds this strategy's unweighted contributions only.
    only: Option<Strategy>,
}

impl Blocks<'_, '_> {
    fn add(&mut self, pixel: [u32; 2], value: f64) {
        let window = self.kernel.scene().film.window();
        let (x, y) = (pixel[0] - window.x, pixel[1] - window.y);
        self.sums[(y / self.size) as usize * self.columns + (x / self.size) as usize] += value;
    }

    /// Splats through the pixel filter, as a film does.
    fn filtered(&mut self, film: Vec2, value: f64) {
        let (window, filter) = (self.kernel.scene().film.window(), self.kernel.filter());
        let r = filter.radius();
        let range = |c: f32, low: u32, size: u32| {
            let first = (c - r - 0.5).ceil().max(low as f32) as u32;
            let last = (c + r - 0.5).floor().min((low + size) as f32 - 1.0);
            (first, last as i64)
        };
        let (x0, x1) = range(film.x, window.x, window.width);
        let (y0, y1) = range(film.y, window.y, window.height);
        for y in i64::from(y0)..=y1 {
            for x in i64::from(x0)..=x1 {
                let weight = filter.eval(x as f32 + 0.5 - film.x, y as f32 + 0.5 - film.y);
                self.add([x as u32, y as u32], value * f64::from(weight));
            }
        }
    }
}

impl Sink for Blocks<'_, '_> {
    const PROBES: bool = true;

    fn eye(&mut self, value: Rgb) {
        assert!(value.0.iter().all(|c| c.is_finite()), "an eye path carries {value:?}");
        if self.only.is_none() {
            self.add(self.pixel, f64::from(value.luminance()));
        }
    }

    fn splat(&mut self, film: Vec2, value: Rgb) {
        assert!(value.is_valid(), "a light path carries {value:?}");
        if self.only.is_none() {
            self.filtered(film, f64::from(value.luminance()));
        }
    }

    fn contribution(&mut self, c: &Contribution<'_>) {
        assert!(c.weight >= 0.0 && c.weight <= 1.0 + 1e-4, "{}: weight {}", c.strategy, c.weight);
        if self.only == Some(c.strategy) {
            let value = f64::from(Rgb([c.unweighted[0], c.unweighted[1], c.unweighted[2]]).luminance());
            if c.strategy.t >= 2 { self.add(self.pixel, value) } else { self.filtered(c.film, value) }
        }
    }
}

/// A picture's estimate: the luminance of each block, over passes of one sample a pixel.
///
/// Passes of stratified samples depend on each other: the mean's variance is less than what passes tell of it, so that
/// tests by that variance err to the safe side. Light tracing alone is the exception: over twelve seeds, the means of its
/// whole pictures had 1.2 to 1.6 times the variance that passes tell. With fresh seeds its tests fail more often than
/// stated.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// Means and variances over the passes.
    pub blocks: Vec<Moments>,
    /// The whole picture.
    pub whole: Moments,
}

/// What is rendered, and how finely it is compared.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Passes of one sample a pixel.
    pub passes: u32,
    /// Edge of a block in pixels.
    pub block: u32,
    /// Adds up only this strategy, unweighted.
    pub only: Option<Strategy>,
}

/// Renders `plan.passes` passes.
pub fn estimate(scene: &Scene, settings: &Settings, plan: Plan) -> Estimate {
    let kernel = Kernel::new(scene, settings.clone());
    let window = scene.film.window();
    let (columns, rows) = (window.width.div_ceil(plan.block), window.height.div_ceil(plan.block));
    let all =
        (0..window.width * window.height).map(|i| [window.x + i % window.width, window.y + i / window.width]);
    let pixels = kernel.in_groups(all);
    let passes: Vec<Vec<f64>> = (0..plan.passes)
        .into_par_iter()
        .map_init(Scratch::default, |scratch, pass| {
            let mut sink = Blocks {
                kernel: &kernel,
                size: plan.block,
                columns: columns as usize,
                sums: vec![0.0; (columns * rows) as usize],
                pixel: [0, 0],
                only: plan.only,
            };
            for &pixel in &pixels {
                sink.pixel = pixel;
                kernel.sample(pixel, pass, scratch, &mut sink);
            }
            sink.sums
        })
        .collect();
    let area = f64::from(plan.block * plan.block);
    let mut result =
        Estimate { blocks: vec![Moments::default(); (columns * rows) as usize], whole: Moments::default() };
    for sums in passes {
        for (block, sum) in result.blocks.iter_mut().zip(&sums) {
            block.push(sum / area);
        }
        result.whole.push(sums.iter().sum::<f64>() / f64::from(window.width * window.height));
    }
    result
}

/// The scene of a description.
///
/// # Panics
/// If it cannot be made.
pub fn flatten(description: Description) -> Scene {
    match Scene::new(description) {
        Ok((scene, _)) => scene,
        Err(e) => panic!("{e}"),
    }
}

/// The significance level of all agreement tests together, per pair.
pub const SIGNIFICANCE: f64 = 1e-3;

/// Whether two estimates agree in every block by Welch's t-test at [`SIGNIFICANCE`], Šidák-corrected, and in the
/// whole picture.
///
/// # Errors
/// What disagrees, and by how much.
pub fn agree(a: &Estimate, b: &Estimate) -> Result<(), String> {
    let alpha = sidak(SIGNIFICANCE, a.blocks.len() + 1);
    let pairs = a.blocks.iter().zip(&b.blocks).chain([(&a.whole, &b.whole)]);
    for (i, (x, y)) in pairs.enumerate() {
        // Rounding of f32 sums.
        let floor = (1e-6 * x.mean).powi(2);
        let p = welch_t_test(x, y, floor);
        if p < alpha {
            return Err(format!(
                "block {i} of {}: {:.6} ± {:.6} against {:.6} ± {:.6} (p = {p:.2e} < {alpha:.2e})",
                a.blocks.len(),
                x.mean,
                x.variance_of_mean().sqrt(),
                y.mean,
                y.variance_of_mean().sqrt(),
            ));
        }
    }
    Ok(())
}

/// Whether the whole picture's mean is `reference`: within `tolerance` of it (relative) and by Student's t-test at
/// [`SIGNIFICANCE`].
///
/// # Errors
/// What was found.
pub fn is_close(e: &Estimate, reference: f64, tolerance: f64) -> Result<(), String> {
    let relative = (e.whole.mean / reference - 1.0).abs();
    let p = student_t_test(&e.whole, reference);
    if relative > tolerance || p < SIGNIFICANCE {
        return Err(format!("mean {:.6}, expected {reference} (p = {p:.2e})", e.whole.mean));
    }
    Ok(())
}
