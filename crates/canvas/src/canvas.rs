//! The canvas itself: pixels, copies, files.

use std::path::Path;

use caustica_film::{Develop, to_display, write_srgb_png};
use caustica_math::Rgb;

use crate::CanvasError;

/// A colour of a display: sRGB, red first.
pub type Colour = [u8; 3];

/// The most pixels of a canvas: 2²⁸, which take 768 MiB.
pub const MAX_PIXELS: u64 = 1 << 28;

/// A rectangle of pixels, parts of which may lie off the canvas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// The leftmost column.
    pub x: i32,
    /// The top row.
    pub y: i32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Area {
    /// `width` × `height` pixels of which the top left one is at (`x`, `y`).
    pub const fn new(x: i32, y: i32, width: u32, height: u32) -> Self {
        Self { x, y, width, height }
    }

    /// The columns that lie in `0..limit`.
    pub(crate) fn columns(&self, limit: u32) -> std::ops::Range<usize> {
        clipped(self.x, self.width, limit)
    }

    /// The rows that lie in `0..limit`.
    pub(crate) fn rows(&self, limit: u32) -> std::ops::Range<usize> {
        clipped(self.y, self.height, limit)
    }
}

fn clipped(start: i32, length: u32, limit: u32) -> std::ops::Range<usize> {
    let limit = i64::from(limit);
    let from = i64::from(start).clamp(0, limit);
    let to = (i64::from(start) + i64::from(length)).clamp(0, limit);
    from as usize..to as usize
}

/// A picture of 8-bit sRGB pixels, row by row from the top left. It has at least one pixel.
#[derive(Clone, PartialEq, Eq)]
pub struct Canvas {
    width: u32,
    height: u32,
    pixels: Vec<Colour>,
}

impl std::fmt::Debug for Canvas {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Canvas({} × {})", self.width, self.height)
    }
}

impl Canvas {
    /// A canvas of one colour. An error if it would have no pixels, or more than [`MAX_PIXELS`].
    pub fn new(width: u32, height: u32, colour: Colour) -> Result<Self, CanvasError> {
        Self::check_size(u64::from(width), u64::from(height))?;
        Ok(Self { width, height, pixels: vec![colour; width as usize * height as usize] })
    }

    /// A canvas of pixels in rows from the top. An error if their number is not `width` · `height`.
    pub fn from_pixels(width: u32, height: u32, pixels: Vec<Colour>) -> Result<Self, CanvasError> {
        Self::check_size(u64::from(width), u64::from(height))?;
        if pixels.len() != width as usize * height as usize {
            return Err(CanvasError::Count { count: pixels.len(), width, height });
        }
        Ok(Self { width, height, pixels })
    }

    /// A canvas of linear pixels as a display shows them. An error if their number is not `width` · `height`.
    pub fn developed(
        pixels: &[Rgb],
        [width, height]: [u32; 2],
        develop: Develop,
    ) -> Result<Self, CanvasError> {
        let shown = |p: &Rgb| to_display(*p, develop.exposure, develop.tone_map);
        Self::from_pixels(width, height, pixels.iter().map(shown).collect())
    }

    /// Whether a canvas of this size can be made, for sizes that are still being added up.
    pub(crate) fn check_size(width: u64, height: u64) -> Result<(), CanvasError> {
        match width.checked_mul(height) {
            Some(1..=MAX_PIXELS) => Ok(()),
            _ => Err(CanvasError::Size { width, height }),
        }
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All pixels, row by row from the top.
    pub fn pixels(&self) -> &[Colour] {
        &self.pixels
    }

    /// All pixels, to be changed.
    pub fn pixels_mut(&mut self) -> &mut [Colour] {
        &mut self.pixels
    }

    /// The pixel in column `x` and row `y`, if there is one.
    pub fn get(&self, x: u32, y: u32) -> Option<Colour> {
        (x < self.width && y < self.height).then(|| self.row(y as usize)[x as usize])
    }

    /// One row of pixels.
    pub(crate) fn row(&self, y: usize) -> &[Colour] {
        &self.pixels[y * self.width as usize..][..self.width as usize]
    }

    /// One row of pixels, to be changed.
    pub(crate) fn row_mut(&mut self, y: usize) -> &mut [Colour] {
        &mut self.pixels[y * self.width as usize..][..self.width as usize]
    }

    /// Copies a picture so that its top left pixel is at (`x`, `y`). What lies off the canvas is left out.
    pub fn blit(&mut self, picture: &Self, x: i32, y: i32) {
        let area = Area::new(x, y, picture.width, picture.height);
        let columns = area.columns(self.width);
        for row in area.rows(self.height) {
            let from = (columns.start as i64 - i64::from(x)) as usize;
            let source = picture.row((row as i64 - i64::from(y)) as usize);
            self.row_mut(row)[columns.clone()].copy_from_slice(&source[from..][..columns.len()]);
        }
    }

    /// Writes an 8-bit PNG that says it is sRGB. The file is replaced whole or not at all.
    pub fn write_png(&self, path: &Path) -> Result<(), CanvasError> {
        Ok(write_srgb_png(path, self.width, self.height, &self.pixels)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impossible_sizes_are_errors() {
        for (width, height) in [(0, 5), (5, 0), (1 << 16, 1 << 16), (u32::MAX, u32::MAX)] {
            assert!(matches!(Canvas::new(width, height, [0; 3]), Err(CanvasError::Size { .. })));
        }
        let error = Canvas::from_pixels(2, 2, vec![[0; 3]; 3]).unwrap_err();
        assert_eq!(error.to_string(), "3 pixels for a canvas of 2 × 2");
    }

    #[test]
    fn blits_are_clipped_on_every_side() {
        let pixels = (0..12).map(|i| [i; 3]).collect();
        let picture = Canvas::from_pixels(4, 3, pixels).unwrap();
        for (x, y) in [(0, 0), (-2, -1), (3, 2), (-4, 0), (5, 5), (i32::MIN, i32::MAX), (1, -2)] {
            let mut canvas = Canvas::new(5, 4, [99; 3]).unwrap();
            canvas.blit(&picture, x, y);
            for row in 0..4 {
                for column in 0..5 {
                    let inside = |at: u32, start: i32| u32::try_from(i64::from(at) - i64::from(start)).ok();
                    let from = inside(column, x).zip(inside(row, y));
                    let expected = from.and_then(|(u, v)| picture.get(u, v)).unwrap_or([99; 3]);
                    assert_eq!(canvas.get(column, row), Some(expected), "{column}, {row} from {x}, {y}");
                }
            }
        }
    }

    #[test]
    fn a_png_has_the_same_bytes_each_time() {
        let folder = tempfile::tempdir().unwrap();
        let canvas = Canvas::new(7, 3, [10, 200, 30]).unwrap();
        let write = |name: &str| {
            let path = folder.path().join(name);
            canvas.write_png(&path).unwrap();
            std::fs::read(path).unwrap()
        };
        assert_eq!(write("a.png"), write("b.png"));
        let missing = folder.path().join("none").join("a.png");
        assert!(matches!(canvas.write_png(&missing), Err(CanvasError::File(_))));
    }
}
