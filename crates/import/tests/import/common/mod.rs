//! What several of these tests need.

use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use caustica_import::{Loaded, parse_nori};
use caustica_scene::{Description, Diagnostic};
use proptest::prelude::*;

/// A complete scene with `inner` beside its camera and integrator, on one line up to `inner`.
pub fn scene(inner: &str) -> String {
    format!("<scene><camera type='perspective'/><integrator type='normals'/>{inner}</scene>")
}

/// Reads a text without files.
pub fn parse(text: &str) -> Result<Loaded, Diagnostic> {
    parse_nori(text, "scene.xml", Path::new("/nowhere"))
}

/// The scene of a text that must be right and free of warnings.
pub fn good(text: &str) -> Description {
    let loaded = parse(text).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(loaded.warnings, []);
    loaded.scene.expect("a scene")
}

/// Asserts that the text is refused with a message that contains `fragment`, at the place before which
/// the text has a `§` (which is taken out).
pub fn refused(marked: &str, fragment: &str) {
    let (text, line, column) = unmark(marked);
    let error = parse(&text).expect_err(fragment);
    assert_place(&error, fragment, (line, column));
}

/// Asserts that the text is read with exactly one warning, as [`refused`] does with errors.
pub fn warned(marked: &str, fragment: &str) -> Description {
    let (text, line, column) = unmark(marked);
    let loaded = parse(&text).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(loaded.warnings.len(), 1, "{:?}", loaded.warnings);
    assert_place(&loaded.warnings[0], fragment, (line, column));
    loaded.scene.expect("a scene")
}

fn assert_place(diagnostic: &Diagnostic, fragment: &str, place: (u32, u32)) {
    let shown = diagnostic.to_string();
    assert!(shown.contains(fragment), "{shown} does not contain {fragment}");
    let origin = diagnostic.origin.as_ref().unwrap_or_else(|| panic!("no place: {shown}"));
    assert_eq!((origin.line, origin.column), place, "{shown}");
    assert_eq!(origin.file, "scene.xml");
}

fn unmark(marked: &str) -> (String, u32, u32) {
    let (before, after) = marked.split_once('§').expect("a mark");
    let line = before.matches('\n').count() as u32 + 1;
    let column = before.rsplit('\n').next().unwrap_or_default().chars().count() as u32 + 1;
    (format!("{before}{after}"), line, column)
}

/// Changes of a text: each puts other bytes, or one of the words, in place of some.
pub fn edits(words: &'static [&'static str]) -> impl Strategy<Value = Vec<Edit>> {
    let fresh = prop_oneof![
        prop::collection::vec(any::<u8>(), 0..4),
        prop::sample::select(words).prop_map(|s| s.as_bytes().to_vec()),
    ];
    prop::collection::vec((any::<prop::sample::Index>(), 0..6_usize, fresh), 1..5)
}

/// Where, how many bytes are removed, and what is put there.
pub type Edit = (prop::sample::Index, usize, Vec<u8>);

/// The text with those changes.
pub fn edited(text: &str, edits: &[Edit]) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for (index, removed, added) in edits {
        let at = index.index(bytes.len() + 1);
        let end = (at + removed).min(bytes.len());
        bytes.splice(at..end, added.iter().copied());
    }
    bytes
}

/// Asserts that an error stands at a place that the text has.
pub fn check_place(error: &Diagnostic, text: &str) {
    let origin = error.origin.as_ref().unwrap_or_else(|| panic!("no place: {error}"));
    assert!(origin.line >= 1 && origin.line as usize <= text.matches('\n').count() + 1, "{error}");
    assert!(origin.column >= 1, "{error}");
    if let Some((start, length)) = origin.span {
        assert!(start + length <= text.len() + 1, "{error}");
    }
}

/// Seconds for which this thread has computed, in its own code and the system's: a busy machine does not count. By the
/// clock where the system does not tell.
fn seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/thread-self/stat").unwrap_or_default();
    let mut fields = stat.rsplit(") ").next().unwrap_or_default().split(' ').skip(11);
    let mut ticks = || fields.next()?.parse::<f64>().ok();
    match (ticks(), ticks()) {
        // Fields 14 and 15 of proc(5); a hundred ticks a second everywhere.
        (Some(own), Some(system)) => (own + system) / 100.0,
        _ => SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |t| t.as_secs_f64()),
    }
}

/// Asserts that it takes no longer than so many seconds.
pub fn in_time<T>(limit: f64, what: &str, run: impl FnOnce() -> T) -> T {
    let start = seconds();
    let result = run();
    let taken = seconds() - start;
    assert!(taken < limit, "{what} took {taken:.2} s");
    result
}
