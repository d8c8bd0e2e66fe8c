//! `cargo xtask nightly`: checks that take longer than a change should wait for.

mod command;
mod fuzz;
mod mutants;
mod nightly;
mod release;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Tasks around the workspace.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    /// Run the long checks: fresh seeds, fuzzing, mutants, planted faults, dependencies, the release
    Nightly(nightly::Nightly),
}

fn main() -> ExitCode {
    match Arguments::parse().task {
        Task::Nightly(options) => nightly::run(&options),
    }
}
