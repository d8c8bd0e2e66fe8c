//! Developed pictures.

use std::fmt;
use std::str::FromStr;

use caustica_math::Rgb;
use serde::{Deserialize, Serialize};

use crate::FilmError;
use crate::film::{CHANNELS, EYE, FilmCounts, LIGHT};
use crate::layout::{FilmLayout, Window, check_layer, check_window};
use crate::quantum::Quantum;

/// What part the light image plays in the combined picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LightImage {
    /// It is added to the eye image.
    #[default]
    On,
    /// It is left out.
    Off,
    /// It stands alone.
    Only,
}

impl fmt::Display for LightImage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::On => "on",
            Self::Off => "off",
            Self::Only => "only",
        })
    }
}

impl FromStr for LightImage {
    type Err = FilmError;

    fn from_str(name: &str) -> Result<Self, FilmError> {
        match name {
            "on" => Ok(Self::On),
            "off" => Ok(Self::Off),
            "only" => Ok(Self::Only),
            _ => Err(FilmError::unknown("light image setting", name, "on, off or only")),
        }
    }
}

/// A developed film: the two layers, each divided by its own number of samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width of the full picture in pixels.
    pub width: u32,
    /// Height of the full picture in pixels.
    pub height: u32,
    /// The part of it that the layers hold.
    pub window: Window,
    /// Samples per pixel of the eye image.
    pub eye_samples: u64,
    /// Passes of light paths of the light image.
    pub light_samples: u64,
    /// The eye image, row by row.
    pub eye: Vec<Rgb>,
    /// The light image, row by row.
    pub light: Vec<Rgb>,
    /// Half the width of the 95 % interval around eye and light image together, where it is known: see
    /// [`ErrorBars`](crate::ErrorBars).
    pub error: Option<Vec<Rgb>>,
    /// What else is known of its pixels.
    pub channels: Vec<Channel>,
}

/// A channel beside the picture, such as `depth.T`.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name, with that of its layer.
    pub name: String,
    /// Its values, row by row.
    pub values: Vec<f32>,
}

impl Picture {
    /// The picture to look at.
    pub fn combined(&self, light_image: LightImage) -> Vec<Rgb> {
        match light_image {
            LightImage::On => self.eye.iter().zip(&self.light).map(|(e, l)| *e + *l).collect(),
            LightImage::Off => self.eye.clone(),
            LightImage::Only => self.light.clone(),
        }
    }

    /// Whether the window fits the picture and the layers fit the window.
    pub(crate) fn check(&self) -> Result<(), FilmError> {
        check_window(self.width, self.height, self.window)?;
        check_layer(self.eye.len(), self.window)?;
        check_layer(self.light.len(), self.window)?;
        self.error.as_ref().map_or(Ok(()), |error| check_layer(error.len(), self.window))?;
        self.channels.iter().try_for_each(|c| check_layer(c.values.len(), self.window))
    }
}

/// The picture of these sums, without error bars.
pub(crate) fn develop<I: Iterator<Item = [i64; CHANNELS]>>(
    layout: &FilmLayout,
    counts: FilmCounts,
    sums: impl Fn() -> I,
) -> Picture {
    let quantum = Quantum::new(layout.quantum_exponent);
    let layer = |first: usize, samples: u64| {
        let scale = if samples == 0 { 0.0 } else { quantum.size() / samples as f64 };
        let develop = |sum: i64| (sum as f64 * scale) as f32;
        sums().map(|s| Rgb([s[first], s[first + 1], s[first + 2]].map(develop))).collect()
    };
    Picture {
        width: layout.width,
        height: layout.height,
        window: layout.window,
        eye_samples: counts.eye_samples,
        light_samples: counts.light_samples,
        eye: layer(EYE, counts.eye_samples),
        light: layer(LIGHT, counts.light_samples),
        error: None,
        channels: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_light_image_can_be_chosen() {
        let picture = Picture {
            width: 1,
            height: 1,
            window: Window { x: 0, y: 0, width: 1, height: 1 },
            eye_samples: 1,
            light_samples: 1,
            eye: vec![Rgb::new(1.0, 2.0, 3.0)],
            light: vec![Rgb::splat(0.5)],
            error: None,
            channels: Vec::new(),
        };
        for (name, expected) in [("on", [1.5, 2.5, 3.5]), ("off", [1.0, 2.0, 3.0]), ("only", [0.5; 3])] {
            let choice: LightImage = name.parse().unwrap();
            assert_eq!(choice.to_string(), name);
            assert_eq!(picture.combined(choice), [Rgb(expected)]);
        }
        let error = "On".parse::<LightImage>().unwrap_err().to_string();
        assert_eq!(error, "`On` is not a light image setting: choose on, off or only");
        assert!(picture.check().is_ok());
        assert!(Picture { light: Vec::new(), ..picture }.check().is_err());
    }
}
