//! Layers beside a picture, of what its samples see first.

use std::ops::Range;
use std::sync::Mutex;

use caustica_film::{Channel, FilmError, Window};
use caustica_math::MemoryLimit;
use caustica_scene::description::Layer;
use caustica_transport::Kernel;

use crate::session::{Control, RenderError, Session};
use crate::workers::{Budget, Workers, pixels};

/// The most samples of each pixel that layers are made of.
pub const MOST_LAYER_SAMPLES: u32 = 64;

/// Where weights of the filter cancel to less than this part of them, their signs do not count.
const LEAST_LEFT: f64 = 0.25;

impl Session<'_> {
    /// The layers of the picture, one channel after the other: by the first of its samples, at most
    /// [`MOST_LAYER_SAMPLES`] of each pixel, whose rays are traced again to the first surface. Values are means by the
    /// pixel filter; numbers of shapes and triangles are those of the sample next to the pixel's centre. They depend
    /// on neither threads nor pauses.
    ///
    /// # Errors
    /// As [`Session::check_layers`], and if no thread can be started.
    pub fn layers(&self, layers: &[Layer]) -> Result<Vec<Channel>, RenderError> {
        let names = self.check_layers(layers)?;
        let window = self.film().layout().window;
        if layers.is_empty() {
            return Ok(Vec::new());
        }
        let range = self.range();
        let samples = range.start as u32..range.end.min(range.start + u64::from(MOST_LAYER_SAMPLES)) as u32;
        let planes = names.len();
        let done: Mutex<Vec<Vec<f32>>> = Mutex::new(vec![vec![0.0; window.pixels() as usize]; planes]);
        let workers = Workers {
            window,
            start: 0,
            done: 0,
            budget: Budget { samples: 1, time: None },
            threads: self.threads(),
            control: &Control::default(),
        };
        workers.run(
            |units| {
                for (_, tile) in units {
                    let values = of_tile(self.kernel(), tile, (layers, planes), samples.clone());
                    let mut done = done.lock().unwrap_or_else(|e| e.into_inner());
                    place(&mut done, window, (tile, &values));
                }
            },
            |_| (),
        )?;
        let done = done.into_inner().unwrap_or_else(|e| e.into_inner());
        Ok(names.into_iter().zip(done).map(|(name, values)| Channel { name, values }).collect())
    }

    /// The names of the layers' channels, if they can be made: to be asked before hours of work, not after.
    ///
    /// # Errors
    /// What [`Layer::check_all`] refuses, and layers that do not fit into memory.
    pub fn check_layers(&self, layers: &[Layer]) -> Result<Vec<String>, RenderError> {
        Layer::check_all(layers).map_err(FilmError::Layout)?;
        let names: Vec<String> = layers.iter().flat_map(Layer::channels).collect();
        let window = self.film().layout().window;
        // Once as they are made, and once as they are written.
        let bytes = 2 * window.pixels() * 4 * names.len() as u64;
        match MemoryLimit::Machine.check(bytes) {
            Ok(()) => Ok(names),
            Err(_) => Err(FilmError::too_large(window.width, window.height, bytes).into()),
        }
    }
}

/// The values of a tile's pixels, one pixel after the other.
fn of_tile(
    kernel: &Kernel<'_>,
    tile: Window,
    (layers, planes): (&[Layer], usize),
    samples: Range<u32>,
) -> Vec<f32> {
    let mut all = Vec::with_capacity(tile.pixels() as usize * planes);
    let mut values = Vec::new();
    let mut means = Means::new(layers, planes);
    for pixel in pixels(tile) {
        means.clear();
        for sample in samples.clone() {
            let seen = kernel.look(pixel, sample, layers, &mut values);
            let (x, y) = (seen.offset.x, seen.offset.y);
            means.add(f64::from(seen.weight), (x * x + y * y, &values));
        }
        means.finish(&mut all);
    }
    all
}

/// Copies a tile's values to where they belong.
fn place(planes: &mut [Vec<f32>], window: Window, (tile, values): (Window, &[f32])) {
    let count = planes.len();
    for (values, [x, y]) in values.chunks(count).zip(pixels(tile)) {
        let at = (y - window.y) as usize * window.width as usize + (x - window.x) as usize;
        for (plane, value) in planes.iter_mut().zip(values) {
            plane[at] = *value;
        }
    }
}

/// The means of a pixel.
struct Means {
    /// Of each channel, whether it is a number of something.
    is_index: Vec<bool>,
    /// Sums with the filter's weights, and with their sizes alone.
    sums: Vec<[f64; 2]>,
    weights: [f64; 2],
    /// The values of the sample next to the centre, and its squared distance.
    next: (f32, Vec<f32>),
}

impl Means {
    fn new(layers: &[Layer], planes: usize) -> Self {
        let indices = layers.iter().flat_map(|l| l.kind.channels().iter().map(|_| l.kind.is_index()));
        let next = (f32::INFINITY, vec![0.0; planes]);
        Self { is_index: indices.collect(), sums: vec![[0.0; 2]; planes], weights: [0.0; 2], next }
    }

    fn clear(&mut self) {
        self.sums.fill([0.0; 2]);
        self.weights = [0.0; 2];
        self.next.0 = f32::INFINITY;
        self.next.1.fill(0.0);
    }

    fn add(&mut self, weight: f64, (distance, values): (f32, &[f32])) {
        let weights = [weight, weight.abs()];
        for i in 0..2 {
            self.weights[i] += weights[i];
            for (sum, value) in self.sums.iter_mut().zip(values) {
                sum[i] += weights[i] * f64::from(*value);
            }
        }
        if distance < self.next.0 {
            self.next.0 = distance;
            self.next.1.copy_from_slice(values);
        }
    }

    fn finish(&self, all: &mut Vec<f32>) {
        let by = usize::from(self.weights[0] < LEAST_LEFT * self.weights[1]);
        let weight = self.weights[by];
        all.extend(self.is_index.iter().zip(&self.sums).zip(&self.next.1).map(
            |((is_index, sum), next)| match () {
                () if *is_index => *next,
                () if weight > 0.0 => (sum[by] / weight) as f32,
                () => 0.0,
            },
        ));
    }
}
