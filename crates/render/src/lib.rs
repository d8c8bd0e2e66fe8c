//! Render sessions: threads, budgets, progress, cancellation; and what is done with a scene beside rendering
//! it: replaying one sample, running the tests that a scene file carries, and describing what was loaded.

pub mod info;
mod layers;
mod names;
mod provenance;
pub mod pyramid;
mod queue;
pub mod replay;
pub mod scene_tests;
mod session;
mod stages;
mod workers;

pub use layers::MOST_LAYER_SAMPLES;
pub use names::{INTEGRATOR_NAMES, integrator_by_name, integrator_name};
pub use provenance::{content_hash, provenance};
pub use session::{Control, Progress, RenderError, RenderOptions, Report, Session, available_threads};
pub use stages::Stages;
pub use workers::Budget;
