//! Light paths that several pixels share.
//!
//! An eye path can be joined with the light paths of other pixels as well as with that of its own: each of n joins makes
//! one of n estimates, as in the light vertex cache of Davidovič et al. ("Progressive Light Transport Simulation on the
//! GPU: Survey and Improvements", 2014), but from a few paths that are known beforehand. The pixels of a [`Group`] lend
//! each other the paths of the same sample, so any range of samples is still whole, and each sample still depends on
//! nothing but its number. They lie apart, so that what they have in common is not seen as blotches.
//!
//! All eye paths are joined with equally many, because weights count them: what a light path splats belongs to another
//! pixel, whose eye paths might find it too. Where a group reaches beyond the window, there are light paths there that
//! splat nothing.

use caustica_math::SampleId;
use caustica_scene::description::Crop;
use caustica_scene::light::Emission;

use crate::kernel::Kernel;
use crate::numbers::LightNumbers;
use crate::walk::{Start, Subpath, emission_flight};

/// The pixels of a group differ in bits of their place in the window, at most so far apart.
const FARTHEST: u32 = 8;

/// Which pixels of a window share their light paths.
#[derive(Clone, Debug)]
pub(crate) struct Groups {
    window: Crop,
    /// By which bits of x and y each pixel's partners differ.
    flips: Vec<[u32; 2]>,
}

/// A light path, of which several eye paths make use.
#[derive(Debug, Default)]
pub(crate) struct LightPath {
    /// Of the sample that it belongs to; perhaps beyond the window.
    pub pixel: [u32; 2],
    pub emission: Option<Emission>,
    pub path: Subpath,
}

/// The light paths of one group.
#[derive(Debug, Default)]
pub(crate) struct LightPaths {
    /// The kernel, the group's first pixel, and the sample, if there are any.
    of: Option<(u64, [u32; 2], u32)>,
    pub paths: Vec<LightPath>,
}

impl Groups {
    /// Groups of `size` pixels (if not a power of two, the next that is smaller), or as many as the window allows.
    pub fn new(window: Crop, size: u32) -> Self {
        let stride = |pixels: u32| if pixels < 2 { 0 } else { FARTHEST.min(1 << (pixels - 1).ilog2()) };
        let (x, y) = (stride(window.width), stride(window.height));
        let mut flips = vec![[x, 0], [0, y], [x / 2, 0], [0, y / 2]];
        flips.retain(|flip| *flip != [0, 0]);
        flips.truncate(size.max(1).ilog2() as usize);
        Self { window, flips }
    }

    /// The bits of x and y in which the pixels of a group differ.
    fn mask(&self) -> [u32; 2] {
        self.flips.iter().fold([0, 0], |all, flip| [all[0] | flip[0], all[1] | flip[1]])
    }

    /// A pixel's place in the window, with those bits cleared.
    fn first(&self, pixel: [u32; 2]) -> [u32; 2] {
        let mask = self.mask();
        [(pixel[0] - self.window.x) & !mask[0], (pixel[1] - self.window.y) & !mask[1]]
    }

    /// The pixels of a pixel's group, some of which may lie beyond the window.
    pub fn of(&self, pixel: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
        let first = self.first(pixel);
        (0..self.size()).map(move |i| {
            let flipped = self.flips.iter().enumerate().filter(|(bit, _)| i >> bit & 1 == 1);
            let [x, y] = flipped.fold(first, |[x, y], (_, flip)| [x ^ flip[0], y ^ flip[1]]);
            [self.window.x + x, self.window.y + y]
        })
    }

    /// How many those are.
    pub fn size(&self) -> u32 {
        1 << self.flips.len()
    }

    /// The pixel whose numbers the light path of a pixel has: those of neighbours, which are stratified jointly, go to the
    /// pixels of one group.
    pub fn numbers_of(&self, pixel: [u32; 2]) -> [u32; 2] {
        let mut place = [pixel[0] - self.window.x, pixel[1] - self.window.y];
        for (i, flip) in self.flips.iter().enumerate() {
            let near = 1 << (i / 2);
            for axis in 0..2 {
                if flip[axis] > near {
                    place[axis] = exchanged(place[axis], near, flip[axis]);
                }
            }
        }
        [self.window.x + place[0], self.window.y + place[1]]
    }
}

/// A number with two of its bits exchanged.
fn exchanged(x: u32, a: u32, b: u32) -> u32 {
    if (x & a == 0) == (x & b == 0) { x } else { x ^ a ^ b }
}

impl Kernel<'_> {
    /// The pixels of a window or a part of it in an order in which those that share light paths follow each other: then
    /// [`Kernel::sample`], with one [`Scratch`], grows each path once. What it finds does not depend on the order.
    pub fn in_groups(&self, pixels: impl Iterator<Item = [u32; 2]>) -> Vec<[u32; 2]> {
        let mut pixels: Vec<_> = pixels.collect();
        pixels.sort_by_cached_key(|pixel| {
            let [x, y] = self.groups.first(*pixel);
            (y, x)
        });
        pixels
    }

    /// With how many light paths each eye path is joined: as many as [`Settings`](crate::Settings) say, but for windows of
    /// fewer pixels, and one where no strategy joins them.
    pub fn shared_light_paths(&self) -> u32 {
        self.groups.size()
    }

    /// The numbers of a sample's light path.
    pub(crate) fn light_numbers(&self, id: SampleId) -> LightNumbers {
        let id = SampleId { pixel: self.groups.numbers_of(id.pixel), ..id };
        LightNumbers::new(self.settings.sampler, id, self.needs)
    }

    /// Grows the light paths of a sample's group, if they are not there already.
    pub(crate) fn grow_light_paths(&self, id: SampleId, lights: &mut LightPaths) {
        let of = Some((self.number, self.groups.first(id.pixel), id.sample));
        if lights.of == of {
            return;
        }
        lights.of = of;
        lights.paths.resize_with(self.groups.size() as usize, LightPath::default);
        for (one, pixel) in lights.paths.iter_mut().zip(self.groups.of(id.pixel)) {
            one.pixel = pixel;
            one.emission = self.light_path(SampleId { pixel, ..id }, &mut one.path);
        }
    }

    /// Emits and grows the light path of a sample.
    pub(crate) fn light_path(&self, id: SampleId, path: &mut Subpath) -> Option<Emission> {
        path.clear();
        let mut numbers = self.light_numbers(id);
        let [choice, u, v] = numbers.emission();
        let emission = self.scene.lights(self.wavelengths).sample_emission(choice, u, v)?;
        let flight = emission_flight(&emission);
        self.grow(flight, &Start::Light(&emission), &mut numbers, path);
        Some(emission)
    }
}
