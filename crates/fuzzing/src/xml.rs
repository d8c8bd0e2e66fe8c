//! Changes of scene files that leave them XML more often than not.

use std::ops::Range;

use crate::dice::Dice;
use crate::mutate::{self, LONGEST, insert_word, replace_number};
use crate::words;

/// Changes of Nori's scenes.
pub fn nori(data: &mut Vec<u8>, dice: &mut Dice) {
    mutate(data, words::NORI, dice);
}

/// Changes of Mitsuba's scenes.
pub fn mitsuba(data: &mut Vec<u8>, dice: &mut Dice) {
    mutate(data, words::MITSUBA, dice);
}

/// Copies, moves and leaves out elements, and changes values.
fn mutate(data: &mut Vec<u8>, words: &[&str], dice: &mut Dice) {
    for _ in 0..=dice.below(3) {
        match dice.below(12) {
            0 => mutate::binary(data, dice),
            1 => insert_word(data, words, dice),
            2..=5 => value(data, words, dice),
            6 | 7 => replace_number(data, |b| matches!(b, b'"' | b'\'' | b',' | b' '), dice),
            8 => {
                if let Some(range) = element(data, dice) {
                    data.drain(range);
                }
            }
            _ => {
                let Some(range) = element(data, dice) else { continue };
                let copy = data[range].to_vec();
                let starts: Vec<usize> = (0..data.len()).filter(|i| data[*i] == b'<').collect();
                let at = *dice.choose(&starts);
                data.splice(at..at, copy);
            }
        }
    }
    data.truncate(LONGEST);
}

/// Replaces what stands between two quotation marks.
fn value(data: &mut Vec<u8>, words: &[&str], dice: &mut Dice) {
    let quotes: Vec<usize> = (0..data.len()).filter(|i| matches!(data[*i], b'"' | b'\'')).collect();
    let pair = 2 * dice.below(quotes.len() / 2);
    let [start, end] = [pair, pair + 1].map(|i| quotes.get(i).copied().unwrap_or(0));
    if start >= end {
        return;
    }
    let new = match dice.below(4) {
        0 => (*dice.choose(words)).to_owned(),
        1 => (*dice.choose(words::NUMBERS)).to_owned(),
        _ => [0; 3].map(|_| *dice.choose(words::NUMBERS)).join(","),
    };
    data.splice(start + 1..end, new.bytes());
}

/// The bytes of an element: from `<tag` to its end, as far as counting tags tells.
fn element(data: &[u8], dice: &mut Dice) -> Option<Range<usize>> {
    let starts: Vec<usize> =
        (0..data.len()).filter(|i| data[*i] == b'<' && data.get(i + 1) != Some(&b'/')).collect();
    let start = *starts.get(dice.below(starts.len()))?;
    let (mut depth, mut at) = (0_i32, start);
    loop {
        let end = at + data[at..].iter().position(|b| *b == b'>')?;
        if data.get(at + 1) == Some(&b'/') {
            depth -= 1;
        } else if data[end - 1] != b'/' {
            depth += 1;
        }
        if depth <= 0 {
            return Some(start..end + 1);
        }
        at = end + data[end..].iter().position(|b| *b == b'<')?;
    }
}
