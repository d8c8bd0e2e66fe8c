//! The compressed part of a mesh.

use std::io::{BufReader, Read};

use caustica_math::{Vec2, Vec3};
use caustica_scene::MemoryLimit;
use caustica_scene::description::Mesh;
use flate2::bufread::ZlibDecoder;

use super::{Fault, broken, bytes, fault};

/// What the flags say.
const HAS_NORMALS: u32 = 0x0001;
const HAS_UVS: u32 = 0x0002;
const HAS_COLORS: u32 = 0x0008;
const IN_DOUBLES: u32 = 0x2000;

/// Deflate makes nothing larger than so many times what it takes (RFC 1951: 258 bytes of two bits).
const MOST_GROWTH: u64 = 1032;
/// The longest name of a mesh.
const LONGEST_NAME: usize = 1 << 16;
/// Bytes that are unpacked at a time.
const CHUNK: usize = 1 << 16;

/// Reads a mesh of that many compressed bytes and that version in so much memory.
pub(super) fn read(
    from: impl Read,
    (compressed, version): (u64, u16),
    memory: MemoryLimit,
) -> Result<Mesh, Fault> {
    let mut from = ZlibDecoder::new(BufReader::new(from));
    let flags = u32::from_le_bytes(bytes(&mut from)?);
    if version == 4 {
        skip_name(&mut from)?;
    }
    let [vertices, triangles] =
        [u64::from_le_bytes(bytes(&mut from)?), u64::from_le_bytes(bytes(&mut from)?)];
    if vertices > u64::from(u32::MAX) || triangles > u64::from(u32::MAX) {
        return Err(fault("it has more than 2³² vertices or triangles"));
    }
    let has = |flag| u64::from(flags & flag != 0);
    let doubles = flags & IN_DOUBLES != 0;
    let numbers = 3 + 3 * has(HAS_NORMALS) + 2 * has(HAS_UVS) + 3 * has(HAS_COLORS);
    // 2³² · 11 · 8 bytes are no overflow.
    let unpacked = vertices * numbers * if doubles { 8 } else { 4 } + triangles * 12;
    if unpacked > compressed.saturating_mul(MOST_GROWTH) {
        return Err(fault(format!(
            "it cannot hold the {vertices} vertices and {triangles} triangles it claims"
        )));
    }
    // The mesh, and the copy of it that other shapes of the same file are made from.
    memory.check(2 * (vertices * 4 * numbers + triangles * 12)).map_err(Fault::Memory)?;
    let mut unpack = Unpack { from, doubles };
    let mesh = Mesh {
        positions: unpack.vectors(vertices)?,
        normals: unpack.vectors(vertices * has(HAS_NORMALS))?,
        uvs: unpack.floats(vertices * has(HAS_UVS), |[u, v]| Vec2::new(u, v))?,
        triangles: {
            unpack.floats(vertices * has(HAS_COLORS), |[_, _, _]: [f32; 3]| ())?;
            unpack.triangles(triangles)?
        },
        attributes: Vec::new(),
    };
    check(&mesh)?;
    Ok(mesh)
}

fn check(mesh: &Mesh) -> Result<(), Fault> {
    if let Some(i) = mesh.positions.iter().position(|p| !p.is_finite()) {
        return Err(fault(format!("vertex {i} is not finite")));
    }
    let count = mesh.positions.len();
    if let Some(corner) = mesh.triangles.iter().flatten().find(|c| **c as usize >= count) {
        return Err(fault(format!("there is no vertex {corner}")));
    }
    if mesh.triangles.is_empty() { Err(fault("it has no triangles")) } else { Ok(()) }
}

fn skip_name(from: &mut impl Read) -> Result<(), Fault> {
    for _ in 0..LONGEST_NAME {
        if bytes(from)? == [0] {
            return Ok(());
        }
    }
    Err(fault("its name does not end"))
}

/// Numbers of a compressed stream.
struct Unpack<R> {
    from: R,
    doubles: bool,
}

impl<R: Read> Unpack<R> {
    fn vectors(&mut self, count: u64) -> Result<Vec<Vec3>, Fault> {
        self.floats(count, |[x, y, z]| Vec3::new(x, y, z))
    }

    /// So many rows of floating-point numbers.
    fn floats<T, const N: usize>(
        &mut self,
        count: u64,
        make: impl Fn([f32; N]) -> T,
    ) -> Result<Vec<T>, Fault> {
        if self.doubles {
            let number = |b: &[u8]| b.first_chunk().map_or(0.0, |b| f64::from_le_bytes(*b) as f32);
            self.rows(count, 8 * N, |row| make(std::array::from_fn(|i| number(&row[8 * i..]))))
        } else {
            let number = |b: &[u8]| b.first_chunk().map_or(0.0, |b| f32::from_le_bytes(*b));
            self.rows(count, 4 * N, |row| make(std::array::from_fn(|i| number(&row[4 * i..]))))
        }
    }

    fn triangles(&mut self, count: u64) -> Result<Vec<[u32; 3]>, Fault> {
        let corner = |b: &[u8]| b.first_chunk().map_or(0, |b| u32::from_le_bytes(*b));
        self.rows(count, 12, |row| std::array::from_fn(|i| corner(&row[4 * i..])))
    }

    /// So many rows of so many bytes.
    fn rows<T>(&mut self, count: u64, width: usize, make: impl Fn(&[u8]) -> T) -> Result<Vec<T>, Fault> {
        let count = count as usize;
        let mut rows = Vec::with_capacity(count);
        let mut buffer = vec![0; CHUNK.min(count * width).next_multiple_of(width)];
        while rows.len() < count {
            let part = (buffer.len() / width).min(count - rows.len());
            let part = &mut buffer[..part * width];
            self.from.read_exact(part).map_err(broken)?;
            rows.extend(part.chunks_exact(width).map(&make));
        }
        Ok(rows)
    }
}
