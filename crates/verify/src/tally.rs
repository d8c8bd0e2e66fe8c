//! What a replicate adds up.

use std::collections::BTreeMap;

use caustica_math::filter::PixelFilter;
use caustica_math::{Rgb, Vec2};
use caustica_scene::camera::Joins;
use caustica_transport::{Contribution, Kernel, Sink};

use crate::class::PathClass;
use crate::estimator::Estimator;
use crate::grid::Grid;

/// A picture being summed up.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Sums of the window's pixels.
    pub pixels: Vec<Rgb>,
    /// Contributions that were not finite numbers.
    pub invalid: u64,
}

impl Picture {
    /// A black one.
    pub fn new(grid: &Grid) -> Self {
        Self { pixels: vec![Rgb::BLACK; grid.pixels()], invalid: 0 }
    }

    /// The same in smaller numbers.
    pub fn scaled(mut self, factor: f32) -> Self {
        self.pixels.iter_mut().for_each(|p| *p = *p * factor);
        self
    }

    /// Adds another one.
    pub fn add(&mut self, other: &Self) {
        self.pixels.iter_mut().zip(&other.pixels).for_each(|(a, b)| *a = *a + *b);
        self.invalid += other.invalid;
    }
}

/// Renders into a picture, as a session renders into a film.
pub struct PictureSink<'k, 's> {
    pub kernel: &'k Kernel<'s>,
    pub grid: Grid,
    pub picture: Picture,
    pub pixel: [u32; 2],
}

fn is_finite(value: Rgb) -> bool {
    value.0.iter().all(|c| c.is_finite())
}

impl PictureSink<'_, '_> {
    fn add_eye(&mut self, value: Rgb) {
        match self.grid.pixel(self.pixel) {
            Some(i) if is_finite(value) => self.picture.pixels[i] = self.picture.pixels[i] + value,
            _ => self.picture.invalid += u64::from(!is_finite(value)),
        }
    }

    fn add_splat(&mut self, film: Vec2, value: Rgb) {
        if !is_finite(value) {
            self.picture.invalid += 1;
            return;
        }
        let pixels = &mut self.picture.pixels;
        self.grid.each_seen(self.kernel.filter(), film, |i, v| pixels[i] = pixels[i] + value * v);
    }
}

impl Sink for PictureSink<'_, '_> {
    fn eye(&mut self, value: Rgb) {
        self.add_eye(value);
    }

    fn splat(&mut self, film: Vec2, value: Rgb) {
        self.add_splat(film, value);
    }
}

/// Sizes of contributions are told apart by factors of four, so many of them.
pub const SIZES: usize = 48;

/// Sums of contributions, of their squares and of their cubes (without sign).
pub type Moments = [f64; 3];

/// What finds contributions. Each sample has an eye path, so that what those find may be steady; where a light path is
/// seen is left to chance.
const WALKS: usize = 2;

/// Contributions by block, by what finds them (eye paths, light paths), and by size.
#[derive(Clone, Debug, Default)]
pub struct Powers {
    moments: Vec<Moments>,
}

impl Powers {
    /// None yet.
    pub fn new(blocks: usize) -> Self {
        Self { moments: vec![[0.0; 3]; blocks * WALKS * SIZES] }
    }

    /// Bytes that a block takes.
    pub fn memory_of_a_block() -> u64 {
        (WALKS * SIZES * size_of::<Moments>()) as u64
    }

    /// Adds contributions that are `rarity` times as large and as rare as `value`.
    fn add(&mut self, (block, walk): (usize, usize), value: f64, rarity: f64) {
        let rarity = rarity.min(RAREST);
        let size = value.abs() * rarity;
        let exponent = (size.to_bits() >> 52) as i64 - 1023;
        let bin = (exponent.div_euclid(2) + SIZES as i64 / 2).clamp(0, SIZES as i64 - 1);
        let moments = &mut self.moments[(block * WALKS + walk) * SIZES + bin as usize];
        moments[0] += value;
        moments[1] += value.abs() * size;
        moments[2] += value.abs() * size * size;
    }

    /// Adds what is found in those shares of all findings (see [`Estimator::shares`]). `rarities` is by how much rarer it
    /// is found for other reasons.
    fn divide(&mut self, block: usize, value: f64, shares: [f64; 3], rarities: [f64; 3]) {
        const WALK_OF: [usize; 3] = [0, 0, 1];
        let own: f64 = shares.iter().sum();
        if own.is_nan() || own <= 0.0 {
            self.add((block, 0), value, RAREST);
            return;
        }
        for i in (0..3).filter(|i| shares[*i] > 0.0) {
            self.add((block, WALK_OF[i]), value * (shares[i] / own), rarities[i] / own);
        }
    }

    /// Adds others.
    pub fn merge(&mut self, other: &Self) {
        self.moments.resize(other.moments.len().max(self.moments.len()), [0.0; 3]);
        for (a, b) in self.moments.iter_mut().zip(&other.moments) {
            add(a, b);
        }
    }

    /// The contributions to a block by eye paths and by light paths, each from small to large.
    pub fn of_block(&self, block: usize) -> [&[Moments]; WALKS] {
        let (eye, light) = self.moments[block * WALKS * SIZES..][..WALKS * SIZES].split_at(SIZES);
        [eye, light]
    }

    /// The sum of a block's contributions.
    pub fn sum(&self, block: usize) -> f64 {
        self.of_block(block).into_iter().flatten().map(|m| m[0]).sum()
    }

    /// The same in the larger blocks of a level.
    pub fn merged(&self, grid: &Grid, level: usize) -> Self {
        let [columns, rows] = grid.levels()[level];
        let mut merged = Self::new((columns * rows) as usize);
        for block in 0..grid.blocks() {
            let larger = grid.ancestor(block, level) * WALKS * SIZES;
            let own = self.of_block(block).into_iter().flatten();
            merged.moments[larger..].iter_mut().zip(own).for_each(|(a, b)| add(a, b));
        }
        merged
    }
}

fn add(a: &mut Moments, b: &Moments) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
}

/// The light of a class of paths.
#[derive(Clone, Copy, Debug, Default)]
pub struct ClassTally {
    /// Sum of the luminances of contributions.
    pub light: f64,
    /// How many there were.
    pub count: u64,
}

impl ClassTally {
    /// Adds a contribution.
    pub fn add(&mut self, luminance: f64) {
        self.light += luminance;
        self.count += 1;
    }

    /// Adds another tally.
    pub fn merge(&mut self, other: &Self) {
        self.light += other.light;
        self.count += other.count;
    }
}

/// All that the reference run learns in a replicate.
#[derive(Clone, Debug)]
pub struct Learned {
    /// The whole picture.
    pub picture: Picture,
    /// The reference's own contributions, by the set of estimators that reach their class (a bit each).
    pub by_reach: BTreeMap<u32, Powers>,
    /// What each estimator's contributions are expected to be.
    pub expected: Vec<Powers>,
    /// The light of each class.
    pub classes: BTreeMap<PathClass, ClassTally>,
}

impl Learned {
    /// Nothing yet, of so many estimators.
    pub fn new(grid: &Grid, estimators: usize) -> Self {
        Self {
            picture: Picture::new(grid),
            by_reach: BTreeMap::new(),
            expected: vec![Powers::new(grid.blocks()); estimators],
            classes: BTreeMap::new(),
        }
    }

    /// Adds what another replicate learnt.
    pub fn merge(&mut self, other: &Self) {
        self.picture.add(&other.picture);
        for (mask, powers) in &other.by_reach {
            self.by_reach.entry(*mask).or_default().merge(powers);
        }
        self.expected.iter_mut().zip(&other.expected).for_each(|(a, b)| a.merge(b));
        for (class, tally) in &other.classes {
            self.classes.entry(*class).or_default().merge(tally);
        }
    }
}

/// Listens to `bdpt` and sorts what it finds by who could have found it.
pub struct Probe<'k, 's> {
    pub render: PictureSink<'k, 's>,
    pub learned: Learned,
    pub estimators: &'k [Estimator],
    /// What the camera can be joined with.
    pub camera: Joins,
    /// Of the pixel filter, see [`sparsity`].
    pub sparsity: f64,
    /// Parts of a splat by block, used again.
    pub parts: Vec<(usize, f64)>,
}

/// By how much rarer and larger the parts of a splat are than what an eye path finds of the same light, if the filter
/// is narrower than a pixel, so that most splats miss all pixels: ∫f².
pub fn sparsity(filter: &PixelFilter) -> f64 {
    filter.square_integral().clamp(1.0, RAREST)
}

/// What an estimator practically never finds counts as this much rarer than all strategies together find it.
const RAREST: f64 = 1e12;

impl Probe<'_, '_> {
    fn reach(&self, class: &PathClass) -> u32 {
        let bit = |(i, e): (usize, &Estimator)| u32::from(e.reaches(class, self.camera)) << i;
        self.estimators.iter().enumerate().map(bit).sum()
    }

    /// The blocks that a contribution of strategy t = 1 goes to, with the filter's share of each.
    fn find_parts(&mut self, film: Vec2) {
        let (grid, parts) = (self.render.grid, &mut self.parts);
        parts.clear();
        let kernel = self.render.kernel;
        grid.each_splatted((&kernel.scene().camera, kernel.filter()), film, |pixel, value| {
            let (block, value) = (grid.block_of(pixel), f64::from(value));
            match parts.iter_mut().find(|p| p.0 == block) {
                Some(part) => part.1 += value,
                None => parts.push((block, value)),
            }
        });
    }
}

/// How often eye paths by themselves, joined paths and light paths find a path that was found, adding up to one.
fn by_all(c: &Contribution<'_>) -> [f64; 3] {
    let finder = |s: usize, edges: usize| if s == edges { 2 } else { usize::from(s > 1) };
    let mut shares = [0.0; 3];
    for (s, weight) in c.weights.iter().enumerate() {
        shares[finder(s, c.weights.len() - 1)] += f64::from(*weight);
    }
    let all: f64 = shares.iter().sum();
    if all > 0.0 {
        return shares.map(|share| share / all);
    }
    let (s, t) = (c.strategy.s as usize, c.strategy.t as usize);
    shares[finder(s, s + t - 1)] = 1.0;
    shares
}

impl Sink for Probe<'_, '_> {
    const PROBES: bool = true;
    const WEIGHS_ALL: bool = true;

    fn eye(&mut self, value: Rgb) {
        self.render.add_eye(value);
    }

    fn splat(&mut self, film: Vec2, value: Rgb) {
        self.render.add_splat(film, value);
    }

    fn contribution(&mut self, c: &Contribution<'_>) {
        let colour = self.render.kernel.rgb(c.unweighted * (c.weight * c.filter_weight));
        let luminance = f64::from(colour.luminance());
        if !luminance.is_finite() {
            // It is counted where it is added to the picture.
            return;
        }
        let grid = self.render.grid;
        if c.strategy.t == 1 {
            self.find_parts(c.film);
        } else {
            self.parts.clear();
            self.parts.extend(grid.pixel(self.render.pixel).map(|p| (grid.block_of(p), 1.0)));
        }
        let class = PathClass::of(self.render.kernel.scene(), c);
        let reach = self.reach(&class);
        let share: f64 = self.parts.iter().map(|p| p.1).sum();
        self.learned.classes.entry(class).or_default().add(luminance * share);
        // What a light path spreads over pixels, eye paths find whole in some of them. Joins with several light paths are
        // no finds by themselves: they have the eye path in common.
        let joins = f64::from(self.render.kernel.shared_light_paths());
        let rarities = |part: f64| {
            let (eye, light) = match c.strategy.t {
                1 => (1.0 / part.abs().min(1.0), 1.0),
                _ => (1.0, self.sparsity),
            };
            [eye, eye * joins, light]
        };
        let by_both = self.learned.by_reach.entry(reach).or_insert_with(|| Powers::new(grid.blocks()));
        let parts = || self.parts.iter().filter(|p| p.1 != 0.0);
        for &(block, part) in parts() {
            by_both.divide(block, luminance * part, by_all(c), rarities(part));
        }
        for (i, estimator) in self.estimators.iter().enumerate().filter(|(i, _)| reach >> i & 1 != 0) {
            let shares = estimator.shares(c.weights);
            for &(block, part) in parts() {
                self.learned.expected[i].divide(block, luminance * part, shares, rarities(part));
            }
        }
    }
}
