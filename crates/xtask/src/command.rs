//! Running programs in the workspace's root.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// How a step ended, where it did not end well.
#[derive(Debug, PartialEq, Eq)]
pub enum Trouble {
    /// A program that the step needs is not there; how to get it.
    Missing { tool: &'static str, install: &'static str },
    /// What went wrong, in words.
    Failed(String),
}

/// A step's outcome.
pub type Outcome = Result<(), Trouble>;

/// A program, and what tells that it is there.
pub struct Tool {
    pub name: &'static str,
    /// A command that succeeds if it is there.
    pub probe: &'static [&'static str],
    pub install: &'static str,
}

impl Tool {
    /// An error with the install command where the tool is missing.
    pub fn check(&self) -> Outcome {
        let there = Command::new(self.probe[0])
            .args(&self.probe[1..])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status()
            .is_ok_and(|status| status.success());
        if there { Ok(()) } else { Err(Trouble::Missing { tool: self.name, install: self.install }) }
    }
}

/// The folder of the workspace.
pub fn root() -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    folder.ancestors().nth(2).unwrap_or(folder).to_owned()
}

/// A program to be run in the workspace's root.
pub fn program(line: &[&str]) -> Command {
    let mut command = Command::new(line[0]);
    command.args(&line[1..]).current_dir(root());
    // Of the toolchain that runs this; a step may ask for another.
    for name in ["RUSTUP_TOOLCHAIN", "CARGO", "CARGO_MANIFEST_DIR", "CARGO_PKG_NAME"] {
        command.env_remove(name);
    }
    command
}

/// Runs it; anything but success is trouble.
pub fn run(mut command: Command) -> Outcome {
    let shown = shown(&command);
    match status(&mut command)? {
        Some(0) => Ok(()),
        Some(code) => Err(Trouble::Failed(format!("`{shown}` ended with {code}"))),
        None => Err(Trouble::Failed(format!("`{shown}` was stopped by a signal"))),
    }
}

/// Runs it and gives its exit code; `None` if a signal stopped it.
pub fn status(command: &mut Command) -> Result<Option<i32>, Trouble> {
    println!("-- {}", shown(command));
    let status = command.status();
    status.map(|s| s.code()).map_err(|e| Trouble::Failed(format!("`{}` cannot be run: {e}", shown(command))))
}

fn shown(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    words.map(|w| w.to_string_lossy()).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_tool_is_told_with_its_install_command() {
        let tool = Tool { name: "x", probe: &["no-such-program-here"], install: "cargo install x" };
        assert_eq!(tool.check(), Err(Trouble::Missing { tool: "x", install: "cargo install x" }));
        Tool { name: "cargo", probe: &["cargo", "--version"], install: "" }.check().unwrap();
    }

    #[test]
    fn what_a_program_ends_with_decides() {
        run(program(&["cargo", "--version"])).unwrap();
        let Err(Trouble::Failed(words)) = run(program(&["cargo", "no-such-command"])) else { panic!() };
        assert!(words.contains("`cargo no-such-command` ended with 101"), "{words}");
    }

    #[test]
    fn the_root_is_the_workspace() {
        assert!(root().join("Cargo.lock").is_file() && root().join("fuzz/Cargo.toml").is_file());
    }
}
