//! What `bdpt` finds in a region, and what its eye and light paths meet.

use std::collections::BTreeMap;

use caustica_math::stream::mix64;
use caustica_math::{Rgb, Vec2, Wavelengths};
use caustica_render::{Control, available_threads};
use caustica_scene::Scene;
use caustica_scene::description::Integrator;
use caustica_transport::{Contribution, Kernel, Scratch, Settings, Sink, StrategySet, Subpaths};

use super::Question;
use super::noise::{Layers, Noise};
use crate::class::PathClass;
use crate::grid::Grid;
use crate::jobs;
use crate::verify::VerifyError;

/// What a class carries, and by whom.
#[derive(Clone, Debug, Default)]
pub struct Carried {
    /// Sum of luminances.
    pub light: f64,
    /// Light by lamp.
    pub lamps: BTreeMap<u32, f64>,
    /// Light by the first mirror or glass that it meets before a D.
    pub casters: BTreeMap<u32, f64>,
    /// Light by the mirror or glass that it is seen in.
    pub seen_in: BTreeMap<u32, f64>,
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
    /// Met mirrors or glass, and no surface that scatters.
    pub mirrors: u64,
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
    pub noise: Noise,
    /// All passes.
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
        self.classes.values().map(|c| c.light).fold(0.0, |a, b| a + b)
    }

    /// Passes of each independent part.
    pub fn passes_of_a_part(&self) -> u32 {
        self.passes / PARTS
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
        let work = |part: usize| {
            let settings = Settings { seed: mix64(settings.seed ^ mix64(part as u64)), ..settings.clone() };
            let kernel = Kernel::new(scene, settings.clone());
            // What surfaces do is to be seen without roulette.
            let looking = Settings { roulette_start: Some(u32::MAX), max_depth: Some(3), ..settings };
            let looking = Kernel::new(scene, looking);
            let mut scratch = Scratch::default();
            let mut listener = Listener {
                kernel: &kernel,
                region,
                limit,
                survey: Self::default(),
                layers: Layers::default(),
                pixel: [0; 2],
                places: Vec::new(),
            };
            let pixels = kernel.in_groups(Grid::new(scene, 1).each_pixel());
            for pass in 0..passes {
                for &pixel in &pixels {
                    listener.pixel = pixel;
                    kernel.sample(pixel, pass, &mut scratch, &mut listener);
                    if pass == 0 {
                        let paths = looking.subpaths(pixel, pass, &mut scratch);
                        listener.survey.look(scene, &paths, region.pixel(pixel).is_some());
                    }
                }
            }
            (listener.survey, listener.layers)
        };
        let threads = question.threads.unwrap_or_else(available_threads);
        let mut all = Self { passes: passes * PARTS, pixels: region.pixels() as u64, ..Self::default() };
        let mut done = 0;
        let finished = jobs::run((PARTS as usize, threads), control, work, |(part, layers)| {
            all.merge(&part);
            all.noise.add(layers);
            done += 1;
            progress(f64::from(done) / f64::from(PARTS));
        })?;
        if finished { Ok(all) } else { Err(VerifyError::Stopped) }
    }

    fn merge(&mut self, other: &Self) {
        for (class, theirs) in &other.classes {
            let own = self.classes.entry(*class).or_default();
            own.light += theirs.light;
            add_up(&mut own.lamps, &theirs.lamps);
            add_up(&mut own.casters, &theirs.casters);
            add_up(&mut own.seen_in, &theirs.seen_in);
        }
        for (lamp, [began, met]) in &other.emitted {
            let own = self.emitted.entry(*lamp).or_default();
            *own = [own[0] + began, own[1] + met];
        }
        add_up(&mut self.longer, &other.longer);
        let (a, b) = (&mut self.views, &other.views);
        a.rays += b.rays;
        a.empty += b.empty;
        a.black += b.black;
        a.dark_lamp += b.dark_lamp;
        a.behind += b.behind;
        a.inside_glass += b.inside_glass;
        a.mirrors += b.mirrors;
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
        views.mirrors += u64::from(!paths.eye.iter().any(|v| v.is_connectible()));
    }
}

/// Adds up what is known by key.
pub fn add_up(sums: &mut BTreeMap<u32, f64>, others: &BTreeMap<u32, f64>) {
    others.iter().for_each(|(key, value)| *sums.entry(*key).or_default() += value);
}

/// Sorts what `bdpt` finds in the region.
struct Listener<'k, 's> {
    kernel: &'k Kernel<'s>,
    region: Grid,
    /// The most edges that the picture's paths have.
    limit: Option<u32>,
    survey: Survey,
    layers: Layers,
    /// The pixel whose sample is looked at.
    pixel: [u32; 2],
    /// Pixels of the region that get a contribution, with the share of each; used again.
    places: Vec<(usize, f32)>,
}

impl Listener<'_, '_> {
    /// Finds the pixels of the region that get a contribution.
    fn place(&mut self, c: &Contribution<'_>) {
        let places = &mut self.places;
        places.clear();
        if c.strategy.t == 1 {
            let camera = &self.kernel.scene().camera;
            self.region
                .each_splatted((camera, self.kernel.filter()), c.film, |i, value| places.push((i, value)));
        } else {
            places.extend(self.region.pixel(self.pixel).map(|i| (i, c.filter_weight)));
        }
    }
}

impl Sink for Listener<'_, '_> {
    const PROBES: bool = true;

    fn eye(&mut self, _: Rgb) {}

    fn splat(&mut self, _: Vec2, _: Rgb) {}

    fn contribution(&mut self, c: &Contribution<'_>) {
        self.place(c);
        let whole = self.kernel.rgb(c.unweighted * c.weight).luminance();
        let luminance = f64::from(whole) * self.places.iter().map(|p| f64::from(p.1)).sum::<f64>();
        if !luminance.is_finite() || self.places.is_empty() {
            return;
        }
        let class = PathClass::of(self.kernel.scene(), c);
        if self.limit.is_some_and(|limit| class.edges() > limit) {
            *self.survey.longer.entry(class.edges()).or_default() += luminance;
            return;
        }
        let layer = self.layers.of(&class, self.region.pixels());
        self.places.iter().for_each(|(i, share)| layer[*i] += whole * share);
        let carried = self.survey.classes.entry(class).or_default();
        carried.light += luminance;
        *carried.lamps.entry(c.path.lamp.light).or_default() += luminance;
        let (caster, seen_in) = mirrors(c.events().map(|(v, dirac)| (!dirac, v.point.shape)));
        for (sums, shape) in [(&mut carried.casters, caster), (&mut carried.seen_in, seen_in)] {
            if let Some(shape) = shape {
                *sums.entry(shape).or_default() += luminance;
            }
        }
    }
}

/// The first S of a path from the lamp on that is followed by a D, and the last one if no D follows: what casts its
/// light, and what it is seen in. Vertices are D (true) or S, with their shapes.
fn mirrors(vertices: impl Iterator<Item = (bool, u32)>) -> (Option<u32>, Option<u32>) {
    let (mut first, mut caster, mut last) = (None, None, None);
    for (diffuse, shape) in vertices {
        if diffuse {
            caster = caster.or(first);
            last = None;
        } else {
            first = first.or(Some(shape));
            last = Some(shape);
        }
    }
    (caster, last)
}

#[cfg(test)]
mod tests {
    use super::mirrors;

    #[test]
    fn mirrors_stand_before_or_behind_what_scatters() {
        let of = |text: &str| mirrors(text.chars().zip(0..).map(|(c, i)| (c == 'D', i)));
        assert_eq!(of("D"), (None, None));
        assert_eq!(of("SSD"), (Some(0), None));
        assert_eq!(of("DSS"), (None, Some(2)));
        assert_eq!(of("SS"), (None, Some(1)));
        assert_eq!(of("SDSDDS"), (Some(0), Some(5)));
        assert_eq!(of("DSD"), (Some(1), None));
    }
}
