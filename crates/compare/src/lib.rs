//! Integrators compared: one scene by several methods, at equal time or equal samples, against a reference.
//!
//! [`compare`] renders, [`Outcome::page`] measures and makes what `caustica-report` shows.

mod curve;
mod insets;
mod method;
mod outcome;
mod race;

pub use curve::{Reached, slope, time_to_reach};
pub use insets::{Region, most_different};
pub use method::{DEFAULT_METHODS, EYE_ONLY, Method};
pub use outcome::{CompareError, Entrant, Made, Outcome, Reference};
pub use race::{Event, Options, ReferenceChoice, Stage, compare};
