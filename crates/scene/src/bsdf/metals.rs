//! Indices of refraction of metals for red, green and blue.

use caustica_math::Rgb;

type Entry = (&'static str, [f32; 3], [f32; 3]);

/// Measured spectra averaged over the three primaries, as several renderers share them; to five digits.
const METALS: [Entry; 18] = [
    ("Ag", [0.15526, 0.11672, 0.13838], [4.8283, 3.1222, 2.1470]),
    ("Al", [1.6575, 0.88037, 0.52123], [9.2239, 6.2695, 4.8370]),
    ("Au", [0.14312, 0.37496, 1.4425], [3.9832, 2.3857, 1.6032]),
    ("Be", [4.1851, 3.1851, 2.7841], [3.8354, 3.0101, 2.8690]),
    ("Cr", [4.3697, 2.9167, 1.6547], [5.2064, 4.2314, 3.7549]),
    ("Cu", [0.20044, 0.92403, 1.1022], [3.9129, 2.4528, 2.1422]),
    ("Hg", [2.3989, 1.4400, 0.90955], [6.3276, 4.3719, 3.4218]),
    ("Ir", [3.0864, 2.0822, 1.6179], [5.5922, 4.0672, 3.2673]),
    ("K", [0.064049, 0.046410, 0.038184], [2.1042, 1.3489, 0.91321]),
    ("Li", [0.26579, 0.19561, 0.22092], [3.5402, 2.3111, 1.6686]),
    ("Mo", [4.4837, 3.5255, 2.7761], [4.1111, 3.4209, 3.1506]),
    ("Na", [0.060267, 0.056141, 0.061991], [3.1793, 2.1125, 1.5791]),
    ("Nb", [3.4201, 2.7902, 2.3956], [3.4414, 2.7376, 2.5799]),
    ("Ni", [2.3673, 1.6634, 1.4671], [4.4988, 3.0502, 2.3454]),
    ("TiN", [1.6485, 1.1504, 1.3798], [3.3685, 1.9435, 1.1020]),
    ("V", [4.2775, 3.5132, 2.7611], [3.4912, 2.8894, 3.1117]),
    ("W", [4.3707, 3.3003, 2.9983], [3.5007, 2.6049, 2.2732]),
    ("none", [0.0; 3], [1.0; 3]),
];

/// The names that [`metal`] knows: chemical symbols, and `none` for a perfect mirror.
pub const METAL_NAMES: &[&str] = &{
    let mut names = [""; METALS.len()];
    let mut i = 0;
    while i < names.len() {
        names[i] = METALS[i].0;
        i += 1;
    }
    names
};

/// The complex index of refraction of a metal in vacuum, by its name: the real part η and the extinction k.
pub fn metal(name: &str) -> Option<(Rgb, Rgb)> {
    let (_, eta, k) = METALS.iter().find(|m| m.0 == name)?;
    Some((Rgb(*eta), Rgb(*k)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::fresnel::fresnel_conductor;
    use caustica_math::Wavelengths;

    fn reflectance(name: &str) -> Rgb {
        let (eta, k) = metal(name).unwrap();
        let lanes = Wavelengths::Rgb;
        lanes.rgb(fresnel_conductor(1.0, lanes.spectrum(eta), lanes.spectrum(k)))
    }

    #[test]
    fn every_name_is_known_and_reflects() {
        for name in METAL_NAMES {
            let r = reflectance(name);
            assert!(r.is_valid() && r.max_channel() > 0.4, "{name}: {r:?}");
        }
        assert!(metal("unobtainium").is_none());
    }

    #[test]
    fn colours_are_as_everyone_knows_them() {
        let Rgb([r, g, b]) = reflectance("Au");
        assert!(r > 0.9 && r > g && g > b && b < 0.5, "gold is yellow: {r} {g} {b}");
        let Rgb([r, g, b]) = reflectance("Cu");
        assert!(r > 0.9 && g < 0.75 && b < g, "copper is red: {r} {g} {b}");
        assert!(reflectance("Ag").0.iter().all(|c| *c > 0.9), "silver is bright");
        assert!(reflectance("none").0.iter().all(|c| *c == 1.0), "a perfect mirror");
    }
}
