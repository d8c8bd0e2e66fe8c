//! Pictures from formulas, the same to the bit as those of `published.py`.

use caustica_math::Rgb;
use caustica_metrics::Image;

/// A picture that owns its pixels.
#[derive(Clone, Debug)]
pub struct Picture {
    pub width: u32,
    pub height: u32,
    pub pixels: Vec<Rgb>,
}

impl Picture {
    /// The picture with the colour `colour(x, y)` at each pixel.
    pub fn new(width: u32, height: u32, colour: impl Fn(u32, u32) -> Rgb) -> Self {
        let pixels = (0..width * height).map(|i| colour(i % width, i / width)).collect();
        Self { width, height, pixels }
    }

    pub fn image(&self) -> Image<'_> {
        Image::new(self.width, self.height, &self.pixels).unwrap()
    }

    /// Each channel through `f`.
    pub fn map(&self, f: impl Fn(f32) -> f32) -> Self {
        Self { pixels: self.pixels.iter().map(|p| p.map(&f)).collect(), ..*self }
    }

    /// Cut off above white.
    pub fn up_to_white(&self) -> Self {
        self.map(|c| c.min(1.0))
    }

    /// With noise that may be negative, cut off at black.
    pub fn speckled(&self, amount: f32, seed: u32) -> Self {
        let noisy = |(i, p): (usize, &Rgb)| {
            let n = noise(i as u32, seed);
            Rgb(std::array::from_fn(|c| (p.0[c] + amount * (n.0[c] - 0.5)).max(0.0)))
        };
        Self { pixels: self.pixels.iter().enumerate().map(noisy).collect(), ..*self }
    }

    /// With about every two-hundredth pixel of brightness `value`.
    pub fn with_fireflies(&self, value: f32, seed: u32) -> Self {
        let lit = |(i, p): (usize, &Rgb)| {
            if noise(i as u32, seed).0[0] < 1.0 / 200.0 { Rgb::splat(value) } else { *p }
        };
        Self { pixels: self.pixels.iter().enumerate().map(lit).collect(), ..*self }
    }
}

/// Noise in [0, 1) for the pixel of number `index`: multiples of 2⁻²⁴ by Chris Wellons' hash lowbias32.
fn noise(index: u32, seed: u32) -> Rgb {
    Rgb(std::array::from_fn(|c| {
        let h = (3 * index + c as u32).wrapping_add(seed.wrapping_mul(1_000_003));
        let h = (h ^ (h >> 16)).wrapping_mul(0x7FEB_352D);
        let h = (h ^ (h >> 15)).wrapping_mul(0x846C_A68B);
        ((h ^ (h >> 16)) >> 8) as f32 / (1 << 24) as f32
    }))
}

/// Coloured checks of 8 × 8 pixels, moved to the right by `shift`.
pub fn checks(width: u32, height: u32, shift: u32) -> Picture {
    Picture::new(width, height, |x, y| {
        let odd = (((x + shift) / 8 + y / 8) % 2) as f32;
        Rgb::new(0.75 * odd + 0.125, 0.5 * odd, 0.25 + 0.25 * odd)
    })
}

/// A ramp of another direction in each channel, in so many levels.
pub fn ramps(width: u32, height: u32, levels: u32) -> Picture {
    let level = |v: u32, size: u32| (v * levels / size) as f32 / levels as f32;
    Picture::new(width, height, |x, y| Rgb::new(level(x, width), level(y, height), 1.0 - level(x, width)))
}

/// Dim ramps with a lamp in them.
pub fn room(width: u32, height: u32, lamp: f32) -> Picture {
    let dim = ramps(width, height, 64).map(|c| c * 0.5 + 1.0 / 64.0);
    Picture::new(width, height, |x, y| {
        let in_lamp = x.abs_diff(width / 2) < 6 && y.abs_diff(height / 4) < 3;
        if in_lamp { Rgb::splat(lamp) } else { dim.pixels[(y * width + x) as usize] }
    })
}

/// Black but for a bar at the left.
pub fn night(width: u32, height: u32) -> Picture {
    Picture::new(width, height, |x, _| if x < 12 { Rgb::new(4.0, 2.0, 1.0) } else { Rgb::BLACK })
}
