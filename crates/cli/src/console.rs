//! All that the program says: results on the standard output, everything else on the standard error.

use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;

use caustica::scene::Diagnostic;
use serde::Serialize;
use serde_json::Value;

use crate::failure::Failure;
use crate::snippet;

/// Speaks to people, or in JSON to programs.
#[derive(Debug)]
pub struct Console {
    json: bool,
    quiet: bool,
    warnings: Vec<Diagnostic>,
}

impl Console {
    /// A console that prints one JSON object, or nothing but errors, or all.
    pub fn new(json: bool, quiet: bool) -> Self {
        Self { json, quiet, warnings: Vec::new() }
    }

    /// Whether people are to be told of progress and results.
    pub fn is_talkative(&self) -> bool {
        !self.json && !self.quiet
    }

    /// Tells of something suspicious: at once, or with the result in JSON.
    pub fn warn(&mut self, warnings: impl IntoIterator<Item = Diagnostic>) {
        for warning in warnings {
            if self.is_talkative() {
                show(&warning);
            }
            self.warnings.push(warning);
        }
    }

    /// Prints the result: `text` or, in JSON, `value` with all warnings.
    pub fn result(&self, value: &impl Serialize, text: impl FnOnce() -> String) -> Result<(), Failure> {
        if self.json {
            print(self.with_warnings(serde_json::json!(value)))
        } else if self.quiet {
            Ok(())
        } else {
            print(text().trim_end())
        }
    }

    fn with_warnings(&self, mut value: Value) -> Value {
        value["warnings"] = serde_json::json!(self.warnings);
        value
    }

    /// Tells why the program ends, and gives the exit code for it.
    pub fn fail(&self, failure: Failure) -> ExitCode {
        let code = failure.code();
        let error = failure.into_diagnostic();
        if !self.json {
            show(&error);
        } else if let Err(e) =
            print(self.with_warnings(serde_json::json!({ "error": error, "exit_code": code })))
        {
            show(&e.into_diagnostic());
        }
        ExitCode::from(code)
    }
}

/// Prints a line on the standard output. A reader that went away has read enough.
pub fn print(line: impl Display) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{line}").and_then(|()| out.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::Output(format!("cannot write to the standard output: {e}")))
        }
        _ => Ok(()),
    }
}

/// Prints on the standard error. If that is gone, nobody can be told.
pub fn note(text: impl Display) {
    let _ = write!(io::stderr().lock(), "{text}");
}

/// Lines without a terminal are not cut shorter than this.
const WIDTH_OF_FILES: usize = 120;

/// Prints a diagnostic on the standard error.
fn show(d: &Diagnostic) {
    let width = console::Term::stderr().size_checked().map_or(WIDTH_OF_FILES, |(_, columns)| columns.into());
    note(snippet::draw(d, width));
}
