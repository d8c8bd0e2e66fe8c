//! Pages that show what was rendered, each in one file that opens from disk without a network.
//!
//! [`write_comparison`] puts images of one scene into one viewer with their errors, curves and details;
//! [`write_pyramid`] shows what each strategy of a bidirectional path tracer adds to an image;
//! [`write_verification`] tells whether all ways to render a scene agree. The images are in the page as half floats,
//! so that exposure can be chosen while looking.

mod comparison;
mod encode;
mod error;
mod page;
mod pyramid;
mod verification;

pub use comparison::{
    Comparison, CurvePoint, Entry, Inset, Metrics, Shown, Speedup, comparison_json, comparison_page,
    write_comparison,
};
pub use error::ReportError;
pub use pyramid::{Pyramid, StrategyImages, pyramid_page, write_pyramid};
pub use verification::{
    Estimated, Pattern, Verification, percent, verification_json, verification_page, write_verification,
};
