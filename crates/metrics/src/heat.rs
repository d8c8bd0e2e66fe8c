//! Values as colours.

/// Seventeen colours at equal distances, fitted by least squares to matplotlib's *magma* (Nathaniel
/// Smith and Stéfan van der Walt, CC0), so that straight lines between them stay within 2 of 255 of it.
const MAGMA: [[u8; 3]; 17] = [
    [0, 0, 2],
    [9, 8, 33],
    [28, 18, 70],
    [53, 15, 108],
    [81, 17, 125],
    [105, 28, 129],
    [130, 38, 130],
    [156, 46, 128],
    [182, 54, 122],
    [208, 64, 112],
    [231, 80, 99],
    [245, 105, 91],
    [252, 135, 96],
    [254, 165, 112],
    [254, 195, 135],
    [253, 224, 161],
    [252, 253, 191],
];

/// The sRGB bytes of `value` in the palette *magma*: 0 is nearly black, then come purple and orange, and
/// 1 is pale yellow. What lies outside of [0, 1] takes the nearer end, and NaN the colour of 1, so that
/// it does not pass unseen.
pub fn heat(value: f32) -> [u8; 3] {
    let value = if value.is_nan() { 1.0 } else { value.clamp(0.0, 1.0) };
    let place = value * (MAGMA.len() - 1) as f32;
    let lower = (place as usize).min(MAGMA.len() - 2);
    let part = place - lower as f32;
    std::array::from_fn(|c| {
        let (from, to) = (f32::from(MAGMA[lower][c]), f32::from(MAGMA[lower + 1][c]));
        (from + (to - from) * part + 0.5) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_through_magma() {
        // Entries 0, 64, 128, 200 and 255 of matplotlib's table, rounded to bytes.
        let table = [
            (0, [0, 0, 4]),
            (64, [81, 18, 124]),
            (128, [183, 55, 121]),
            (200, [253, 152, 105]),
            (255, [252, 253, 191]),
        ];
        for (index, expected) in table {
            let found = heat(index as f32 / 255.0);
            assert!(
                (0..3).all(|c| found[c].abs_diff(expected[c]) <= 2),
                "{index}: {found:?}, not {expected:?}"
            );
        }
    }

    #[test]
    fn grows_brighter_all_the_way() {
        let light =
            |v: f32| heat(v).iter().zip([2126, 7152, 722]).map(|(c, w)| u32::from(*c) * w).sum::<u32>();
        let steps: Vec<u32> = (0..=64).map(|i| light(i as f32 / 64.0)).collect();
        assert!(steps.is_sorted(), "{steps:?}");
    }

    #[test]
    fn what_is_out_of_range_takes_an_end() {
        assert_eq!(heat(-1.0), heat(0.0));
        for value in [2.0, f32::INFINITY, f32::NAN] {
            assert_eq!(heat(value), heat(1.0));
        }
    }
}
