//! The colours that spectra are seen as: the CIE 1931 standard observer and illuminant D65 (CIE 15, tables T.4 and T.1),
//! every 10 nm, with straight lines between.

/// The first and last wavelength of the tables, nm.
pub(super) const FIRST: f64 = 380.0;
pub(super) const LAST: f64 = 780.0;
const STEP: f64 = 10.0;
const ROWS: usize = 41;

/// x̄, ȳ, z̄ and D65's relative power.
#[rustfmt::skip]
const TABLE: [[f64; 4]; ROWS] = [
    [0.001368, 0.000039, 0.006450, 49.9755], [0.004243, 0.000120, 0.020050, 54.6482],
    [0.014310, 0.000396, 0.067850, 82.7549], [0.043510, 0.001210, 0.207400, 91.4860],
    [0.134380, 0.004000, 0.645600, 93.4318], [0.283900, 0.011600, 1.385600, 86.6823],
    [0.348280, 0.023000, 1.747060, 104.865], [0.336200, 0.038000, 1.772110, 117.008],
    [0.290800, 0.060000, 1.669200, 117.812], [0.195360, 0.090980, 1.287640, 114.861],
    [0.095640, 0.139020, 0.812950, 115.923], [0.032010, 0.208020, 0.465180, 108.811],
    [0.004900, 0.323000, 0.272000, 109.354], [0.009300, 0.503000, 0.158200, 107.802],
    [0.063270, 0.710000, 0.078250, 104.790], [0.165500, 0.862000, 0.042160, 107.689],
    [0.290400, 0.954000, 0.020300, 104.405], [0.433450, 0.994950, 0.008750, 104.046],
    [0.594500, 0.995000, 0.003900, 100.000], [0.762100, 0.952000, 0.002100, 96.3342],
    [0.916300, 0.870000, 0.001650, 95.7880], [1.026300, 0.757000, 0.001100, 88.6856],
    [1.062200, 0.631000, 0.000800, 90.0062], [1.002600, 0.503000, 0.000340, 89.5991],
    [0.854450, 0.381000, 0.000190, 87.6987], [0.642400, 0.265000, 0.000050, 83.2886],
    [0.447900, 0.175000, 0.000020, 83.6992], [0.283500, 0.107000, 0.000000, 80.0268],
    [0.164900, 0.061000, 0.000000, 80.2146], [0.087400, 0.032000, 0.000000, 82.2778],
    [0.046770, 0.017000, 0.000000, 78.2842], [0.022700, 0.008210, 0.000000, 69.7213],
    [0.011359, 0.004102, 0.000000, 71.6091], [0.005790, 0.002091, 0.000000, 74.3490],
    [0.002899, 0.001047, 0.000000, 61.6040], [0.001440, 0.000520, 0.000000, 69.8856],
    [0.000690, 0.000249, 0.000000, 75.0870], [0.000332, 0.000120, 0.000000, 63.5927],
    [0.000166, 0.000060, 0.000000, 46.4182], [0.000083, 0.000030, 0.000000, 66.8054],
    [0.000042, 0.000015, 0.000000, 63.3828],
];

/// The table's row at a wavelength between [`FIRST`] and [`LAST`].
fn row(wavelength: f64) -> [f64; 4] {
    let at = ((wavelength - FIRST) / STEP).clamp(0.0, (ROWS - 1) as f64);
    let index = (at as usize).min(ROWS - 2);
    let t = at - index as f64;
    [0, 1, 2, 3].map(|i| TABLE[index][i] * (1.0 - t) + TABLE[index + 1][i] * t)
}

/// What a spectrum is multiplied by before it is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Light {
    /// Nothing: it is light itself. A spectrum of one has luminance one.
    Itself,
    /// Illuminant D65: it is a reflectance. One is white.
    D65,
}

/// Linear BT.709 of a spectrum, not clipped to what can be shown.
pub(super) fn to_rgb(spectrum: impl Fn(f64) -> f64, light: Light) -> [f64; 3] {
    let (mut xyz, mut whole) = ([0.0; 3], 0.0);
    // Every nanometre, in the middle.
    for i in 0..(LAST - FIRST) as u32 {
        let wavelength = FIRST + f64::from(i) + 0.5;
        let [x, y, z, d65] = row(wavelength);
        let weight = if light == Light::D65 { d65 } else { 1.0 };
        let value = spectrum(wavelength) * weight;
        whole += y * weight;
        xyz = [xyz[0] + x * value, xyz[1] + y * value, xyz[2] + z * value];
    }
    let [x, y, z] = xyz.map(|c| c / whole);
    // IEC 61966-2-1's inverse matrix.
    [
        3.240_969_94 * x - 1.537_383_18 * y - 0.498_610_76 * z,
        -0.969_243_64 * x + 1.875_967_50 * y + 0.041_555_06 * z,
        0.055_630_08 * x - 0.203_976_96 * y + 1.056_971_51 * z,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: [f64; 3], b: [f64; 3], tolerance: f64) {
        assert!((0..3).all(|i| (a[i] - b[i]).abs() <= tolerance * b[i].abs()), "{a:?} {b:?}");
    }

    #[test]
    fn a_white_reflectance_is_white() {
        close(to_rgb(|_| 1.0, Light::D65), [1.0; 3], 3e-3);
    }

    #[test]
    fn equal_energy_has_its_published_colour() {
        // x = y = z in sRGB's primaries.
        close(to_rgb(|_| 1.0, Light::Itself), [1.204_98, 0.948_28, 0.908_63], 2e-3);
    }
}
