//! Light transport: vertices, edges, strategies, weights, and the integrators made of them.
//!
//! Everything is evaluated as light travels, whichever walk asks (see [`vertex`]); densities change their
//! measure in one place ([`edge`]); and a weight is a pure function of densities ([`weight`]).
//! [`Kernel::sample`] renders one sample of one pixel and hands what it finds to a [`Sink`].

mod bdpt;
mod direct_views;
pub mod edge;
pub mod fault;
mod hidden;
mod kernel;
mod layers;
mod light_tracer;
mod numbers;
mod path_tracer;
mod pilot;
mod shared;
pub mod sink;
pub mod strategy;
mod subpaths;
pub mod vertex;
mod walk;
pub mod weight;

pub use kernel::{Kernel, Scratch, Settings};
pub use layers::Seen;
pub use pilot::suited_light_paths;
pub use sink::{Contribution, PathView, Sink};
pub use strategy::{Strategy, StrategySet};
pub use subpaths::Subpaths;
pub use weight::Heuristic;
