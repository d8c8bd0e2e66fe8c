use std::f32::consts::{FRAC_PI_2, TAU};

use caustica_math::elementary::{atan2, exp, pow, safe_sqrt, sin_cos_turns, upper_angle};
use caustica_math::{Distribution2d, Rgb, SolidAnglePdf, Vec3};

use super::{Figures, Heaven, WHOLE_Y, turbidity_between};

static FIGURES: Figures = Figures(include_bytes!("../../../data/daylight/sky.f32"));

/// Control points of the sun's elevation.
const POINTS: usize = 6;
/// Numbers of a channel: those of the formula, and its mean radiance.
const NUMBERS: usize = 10;
/// Numbers of a turbidity: for two albedos.
const BLOCK: usize = 2 * POINTS * 3 * NUMBERS;

/// Cells of the table by which directions are chosen: around, and from the horizon up.
const COLUMNS: usize = 128;
const ROWS: usize = 64;
/// The formula is looked at so often along each side of a cell.
const LOOKS: usize = 2;
/// Each cell has at least this part of the mean.
const LEAST: f32 = 1e-3;

/// A clear sky without its sun. Below the horizon there is nothing.
#[derive(Debug)]
pub struct SkyLight {
    heaven: Heaven,
    /// To the sun, in the sky's frame.
    to_sun: Vec3,
    /// Of each channel.
    channels: [[f32; NUMBERS]; 3],
    /// Of the azimuth in turns and the sine of the elevation, both over one.
    table: Distribution2d,
    flux: f64,
    brightest: f32,
}

impl SkyLight {
    /// Over ground of that albedo. `None` if it is black.
    pub fn new(heaven: Heaven, albedo: Rgb, scale: f32) -> Option<Self> {
        let mut channels = configuration(&heaven, albedo);
        channels.iter_mut().for_each(|c| c[NUMBERS - 1] *= scale / WHOLE_Y);
        let to_sun = heaven.to_local(heaven.to_sun);
        let (mut weights, mut brightest) = (Vec::with_capacity(COLUMNS * ROWS), 0.0_f32);
        for cell in 0..COLUMNS * ROWS {
            let (row, column) = (cell / COLUMNS, cell % COLUMNS);
            let mut sum = 0.0;
            for look in 0..LOOKS * LOOKS {
                let within = |k: usize| (k as f32 + 0.5) / LOOKS as f32;
                let x = (column as f32 + within(look % LOOKS)) / COLUMNS as f32;
                let y = (row as f32 + within(look / LOOKS)) / ROWS as f32;
                let radiance = radiance(&channels, to_sun, direction_at([x, y]));
                sum += radiance.luminance();
                brightest = brightest.max(radiance.max_channel());
            }
            weights.push(sum / (LOOKS * LOOKS) as f32);
        }
        let mean = weights.iter().map(|w| f64::from(*w)).sum::<f64>() / weights.len() as f64;
        weights.iter_mut().for_each(|w| *w = w.max(LEAST * mean as f32));
        // Between the looks it may be a little brighter.
        let brightest = 1.5 * brightest;
        let table = Distribution2d::new(&weights, COLUMNS)?;
        Some(Self { heaven, to_sun, channels, table, flux: mean * f64::from(TAU), brightest })
    }

    /// How many numbers its table has.
    pub const CELLS: usize = COLUMNS * ROWS;

    /// ∫ luminance dω, by many looks.
    pub fn flux(&self) -> f64 {
        self.flux
    }

    /// A bound of its radiance.
    pub fn brightest(&self) -> f32 {
        self.brightest
    }

    /// A unit direction towards the sky, and its density.
    pub fn sample_direction(&self, u: [f32; 2]) -> Option<(Vec3, SolidAnglePdf)> {
        let d = direction_at(self.table.sample(u).0);
        let [x, y, z] = self.heaven.axes;
        let towards = x * d.x + y * d.y + z * d.z;
        // Asked again by direction, so that rounding cannot tell the two apart.
        let pdf = self.direction_pdf(towards);
        (pdf.0 > 0.0).then_some((towards, pdf))
    }

    /// The density of a direction towards the sky.
    pub fn direction_pdf(&self, towards: Vec3) -> SolidAnglePdf {
        let d = self.heaven.to_local(towards);
        if d.z < 0.0 {
            return SolidAnglePdf::ZERO;
        }
        let turns = atan2(d.y, d.x) * (1.0 / TAU);
        let x = if turns < 0.0 { turns + 1.0 } else { turns };
        // The sine of the elevation is what solid angle is uniform in.
        SolidAnglePdf(self.table.pdf([x, d.z]) * (1.0 / TAU))
    }

    /// The radiance that arrives from a direction.
    pub fn radiance_from(&self, towards: Vec3) -> Rgb {
        radiance(&self.channels, self.to_sun, self.heaven.to_local(towards))
    }
}

/// The direction in the sky's frame at an azimuth in turns and a sine of the elevation.
fn direction_at([turns, z]: [f32; 2]) -> Vec3 {
    let (sin, cos) = sin_cos_turns(turns);
    let r = safe_sqrt((1.0 - z) * (1.0 + z));
    Vec3::new(r * cos, r * sin, z)
}

/// The figures for where the sun is: linear in turbidity and albedo, and a Bézier curve of the fifth degree in the cube
/// root of the elevation.
fn configuration(heaven: &Heaven, albedo: Rgb) -> [[f32; NUMBERS]; 3] {
    let turbidity = turbidity_between(heaven.turbidity);
    let x = pow(heaven.elevation() / FRAC_PI_2, 1.0 / 3.0).min(1.0);
    let mut all = [[0.0; NUMBERS]; 3];
    for (point, times) in [1.0, 5.0, 10.0, 10.0, 5.0, 1.0].into_iter().enumerate() {
        let up = (0..point).fold(times, |product, _| product * x);
        let weight = (point + 1..POINTS).fold(up, |product, _| product * (1.0 - x));
        for (channel, numbers) in all.iter_mut().enumerate() {
            for (i, number) in numbers.iter_mut().enumerate() {
                let at = |ground: usize| {
                    let index = ((ground * POINTS + point) * 3 + channel) * NUMBERS + i;
                    FIGURES.between(turbidity, BLOCK, index)
                };
                let part = albedo.0[channel];
                *number += weight * (at(0) * (1.0 - part) + at(1) * part);
            }
        }
    }
    all
}

/// The formula of 2012 (its equation 8), in the sky's frame.
#[inline]
fn radiance(channels: &[[f32; NUMBERS]; 3], to_sun: Vec3, d: Vec3) -> Rgb {
    if d.z < 0.0 {
        return Rgb::BLACK;
    }
    let cos = d.dot(to_sun);
    let angle = upper_angle(d.cross(to_sun).length(), cos);
    let (high, root) = (1.0 / (d.z + 0.01), d.z.sqrt());
    Rgb(channels.map(|[a, b, c, d, e, f, g, h, i, mean]| {
        let squared = 1.0 + i * i - 2.0 * i * cos;
        let anisotropic = (1.0 + cos * cos) / (squared * safe_sqrt(squared)).max(f32::MIN_POSITIVE);
        let gradient = 1.0 + a * exp(b * high);
        let around = c + d * exp(e * angle) + f * cos * cos + g * anisotropic + h * root;
        (gradient * around * mean).max(0.0)
    }))
}
