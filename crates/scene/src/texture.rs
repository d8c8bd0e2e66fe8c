//! Textures made ready for look-ups.

use caustica_math::{Rgb, Spectrum, Vec2, Wavelengths};

use crate::description::{Image, Scalar, Texture};

/// A colour that may vary over a surface, as the renderer evaluates it.
#[derive(Clone, Copy, Debug)]
pub struct TextureTable<'a> {
    /// The images that image textures name.
    pub images: &'a [Image],
}

impl TextureTable<'_> {
    /// The texture's colour at `uv`.
    #[inline]
    pub fn rgb(&self, texture: &Texture, uv: Vec2) -> Rgb {
        match texture {
            Texture::Constant(c) => *c,
            Texture::Checkerboard { delta, scale, value1, value2 } => {
                let cell = |x: f32, axis: usize| (x / scale[axis] - delta[axis]).floor() as i64;
                if cell(uv.x, 0).wrapping_add(cell(uv.y, 1)) & 1 == 0 { *value1 } else { *value2 }
            }
            Texture::Image { image, transform } => {
                let u = uv.x * transform.scale[0] + transform.offset[0];
                let v = uv.y * transform.scale[1] + transform.offset[1];
                // Row 0 is the upper edge, v = 1.
                bilinear(&self.images[image.0 as usize], u, 1.0 - v, Wrap::Repeat)
            }
        }
    }

    /// The mean luminance over all that the texture may show. More than zero if the texture is not black.
    pub(crate) fn mean_luminance(&self, texture: &Texture) -> f32 {
        match texture {
            Texture::Constant(c) => c.luminance(),
            Texture::Checkerboard { value1, value2, .. } => 0.5 * (value1.luminance() + value2.luminance()),
            Texture::Image { image, .. } => {
                let pixels = &self.images[image.0 as usize].pixels;
                let sum: f64 = pixels.iter().map(|p| f64::from(p.luminance())).sum();
                (sum / pixels.len() as f64) as f32
            }
        }
    }

    /// The number at `uv`.
    #[inline]
    pub fn number(&self, scalar: &Scalar, uv: Vec2) -> f32 {
        match scalar {
            Scalar::Constant(x) => *x,
            Scalar::Texture(texture) => self.rgb(texture, uv).luminance(),
        }
    }

    /// The texture's spectrum at `uv`.
    #[inline]
    pub fn spectrum(&self, texture: &Texture, uv: Vec2, wavelengths: Wavelengths) -> Spectrum {
        wavelengths.spectrum(self.rgb(texture, uv))
    }
}

/// What lies beyond the upper and lower edges of an image. (The left and right ones always join.)
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// The image again.
    Repeat,
    /// Its last row.
    Clamp,
}

/// Bilinear look-up at (x, y) of the unit square, from the upper left corner; pixel centres are at half
/// integers. Coordinates that are not finite count as zero.
#[inline]
pub fn bilinear(image: &Image, x: f32, y: f32, wrap: Wrap) -> Rgb {
    let (w, h) = (image.width as i64, image.height as i64);
    let finite = |c: f32| if c.is_finite() { c } else { 0.0 };
    let (x, y) = (finite(x), finite(y));
    // Whole repeats are dropped first, so that large coordinates keep their fraction.
    let x = (x - x.floor()) * w as f32 - 0.5;
    let y = if wrap == Wrap::Repeat { y - y.floor() } else { y.clamp(0.0, 1.0) } * h as f32 - 0.5;
    let (x0, y0) = (x.floor(), y.floor());
    let (fx, fy) = (x - x0, y - y0);
    let pixel = |dx: i64, dy: i64| {
        let row = y0 as i64 + dy;
        let row = if wrap == Wrap::Repeat { row.rem_euclid(h) } else { row.clamp(0, h - 1) };
        image.pixels[(row * w + (x0 as i64 + dx).rem_euclid(w)) as usize]
    };
    let upper = pixel(0, 0) * (1.0 - fx) + pixel(1, 0) * fx;
    let lower = pixel(0, 1) * (1.0 - fx) + pixel(1, 1) * fx;
    upper * (1.0 - fy) + lower * fy
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::{ImageId, TextureTransform};

    fn image() -> Image {
        let grey = |v: f32| Rgb::splat(v);
        Image { width: 2, height: 2, pixels: [grey(0.0), grey(1.0), grey(2.0), grey(3.0)].into() }
    }

    #[test]
    fn image_rows_run_down_from_v_one() {
        let images = [image()];
        let table = TextureTable { images: &images };
        let t = Texture::Image { image: ImageId(0), transform: TextureTransform::default() };
        assert_eq!(table.rgb(&t, Vec2::new(0.25, 0.75)), Rgb::splat(0.0));
        assert_eq!(table.rgb(&t, Vec2::new(0.75, 0.25)), Rgb::splat(3.0));
        assert_eq!(table.rgb(&t, Vec2::new(0.5, 0.5)), Rgb::splat(1.5));
        assert_eq!(table.rgb(&t, Vec2::new(1.25, -0.25)), Rgb::splat(0.0));
        assert_eq!(table.rgb(&t, Vec2::new(f32::NAN, 0.75)), Rgb::splat(0.5));
    }

    #[test]
    fn checkerboard_parity() {
        let table = TextureTable { images: &[] };
        let t = Texture::Checkerboard {
            delta: [0.0; 2],
            scale: [0.5, 1.0],
            value1: Rgb::BLACK,
            value2: Rgb::WHITE,
        };
        assert_eq!(table.rgb(&t, Vec2::new(0.1, 0.1)), Rgb::BLACK);
        assert_eq!(table.rgb(&t, Vec2::new(0.6, 0.1)), Rgb::WHITE);
        assert_eq!(table.rgb(&t, Vec2::new(-0.1, 0.1)), Rgb::WHITE);
        assert_eq!(table.rgb(&t, Vec2::new(0.6, 1.1)), Rgb::BLACK);
    }
}
