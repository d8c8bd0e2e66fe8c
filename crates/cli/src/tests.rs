use std::process::ExitCode;

use caustica::import::{self, Provision};
use caustica::scene::Diagnostic;
use caustica::session::scene_tests::{self, Outcome, Summary, TestOptions};
use serde::Serialize;

use crate::args::Test;
use crate::console::{Console, print};
use crate::failure::Failure;
use crate::loading;

/// What `--json` prints.
#[derive(Serialize)]
struct Results {
    outcomes: Vec<Outcome>,
    #[serde(flatten)]
    summary: Summary,
}

pub fn run(args: &Test, console: &mut Console) -> Result<ExitCode, Failure> {
    let loaded =
        import::load_with(&args.scene, &Provision { trust: loading::trust(args.untrusted), variables: &[] })?;
    console.warn(loaded.warnings);
    if loaded.tests.is_empty() {
        return Err(Diagnostic::error(format!("`{}` carries no tests", args.scene.display()))
            .hint("tests are `<test type=\"ttest\">` and `<test type=\"chi2test\">`")
            .into());
    }
    let options = TestOptions { seed: args.seed, threads: args.threads.map(usize::from) };
    let (mut outcomes, mut printed) = (Vec::new(), Ok(()));
    let summary = scene_tests::run(&loaded.tests, &options, &mut |outcome| {
        if console.is_talkative() && printed.is_ok() {
            printed = print(line(outcome));
        }
        outcomes.push(outcome.clone());
    });
    printed?;
    let results = Results { outcomes, summary };
    console.result(&results, || format!("{} passed, {} failed", summary.passed, summary.failed))?;
    Ok(if summary.failed == 0 { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

/// An outcome; where it failed, with its place in the file.
fn line(outcome: &Outcome) -> String {
    let Outcome { name, passed, detail, origin } = outcome;
    match origin {
        Some(origin) if !passed => format!("FAIL  {name}: {detail} ({origin})"),
        _ => format!("{}  {name}: {detail}", if *passed { "ok  " } else { "FAIL" }),
    }
}
