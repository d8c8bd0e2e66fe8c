//! Videos of rendering: a picture that converges, with its light image and without ([`converge`]); the strategies of
//! bidirectional path tracing added one by one ([`pyramid`]); a camera that swings around what it looks at
//! ([`orbit`]).

mod converge;
mod orbit;
mod pyramid;
mod reel;

pub use converge::{Converge, Layout, converge};
pub use orbit::{Orbit, orbit};
pub use pyramid::{PyramidClip, pyramid};
pub use reel::{ClipError, ClipOptions, Step};
