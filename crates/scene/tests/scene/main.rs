//! From a description to a scene: cameras, surfaces, wrapped materials, degenerate input, and what is refused. One
//! program, so that it is linked once.

mod attributes;
mod cameras;
mod degenerate;
mod memory;
mod scene_errors;
mod surfaces;
mod tangents;
mod wrappers;
