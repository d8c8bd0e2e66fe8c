//! Colours as the eye compares them.
//!
//! ꟻLIP filters in the opponent space YCxCz (Flohr et al. 1993), which is linear in light: with
//! tristimulus values x, y, z relative to white, Y = 116 y − 16, Cx = 500 (x − y) and Cz = 200 (y − z).
//! Its filters keep constants as they are, so that y, x − y and y − z can be filtered instead, and the
//! scales and the offset are not needed.

/// From linear Rec. 709 light to tristimulus values relative to white (D65): each row adds up to one.
const TO_TRISTIMULUS: [[f32; 3]; 3] = [
    [0.433_895_4, 0.376_242_37, 0.189_862_24],
    [0.212_636_82, 0.715_183, 0.072_180_2],
    [0.017_752_423, 0.109_465_63, 0.872_781_95],
];

/// The inverse of [`TO_TRISTIMULUS`].
const FROM_TRISTIMULUS: [[f32; 3]; 3] = [
    [3.080_342, -1.537_399, -0.542_943],
    [-0.921_178_4, 1.875_93, 0.045_248_41],
    [0.052_881_293, -0.204_011_21, 1.151_129_9],
];

/// The exponent of the colour difference (q_c in the paper).
const COLOUR_EXPONENT: f32 = 0.7;

/// Differences up to this share of the greatest one (p_c) …
const COMMON_SHARE: f32 = 0.4;

/// … take this share of the scale (p_t).
const COMMON_SCALE: f32 = 0.95;

/// (y, x − y, y − z) of linear light.
#[inline]
pub(super) fn opponents(light: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = transform(&TO_TRISTIMULUS, light);
    [y, x - y, y - z]
}

/// Lightness and Hunt-adjusted chroma of opponent values: brought into the display's range, then CIELAB
/// with a* and b* multiplied by L* / 100 (the paper's colour pipeline).
#[inline]
pub(super) fn appearance([y, x_less_y, y_less_z]: [f32; 3]) -> [f32; 3] {
    let light = transform(&FROM_TRISTIMULUS, [y + x_less_y, y, y - y_less_z]).map(|c| c.clamp(0.0, 1.0));
    let [x, y, z] = transform(&TO_TRISTIMULUS, light).map(cube_root);
    let lightness = 116.0 * y - 16.0;
    let hunt = 0.01 * lightness;
    [lightness, hunt * 500.0 * (x - y), hunt * 200.0 * (y - z)]
}

/// CIELAB's cube root, which is a straight line below (6/29)³.
#[inline]
fn cube_root(t: f32) -> f32 {
    const KNEE: f32 = 6.0 / 29.0;
    if t > KNEE * KNEE * KNEE { libm::cbrtf(t) } else { t / (3.0 * KNEE * KNEE) + 4.0 / 29.0 }
}

/// The scale of colour differences.
#[derive(Clone, Copy)]
pub(super) struct ColourScale {
    /// The greatest difference of two colours of the display, that between green and blue.
    greatest: f32,
}

impl ColourScale {
    /// The scale of a Rec. 709 display.
    pub(super) fn new() -> Self {
        let of = |light| appearance(opponents(light));
        Self { greatest: power_of_distance(of([0.0, 1.0, 0.0]), of([0.0, 0.0, 1.0])) }
    }

    /// The difference of two appearances, from 0 to 1: large ones, which are rare, are squeezed.
    #[inline]
    pub(super) fn difference(self, a: [f32; 3], b: [f32; 3]) -> f32 {
        let (found, common) = (power_of_distance(a, b), COMMON_SHARE * self.greatest);
        if found < common {
            COMMON_SCALE * found / common
        } else {
            let beyond = (found - common) / (self.greatest - common);
            (COMMON_SCALE + (1.0 - COMMON_SCALE) * beyond).min(1.0)
        }
    }
}

/// The HyAB distance, city block in lightness and Euclidean in chroma, to its power.
#[inline]
fn power_of_distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    let (da, db) = (a[1] - b[1], a[2] - b[2]);
    libm::powf((a[0] - b[0]).abs() + (da * da + db * db).sqrt(), COLOUR_EXPONENT)
}

#[inline]
fn transform(rows: &[[f32; 3]; 3], [a, b, c]: [f32; 3]) -> [f32; 3] {
    [
        rows[0][0] * a + rows[0][1] * b + rows[0][2] * c,
        rows[1][0] * a + rows[1][1] * b + rows[1][2] * c,
        rows[2][0] * a + rows[2][1] * b + rows[2][2] * c,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_neutral_and_the_matrices_undo_each_other() {
        let [lightness, a, b] = appearance(opponents([1.0; 3]));
        assert!((lightness - 100.0).abs() < 1e-3 && a.abs() < 1e-3 && b.abs() < 1e-3);
        let light = [0.2, 0.5, 0.9];
        let back = transform(&FROM_TRISTIMULUS, transform(&TO_TRISTIMULUS, light));
        assert!((0..3).all(|c| (back[c] - light[c]).abs() < 1e-6), "{back:?}");
    }

    #[test]
    fn known_lab_values() {
        // sRGB red and blue in CIELAB (D65), as many tables give them; chroma here times L*/100.
        for (light, [l, a, b]) in
            [([1.0, 0.0, 0.0], [53.24, 80.09, 67.20]), ([0.0, 0.0, 1.0], [32.30, 79.19, -107.86])]
        {
            let found = appearance(opponents(light));
            let expected = [l, a * l / 100.0, b * l / 100.0];
            assert!((0..3).all(|c| (found[c] - expected[c]).abs() < 0.05), "{found:?}, not {expected:?}");
        }
    }

    #[test]
    fn no_two_colours_are_farther_apart_than_green_and_blue() {
        let grid = |i: usize| [i % 5, i / 5 % 5, i / 25].map(|c| c as f32 / 4.0);
        let colours: Vec<_> = (0..125).map(|i| appearance(opponents(grid(i)))).collect();
        let greatest = ColourScale::new().greatest;
        for a in &colours {
            assert!(colours.iter().all(|b| power_of_distance(*a, *b) <= greatest));
        }
    }
}
