//! What light is gathered on, and what becomes of it.
//!
//! A [`Film`] adds contributions up as integers, so that any order, any number of threads and any
//! grouping of merged films give the same bits. [`Film::develop`] turns its sums into a [`Picture`] of
//! two layers, which [`write_exr`] keeps losslessly and [`write_png`] shows. Files are replaced whole
//! or not at all.

mod display;
mod dual;
mod error;
mod error_bars;
mod film;
mod layout;
mod openexr;
mod output;
mod picture;
mod quantum;
mod record;
mod tonemap;
mod turns;

pub use display::{Develop, write_png, write_srgb_png};
pub use dual::{DualFilm, half_of};
pub use error::FilmError;
pub use error_bars::ErrorBars;
pub use film::{Film, FilmCounts, LightBuffer};
pub use layout::{FilmLayout, Window};
pub use openexr::{Metadata, read_exr, write_exr, write_layers};
pub use output::{check_writable, remove_leftovers, write_atomically, write_file};
pub use picture::{Channel, LightImage, Picture};
pub use record::{FilmFacts, FilmRecord, MOST_SAMPLES, Provenance, SampleRanges, write_film};
pub use tonemap::{ToneMap, to_display};
