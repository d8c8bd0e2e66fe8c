//! How many light paths to join an eye path with, found by rendering a little.
//!
//! Let v₀ + v₁/K be the variance of a sample that is joined with K light paths, and c₀ + c₁·K its cost. The product is least
//! for K² = (c₀/c₁)·(v₁/v₀). The cost of joins differs little between scenes; the variances are measured. v₁ is how much
//! the estimates by single light paths differ that one eye path is joined with.

use caustica_math::{Rgb, Vec2};
use caustica_scene::Scene;
use caustica_scene::description::{Crop, Integrator};

use crate::kernel::{Kernel, Scratch, Settings};
use crate::sink::{Contribution, Sink};

/// Cells of the picture along its longer edge, in each of which a group of pixels is looked at.
const CELLS: u32 = 12;
/// Samples of each pixel.
const SAMPLES: u32 = 8;
/// Light paths that each is joined with meanwhile.
const JOINS: u32 = 4;
/// c₀/c₁: what a sample costs but for its joins, over what those with one light path cost.
const COST: f64 = 7.0;
/// The most that are told: beyond it, joins had too much in common to gain in any scene.
const MOST: u32 = 8;
/// The share of the pixels that is left out: those of the most noise, which is that of rare finds.
const OUTLIERS: f64 = 0.02;
/// So much of the squared mean luminance is added to what variances are relative to.
const DIM: f64 = 0.01;

/// With how many light paths `bdpt` had best join each eye path in that scene: a setting for
/// [`Settings::shared_light_paths`], whose own value has no part in it. It takes some 3000 samples on one thread, and
/// is the same wherever it is asked for. 1 where nothing is joined.
pub fn suited_light_paths(scene: &Scene, settings: &Settings) -> u32 {
    let settings =
        Settings { shared_light_paths: JOINS, integrator: Integrator::Bdpt, seed: 0, ..settings.clone() };
    let kernel = Kernel::new(scene, settings);
    if kernel.shared_light_paths() == 1 {
        return 1;
    }
    let variances = Pilot::new(&kernel).run();
    let squared = COST * variances.joins / variances.rest;
    // The power of two that is nearest, by ratios.
    let mut suited = 1;
    while suited < MOST && squared > f64::from(2 * suited * suited) {
        suited *= 2;
    }
    suited
}

/// Variances of a sample, relative to the brightness squared, summed over the pixels.
#[derive(Clone, Copy, Debug, Default)]
struct Variances {
    /// v₁.
    joins: f64,
    /// v₀.
    rest: f64,
}

/// What is known of a pixel.
struct Looked {
    cell: usize,
    mean: f64,
    /// Of its eye image.
    variance: f64,
    joins: f64,
}

struct Pilot<'k, 's> {
    kernel: &'k Kernel<'s>,
    window: Crop,
    /// Edge of a cell in pixels.
    edge: u32,
    columns: u32,
}

impl<'k, 's> Pilot<'k, 's> {
    fn new(kernel: &'k Kernel<'s>) -> Self {
        let window = kernel.scene().film.window();
        let edge = window.width.max(window.height).div_ceil(CELLS);
        Self { kernel, window, edge, columns: window.width.div_ceil(edge) }
    }

    /// The pixels in the middle of each cell that share light paths.
    fn pixels(&self) -> Vec<[u32; 2]> {
        let w = self.window;
        let middles = |start: u32, size: u32| {
            (0..size.div_ceil(self.edge)).map(move |i| start + (i * self.edge + self.edge / 2).min(size - 1))
        };
        let inside = |p: &[u32; 2]| p[0].wrapping_sub(w.x) < w.width && p[1].wrapping_sub(w.y) < w.height;
        let mut pixels: Vec<_> = middles(w.y, w.height)
            .flat_map(|y| middles(w.x, w.width).map(move |x| [x, y]))
            .flat_map(|pixel| self.kernel.groups.of(pixel).filter(inside))
            .collect();
        pixels.sort_unstable();
        pixels.dedup();
        self.kernel.in_groups(pixels.into_iter())
    }

    /// The cell of a film position; `None` outside of the window.
    fn cell(&self, film: Vec2) -> Option<usize> {
        let (x, y) = (film.x - self.window.x as f32, film.y - self.window.y as f32);
        (x >= 0.0 && y >= 0.0 && x < self.window.width as f32 && y < self.window.height as f32)
            .then(|| (y as u32 / self.edge * self.columns + x as u32 / self.edge) as usize)
    }

    fn run(&self) -> Variances {
        let cells = (self.columns * self.window.height.div_ceil(self.edge)) as usize;
        let pixels = self.pixels();
        let mut scratch = Scratch::default();
        let mut listener =
            Listener { pilot: self, eye: 0.0, joined: [0.0; JOINS as usize], splats: vec![[0.0; 2]; cells] };
        let mut looked = Vec::with_capacity(pixels.len());
        for &pixel in &pixels {
            let n = f64::from(SAMPLES);
            let (mut sum, mut squares, mut joins) = (0.0, 0.0, 0.0);
            for sample in 0..SAMPLES {
                (listener.eye, listener.joined) = (0.0, [0.0; JOINS as usize]);
                self.kernel.sample(pixel, sample, &mut scratch, &mut listener);
                sum += listener.eye;
                squares += listener.eye * listener.eye;
                joins += listener.variance_of_joins();
            }
            let mean = sum / n;
            let variance = ((squares - n * mean * mean) / (n - 1.0)).max(0.0);
            let [x, y] = pixel.map(|c| c as f32 + 0.5);
            let Some(cell) = self.cell(Vec2::new(x, y)) else { continue };
            looked.push(Looked { cell, mean, variance, joins: joins / n });
        }
        self.add_up(&looked, &listener.splats)
    }

    fn add_up(&self, looked: &[Looked], splats: &[[f64; 2]]) -> Variances {
        // As many light paths as pixels make a pass; what each pixel of a cell has of it.
        let pass = f64::from(self.window.width) * f64::from(self.window.height);
        let paths = looked.len() as f64 * f64::from(SAMPLES);
        let share = pass / paths / f64::from(self.edge * self.edge);
        let mut means = vec![[0.0; 2]; splats.len()];
        for pixel in looked {
            means[pixel.cell][0] += pixel.mean;
            means[pixel.cell][1] += 1.0;
        }
        let mean = |cell: usize| means[cell][0] / f64::max(means[cell][1], 1.0) + splats[cell][0] * share;
        let all = looked.iter().map(|pixel| mean(pixel.cell)).sum::<f64>() / looked.len() as f64;
        let relative = |pixel: &Looked| {
            let brightness = mean(pixel.cell) * mean(pixel.cell) + DIM * all * all;
            let joins = f64::from(self.kernel.shared_light_paths());
            let rest = (pixel.variance - pixel.joins / joins).max(0.0);
            Variances {
                joins: pixel.joins / brightness,
                rest: (rest + splats[pixel.cell][1] * share) / brightness,
            }
        };
        let mut each: Vec<Variances> =
            looked.iter().map(relative).filter(|v| (v.joins + v.rest).is_finite()).collect();
        each.sort_by(|a, b| f64::total_cmp(&(a.joins + a.rest), &(b.joins + b.rest)));
        each.truncate(each.len() - (OUTLIERS * each.len() as f64) as usize);
        each.iter().fold(Variances::default(), |all, v| Variances {
            joins: all.joins + v.joins,
            rest: all.rest + v.rest,
        })
    }
}

/// Takes down one sample, and all splats.
struct Listener<'p, 'k, 's> {
    pilot: &'p Pilot<'k, 's>,
    eye: f64,
    /// What each light path brought by joins.
    joined: [f64; JOINS as usize],
    /// Sums of luminances and of their squares, by cell.
    splats: Vec<[f64; 2]>,
}

impl Listener<'_, '_, '_> {
    /// The variance of the estimates that the light paths make one by one.
    fn variance_of_joins(&self) -> f64 {
        let n = self.pilot.kernel.shared_light_paths() as usize;
        let mean = self.joined.iter().sum::<f64>();
        let squares: f64 = self.joined[..n].iter().map(|x| (x * n as f64 - mean).powi(2)).sum();
        squares / (n - 1) as f64
    }
}

impl Sink for Listener<'_, '_, '_> {
    const PROBES: bool = true;

    fn eye(&mut self, value: Rgb) {
        let luminance = f64::from(value.luminance());
        self.eye = if luminance.is_finite() { luminance } else { 0.0 };
    }

    fn splat(&mut self, film: Vec2, value: Rgb) {
        let luminance = f64::from(value.luminance());
        if let Some(cell) = self.pilot.cell(film).filter(|_| luminance.is_finite()) {
            self.splats[cell][0] += luminance;
            self.splats[cell][1] += luminance * luminance;
        }
    }

    fn contribution(&mut self, c: &Contribution<'_>) {
        if c.strategy.s > 1 && c.strategy.t > 1 {
            let value = self.pilot.kernel.rgb(c.unweighted * (c.weight * c.filter_weight));
            self.joined[c.light_path] += f64::from(value.luminance());
        }
    }
}
