//! Scenes: what the user describes, and what rays run on.
//!
//! - [`description`]: owned, serialisable, user-level. Readers produce it, users edit it.
//! - [`scene::Scene`]: flat tables and `u32` ids made from it, with [`surface`]s, [`bsdf`]s, [`light`]s, the
//!   [`camera`] and the ray-intersection tree ([`bvh`]).

mod albedo;
mod attributes;
pub mod bsdf;
pub mod bvh;
pub mod camera;
pub mod casters;
pub mod description;
pub mod diagnostic;
mod figures;
pub mod light;
mod material;
pub mod memory;
mod references;
pub mod scene;
pub mod surface;
pub mod texture;
mod traits;
mod warnings;
pub mod wrapped;

pub use caustica_math::MemoryLimit;
pub use description::Description;
pub use diagnostic::{Cause, Diagnostic, Origin, Severity};
pub use scene::Scene;
