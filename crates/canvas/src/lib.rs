//! Pictures as displays show them, with labels on, and sheets of such pictures.
//!
//! A [`Canvas`] holds 8-bit sRGB pixels. Lines, areas and text are drawn on it, smaller copies are made
//! in linear light, and [`sheet`](sheet()) or [`grid`] lay many of them out with captions. The same calls
//! give the same bytes on every machine.

mod canvas;
mod draw;
mod error;
mod resize;
mod sheet;
mod text;

pub use canvas::{Area, Canvas, Colour, MAX_PIXELS};
pub use error::CanvasError;
pub use resize::{from_linear, to_linear};
pub use sheet::{Cell, LegendLine, Row, SheetStyle, grid, sheet};
pub use text::{TextSize, TextStyle, Weight, shortened, wrapped};
