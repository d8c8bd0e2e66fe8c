use std::f32::consts::{FRAC_1_PI, PI, TAU};

use caustica_math::elementary::{atan2, sin, sin_cos, sin_cos_turns};
use caustica_math::{Distribution2d, Rgb, SolidAnglePdf, Spectrum, Vec3, warp};

use super::{SkyLight, SunLight, Surroundings};
use crate::description::{EnvironmentRows, Image, Wrap};
use crate::texture::bilinear;

/// Light from infinitely far away, from more than one direction.
#[derive(Debug)]
pub enum EnvironmentLight {
    /// The same radiance from all directions.
    Constant(Spectrum),
    /// A map.
    Map(Box<EnvironmentMap>),
    /// A clear sky.
    Sky(Box<SkyLight>),
    /// The sun's disc.
    Sun(Box<SunLight>),
}

/// An equirectangular map with its sampling table.
#[derive(Debug)]
pub struct EnvironmentMap {
    image: u32,
    scale: f32,
    /// Map axes in world space.
    axes: [Vec3; 3],
    rows: EnvironmentRows,
    table: Distribution2d,
    /// ∫ luminance dω.
    flux: f64,
}

/// Direction in the map's frame to the unit square, from the upper left corner.
fn direction_to_square(d: Vec3) -> [f32; 2] {
    let x = 0.5 - atan2(d.x, d.z) * (0.5 * FRAC_1_PI);
    // Of a direction near a pole, d.y alone tells next to nothing about the angle.
    [if x >= 1.0 { 0.0 } else { x }, atan2(sin_theta(d), d.y) * FRAC_1_PI]
}

fn sin_theta(d: Vec3) -> f32 {
    (d.x * d.x + d.z * d.z).sqrt()
}

/// The inverse, and sin θ.
fn square_to_direction([x, y]: [f32; 2]) -> (Vec3, f32) {
    let (sin_theta, cos_theta) = sin_cos(y * PI);
    // The angle from +z towards +x is half a turn less x turns.
    let (s, c) = sin_cos_turns(x);
    (Vec3::new(sin_theta * s, cos_theta, -sin_theta * c), sin_theta)
}

impl EnvironmentMap {
    /// Builds the sampling table. `None` if the image is black.
    ///
    /// Cells are weighed by the mean of the pixels that a bilinear look-up in them reaches into: wherever there is
    /// radiance there is density.
    pub fn new(
        index: u32,
        image: &Image,
        (scale, rows): (f32, EnvironmentRows),
        axes: [Vec3; 3],
    ) -> Option<Self> {
        let (w, h) = (image.width as usize, image.height as usize);
        // One row cannot lie on two poles.
        let rows = if h == 1 { EnvironmentRows::Inside } else { rows };
        let luminance = |row: usize, column: usize| image.pixels[row * w + column].luminance();
        let cells = if rows == EnvironmentRows::OnPoles { h - 1 } else { h };
        let mut weights = Vec::with_capacity(w * cells);
        for cell in 0..cells {
            let sin_theta = sin((cell as f32 + 0.5) / cells as f32 * PI);
            let (reached, count) = reached_rows(cell, h, rows);
            for column in 0..w {
                let columns = [(column + w - 1) % w, column, (column + 1) % w];
                let each = reached.iter().flat_map(|(r, part)| columns.map(|c| luminance(*r, c) * part));
                weights.push(each.sum::<f32>() / count * sin_theta);
            }
        }
        let mut flux = 0.0;
        for row in 0..h {
            let sum: f64 = (0..w).map(|column| f64::from(luminance(row, column))).sum();
            flux += sum * row_share(row, h, rows);
        }
        let flux = flux * f64::from(TAU) / w as f64 * f64::from(scale);
        Some(Self { image: index, scale, axes, rows, table: Distribution2d::new(&weights, w)?, flux })
    }

    /// Where the look-up finds a height of the square.
    fn row_at(&self, y: f32, height: u32) -> f32 {
        match self.rows {
            EnvironmentRows::Inside => y,
            EnvironmentRows::OnPoles => (y * (height - 1) as f32 + 0.5) / height as f32,
        }
    }
}

/// The rows that look-ups in a row of cells reach into, with their parts, and the number of pixels that this is.
fn reached_rows(cell: usize, h: usize, rows: EnvironmentRows) -> ([(usize, f32); 4], f32) {
    let (above, below) = (cell.saturating_sub(1), (cell + 1).min(h - 1));
    match rows {
        EnvironmentRows::Inside => ([(above, 1.0), (cell, 1.0), (below, 1.0), (cell, 0.0)], 9.0),
        // Beyond the two between which it lies, rounding reaches.
        EnvironmentRows::OnPoles => {
            ([(above, ROUNDING), (cell, 1.0), (below, 1.0), ((cell + 2).min(h - 1), ROUNDING)], 6.0)
        }
    }
}

/// The part of a row that only rounding can reach.
const ROUNDING: f32 = 1.0 / 64.0;

/// ∫ sin θ dθ over what a row lights: its own share, or from the row above to the one below in linear descents.
fn row_share(row: usize, h: usize, rows: EnvironmentRows) -> f64 {
    match rows {
        EnvironmentRows::Inside => {
            let sin_theta = sin((row as f32 + 0.5) / h as f32 * PI);
            f64::from(sin_theta) * 2.0 * f64::from(sin(0.5 * PI / h as f32))
        }
        EnvironmentRows::OnPoles => {
            let step = PI / (h - 1) as f32;
            let half = f64::from(sin(0.5 * step)) / (0.5 * f64::from(step));
            if row == 0 || row + 1 == h {
                // 1 − sin(x)/x.
                let x2 = f64::from(step) * f64::from(step);
                x2 / 6.0 * (1.0 - x2 / 20.0 * (1.0 - x2 / 42.0 * (1.0 - x2 / 72.0)))
            } else {
                f64::from(sin(row as f32 * step)) * f64::from(step) * half * half
            }
        }
    }
}

impl EnvironmentLight {
    /// ∫ luminance dω.
    pub fn flux(&self, around: &Surroundings<'_>) -> f64 {
        match self {
            Self::Constant(radiance) => {
                f64::from(around.wavelengths.luminance(*radiance)) * 2.0 * f64::from(TAU)
            }
            Self::Map(map) => map.flux,
            Self::Sky(sky) => sky.flux(),
            Self::Sun(sun) => sun.flux(),
        }
    }

    /// What part of its flux falls on a surface that faces it best, or about so much.
    pub(super) fn part_on_surface(&self) -> f64 {
        match self {
            // Of what comes from everywhere, a surface gets a quarter: half of it, and that by the cosine.
            Self::Constant(_) | Self::Map(_) | Self::Sky(_) => 0.25,
            Self::Sun(_) => 1.0,
        }
    }

    /// A bound of its radiance, where no image tells.
    pub(crate) fn brightest(&self) -> f32 {
        match self {
            Self::Constant(_) | Self::Map(_) => 0.0,
            Self::Sky(sky) => sky.brightest(),
            Self::Sun(sun) => sun.brightest(),
        }
    }

    /// A direction towards the environment and its density.
    pub fn sample_direction(&self, u: [f32; 2]) -> Option<(Vec3, SolidAnglePdf)> {
        match self {
            Self::Constant(_) => Some((warp::uniform_sphere(u), warp::UNIFORM_SPHERE_PDF)),
            Self::Map(map) => {
                let (point, _) = map.table.sample(u);
                let (d, _) = square_to_direction(point);
                let towards = map.axes[0] * d.x + map.axes[1] * d.y + map.axes[2] * d.z;
                // Asked again by direction, so that rounding cannot tell the two apart.
                let pdf = self.direction_pdf(towards);
                (pdf.0 > 0.0).then_some((towards, pdf))
            }
            Self::Sky(sky) => sky.sample_direction(u),
            Self::Sun(sun) => Some(sun.sample_direction(u)),
        }
    }

    /// The density of a direction towards the environment.
    pub fn direction_pdf(&self, towards: Vec3) -> SolidAnglePdf {
        match self {
            Self::Constant(_) => warp::UNIFORM_SPHERE_PDF,
            Self::Map(map) => {
                let local = map.local(towards);
                // The pole itself has no density; keep it finite.
                let sin_theta = sin_theta(local).max(1e-6);
                SolidAnglePdf(map.table.pdf(direction_to_square(local)) / (TAU * PI * sin_theta))
            }
            Self::Sky(sky) => sky.direction_pdf(towards),
            Self::Sun(sun) => sun.direction_pdf(towards),
        }
    }

    /// The radiance that arrives from a direction.
    pub fn radiance_from(&self, towards: Vec3, around: &Surroundings<'_>) -> Spectrum {
        match self {
            Self::Constant(radiance) => *radiance,
            Self::Map(map) => {
                let [x, y] = direction_to_square(map.local(towards));
                let image = &around.textures.images[map.image as usize];
                let row = map.row_at(y, image.height);
                let rgb: Rgb = bilinear(image, x, row, [Wrap::Repeat, Wrap::Clamp]) * map.scale;
                around.wavelengths.spectrum(rgb)
            }
            Self::Sky(sky) => around.wavelengths.spectrum(sky.radiance_from(towards)),
            Self::Sun(sun) => around.wavelengths.spectrum(sun.radiance_from(towards)),
        }
    }
}

impl EnvironmentMap {
    fn local(&self, d: Vec3) -> Vec3 {
        Vec3::new(d.dot(self.axes[0]), d.dot(self.axes[1]), d.dot(self.axes[2]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn square_and_sphere_round_trip() {
        for i in 0..50 {
            for j in 1..50 {
                let p = [(i as f32 + 0.5) / 50.0, j as f32 / 50.0];
                let q = direction_to_square(square_to_direction(p).0);
                assert!((p[0] - q[0]).abs() < 1e-5 && (p[1] - q[1]).abs() < 1e-5, "{p:?} {q:?}");
            }
        }
    }

    #[test]
    fn the_centre_is_plus_z_and_left_is_plus_x() {
        let d = |x, y| square_to_direction([x, y]).0;
        assert!((d(0.5, 0.5) - Vec3::Z).length() < 1e-5);
        assert!((d(0.25, 0.5) - Vec3::X).length() < 1e-5);
        assert!((d(0.5, 0.0) - Vec3::Y).length() < 1e-5);
    }
}
