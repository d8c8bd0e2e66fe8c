//! Film files.
//!
//! A line `caustica film 1`, a line of JSON (sizes, counts, what it is a film of, which samples it holds), then the
//! sums of the two halves, six channels each, and at last the BLAKE3 hash of all before it. A channel is its length
//! in eight bytes and that many bytes of raw deflate, which hold the sums as 64-bit integers, the lowest bytes of
//! all first, row by row, then the next ones. All numbers are little-endian.

use std::fs::File;
use std::io::{self, BufWriter, Read, Write};
use std::path::Path;

use flate2::Compression;
use flate2::read::DeflateDecoder;
use flate2::write::DeflateEncoder;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{FilmFacts, FilmRecord};
use crate::dual::{DualFilm, passes_by_half};
use crate::film::{Film, FilmCounts};
use crate::layout::FilmLayout;
use crate::{FilmError, output};

/// How every film file begins.
const MAGIC: &[u8] = b"caustica film ";
const VERSION: &[u8] = b"1\n";

/// Bytes of the hash at the end.
const HASH: usize = 32;

/// The longest header in bytes.
const LONGEST_HEADER: usize = 1 << 24;

/// Sample numbers have 32 bits.
const MOST_SAMPLES: u64 = 1 << 32;

/// Layers and channels of a half.
const CHANNELS: usize = 6;

#[derive(Serialize, Deserialize)]
struct Header {
    #[serde(flatten)]
    layout: FilmLayout,
    counts: [FilmCounts; 2],
    #[serde(flatten)]
    facts: FilmFacts,
}

/// Writes a film, under a temporary name first: a file of that name is replaced whole or not at all. The same film and
/// facts give the same bytes.
///
/// # Errors
/// What the system says.
pub fn write_film(path: &Path, film: &DualFilm, facts: &FilmFacts) -> Result<(), FilmError> {
    let planes = planes(film);
    output::write_atomically(path, |file| {
        let mut hashed = Hashed { file: BufWriter::new(file), hasher: blake3::Hasher::new() };
        put((film, facts), &planes, &mut hashed).map_err(|e| FilmError::io(path, e))
    })
}

fn put((film, facts): (&DualFilm, &FilmFacts), planes: &[Vec<u8>], to: &mut Hashed<'_>) -> io::Result<()> {
    let counts = film.halves().each_ref().map(Film::counts);
    let header = Header { layout: *film.layout(), counts, facts: facts.clone() };
    to.put(MAGIC)?;
    to.put(VERSION)?;
    to.put(serde_json::to_string(&header)?.as_bytes())?;
    to.put(b"\n")?;
    for plane in planes {
        to.put(&(plane.len() as u64).to_le_bytes())?;
        to.put(plane)?;
    }
    let hash = to.hasher.finalize();
    to.file.write_all(hash.as_bytes())?;
    to.file.flush()
}

/// The channels of both halves, packed.
fn planes(film: &DualFilm) -> Vec<Vec<u8>> {
    (0..2 * CHANNELS)
        .into_par_iter()
        .map(|i| {
            let half = &film.halves()[i / CHANNELS];
            pack(&half.sums().map(|sums| sums[i % CHANNELS]).collect::<Vec<_>>())
        })
        .collect()
}

impl FilmRecord {
    /// Whether bytes begin as a film file does.
    pub fn is_film(start: &[u8]) -> bool {
        start.starts_with(MAGIC)
    }

    /// Writes the film as [`write_film`] does.
    ///
    /// # Errors
    /// What the system says.
    pub fn write(&self, path: &Path) -> Result<(), FilmError> {
        write_film(path, &self.film, &self.facts)
    }

    /// Reads a film file.
    ///
    /// # Errors
    /// What the system says, files that are no films, cut short, changed, or of a later version, and films for which
    /// there is no memory.
    pub fn read(path: &Path) -> Result<Self, FilmError> {
        let io = |e| FilmError::io(path, e);
        let mut file = File::open(path).map_err(io)?;
        let mut bytes = Vec::new();
        // What is no film is not read to its end.
        (&mut file).take((MAGIC.len() + VERSION.len()) as u64).read_to_end(&mut bytes).map_err(io)?;
        if Self::is_film(&bytes) {
            file.read_to_end(&mut bytes).map_err(io)?;
        }
        Self::parse(&bytes).map_err(|e| match e {
            FilmError::Layout(message) | FilmError::Merge(message) => FilmError::format(path, message),
            other => other,
        })
    }

    /// Reads a film from the bytes of a file.
    ///
    /// # Errors
    /// As [`FilmRecord::read`], without the file's name.
    pub fn parse(bytes: &[u8]) -> Result<Self, FilmError> {
        let bad = |message: &str| FilmError::Layout(message.to_owned());
        let rest = bytes.strip_prefix(MAGIC).ok_or_else(|| bad("it is not a film file"))?;
        let rest = rest.strip_prefix(VERSION).ok_or_else(|| bad("it is a film file of another version"))?;
        let damaged = || bad("the film file is cut short or damaged");
        let body = rest.len().checked_sub(HASH).ok_or_else(damaged)?;
        let (all, hash) = bytes.split_at(bytes.len() - HASH);
        if blake3::hash(all).as_bytes() != hash {
            return Err(damaged());
        }
        let rest = &rest[..body];
        let end = rest.iter().take(LONGEST_HEADER).position(|b| *b == b'\n').ok_or_else(damaged)?;
        let header: Header = serde_json::from_slice(&rest[..end])
            .map_err(|e| FilmError::Layout(format!("the film file's header cannot be read: {e}")))?;
        header.check_counts()?;
        // Before any memory is taken for the sums.
        let _ = DualFilm::new(header.layout)?;
        let film = unpack_film(&header, &rest[end + 1..]).ok_or_else(damaged)?;
        Ok(Self { film, facts: header.facts })
    }
}

impl Header {
    /// Whether the counts are those of the samples that are said to be there.
    fn check_counts(&self) -> Result<(), FilmError> {
        let ranges = self.facts.samples.as_slice();
        let expected = ranges.iter().map(|r| passes_by_half(r.clone()));
        let expected = expected.fold([0, 0], |sum, n| [sum[0] + n[0], sum[1] + n[1]]);
        let right = |of: fn(&FilmCounts) -> u64| {
            let counts = self.counts.each_ref().map(of);
            counts == [0, 0] || counts == expected
        };
        let in_reach = ranges.last().is_none_or(|r| r.end <= MOST_SAMPLES);
        if in_reach && right(|c| c.eye_samples) && right(|c| c.light_samples) && self.facts.seconds >= 0.0 {
            return Ok(());
        }
        Err(FilmError::Layout("the film file's numbers of samples do not fit together".to_owned()))
    }
}

/// A file whose bytes are hashed while they are written.
struct Hashed<'a> {
    file: BufWriter<&'a mut File>,
    hasher: blake3::Hasher,
}

impl Hashed<'_> {
    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.hasher.update(bytes);
        self.file.write_all(bytes)
    }
}

/// The film of those channels, which fill the bytes exactly; the sizes were checked.
fn unpack_film(header: &Header, mut bytes: &[u8]) -> Option<DualFilm> {
    let count = header.layout.window.pixels() as usize;
    let mut planes = Vec::new();
    for _ in 0..2 * CHANNELS {
        let (length, rest) = bytes.split_first_chunk::<8>()?;
        let (plane, rest) = rest.split_at_checked(u64::from_le_bytes(*length).try_into().ok()?)?;
        planes.push(plane);
        bytes = rest;
    }
    if !bytes.is_empty() {
        return None;
    }
    let channels: Vec<Vec<i64>> = planes.par_iter().map(|p| unpack(p, count)).collect::<Option<_>>()?;
    let half = |h: usize| {
        let channels = &channels[h * CHANNELS..][..CHANNELS];
        let sums: Vec<[i64; CHANNELS]> =
            (0..count).map(|i| std::array::from_fn(|c| channels[c][i])).collect();
        Film::restore(header.layout, &sums, header.counts[h]).ok()
    };
    DualFilm::of_halves([half(0)?, half(1)?]).ok()
}

/// Integers as compressed bytes: those of equal weight lie together, because the upper ones are nearly all alike.
fn pack(values: &[i64]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(8 * values.len());
    for k in 0..8 {
        bytes.extend(values.iter().map(|v| v.to_le_bytes()[k]));
    }
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::fast());
    // Memory takes whatever is written to it.
    let _ = encoder.write_all(&bytes);
    encoder.finish().unwrap_or_default()
}

/// Exactly so many integers; `None` if the bytes hold anything else.
fn unpack(packed: &[u8], count: usize) -> Option<Vec<i64>> {
    let mut bytes = Vec::new();
    let mut decoder = DeflateDecoder::new(packed).take(8 * count as u64 + 1);
    decoder.read_to_end(&mut bytes).ok()?;
    if bytes.len() != 8 * count {
        return None;
    }
    let value = |i: usize| i64::from_le_bytes(std::array::from_fn(|k| bytes[k * count + i]));
    Some((0..count).map(value).collect())
}
