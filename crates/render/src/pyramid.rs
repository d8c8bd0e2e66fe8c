//! The pyramid: what each strategy of `bdpt` finds, weighted and unweighted, as a picture of its own.

use std::time::Instant;

use caustica_film::{Film, FilmError, Window};
use caustica_math::{MemoryLimit, Rgb, Vec2};
use caustica_scene::Scene;
use caustica_scene::description::Integrator;
use caustica_transport::strategy::Strategy;
use caustica_transport::{Contribution, Kernel, Scratch, Settings, Sink};

use crate::session::{Control, Progress, RenderError, RenderOptions, film_layout};
use crate::workers::{Budget, Units, Workers, pixels};

/// The most edges of paths whose strategies can be kept apart: 152 strategies.
pub const MOST_EDGES: u32 = 16;

/// What the two films of a strategy take, in bytes a pixel.
const BYTES: u64 = 96;

/// A film of every strategy (s, t) of paths of up to some number of edges, one of all longer paths, and one of all
/// together.
///
/// The weighted films and that of the longer paths add up to the whole, to the bit: what a sample adds to a pixel is
/// rounded once, as a whole, and the largest contribution takes what the rounding of the others leaves.
#[derive(Debug)]
pub struct Pyramid<'a> {
    kernel: Kernel<'a>,
    edges: u32,
    layers: Vec<Layer>,
    rest: Film,
    whole: Film,
    options: RenderOptions,
}

/// The films of one strategy.
#[derive(Debug)]
pub struct Layer {
    /// The strategy.
    pub strategy: Strategy,
    /// Its contributions times their MIS weights.
    pub weighted: Film,
    /// Its contributions as they are: the whole light of the paths that it reaches.
    pub unweighted: Film,
}

impl<'a> Pyramid<'a> {
    /// An empty pyramid of paths of up to `edges` edges, which is brought into 1 to [`MOST_EDGES`]. The integrator is
    /// `bdpt`, whatever the options say.
    ///
    /// # Errors
    /// If the films do not fit into memory, with as much again for developing them: they take 96 bytes a pixel and
    /// strategy.
    pub fn new(scene: &'a Scene, options: RenderOptions, edges: u32) -> Result<Self, RenderError> {
        let edges = edges.clamp(1, MOST_EDGES);
        let settings = Settings { integrator: Integrator::Bdpt, ..options.settings.clone() };
        let layout = film_layout(scene, &settings.integrator);
        let strategies = u64::from(edges * (edges + 3) / 2);
        let needed = layout.window.pixels().saturating_mul(2 * BYTES * (strategies + 1));
        if MemoryLimit::Machine.check(needed).is_err() {
            let Window { width, height, .. } = layout.window;
            return Err(FilmError::too_large(width, height, needed).into());
        }
        let layers = (1..=edges)
            .flat_map(|k| (0..=k).map(move |s| Strategy { s, t: k + 1 - s }))
            .map(|strategy| {
                Ok(Layer { strategy, weighted: Film::new(layout)?, unweighted: Film::new(layout)? })
            })
            .collect::<Result<_, FilmError>>()?;
        let (rest, whole) = (Film::new(layout)?, Film::new(layout)?);
        let options = RenderOptions { settings: settings.clone(), ..options };
        Ok(Self { kernel: Kernel::new(scene, settings), edges, layers, rest, whole, options })
    }

    /// The strategies, paths of one edge first; of equal length, those with fewer light vertices first.
    pub fn layers(&self) -> &[Layer] {
        &self.layers
    }

    /// What longer paths add.
    pub fn rest(&self) -> &Film {
        &self.rest
    }

    /// All together: the picture.
    pub fn whole(&self) -> &Film {
        &self.whole
    }

    /// The most edges of the paths whose strategies are kept apart.
    pub fn edges(&self) -> u32 {
        self.edges
    }

    /// Renders as [`Session::run`](crate::Session::run) does. Returns seconds.
    ///
    /// # Errors
    /// If no worker thread can be started.
    pub fn run(&self, control: &Control, progress: impl FnMut(&Progress)) -> Result<f64, RenderError> {
        self.run_for(self.options.budget(), control, progress)
    }

    /// Renders as [`Session::run_for`](crate::Session::run_for) does. Returns seconds.
    ///
    /// # Errors
    /// If no worker thread can be started.
    pub fn run_for(
        &self,
        budget: Budget,
        control: &Control,
        progress: impl FnMut(&Progress),
    ) -> Result<f64, RenderError> {
        let start = Instant::now();
        let threads = self.options.thread_count();
        let (window, done) = (self.whole.layout().window, self.whole.eye_samples());
        let workers = Workers { window, start: 0, done, budget, threads, control };
        let added = workers.run(|units| self.work(units), progress)?;
        let light = if self.kernel.has_light_image() { added } else { 0 };
        let films = self.layers.iter().flat_map(|l| [&l.weighted, &l.unweighted]);
        films.chain([&self.rest, &self.whole]).for_each(|film| film.finish_samples(added, light));
        Ok(start.elapsed().as_secs_f64())
    }

    fn work(&self, units: Units<'_>) {
        let (mut scratch, mut parts) = (Scratch::default(), Vec::new());
        for (pass, tile) in units {
            for pixel in self.kernel.in_groups(pixels(tile)) {
                let mut sink = PyramidSink { pyramid: self, pixel, parts: &mut parts, splat: None };
                self.kernel.sample(pixel, pass, &mut scratch, &mut sink);
            }
        }
    }

    fn layer(&self, strategy: Strategy) -> Option<&Layer> {
        let edges = strategy.s + strategy.t - 1;
        let before = edges * (edges + 1) / 2 - 1;
        (edges <= self.edges).then(|| &self.layers[(before + strategy.s) as usize])
    }
}

/// What one strategy adds to the sample's pixel.
struct Part<'a> {
    layer: Option<&'a Layer>,
    weighted: Rgb,
    unweighted: Rgb,
}

struct PyramidSink<'a, 's, 'b> {
    pyramid: &'a Pyramid<'s>,
    pixel: [u32; 2],
    parts: &'b mut Vec<Part<'a>>,
    /// Of the splats that follow: their strategy's layer, and their value without the weight.
    splat: Option<(Option<&'a Layer>, Rgb)>,
}

impl Sink for PyramidSink<'_, '_, '_> {
    const PROBES: bool = true;

    fn eye(&mut self, value: Rgb) {
        let Self { pyramid, pixel, parts, .. } = self;
        let Some(mut left) = pyramid.whole.quanta(*pixel, value) else {
            // The film counts what is not finite.
            pyramid.whole.add_eye(*pixel, value);
            parts.clear();
            return;
        };
        pyramid.whole.add_eye_quanta(*pixel, left);
        let size = |p: &Part<'_>| p.weighted.0.iter().fold(0.0, |m: f32, c| m.max(c.abs()));
        parts.sort_by(|a, b| size(a).total_cmp(&size(b)));
        let last = parts.len().saturating_sub(1);
        for (i, part) in parts.drain(..).enumerate() {
            let film = part.layer.map_or(&pyramid.rest, |l| &l.weighted);
            let quanta =
                if i == last { left } else { film.quanta(*pixel, part.weighted).unwrap_or_default() };
            film.add_eye_quanta(*pixel, quanta);
            left = [0, 1, 2].map(|c| left[c] - quanta[c]);
            if let Some(layer) = part.layer {
                layer.unweighted.add_eye(*pixel, part.unweighted);
            }
        }
    }

    fn splat(&mut self, film: Vec2, value: Rgb) {
        let Some((layer, unweighted)) = self.splat else { return };
        let filter = self.pyramid.kernel.filter();
        self.pyramid.whole.splat_light(filter, film, value);
        layer.map_or(&self.pyramid.rest, |l| &l.weighted).splat_light(filter, film, value);
        if let Some(layer) = layer {
            layer.unweighted.splat_light(filter, film, unweighted);
        }
    }

    fn invalid(&mut self) {
        self.pyramid.whole.add_eye(self.pixel, Rgb::splat(f32::NAN));
    }

    fn contribution(&mut self, c: &Contribution<'_>) {
        let layer = self.pyramid.layer(c.strategy);
        let unweighted = c.unweighted * c.filter_weight;
        let rgb = |value| self.pyramid.kernel.rgb(value);
        if c.strategy.t == 1 {
            self.splat = Some((layer, rgb(unweighted)));
        } else {
            let weighted = rgb(unweighted * c.weight);
            self.parts.push(Part { layer, weighted, unweighted: rgb(unweighted) });
        }
    }
}
