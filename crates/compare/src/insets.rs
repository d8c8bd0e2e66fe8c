//! Where pictures differ most.

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Left edge.
    pub x: u32,
    /// Upper edge.
    pub y: u32,
    /// Width.
    pub width: u32,
    /// Height.
    pub height: u32,
}

/// Larger errors count as this: a few wrong pixels do not make a region.
const MOST: f32 = 1.0;

/// The share of the picture's sides that a region has.
const SHARE: u32 = 7;

/// The shortest side of a region, in pixels.
const SHORTEST: u32 = 16;

/// Up to `count` regions that do not overlap, in which the errors of the pictures (per pixel, one list a picture, row
/// by row) differ most: the mean of the largest less that of the smallest. Those that differ most come first.
pub fn most_different([width, height]: [u32; 2], errors: &[&[f32]], count: usize) -> Vec<Region> {
    let side = |length: u32| (length / SHARE).max(SHORTEST).min(length);
    let (w, h) = (side(width), side(height));
    let mut found: Vec<(f32, Region)> = starts(width, w)
        .flat_map(|x| starts(height, h).map(move |y| Region { x, y, width: w, height: h }))
        .map(|region| (spread(region, width, errors), region))
        .filter(|(spread, _)| *spread > 0.0)
        .collect();
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut chosen: Vec<Region> = Vec::new();
    for (_, region) in found {
        if chosen.len() < count && !chosen.iter().any(|c| overlap(c, &region)) {
            chosen.push(region);
        }
    }
    chosen
}

/// Where regions of that length begin, in steps of about a half of it.
fn starts(length: u32, side: u32) -> impl Iterator<Item = u32> + Clone {
    let last = length - side;
    let steps = (2 * last).div_ceil(side.max(1));
    (0..=steps).map(move |i| (u64::from(i) * u64::from(last) / u64::from(steps.max(1))) as u32)
}

fn overlap(a: &Region, b: &Region) -> bool {
    let meet = |a: u32, la: u32, b: u32, lb: u32| a < b + lb && b < a + la;
    meet(a.x, a.width, b.x, b.width) && meet(a.y, a.height, b.y, b.height)
}

/// By how much the mean errors in a region differ.
fn spread(r: Region, width: u32, errors: &[&[f32]]) -> f32 {
    let mean = |picture: &&[f32]| {
        let row = |y: u32| {
            let start = (y * width + r.x) as usize;
            // What is not a number is as wrong as can be.
            let cut = |e: &f32| if *e < MOST { *e } else { MOST };
            picture[start..start + r.width as usize].iter().map(cut).sum::<f32>()
        };
        (r.y..r.y + r.height).map(row).sum::<f32>() / (r.width * r.height) as f32
    };
    let means: Vec<f32> = errors.iter().map(mean).collect();
    let largest = means.iter().copied().fold(0.0, f32::max);
    largest - means.iter().copied().fold(largest, f32::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_region_that_differs_is_found() {
        let (width, height) = (140, 112);
        let mut errors = [(); 3].map(|()| vec![0.1; width * height]);
        let patch = |x: usize, y: usize| (60..75).contains(&x) && (20..32).contains(&y);
        for y in 0..height {
            for x in 0..width {
                if patch(x, y) {
                    errors[1][y * width + x] = f32::NAN;
                }
            }
        }
        let regions = most_different([140, 112], &errors.each_ref().map(Vec::as_slice), 3);
        let first = regions[0];
        assert_eq!((first.width, first.height), (20, 16));
        assert!(first.x <= 60 && first.x + 20 >= 75 && first.y.abs_diff(20) <= 8, "{first:?}");
        for (i, a) in regions.iter().enumerate() {
            assert!(a.x + a.width <= 140 && a.y + a.height <= 112);
            assert!(regions[..i].iter().all(|b| !overlap(a, b)));
        }
    }

    #[test]
    fn nothing_differs_and_tiny_pictures() {
        assert_eq!(most_different([64, 64], &[&[0.5; 64 * 64], &[0.5; 64 * 64]], 4), []);
        assert_eq!(most_different([64, 64], &[], 4), []);
        let whole = Region { x: 0, y: 0, width: 3, height: 1 };
        assert_eq!(most_different([3, 1], &[&[0.0; 3], &[0.5; 3]], 4), [whole]);
    }
}
