//! What a PLY file says about itself.

use super::{Fault, fault};
use crate::suggest::shorten;

/// The most bytes of a header, and the most properties in it.
const LONGEST: usize = 1 << 16;
const MOST_PROPERTIES: usize = 1000;

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// Types of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Kind {
    fn parse(word: &str) -> Option<Self> {
        Some(match word {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// A property of an element.
#[derive(Clone, Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// The type of the number of items, if it is a list.
    pub(super) list: Option<Kind>,
}

/// A table.
#[derive(Clone, Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

/// The header.
#[derive(Clone, Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Its bytes.
    pub(super) length: usize,
    /// Its lines.
    pub(super) lines: u32,
}

pub(super) fn parse(bytes: &[u8]) -> Result<Header, Fault> {
    if !bytes.starts_with(b"ply") {
        return fault("this is no PLY file: it does not start with `ply`", 1);
    }
    let mut header = Header { encoding: Encoding::Text, elements: Vec::new(), length: 0, lines: 0 };
    let mut encoding = None;
    let mut properties = 0;
    loop {
        let rest = &bytes[header.length..];
        let end = rest.iter().take(LONGEST).position(|b| *b == b'\n');
        let Some(end) = end.filter(|_| header.length < LONGEST) else {
            return fault("the header does not end with `end_header`", header.lines + 1);
        };
        header.length += end + 1;
        header.lines += 1;
        let line = String::from_utf8_lossy(&rest[..end]);
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match words[..] {
            [] | ["ply"] | ["comment" | "obj_info", ..] => {}
            ["end_header"] => break,
            ["format", format, _] => encoding = Some(parse_encoding(format, header.lines)?),
            ["element", name, count] => {
                let Ok(count) = count.parse() else {
                    return fault(format!("`{}` is not a number of elements", shorten(count)), header.lines);
                };
                header.elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
            }
            ["property", ref words @ ..] => {
                properties += 1;
                let property = parse_property(words).filter(|_| properties <= MOST_PROPERTIES);
                match (property, header.elements.last_mut()) {
                    (Some(property), Some(element)) => element.properties.push(property),
                    _ => return fault(format!("unknown property `{}`", shorten(&line)), header.lines),
                }
            }
            _ => return fault(format!("unknown line `{}` in the header", shorten(&line)), header.lines),
        }
    }
    match encoding {
        Some(encoding) => Ok(Header { encoding, ..header }),
        None => fault("the header has no line `format`", header.lines),
    }
}

fn parse_encoding(word: &str, line: u32) -> Result<Encoding, Fault> {
    match word {
        "ascii" => Ok(Encoding::Text),
        "binary_little_endian" => Ok(Encoding::LittleEndian),
        "binary_big_endian" => Ok(Encoding::BigEndian),
        _ => fault(format!("unknown format `{}`", shorten(word)), line),
    }
}

fn parse_property(words: &[&str]) -> Option<Property> {
    match *words {
        ["list", count, kind, name] => Some(Property {
            name: name.to_owned(),
            kind: Kind::parse(kind)?,
            list: Some(Kind::parse(count)?),
        }),
        [kind, name] => Some(Property { name: name.to_owned(), kind: Kind::parse(kind)?, list: None }),
        _ => None,
    }
}
