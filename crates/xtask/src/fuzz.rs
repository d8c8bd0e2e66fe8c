//! Long fuzzing of each target.

use std::fs;

use crate::command::{Outcome, Tool, Trouble, program, root, run};

const NIGHTLY: Tool = Tool {
    name: "a nightly toolchain",
    probe: &["cargo", "+nightly", "--version"],
    install: "rustup toolchain install nightly",
};
const CARGO_FUZZ: Tool = Tool {
    name: "cargo-fuzz",
    probe: &["cargo", "fuzz", "--version"],
    install: "cargo install cargo-fuzz --locked",
};

/// libFuzzer's limits: bytes and seconds of an input, megabytes of the process.
const LIMITS: [&str; 3] = ["-max_len=65536", "-timeout=5", "-rss_limit_mb=2048"];

/// Renders by fifteen integrators, which takes longer than reading.
const SCENES: &str = "scenes";

/// Its own limits. What threads that are about to end still hold is no leak, but looks like one.
const SCENES_LIMITS: [&str; 3] = ["-max_len=1024", "-timeout=60", "-detect_leaks=0"];

/// Fuzzes every target for so many minutes, from its seeds and what earlier runs found.
pub fn fuzz(minutes: u32) -> Outcome {
    NIGHTLY.check()?;
    CARGO_FUZZ.check()?;
    let io = |what: &str, e: std::io::Error| Trouble::Failed(format!("{what}: {e}"));
    // The versions of the workspace, not the newest.
    fs::copy(root().join("Cargo.lock"), root().join("fuzz/Cargo.lock"))
        .map_err(|e| io("fuzz/Cargo.lock", e))?;
    run(program(&[
        "cargo",
        "run",
        "--quiet",
        "--package",
        "caustica-fuzzing",
        "--bin",
        "fuzz-seeds",
        "fuzz",
    ]))?;
    let mut broken = Vec::new();
    for target in targets(&fs::read_to_string(root().join("fuzz/Cargo.toml")).map_err(|e| io("fuzz", e))?) {
        if let Err(trouble) = fuzz_one(&target, minutes) {
            println!("-- {target}: {trouble:?}; the input is in fuzz/artifacts/{target}");
            broken.push(target);
        }
    }
    if broken.is_empty() {
        Ok(())
    } else {
        Err(Trouble::Failed(format!("inputs break {}", broken.join(", "))))
    }
}

fn fuzz_one(target: &str, minutes: u32) -> Outcome {
    let mut command = program(&["cargo", "+nightly", "fuzz", "run", target, "--"]);
    command.args(LIMITS).arg(format!("-max_total_time={}", u64::from(minutes) * 60));
    if target == SCENES {
        command.args(SCENES_LIMITS);
    } else {
        command.arg(format!("-dict=fuzz/dictionaries/{target}.dict"));
    }
    run(command)
}

/// The names of the programs in a manifest of cargo-fuzz.
fn targets(manifest: &str) -> Vec<String> {
    let bins = manifest.split("[[bin]]").skip(1);
    let name = |part: &str| {
        part.lines().find_map(|l| l.strip_prefix("name = \"")?.strip_suffix('"').map(str::to_owned))
    };
    bins.filter_map(name).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_target_is_in_the_manifest() {
        let manifest = std::fs::read_to_string(crate::command::root().join("fuzz/Cargo.toml")).unwrap();
        let files = ["nori_xml", "obj", "images", "exr", "film"];
        let later = ["scenes", "mitsuba_xml", "ply", "serialized"];
        assert_eq!(super::targets(&manifest), [&files[..], &later].concat());
    }
}
