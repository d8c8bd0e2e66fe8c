//! Readers: what they read, and every error with its place. One program, so that it is linked once.

mod carried_tests;
mod common;
mod files;
mod images;
mod memory;
mod mitsuba_damaged;
mod mitsuba_materials;
mod mitsuba_plugins;
mod mitsuba_robustness;
mod mitsuba_sensors;
mod mitsuba_shapes;
mod mitsuba_sunsky;
mod mitsuba_syntax;
mod obj;
mod plugin_errors;
mod ply;
mod robustness;
mod scenes;
mod serialized;
mod syntax_errors;
