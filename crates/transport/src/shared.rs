//! Light paths that several pixels share.
//!
//! An eye path can be joined with the light paths of other pixels as well as with that of its own: each of n joins makes
//! one of n estimates, as in the light vertex cache of Davidovič et al. ("Progressive Light Transport Simulation on the
//! GPU: Survey and Improvements", 2014), but from a few paths that are known beforehand. The pixels of a group lend
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

/// The pixels of a group are at most so far apart in x or in y.
const FARTHEST: u32 = 8;

/// Which pixels share their light paths.
#[derive(Clone, Debug)]
pub(crate) struct Groups {
    flips: Vec<Flip>,
}

/// A bit of x or y (0 in the other) in which the pixels of a group differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Flip {
    bits: [u32; 2],
    /// The bit in which neighbours differ whose numbers they have instead.
    near: [u32; 2],
}

/// A light path, of which several eye paths make use.
#[derive(Debug, Default)]
pub(crate) struct LightPath {
    /// That of the sample which it belongs to; perhaps beyond the window.
    pub pixel: [u32; 2],
    pub emission: Option<Emission>,
    pub path: Subpath,
}

/// The light paths of one group.
#[derive(Debug, Default)]
pub(crate) struct LightPaths {
    /// The kernel, the group's first pixel, and the sample, if there are any.
    of: Option<(u64, [u32; 2], u32)>,
    paths: Vec<LightPath>,
}

impl LightPaths {
    /// Those that were grown last.
    pub fn paths(&self) -> &[LightPath] {
        &self.paths
    }
}

impl Groups {
    /// Groups of `size` pixels (if not a power of two, the next that is smaller), or of as many as suit a small window.
    pub fn new(window: Crop, size: u32) -> Self {
        // So near that few groups reach beyond the window: it is wide enough for two of them, but for the smallest.
        let stride =
            |pixels: u32| if pixels < 2 { 0 } else { FARTHEST.min(1 << (pixels / 4).max(1).ilog2()) };
        let (x, y) = (stride(window.width), stride(window.height));
        let flip = |bits, near| Flip { bits, near };
        let mut flips = vec![
            flip([x, 0], [1, 0]),
            flip([0, y], [0, 1]),
            flip([x / 2, 0], [2, 0]),
            flip([0, y / 2], [0, 2]),
        ];
        flips.retain(|flip| flip.bits != [0, 0]);
        flips.truncate(size.max(1).ilog2() as usize);
        Self { flips }
    }

    /// The pixel of a group in which all bits are zero in which its pixels differ.
    fn first(&self, pixel: [u32; 2]) -> [u32; 2] {
        self.flips.iter().fold(pixel, |[x, y], flip| [x & !flip.bits[0], y & !flip.bits[1]])
    }

    /// The pixels of a pixel's group, some of which may lie beyond the window.
    pub fn of(&self, pixel: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
        let first = self.first(pixel);
        (0..self.size()).map(move |i| {
            let flipped = self.flips.iter().enumerate().filter(|(bit, _)| i >> bit & 1 == 1);
            flipped.fold(first, |[x, y], (_, flip)| [x ^ flip.bits[0], y ^ flip.bits[1]])
        })
    }

    /// How many those are.
    pub fn size(&self) -> u32 {
        1 << self.flips.len()
    }

    /// The pixel whose numbers the light path of a pixel has: those of neighbours, which are stratified jointly, go to the
    /// pixels of one group.
    pub fn numbers_of(&self, pixel: [u32; 2]) -> [u32; 2] {
        let exchange = |at: u32, near: u32, far: u32| if far > near { exchanged(at, near, far) } else { at };
        self.flips.iter().fold(pixel, |[x, y], flip| {
            [exchange(x, flip.near[0], flip.bits[0]), exchange(y, flip.near[1], flip.bits[1])]
        })
    }
}

/// A number with two of its bits exchanged.
fn exchanged(x: u32, a: u32, b: u32) -> u32 {
    if (x & a == 0) == (x & b == 0) { x } else { x ^ a ^ b }
}

impl Kernel<'_> {
    /// The pixels of a window or a part of it in an order in which those that share light paths follow each other: then
    /// [`Kernel::sample`], with one [`Scratch`](crate::Scratch), grows each path once. What it finds does not depend on the order.
    pub fn in_groups(&self, pixels: impl Iterator<Item = [u32; 2]>) -> Vec<[u32; 2]> {
        let mut pixels: Vec<_> = pixels.collect();
        if self.groups.size() > 1 {
            pixels.sort_by_cached_key(|pixel| {
                let [x, y] = self.groups.first(*pixel);
                (y, x)
            });
        }
        pixels
    }

    /// With how many light paths each eye path is joined: as many as [`Settings`](crate::Settings) say, but for windows of
    /// less than eight pixels in width or height, and one where nothing is joined.
    pub fn shared_light_paths(&self) -> u32 {
        self.groups.size()
    }

    /// The numbers of a sample's light path.
    pub(crate) fn light_numbers(&self, id: SampleId) -> LightNumbers {
        let id = SampleId { pixel: self.groups.numbers_of(id.pixel), ..id };
        LightNumbers::new(self.settings.sampler, id, self.needs)
    }

    /// The light paths of a sample's group, which are grown if they are not there already.
    pub(crate) fn grow_light_paths<'l>(&self, id: SampleId, lights: &'l mut LightPaths) -> &'l [LightPath] {
        let of = Some((self.number, self.groups.first(id.pixel), id.sample));
        if lights.of != of {
            lights.of = of;
            lights.paths.resize_with(self.groups.size() as usize, LightPath::default);
            for (one, pixel) in lights.paths.iter_mut().zip(self.groups.of(id.pixel)) {
                one.pixel = pixel;
                one.emission = self.light_path(SampleId { pixel, ..id }, &mut one.path);
            }
        }
        &lights.paths
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    const SIZES: [u32; 5] = [1, 2, 4, 8, 16];
    const WINDOWS: [[u32; 2]; 8] = [[64, 48], [8, 8], [9, 9], [5, 1], [64, 1], [1, 64], [2, 3], [1, 1]];

    fn window([width, height]: [u32; 2]) -> Crop {
        Crop { x: 5, y: 3, width, height }
    }

    /// Pixels around a window, in whole blocks that no group leaves.
    fn around() -> impl Iterator<Item = [u32; 2]> {
        (0..96 * 96).map(|i| [i % 96, i / 96])
    }

    #[test]
    fn a_pixel_is_in_the_group_of_each_of_its_partners() {
        for (size, of) in SIZES.into_iter().flat_map(|size| WINDOWS.map(|of| (size, of))) {
            let groups = Groups::new(window(of), size);
            assert!(
                groups.size() <= size && (groups.size() == size || of[0] * of[1] < 64 || of.contains(&1))
            );
            for pixel in around() {
                let group: BTreeSet<_> = groups.of(pixel).collect();
                assert_eq!(group.len() as u32, groups.size());
                assert!(group.contains(&pixel));
                assert!(group.iter().all(|p| groups.of(*p).eq(groups.of(pixel))));
            }
        }
    }

    #[test]
    fn groups_have_the_numbers_of_neighbours_and_none_is_had_twice() {
        for (size, of) in SIZES.into_iter().flat_map(|size| WINDOWS.map(|of| (size, of))) {
            let groups = Groups::new(window(of), size);
            let numbers: BTreeSet<_> = around().map(|pixel| groups.numbers_of(pixel)).collect();
            assert_eq!(numbers, around().collect());
            for pixel in around() {
                // An aligned block: as wide and high as there are bits of x and y to choose.
                let bits = |axis: usize| groups.flips.iter().filter(|f| f.bits[axis] > 0).count();
                let place = |pixel| {
                    let [x, y] = groups.numbers_of(pixel);
                    [x >> bits(0), y >> bits(1)]
                };
                assert!(groups.of(pixel).all(|partner| place(partner) == place(pixel)), "{size} of {of:?}");
            }
        }
    }

    #[test]
    fn few_light_paths_lie_beyond_a_window() {
        for (size, [width, height]) in SIZES.into_iter().flat_map(|size| WINDOWS.map(|of| (size, of))) {
            let window = window([width, height]);
            let groups = Groups::new(window, size);
            let pixels = || (0..width * height).map(|i| [window.x + i % width, window.y + i / width]);
            let grown: BTreeSet<_> = pixels().flat_map(|pixel| groups.of(pixel)).collect();
            assert!(
                grown.len() as u32 <= 4 * width * height,
                "{size} of {width} × {height}: {}",
                grown.len()
            );
        }
        // Of windows of usual sizes there are but few.
        let groups = Groups::new(Crop { x: 0, y: 0, width: 400, height: 300 }, 4);
        let grown: BTreeSet<_> =
            (0..400 * 300).flat_map(|i| groups.of([i % 400, i / 400]).collect::<Vec<_>>()).collect();
        assert!(grown.len() < 400 * 300 * 103 / 100);
    }
}
