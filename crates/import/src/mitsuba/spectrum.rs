//! Spectra, and what they look like.

use caustica_math::Rgb;

use super::cie::{self, Light};
use crate::nori::value::Bad;
use crate::suggest::shorten;

/// The most samples of a spectrum.
const MOST_SAMPLES: usize = 10_000;

/// What a colour is the colour of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// Light: no upper bound.
    Light,
    /// A part of the light: at most 1.
    Reflectance,
    /// An index of refraction: for each primary by itself.
    Index,
}

/// A function of the wavelength.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Curve {
    /// The same everywhere.
    Uniform(f64),
    /// (wavelength in nm, value), sorted, with straight lines between and nothing beyond.
    Samples(Vec<(f64, f64)>),
    /// Planck's law, W·m⁻²·sr⁻¹·nm⁻¹.
    Blackbody {
        /// K.
        temperature: f64,
        /// A factor.
        scale: f64,
    },
}

impl Curve {
    /// A number, or `wavelength:value` pairs in ascending order.
    pub(super) fn parse(text: &str) -> Result<Self, Bad> {
        let whole = |message: String| Bad { message, range: 0..text.len() };
        let number = |word: &str| word.trim().parse::<f64>().ok().filter(|x| x.is_finite());
        if !text.contains(':') {
            let value = number(text).ok_or_else(|| {
                whole(format!("`{}` is neither a number nor a list such as 400:0.1, 700:0.2", shorten(text)))
            })?;
            return Ok(Self::Uniform(value));
        }
        let mut samples = Vec::new();
        for word in text.split([',', ' ', '\t', '\r', '\n']).filter(|w| !w.is_empty()) {
            let pair = word.split_once(':').and_then(|(w, v)| Some((number(w)?, number(v)?)));
            let start = word.as_ptr() as usize - text.as_ptr() as usize;
            samples.push(pair.ok_or_else(|| Bad {
                message: format!("`{}` is not a pair such as 550:0.1", shorten(word)),
                range: start..start + word.len(),
            })?);
        }
        Self::from_samples(samples).map_err(whole)
    }

    /// The samples of a file: a wavelength and a value a line, `#` before comments.
    pub(super) fn parse_file(text: &str) -> Result<Self, String> {
        let mut samples = Vec::new();
        for (index, line) in text.lines().enumerate() {
            let line = line.split('#').next().unwrap_or_default();
            let words: Vec<Option<f64>> = line.split_whitespace().map(|w| w.parse().ok()).collect();
            match words[..] {
                [] => {}
                [Some(wavelength), Some(value)] => samples.push((wavelength, value)),
                _ => return Err(format!("its line {} is not a wavelength and a value", index + 1)),
            }
        }
        Self::from_samples(samples)
    }

    /// From wavelengths, which must ascend, and values.
    pub(super) fn from_samples(samples: Vec<(f64, f64)>) -> Result<Self, String> {
        if samples.is_empty() || samples.len() > MOST_SAMPLES {
            return Err(format!("a spectrum needs from 1 to {MOST_SAMPLES} samples"));
        }
        if !samples.iter().all(|(w, v)| w.is_finite() && v.is_finite()) {
            return Err("a spectrum must be finite".into());
        }
        if samples.windows(2).any(|pair| pair[1].0 <= pair[0].0) {
            return Err("the wavelengths of a spectrum must ascend".into());
        }
        Ok(Self::Samples(samples))
    }

    /// Its value at a wavelength.
    fn eval(&self, wavelength: f64) -> f64 {
        match self {
            Self::Uniform(value) => *value,
            Self::Samples(samples) => {
                let after = samples.partition_point(|(w, _)| *w < wavelength);
                match (after.checked_sub(1).map(|i| samples[i]), samples.get(after)) {
                    (Some((w0, v0)), Some((w1, v1))) => v0 + (v1 - v0) * (wavelength - w0) / (w1 - w0),
                    (None, Some((w, v))) if *w == wavelength => *v,
                    _ => 0.0,
                }
            }
            Self::Blackbody { temperature, scale } => scale * planck(wavelength, *temperature),
        }
    }

    /// What it looks like, and whether it had to be clipped for that.
    pub(super) fn rgb(&self, role: Role) -> (Rgb, bool) {
        let raw = match (self, role) {
            (Self::Uniform(value), _) => [*value; 3],
            (_, Role::Light) => cie::to_rgb(|w| self.eval(w), Light::Itself),
            (_, Role::Reflectance) => cie::to_rgb(|w| self.eval(w), Light::D65),
            (_, Role::Index) => cie::to_rgb(|w| self.eval(self.inside(w)), Light::D65),
        };
        let most = if role == Role::Reflectance { 1.0 } else { f64::INFINITY };
        // A single number is what it is; the reader of the property decides whether it may be.
        let clipped = match self {
            Self::Uniform(_) => raw,
            _ => raw.map(|c| c.clamp(0.0, most)),
        };
        let changed =
            (0..3).any(|i| (raw[i] - clipped[i]).abs() > 1e-3 * clipped.iter().fold(0.0, |a, b| b.max(a)));
        (Rgb(clipped.map(|c| c as f32)), changed)
    }

    /// The nearest wavelength at which there are samples: an index does not end with its table.
    fn inside(&self, wavelength: f64) -> f64 {
        match self {
            Self::Samples(s) => wavelength.clamp(s[0].0, s[s.len() - 1].0),
            _ => wavelength,
        }
    }
}

/// Planck's law for a wavelength in nm, with CODATA's 2018 constants.
fn planck(wavelength: f64, temperature: f64) -> f64 {
    const H: f64 = 6.626_070_15e-34;
    const C: f64 = 299_792_458.0;
    const K: f64 = 1.380_649e-23;
    let l = wavelength * 1e-9;
    2e-9 * H * C * C / (l * l * l * l * l) / (libm::exp(H * C / (l * K * temperature)) - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(text: &str, role: Role, expected: [f64; 3], tolerance: f64) {
        let Rgb(rgb) = Curve::parse(text).unwrap().rgb(role).0;
        for (a, b) in rgb.iter().zip(expected) {
            assert!((f64::from(*a) - b).abs() <= tolerance * b, "{text}: {rgb:?}");
        }
    }

    #[test]
    fn known_colours() {
        // Figures that Mitsuba renders with.
        let luminaire = "400:0, 500:8, 600:15.6, 700:18.4";
        close(luminaire, Role::Light, [20.7108, 10.8546, 2.77115], 4e-3);
        let white = "400:0.78, 500:0.78, 600:0.78, 700:0.78";
        close(white, Role::Reflectance, [0.77637, 0.77981, 0.77603], 2e-3);
        close("0.3", Role::Reflectance, [0.3; 3], 1e-6);
        close("500:1.5, 600:1.5", Role::Index, [1.5; 3], 3e-3);
    }

    #[test]
    fn a_hot_body_is_bluer() {
        let color = |temperature| Curve::Blackbody { temperature, scale: 1.0 }.rgb(Role::Light).0.0;
        let (warm, cold) = (color(2700.0), color(10_000.0));
        assert!(warm[0] > 2.0 * warm[2] && cold[2] > cold[0], "{warm:?} {cold:?}");
    }

    #[test]
    fn bad_lists() {
        for (text, range) in [("400:1 300:2", 0..11), ("400:1, 5oo:2", 7..12), ("x", 0..1), ("400:1 2", 6..7)]
        {
            assert_eq!(Curve::parse(text).unwrap_err().range, range, "{text}");
        }
        assert!(Curve::parse_file("# a lamp\n400 1\n\n500 2 # end\n").is_ok());
        assert!(Curve::parse_file("400 1\n500\n").unwrap_err().contains("line 2"));
    }
}
