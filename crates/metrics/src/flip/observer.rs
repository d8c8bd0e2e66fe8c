//! Two pictures seen one after the other.

use caustica_math::Rgb;
use rayon::prelude::*;

use super::colour::{ColourScale, appearance, opponents};
use super::kernel::Kernels;
use super::visible;
use crate::image::{Image, MetricsError};

/// The exponent of the feature difference (q_f in the paper) is one half.
const FEATURE_SCALE: f32 = std::f32::consts::FRAC_1_SQRT_2;

/// Lines that a row has after filtering along it, in this order: light and dark, red and green, blue and
/// yellow twice; edge, point and Gaussian.
const ALONG_ROWS: usize = 7;

/// Lines that a row has after filtering along columns too: light and dark, red and green, blue and
/// yellow; edge and point along the row, edge and point along the column.
const ALONG_BOTH: usize = 7;

/// An observer of an image and its reference, who remembers the greatest difference seen at each pixel.
pub(super) struct Observer<'a> {
    pictures: [Image<'a>; 2],
    kernels: Kernels,
    /// What the observer sees of each picture, filtered along rows.
    seen: [Vec<f32>; 2],
    values: Vec<f32>,
}

impl<'a> Observer<'a> {
    /// An observer of two pictures of the same size, for whom `pixels_per_degree` pixels fill a degree.
    pub(super) fn new(
        image: Image<'a>,
        reference: Image<'a>,
        pixels_per_degree: f32,
    ) -> Result<Self, MetricsError> {
        let kernels = Kernels::new(pixels_per_degree)?;
        let pixels = image.pixels().len();
        let lines = || vec![0.0; ALONG_ROWS * pixels];
        Ok(Self {
            pictures: [image, reference],
            kernels,
            seen: [lines(), lines()],
            values: vec![0.0; pixels],
        })
    }

    /// The greatest differences seen, from 0 to 1.
    pub(super) fn into_values(self) -> Vec<f32> {
        self.values
    }

    /// Looks at both pictures, the light of which `shown` turns into that of a display, in [0, 1].
    pub(super) fn look(&mut self, shown: impl Fn(Rgb) -> [f32; 3] + Sync) {
        for (lines, picture) in self.seen.iter_mut().zip(&self.pictures) {
            filter_rows(lines, picture, &self.kernels, &shown);
        }
        let (kernels, seen, width) = (&self.kernels, &self.seen, self.pictures[0].width() as usize);
        let scale = ColourScale::new();
        let empty = || [(); 2].map(|()| vec![0.0; ALONG_BOTH * width]);
        self.values.par_chunks_mut(width).enumerate().for_each_init(empty, |both, (y, values)| {
            for (lines, rows) in both.iter_mut().zip(seen) {
                filter_columns(lines, rows, y, kernels);
            }
            let at = |lines: &[f32], x: usize| std::array::from_fn(|line| lines[line * width + x]);
            for (x, value) in values.iter_mut().enumerate() {
                *value = value.max(difference(at(&both[0], x), at(&both[1], x), scale));
            }
        });
    }
}

/// Filters each row of `picture` along itself: row by row the lines of [`ALONG_ROWS`].
fn filter_rows(
    lines: &mut [f32],
    picture: &Image,
    kernels: &Kernels,
    shown: &(impl Fn(Rgb) -> [f32; 3] + Sync),
) {
    let (width, margin) = (picture.width() as usize, kernels.radius);
    let padded = width + 2 * margin;
    let rows = lines.par_chunks_mut(ALONG_ROWS * width).zip(picture.pixels().par_chunks(width));
    rows.for_each_init(
        || vec![0.0; 3 * padded],
        |channels, (out, row)| {
            for i in 0..padded {
                // Beyond the edges a picture goes on as at the edge.
                let pixel = row[i.saturating_sub(margin).min(width - 1)];
                let values = opponents(shown(visible(pixel)));
                (0..3).for_each(|c| channels[c * padded + i] = values[c]);
            }
            let sources = [
                (&kernels.light_dark, 0),
                (&kernels.red_green, 1),
                (&kernels.blue_yellow[0], 2),
                (&kernels.blue_yellow[1], 2),
                (&kernels.edge, 0),
                (&kernels.point, 0),
                (&kernels.along, 0),
            ];
            for ((kernel, channel), out) in sources.into_iter().zip(out.chunks_exact_mut(width)) {
                let start = channel * padded + margin;
                out.fill(0.0);
                kernel.add(out, |d| &channels[start.wrapping_add_signed(d)..][..width]);
            }
        },
    );
}

/// Filters what [`filter_rows`] made along the columns, at row `y`: the lines of [`ALONG_BOTH`].
fn filter_columns(lines: &mut [f32], rows: &[f32], y: usize, kernels: &Kernels) {
    let width = lines.len() / ALONG_BOTH;
    let last = rows.len() / (ALONG_ROWS * width) - 1;
    // The line of the result, the filter, and the line that it is applied to.
    let steps = [
        (0, &kernels.light_dark, 0),
        (1, &kernels.red_green, 1),
        (2, &kernels.blue_yellow[0], 2),
        (2, &kernels.blue_yellow[1], 3),
        (3, &kernels.along, 4),
        (4, &kernels.along, 5),
        (5, &kernels.edge, 6),
        (6, &kernels.point, 6),
    ];
    lines.fill(0.0);
    for (line, kernel, source) in steps {
        kernel.add(&mut lines[line * width..][..width], |d| {
            let row = y.saturating_add_signed(d).min(last);
            &rows[(row * ALONG_ROWS + source) * width..][..width]
        });
    }
}

/// ꟻLIP of a pixel: the colour difference, made greater where edges and points differ.
#[inline]
fn difference(a: [f32; ALONG_BOTH], b: [f32; ALONG_BOTH], scale: ColourScale) -> f32 {
    let length = |x: f32, y: f32| (x * x + y * y).sqrt();
    let edge = (length(a[3], a[5]) - length(b[3], b[5])).abs();
    let point = (length(a[4], a[6]) - length(b[4], b[6])).abs();
    let feature = (FEATURE_SCALE * edge.max(point)).sqrt().min(1.0);
    let colour = scale.difference(appearance([a[0], a[1], a[2]]), appearance([b[0], b[1], b[2]]));
    libm::powf(colour, 1.0 - feature)
}
