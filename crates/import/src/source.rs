//! Byte offsets of a text to lines and columns.

use std::ops::Range;

use caustica_scene::Origin;

/// Bytes between two remembered positions: what a look-up has to scan at most.
const STEP: usize = 1024;

/// A text and the name of its file.
pub(crate) struct Source<'t> {
    file: String,
    text: &'t str,
    /// (line, column), both from 0, of every `STEP`-th byte.
    marks: Vec<(u32, u32)>,
}

impl<'t> Source<'t> {
    pub(crate) fn new(file: &str, text: &'t str) -> Self {
        let mut marks = Vec::with_capacity(text.len() / STEP + 1);
        let mut position = (0, 0);
        for chunk in text.as_bytes().chunks(STEP) {
            marks.push(position);
            position = advance(position, chunk);
        }
        if text.len().is_multiple_of(STEP) {
            marks.push(position);
        }
        Self { file: file.to_owned(), text, marks }
    }

    /// The text.
    pub(crate) fn text(&self) -> &'t str {
        self.text
    }

    /// The place of a range of bytes.
    pub(crate) fn origin(&self, range: Range<usize>) -> Origin {
        let start = range.start.min(self.text.len());
        let step = start / STEP;
        let (line, column) = advance(self.marks[step], &self.text.as_bytes()[step * STEP..start]);
        Origin {
            span: Some((start, range.end.max(start) - start)),
            ..self.at_line_and_column(line + 1, column + 1)
        }
    }

    /// A place of which no byte offset is known.
    pub(crate) fn at_line_and_column(&self, line: u32, column: u32) -> Origin {
        Origin { file: self.file.clone(), line, column, span: None }
    }
}

/// The position after `bytes`, if they start at `position`.
fn advance((mut line, mut column): (u32, u32), bytes: &[u8]) -> (u32, u32) {
    for &byte in bytes {
        if byte == b'\n' {
            (line, column) = (line + 1, 0);
        } else if byte & 0xC0 != 0x80 {
            // Every byte but the later ones of a character in UTF-8.
            column += 1;
        }
    }
    (line, column)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_over_many_steps() {
        let text = format!("{}\n{}x", "é".repeat(700), "ü".repeat(2000));
        let source = Source::new("f", &text);
        let at = text.len() - 1;
        let origin = source.origin(at..at + 1);
        assert_eq!((origin.line, origin.column, origin.span), (2, 2001, Some((at, 1))));
        assert_eq!(source.origin(0..0).to_string(), "f:1:1");
    }

    #[test]
    fn the_end_has_a_position_at_every_length() {
        for length in [0, 1, STEP - 1, STEP, STEP + 1, 2 * STEP] {
            let text = "a".repeat(length);
            assert_eq!(Source::new("f", &text).origin(length..length).column as usize, length + 1);
        }
    }
}
