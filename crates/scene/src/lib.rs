//! Scenes: what the user describes, and what rays run on.
//!
//! - [`description`]: owned, serialisable, user-level. Readers produce it, users edit it.

pub mod description;
pub mod diagnostic;

pub use description::Description;
pub use diagnostic::{Diagnostic, Origin, Severity};
