//! Tools for the tests of the other crates: statistical harnesses, small scenes, agreement tests.

pub mod agreement;
pub mod build;
pub mod chi_square;
pub mod known_failures;
pub mod materials;
pub mod oracle;
pub mod random_scene;
pub mod rows;
pub mod scaled;
pub mod scenes;
pub mod seed;
pub mod ways;
