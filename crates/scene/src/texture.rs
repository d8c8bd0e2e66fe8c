//! Textures made ready for look-ups.

use caustica_math::{Rgb, Spectrum, Vec2, Wavelengths};

use crate::description::{Image, PixelLookup, Scalar, Texture, TextureTransform, Wrap};
use crate::surface::Site;

/// A colour that may vary over a surface, as the renderer evaluates it.
#[derive(Clone, Copy, Debug)]
pub struct TextureTable<'a> {
    /// The images that image textures name.
    pub images: &'a [Image],
    /// The place where they are looked up. Attributes of meshes are black without one.
    pub site: Option<Site<'a>>,
}

impl<'a> TextureTable<'a> {
    /// Textures by those images.
    #[inline(always)]
    pub fn new(images: &'a [Image]) -> Self {
        Self { images, site: None }
    }

    /// The same at a place.
    #[inline(always)]
    pub fn at(self, site: Site<'a>) -> Self {
        Self { site: Some(site), ..self }
    }

    /// The texture's colour at `uv`.
    #[inline]
    pub fn rgb(&self, texture: &Texture, uv: Vec2) -> Rgb {
        match texture {
            Texture::Constant(c) => *c,
            Texture::Checkerboard { delta, scale, shear, value1, value2 } => {
                let cell = |x: f32, y: f32, i: usize| {
                    (x / scale[i] + sheared(y, shear[i]) - delta[i]).floor() as i64
                };
                let sum = cell(uv.x, uv.y, 0).wrapping_add(cell(uv.y, uv.x, 1));
                if sum & 1 == 0 { *value1 } else { *value2 }
            }
            Texture::Image { image, transform } => {
                let (image, at) = (&self.images[image.0 as usize], place(transform, uv));
                let wrap = [transform.wrap; 2];
                match transform.filter {
                    PixelLookup::Bilinear => bilinear(image, at.x, at.y, wrap),
                    PixelLookup::Nearest => nearest(image, at, wrap),
                }
            }
            Texture::Attribute { attribute, scale } => {
                self.site.as_ref().map_or(Rgb::BLACK, |site| site.attribute(*attribute) * *scale)
            }
        }
    }

    /// The derivatives by u and v of the texture's luminance. Where colours jump they are left out.
    pub fn gradient(&self, texture: &Texture, uv: Vec2) -> [f32; 2] {
        let Texture::Image { image, transform } = texture else { return [0.0; 2] };
        if transform.filter == PixelLookup::Nearest {
            return [0.0; 2];
        }
        let at = place(transform, uv);
        let [x, y] = slope(&self.images[image.0 as usize], at, [transform.wrap; 2]);
        // The image's y runs against v.
        let TextureTransform { scale, shear, .. } = transform;
        [x * scale[0] - y * shear[1], x * shear[0] - y * scale[1]]
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
            Texture::Attribute { attribute, scale } => {
                let values = self.site.as_ref().map_or(&[][..], |site| site.attribute_values(*attribute));
                let sum: f64 = values.iter().map(|v| f64::from(v.luminance())).sum();
                (sum / values.len().max(1) as f64) as f32 * scale
            }
        }
    }

    /// The number at `uv`.
    #[inline]
    pub fn number(&self, scalar: &Scalar, uv: Vec2) -> f32 {
        match scalar {
            Scalar::Constant(x) => *x,
            Scalar::Texture(texture) => grey(self.rgb(texture, uv)),
        }
    }

    /// The texture's spectrum at `uv`.
    #[inline]
    pub fn spectrum(&self, texture: &Texture, uv: Vec2, wavelengths: Wavelengths) -> Spectrum {
        wavelengths.spectrum(self.rgb(texture, uv))
    }
}

/// The luminance, and of a grey exactly that.
pub(crate) fn grey(Rgb([r, g, b]): Rgb) -> f32 {
    if r == g && g == b { r } else { Rgb([r, g, b]).luminance() }
}

/// What the other coordinate adds. Nothing adds nothing, even times what is not finite.
#[inline]
fn sheared(other: f32, shear: f32) -> f32 {
    if shear == 0.0 { 0.0 } else { other * shear }
}

/// Where texture coordinates are on an image: row 0 is the upper edge, v = 1.
#[inline]
fn place(t: &TextureTransform, uv: Vec2) -> Vec2 {
    let u = uv.x * t.scale[0] + sheared(uv.y, t.shear[0]) + t.offset[0];
    let v = uv.y * t.scale[1] + sheared(uv.x, t.shear[1]) + t.offset[1];
    Vec2::new(u, 1.0 - v)
}

/// A coordinate within the image, in [0, 1], and −1 where it runs backwards. Whole repeats are dropped, so that large
/// coordinates keep their fraction. One that is not finite counts as zero.
#[inline]
fn within(x: f32, wrap: Wrap) -> (f32, f32) {
    let x = if x.is_finite() { x } else { 0.0 };
    match wrap {
        Wrap::Repeat => (x - x.floor(), 1.0),
        Wrap::Clamp => (x.clamp(0.0, 1.0), if (0.0..=1.0).contains(&x) { 1.0 } else { 0.0 }),
        Wrap::Mirror => {
            let x = x - 2.0 * (0.5 * x).floor();
            if x > 1.0 { (2.0 - x, -1.0) } else { (x, 1.0) }
        }
    }
}

/// An index within the image.
#[inline]
fn index(i: i64, size: i64, wrap: Wrap) -> i64 {
    if wrap == Wrap::Repeat { i.rem_euclid(size) } else { i.clamp(0, size - 1) }
}

/// The four pixels around (x, y), row by row, and where between them it is. Pixel centres are at half integers.
#[inline]
fn around(image: &Image, x: f32, y: f32, wrap: [Wrap; 2]) -> ([Rgb; 4], [f32; 2]) {
    let (w, h) = (image.width as i64, image.height as i64);
    let (x, y) = (within(x, wrap[0]).0 * w as f32 - 0.5, within(y, wrap[1]).0 * h as f32 - 0.5);
    let (x0, y0) = (x.floor(), y.floor());
    let pixel = |dx: i64, dy: i64| {
        let (column, row) = (index(x0 as i64 + dx, w, wrap[0]), index(y0 as i64 + dy, h, wrap[1]));
        image.pixels[(row * w + column) as usize]
    };
    ([pixel(0, 0), pixel(1, 0), pixel(0, 1), pixel(1, 1)], [x - x0, y - y0])
}

/// Bilinear look-up at (x, y) of the unit square, from the upper left corner; pixel centres are at half
/// integers. `wrap` tells what lies beyond the edges, of x and of y. Coordinates that are not finite count as zero.
#[inline]
pub fn bilinear(image: &Image, x: f32, y: f32, wrap: [Wrap; 2]) -> Rgb {
    let ([a, b, c, d], [fx, fy]) = around(image, x, y, wrap);
    let upper = a * (1.0 - fx) + b * fx;
    let lower = c * (1.0 - fx) + d * fx;
    upper * (1.0 - fy) + lower * fy
}

/// The derivatives by x and y of the luminance of [`bilinear`].
fn slope(image: &Image, at: Vec2, wrap: [Wrap; 2]) -> [f32; 2] {
    let (pixels, [fx, fy]) = around(image, at.x, at.y, wrap);
    let [a, b, c, d] = pixels.map(Rgb::luminance);
    let by_x = (b - a) * (1.0 - fy) + (d - c) * fy;
    let by_y = (c - a) * (1.0 - fx) + (d - b) * fx;
    let signs = [within(at.x, wrap[0]).1, within(at.y, wrap[1]).1];
    [by_x * image.width as f32 * signs[0], by_y * image.height as f32 * signs[1]]
}

/// The pixel at a place.
fn nearest(image: &Image, at: Vec2, wrap: [Wrap; 2]) -> Rgb {
    let (w, h) = (image.width as i64, image.height as i64);
    let cell = |x: f32, size: i64, wrap: Wrap| index((within(x, wrap).0 * size as f32) as i64, size, wrap);
    image.pixels[(cell(at.y, h, wrap[1]) * w + cell(at.x, w, wrap[0])) as usize]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::ImageId;

    fn image() -> Image {
        let grey = |v: f32| Rgb::splat(v);
        Image { width: 2, height: 2, pixels: [grey(0.0), grey(1.0), grey(2.0), grey(3.0)].into() }
    }

    #[test]
    fn image_rows_run_down_from_v_one() {
        let images = [image()];
        let table = TextureTable::new(&images);
        let t = Texture::Image { image: ImageId(0), transform: TextureTransform::default() };
        assert_eq!(table.rgb(&t, Vec2::new(0.25, 0.75)), Rgb::splat(0.0));
        assert_eq!(table.rgb(&t, Vec2::new(0.75, 0.25)), Rgb::splat(3.0));
        assert_eq!(table.rgb(&t, Vec2::new(0.5, 0.5)), Rgb::splat(1.5));
        assert_eq!(table.rgb(&t, Vec2::new(1.25, -0.25)), Rgb::splat(0.0));
        assert_eq!(table.rgb(&t, Vec2::new(f32::NAN, 0.75)), Rgb::splat(0.5));
    }

    #[test]
    fn checkerboard_parity() {
        let table = TextureTable::new(&[]);
        let t = Texture::Checkerboard {
            delta: [0.0; 2],
            scale: [0.5, 1.0],
            shear: [0.0; 2],
            value1: Rgb::BLACK,
            value2: Rgb::WHITE,
        };
        assert_eq!(table.rgb(&t, Vec2::new(0.1, 0.1)), Rgb::BLACK);
        assert_eq!(table.rgb(&t, Vec2::new(0.6, 0.1)), Rgb::WHITE);
        assert_eq!(table.rgb(&t, Vec2::new(-0.1, 0.1)), Rgb::WHITE);
        assert_eq!(table.rgb(&t, Vec2::new(0.6, 1.1)), Rgb::BLACK);
    }

    /// A ramp from 0 to 3 in a row.
    fn ramp(transform: TextureTransform, u: f32) -> f32 {
        let pixels = [0.0, 1.0, 2.0, 3.0].map(Rgb::splat).into();
        let images = [Image { width: 4, height: 1, pixels }];
        let texture = Texture::Image { image: ImageId(0), transform };
        TextureTable::new(&images).rgb(&texture, Vec2::new(u, 0.5)).0[0]
    }

    #[test]
    fn beyond_the_edges() {
        let at = |wrap, filter, u| ramp(TextureTransform { wrap, filter, ..TextureTransform::default() }, u);
        let (bilinear, nearest) = (PixelLookup::Bilinear, PixelLookup::Nearest);
        let columns = |wrap, filter| [-0.375, 0.0, 0.125, 0.875, 1.0, 1.375].map(|u| at(wrap, filter, u));
        assert_eq!(columns(Wrap::Repeat, bilinear), [2.0, 1.5, 0.0, 3.0, 1.5, 1.0]);
        assert_eq!(columns(Wrap::Mirror, bilinear), [1.0, 0.0, 0.0, 3.0, 3.0, 2.0]);
        assert_eq!(columns(Wrap::Clamp, bilinear), [0.0, 0.0, 0.0, 3.0, 3.0, 3.0]);
        assert_eq!(columns(Wrap::Repeat, nearest), [2.0, 0.0, 0.0, 3.0, 0.0, 1.0]);
        assert_eq!(columns(Wrap::Mirror, nearest), [1.0, 0.0, 0.0, 3.0, 3.0, 2.0]);
        assert_eq!(columns(Wrap::Clamp, nearest), [0.0, 0.0, 0.0, 3.0, 3.0, 3.0]);
        for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
            for u in [f32::NAN, f32::INFINITY, 1e30, -1e30, -1e-30, 1.0 - 1e-7] {
                assert!((0.0..=3.0).contains(&at(wrap, bilinear, u)) && at(wrap, nearest, u) <= 3.0);
            }
        }
    }

    /// Derivatives against differences, under a transform that turns and shears.
    #[test]
    fn gradients_are_derivatives() {
        let pixels = (0..30).map(|i| Rgb::splat((i * 7 % 11) as f32)).collect();
        let images = [Image { width: 6, height: 5, pixels }];
        let table = TextureTable::new(&images);
        for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
            let (scale, shear, offset) = ([1.3, -0.7], [0.4, 0.9], [0.2, 0.1]);
            let transform = TextureTransform { scale, shear, offset, wrap, ..TextureTransform::default() };
            let t = Texture::Image { image: ImageId(0), transform };
            for i in 0..40 {
                let uv = Vec2::new(i as f32 * 0.137 - 2.0, 1.5 - i as f32 * 0.071);
                let at = |du: f32, dv: f32| table.rgb(&t, Vec2::new(uv.x + du, uv.y + dv)).luminance();
                let h = 1e-3;
                let sides = [
                    [at(h, 0.0) - at(0.0, 0.0), at(0.0, h) - at(0.0, 0.0)],
                    [at(0.0, 0.0) - at(-h, 0.0), at(0.0, 0.0) - at(0.0, -h)],
                ];
                let found = table.gradient(&t, uv);
                for axis in 0..2 {
                    // Where the two sides differ a pixel's middle is crossed.
                    let [a, b] = [sides[0][axis] / h, sides[1][axis] / h];
                    let close = found[axis] > a.min(b) - 0.3 && found[axis] < a.max(b) + 0.3;
                    assert!(close, "{wrap:?} {uv:?}: {} is not between {a} and {b}", found[axis]);
                }
            }
        }
    }
}
