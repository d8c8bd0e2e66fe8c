//! The statements of an OBJ file.

use caustica_math::{Vec2, Vec3};
use caustica_scene::{Diagnostic, Origin};

use super::ObjMesh;
use super::builder::{Builder, Corner, NONE, Pools};
use super::lines::Words;
use super::triangulate::triangulate;
use crate::suggest::shorten;

/// Statements that say nothing about triangles.
const IGNORED: &[&[u8]] = &[
    b"g",
    b"o",
    b"s",
    b"p",
    b"l",
    b"vp",
    b"mg",
    b"mtllib",
    b"usemtl",
    b"usemap",
    b"maplib",
    b"bevel",
    b"lod",
    b"c_interp",
    b"d_interp",
    b"shadow_obj",
    b"trace_obj",
];

/// A mistake in a logical line.
pub(super) struct Bad {
    pub(super) message: String,
    pub(super) hint: Option<&'static str>,
    /// Offset and length in the line.
    pub(super) at: usize,
    pub(super) length: usize,
}

impl Bad {
    fn new(message: impl Into<String>, (at, word): (usize, &[u8])) -> Self {
        Self { message: message.into(), hint: None, at, length: word.len() }
    }
}

/// How often something happened, and on which line first.
#[derive(Default)]
struct Tally {
    count: u64,
    line: u32,
}

impl Tally {
    fn add(&mut self, line: u32) {
        if self.count == 0 {
            self.line = line;
        }
        self.count += 1;
    }
}

/// What a file's statements add up to.
#[derive(Default)]
pub(super) struct Statements {
    pools: Pools,
    builder: Builder,
    corners: Vec<Corner>,
    points: Vec<[f64; 3]>,
    cut: Vec<[u32; 3]>,
    without_area: Tally,
    zero_normals: Tally,
    unknown: Tally,
    unknown_word: String,
}

impl Statements {
    /// Takes in one logical line that starts at line `number` of the file.
    pub(super) fn read(&mut self, line: &[u8], number: u32) -> Result<(), Bad> {
        let mut words = Words::new(line);
        let Some((at, keyword)) = words.next() else { return Ok(()) };
        let here = (at, keyword);
        match keyword {
            b"v" => {
                let [x, y, z] = numbers::<3>(words, here, 3)?;
                push(&mut self.pools.positions, Vec3::new(x, y, z), here)
            }
            b"vt" => {
                let [u, v] = numbers::<2>(words, here, 1)?;
                push(&mut self.pools.uvs, Vec2::new(u, v), here)
            }
            b"vn" => {
                let [x, y, z] = numbers::<3>(words, here, 3)?;
                let normal = Vec3::new(x, y, z);
                if normal.try_normalized().is_none() {
                    self.zero_normals.add(number);
                }
                push(&mut self.pools.normals, normal, here)
            }
            b"f" => self.face(words, here, number),
            _ => {
                if !IGNORED.contains(&keyword) {
                    if self.unknown.count == 0 {
                        self.unknown_word = shorten(&String::from_utf8_lossy(keyword));
                    }
                    self.unknown.add(number);
                }
                Ok(())
            }
        }
    }

    /// The bytes that reading on takes at least: tables that grow are copied to others as large; and if what was read
    /// is one of `parts` equal ones, which is a guess, half of what the others take.
    pub(super) fn memory_for(&self, parts: f64) -> u64 {
        let now = self.pools.memory() + self.builder.memory();
        now.max((now as f64 * 0.5 * (parts - 1.0)) as u64)
    }

    fn face(&mut self, words: Words, here: (usize, &[u8]), number: u32) -> Result<(), Bad> {
        self.corners.clear();
        self.points.clear();
        self.cut.clear();
        for word in words {
            let corner = self.corner(word)?;
            let p = self.pools.positions[corner.position as usize];
            self.corners.push(corner);
            self.points.push([f64::from(p.x), f64::from(p.y), f64::from(p.z)]);
        }
        if self.corners.len() < 3 {
            let message = format!("a face needs at least 3 corners, and this one has {}", self.corners.len());
            return Err(Bad::new(message, here));
        }
        triangulate(&self.points, &mut self.cut)
            .map_err(|_| Bad::new("a face that is not convex may have at most 4096 corners", here))?;
        if self.cut.is_empty() {
            self.without_area.add(number);
        }
        for i in 0..self.cut.len() {
            let [a, b, c] = self.cut[i].map(|k| self.corners[k as usize]);
            let mut vertex = |corner| self.builder.vertex(corner).ok_or_else(|| too_many(here));
            let triangle = [vertex(a)?, vertex(b)?, vertex(c)?];
            self.builder.triangles.push(triangle);
        }
        Ok(())
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&self, word: (usize, &[u8])) -> Result<Corner, Bad> {
        let mut parts = [None; 3];
        let mut at = word.0;
        for (i, part) in word.1.split(|b| *b == b'/').enumerate() {
            if i == 3 {
                return Err(Bad::new("a corner has at most three indices, as in `1/2/3`", word));
            }
            parts[i] = Some((at, part)).filter(|_| i == 0 || !part.is_empty());
            at += part.len() + 1;
        }
        let [position, uv, normal] = parts;
        let position = position.unwrap_or(word);
        let mut corner = Corner { position: 0, uv: NONE, normal: NONE };
        corner.position = resolve(position, self.pools.positions.len(), "vertex")?;
        if let Some(uv) = uv {
            corner.uv = resolve(uv, self.pools.uvs.len(), "texture coordinate")?;
        }
        if let Some(normal) = normal {
            corner.normal = resolve(normal, self.pools.normals.len(), "normal")?;
            if self.zero_normals.count > 0
                && self.pools.normals[corner.normal as usize].try_normalized().is_none()
            {
                corner.normal = NONE;
            }
        }
        Ok(corner)
    }

    /// The mesh, with warnings placed by `line`.
    pub(super) fn finish(self, line: impl Fn(u32) -> Option<Origin>) -> Result<ObjMesh, Diagnostic> {
        let mut warnings = Vec::new();
        let mut warn = |tally: &Tally, message: String| {
            if tally.count > 0 {
                warnings.push(Diagnostic::warning(message).at(line(tally.line)));
            }
        };
        let n = self.without_area.count;
        warn(
            &self.without_area,
            format!("{n} {} without area left out", if n == 1 { "face" } else { "faces" }),
        );
        let n = self.zero_normals.count;
        warn(
            &self.zero_normals,
            format!(
                "{n} {} of zero length; the faces' own are used instead",
                if n == 1 { "normal" } else { "normals" }
            ),
        );
        let word = &self.unknown_word;
        let n = self.unknown.count;
        warn(
            &self.unknown,
            format!("{n} unknown {}, first `{word}`", if n == 1 { "statement" } else { "statements" }),
        );
        if self.builder.triangles.is_empty() {
            return Err(Diagnostic::error(match self.without_area.count {
                0 => "the mesh has no faces",
                _ => "the mesh has no face with an area",
            }));
        }
        let (mesh, partly) = self
            .builder
            .finish(&self.pools)
            .ok_or_else(|| Diagnostic::error("the mesh has more vertices than 32 bits can count"))?;
        if partly {
            let message = "only some faces have texture coordinates; the others get (0, 0)";
            warnings.push(Diagnostic::warning(message).at(line(1)));
        }
        Ok(ObjMesh { mesh, warnings })
    }
}

fn push<T>(pool: &mut Vec<T>, value: T, here: (usize, &[u8])) -> Result<(), Bad> {
    if pool.len() >= NONE as usize {
        return Err(too_many(here));
    }
    pool.push(value);
    Ok(())
}

fn too_many(here: (usize, &[u8])) -> Bad {
    Bad::new("more items than 32 bits can count", here)
}

/// The numbers of a statement: at least `least` and as many as there are up to `N`; the rest is only
/// checked (weights and vertex colours follow here and there).
fn numbers<const N: usize>(words: Words, here: (usize, &[u8]), least: usize) -> Result<[f32; N], Bad> {
    let mut values = [0.0; N];
    let mut count = 0;
    for word in words {
        let text = std::str::from_utf8(word.1).ok();
        let Some(value) = text.and_then(|t| t.parse::<f32>().ok()) else {
            let shown = shorten(&String::from_utf8_lossy(word.1));
            return Err(Bad::new(format!("`{shown}` is not a number"), word));
        };
        if !value.is_finite() {
            return Err(Bad::new("a coordinate must be a finite number", word));
        }
        if count < N {
            values[count] = value;
        }
        count += 1;
    }
    if count < least {
        let keyword = String::from_utf8_lossy(here.1);
        let message = format!("`{keyword}` needs {least} numbers, and here are {count}");
        return Err(Bad::new(message, here));
    }
    Ok(values)
}

/// An index from 1, or from −1 backwards, to one from 0.
fn resolve(word: (usize, &[u8]), count: usize, what: &str) -> Result<u32, Bad> {
    let Some(index) = integer(word.1) else {
        let shown = shorten(&String::from_utf8_lossy(word.1));
        return Err(Bad::new(format!("`{shown}` is not an index"), word));
    };
    let resolved = match index {
        0 => return Err(Bad::new("indices count from 1; 0 is none", word)),
        1.. => index - 1,
        _ => index + count as i64,
    };
    if resolved < 0 || resolved >= count as i64 {
        let mut bad = Bad::new(format!("there is no {what} {index}: there are {count} so far"), word);
        bad.hint = Some("what a face names must stand before the face");
        return Err(bad);
    }
    Ok(resolved as u32)
}

/// A decimal integer; `None` for anything else, and for what has more digits than indices can have.
#[inline]
fn integer(word: &[u8]) -> Option<i64> {
    let (negative, digits) = match word {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, word),
    };
    if digits.is_empty() || digits.len() > 18 {
        return None;
    }
    let mut value = 0;
    for digit in digits {
        if !digit.is_ascii_digit() {
            return None;
        }
        value = value * 10 + i64::from(digit - b'0');
    }
    Some(if negative { -value } else { value })
}
