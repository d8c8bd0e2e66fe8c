//! The film: exact sums of contributions.

use std::ops::Range;
use std::sync::atomic::{AtomicI64, AtomicU64, Ordering::Relaxed};

use caustica_math::filter::PixelFilter;
use caustica_math::stream::mix64;
use caustica_math::{MemoryLimit, Rgb, Vec2};
use serde::{Deserialize, Serialize};

use crate::FilmError;
use crate::layout::{FilmLayout, Window};
use crate::picture::{Picture, develop};
use crate::quantum::Quantum;
use crate::turns::Turns;

/// More pixels than this are refused without asking for the memory.
const MOST_PIXELS: u64 = 1 << 31;

/// Three channels of the eye image, then three of the light image.
type Sums = [AtomicI64; CHANNELS];
pub(crate) const CHANNELS: usize = 6;
pub(crate) const EYE: usize = 0;
pub(crate) const LIGHT: usize = 3;

/// How much went into a film.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FilmCounts {
    /// Samples per pixel of the eye image.
    pub eye_samples: u64,
    /// Passes of light paths of the light image.
    pub light_samples: u64,
    /// Contributions that were skipped because they were not finite.
    pub invalid: u64,
    /// Contributions to a pixel that were too large for the quantum, and were clamped.
    pub clamped: u64,
}

impl FilmCounts {
    /// The counts of both together.
    pub fn plus(self, other: Self) -> Self {
        Self {
            eye_samples: self.eye_samples.saturating_add(other.eye_samples),
            light_samples: self.light_samples.saturating_add(other.light_samples),
            invalid: self.invalid.saturating_add(other.invalid),
            clamped: self.clamped.saturating_add(other.clamped),
        }
    }
}

/// Sums of contributions to the pixels of a window, in two layers.
///
/// Contributions are added as whole numbers of a quantum. Whole numbers add up the same in any order,
/// so a film depends on what was added and on nothing else: not on threads, not on splits, not on the
/// order of merging. It is filled through shared references, from any number of threads at once.
#[derive(Debug)]
pub struct Film {
    layout: FilmLayout,
    quantum: Quantum,
    pixels: Vec<Sums>,
    turns: Turns,
    eye_samples: AtomicU64,
    light_samples: AtomicU64,
    invalid: AtomicU64,
    clamped: AtomicU64,
}

/// Splats of one thread, on their way to a [`Film`].
#[derive(Debug)]
pub struct LightBuffer {
    sums: Vec<[i64; 3]>,
}

impl LightBuffer {
    /// How many bytes a buffer for a window of that many pixels takes.
    pub fn memory(pixels: u64) -> u64 {
        pixels * size_of::<[i64; 3]>() as u64
    }
}

impl Film {
    /// An empty film. Sizes that make no sense or need more memory than there is are errors.
    pub fn new(layout: FilmLayout) -> Result<Self, FilmError> {
        layout.check()?;
        let count = Self::check_memory(layout.window, 1)?;
        let mut pixels = Vec::new();
        pixels.try_reserve_exact(count).map_err(|_| too_large(layout.window, 1))?;
        pixels.resize_with(count, Sums::default);
        Ok(Self {
            layout,
            quantum: Quantum::new(layout.quantum_exponent),
            pixels,
            turns: Turns::default(),
            eye_samples: AtomicU64::new(0),
            light_samples: AtomicU64::new(0),
            invalid: AtomicU64::new(0),
            clamped: AtomicU64::new(0),
        })
    }

    /// How many pixels a window has, if the machine has the memory for `films` films of them, and for developing
    /// them.
    pub(crate) fn check_memory(window: Window, films: u64) -> Result<usize, FilmError> {
        match usize::try_from(window.pixels()) {
            Ok(count) if window.pixels() <= MOST_PIXELS && fits_memory(films * window.pixels()) => Ok(count),
            _ => Err(too_large(window, films)),
        }
    }

    /// A film with the sums and counts of an earlier one.
    pub fn restore(layout: FilmLayout, sums: &[[i64; 6]], counts: FilmCounts) -> Result<Self, FilmError> {
        let mut film = Self::new(layout)?;
        if sums.len() != film.pixels.len() {
            let expected = film.pixels.len();
            return Err(FilmError::Layout(format!("sums of {} pixels for a film of {expected}", sums.len())));
        }
        for (pixel, saved) in film.pixels.iter_mut().zip(sums) {
            *pixel = saved.map(AtomicI64::new);
        }
        film.add_counts(counts);
        Ok(film)
    }

    /// Sets the 64 bits of the sums of the pixels from `start` on.
    pub(crate) fn set_sums(&mut self, start: usize, sums: impl Iterator<Item = [i64; 6]>) {
        for (pixel, sums) in self.pixels[start..].iter_mut().zip(sums) {
            *pixel = sums.map(AtomicI64::new);
        }
    }

    /// The sums of some pixels in quanta, but for their turns.
    pub(crate) fn some_sums(&self, pixels: Range<usize>) -> impl ExactSizeIterator<Item = [i64; CHANNELS]> {
        self.pixels[pixels].iter().map(|pixel| pixel.each_ref().map(|sum| sum.load(Relaxed)))
    }

    pub(crate) fn turns(&self) -> &Turns {
        &self.turns
    }

    pub(crate) fn turns_mut(&mut self) -> &mut Turns {
        &mut self.turns
    }

    /// The film's sizes.
    pub fn layout(&self) -> &FilmLayout {
        &self.layout
    }

    /// Adds to the eye image at a pixel of the full picture. Outside of the window: nothing.
    #[inline]
    pub fn add_eye(&self, pixel: [u32; 2], value: Rgb) {
        if let Some(index) = self.layout.window.index(pixel) {
            if is_finite(value) {
                self.add_counts_to(index, EYE, self.count(pixel, value));
            } else {
                self.invalid.fetch_add(1, Relaxed);
            }
        }
    }

    /// What [`Film::add_eye`] would add, in quanta; `None` if nothing.
    pub fn quanta(&self, pixel: [u32; 2], value: Rgb) -> Option<[i64; 3]> {
        (self.layout.window.index(pixel).is_some() && is_finite(value)).then(|| self.count(pixel, value))
    }

    /// Adds quanta to the eye image at a pixel of the full picture. Outside of the window: nothing.
    pub fn add_eye_quanta(&self, pixel: [u32; 2], quanta: [i64; 3]) {
        if let Some(index) = self.layout.window.index(pixel) {
            self.add_counts_to(index, EYE, quanta);
        }
    }

    /// Adds to the light image around `position`, in pixels of the full picture: pixel (i, j) covers
    /// [i, i + 1) × [j, j + 1).
    ///
    /// Each pixel of the window within the filter's radius gets `value` times the filter's density
    /// there. The filter is not normalised anew where it sticks out of the window: what falls outside
    /// belongs to pixels that this film does not hold.
    pub fn splat_light(&self, filter: &PixelFilter, position: Vec2, value: Rgb) {
        self.splat(filter, position, value, |index, counts| self.add_counts_to(index, LIGHT, counts));
    }

    /// The same into a thread's own buffer, which [`Film::flush`] adds to the film.
    #[inline]
    pub fn splat_into(&self, buffer: &mut LightBuffer, filter: &PixelFilter, position: Vec2, value: Rgb) {
        self.splat(filter, position, value, |index, counts| {
            for (c, (sum, count)) in buffer.sums[index].iter_mut().zip(counts).enumerate() {
                self.turns.add_alone((number(index, LIGHT + c), sum), count);
            }
        });
    }

    /// A buffer for the splats of one thread, of half the film's size; `None` if the memory for it is not to
    /// be had. It spares splats the atomic additions to sums that threads share.
    pub fn light_buffer(&self) -> Option<LightBuffer> {
        let mut sums = Vec::new();
        sums.try_reserve_exact(self.pixels.len()).ok()?;
        sums.resize(self.pixels.len(), [0; 3]);
        Some(LightBuffer { sums })
    }

    /// Moves a buffer's sums into the film.
    pub fn flush(&self, buffer: &mut LightBuffer) {
        for (index, sums) in buffer.sums.iter_mut().enumerate() {
            self.add_counts_to(index, LIGHT, std::mem::take(sums));
        }
    }

    #[inline]
    fn splat(&self, filter: &PixelFilter, position: Vec2, value: Rgb, mut add: impl FnMut(usize, [i64; 3])) {
        if !(is_finite(value) && position.x.is_finite() && position.y.is_finite()) {
            self.invalid.fetch_add(1, Relaxed);
            return;
        }
        let window = self.layout.window;
        let columns = reach(position.x, filter.radius(), window.x, window.width);
        for y in reach(position.y, filter.radius(), window.y, window.height) {
            let row = filter.eval_axis(y as f32 + 0.5 - position.y);
            let start = (y - window.y) as usize * window.width as usize;
            for x in columns.clone() {
                let density = filter.eval_axis(x as f32 + 0.5 - position.x) * row;
                if density != 0.0 {
                    add(start + (x - window.x) as usize, self.count([x, y], value * density));
                }
            }
        }
    }

    /// The quanta of a finite value at a pixel.
    #[inline]
    fn count(&self, [x, y]: [u32; 2], value: Rgb) -> [i64; 3] {
        // The index in the full picture, so that a crop gets the bits that the whole would have there.
        let index = u64::from(y) * u64::from(self.layout.width) + u64::from(x);
        let (counts, clamped) = self.quantum.count(value, index);
        if clamped {
            self.clamped.fetch_add(1, Relaxed);
        }
        counts
    }

    #[inline]
    fn add_counts_to(&self, index: usize, layer: usize, counts: [i64; 3]) {
        for (c, (sum, count)) in self.pixels[index][layer..layer + 3].iter().zip(counts).enumerate() {
            if count != 0 {
                self.turns.add((number(index, layer + c), sum), count);
            }
        }
    }

    /// Records that every pixel of the eye image has had `eye` more samples, and the light image
    /// `light` more passes.
    pub fn finish_samples(&self, eye: u64, light: u64) {
        self.add_counts(FilmCounts { eye_samples: eye, light_samples: light, ..FilmCounts::default() });
    }

    pub(crate) fn add_counts(&self, counts: FilmCounts) {
        self.eye_samples.fetch_add(counts.eye_samples, Relaxed);
        self.light_samples.fetch_add(counts.light_samples, Relaxed);
        self.invalid.fetch_add(counts.invalid, Relaxed);
        self.clamped.fetch_add(counts.clamped, Relaxed);
    }

    /// How much went into the film.
    pub fn counts(&self) -> FilmCounts {
        FilmCounts {
            eye_samples: self.eye_samples(),
            light_samples: self.light_samples(),
            invalid: self.invalid(),
            clamped: self.clamped(),
        }
    }

    /// Samples per pixel of the eye image.
    pub fn eye_samples(&self) -> u64 {
        self.eye_samples.load(Relaxed)
    }

    /// Passes of light paths of the light image.
    pub fn light_samples(&self) -> u64 {
        self.light_samples.load(Relaxed)
    }

    /// Contributions that were skipped because they were not finite.
    pub fn invalid(&self) -> u64 {
        self.invalid.load(Relaxed)
    }

    /// Contributions to a pixel that were too large for the quantum, and were clamped.
    pub fn clamped(&self) -> u64 {
        self.clamped.load(Relaxed)
    }

    /// Adds all that went into `other`, a film of the same layout.
    pub fn merge(&self, other: &Film) -> Result<(), FilmError> {
        self.check_same_layout(other)?;
        for (i, (ours, theirs)) in self.pixels.iter().flatten().zip(other.pixels.iter().flatten()).enumerate()
        {
            self.turns.add((i as u64, ours), theirs.load(Relaxed));
        }
        self.turns.merge(&other.turns);
        self.add_counts(other.counts());
        Ok(())
    }

    pub(crate) fn check_same_layout(&self, other: &Film) -> Result<(), FilmError> {
        if self.layout == other.layout {
            return Ok(());
        }
        Err(FilmError::Layout(format!("they are of {} and {}", self.layout, other.layout)))
    }

    /// The sums in quanta, pixel by pixel: three channels of the eye image, then three of the light image; those beyond
    /// 64 bits are the largest number. With [`Film::counts`], all that [`Film::restore`] needs.
    pub fn sums(&self) -> impl ExactSizeIterator<Item = [i64; CHANNELS]> {
        let shown = |(i, sums): (usize, [i64; CHANNELS])| {
            std::array::from_fn(|c| self.turns.shown(number(i, c), sums[c]))
        };
        self.some_sums(0..self.pixels.len()).enumerate().map(shown)
    }

    /// All that tells sums apart, also those beyond 64 bits.
    fn exact(&self) -> impl Iterator<Item = u64> {
        let turns = self.turns.all().into_iter().flat_map(|(number, turns)| [number, turns as u64]);
        self.some_sums(0..self.pixels.len()).flatten().map(|sum| sum as u64).chain(turns)
    }

    /// Whether two films have the same layout, sums and counts.
    pub fn bits_equal(&self, other: &Film) -> bool {
        self.layout == other.layout && self.counts() == other.counts() && self.exact().eq(other.exact())
    }

    /// A hash of the layout, the sums and the counts.
    pub fn fingerprint(&self) -> u64 {
        let FilmLayout { width, height, window, quantum_exponent } = self.layout;
        let counts = self.counts();
        let head = [width, height, window.x, window.y, window.width, window.height, quantum_exponent as u32];
        let tail = [counts.eye_samples, counts.light_samples, counts.invalid, counts.clamped];
        head.into_iter().map(u64::from).chain(tail).chain(self.exact()).fold(0, combine)
    }

    /// The picture so far: each layer divided by its own count. A layer without samples is black.
    pub fn develop(&self) -> Picture {
        develop(&self.layout, self.counts(), || self.sums())
    }
}

/// A hash of two words.
pub(crate) fn combine(hash: u64, word: u64) -> u64 {
    mix64(hash.wrapping_mul(3).wrapping_add(1) ^ word)
}

/// The number of a sum among all of a film.
#[inline]
fn number(pixel: usize, channel: usize) -> u64 {
    (pixel * CHANNELS + channel) as u64
}

/// `films` films of that window need more memory than there is.
fn too_large(window: Window, films: u64) -> FilmError {
    let bytes = window.pixels().saturating_mul(films * size_of::<Sums>() as u64);
    FilmError::too_large(window.width, window.height, bytes)
}

/// Whether the machine has the memory for a film of that many pixels, and for developing it. Asking for it
/// does not tell: systems promise more than they have, and end the program when it is used.
fn fits_memory(pixels: u64) -> bool {
    MemoryLimit::Machine.check(pixels.saturating_mul(2 * size_of::<Sums>() as u64)).is_ok()
}

#[inline]
fn is_finite(value: Rgb) -> bool {
    value.0.iter().all(|c| c.is_finite())
}

/// The pixels from `start` on, `count` of them, whose centres lie within `radius` of `position`.
/// Rounding can only add a pixel, for which the filter then gives zero.
#[inline]
fn reach(position: f32, radius: f32, start: u32, count: u32) -> Range<u32> {
    let end = start + count;
    let first = ceil(position - radius - 0.5).clamp(i64::from(start), i64::from(end));
    let last = (-ceil(0.5 - position - radius)).clamp(i64::from(start) - 1, i64::from(end) - 1);
    first as u32..(last + 1) as u32
}

/// The smallest integer that is not less, within what 32 bits hold. (Not every CPU that this is compiled for has an
/// instruction for it, and a library's function would take longer than all else here.)
#[inline]
fn ceil(x: f32) -> i64 {
    let whole = x as i32;
    i64::from(whole) + i64::from(x > whole as f32)
}

#[cfg(test)]
mod tests;
