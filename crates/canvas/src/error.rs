//! What can go wrong with a canvas.

use caustica_film::FilmError;

/// An error of a canvas.
#[derive(Debug, thiserror::Error)]
pub enum CanvasError {
    /// Nothing, or more than [`MAX_PIXELS`](crate::MAX_PIXELS).
    #[error("a canvas of {width} × {height} pixels cannot be made: between 1 and {} fit", crate::MAX_PIXELS)]
    Size {
        /// The width that was asked for.
        width: u64,
        /// The height that was asked for.
        height: u64,
    },
    /// The number of pixels is not width times height.
    #[error("{count} pixels for a canvas of {width} × {height}")]
    Count {
        /// How many there are.
        count: usize,
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
    },
    /// A copy would be larger than the picture.
    #[error("a picture of {from_width} × {from_height} cannot be scaled down to {width} × {height}")]
    Larger {
        /// Width of the picture.
        from_width: u32,
        /// Height of the picture.
        from_height: u32,
        /// Width that was asked for.
        width: u32,
        /// Height that was asked for.
        height: u32,
    },
    /// A sheet without any picture.
    #[error("a sheet needs at least one picture")]
    Empty,
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] FilmError),
}
