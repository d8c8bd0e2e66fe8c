//! The tables of a PLY file.

use caustica_math::{Vec2, Vec3};
use caustica_scene::description::{Domain, Mesh};

use super::attributes::{self, Columns};
use super::header::{Element, Encoding, Header, Kind, Property};
use super::sizes::Sizes;
use super::{Fault, fault};
use crate::obj::triangulate::triangulate;
use crate::suggest::shorten;

/// The most corners of a face.
const MOST_CORNERS: u64 = 1 << 16;

/// Numbers one after another.
pub(super) struct Numbers<'b> {
    pub(super) rest: &'b [u8],
    pub(super) encoding: Encoding,
    /// The line, in a text.
    line: u32,
}

impl<'b> Numbers<'b> {
    pub(super) fn new(header: &Header, body: &'b [u8]) -> Self {
        Self { rest: body, encoding: header.encoding, line: header.lines + 1 }
    }

    pub(super) fn take(&mut self, size: usize) -> Result<&'b [u8], Fault> {
        match self.rest.split_at_checked(size) {
            Some((head, rest)) => {
                self.rest = rest;
                Ok(head)
            }
            None => self.ended(),
        }
    }

    fn ended<T>(&self) -> Result<T, Fault> {
        fault("the file ends too early", self.line)
    }

    #[inline]
    fn next(&mut self, kind: Kind) -> Result<f64, Fault> {
        if self.encoding == Encoding::Text {
            return self.word();
        }
        let bytes = self.take(kind.size())?;
        let mut buffer = [0; 8];
        let part = &mut buffer[..bytes.len()];
        part.copy_from_slice(bytes);
        if self.encoding == Encoding::BigEndian {
            part.reverse();
        }
        let [a, b, c, d, ..] = buffer;
        Ok(match kind {
            Kind::I8 => f64::from(a as i8),
            Kind::U8 => f64::from(a),
            Kind::I16 => f64::from(i16::from_le_bytes([a, b])),
            Kind::U16 => f64::from(u16::from_le_bytes([a, b])),
            Kind::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Kind::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Kind::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Kind::F64 => f64::from_le_bytes(buffer),
        })
    }

    /// The next word of a text.
    fn text(&mut self) -> Result<&'b [u8], Fault> {
        let space = self.rest.iter().position(|b| !b.is_ascii_whitespace()).unwrap_or(self.rest.len());
        self.line += self.rest[..space].iter().filter(|b| **b == b'\n').count() as u32;
        self.rest = &self.rest[space..];
        let end = self.rest.iter().position(u8::is_ascii_whitespace).unwrap_or(self.rest.len());
        if end == 0 {
            return self.ended();
        }
        self.take(end)
    }

    fn word(&mut self) -> Result<f64, Fault> {
        let text = String::from_utf8_lossy(self.text()?);
        match text.parse() {
            Ok(number) => Ok(number),
            Err(_) => fault(format!("`{}` is not a number", shorten(&text)), self.line),
        }
    }

    /// The number of items of a list.
    fn length(&mut self, kind: Kind) -> Result<u64, Fault> {
        let length = self.next(kind)?;
        if length >= 0.0 && length <= MOST_CORNERS as f64 {
            return Ok(length as u64);
        }
        fault(format!("a list of {length} items is too long"), self.line)
    }

    /// Reads a property that nobody asks for.
    fn skip(&mut self, property: &Property) -> Result<(), Fault> {
        let count = property.list.map_or(Ok(1), |kind| self.length(kind))?;
        (0..count).try_for_each(|_| self.next(property.kind).map(drop))
    }

    /// Passes a property without a look at its numbers, and tells how many it has.
    pub(super) fn pass(&mut self, property: &Property) -> Result<u64, Fault> {
        let count = property.list.map_or(Ok(1), |kind| self.length(kind))?;
        match self.encoding {
            Encoding::Text => (0..count).try_for_each(|_| self.text().map(drop))?,
            _ => drop(self.take(count as usize * property.kind.size())?),
        }
        Ok(count)
    }
}

/// Whether a property of a face is its list of corners.
pub(super) fn is_corners(p: &Property) -> bool {
    p.list.is_some() && ["vertex_indices", "vertex_index"].contains(&p.name.as_str())
}

/// The mesh, and how many faces of it were left out.
pub(super) fn read(header: &Header, body: &[u8], sizes: Sizes) -> Result<(Mesh, usize), Fault> {
    let mut numbers = Numbers::new(header, body);
    let mut mesh = Mesh::default();
    let mut left_out = 0;
    for element in &header.elements {
        match element.name.as_str() {
            "vertex" => vertices(element, &mut numbers, (&mut mesh, sizes))?,
            "face" => left_out += faces(element, &mut numbers, (&mut mesh, sizes))?,
            _ => {
                for _ in 0..element.count {
                    // Rows without anything in them do not shorten the file.
                    if element.properties.is_empty() {
                        break;
                    }
                    element.properties.iter().try_for_each(|p| numbers.skip(p))?;
                }
            }
        }
    }
    if mesh.triangles.is_empty() {
        return fault("the mesh has no triangles", 1);
    }
    Ok((mesh, left_out))
}

/// What a property of a vertex is: a coordinate of its position, normal or texture.
fn slot(name: &str) -> Option<usize> {
    Some(match name {
        "x" => 0,
        "y" => 1,
        "z" => 2,
        "nx" => 3,
        "ny" => 4,
        "nz" => 5,
        "u" | "s" | "texture_u" | "texture_s" => 6,
        "v" | "t" | "texture_v" | "texture_t" => 7,
        _ => return None,
    })
}

/// Whether a property of a vertex is one of those.
pub(super) fn is_usual(name: &str) -> bool {
    slot(name).is_some()
}

/// Whether the vertices have the coordinates of these slots.
fn has(element: &Element, mut slots: std::ops::Range<usize>) -> bool {
    slots.all(|wanted| element.properties.iter().any(|p| slot(&p.name) == Some(wanted)))
}

/// Whether the vertices have normals, and texture coordinates.
pub(super) fn parts(element: &Element) -> [bool; 2] {
    [has(element, 3..6), has(element, 6..8)]
}

fn vertices(
    element: &Element,
    numbers: &mut Numbers,
    (mesh, sizes): (&mut Mesh, Sizes),
) -> Result<(), Fault> {
    let mut columns = attributes::find(element, (Domain::Vertex, mesh), is_usual);
    let slots: Vec<Option<usize>> = element.properties.iter().map(|p| slot(&p.name)).collect();
    if !has(element, 0..3) {
        return fault("the vertices have no x, y and z", 1);
    }
    if element.count > u64::from(u32::MAX) {
        return fault("the mesh has too many vertices", 1);
    }
    let [has_normals, has_uvs] = parts(element);
    mesh.positions.reserve_exact(sizes.vertices);
    mesh.normals.reserve_exact(if has_normals { sizes.vertices } else { 0 });
    mesh.uvs.reserve_exact(if has_uvs { sizes.vertices } else { 0 });
    columns.iter_mut().for_each(|c| c.reserve(sizes.vertices));
    let mut others = vec![0.0_f32; element.properties.len()];
    for _ in 0..element.count {
        let mut values = [0.0_f32; 8];
        for ((property, slot), other) in element.properties.iter().zip(&slots).zip(&mut others) {
            match slot {
                _ if property.list.is_some() => numbers.skip(property)?,
                Some(slot) => values[*slot] = numbers.next(property.kind)? as f32,
                None => *other = numbers.next(property.kind)? as f32,
            }
        }
        let [x, y, z, nx, ny, nz, u, v] = values;
        if !(x.is_finite() && y.is_finite() && z.is_finite()) {
            return fault("a vertex is not finite", numbers.line);
        }
        mesh.positions.push(Vec3::new(x, y, z));
        if has_normals {
            mesh.normals.push(Vec3::new(nx, ny, nz));
        }
        if has_uvs {
            mesh.uvs.push(Vec2::new(u, v));
        }
        columns.iter_mut().for_each(|c| c.push(&others, 1));
    }
    mesh.attributes.extend(columns.into_iter().map(Columns::finish));
    Ok(())
}

fn faces(
    element: &Element,
    numbers: &mut Numbers,
    (mesh, sizes): (&mut Mesh, Sizes),
) -> Result<usize, Fault> {
    if !element.properties.iter().any(is_corners) {
        return fault("the faces have no list `vertex_indices`", 1);
    }
    mesh.triangles.reserve_exact(sizes.triangles);
    let mut columns = attributes::find(element, (Domain::Face, mesh), |_| false);
    columns.iter_mut().for_each(|c| c.reserve(sizes.triangles));
    let mut values = vec![0.0_f32; element.properties.len()];
    let mut corners: Vec<u32> = Vec::new();
    let mut left_out = 0;
    for _ in 0..element.count {
        let before = mesh.triangles.len();
        for (property, value) in element.properties.iter().zip(&mut values) {
            match property.list {
                Some(kind) if is_corners(property) => {
                    corners.clear();
                    for _ in 0..numbers.length(kind)? {
                        let corner = numbers.next(property.kind)?;
                        if !(corner >= 0.0 && corner < mesh.positions.len() as f64) {
                            return fault(format!("there is no vertex {corner}"), numbers.line);
                        }
                        corners.push(corner as u32);
                    }
                    left_out += usize::from(!add_face(&corners, mesh, numbers.line)?);
                }
                None => *value = numbers.next(property.kind)? as f32,
                Some(_) => numbers.skip(property)?,
            }
        }
        columns.iter_mut().for_each(|c| c.push(&values, mesh.triangles.len() - before));
    }
    mesh.attributes.extend(columns.into_iter().map(Columns::finish));
    Ok(left_out)
}

/// Adds a face's triangles; whether it has any.
fn add_face(corners: &[u32], mesh: &mut Mesh, line: u32) -> Result<bool, Fault> {
    if mesh.triangles.len() >= u32::MAX as usize {
        return fault("the mesh has too many triangles", line);
    }
    match corners {
        [] | [_] | [_, _] => Ok(false),
        [a, b, c] => {
            mesh.triangles.push([*a, *b, *c]);
            Ok(a != b && b != c && c != a)
        }
        _ => {
            let at = |i: &u32| {
                let p = mesh.positions[*i as usize];
                [f64::from(p.x), f64::from(p.y), f64::from(p.z)]
            };
            let points: Vec<[f64; 3]> = corners.iter().map(at).collect();
            let mut triangles = Vec::new();
            if triangulate(&points, &mut triangles).is_err() {
                return fault("a face has too many corners", line);
            }
            mesh.triangles.extend(triangles.iter().map(|t| t.map(|i| corners[i as usize])));
            Ok(!triangles.is_empty())
        }
    }
}
