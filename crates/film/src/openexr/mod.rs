//! Pictures as OpenEXR files: lossless, with both layers and what made them.
//!
//! A file has one part. Its data window is the crop, its display window the full picture, and its
//! channels are `combined.R/G/B`, `eye.R/G/B` and `light.R/G/B`, with `error.R/G/B` where error bars are known: half
//! the width of the 95 % interval around eye and light image together, and the picture's further channels. Every fact
//! about the render is a text attribute whose name begins with `caustica.`.

mod read;
mod write;

use std::collections::BTreeMap;

pub use read::read_exr;
pub use write::{write_exr, write_layers};

/// What the names of our attributes begin with.
const PREFIX: &str = "caustica.";

/// The layers that a picture is read from; the combined one follows from them.
const LAYERS: [&str; 2] = ["eye", "light"];

/// The layer that is shown.
const COMBINED: &str = "combined";

/// The layer of error bars.
const ERROR: &str = "error";

/// Facts that [`write_exr`] states itself, whatever the metadata says.
const SAMPLES: &str = "samples";
const LIGHT_PASSES: &str = "lightPasses";
const LIGHT_IMAGE: &str = "lightImage";

/// Facts about a render by name, such as `integrator`, `seed`, `version` or `timeSeconds`; in a file
/// their names begin with `caustica.`.
///
/// `samples` (per pixel, of the eye image), `lightPasses` and `lightImage` are written from the
/// picture itself, and are found here after reading.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Metadata(BTreeMap<String, String>);

impl Metadata {
    /// No facts.
    pub fn new() -> Self {
        Self::default()
    }

    /// States a fact, in place of an earlier one of that name.
    pub fn set(&mut self, name: impl Into<String>, value: impl ToString) {
        self.0.insert(name.into(), value.to_string());
    }

    /// The fact of that name.
    pub fn get(&self, name: &str) -> Option<&str> {
        self.0.get(name).map(String::as_str)
    }

    /// All facts in the order of their names.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().map(|(name, value)| (name.as_str(), value.as_str()))
    }
}

impl FromIterator<(String, String)> for Metadata {
    fn from_iter<I: IntoIterator<Item = (String, String)>>(facts: I) -> Self {
        Self(facts.into_iter().collect())
    }
}

#[cfg(test)]
mod tests;
