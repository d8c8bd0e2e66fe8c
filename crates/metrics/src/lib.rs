//! How far a picture is from its reference.
//!
//! - [`errors`]: relMSE, relMSE without the worst pixels, RMSE and the mean; [`relative_error_map`] for each pixel.
//! - [`flip`]: ꟻLIP, the difference that an observer sees who flips between two pictures, for pictures as a display
//!   shows them and for light of any brightness.
//! - [`heat`]: values as false colours.
//!
//! Results are the same to the bit on any number of threads.

mod errors;
pub mod flip;
mod heat;
mod image;

pub use errors::{Errors, TRIMMED_SHARE, errors, relative_error_map};
pub use heat::heat;
pub use image::{Image, MetricsError};
