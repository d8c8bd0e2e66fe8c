//! The size of a film.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::FilmError;

/// The longest side of a picture: beyond it, `f32` positions no longer resolve the middle of a pixel.
const LONGEST_SIDE: u32 = 1 << 23;

/// Quanta within these powers of two scale every `f32` exactly in `f64`.
const EXPONENTS: std::ops::RangeInclusive<i32> = -120..=120;

/// A rectangle of pixels; (0, 0) is the upper left corner of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Window {
    /// Left edge.
    pub x: u32,
    /// Upper edge.
    pub y: u32,
    /// Width, at least 1.
    pub width: u32,
    /// Height, at least 1.
    pub height: u32,
}

impl Window {
    /// How many pixels it holds.
    pub fn pixels(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// The index of a pixel of the full picture among the window's, row by row; `None` outside.
    #[inline]
    pub fn index(&self, [x, y]: [u32; 2]) -> Option<usize> {
        // Left of the window the subtraction wraps round to a huge number.
        let (column, row) = (x.wrapping_sub(self.x), y.wrapping_sub(self.y));
        (column < self.width && row < self.height)
            .then(|| row as usize * self.width as usize + column as usize)
    }
}

/// The sizes of a film. Films of the same layout can be merged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FilmLayout {
    /// Width of the full picture in pixels.
    pub width: u32,
    /// Height of the full picture in pixels.
    pub height: u32,
    /// The part of it that the film holds.
    pub window: Window,
    /// Sums are counted in units of 2 to this power.
    pub quantum_exponent: i32,
}

impl fmt::Display for FilmLayout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { width, height, window: w, quantum_exponent } = self;
        write!(f, "{width} × {height} pixels")?;
        if [w.width, w.height] != [*width, *height] {
            write!(f, " (of them {} × {} from {}, {})", w.width, w.height, w.x, w.y)?;
        }
        write!(f, " in quanta of 2^{quantum_exponent}")
    }
}

impl FilmLayout {
    /// Whether a film can have these sizes at all.
    pub(crate) fn check(&self) -> Result<(), FilmError> {
        let Self { width, height, window, quantum_exponent } = *self;
        check_window(width, height, window)?;
        if !EXPONENTS.contains(&quantum_exponent) {
            return Err(FilmError::Layout(format!(
                "the film's quantum 2^{quantum_exponent} is outside of 2^{} to 2^{}",
                EXPONENTS.start(),
                EXPONENTS.end()
            )));
        }
        Ok(())
    }
}

/// Whether a layer of that many pixels fills `window`.
pub(crate) fn check_layer(pixels: usize, window: Window) -> Result<(), FilmError> {
    let expected = window.pixels();
    if pixels as u64 == expected {
        return Ok(());
    }
    Err(FilmError::Layout(format!("a layer of {pixels} pixels for a window of {expected}")))
}

/// Whether `window` is a part of a picture of `width` × `height` pixels.
pub(crate) fn check_window(width: u32, height: u32, window: Window) -> Result<(), FilmError> {
    let Window { x, y, width: w, height: h } = window;
    let fail = |message| Err(FilmError::Layout(message));
    if width == 0 || height == 0 || w == 0 || h == 0 {
        return fail(format!("a film of {w} × {h} pixels of a picture of {width} × {height} is empty"));
    }
    if width.max(height) > LONGEST_SIDE {
        return fail(format!(
            "a picture of {width} × {height} pixels is longer than {LONGEST_SIDE} on a side"
        ));
    }
    let (right, bottom) = (u64::from(x) + u64::from(w), u64::from(y) + u64::from(h));
    if right > u64::from(width) || bottom > u64::from(height) {
        return fail(format!(
            "the crop {w} × {h} at ({x}, {y}) leaves the picture of {width} × {height} pixels"
        ));
    }
    Ok(())
}
