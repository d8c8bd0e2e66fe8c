//! Verifies a scene for each thing that bidirectional renderers are known to get wrong, and prints a table:
//! `cargo run --release -p caustica-verify --example known_failures`.

use std::process::ExitCode;

use caustica_render::Control;
use caustica_scene::Scene;
use caustica_testkit::rows::rows;
use caustica_transport::Settings;
use caustica_verify::{Options, Verdict, verify};

/// Samples per pixel: the scenes are small.
const SAMPLES: u32 = 512;

fn main() -> ExitCode {
    println!(
        "| what goes wrong elsewhere | told of in | estimators that agree | too noisy | tests | smallest p | mismatches | \
         test of its own |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|---|");
    let mut all = 0;
    for row in rows() {
        let scene = match Scene::new(row.scene) {
            Ok((scene, _)) => scene,
            Err(e) => {
                eprintln!("{}: {e}", row.what);
                return ExitCode::FAILURE;
            }
        };
        let settings = Settings { max_depth: Some(12), ..Settings::default() };
        let options = Options { settings, samples: SAMPLES, block: 4, ..Options::default() };
        let outcome = match verify(&scene, &options, &Control::default(), |_| ()) {
            Ok(outcome) => outcome,
            Err(e) => {
                eprintln!("{}: {e}", row.what);
                return ExitCode::FAILURE;
            }
        };
        let count = |v: Verdict| outcome.tested.iter().filter(|t| t.verdict == v).count();
        let tests: usize = outcome.tested.iter().map(|t| t.tests()).sum();
        let smallest = outcome.tested.iter().map(|t| t.smallest_p()).fold(1.0, f64::min);
        let mismatches = count(Verdict::Mismatch);
        all += mismatches;
        println!(
            "| {} | {} | {} | {} | {tests} | {smallest:.1e} | {mismatches} | {}`{}::{}` |",
            row.what,
            row.threads,
            count(Verdict::Agrees),
            count(Verdict::TooNoisy),
            if row.shared { "shared: " } else { "" },
            row.test.0,
            row.test.1
        );
    }
    if all == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
