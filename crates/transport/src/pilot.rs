//! How many light paths to join an eye path with, found by rendering a little.
//!
//! Let v₀ + v₁/K be the variance of a sample that is joined with K light paths, and c₀ + c₁·K its cost. The product is least
//! for K² = (c₀/c₁)·(v₁/v₀). All four are measured: v₁ is how much the estimates by single light paths differ that one eye
//! path is joined with; costs are counted in vertices and in pairs of them, for clocks differ. That weights depend on K too is
//! left out of account.

use caustica_math::{Rgb, Vec2};
use caustica_scene::Scene;
use caustica_scene::description::{Crop, Integrator};

use crate::kernel::{Kernel, Scratch, Settings};
use crate::shared::Groups;
use crate::sink::{Contribution, Sink};
use crate::walk::Subpath;

/// About so many cells of the picture, in each of which a group of pixels is looked at.
const CELLS: f64 = 108.0;
/// Samples of each pixel, if they are not too long.
const SAMPLES: u32 = 12;
/// Samples of each pixel, however long they are.
const LEAST_SAMPLES: u32 = 2;
/// No sample more is begun after so much work.
const MOST_WORK: f64 = 1e6;
/// Light paths that each is joined with meanwhile.
const JOINS: u32 = 4;
/// What a pair of vertices costs beside a vertex of a path: fitted to times of the gallery's scenes.
const PAIR: f64 = 0.16;
/// The most that are told: beyond it, joins had too much in common to gain in any scene.
const MOST: u32 = 8;
/// The share of the pixels that is left out: those of the most noise, which is that of rare finds.
const OUTLIERS: f64 = 0.02;
/// So much of the squared mean luminance is added to what variances are relative to.
const DIM: f64 = 0.01;
/// Of samples that nobody else is likely to render.
const SEED: u64 = 0x5e1f_9ae3_07c4_66b1;

/// With how many light paths `bdpt` had best join each eye path in that scene: a setting for
/// [`Settings::shared_light_paths`], whose own value has no part in it, nor has the seed. It takes up to 6000 samples on one
/// thread, fewer where they are long, and is the same wherever it is asked for. 1 where nothing is joined.
pub fn suited_light_paths(scene: &Scene, settings: &Settings) -> u32 {
    let settings =
        Settings { shared_light_paths: JOINS, integrator: Integrator::Bdpt, seed: SEED, ..settings.clone() };
    let kernel = Kernel::new(scene, settings);
    if kernel.shared_light_paths() == 1 {
        return 1;
    }
    let Measured { joins, rest, pairs, vertices } = Pilot::new(&kernel).run();
    let squared = vertices / (PAIR * pairs) * (joins / rest.max(0.0));
    // The power of two that is nearest, by ratios.
    let mut suited = 1;
    let most = Groups::new(scene.film.window(), MOST).size();
    while suited < most && squared > f64::from(2 * suited * suited) {
        suited *= 2;
    }
    suited
}

/// Variances of a sample, relative to the brightness squared, summed over the pixels; and the work of all samples.
#[derive(Clone, Copy, Debug, Default)]
struct Measured {
    /// v₁.
    joins: f64,
    /// v₀.
    rest: f64,
    /// Of vertices of an eye path and of one light path.
    pairs: f64,
    /// Of an eye path and its own light path, with the ends.
    vertices: f64,
}

/// What is known of a pixel.
#[derive(Clone, Copy, Debug, Default)]
struct Looked {
    cell: usize,
    /// Sums over samples, of its eye image.
    sum: f64,
    squares: f64,
    /// The sum of the variances of what single light paths brought.
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
        let area = f64::from(window.width) * f64::from(window.height);
        let edge = ((area / CELLS).sqrt() as u32).max(1);
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
        (x >= 0.0 && y >= 0.0 && x < self.window.width as f32 && y < self.window.height as f32).then(|| {
            y as usize / self.edge as usize * self.columns as usize + x as usize / self.edge as usize
        })
    }

    /// Pixels of a cell, of which some at the borders have fewer.
    fn area(&self, cell: usize) -> f64 {
        let [column, row] = [cell as u32 % self.columns, cell as u32 / self.columns];
        let side = |at: u32, size: u32| f64::from((size - at * self.edge).min(self.edge));
        side(column, self.window.width) * side(row, self.window.height)
    }

    fn run(&self) -> Measured {
        let cells = self.columns as usize * self.window.height.div_ceil(self.edge) as usize;
        let pixels = self.pixels();
        let mut scratch = Scratch::default();
        let mut listener =
            Listener { pilot: self, eye: 0.0, joined: [0.0; JOINS as usize], splats: vec![[0.0; 2]; cells] };
        let mut looked = vec![Looked::default(); pixels.len()];
        let mut measured = Measured::default();
        let mut samples = 0;
        while samples < LEAST_SAMPLES
            || samples < SAMPLES && measured.vertices + PAIR * measured.pairs < MOST_WORK
        {
            for (&pixel, looked) in pixels.iter().zip(&mut looked) {
                (listener.eye, listener.joined) = (0.0, [0.0; JOINS as usize]);
                self.kernel.sample(pixel, samples, &mut scratch, &mut listener);
                looked.sum += listener.eye;
                looked.squares += listener.eye * listener.eye;
                looked.joins += listener.variance_of_joins();
                measured.count(&scratch);
            }
            samples += 1;
        }
        for (pixel, looked) in pixels.iter().zip(&mut looked) {
            let [x, y] = pixel.map(|c| c as f32 + 0.5);
            looked.cell = self.cell(Vec2::new(x, y)).unwrap_or_default();
        }
        self.add_up((&looked, f64::from(samples)), &listener.splats, measured)
    }

    fn add_up(&self, (looked, n): (&[Looked], f64), splats: &[[f64; 2]], work: Measured) -> Measured {
        // As many light paths as pixels make a pass; what each pixel of a cell has of it.
        let pass = f64::from(self.window.width) * f64::from(self.window.height);
        let share = |cell: usize| pass / (looked.len() as f64 * n) / self.area(cell);
        let mut means = vec![[0.0; 2]; splats.len()];
        for pixel in looked {
            means[pixel.cell][0] += pixel.sum / n;
            means[pixel.cell][1] += 1.0;
        }
        let mean =
            |cell: usize| means[cell][0] / f64::max(means[cell][1], 1.0) + splats[cell][0] * share(cell);
        let all = looked.iter().map(|pixel| mean(pixel.cell)).sum::<f64>() / looked.len() as f64;
        let blurred = self.kernel.filter().square_integral();
        let lights = f64::from(self.kernel.shared_light_paths());
        // v₁ and v₀.
        let relative = |pixel: &Looked| {
            let brightness = mean(pixel.cell) * mean(pixel.cell) + DIM * all * all;
            let variance = (pixel.squares - pixel.sum * pixel.sum / n) / (n - 1.0);
            let joins = pixel.joins / n;
            let splats = splats[pixel.cell][1] * share(pixel.cell) * blurred;
            [joins / brightness, (variance - joins / lights + splats) / brightness]
        };
        let mut each: Vec<[f64; 2]> =
            looked.iter().map(relative).filter(|[joins, rest]| (joins + rest).is_finite()).collect();
        each.sort_by(|a, b| f64::total_cmp(&(a[0] + a[1]), &(b[0] + b[1])));
        each.truncate(each.len() - (OUTLIERS * each.len() as f64) as usize);
        let [joins, rest] = each.iter().fold([0.0; 2], |all, v| [all[0] + v[0], all[1] + v[1]]);
        Measured { joins, rest, ..work }
    }
}

impl Measured {
    /// Adds the work of the last sample.
    fn count(&mut self, scratch: &Scratch) {
        let joinable = |path: &Subpath| path.vertices.iter().filter(|v| v.is_connectible()).count() as f64;
        let eye = joinable(&scratch.eye);
        let lights = scratch.lights.paths();
        let each = lights.len().max(1) as f64;
        let grown: f64 = lights.iter().map(|light| light.path.vertices.len() as f64).sum();
        self.vertices += 2.0 + scratch.eye.vertices.len() as f64 + grown / each;
        self.pairs += eye * lights.iter().map(|light| joinable(&light.path)).sum::<f64>() / each;
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
    const KEEPS_ALL: bool = false;

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
