//! The logical lines of an OBJ file and their words.

use std::io::{self, BufRead, Read};

/// The most bytes that a logical line may have: without a limit, a file without line ends would be read
/// whole before anything is known about it.
const LONGEST_LINE: usize = 16 << 20;

/// Logical lines: physical ones, joined where a line ends in a backslash.
pub(super) struct Lines<R> {
    reader: R,
    /// The logical line with its line ends and backslashes.
    pub(super) buffer: Vec<u8>,
    /// Number of the line's first physical line, from 1.
    pub(super) line: u32,
    /// Offset of the line in the file.
    pub(super) offset: usize,
    physical_lines: u32,
}

/// Why there is no next line.
pub(super) enum LineError {
    /// The file could not be read.
    Io(io::Error),
    /// The line is longer than this reader takes.
    TooLong,
}

impl<R: BufRead> Lines<R> {
    pub(super) fn new(reader: R) -> Self {
        Self { reader, buffer: Vec::new(), line: 0, offset: 0, physical_lines: 1 }
    }

    /// Reads the next logical line; false at the end of the file.
    pub(super) fn advance(&mut self) -> Result<bool, LineError> {
        self.offset += self.buffer.len();
        self.line += self.physical_lines;
        self.buffer.clear();
        self.physical_lines = 0;
        loop {
            let room = LONGEST_LINE - self.buffer.len();
            let mut limited = self.reader.by_ref().take(room as u64);
            let read = limited.read_until(b'\n', &mut self.buffer).map_err(LineError::Io)?;
            self.physical_lines += u32::from(read > 0);
            if read == room && self.buffer.last() != Some(&b'\n') {
                return Err(LineError::TooLong);
            }
            if read == 0 || !self.continues() {
                return Ok(!self.buffer.is_empty());
            }
        }
    }

    /// Whether the next physical line belongs to this one. Comments never go on: paths in them end in a
    /// backslash now and then.
    fn continues(&self) -> bool {
        let Some(line) = self.buffer.strip_suffix(b"\n") else { return false };
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        line.ends_with(b"\\") && line.trim_ascii_start().first() != Some(&b'#')
    }

    /// (line, column) of a byte of the logical line, from 1.
    pub(super) fn position(&self, at: usize) -> (u32, u32) {
        let before = &self.buffer[..at.min(self.buffer.len())];
        let line = before.iter().filter(|b| **b == b'\n').count() as u32;
        let start = before.iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
        let column = before[start..].iter().filter(|b| **b & 0xC0 != 0x80).count() as u32;
        (self.line + line, column + 1)
    }
}

/// Whether the backslash at `at` is followed by nothing but an end of line.
fn line_end(bytes: &[u8], at: usize) -> bool {
    matches!(&bytes[at + 1..], [b'\n', ..] | [b'\r', b'\n', ..])
}

/// The words of a logical line, with the offsets at which they start.
pub(super) struct Words<'l> {
    line: &'l [u8],
    /// Where the next word is looked for.
    pub(super) at: usize,
}

impl<'l> Words<'l> {
    pub(super) fn new(line: &'l [u8]) -> Self {
        Self { line, at: 0 }
    }
}

impl<'l> Iterator for Words<'l> {
    type Item = (usize, &'l [u8]);

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let line = self.line;
        while let Some(&byte) = line.get(self.at) {
            if !(is_space(byte) || byte == b'\\' && line_end(line, self.at)) {
                break;
            }
            self.at += 1;
        }
        let start = self.at;
        while let Some(&byte) = line.get(self.at) {
            if is_space(byte) || byte == b'\\' && line_end(line, self.at) {
                break;
            }
            self.at += 1;
        }
        let word = &line[start..self.at];
        // A comment ends the line.
        (!word.is_empty() && word[0] != b'#').then_some((start, word))
    }
}

#[inline]
fn is_space(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t'..=b'\r')
}
