//! What `bdpt` finds in a region, and what its eye and light paths meet.

use std::collections::BTreeMap;

use caustica_math::{Rgb, Vec2, Wavelengths};
use caustica_render::{Control, available_threads};
use caustica_scene::Scene;
use caustica_scene::description::Integrator;
use caustica_transport::{Contribution, Kernel, Scratch, Settings, Sink, StrategySet, Subpaths};

use super::Question;
use crate::class::PathClass;
use crate::grid::Grid;
use crate::jobs;
use crate::tally::ClassTally;
use crate::verify::VerifyError;

/// What a class carries, and by whom.
#[derive(Clone, Debug, Default)]
pub struct Carried {
    pub tally: ClassTally,
    /// Light by lamp.
    pub lamps: BTreeMap<u32, f64>,
    /// Light by the first mirror or glass after the lamp.
    pub casters: BTreeMap<u32, f64>,
}

/// What eye rays through the region meet first.
#[derive(Clone, Copy, Debug, Default)]
pub struct Views {
    pub rays: u64,
    /// Left the scene.
    pub empty: u64,
    /// Met a surface that scatters nothing towards the camera: black, or seen from its back.
    pub black: u64,
    /// Met a lamp from its dark side.
    pub dark_lamp: u64,
    /// Met a surface from behind.
    pub behind: u64,
    /// Met a transparent surface from behind: from inside the medium.
    pub inside_glass: u64,
}

/// A survey of a region.
#[derive(Clone, Debug, Default)]
pub struct Survey {
    pub classes: BTreeMap<PathClass, Carried>,
    pub views: Views,
    /// For each lamp, the light paths that it began and how many of those met a surface.
    pub emitted: BTreeMap<u32, [u64; 2]>,
    /// Light that paths longer than the limit would carry, by their edges.
    pub longer: BTreeMap<u32, f64>,
    pub passes: u32,
    pub pixels: u64,
}

/// So many edges beyond the limit are looked at.
const BEYOND: u32 = 6;

/// Parts of the work.
pub const PARTS: u32 = 16;

impl Survey {
    /// All light that was found, in sums of luminances.
    pub fn light(&self) -> f64 {
        self.classes.values().map(|c| c.tally.light).fold(0.0, |a, b| a + b)
    }

    /// The sum of the squares of all contributions.
    pub fn squares(&self) -> f64 {
        self.classes.values().map(|c| c.tally.squares).fold(0.0, |a, b| a + b)
    }

    /// Samples times pixels of the region.
    pub fn pixel_samples(&self) -> f64 {
        f64::from(self.passes) * self.pixels as f64
    }

    /// Looks at all samples of a question.
    pub fn run(
        scene: &Scene,
        (question, region): (&Question<'_>, Grid),
        control: &Control,
        mut progress: impl FnMut(f64),
    ) -> Result<Self, VerifyError> {
        let passes = question.samples.div_ceil(PARTS);
        let limit = question.settings.max_depth;
        let settings = Settings {
            integrator: Integrator::Bdpt,
            strategies: StrategySet::default(),
            max_depth: limit.map(|d| d.saturating_add(BEYOND)),
            ..question.settings.clone()
        };
        let kernel = Kernel::new(scene, settings.clone());
        // What surfaces do is to be seen without roulette.
        let looking =
            Kernel::new(scene, Settings { roulette_start: Some(u32::MAX), max_depth: Some(3), ..settings });
        let work = |part: usize| {
            let mut scratch = Scratch::default();
            let survey = Self::default();
            let mut listener = Listener { kernel: &kernel, region, limit, survey, pixel: [0; 2] };
            for pass in 0..passes {
                let sample = part as u32 * passes + pass;
                for pixel in Grid::new(scene, 1).each_pixel() {
                    listener.pixel = pixel;
                    kernel.sample(pixel, sample, &mut scratch, &mut listener);
                    if pass == 0 {
                        let paths = looking.subpaths(pixel, sample, &mut scratch);
                        listener.survey.look(scene, &paths, region.pixel(pixel).is_some());
                    }
                }
            }
            listener.survey
        };
        let threads = question.threads.unwrap_or_else(available_threads);
        let mut all = Self { passes: passes * PARTS, pixels: region.pixels() as u64, ..Self::default() };
        let mut done = 0;
        let finished = jobs::run((PARTS as usize, threads), control, work, |part| {
            all.merge(&part);
            done += 1;
            progress(f64::from(done) / f64::from(PARTS));
        })?;
        if finished { Ok(all) } else { Err(VerifyError::Stopped) }
    }

    fn merge(&mut self, other: &Self) {
        for (class, theirs) in &other.classes {
            let own = self.classes.entry(*class).or_default();
            own.tally.merge(&theirs.tally);
            theirs.lamps.iter().for_each(|(k, v)| *own.lamps.entry(*k).or_default() += v);
            theirs.casters.iter().for_each(|(k, v)| *own.casters.entry(*k).or_default() += v);
        }
        for (lamp, [began, met]) in &other.emitted {
            let own = self.emitted.entry(*lamp).or_default();
            *own = [own[0] + began, own[1] + met];
        }
        other.longer.iter().for_each(|(k, v)| *self.longer.entry(*k).or_default() += v);
        let (a, b) = (&mut self.views, &other.views);
        a.rays += b.rays;
        a.empty += b.empty;
        a.black += b.black;
        a.dark_lamp += b.dark_lamp;
        a.behind += b.behind;
        a.inside_glass += b.inside_glass;
    }

    /// Notes what the subpaths of a sample meet.
    fn look(&mut self, scene: &Scene, paths: &Subpaths<'_>, inside: bool) {
        if let Some(e) = &paths.emission {
            let lamp = self.emitted.entry(e.point.light).or_default();
            *lamp = [lamp[0] + 1, lamp[1] + u64::from(!paths.light.is_empty())];
        }
        if !inside {
            return;
        }
        let views = &mut self.views;
        views.rays += 1;
        let Some(first) = paths.eye.first() else {
            views.empty += 1;
            return;
        };
        let behind = first.side(first.prev) < 0.0;
        let glass = first.bsdf.bounds_a_medium();
        let lamp = scene.lamp_at(&first.point).is_some();
        views.behind += u64::from(behind && !first.bsdf.transmits() && !lamp);
        views.inside_glass += u64::from(behind && glass);
        let shines = lamp && !scene.emitted(&first.point, first.prev, Wavelengths::Rgb).is_black();
        let ends = paths.eye.len() == 1 && paths.escape.is_none();
        views.dark_lamp += u64::from(lamp && !shines && ends);
        views.black += u64::from(ends && !lamp);
    }
}

/// Sorts what `bdpt` finds in the region.
struct Listener<'k, 's> {
    kernel: &'k Kernel<'s>,
    region: Grid,
    /// The most edges that the picture's paths have.
    limit: Option<u32>,
    survey: Survey,
    /// The pixel whose sample is looked at.
    pixel: [u32; 2],
}

impl Listener<'_, '_> {
    /// How much of a contribution the region gets.
    fn share(&self, c: &Contribution<'_>) -> f32 {
        if c.strategy.t != 1 {
            return if self.region.pixel(self.pixel).is_some() { c.filter_weight } else { 0.0 };
        }
        let (mut share, camera) = (0.0, &self.kernel.scene().camera);
        self.region.each_splatted((camera, self.kernel.filter()), c.film, |_, value| share += value);
        share
    }
}

impl Sink for Listener<'_, '_> {
    const PROBES: bool = true;

    fn eye(&mut self, _: Rgb) {}

    fn splat(&mut self, _: Vec2, _: Rgb) {}

    fn contribution(&mut self, c: &Contribution<'_>) {
        let share = self.share(c);
        let luminance = f64::from(self.kernel.rgb(c.unweighted * (c.weight * share)).luminance());
        if !luminance.is_finite() || share == 0.0 {
            return;
        }
        let class = PathClass::of(self.kernel.scene(), c);
        if self.limit.is_some_and(|limit| class.edges() > limit) {
            *self.survey.longer.entry(class.edges()).or_default() += luminance;
            return;
        }
        let carried = self.survey.classes.entry(class).or_default();
        carried.tally.add(luminance);
        *carried.lamps.entry(c.path.lamp.light).or_default() += luminance;
        let vertices = c.path.light.iter().chain(c.path.eye.iter().rev());
        let caster = vertices.filter(|v| !v.is_connectible()).map(|v| v.point.shape).next();
        if let Some(shape) = caster {
            *carried.casters.entry(shape).or_default() += luminance;
        }
    }
}
