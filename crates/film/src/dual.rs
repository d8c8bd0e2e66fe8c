//! Films in two halves, whose difference tells the error.

use std::ops::Range;

use crate::FilmError;
use crate::error_bars::ErrorBars;
use crate::film::{Film, FilmCounts, combine};
use crate::layout::FilmLayout;
use crate::picture::{LightImage, Picture, develop};

/// A film in two half-buffers. Each pass of one sample a pixel goes to one of them, by its number alone, so that the
/// halves, like their sum, depend on which passes were added and on nothing else.
///
/// The sum is what a single [`Film`] would hold. The difference of the halves holds nothing but noise, that of the
/// light image included, and so tells how far the picture may be from the truth: see [`ErrorBars`].
#[derive(Debug)]
pub struct DualFilm {
    halves: [Film; 2],
}

/// Runs of passes that go to one half are never longer than 2 to this power.
const LONGEST_RUN: u32 = 12;

/// The half that a pass belongs to. Of the passes from 2^k up to 2^(k+1), the four quarters go to the first, the second,
/// the first and the second half; from 2¹⁴ on runs of 4096 take turns. Long runs of consecutive passes stay together,
/// because they are well spread among each other: every other pass would be noisier than half of the film is.
#[inline]
pub fn half_of(pass: u64) -> usize {
    (pass >> run_of(pass) & 1) as usize
}

/// log₂ of the length of the run that a pass is in.
#[inline]
fn run_of(pass: u64) -> u32 {
    (pass | 1).ilog2().saturating_sub(2).min(LONGEST_RUN)
}

/// How many of the passes before `end` belong to the second half.
fn second_before(end: u64) -> u64 {
    // All runs of before are whole and even in number.
    let run = 1 << run_of(end);
    let (pairs, rest) = (end / (2 * run), end % (2 * run));
    pairs * run + rest.saturating_sub(run)
}

/// How many of those passes belong to each half.
pub(crate) fn passes_by_half(passes: Range<u64>) -> [u64; 2] {
    let second = second_before(passes.end) - second_before(passes.start);
    [passes.end - passes.start - second, second]
}

impl DualFilm {
    /// An empty film. It takes 96 bytes a pixel.
    ///
    /// # Errors
    /// Sizes that make no sense or need more memory than there is.
    pub fn new(layout: FilmLayout) -> Result<Self, FilmError> {
        let window = layout.window;
        layout.check()?;
        Film::check_memory(window, 2)?;
        Ok(Self { halves: [Film::new(layout)?, Film::new(layout)?] })
    }

    pub(crate) fn halves_mut(&mut self) -> &mut [Film; 2] {
        &mut self.halves
    }

    /// The film's sizes.
    pub fn layout(&self) -> &FilmLayout {
        self.halves[0].layout()
    }

    /// The half to which a pass is added.
    #[inline]
    pub fn half(&self, pass: u64) -> &Film {
        &self.halves[half_of(pass)]
    }

    /// Both halves.
    pub fn halves(&self) -> &[Film; 2] {
        &self.halves
    }

    /// Records that these passes were added, to the eye image, the light image or both.
    pub fn finish_passes(&self, passes: Range<u64>, eye: bool, light: bool) {
        for (film, count) in self.halves.iter().zip(passes_by_half(passes)) {
            film.finish_samples(if eye { count } else { 0 }, if light { count } else { 0 });
        }
    }

    /// How much went into both halves.
    pub fn counts(&self) -> FilmCounts {
        let [a, b] = self.halves.each_ref().map(Film::counts);
        a.plus(b)
    }

    /// Samples per pixel of the eye image.
    pub fn eye_samples(&self) -> u64 {
        self.counts().eye_samples
    }

    /// Passes of light paths of the light image.
    pub fn light_samples(&self) -> u64 {
        self.counts().light_samples
    }

    /// The sums of both halves in quanta, pixel by pixel: three channels of the eye image, then three of the light
    /// image.
    pub fn sums(&self) -> impl ExactSizeIterator<Item = [i64; 6]> {
        let [a, b] = &self.halves;
        a.sums().zip(b.sums()).map(|(a, b)| std::array::from_fn(|c| a[c].saturating_add(b[c])))
    }

    /// Adds all that went into `other`, a film of the same layout.
    ///
    /// # Errors
    /// If the layouts differ.
    pub fn merge(&self, other: &DualFilm) -> Result<(), FilmError> {
        self.halves[0].merge(&other.halves[0])?;
        self.halves[1].merge(&other.halves[1])
    }

    /// Whether two films have the same layout, sums and counts in both halves.
    pub fn bits_equal(&self, other: &DualFilm) -> bool {
        self.halves.iter().zip(&other.halves).all(|(a, b)| a.bits_equal(b))
    }

    /// A hash of the layout, the sums and the counts of both halves.
    pub fn fingerprint(&self) -> u64 {
        let [a, b] = self.halves.each_ref().map(Film::fingerprint);
        combine(a, b)
    }

    /// The picture so far: each layer divided by its own count, with error bars if there are passes in both halves.
    /// A layer without samples is black.
    pub fn develop(&self) -> Picture {
        let error = self.error_bars().map(|bars| bars.half_widths());
        Picture { error, ..self.develop_without_bars() }
    }

    /// The same without error bars, which take longer than all else: for pictures that are only looked at.
    pub fn develop_without_bars(&self) -> Picture {
        develop(self.layout(), self.counts(), || self.sums())
    }

    /// How far the picture, eye and light image together, may be from the truth. `None` if one half is empty.
    pub fn error_bars(&self) -> Option<ErrorBars> {
        let passes = self.halves.each_ref().map(|f| f.eye_samples().max(f.light_samples()));
        if passes.contains(&0) {
            return None;
        }
        let halves = self.halves.each_ref().map(|f| f.develop().combined(LightImage::On));
        Some(ErrorBars::of_halves(self.layout().window, halves, passes))
    }
}

#[cfg(test)]
mod tests {
    use caustica_math::Rgb;

    use super::*;
    use crate::Window;

    #[test]
    fn halves_are_balanced_at_every_power_of_two_and_counted_right() {
        let mut second = 0;
        for pass in 0..40_000u64 {
            assert_eq!(second_before(pass), second, "{pass}");
            if pass.is_power_of_two() && pass > 1 {
                assert_eq!(2 * second, pass);
            }
            // Never less than two fifths of them, and a run.
            assert!(5 * second + 5 >= 2 * pass && 5 * (pass - second) + 5 >= 2 * pass, "{pass}: {second}");
            second += half_of(pass) as u64;
        }
        assert_eq!((half_of(u64::MAX), second_before(u64::MAX)), (1, u64::MAX / 2));
    }

    fn film() -> DualFilm {
        let window = Window { x: 0, y: 0, width: 4, height: 3 };
        DualFilm::new(FilmLayout { width: 4, height: 3, window, quantum_exponent: -20 }).unwrap()
    }

    fn add(film: &DualFilm, pass: u64) {
        let value = Rgb::new(1.0, 0.5 + pass as f32, 0.25);
        for i in 0..12 {
            film.half(pass).add_eye([i % 4, i / 4], value * (i + 1) as f32);
        }
        film.finish_passes(pass..pass + 1, true, false);
    }

    #[test]
    fn the_sum_is_what_a_single_film_holds() {
        let dual = film();
        let single = Film::new(*dual.layout()).unwrap();
        for pass in 0..7 {
            add(&dual, pass);
            for i in 0..12 {
                single.add_eye([i % 4, i / 4], Rgb::new(1.0, 0.5 + pass as f32, 0.25) * (i + 1) as f32);
            }
            single.finish_samples(1, 0);
        }
        assert!(dual.sums().eq(single.sums()));
        assert_eq!(dual.counts(), single.counts());
        let picture = dual.develop();
        assert!(picture.error.is_some());
        assert_eq!(Picture { error: None, ..picture }, single.develop());
    }

    #[test]
    fn merging_keeps_the_halves_apart() {
        let (whole, a, b) = (film(), film(), film());
        for pass in 0..9 {
            add(&whole, pass);
            add(if pass % 3 == 0 { &a } else { &b }, pass);
        }
        assert!(!a.bits_equal(&whole) && a.fingerprint() != whole.fingerprint());
        b.merge(&a).unwrap();
        assert!(b.bits_equal(&whole));
        assert_eq!(b.fingerprint(), whole.fingerprint());
    }

    #[test]
    fn a_half_without_passes_has_no_error_bars() {
        let one = film();
        assert_eq!(one.develop().error, None);
        add(&one, 0);
        assert!(one.error_bars().is_none());
        add(&one, 1);
        assert!(one.error_bars().is_some());
    }
}
