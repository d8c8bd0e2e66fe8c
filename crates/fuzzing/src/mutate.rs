//! Changes of inputs.

use crate::dice::Dice;
use crate::{images, words};

/// The longest input that changes make.
pub const LONGEST: usize = 1 << 16;

/// Whole numbers at the edges of their types.
const EDGES: [u64; 14] =
    [0, 1, 2, 3, 0x7F, 0x80, 0xFF, 0x7FFF, 0xFFFF, 0x1_0000, 0x7FFF_FFFF, 0xFFFF_FFFF, 1 << 63, u64::MAX];

/// Changes bytes: flips, numbers at the edges, parts copied, moved and left out.
pub fn binary(data: &mut Vec<u8>, dice: &mut Dice) {
    for _ in 0..=dice.below(4) {
        let range = dice.range(data.len());
        match dice.below(6) {
            0 | 1 => {
                if let Some(byte) = data.get_mut(range.start) {
                    *byte ^= 1 << dice.below(8);
                }
            }
            2 => {
                let width = 1 << dice.below(4);
                let mut number = dice.choose(&EDGES).wrapping_add(dice.below(3) as u64).to_le_bytes();
                if dice.once_in(3) {
                    number[..width].reverse();
                }
                let end = (range.start + width).min(data.len());
                data[range.start..end].copy_from_slice(&number[..end - range.start]);
            }
            3 => drop(data.drain(range)),
            4 => {
                let part = data[range].to_vec();
                let at = dice.below(data.len() + 1);
                data.splice(at..at, part);
            }
            _ => data[range].iter_mut().for_each(|b| *b = dice.bits() as u8),
        }
    }
    data.truncate(LONGEST);
}

/// Puts a word where there was none.
pub fn insert_word(data: &mut Vec<u8>, words: &[&str], dice: &mut Dice) {
    let range = dice.range(data.len());
    let end = if dice.once_in(2) { range.start } else { range.end };
    data.splice(range.start..end, dice.choose(words).bytes());
}

/// Changes of OBJ files.
pub fn obj(data: &mut Vec<u8>, dice: &mut Dice) {
    lines(data, words::OBJ, dice);
}

/// Changes files of lines: lines copied and left out, and words of lines replaced.
pub fn lines(data: &mut Vec<u8>, words: &[&str], dice: &mut Dice) {
    for _ in 0..=dice.below(4) {
        match dice.below(6) {
            0 => binary(data, dice),
            1 => insert_word(data, words, dice),
            2 => replace_number(data, |b| b.is_ascii_whitespace() || b == b'/', dice),
            kind => {
                let starts: Vec<usize> =
                    std::iter::once(0).chain((1..data.len()).filter(|i| data[i - 1] == b'\n')).collect();
                let from = dice.below(starts.len());
                let to = (from + 1 + dice.below(4)).min(starts.len());
                let range = starts[from]..starts.get(to).copied().unwrap_or(data.len());
                if kind == 3 {
                    data.drain(range);
                } else {
                    let lines = data[range].to_vec();
                    let at = *dice.choose(&starts);
                    data.splice(at..at, lines);
                }
            }
        }
    }
    data.truncate(LONGEST);
}

/// Replaces a word between separators by a number.
pub fn replace_number(data: &mut Vec<u8>, separates: impl Fn(u8) -> bool, dice: &mut Dice) {
    let at = dice.below(data.len());
    let start = data[..at].iter().rposition(|b| separates(*b)).map_or(0, |i| i + 1);
    let end = data[at..].iter().position(|b| separates(*b)).map_or(data.len(), |i| at + i);
    if start <= end {
        data.splice(start..end, dice.choose(words::NUMBERS).bytes());
    }
}

/// Changes images and, mostly, repairs the checksums of PNG.
pub fn images(data: &mut Vec<u8>, dice: &mut Dice) {
    if dice.once_in(8) {
        insert_word(data, words::IMAGES, dice);
    } else {
        binary(data, dice);
    }
    if !dice.once_in(16) {
        images::repair_png(data);
    }
}
