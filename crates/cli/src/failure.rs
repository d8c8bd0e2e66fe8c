use std::process::ExitCode;

use caustica::film::FilmError;
use caustica::scene::{Diagnostic, Origin, Severity};
use caustica::session::RenderError;
use miette::{LabeledSpan, MietteDiagnostic, NamedSource, Report};

/// Why the program ends without what it was asked for. Each kind has an exit code.
#[derive(Debug)]
pub enum Failure {
    /// The arguments do not fit the scene.
    Usage(String),
    /// The scene or film file.
    Input(Diagnostic),
    /// The output.
    Output(String),
    /// Memory or threads.
    Machine(String),
}

impl From<Diagnostic> for Failure {
    fn from(d: Diagnostic) -> Self {
        Self::Input(d)
    }
}

impl From<RenderError> for Failure {
    fn from(e: RenderError) -> Self {
        Self::Machine(e.to_string())
    }
}

impl Failure {
    /// A film that was to be written.
    pub fn output(e: FilmError) -> Self {
        Self::Output(e.to_string())
    }

    /// A film that was to be read.
    pub fn input(e: FilmError) -> Self {
        Self::Input(Diagnostic::error(e.to_string()))
    }

    fn code(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            Self::Input(_) => 3,
            Self::Output(_) => 4,
            Self::Machine(_) => 5,
        }
    }

    /// Prints it and returns the exit code.
    pub fn tell(self, json: bool) -> ExitCode {
        let code = self.code();
        let diagnostic = match self {
            Self::Input(d) => d,
            Self::Usage(m) | Self::Output(m) | Self::Machine(m) => Diagnostic::error(m),
        };
        if json {
            println!("{}", serde_json::json!({ "error": diagnostic, "exit_code": code }));
        } else {
            show(&diagnostic);
        }
        ExitCode::from(code)
    }
}

/// Prints a diagnostic on the standard error, with the passage that it is about.
pub fn show(d: &Diagnostic) {
    let (label, severity) = match d.severity {
        Severity::Error => ("error", miette::Severity::Error),
        Severity::Warning => ("warning", miette::Severity::Warning),
    };
    // The first line can be read by editors and scripts; the passage is for people.
    match &d.origin {
        Some(origin) => eprintln!("{label}: {origin}: {}", d.message),
        None => eprintln!("{label}: {}", d.message),
    }
    let passage = d.origin.as_ref().and_then(passage);
    if let Some((file, text, span)) = passage {
        let mut shown = MietteDiagnostic::new("").with_severity(severity);
        shown.labels = Some(vec![LabeledSpan::new_with_span(None, span)]);
        shown.help.clone_from(&d.hint);
        eprintln!("{}", snippet(&Report::new(shown).with_source_code(NamedSource::new(file, text))));
    } else if let Some(hint) = &d.hint {
        eprintln!("  help: {hint}");
    }
}

/// miette's drawing without its line for the message, which stands above already.
fn snippet(report: &Report) -> String {
    let drawn = format!("{report:?}");
    let start = drawn.find('╭').or_else(|| drawn.find(",-[")).unwrap_or(0);
    let line = drawn[..start].rfind('\n').map_or(0, |i| i + 1);
    drawn[line..].trim_end().to_owned()
}

/// Larger files are not shown.
const LARGEST_SHOWN: u64 = 16 << 20;

/// The file that a diagnostic is about, its text, and the bytes to point at.
fn passage(origin: &Origin) -> Option<(String, String, (usize, usize))> {
    let size = std::fs::metadata(&origin.file).ok()?.len();
    if size > LARGEST_SHOWN {
        return None;
    }
    let text = std::fs::read_to_string(&origin.file).ok()?;
    let span = origin.span.or_else(|| {
        let lines = text.split_inclusive('\n');
        let start: usize = lines.take(origin.line.checked_sub(1)? as usize).map(str::len).sum();
        let column = origin.column.saturating_sub(1) as usize;
        let offset = text[start..].char_indices().nth(column).map_or(0, |(i, _)| i);
        Some((start + offset, 1))
    })?;
    (span.0 <= text.len()).then(|| {
        let length = span.1.min(text.len() - span.0);
        (origin.file.clone(), text, (span.0, length))
    })
}
