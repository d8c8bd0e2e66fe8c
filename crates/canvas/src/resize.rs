//! Smaller copies, made in linear light.

use std::sync::LazyLock;

use caustica_film::{ToneMap, to_display};
use caustica_math::Rgb;

use crate::{Canvas, CanvasError, Colour};

/// The inverse of the transfer function of IEC 61966-2-1 for each byte.
static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|byte| {
        let value = byte as f64 / 255.0;
        let linear = if value <= 0.040_45 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) };
        linear as f32
    })
});

/// The linear light of a display value, in [0, 1].
pub fn to_linear(colour: Colour) -> Rgb {
    Rgb(colour.map(|byte| LINEAR[usize::from(byte)]))
}

/// The display value of linear light, clamped to [0, 1].
pub fn from_linear(light: Rgb) -> Colour {
    to_display(light, 0.0, ToneMap::Srgb)
}

impl Canvas {
    /// A smaller copy, in which each pixel is the mean of the light in the rectangle that it covers.
    /// An error where either side would be longer or nothing.
    pub fn scaled_down(&self, width: u32, height: u32) -> Result<Self, CanvasError> {
        let (from_width, from_height) = (self.width(), self.height());
        if width > from_width || height > from_height {
            return Err(CanvasError::Larger { from_width, from_height, width, height });
        }
        if (width, height) == (from_width, from_height) {
            return Ok(self.clone());
        }
        let mut copy = Self::new(width, height, [0; 3])?;
        let columns: Vec<Share> = (0..width).map(|i| Share::new(i, width, from_width)).collect();
        for y in 0..height {
            let share = Share::new(y, height, from_height);
            let mut light = vec![Rgb::BLACK; from_width as usize];
            for (row, weight) in share.weights() {
                for (sum, pixel) in light.iter_mut().zip(self.row(row)) {
                    *sum = *sum + to_linear(*pixel) * weight;
                }
            }
            for (pixel, columns) in copy.row_mut(y as usize).iter_mut().zip(&columns) {
                let mean = columns.weights().fold(Rgb::BLACK, |sum, (x, weight)| sum + light[x] * weight);
                *pixel = from_linear(mean);
            }
        }
        Ok(copy)
    }

    /// The largest copy of the same proportions that fits into `width` × `height`; never larger than it is.
    pub fn fitted(&self, width: u32, height: u32) -> Result<Self, CanvasError> {
        let (own_width, own_height) = (u64::from(self.width()), u64::from(self.height()));
        let (width, height) = (u64::from(width).min(own_width), u64::from(height).min(own_height));
        let (w, h) = if own_width * height > own_height * width {
            (width, (own_height * width + own_width / 2) / own_width)
        } else {
            ((own_width * height + own_height / 2) / own_height, height)
        };
        self.scaled_down(w.max(1) as u32, h.max(1) as u32)
    }
}

/// The source pixels that one pixel of a smaller row covers. In units of 1/`count` of a source pixel,
/// everything is a whole number: a source pixel is `count` long, a target pixel `from`.
struct Share {
    start: u64,
    count: u64,
    from: u64,
}

impl Share {
    fn new(index: u32, count: u32, from: u32) -> Self {
        Self { start: u64::from(index) * u64::from(from), count: count.into(), from: from.into() }
    }

    /// Source pixels and their weights, which add up to one.
    fn weights(&self) -> impl Iterator<Item = (usize, f32)> {
        let (start, end, count, from) = (self.start, self.start + self.from, self.count, self.from);
        (start / count..end.div_ceil(count)).map(move |i| {
            let overlap = ((i + 1) * count).min(end) - (i * count).max(start);
            (i as usize, overlap as f32 / from as f32)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_survive_linear_light() {
        for byte in 0..=255 {
            assert_eq!(from_linear(to_linear([byte, 255 - byte, byte / 2])), [byte, 255 - byte, byte / 2]);
        }
    }

    #[test]
    fn shares_tile_the_row() {
        for (count, from) in [(1, 7), (3, 7), (4, 8), (7, 7), (640, 1920), (333, 1000)] {
            let mut covered = vec![0.0; from as usize];
            for i in 0..count {
                let total: f32 = Share::new(i, count, from).weights().map(|(_, w)| w).sum();
                assert!((total - 1.0).abs() < 1e-6);
                for (x, weight) in Share::new(i, count, from).weights() {
                    covered[x] += weight * from as f32 / count as f32;
                }
            }
            assert!(covered.iter().all(|c| (c - 1.0f32).abs() < 1e-5), "{count} of {from}: {covered:?}");
        }
    }

    /// Half of the light of white is 188, not 128.
    #[test]
    fn light_is_averaged_not_bytes() {
        let board = |size: u32| (0..size * size).map(|i| [(((i + i / size) % 2) * 255) as u8; 3]).collect();
        let canvas = Canvas::from_pixels(8, 8, board(8)).unwrap();
        let small = canvas.scaled_down(4, 4).unwrap();
        assert!(small.pixels().iter().all(|p| *p == [188; 3]), "{:?}", small.pixels());
        let third = Canvas::from_pixels(3, 1, vec![[255; 3], [0; 3], [0; 3]]).unwrap();
        // The first of two pixels covers one and a half: two thirds of the light.
        assert_eq!(third.scaled_down(2, 1).unwrap().pixels(), [[213; 3], [0; 3]]);
    }

    #[test]
    fn proportions_are_kept() {
        let canvas = Canvas::new(800, 600, [7, 8, 9]).unwrap();
        for ((width, height), expected) in [
            ((400, 400), (400, 300)),
            ((4000, 150), (200, 150)),
            ((9000, 9000), (800, 600)),
            ((1, 1), (1, 1)),
        ] {
            let small = canvas.fitted(width, height).unwrap();
            assert_eq!((small.width(), small.height()), expected);
            assert!(small.pixels().iter().all(|p| *p == [7, 8, 9]));
        }
        assert!(matches!(canvas.scaled_down(801, 10), Err(CanvasError::Larger { .. })));
        assert!(matches!(canvas.scaled_down(0, 10), Err(CanvasError::Size { .. })));
    }
}
