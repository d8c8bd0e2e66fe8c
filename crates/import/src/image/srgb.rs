//! sRGB's transfer function.

use caustica_math::elementary::pow;

/// The linear value of an encoded one, both in [0, 1].
pub(super) fn to_linear(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { pow((encoded + 0.055) / 1.055, 2.4) }
}

/// The linear values of all codes up to `largest`.
pub(super) fn table(largest: u16) -> Vec<f32> {
    (0..=largest).map(|code| to_linear(f32::from(code) / f32::from(largest))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values() {
        assert_eq!((to_linear(0.0), to_linear(1.0)), (0.0, 1.0));
        assert!((table(255)[128] - 0.215_860_5).abs() < 1e-6);
        assert!((table(255)[5] - 5.0 / 255.0 / 12.92).abs() < 1e-7);
        assert!((table(65535)[32896] - table(255)[128]).abs() < 1e-6);
    }
}
