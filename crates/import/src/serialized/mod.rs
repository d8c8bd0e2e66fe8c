//! Mitsuba's `serialized` meshes: any number of them in a file, each compressed by zlib (versions 3 and 4).
//!
//! At the start of every mesh stand the number 0x041C and the version, of 16 bits each, and then the compressed part.
//! The file ends with the meshes' places, of 64 bits (32 in version 3), and their number. All is little-endian. (Mitsuba's
//! documentation of the plugin has the format.)

mod body;

use std::io::{Cursor, Read, Seek, SeekFrom};
use std::path::Path;

use caustica_math::MemoryShortage;
use caustica_scene::description::Mesh;
use caustica_scene::memory::shortage;
use caustica_scene::{Diagnostic, MemoryLimit};

use crate::files;

/// What every mesh starts with.
const MAGIC: u16 = 0x041C;
/// The bytes of that and of the version.
const HEADER: u64 = 4;

/// What is wrong with a file.
enum Fault {
    Broken(String),
    Memory(MemoryShortage),
}

impl Fault {
    fn of(self, file_name: &str) -> Diagnostic {
        let mesh = format!("the mesh `{file_name}`");
        match self {
            Self::Broken(what) => Diagnostic::error(format!("{mesh}: {what}")),
            Self::Memory(e) => shortage(&mesh, e).hint("use a mesh of fewer triangles"),
        }
    }
}

fn fault(message: impl Into<String>) -> Fault {
    Fault::Broken(message.into())
}

fn broken(error: std::io::Error) -> Fault {
    match error.kind() {
        std::io::ErrorKind::UnexpectedEof => fault("the file ends too early"),
        _ => fault(format!("it cannot be read: {error}")),
    }
}

/// Reads the mesh of number `index`, from 0, of a file in so much memory. The error names the file.
pub(crate) fn load(path: &Path, index: u32, memory: MemoryLimit) -> Result<Mesh, Diagnostic> {
    let name = path.display().to_string();
    let (file, size) = files::open(path)
        .map_err(|why| Diagnostic::error(format!("cannot read the mesh `{name}`: {why}")))?;
    read(file, size, index, memory).map_err(|fault| fault.of(&name))
}

/// Reads the mesh of number `index`, from 0, of the bytes of a `serialized` file; `file_name` is for messages.
/// Texture coordinates are as in the file, and colours are skipped. What the mesh says about itself is believed after it
/// is compared with the bytes that there are and with `memory`.
///
/// # Errors
/// A damaged file, a mesh that does not exist or does not fit. The error names the file; it has no line.
pub fn read_serialized(
    bytes: &[u8],
    file_name: &str,
    index: u32,
    memory: MemoryLimit,
) -> Result<Mesh, Diagnostic> {
    read(Cursor::new(bytes), bytes.len() as u64, index, memory).map_err(|fault| fault.of(file_name))
}

fn read(mut file: impl Read + Seek, size: u64, index: u32, memory: MemoryLimit) -> Result<Mesh, Fault> {
    let version = header(&mut file)?;
    let [start, end] = place(&mut file, (size, version), index)?;
    file.seek(SeekFrom::Start(start)).map_err(broken)?;
    let version = header(&mut file)?;
    let compressed = end - start - HEADER;
    body::read(file.take(compressed), (compressed, version), memory)
}

/// The version, after the number that tells the format.
fn header(file: &mut impl Read) -> Result<u16, Fault> {
    let magic = u16::from_le_bytes(bytes(file)?);
    if magic != MAGIC {
        return Err(fault("it is no serialized mesh: it does not start with 0x041C"));
    }
    match u16::from_le_bytes(bytes(file)?) {
        version @ (3 | 4) => Ok(version),
        version => Err(fault(format!("its version is {version}; 3 and 4 can be read"))),
    }
}

/// Where the mesh of that number begins and ends in a file of that size and version.
fn place(file: &mut (impl Read + Seek), (size, version): (u64, u16), index: u32) -> Result<[u64; 2], Fault> {
    let width = if version == 3 { 4 } else { 8 };
    file.seek(SeekFrom::Start(size.saturating_sub(4))).map_err(broken)?;
    let count = u64::from(u32::from_le_bytes(bytes(file)?));
    let table = size.checked_sub(4 + count * width).filter(|_| count > 0);
    let Some(table) = table else { return Err(fault("the list of its meshes is damaged")) };
    if u64::from(index) >= count {
        let last = count - 1;
        return Err(fault(format!("it has no mesh of number {index}; the last one is number {last}")));
    }
    let mut offset = |i: u64| -> Result<u64, Fault> {
        file.seek(SeekFrom::Start(table + i * width)).map_err(broken)?;
        Ok(if version == 3 {
            u32::from_le_bytes(bytes(file)?).into()
        } else {
            u64::from_le_bytes(bytes(file)?)
        })
    };
    let start = offset(index.into())?;
    let next = u64::from(index) + 1;
    let end = if next < count { offset(next)?.min(table) } else { table };
    if start.checked_add(HEADER).is_none_or(|after| after > end) {
        return Err(fault("the list of its meshes is damaged"));
    }
    Ok([start, end])
}

/// The next bytes.
fn bytes<const N: usize>(from: &mut impl Read) -> Result<[u8; N], Fault> {
    let mut bytes = [0; N];
    from.read_exact(&mut bytes).map_err(broken)?;
    Ok(bytes)
}
