//! A short run of every fuzz target: its seeds, and deterministic changes of them for a few seconds.
//!
//! `CAUSTICA_SEED` chooses other changes, and `CAUSTICA_FUZZ_SECONDS` for how long each target runs.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use caustica_fuzzing::{Dice, target};

/// No input may take longer than this, on a machine that is busy with other work.
const HANG: Duration = Duration::from_secs(60);

/// A whole number from the environment.
fn environment(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

/// Runs the seeds, then changed ones until their number or the time is over.
fn short(name: &str, count: u64) {
    let target = target(name);
    let seeds = (target.seeds)();
    let seconds = environment("CAUSTICA_FUZZ_SECONDS");
    let limit = Duration::from_secs(seconds.unwrap_or(4));
    let count = if seconds.is_some() { u64::MAX } else { count };
    let start = Instant::now();
    let run = |input: &[u8], what: &str| {
        let began = Instant::now();
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| (target.run)(input))) {
            let path = std::env::temp_dir().join(format!("caustica-{name}-crash"));
            let kept =
                std::fs::write(&path, input).map_or(String::new(), |()| format!(" ({})", path.display()));
            eprintln!("{name}: {what}{kept}");
            std::panic::resume_unwind(panic);
        }
        assert!(began.elapsed() < HANG, "{name}: {what} took {:?}", began.elapsed());
    };
    for (i, seed) in seeds.iter().enumerate() {
        run(seed, &format!("seed {i}"));
    }
    let first = environment("CAUSTICA_SEED").unwrap_or(0) << 32;
    for change in (first..).take_while(|c| c - first < count && start.elapsed() < limit) {
        let mut dice = Dice::new(change);
        let mut input = dice.choose(&seeds).clone();
        for _ in 0..=dice.below(3) {
            (target.mutate)(&mut input, &mut dice);
        }
        run(&input, &format!("change {change}"));
    }
}

#[test]
fn nori_xml() {
    short("nori_xml", 20_000);
}

#[test]
fn mitsuba_xml() {
    short("mitsuba_xml", 20_000);
}

#[test]
fn ply() {
    short("ply", 40_000);
}

#[test]
fn serialized() {
    short("serialized", 20_000);
}

#[test]
fn film() {
    short("film", 40_000);
}

#[test]
fn obj() {
    short("obj", 40_000);
}

#[test]
fn images() {
    short("images", 20_000);
}

#[test]
fn exr() {
    short("exr", 4_000);
}

#[test]
fn scenes() {
    short("scenes", 400);
}
