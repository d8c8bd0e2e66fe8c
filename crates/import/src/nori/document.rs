//! XML, within limits.

use caustica_scene::{Diagnostic, Origin};
use roxmltree::{Document, Error, ParsingOptions};

use crate::source::Source;

/// The most tags (and comments) of a file.
const MOST_TAGS: usize = 4_000_000;
/// The most attributes of a tag: the parser compares them in pairs.
const MOST_ATTRIBUTES: usize = 256;
/// The most namespaces of a file: the parser copies them for each tag that adds one.
const MOST_NAMESPACES: usize = 64;

/// Parses the text, if its parser can do so in time and memory proportional to it.
pub(crate) fn parse<'t>(source: &Source<'t>) -> Result<Document<'t>, Diagnostic> {
    check_limits(source)?;
    // Without a document type there are no entities, hence none that expand without bound.
    let options = ParsingOptions {
        allow_dtd: false,
        nodes_limit: 2 * MOST_TAGS as u32 + 2,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(source.text(), options).map_err(|error| {
        let diagnostic = Diagnostic::error(format!("malformed XML: {}", message(&error)));
        match error {
            Error::DtdDetected => diagnostic
                .at(source.text().find("<!DOCTYPE").map(|at| source.origin(at..at + 9)))
                .hint("scene files need none"),
            _ => diagnostic.at(Some(place(&error, source))),
        }
    })
}

/// The parser's words, less its position.
fn message(error: &Error) -> String {
    match error {
        Error::DtdDetected => "a document type declaration is not allowed".into(),
        Error::UnclosedRootNode => "the file ends before all of its tags are closed".into(),
        Error::UnexpectedCloseTag(expected, actual, _) => {
            format!("expected </{expected}> and not </{actual}>")
        }
        _ => {
            let text = error.to_string();
            text.rsplit_once(" at ").map_or(text.clone(), |(words, _)| words.to_owned())
        }
    }
}

fn place(error: &Error, source: &Source) -> Origin {
    match error {
        Error::UnclosedRootNode | Error::UnexpectedEndOfStream => {
            let end = source.text().len();
            source.origin(end..end)
        }
        _ => {
            let position = error.pos();
            source.at_line_and_column(position.row, position.col)
        }
    }
}

/// Refuses what would cost the parser more than time and memory in proportion to the text.
fn check_limits(source: &Source) -> Result<(), Diagnostic> {
    let text = source.text();
    let too_many = |what: String, at: usize| Err(Diagnostic::error(what).at(Some(source.origin(at..at + 1))));
    let (mut tags, mut at) = (0, 0);
    while let Some(start) = text[at..].find('<').map(|i| at + i) {
        tags += 1;
        if tags > MOST_TAGS {
            return too_many(format!("more than {MOST_TAGS} tags"), start);
        }
        let rest = &text[start..];
        if let Some(comment) = rest.strip_prefix("<!--") {
            at = comment.find("-->").map_or(text.len(), |end| start + 4 + end);
            continue;
        }
        let end = rest[1..].find('<').map_or(text.len(), |end| start + 1 + end);
        if text[start..end].bytes().filter(|b| *b == b'=').count() > MOST_ATTRIBUTES {
            return too_many(format!("a tag with more than {MOST_ATTRIBUTES} attributes"), start);
        }
        at = end;
    }
    match text.match_indices("xmlns").nth(MOST_NAMESPACES) {
        Some((at, _)) => too_many(format!("more than {MOST_NAMESPACES} namespaces"), at),
        None => Ok(()),
    }
}
