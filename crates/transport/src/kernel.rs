//! The kernel: a scene with the settings that it is rendered by.

use std::sync::atomic::{AtomicU64, Ordering};

use caustica_math::filter::PixelFilter;
use caustica_math::{Rgb, SampleId, Sampler, Spectrum, Vec2, Wavelengths};
use caustica_scene::Scene;
use caustica_scene::bvh::Ray;
use caustica_scene::camera::{CameraRay, Joins};
use caustica_scene::description::Integrator;

use crate::bdpt::Candidates;
use crate::numbers::{EyeNumbers, Needs};
use crate::shared::{Groups, LightPaths};
use crate::sink::Sink;
use crate::strategy::{Classes, StrategySet};
use crate::vertex::Vertex;
use crate::walk::{Flight, Subpath};
use crate::weight::{Heuristic, VertexDensities};

/// How a scene is rendered.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The algorithm.
    pub integrator: Integrator,
    /// The most edges that a path may have: 1 is lamps seen directly, 2 adds direct light. `None`: no limit.
    pub max_depth: Option<u32>,
    /// After how many bounces roulette begins. `None`: at the first for `bdpt` and `light`, whose cost grows with
    /// every pair of vertices, and at the fifth for the others.
    pub roulette_start: Option<u32>,
    /// The seed of all sample streams.
    pub seed: u64,
    /// How samples are chosen.
    pub sampler: Sampler,
    /// The strategies that `bdpt` uses.
    pub strategies: StrategySet,
    /// How `bdpt` weighs them.
    pub heuristic: Heuristic,
    /// Whether `bdpt` adds up all strategies for every weight, instead of running sums: slower, the same up to
    /// rounding. Sets that are no union of classes need it and get it anyway.
    pub exhaustive_weights: bool,
    /// How many rays `bdpt` aims at mirrors and glass from each point of an eye path from where no other strategy makes
    /// a path; at most [`Settings::MOST_AIMED_RAYS`]. Weights that add up all strategies go without.
    pub aimed_rays: u32,
    /// How many light paths `bdpt` joins each eye path with: its own and those of pixels some way off. A power of two from
    /// 1 to [`Settings::MOST_SHARED_LIGHT_PATHS`]; anything else counts as the next that is smaller (0 as 1). There may be
    /// fewer in windows of less than eight pixels in width or height, see [`Kernel::shared_light_paths`]. How many
    /// pay depends on the scene: [`suited_light_paths`](crate::suited_light_paths) advises on it.
    pub shared_light_paths: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            integrator: Integrator::Bdpt,
            max_depth: None,
            roulette_start: None,
            seed: 0,
            sampler: Sampler::default(),
            strategies: StrategySet::default(),
            heuristic: Heuristic::Balance,
            exhaustive_weights: false,
            aimed_rays: 2,
            shared_light_paths: 4,
        }
    }
}

impl Settings {
    /// More rays are not aimed.
    pub const MOST_AIMED_RAYS: u32 = 63;
    /// No more pixels share their light paths.
    pub const MOST_SHARED_LIGHT_PATHS: u32 = 16;

    /// After how many bounces roulette begins, by default or as set.
    pub fn roulette_start(&self) -> u32 {
        let pairs = matches!(self.integrator, Integrator::Bdpt | Integrator::Light);
        self.roulette_start.unwrap_or(if pairs { 1 } else { 5 })
    }
}

/// Longer paths than this are cut even without a limit, so that a scene of perfect mirrors ends. Roulette
/// alone makes them rarer than one in 10⁴ of those that no surface absorbs.
const LONGEST_PATH: u32 = 1024;

/// How many kernels there have been.
static KERNELS: AtomicU64 = AtomicU64::new(0);

/// Renders samples of one scene. Shared between threads; all that changes is in [`Scratch`] and the sink.
#[derive(Debug)]
pub struct Kernel<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) settings: Settings,
    pub(crate) filter: PixelFilter,
    /// Which classes have any strategy in the set; the running sums count whole classes.
    pub(crate) classes: Classes,
    pub(crate) exhaustive: bool,
    pub(crate) heuristic: Heuristic,
    pub(crate) aimed_rays: u32,
    pub(crate) max_edges: usize,
    pub(crate) roulette_start: usize,
    /// Light paths in one pass: as many as the window has pixels.
    pub(crate) light_paths: f32,
    pub(crate) wavelengths: Wavelengths,
    pub(crate) needs: Needs,
    pub(crate) groups: Groups,
    /// How many light paths each eye path is joined with; zero if there is no strategy that does.
    pub(crate) joins: f32,
    /// Like that of no other kernel, so that buffers know whose paths they hold.
    pub(crate) number: u64,
}

/// Buffers that are used again for every sample of a thread.
#[derive(Debug, Default)]
pub struct Scratch {
    pub(crate) eye: Subpath,
    pub(crate) lights: LightPaths,
    pub(crate) densities: Vec<VertexDensities>,
    pub(crate) weights: Vec<f32>,
    pub(crate) candidates: Candidates,
    pub(crate) aimed: Vec<Vertex>,
    /// A light path that is not joined with anything.
    pub(crate) looked_at: Subpath,
}

/// One eye path's beginning.
pub(crate) struct EyeSample {
    pub film: Vec2,
    /// The filter's sign and size and the camera's response, by which the sample counts.
    pub filter_weight: f32,
    pub ray: CameraRay,
    pub numbers: EyeNumbers,
}

impl<'a> Kernel<'a> {
    /// A kernel for that scene.
    pub fn new(scene: &'a Scene, mut settings: Settings) -> Self {
        let window = scene.film.window();
        if scene.camera.joins() == Joins::Nothing {
            settings.strategies = settings.strategies.without_splats();
        }
        let exhaustive = settings.exhaustive_weights || settings.strategies.classes().is_none();
        let classes = settings.strategies.touched();
        let joins = classes.inner && settings.integrator == Integrator::Bdpt;
        let groups = Groups::new(window, if joins { settings.shared_light_paths } else { 1 });
        // As many as there are.
        settings.shared_light_paths = groups.size();
        let aims = !exhaustive && !scene.casters().is_empty();
        Self {
            scene,
            filter: PixelFilter::new(&scene.film.filter),
            classes,
            exhaustive,
            aimed_rays: if aims { settings.aimed_rays.min(Settings::MOST_AIMED_RAYS) } else { 0 },
            heuristic: settings.heuristic,
            max_edges: settings.max_depth.unwrap_or(LONGEST_PATH).clamp(1, LONGEST_PATH) as usize,
            roulette_start: settings.roulette_start() as usize,
            light_paths: window.width as f32 * window.height as f32,
            wavelengths: Wavelengths::Rgb,
            needs: Needs::of(scene),
            joins: if joins { groups.size() as f32 } else { 0.0 },
            groups,
            number: KERNELS.fetch_add(1, Ordering::Relaxed),
            settings,
        }
    }

    /// The pixel filter, for splatting what the sink gets.
    pub fn filter(&self) -> &PixelFilter {
        &self.filter
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        self.scene
    }

    /// The settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The colour of a spectrum that the kernel's sinks get.
    pub fn rgb(&self, value: Spectrum) -> Rgb {
        self.wavelengths.rgb(value)
    }

    /// Whether the integrator splats into the light image.
    pub fn has_light_image(&self) -> bool {
        match self.settings.integrator {
            Integrator::Light => true,
            Integrator::Bdpt => self.classes.splat,
            _ => false,
        }
    }

    /// Renders one sample: one eye path through `pixel` (of the full picture) and, where the integrator has
    /// them, one light path; the eye path is joined with those of other pixels, too, see
    /// [`Settings::shared_light_paths`]. Calls [`Sink::eye`] once, unless the integrator has no eye paths.
    pub fn sample<S: Sink>(&self, pixel: [u32; 2], sample: u32, scratch: &mut Scratch, sink: &mut S) {
        let id = SampleId { seed: self.settings.seed, pixel, sample };
        match self.settings.integrator {
            Integrator::Bdpt => self.bdpt(id, scratch, sink),
            Integrator::Light => self.trace_light(id, sink),
            Integrator::Path(technique) => self.path(id, technique, sink),
            Integrator::Direct(technique) => self.direct(id, technique, sink),
            Integrator::Whitted => self.whitted(id, sink),
            _ => self.direct_view(id, sink),
        }
    }

    /// Draws the film position, by the pixel filter, and the camera ray.
    pub(crate) fn eye_sample(&self, id: SampleId) -> EyeSample {
        let mut numbers = EyeNumbers::new(self.settings.sampler, id, self.needs);
        let (offset, filter_weight) = self.filter.sample(numbers.film());
        let [x, y] = id.pixel.map(|c| c as f32 + 0.5);
        let film = Vec2::new(x + offset.x, y + offset.y);
        let ray = self.scene.camera.ray(film, numbers.lens());
        EyeSample { film, filter_weight: filter_weight * self.scene.camera.response(), ray, numbers }
    }

    /// The first flight of a camera walk.
    pub(crate) fn camera_flight(ray: &CameraRay) -> Flight {
        Flight {
            ray: Ray { origin: ray.origin, direction: ray.direction, t_max: ray.t_max },
            throughput: Spectrum::ONE,
            pdf: ray.pdf.0,
            from: (!ray.point.infinite).then_some(ray.point.at),
            cos: 1.0,
            reverse: 0.0,
            delta: false,
            radiance_scale: 1.0,
        }
    }

    /// Whether a film position is near enough to the window for its pixels to see it.
    #[inline]
    pub(crate) fn reaches_window(&self, film: Vec2) -> bool {
        let (w, r) = (self.scene.film.window(), self.filter.radius());
        film.x >= w.x as f32 - r
            && film.y >= w.y as f32 - r
            && film.x <= (w.x + w.width) as f32 + r
            && film.y <= (w.y + w.height) as f32 + r
    }

    /// Gives the sample's value to its pixel, or tells that it is none.
    #[inline]
    pub(crate) fn deliver<S: Sink>(&self, value: Spectrum, filter_weight: f32, sink: &mut S) {
        let value = if value.is_valid() {
            value
        } else {
            sink.invalid();
            Spectrum::ZERO
        };
        sink.eye(self.wavelengths.rgb(value * filter_weight));
    }

    /// Splats at every film position that shows the same place. The position itself is one that [`Kernel::is_seen`]
    /// found to be seen.
    #[inline]
    pub(crate) fn splat<S: Sink>(&self, film: Vec2, value: Spectrum, sink: &mut S) {
        if !value.is_valid() || (film.x + film.y).is_nan() {
            return sink.invalid();
        }
        let rgb = self.wavelengths.rgb(value) * self.scene.camera.response();
        if !self.scene.camera.wraps() {
            return sink.splat(film, rgb);
        }
        for alias in self.scene.camera.aliases(film, self.filter.radius()) {
            if self.reaches_window(alias) {
                sink.splat(alias, rgb);
            }
        }
    }

    /// Whether any alias of a film position is near enough to the window. One that is no number is let through, so that
    /// [`Kernel::splat`] tells of it.
    #[inline]
    pub(crate) fn is_seen(&self, film: Vec2) -> bool {
        if !self.scene.camera.wraps() {
            return self.reaches_window(film) || (film.x + film.y).is_nan();
        }
        (film.x + film.y).is_nan()
            || self.scene.camera.aliases(film, self.filter.radius()).any(|a| self.reaches_window(a))
    }
}
