//! Metrics of pictures that come from formulas.

mod pictures;
mod properties;
mod published;
