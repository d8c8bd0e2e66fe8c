//! The tree: what rays hit, watertightness, instances, and memory. One program, so that it is linked once.

mod brute_force;
mod instance_memory;
mod instances;
mod leaks;
mod memory;
mod scale;
mod soups;
mod spatial;
mod watertight;
