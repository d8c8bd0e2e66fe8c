use std::process::ExitCode;

use caustica::import;
use caustica::scene::Diagnostic;
use caustica::session::scene_tests::{self, TestOptions};

use crate::args::Test;
use crate::failure::{Failure, show};

pub fn run(args: &Test) -> Result<ExitCode, Failure> {
    let loaded = import::load(&args.scene)?;
    if loaded.tests.is_empty() {
        return Err(Diagnostic::error(format!("`{}` carries no tests", args.scene.display()))
            .hint("tests are `<test type=\"ttest\">` and `<test type=\"chi2test\">`")
            .into());
    }
    if !args.json {
        loaded.warnings.iter().for_each(show);
    }
    let mut outcomes = Vec::new();
    let summary = scene_tests::run(&loaded.tests, &TestOptions { seed: args.seed }, &mut |outcome| {
        if !args.json {
            println!("{}  {}: {}", if outcome.passed { "ok  " } else { "FAIL" }, outcome.name, outcome.detail);
        }
        outcomes.push(outcome.clone());
    });
    if args.json {
        println!(
            "{}",
            serde_json::json!({
                "outcomes": outcomes,
                "passed": summary.passed,
                "failed": summary.failed,
                "warnings": loaded.warnings,
            })
        );
    } else {
        println!("{} passed, {} failed", summary.passed, summary.failed);
    }
    Ok(if summary.failed == 0 { ExitCode::SUCCESS } else { ExitCode::from(1) })
}
