//! Blocks of pixels, and larger blocks made of four each, up to the whole picture.

use caustica_math::filter::PixelFilter;
use caustica_math::{Rgb, Vec2};
use caustica_scene::Scene;
use caustica_scene::camera::Camera;
use caustica_scene::description::Crop;

/// What is known of a block takes up to half a megabyte.
const MOST_BLOCKS: usize = 1024;

/// A picture's window, cut into square blocks.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// The window, in pixels of the full picture.
    pub window: Crop,
    /// Edge of a block in pixels; those at the right and the bottom may be smaller.
    pub block: u32,
}

impl Grid {
    /// The blocks of a scene's window: larger ones than asked for where there would be too many.
    pub fn new(scene: &Scene, block: u32) -> Self {
        let mut grid = Self { window: scene.film.window(), block: block.max(1) };
        while grid.blocks() > MOST_BLOCKS {
            grid.block *= 2;
        }
        grid
    }

    /// Pixels of the window.
    pub fn pixels(&self) -> usize {
        self.window.width as usize * self.window.height as usize
    }

    /// Columns and rows of blocks.
    pub fn size(&self) -> [u32; 2] {
        [self.window.width.div_ceil(self.block), self.window.height.div_ceil(self.block)]
    }

    /// How many blocks there are.
    pub fn blocks(&self) -> usize {
        let [columns, rows] = self.size();
        columns as usize * rows as usize
    }

    /// The index of a pixel of the full picture among the window's; `None` outside.
    pub fn pixel(&self, [x, y]: [u32; 2]) -> Option<usize> {
        let (column, row) = (x.wrapping_sub(self.window.x), y.wrapping_sub(self.window.y));
        (column < self.window.width && row < self.window.height)
            .then(|| row as usize * self.window.width as usize + column as usize)
    }

    /// The block of a pixel, by its index among the window's.
    pub fn block_of(&self, pixel: usize) -> usize {
        let width = self.window.width as usize;
        let (column, row) = (pixel % width, pixel / width);
        let edge = self.block as usize;
        row / edge * self.size()[0] as usize + column / edge
    }

    /// All pixels of the window, in the full picture's coordinates.
    pub fn each_pixel(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let w = self.window;
        (w.y..w.y + w.height).flat_map(move |y| (w.x..w.x + w.width).map(move |x| [x, y]))
    }

    /// Tells the window's pixels that see a film position, with the filter's value for each.
    pub fn each_seen(&self, filter: &PixelFilter, film: Vec2, mut tell: impl FnMut(usize, f32)) {
        if !(film.x.is_finite() && film.y.is_finite()) {
            return;
        }
        let reach = filter.radius() + 0.5;
        let range = |at: f32, start: u32, size: u32| {
            let first = (at - reach).max(start as f32) as u32;
            let last = (at + reach).min((start + size) as f32).max(0.0) as u32;
            first..last.min(start + size - 1) + 1
        };
        for y in range(film.y, self.window.y, self.window.height) {
            for x in range(film.x, self.window.x, self.window.width) {
                let value = filter.eval(x as f32 + 0.5 - film.x, y as f32 + 0.5 - film.y);
                if value != 0.0
                    && let Some(pixel) = self.pixel([x, y])
                {
                    tell(pixel, value);
                }
            }
        }
    }

    /// The same at every film position that shows the same place.
    pub fn each_splatted(
        &self,
        (camera, filter): (&Camera, &PixelFilter),
        film: Vec2,
        mut tell: impl FnMut(usize, f32),
    ) {
        if camera.wraps() {
            camera.aliases(film, filter.radius()).for_each(|film| self.each_seen(filter, film, &mut tell));
        } else {
            self.each_seen(filter, film, tell);
        }
    }

    /// The luminance of each block of a picture, summed over its pixels.
    pub fn sums(&self, pixels: &[Rgb]) -> Vec<f64> {
        let mut sums = vec![0.0; self.blocks()];
        for (i, pixel) in pixels.iter().enumerate() {
            sums[self.block_of(i)] += f64::from(pixel.luminance());
        }
        sums
    }

    /// For each level, from the blocks themselves to the whole picture, its columns and rows.
    pub fn levels(&self) -> Vec<[u32; 2]> {
        let mut levels = vec![self.size()];
        while let Some(&[columns, rows]) = levels.last()
            && columns * rows > 1
        {
            levels.push([columns.div_ceil(2), rows.div_ceil(2)]);
        }
        levels
    }

    /// The block of a level that holds a block of the finest.
    pub fn ancestor(&self, block: usize, level: usize) -> usize {
        let columns = self.size()[0] as usize;
        let (column, row) = (block % columns, block / columns);
        (row >> level) * (columns.div_ceil(1 << level)) + (column >> level)
    }

    /// The sums of a level's blocks.
    pub fn merged(&self, sums: &[f64], level: usize) -> Vec<f64> {
        let [columns, rows] = self.levels()[level];
        let mut merged = vec![0.0; (columns * rows) as usize];
        for (block, sum) in sums.iter().enumerate() {
            merged[self.ancestor(block, level)] += sum;
        }
        merged
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use caustica_math::Filter;

    fn grid() -> Grid {
        Grid { window: Crop { x: 3, y: 5, width: 21, height: 10 }, block: 4 }
    }

    #[test]
    fn blocks_merge_up_to_the_whole() {
        let grid = grid();
        assert_eq!(grid.levels(), [[6, 3], [3, 2], [2, 1], [1, 1]]);
        let sums: Vec<f64> = (0..grid.blocks()).map(|i| i as f64).collect();
        for level in 0..4 {
            assert_eq!(grid.merged(&sums, level).iter().sum::<f64>(), 153.0);
        }
        assert_eq!(grid.merged(&sums, 1)[0], 0.0 + 1.0 + 6.0 + 7.0);
        assert_eq!((grid.ancestor(17, 1), grid.ancestor(17, 2), grid.ancestor(17, 3)), (5, 1, 0));
    }

    #[test]
    fn pixels_lie_in_blocks() {
        let grid = grid();
        assert_eq!(grid.each_pixel().count(), grid.pixels());
        assert_eq!(grid.pixel([2, 5]), None);
        assert_eq!(grid.pixel([3, 15]), None);
        let last = grid.pixel([23, 14]).unwrap();
        assert_eq!((last, grid.block_of(last)), (209, 17));
        assert_eq!(grid.block_of(grid.pixel([7, 8]).unwrap()), 1);
    }

    #[test]
    fn splats_reach_as_far_as_the_filter() {
        let filter = PixelFilter::new(&Filter::Gaussian { radius: 2.0, stddev: 0.5 });
        let count = |x: f32, y: f32| {
            let mut seen = Vec::new();
            grid().each_seen(&filter, Vec2::new(x, y), |i, v| seen.push((i, v)));
            seen
        };
        let total: f32 = count(12.0, 9.0).iter().map(|s| s.1).sum();
        assert!((total - 1.0).abs() < 0.05, "{total}");
        assert!(!count(2.0, 9.0).is_empty() && count(0.4, 9.0).is_empty() && count(26.5, 9.0).is_empty());
        assert!(count(f32::NAN, 9.0).is_empty() && count(-1e30, 1e30).is_empty());
    }
}
