//! Areas, lines and outlines.

use crate::{Area, Canvas, Colour};

/// `under` with `over` laid on it, which hides a share of `cover` / 255. The mean is of display values,
/// as in web pages, for which fonts and translucent bars are made.
pub(crate) fn blend(under: Colour, over: Colour, cover: u8) -> Colour {
    std::array::from_fn(|i| {
        let (a, b, c) = (u32::from(under[i]), u32::from(over[i]), u32::from(cover));
        ((a * (255 - c) + b * c + 127) / 255) as u8
    })
}

impl Canvas {
    /// Fills an area. `opacity` is the share of what is beneath that is hidden, from 0 to 1.
    pub fn fill(&mut self, area: Area, colour: Colour, opacity: f32) {
        let cover = (opacity.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        let columns = area.columns(self.width());
        for y in area.rows(self.height()) {
            for pixel in &mut self.row_mut(y)[columns.clone()] {
                *pixel = blend(*pixel, colour, cover);
            }
        }
    }

    /// Draws a frame of `thickness` pixels around an area, outside it.
    pub fn outline(&mut self, area: Area, colour: Colour, thickness: u32) {
        let Area { x, y, width, height } = area;
        let t = thickness.min(i32::MAX as u32 / 4) as i32;
        let (wide, tall) = (width.saturating_add(2 * t as u32), height.saturating_add(2 * t as u32));
        let (left, top) = (x.saturating_sub(t), y.saturating_sub(t));
        let (right, bottom) = (x.saturating_add_unsigned(width), y.saturating_add_unsigned(height));
        self.fill(Area::new(left, top, wide, t as u32), colour, 1.0);
        self.fill(Area::new(left, bottom, wide, t as u32), colour, 1.0);
        self.fill(Area::new(left, top, t as u32, tall), colour, 1.0);
        self.fill(Area::new(right, top, t as u32, tall), colour, 1.0);
    }

    /// Draws a line one pixel wide, both ends included. What lies off the canvas is left out.
    pub fn line(&mut self, from: (i32, i32), to: (i32, i32), colour: Colour) {
        let (dx, dy) = (i64::from(to.0) - i64::from(from.0), i64::from(to.1) - i64::from(from.1));
        let steep = dy.abs() > dx.abs();
        let turn =
            |(x, y): (i32, i32)| if steep { (i64::from(y), i64::from(x)) } else { (x.into(), y.into()) };
        let (mut start, mut end) = (turn(from), turn(to));
        if start.0 > end.0 {
            std::mem::swap(&mut start, &mut end);
        }
        let limit = i64::from(if steep { self.height() } else { self.width() });
        // Products of two differences of 33 bits.
        let (run, rise) = (i128::from(end.0 - start.0), i128::from(end.1 - start.1));
        for along in start.0.max(0)..=end.0.min(limit - 1) {
            let gone = i128::from(along - start.0);
            // Rounded half up; a line of one point has no run and no rise.
            let across = i128::from(start.1) + (2 * gone * rise + run).div_euclid((2 * run).max(1));
            let (x, y) = if steep { (across, i128::from(along)) } else { (i128::from(along), across) };
            self.put(x, y, colour);
        }
    }

    fn put(&mut self, x: i128, y: i128, colour: Colour) {
        if (0..i128::from(self.width())).contains(&x) && (0..i128::from(self.height())).contains(&y) {
            self.row_mut(y as usize)[x as usize] = colour;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE: Colour = [255; 3];

    fn lit(canvas: &Canvas) -> Vec<(u32, u32)> {
        let places = (0..canvas.height()).flat_map(|y| (0..canvas.width()).map(move |x| (x, y)));
        places.filter(|(x, y)| canvas.get(*x, *y) == Some(WHITE)).collect()
    }

    fn lit_by_line(from: (i32, i32), to: (i32, i32)) -> Vec<(u32, u32)> {
        let mut canvas = Canvas::new(6, 5, [0; 3]).unwrap();
        canvas.line(from, to, WHITE);
        lit(&canvas)
    }

    #[test]
    fn lines_are_one_pixel_wide_and_include_their_ends() {
        assert_eq!(lit_by_line((1, 2), (4, 2)), [(1, 2), (2, 2), (3, 2), (4, 2)]);
        assert_eq!(lit_by_line((3, 4), (3, 1)), [(3, 1), (3, 2), (3, 3), (3, 4)]);
        assert_eq!(lit_by_line((0, 0), (4, 4)), [(0, 0), (1, 1), (2, 2), (3, 3), (4, 4)]);
        assert_eq!(lit_by_line((4, 0), (0, 2)), [(4, 0), (2, 1), (3, 1), (0, 2), (1, 2)]);
        assert_eq!(lit_by_line((2, 2), (2, 2)), [(2, 2)]);
    }

    #[test]
    fn long_lines_are_clipped() {
        let row: Vec<_> = (0..6).map(|x| (x, 3)).collect();
        assert_eq!(lit_by_line((i32::MIN, 3), (i32::MAX, 3)), row);
        assert_eq!(lit_by_line((i32::MIN, i32::MIN), (i32::MAX, i32::MAX)).len(), 5);
        assert!(lit_by_line((-5, -1), (20, -1)).is_empty());
    }

    #[test]
    fn fills_blend_display_values() {
        let mut canvas = Canvas::new(2, 1, [100, 200, 0]).unwrap();
        canvas.fill(Area::new(1, 0, 9, 9), WHITE, 0.6);
        assert_eq!(canvas.pixels(), [[100, 200, 0], [193, 233, 153]]);
        // 200 · 77 / 255 and 25 · 178 / 255 add up to 77.8.
        let mut rounded = Canvas::new(1, 1, [25; 3]).unwrap();
        rounded.fill(Area::new(0, 0, 1, 1), [200; 3], 0.3);
        assert_eq!(rounded.pixels(), [[78; 3]]);
        canvas.fill(Area::new(-7, -7, 8, 8), [1, 2, 3], 7.0);
        assert_eq!(canvas.pixels()[0], [1, 2, 3]);
        canvas.fill(Area::new(0, 0, 2, 1), WHITE, f32::NAN);
        assert_eq!(canvas.pixels()[0], [1, 2, 3]);
    }

    #[test]
    fn outlines_surround_their_area() {
        let mut canvas = Canvas::new(6, 5, [0; 3]).unwrap();
        canvas.outline(Area::new(2, 1, 2, 2), WHITE, 1);
        let inside = |x: u32, y: u32| (2..4).contains(&x) && (1..3).contains(&y);
        let around = |x: u32, y: u32| (1..5).contains(&x) && y < 4 && !inside(x, y);
        assert!(lit(&canvas).iter().all(|(x, y)| around(*x, *y)));
        assert_eq!(lit(&canvas).len(), 12);
        canvas.outline(Area::new(i32::MIN, i32::MAX, u32::MAX, u32::MAX), WHITE, u32::MAX);
    }
}
