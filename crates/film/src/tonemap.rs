//! From linear light to what a display shows.

use std::fmt;
use std::str::FromStr;

use caustica_math::Rgb;
use caustica_math::elementary::{ln, pow};
use serde::{Deserialize, Serialize};

use crate::FilmError;

/// How linear light is brought into the range of a display.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ToneMap {
    /// Clamped to [0, 1]: exact below white, and for comparisons.
    #[default]
    Srgb,
    /// Troy Sobotka's AgX, base look: highlights roll off and bright colours fade to white.
    #[serde(rename = "agx")]
    Filmic,
}

impl fmt::Display for ToneMap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Srgb => "srgb",
            Self::Filmic => "agx",
        })
    }
}

impl FromStr for ToneMap {
    type Err = FilmError;

    fn from_str(name: &str) -> Result<Self, FilmError> {
        match name {
            "srgb" => Ok(Self::Srgb),
            "agx" | "filmic" => Ok(Self::Filmic),
            _ => Err(FilmError::unknown("tone map", name, "srgb or agx")),
        }
    }
}

/// The bytes of an sRGB display for linear BT.709 light, made brighter by `exposure_stops` powers of
/// two. NaN becomes black.
pub fn to_display(linear: Rgb, exposure_stops: f32, tone_map: ToneMap) -> [u8; 3] {
    let gain = pow(2.0, exposure_stops);
    // `max` takes the number where the other is NaN.
    let exposed = linear.map(|c| (c * gain).max(0.0));
    let mapped = match tone_map {
        ToneMap::Srgb => exposed,
        ToneMap::Filmic => agx(exposed),
    };
    mapped.0.map(|c| (srgb_oetf(c.clamp(0.0, 1.0)) * 255.0 + 0.5) as u8)
}

/// The transfer function of IEC 61966-2-1, for `linear` in [0, 1].
fn srgb_oetf(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * pow(linear, 1.0 / 2.4) - 0.055 }
}

/// Draws the primaries in, so that strong colours leave some light in every channel.
const AGX_INSET: [[f32; 3]; 3] = [
    [0.842_479_06, 0.078_433_6, 0.079_223_745],
    [0.042_328_242, 0.878_468_64, 0.079_166_13],
    [0.042_375_654, 0.078_433_6, 0.879_143],
];

/// The inverse of the inset.
const AGX_OUTSET: [[f32; 3]; 3] = [
    [1.196_879, -0.098_020_88, -0.099_029_74],
    [-0.052_896_85, 1.151_903_1, -0.098_961_174],
    [-0.052_971_635, -0.098_043_45, 1.151_073_7],
];

/// The range of the curve in stops.
const AGX_DARKEST: f32 = -12.473_93;
const AGX_BRIGHTEST: f32 = 4.026_069;

/// The curve's fit of the sixth degree, from the constant up.
const AGX_CONTRAST: [f32; 7] = [-0.002_32, 0.119_1, 0.429_8, -6.868, 31.96, -40.14, 15.5];

/// AgX's base look, with the constants that Benjamin Wrensch published for BT.709 primaries. The curve
/// leads to display values of a pure 2.2 power, from which linear light is made again.
fn agx(linear: Rgb) -> Rgb {
    let shaped = transform(&AGX_INSET, linear).map(|c| {
        let stops = ln(c.max(1e-10)) * std::f32::consts::LOG2_E;
        let x = (stops.clamp(AGX_DARKEST, AGX_BRIGHTEST) - AGX_DARKEST) / (AGX_BRIGHTEST - AGX_DARKEST);
        AGX_CONTRAST.iter().rev().fold(0.0, |sum, k| sum * x + k)
    });
    transform(&AGX_OUTSET, shaped).map(|c| pow(c.max(0.0), 2.2))
}

fn transform(rows: &[[f32; 3]; 3], Rgb([r, g, b]): Rgb) -> Rgb {
    Rgb(rows.map(|row| row[0] * r + row[1] * g + row[2] * b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(value: f32, stops: f32, tone_map: ToneMap) -> u8 {
        let [r, g, b] = to_display(Rgb::splat(value), stops, tone_map);
        assert!(r.abs_diff(g) <= 1 && g.abs_diff(b) <= 1, "{value} is not grey: {r} {g} {b}");
        g
    }

    #[test]
    fn anchors_of_srgb() {
        let table = [(0.0, 0), (-1.0, 0), (0.001, 3), (0.18, 118), (0.5, 188), (1.0, 255), (7.0, 255)];
        for (linear, byte) in table {
            assert_eq!(grey(linear, 0.0, ToneMap::Srgb), byte, "{linear}");
        }
        assert_eq!(grey(0.09, 1.0, ToneMap::Srgb), 118);
        assert_eq!(grey(0.72, -2.0, ToneMap::Srgb), 118);
        assert_eq!(to_display(Rgb::new(1.0, 0.0, 0.18), 0.0, ToneMap::Srgb), [255, 0, 118]);
    }

    #[test]
    fn agx_is_monotone_and_keeps_middle_grey() {
        let mut previous = 0;
        for i in -160..=80 {
            let now = grey(pow(2.0, i as f32 / 10.0), 0.0, ToneMap::Filmic);
            assert!(now >= previous, "at {i}: {previous}, then {now}");
            previous = now;
        }
        assert_eq!(grey(0.0, 0.0, ToneMap::Filmic), 0);
        let middle = grey(0.18, 0.0, ToneMap::Filmic);
        // The curve's pivot: a middle grey of 0.18 in the middle of the display's range.
        assert!((126..=129).contains(&middle), "{middle}");
        assert!(grey(1.0, 0.0, ToneMap::Filmic) < 230 && grey(17.0, 0.0, ToneMap::Filmic) > 250);
    }

    /// Worked out from the published constants in double precision, apart from this code.
    #[test]
    fn anchors_of_agx() {
        for (linear, bytes) in [
            ([0.8, 0.2, 0.05], [202, 137, 88]),
            ([0.02, 0.3, 4.0], [150, 176, 246]),
            ([0.18, 1.5, 0.0], [144, 225, 98]),
        ] {
            assert_eq!(to_display(Rgb(linear), 0.0, ToneMap::Filmic), bytes);
        }
    }

    #[test]
    fn agx_fades_bright_colours() {
        let [r, g, b] = to_display(Rgb::new(50.0, 0.0, 0.0), 0.0, ToneMap::Filmic);
        assert!(r > 240 && g > 100 && b > 100, "{r} {g} {b}");
    }

    #[test]
    fn what_is_not_finite_does_not_spread() {
        for tone_map in [ToneMap::Srgb, ToneMap::Filmic] {
            assert_eq!(to_display(Rgb::splat(f32::NAN), 0.0, tone_map), [0; 3]);
            assert!(to_display(Rgb::splat(f32::INFINITY), 0.0, tone_map).iter().all(|b| *b > 250));
            assert_eq!(to_display(Rgb::splat(f32::NEG_INFINITY), 0.0, tone_map), [0; 3]);
        }
        assert_eq!(to_display(Rgb::new(f32::NAN, 1.0, 0.18), 0.0, ToneMap::Srgb), [0, 255, 118]);
        let black_red = to_display(Rgb::new(0.0, 1.0, 0.18), 0.0, ToneMap::Filmic);
        for odd in [f32::NAN, f32::NEG_INFINITY, -5.0] {
            assert_eq!(to_display(Rgb::new(odd, 1.0, 0.18), 0.0, ToneMap::Filmic), black_red, "{odd}");
        }
    }

    #[test]
    fn names_round_trip() {
        for tone_map in [ToneMap::Srgb, ToneMap::Filmic] {
            assert_eq!(tone_map.to_string().parse::<ToneMap>().unwrap(), tone_map);
        }
        assert_eq!("filmic".parse::<ToneMap>().unwrap(), ToneMap::Filmic);
        assert!("aces".parse::<ToneMap>().is_err());
    }
}
