//! What the benchmarks share: scenes of triangles, the rays that a renderer shoots into them, and a peer to
//! compare with.

pub mod embree;
pub mod rays;
pub mod rooms;
pub mod timing;
