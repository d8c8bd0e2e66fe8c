//! What can go wrong with a report.

use caustica_film::FilmError;

/// An error in the making of a page.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// An image has no pixels, or not as many as its size asks for.
    #[error("`{name}` has {pixels} pixels, but {width} × {height} were announced")]
    PixelCount {
        /// The image.
        name: String,
        /// Its width in pixels.
        width: u32,
        /// Its height in pixels.
        height: u32,
        /// How many pixels there are.
        pixels: usize,
    },
    /// Images of one page differ in size.
    #[error(
        "`{name}` is {width} × {height}, but `{first}` is {first_width} × {first_height}: one page needs one size"
    )]
    SizesDiffer {
        /// The image.
        name: String,
        /// Its width in pixels.
        width: u32,
        /// Its height in pixels.
        height: u32,
        /// The image that it is compared with.
        first: String,
        /// That one's width in pixels.
        first_width: u32,
        /// That one's height in pixels.
        first_height: u32,
    },
    /// An inset that is empty or leaves the image.
    #[error(
        "the inset `{label}` ({width} × {height} at {x}, {y}) is not inside the image of {image_width} × {image_height}"
    )]
    InsetOutside {
        /// What the inset is called.
        label: String,
        /// Its left edge in pixels.
        x: u32,
        /// Its upper edge in pixels.
        y: u32,
        /// Its width in pixels.
        width: u32,
        /// Its height in pixels.
        height: u32,
        /// The image's width in pixels.
        image_width: u32,
        /// The image's height in pixels.
        image_height: u32,
    },
    /// A pyramid has a strategy twice.
    #[error("the strategy s = {s}, t = {t} is there twice")]
    StrategyTwice {
        /// Vertices on the light's side.
        s: u32,
        /// Vertices on the camera's side.
        t: u32,
    },
    /// A strategy that joins nothing: a path has two vertices at least.
    #[error("the strategy s = {s}, t = {t} has fewer than two vertices and makes no path")]
    NoPath {
        /// Vertices on the light's side.
        s: u32,
        /// Vertices on the camera's side.
        t: u32,
    },
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] FilmError),
    /// A folder could not be made.
    #[error("{}: {source}", path.display())]
    Folder {
        /// The folder.
        path: std::path::PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The template could not be filled.
    #[error("the page could not be made: {0}")]
    Template(#[from] askama::Error),
    /// The data could not be put as JSON.
    #[error("the report's data could not be written: {0}")]
    Json(#[from] serde_json::Error),
}
