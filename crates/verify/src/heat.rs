//! The picture of where estimators differ.

use caustica_canvas::{Canvas, CanvasError, Cell, Colour, LegendLine, SheetStyle, grid as lay_out};
use caustica_math::Rgb;

use crate::outcome::{Outcome, Tested, Verdict};

/// Statistics from here on have the strongest colour.
const STRONGEST: f64 = 6.0;

const NEUTRAL: [f64; 3] = [236.0, 236.0, 232.0];
const BRIGHT: [f64; 3] = [178.0, 24.0, 43.0];
const DARK: [f64; 3] = [33.0, 102.0, 172.0];
const FRAME: Colour = [178, 24, 43];
/// The two greys of what could not be tested.
const UNTESTED: [Colour; 2] = [[150, 150, 150], [172, 172, 172]];
const BLACK: Colour = [72, 74, 82];

/// The longest side of a map in pixels.
const SIDE: u32 = 288;

/// Columns of maps.
const COLUMNS: usize = 4;

/// The colour of a statistic: from blue (too dark) over grey to red (too bright).
fn colour(t: f64) -> Colour {
    let share = (t.abs() / STRONGEST).min(1.0);
    let end = if t > 0.0 { BRIGHT } else { DARK };
    std::array::from_fn(|c| (NEUTRAL[c] + (end[c] - NEUTRAL[c]) * share + 0.5) as u8)
}

/// One map for each estimator that can reach anything, and the reference first.
///
/// # Errors
/// A picture too large for a canvas.
pub fn heat_map(outcome: &Outcome, title: &str) -> Result<Canvas, CanvasError> {
    let window = outcome.grid.window;
    let zoom = (SIDE / window.width.max(window.height)).max(1);
    let mut cells = vec![Some(Cell::new(reference(outcome, zoom)?, "reference: bdpt"))];
    for tested in outcome.tested.iter().filter(|t| t.verdict != Verdict::NothingToReach) {
        let cell = Cell::new(map(outcome, tested, zoom)?, tested.estimator.name.clone());
        let differs = tested.verdict == Verdict::Mismatch;
        cells.push(Some(if differs { cell.outlined(FRAME) } else { cell }));
    }
    let line = |colour, text: &str| LegendLine { colour: Some(colour), text: text.to_owned() };
    let legend = vec![
        line(colour(-STRONGEST), "six standard deviations too dark, or more"),
        line(colour(0.0), "as the reference has it"),
        line(colour(STRONGEST), "six standard deviations too bright, or more"),
        line(UNTESTED[0], "too noisy to test"),
        line(BLACK, "no light by paths that it reaches"),
    ];
    let style = SheetStyle { title: Some(title.to_owned()), legend, ..SheetStyle::default() };
    lay_out(&cells, COLUMNS, &style)
}

fn reference(outcome: &Outcome, zoom: u32) -> Result<Canvas, CanvasError> {
    let window = outcome.grid.window;
    let mut pixels: Vec<Rgb> = Vec::new();
    for row in outcome.reference_pixels().chunks(window.width as usize) {
        let wide: Vec<Rgb> = row.iter().flat_map(|p| std::iter::repeat_n(*p, zoom as usize)).collect();
        (0..zoom).for_each(|_| pixels.extend(&wide));
    }
    let size = [window.width * zoom, window.height * zoom];
    Canvas::developed(&pixels, size, Default::default())
}

fn map(outcome: &Outcome, tested: &Tested, zoom: u32) -> Result<Canvas, CanvasError> {
    let (grid, window) = (outcome.grid, outcome.grid.window);
    let colours: Vec<Option<Colour>> =
        (0..grid.blocks()).map(|b| tested.trial_of(&grid, b).map(|trial| colour(trial.t))).collect();
    let (width, height) = (window.width * zoom, window.height * zoom);
    let pixel = |i: u32| {
        let (x, y) = (i % width, i / width);
        let block = grid.block_of((y / zoom * window.width + x / zoom) as usize);
        let finding = &tested.findings[0][block];
        match colours[block] {
            _ if finding.reference.mean == 0.0 && finding.estimate.mean == 0.0 => BLACK,
            Some(colour) => colour,
            // Hatched.
            None => UNTESTED[((x + y) / 4 % 2) as usize],
        }
    };
    Canvas::from_pixels(width, height, (0..width * height).map(pixel).collect())
}
