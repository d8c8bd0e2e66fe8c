//! The mathematics that every other part of Caustica stands on.
//!
//! Vectors and frames, transforms, colours and spectra, densities with their measure in the type,
//! warps from the unit square, discrete and piecewise-constant distributions, counter-based sample
//! streams and the statistical tests by which a renderer is checked.
//!
//! Everything here gives the same bits on every machine of the target family: see [`elementary`].

mod affine;
pub mod chi_square;
pub mod distribution;
pub mod elementary;
pub mod filter;
pub mod frame;
pub mod memory;
pub mod pdf;
pub mod spectrum;
pub mod spherical;
pub mod stats;
mod strata;
pub mod stream;
pub mod transform;
pub mod vector;
pub mod warp;

pub use affine::Affine;
pub use distribution::{Distribution1d, Distribution2d};
pub use filter::{Filter, PixelFilter};
pub use frame::Frame;
pub use memory::{MemoryLimit, MemoryShortage};
pub use pdf::{AreaPdf, Mass, SolidAnglePdf};
pub use spectrum::{Rgb, Spectrum, Wavelengths};
pub use stream::{SampleId, SampleStream, Sampler, StreamId};
pub use transform::Transform;
pub use vector::{Vec2, Vec3};

/// The largest `f32` below one: the upper end of what a sample stream returns.
pub const ONE_BELOW: f32 = 1.0 - f32::EPSILON / 2.0;
