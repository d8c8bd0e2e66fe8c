//! The passage of a file that a diagnostic is about, drawn as Rust's compiler does.

use caustica::scene::{Diagnostic, Origin, Severity};
use console::{Style, measure_text_width};

/// Larger files are not read again only to be shown.
const LARGEST_SHOWN: u64 = 16 << 20;

/// A line of a file, and the part of it to point at.
#[derive(Debug, PartialEq, Eq)]
struct Passage {
    before: String,
    marked: String,
    after: String,
}

/// A diagnostic for people, in lines no wider than the terminal where they show a file.
pub fn draw(d: &Diagnostic, width: usize) -> String {
    let (label, colour) = match d.severity {
        Severity::Error => ("error", Style::new().for_stderr().red().bold()),
        Severity::Warning => ("warning", Style::new().for_stderr().yellow().bold()),
    };
    let quiet = Style::new().for_stderr().dim();
    let place = d.origin.as_ref().map_or(String::new(), |o| format!("{o}: "));
    // Editors and scripts can read the first line.
    let mut drawn = format!("{}: {place}{}\n", colour.apply_to(label), d.message);
    let mut margin = String::new();
    if let Some((line, passage)) = d.origin.as_ref().and_then(|o| Some((o.line, passage(o)?))) {
        let number = line.to_string();
        margin = " ".repeat(number.len());
        let shown = passage.fit(width.saturating_sub(number.len() + 4));
        let pad = " ".repeat(measure_text_width(&shown.before));
        let arrows = "^".repeat(measure_text_width(&shown.marked).max(1));
        let text = format!("{}{}{}", shown.before, shown.marked, shown.after);
        drawn += &format!("{}\n", quiet.apply_to(format!("{margin} |")));
        drawn += &format!("{} {text}\n", quiet.apply_to(format!("{number} |")));
        drawn += &format!("{} {pad}{}\n", quiet.apply_to(format!("{margin} |")), colour.apply_to(arrows));
    }
    if let Some(hint) = &d.hint {
        drawn += &format!("{margin} {} {hint}\n", quiet.apply_to("= help:"));
    }
    drawn
}

impl Passage {
    /// Cut to that many columns around what is marked.
    fn fit(self, columns: usize) -> Self {
        let all = [&self.before, &self.marked, &self.after].map(|t| measure_text_width(t));
        if all.iter().sum::<usize>() <= columns {
            return self;
        }
        let columns = columns.max(20);
        let marked = head(&self.marked, columns / 2);
        let rest = columns.saturating_sub(measure_text_width(&marked) + 2);
        let before = tail(&self.before, rest.saturating_sub(all[2].min(rest / 2)));
        let after = head(&self.after, rest.saturating_sub(measure_text_width(&before)));
        Self { before, marked, after }
    }
}

/// The first columns of a text, with a mark where it goes on.
fn head(text: &str, columns: usize) -> String {
    console::truncate_str(text, columns + 1, "…").into_owned()
}

/// The last columns of a text, with a mark where more precedes them.
fn tail(text: &str, columns: usize) -> String {
    if measure_text_width(text) <= columns + 1 {
        return text.to_owned();
    }
    let mut kept = 0;
    let start = text.char_indices().rev().find(|(_, c)| {
        kept += measure_text_width(c.encode_utf8(&mut [0; 4]));
        kept > columns
    });
    format!("…{}", &text[start.map_or(0, |(i, c)| i + c.len_utf8())..])
}

/// What a diagnostic is about, if the file can still be read.
fn passage(origin: &Origin) -> Option<Passage> {
    let there = std::fs::metadata(&origin.file).ok()?;
    if !there.is_file() || there.len() > LARGEST_SHOWN {
        return None;
    }
    mark(&std::fs::read_to_string(&origin.file).ok()?, origin)
}

/// The line of the origin, from its first column to the span's or the line's end.
fn mark(text: &str, origin: &Origin) -> Option<Passage> {
    let line = text.lines().nth(origin.line.checked_sub(1)? as usize)?;
    let column = origin.column.saturating_sub(1) as usize;
    let start = line.char_indices().nth(column).map_or(line.len(), |(i, _)| i);
    let length = match (origin.column, origin.span) {
        (0, _) => line.len(),
        (_, Some((_, length))) => length,
        (_, None) => 1,
    };
    let mut end = start.saturating_add(length).min(line.len());
    while !line.is_char_boundary(end) {
        end += 1;
    }
    let marked = line[start..end].trim_end();
    Some(Passage {
        before: printable(&line[..start]),
        marked: printable(marked),
        after: printable(&line[start + marked.len()..]),
    })
}

/// Tabs as spaces; what would steer a terminal as a replacement character.
fn printable(text: &str) -> String {
    let text = text.replace('\t', "    ");
    text.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn origin(line: u32, column: u32, length: Option<usize>) -> Origin {
        Origin { file: "none".into(), line, column, span: length.map(|n| (0, n)) }
    }

    fn marked(text: &str, at: &Origin) -> (String, String) {
        let p = mark(text, at).unwrap();
        (p.before, p.marked)
    }

    #[test]
    fn passages_are_cut_out_of_their_line() {
        let text = "first\n\tsecond <bsdf type=\"x\"/>\nüñí \u{1b}[31m";
        assert_eq!(marked(text, &origin(2, 9, Some(5))), ("    second ".into(), "<bsdf".into()));
        assert_eq!(marked(text, &origin(2, 9, Some(500))).1, "<bsdf type=\"x\"/>");
        assert_eq!(marked(text, &origin(3, 2, Some(1))), ("ü".into(), "ñ".into()));
        assert_eq!(marked(text, &origin(3, 5, None)).1, "\u{fffd}");
        assert_eq!(marked(text, &origin(1, 0, None)).1, "first");
        assert_eq!(marked(text, &origin(1, 99, None)), ("first".into(), String::new()));
        assert!(mark(text, &origin(4, 1, None)).is_none() && mark(text, &origin(0, 1, None)).is_none());
    }

    #[test]
    fn long_lines_are_cut_around_the_mark() {
        for (before, length, after) in [(500, 10, 500), (0, 10, 500), (500, 10, 0), (5, 900, 5)] {
            let line = format!("{}{}{}", "a".repeat(before), "M".repeat(length), "z".repeat(after));
            let column = before as u32 + 1;
            let p = mark(&line, &origin(1, column, Some(length))).unwrap().fit(60);
            let shown = format!("{}{}{}", p.before, p.marked, p.after);
            assert!((40..=60).contains(&measure_text_width(&shown)), "{shown}");
            assert!(p.marked.starts_with('M') && shown.contains('…'), "{shown}");
        }
    }
}
