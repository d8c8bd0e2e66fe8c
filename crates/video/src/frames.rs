//! Frames made from pictures: captions, labels, comparisons.

use caustica_canvas::{
    Area, Canvas, CanvasError, Colour, TextSize, TextStyle, from_linear, shortened, to_linear,
};

use crate::VideoError;

const BAR: Colour = [0, 0, 0];
const BAR_OPACITY: f32 = 0.62;
const TEXT: Colour = [240, 240, 240];
const LINE: Colour = [245, 245, 245];
/// Between pictures that stand side by side.
const JOINT: Colour = [27, 27, 27];

/// A corner of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// The upper left one.
    TopLeft,
    /// The upper right one.
    TopRight,
}

/// Writes a line on a dark translucent bar along the bottom: `left` at its left, such as the integrator,
/// and `right` at its right, such as samples and time. Where both do not fit, the text becomes
/// smaller; where that does not help, `left` is shortened first, then `right`.
pub fn caption(canvas: &mut Canvas, left: &str, right: &str) {
    let (width, height) = (canvas.width(), canvas.height());
    let fits = |size: &TextSize| {
        let between = if left.is_empty() || right.is_empty() { 0 } else { 2 * size.advance() };
        size.width_of(left).saturating_add(size.width_of(right)).saturating_add(between) <= room(*size, width)
    };
    let largest = TextSize::for_height(height);
    let size =
        TextSize::ALL.into_iter().rev().filter(|s| *s <= largest).find(fits).unwrap_or(TextSize::Small);
    let right = shortened(right, size, room(size, width));
    let right_width = size.width_of(&right);
    let taken = if right.is_empty() { 0 } else { right_width + 2 * size.advance() };
    let left = shortened(left, size, room(size, width).saturating_sub(taken));

    let bar = bar_height(size).min(height);
    let top = (height - bar) as i32;
    canvas.fill(Area::new(0, top, width, bar), BAR, BAR_OPACITY);
    let y = top + (bar_height(size) - size.height()) as i32 / 2;
    let style = TextStyle::new(size, TEXT);
    canvas.text(size.advance() as i32, y, &left, style);
    canvas.text(width as i32 - (size.advance() + right_width) as i32, y, &right, style);
}

/// Writes a few words on a dark translucent ground in a corner, such as what is seen in that half.
pub fn label(canvas: &mut Canvas, text: &str, corner: Corner) {
    let size = TextSize::for_height(canvas.height());
    let text = shortened(text, size, room(size, canvas.width()));
    let margin = size.advance() as i32;
    let width = size.width_of(&text) + 2 * size.advance();
    let x = match corner {
        Corner::TopLeft => margin,
        Corner::TopRight => canvas.width() as i32 - margin - width as i32,
    };
    if !text.is_empty() {
        canvas.fill(Area::new(x, margin, width, bar_height(size)), BAR, BAR_OPACITY);
        let y = margin + (bar_height(size) - size.height()) as i32 / 2;
        canvas.text(x + margin, y, &text, TextStyle::new(size, TEXT));
    }
}

/// What text may take of a width, with a margin of one character at each side.
fn room(size: TextSize, width: u32) -> u32 {
    width.saturating_sub(2 * size.advance())
}

fn bar_height(size: TextSize) -> u32 {
    size.height() * 3 / 2
}

/// The left `share` of `a` and the rest of `b`, with a thin bright line between them unless the share is 0
/// or 1. An error if the pictures differ in size.
pub fn wipe(a: &Canvas, b: &Canvas, share: f32) -> Result<Canvas, VideoError> {
    check_same_size(a, b)?;
    let (width, height) = (a.width(), a.height());
    let edge = (f64::from(share.clamp(0.0, 1.0)) * f64::from(width) + 0.5) as u32;
    let mut joined = b.clone();
    let rows = joined.pixels_mut().chunks_exact_mut(width as usize);
    for (to, from) in rows.zip(a.pixels().chunks_exact(width as usize)) {
        to[..edge as usize].copy_from_slice(&from[..edge as usize]);
    }
    if 0 < edge && edge < width {
        let thickness = 1 + height / 600;
        let left = edge as i32 - thickness as i32 / 2;
        // Dark flanks keep the line visible on bright pictures.
        upright_line(&mut joined, left - 1, thickness + 2, (BAR, 0.5));
        upright_line(&mut joined, left, thickness, (LINE, 1.0));
    }
    Ok(joined)
}

fn upright_line(canvas: &mut Canvas, x: i32, width: u32, (colour, opacity): (Colour, f32)) {
    canvas.fill(Area::new(x, 0, width, canvas.height()), colour, opacity);
}

/// Both pictures beside each other, twice as wide as one, with a narrow dark line over their joint. An error if
/// they differ in size.
pub fn side_by_side(a: &Canvas, b: &Canvas) -> Result<Canvas, VideoError> {
    check_same_size(a, b)?;
    let (width, height) = (a.width(), a.height());
    let too_wide = || CanvasError::Size { width: u64::from(width) * 2, height: height.into() };
    let mut joined = Canvas::new(width.checked_mul(2).ok_or_else(too_wide)?, height, BAR)?;
    joined.blit(a, 0, 0);
    joined.blit(b, width as i32, 0);
    let half = 1 + height / 600;
    upright_line(&mut joined, width as i32 - half as i32, 2 * half, (JOINT, 1.0));
    Ok(joined)
}

/// The mean of two pictures in linear light, with a weight of `share` for `b`: 0 is `a`, 1 is `b`. An error
/// if they differ in size.
pub fn cross_fade(a: &Canvas, b: &Canvas, share: f32) -> Result<Canvas, VideoError> {
    check_same_size(a, b)?;
    let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
    let mut faded = a.clone();
    for (to, from) in faded.pixels_mut().iter_mut().zip(b.pixels()) {
        if to != from {
            *to = from_linear(to_linear(*to) * (1.0 - share) + to_linear(*from) * share);
        }
    }
    Ok(faded)
}

fn check_same_size(a: &Canvas, b: &Canvas) -> Result<(), VideoError> {
    if (a.width(), a.height()) == (b.width(), b.height()) {
        Ok(())
    } else {
        Err(VideoError::Mismatch(a.width(), a.height(), b.width(), b.height()))
    }
}

#[cfg(test)]
#[path = "frames/tests.rs"]
mod tests;
