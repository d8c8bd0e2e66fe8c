use caustica_math::elementary::{asin, atan2};
use caustica_math::{Distribution2d, SolidAnglePdf, Spectrum, Vec2, Vec3};

use super::Surroundings;
use super::tree::Cone;
use crate::description::{Texture, TextureTransform};

/// A point that throws a picture, as [`crate::description::LightKind::Projector`] describes it.
#[derive(Debug)]
pub struct ProjectorLight {
    position: Vec3,
    /// Left, up and forward.
    axes: [Vec3; 3],
    /// Half the picture's width and height at distance one.
    extent: [f32; 2],
    irradiance: Texture,
    scale: f32,
    table: Distribution2d,
    power: f64,
}

/// The part of its sampling that is even, so that no part of the picture is lost.
const UNIFORM_PART: f32 = 0.01;

/// Cells along each side for a picture that is no mere image.
const CELLS: usize = 64;

impl ProjectorLight {
    /// From its place, its axes, and the tangents of half its angles. `None` if the picture is black.
    pub fn new(
        (position, axes): (Vec3, [Vec3; 3]),
        extent: [f32; 2],
        (irradiance, scale): (Texture, f32),
        around: &Surroundings<'_>,
    ) -> Option<Self> {
        let [w, h] = cells(&irradiance, around);
        let luminance: Vec<f32> = (0..w * h)
            .map(|i| {
                let place = [((i % w) as f32 + 0.5) / w as f32, ((i / w) as f32 + 0.5) / h as f32];
                around.textures.rgb(&irradiance, on_picture(place)).luminance()
            })
            .collect();
        let mean = luminance.iter().map(|l| f64::from(*l)).sum::<f64>() / (w * h) as f64;
        // The cells' centres may miss what is bright, but no lamp may be lost that emits anywhere.
        let mean = mean.max(f64::from(UNIFORM_PART * around.textures.mean_luminance(&irradiance)));
        let weights: Vec<f32> = (0..w * h)
            .map(|i| {
                // A look-up reaches into neighbours.
                let [columns, rows] =
                    [(i % w, w), (i / w, h)].map(|(at, n)| [(at + n - 1) % n, at, (at + 1) % n]);
                let sum: f32 = rows.iter().flat_map(|r| columns.map(|c| luminance[r * w + c])).sum();
                sum / 9.0 + UNIFORM_PART * mean as f32
            })
            .collect();
        let power = 4.0 * f64::from(extent[0]) * f64::from(extent[1]) * mean * f64::from(scale);
        Some(Self {
            position,
            axes,
            extent,
            irradiance,
            scale,
            table: Distribution2d::new(&weights, w)?,
            power,
        })
    }

    /// Where it is.
    pub fn position(&self) -> Vec3 {
        self.position
    }

    /// Its power in W: the irradiance over the picture at distance one.
    pub fn power(&self) -> f64 {
        self.power
    }

    /// The directions of its light.
    pub(super) fn cone(&self) -> Cone {
        let [x, y] = self.extent;
        Cone { axis: self.axes[2], spread: 0.0, reach: atan2((x * x + y * y).sqrt(), 1.0) }
    }

    /// The solid angle of the picture, in sr.
    pub fn solid_angle(&self) -> f32 {
        let [x, y] = self.extent;
        4.0 * asin(x * y / ((1.0 + x * x) * (1.0 + y * y)).sqrt())
    }

    /// The place on the picture's square, from the upper left, and the cosine to the axis; `None` beside it.
    fn place(&self, direction: Vec3) -> Option<([f32; 2], f32)> {
        let [x, y, z] = self.axes.map(|a| a.dot(direction));
        let place = [0.5 - 0.5 * x / (z * self.extent[0]), 0.5 - 0.5 * y / (z * self.extent[1])];
        (z > 0.0 && place.iter().all(|c| (0.0..=1.0).contains(c))).then_some((place, z))
    }

    /// The intensity in a direction of travel: what lights a plane across the axis at distance one by the picture.
    #[inline]
    pub fn intensity_in(&self, direction: Vec3, around: &Surroundings<'_>) -> Spectrum {
        let Some((place, cos)) = self.place(direction) else { return Spectrum::ZERO };
        let picture = around.textures.spectrum(&self.irradiance, on_picture(place), around.wavelengths);
        picture * (self.scale / (cos * cos * cos))
    }

    /// A direction by the picture's brightness.
    pub fn sample_direction(&self, u: [f32; 2]) -> Vec3 {
        let ([x, y], _) = self.table.sample(u);
        let across = [(1.0 - 2.0 * x) * self.extent[0], (1.0 - 2.0 * y) * self.extent[1]];
        (self.axes[0] * across[0] + self.axes[1] * across[1] + self.axes[2]).normalized()
    }

    /// Its density; zero where there is no light.
    #[inline]
    pub fn direction_pdf(&self, direction: Vec3) -> SolidAnglePdf {
        let Some((place, cos)) = self.place(direction) else { return SolidAnglePdf::ZERO };
        let area = 4.0 * self.extent[0] * self.extent[1] * cos * cos * cos;
        SolidAnglePdf(self.table.pdf(place) / area)
    }
}

/// Texture coordinates have v = 0 at the lower edge.
fn on_picture([x, y]: [f32; 2]) -> Vec2 {
    Vec2::new(x, 1.0 - y)
}

fn cells(picture: &Texture, around: &Surroundings<'_>) -> [usize; 2] {
    match picture {
        Texture::Constant(_) => [1, 1],
        Texture::Image { image, transform } if *transform == TextureTransform::default() => {
            let image = &around.textures.images[image.0 as usize];
            [image.width as usize, image.height as usize]
        }
        _ => [CELLS, CELLS],
    }
}
