//! cargo-mutants on the transport crate.

use std::fs;

use crate::command::{Outcome, Tool, Trouble, program, root, status};

const CARGO_MUTANTS: Tool = Tool {
    name: "cargo-mutants",
    probe: &["cargo", "mutants", "--version"],
    install: "cargo install cargo-mutants --locked",
};

/// Where survivors that are no gap in the tests are listed, with the reason.
const KNOWN: &str = "docs/mutants.md";

/// What cargo-mutants ends with if mutants survive, and if some take too long.
const SURVIVORS: [i32; 2] = [2, 3];

/// Plants cargo-mutants' faults, or a part `k/n` of them, and fails if one survives that is not listed as known.
pub fn mutants(shard: Option<&str>) -> Outcome {
    CARGO_MUTANTS.check()?;
    let mut command =
        program(&["cargo", "mutants", "--package", "caustica-transport", "--timeout", "300", "--jobs", "1"]);
    command.args(["--output", "target", "--colors", "never"]);
    if let Some(shard) = shard {
        command.args(["--shard", shard]);
    }
    match status(&mut command)? {
        Some(0) => return Ok(()),
        Some(code) if SURVIVORS.contains(&code) => {}
        code => return Err(Trouble::Failed(format!("cargo mutants ended with {code:?}"))),
    }
    let read = |name: &str| {
        fs::read_to_string(root().join(name)).map_err(|e| Trouble::Failed(format!("{name}: {e}")))
    };
    let missed = read("target/mutants.out/missed.txt")?;
    let unknown = unknown(&missed, &read(KNOWN)?);
    unknown.iter().for_each(|mutant| println!("-- survived: {mutant}"));
    match unknown.len() {
        0 => Ok(()),
        n => Err(Trouble::Failed(format!("{n} mutants survive that {KNOWN} does not list"))),
    }
}

/// The survivors that are not among the known ones. Lines and columns move, so they do not count.
fn unknown<'m>(missed: &'m str, known: &str) -> Vec<&'m str> {
    // As tables of Markdown have to write it.
    let known = known.replace("\\|", "|");
    let is_known = |mutant: &str| {
        let Some((path, change)) = parts(mutant) else { return false };
        known.lines().any(|line| line.contains(path) && line.contains(&format!("`{change}`")))
    };
    missed.lines().filter(|line| !line.trim().is_empty() && !is_known(line)).collect()
}

/// `path:line:column: change` without the numbers.
fn parts(mutant: &str) -> Option<(&str, &str)> {
    let (path, rest) = mutant.split_once(':')?;
    Some((path, rest.split_once(": ")?.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_survivors_may_move() {
        let known =
            "| `crates/transport/src/weight.rs` | `replace < with <= in f` | the ends are never equal |";
        let missed = "crates/transport/src/weight.rs:1:2: replace < with <= in f\n\
            crates/transport/src/weight.rs:1:2: replace < with <= in g\n\
            crates/transport/src/edge.rs:1:2: replace < with <= in f\n";
        assert_eq!(unknown(missed, known), missed.lines().skip(1).collect::<Vec<_>>());
        assert!(unknown("", known).is_empty());
        let known = r"| `crates/transport/src/weight.rs` | `replace \|\| with && in f` | spares work |";
        assert!(unknown("crates/transport/src/weight.rs:1:2: replace || with && in f\n", known).is_empty());
    }
}
