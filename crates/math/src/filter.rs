//! Pixel filters.

use serde::{Deserialize, Serialize};

use crate::vector::Vec2;

/// A pixel filter; lengths are in pixels, from the centre of the pixel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Filter {
    /// One inside of the radius; 0.5 is the pixel itself.
    Box {
        /// Half width.
        radius: f32,
    },
    /// A triangle.
    Tent {
        /// Half width.
        radius: f32,
    },
    /// A Gaussian, lowered so that it ends at zero.
    Gaussian {
        /// Half width.
        radius: f32,
        /// Standard deviation.
        stddev: f32,
    },
    /// Mitchell and Netravali's cubic, stretched to the radius.
    Mitchell {
        /// Half width.
        radius: f32,
        /// Its B.
        b: f32,
        /// Its C.
        c: f32,
    },
    /// The sine cardinal under the middle of a wider one, as wide as it has lobes on a side.
    Lanczos {
        /// Lobes on a side, and half width.
        lobes: u32,
    },
}

impl Default for Filter {
    fn default() -> Self {
        Self::Gaussian { radius: 2.0, stddev: 0.5 }
    }
}

impl Filter {
    /// Half width in pixels.
    pub fn radius(&self) -> f32 {
        match *self {
            Self::Box { radius }
            | Self::Tent { radius }
            | Self::Gaussian { radius, .. }
            | Self::Mitchell { radius, .. } => radius,
            Self::Lanczos { lobes } => lobes as f32,
        }
    }

    /// Whether it may be negative somewhere.
    pub fn has_lobes(&self) -> bool {
        matches!(self, Self::Mitchell { .. } | Self::Lanczos { .. })
    }

    /// The filter along one axis, not normalised, `x` pixels from the centre; zero beyond the radius.
    pub fn eval1d(&self, x: f32) -> f32 {
        let (x, radius) = (f64::from(x.abs()), f64::from(self.radius()));
        if x <= radius { self.profile(x, radius) as f32 } else { 0.0 }
    }

    /// The filter at 0 ≤ x ≤ radius.
    fn profile(&self, x: f64, radius: f64) -> f64 {
        match *self {
            Self::Box { .. } => 1.0,
            Self::Tent { .. } => 1.0 - x / radius,
            Self::Gaussian { stddev, .. } => {
                let k = 0.5 / (f64::from(stddev) * f64::from(stddev));
                // exp(−kx²) − exp(−kr²), without the cancellation of wide Gaussians.
                -libm::exp(-k * x * x) * libm::expm1(-k * (radius * radius - x * x))
            }
            Self::Mitchell { b, c, .. } => mitchell(2.0 * x / radius, f64::from(b), f64::from(c)),
            Self::Lanczos { .. } => sinc(x) * sinc(x / radius),
        }
    }
}

/// The cubic of Mitchell and Netravali, "Reconstruction Filters in Computer Graphics" (SIGGRAPH
/// 1988), equation 8, for 0 ≤ x ≤ 2.
fn mitchell(x: f64, b: f64, c: f64) -> f64 {
    if x < 1.0 {
        let (cubic, square) = (12.0 - 9.0 * b - 6.0 * c, -18.0 + 12.0 * b + 6.0 * c);
        (x * x * (cubic * x + square) + 6.0 - 2.0 * b) / 6.0
    } else {
        let (cubic, square) = (-b - 6.0 * c, 6.0 * b + 30.0 * c);
        (x * (x * (cubic * x + square) - 12.0 * b - 48.0 * c) + 8.0 * b + 24.0 * c) / 6.0
    }
}

/// sin(πx)/(πx): Duchon, "Lanczos Filtering in One and Two Dimensions" (Journal of Applied Meteorology 18, 1979).
fn sinc(x: f64) -> f64 {
    let x = x * std::f64::consts::PI;
    // Nearer to zero the two terms that are left out are below the precision.
    if x < 1e-4 { 1.0 - x * x / 6.0 } else { libm::sin(x) / x }
}

/// A filter made ready for rendering: normalised to an integral of one, evaluated from a table and
/// sampled by the inverse of its distribution.
///
/// The table is joined by straight lines, and those lines *are* the filter: sampling inverts them
/// exactly, so that splats and samples agree whatever the resolution.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelFilter {
    radius: f32,
    shape: Shape,
}

#[derive(Clone, Debug, PartialEq)]
enum Shape {
    /// Kept apart because it ends in a step, and so that samples pass through untouched.
    Box {
        height: f32,
    },
    Table(Table),
}

/// The largest integral of a filter's magnitude, where that of the filter is one. It is the size of every sample's
/// weight along one axis: beyond, pictures are noise, and in the end not finite.
const LARGEST_MAGNITUDE: f64 = 1e3;

impl PixelFilter {
    /// Prepares `filter`. Parameters that make no filter (a radius that is not positive, an integral
    /// that is not, or is nothing beside its parts) give the pixel itself, a box of radius 0.5.
    pub fn new(filter: &Filter) -> Self {
        let radius = filter.radius();
        let usable = radius > 0.0 && radius.is_finite();
        match filter {
            Filter::Box { .. } if usable => Self::boxed(radius),
            _ if usable => match Table::new(filter) {
                Some(table) => Self { radius, shape: Shape::Table(table) },
                None => Self::boxed(0.5),
            },
            _ => Self::boxed(0.5),
        }
    }

    fn boxed(radius: f32) -> Self {
        Self { radius, shape: Shape::Box { height: 0.5 / radius } }
    }

    /// Half width in pixels.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// The normalised density at (dx, dy), the centre of a pixel less the position of a sample. It may
    /// be negative.
    #[inline]
    pub fn eval(&self, dx: f32, dy: f32) -> f32 {
        self.eval_axis(dx) * self.eval_axis(dy)
    }

    /// One of the two equal factors of [`PixelFilter::eval`].
    ///
    /// A box holds −radius < d ≤ radius, so that a position on the border of two pixels, which belongs
    /// to the one after it, counts once.
    #[inline]
    pub fn eval_axis(&self, d: f32) -> f32 {
        match &self.shape {
            Shape::Box { height } if -self.radius < d && d <= self.radius => *height,
            Shape::Box { .. } => 0.0,
            Shape::Table(table) => table.eval(d.abs()),
        }
    }

    /// ∫f², of f without negative lobes: the noise of splats in a pixel, over that of a filter of one pixel that is flat.
    pub fn square_integral(&self) -> f64 {
        const STEPS: u16 = 256;
        let value = |i| {
            let (at, _) = self.sample([(f32::from(i) + 0.5) / f32::from(STEPS), 0.5]);
            f64::from(self.eval_axis(at.x).abs())
        };
        let axis = (0..STEPS).map(value).sum::<f64>() / f64::from(STEPS);
        axis * axis
    }

    /// The position of a sample, from the centre of its pixel, with density proportional to the
    /// filter's magnitude; and the sample's weight: the filter's sign there times the integral of its
    /// magnitude, which is exactly 1 for filters that are nowhere negative.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> (Vec2, f32) {
        let (x, wx) = self.sample_axis(u[0]);
        let (y, wy) = self.sample_axis(u[1]);
        (Vec2::new(x, y), wx * wy)
    }

    #[inline]
    fn sample_axis(&self, u: f32) -> (f32, f32) {
        let side = 2.0 * u - 1.0;
        match &self.shape {
            Shape::Box { .. } => (side * self.radius, 1.0),
            Shape::Table(table) => {
                let (x, weight) = table.sample(side.abs());
                // Rounding may end at the radius, but an offset must not leave the filter.
                (x.min(self.radius).copysign(side), weight)
            }
        }
    }
}

/// Half of a symmetric filter: values at equal steps from the centre to the radius, joined by lines.
#[derive(Clone, Debug, PartialEq)]
struct Table {
    /// Normalised values; one more than there are cells.
    values: Vec<f32>,
    /// Cells per pixel.
    cells_per_pixel: f32,
    /// The distribution of the magnitude: `cumulative[i]` is the share of the cells before i.
    cumulative: Vec<f64>,
    /// `guide[j]` is the cell that holds the share j / cells, where the search for a share begins.
    guide: Vec<u32>,
    /// The integral of the magnitude.
    magnitude: f32,
}

impl Table {
    /// `None` if the integral is not positive, or next to nothing beside what cancels in it.
    fn new(filter: &Filter) -> Option<Self> {
        let radius = f64::from(filter.radius());
        let cells = match *filter {
            // Cells of σ/64 leave an error of 3e-5 of the peak.
            Filter::Gaussian { radius, stddev } => (64.0 * radius / stddev.abs()).clamp(1024.0, 65536.0),
            // And cells of 1/256 of a lobe, 2e-5.
            Filter::Lanczos { lobes } => (256.0 * lobes as f32).clamp(1024.0, 65536.0),
            _ => 1024.0,
        } as usize;
        let step = radius / cells as f64;
        let mut raw: Vec<f64> = (0..cells).map(|i| filter.profile(step * i as f64, radius)).collect();
        raw.push(0.0);
        let integral = raw.windows(2).map(|v| v[0] + v[1]).sum::<f64>() * step;
        let whole = raw.windows(2).map(|v| (v[0] + v[1]).abs()).sum::<f64>() * step;
        if !(whole.is_finite() && integral > 0.0 && whole <= integral * LARGEST_MAGNITUDE) {
            return None;
        }
        let values: Vec<f32> = raw.iter().map(|v| (v / integral) as f32).collect();
        let mut cumulative = Vec::with_capacity(cells + 1);
        let mut sum = 0.0;
        cumulative.push(sum);
        for v in values.windows(2) {
            sum += cell_magnitude(f64::from(v[0]), f64::from(v[1]));
            cumulative.push(sum);
        }
        cumulative.iter_mut().for_each(|c| *c /= sum);
        let holds = |j: usize| {
            let share = j as f64 / cells as f64;
            cumulative[1..cells].partition_point(|c| *c <= share) as u32
        };
        let guide = (0..cells).map(holds).collect();
        let negative = values.iter().any(|v| *v < 0.0);
        let magnitude = if negative { (2.0 * sum * step) as f32 } else { 1.0 };
        Some(Self { values, cells_per_pixel: (1.0 / step) as f32, cumulative, guide, magnitude })
    }

    #[inline]
    fn eval(&self, distance: f32) -> f32 {
        let position = distance * self.cells_per_pixel;
        let cell = position as usize;
        // A NaN distance lands in cell 0 and comes out as NaN.
        match self.values.get(cell..).and_then(|v| v.first_chunk::<2>()) {
            Some([a, b]) => a + (b - a) * (position - cell as f32),
            None => 0.0,
        }
    }

    /// The distance at the share `u` of the magnitude, and the weight there.
    fn sample(&self, u: f32) -> (f32, f32) {
        // Below one, so that the last cell with any mass is found even if empty ones follow it.
        let u = f64::from(u).min(1.0 - f64::EPSILON);
        let mut cell = self.guide[(u * self.guide.len() as f64) as usize] as usize;
        while self.cumulative[cell + 1] <= u {
            cell += 1;
        }
        let (a, b) = (f64::from(self.values[cell]), f64::from(self.values[cell + 1]));
        let (low, high) = (self.cumulative[cell], self.cumulative[cell + 1]);
        let share = if high > low { ((u - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 };
        let (t, sign) = invert_cell(a, b, share * cell_magnitude(a, b));
        ((((cell as f64) + t) / f64::from(self.cells_per_pixel)) as f32, sign * self.magnitude)
    }
}

/// ∫|a + (b − a)t| dt over [0, 1].
fn cell_magnitude(a: f64, b: f64) -> f64 {
    if a * b < 0.0 {
        // Two triangles that meet where the line crosses zero.
        0.5 * (a * a + b * b) / (a.abs() + b.abs())
    } else {
        0.5 * (a.abs() + b.abs())
    }
}

/// Where ∫|a + (b − a)t| dt from 0 reaches `mass`, and the line's sign there.
fn invert_cell(a: f64, b: f64, mass: f64) -> (f64, f32) {
    let sign_of = |v: f64| if v < 0.0 { -1.0 } else { 1.0 };
    if a * b < 0.0 {
        let zero = a.abs() / (a.abs() + b.abs());
        let before = 0.5 * a.abs() * zero;
        return if mass < before {
            (zero * invert_line(a.abs(), 0.0, mass / zero), sign_of(a))
        } else {
            (zero + (1.0 - zero) * invert_line(0.0, b.abs(), (mass - before) / (1.0 - zero)), sign_of(b))
        };
    }
    (invert_line(a.abs(), b.abs(), mass), sign_of(a + b))
}

/// Solves a·t + (b − a)·t²/2 = mass for a, b ≥ 0, in the form that does not cancel.
fn invert_line(a: f64, b: f64, mass: f64) -> f64 {
    let root = (a * a + 2.0 * (b - a) * mass).max(0.0).sqrt();
    if a + root > 0.0 { (2.0 * mass / (a + root)).min(1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests;
