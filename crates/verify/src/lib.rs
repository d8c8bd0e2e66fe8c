//! Whether all ways to render a scene agree, and why its light is hard to find.
//!
//! [`verify`](verify()) renders a scene by `bdpt` and sorts what it finds by the [class](PathClass) of its paths; then
//! it renders by every set of strategies and every integrator alone, and tests block by block that each finds
//! what `bdpt` found of the classes that it reaches. [`explain`](explain()) tells which classes carry the light and the
//! noise of a region, and what no strategy reaches.

mod class;
mod estimator;
mod explain;
mod grid;
mod heat;
mod jobs;
mod memory;
mod outcome;
mod page;
mod tally;
mod trial;
mod verify;

pub use class::{LampEnd, PathClass};
pub use estimator::Estimator;
pub use explain::{Explanation, Missing, Question, Row, explain};
pub use grid::Grid;
pub use heat::heat_map;
pub use outcome::{ClassShare, Finding, Outcome, PatternShare, Tested, Verdict, by_pattern};
pub use page::verification;
pub use tally::Picture;
pub use trial::{Side, Trial};
pub use verify::{Options, Stage, VerifyError, shrink, verify};
