//! How far a picture is from its reference.
//!
//! - [`errors`]: relMSE, relMSE without the worst pixels, RMSE and the mean; [`relative_error_map`] for each pixel.
//! - [`flip`]: ꟻLIP, the difference that an observer sees who flips between two pictures, for pictures as a display
//!   shows them and for light of any brightness.
//! - [`heat`]: values as false colours.
//!
//! Results are the same to the bit on any number of threads.
//!
//! ```
//! use caustica_math::Rgb;
//! use caustica_metrics::{Image, errors, flip, heat};
//!
//! # fn main() -> Result<(), caustica_metrics::MetricsError> {
//! let (found, right) = ([Rgb::splat(0.55); 6], [Rgb::splat(0.5); 6]);
//! let (image, reference) = (Image::new(3, 2, &found)?, Image::new(3, 2, &right)?);
//! assert!((errors(image, reference)?.rel_mse - 0.01 / 1.01).abs() < 1e-6);
//!
//! let seen = flip::hdr(image, reference, &flip::Options::default())?;
//! assert!(seen.mean > 0.0 && seen.mean < 0.1);
//! let colours: Vec<[u8; 3]> = seen.values.iter().map(|v| heat(*v)).collect();
//! # assert_eq!(colours.len(), 6);
//! # Ok(())
//! # }
//! ```

mod errors;
pub mod flip;
mod heat;
mod image;

pub use errors::{Errors, TRIMMED_SHARE, errors, relative_error_map};
pub use heat::heat;
pub use image::{Image, MetricsError};
