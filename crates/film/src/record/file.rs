//! Film files.
//!
//! A line `caustica film 1`, a line of JSON (sizes, counts, what it is a film of, which samples it holds), then the
//! sums of one half and those of the other in chunks of 65 536 pixels (the last one shorter), and at last the BLAKE3
//! hash of all before it. A chunk is its length in eight bytes and that many bytes of raw deflate, which hold the sums
//! of six channels one after the other as 64-bit integers: of each channel the lowest bytes of all pixels first, row by
//! row, then the next ones. Of sums beyond 64 bits, if the header counts any, the number of the sum in its half and how
//! often it went round follow the sums, in sixteen bytes each. All numbers are little-endian.

use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Write};
use std::ops::Range;
use std::path::Path;

use flate2::Compression;
use flate2::read::DeflateDecoder;
use flate2::write::DeflateEncoder;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::{FilmFacts, FilmRecord, MOST_SAMPLES, Provenance};
use crate::dual::{DualFilm, passes_by_half};
use crate::film::{CHANNELS, Film, FilmCounts};
use crate::layout::FilmLayout;
use crate::{FilmError, output};

/// How every film file begins.
const MAGIC: &[u8] = b"caustica film ";
const VERSION: &[u8] = b"1\n";

/// The longest header in bytes.
const LONGEST_HEADER: u64 = 1 << 20;

/// Sample numbers have 32 bits.
const SAMPLE_NUMBERS: u64 = 1 << 32;

/// Longer times of rendering are nonsense.
const LONGEST_TIME: f64 = 1e12;

/// Pixels of a chunk.
const CHUNK: usize = 1 << 16;

/// No bytes of deflate hold more than so many times as many.
const CLOSEST_PACKING: u64 = 1040;

/// Chunks that are packed at once.
const AT_ONCE: usize = 8;

#[derive(Serialize, Deserialize)]
struct Header {
    #[serde(flatten)]
    layout: FilmLayout,
    counts: [FilmCounts; 2],
    /// How many sums of each half are beyond 64 bits.
    #[serde(default, skip_serializing_if = "are_zero")]
    beyond: [u64; 2],
    #[serde(flatten)]
    facts: FilmFacts,
}

fn are_zero(counts: &[u64; 2]) -> bool {
    *counts == [0, 0]
}

/// Writes a film, under a temporary name first: a file of that name is replaced whole or not at all. The same film and
/// facts give the same bytes.
///
/// # Errors
/// What the system says.
pub fn write_film(path: &Path, film: &DualFilm, facts: &FilmFacts) -> Result<(), FilmError> {
    output::write_atomically(path, |file| {
        let mut hashed = Hashed { to: BufWriter::new(file), hasher: blake3::Hasher::new() };
        put(film, facts, &mut hashed).map_err(|e| FilmError::io(path, e))
    })
}

fn put<W: Write>(film: &DualFilm, facts: &FilmFacts, to: &mut Hashed<W>) -> io::Result<()> {
    let counts = film.halves().each_ref().map(Film::counts);
    let turns = film.halves().each_ref().map(|half| half.turns().all());
    let beyond = turns.each_ref().map(|t| t.len() as u64);
    let header = Header { layout: *film.layout(), counts, beyond, facts: facts.clone() };
    to.write_all(MAGIC)?;
    to.write_all(VERSION)?;
    to.write_all(serde_json::to_string(&header)?.as_bytes())?;
    to.write_all(b"\n")?;
    let pixels = film.layout().window.pixels() as usize;
    let chunks: Vec<(&Film, Range<usize>)> =
        film.halves().iter().flat_map(|half| chunks(pixels).map(move |c| (half, c))).collect();
    for some in chunks.chunks(AT_ONCE) {
        let packed: Vec<Vec<u8>> = some.par_iter().map(|(half, c)| pack(half.some_sums(c.clone()))).collect();
        for chunk in packed {
            to.write_all(&(chunk.len() as u64).to_le_bytes())?;
            to.write_all(&chunk)?;
        }
    }
    for (number, turns) in turns.into_iter().flatten() {
        to.write_all(&number.to_le_bytes())?;
        to.write_all(&turns.to_le_bytes())?;
    }
    let hash = to.hasher.finalize();
    to.to.write_all(hash.as_bytes())?;
    to.to.flush()
}

/// The pixels of each chunk.
fn chunks(pixels: usize) -> impl Iterator<Item = Range<usize>> {
    (0..pixels).step_by(CHUNK).map(move |start| start..(start + CHUNK).min(pixels))
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
        let file = File::open(path).map_err(io)?;
        let length = file.metadata().map_err(io)?.len();
        Self::read_from(BufReader::new(file), length).map_err(|e| e.of_file(path))
    }

    /// Reads what a film file says of itself, and none of its sums.
    ///
    /// # Errors
    /// What the system says, files that are no films, and those of a later version.
    pub fn read_facts(path: &Path) -> Result<(FilmLayout, FilmFacts), FilmError> {
        let file = File::open(path).map_err(|e| FilmError::io(path, e))?;
        let mut from = Hashed { to: BufReader::new(file), hasher: blake3::Hasher::new() };
        let header = header(&mut from).map_err(|e| e.of_file(path))?;
        Ok((header.layout, header.facts))
    }

    /// Reads a film from the bytes of a file.
    ///
    /// # Errors
    /// As [`FilmRecord::read`], without the file's name.
    pub fn parse(bytes: &[u8]) -> Result<Self, FilmError> {
        Self::read_from(bytes, bytes.len() as u64).map_err(|e| match e {
            Bad::Io(_) => bad(DAMAGED),
            Bad::Film(e) => e,
        })
    }

    /// Of a file of that length; no more memory is taken than it can fill.
    fn read_from(from: impl BufRead, length: u64) -> Result<Self, Bad> {
        let mut from = Hashed { to: from, hasher: blake3::Hasher::new() };
        let header = header(&mut from)?;
        let pixels = Film::check_memory(header.layout.window, 2)?;
        let bytes = 2 * 8 * CHANNELS as u64 * pixels as u64;
        if bytes / CLOSEST_PACKING > length {
            return Err(bad(DAMAGED).into());
        }
        let mut film = DualFilm::new(header.layout)?;
        for (half, counts) in film.halves_mut().iter_mut().zip(header.counts) {
            for chunk in chunks(pixels) {
                let sums = chunk_of(&mut from, chunk.len())?;
                half.set_sums(chunk.start, sums);
            }
            half.add_counts(counts);
        }
        for (half, count) in film.halves_mut().iter_mut().zip(header.beyond) {
            half.turns_mut().restore(turns_of(&mut from, count)?, (pixels * CHANNELS) as u64)?;
        }
        let expected = from.hasher.finalize();
        let mut hash = Vec::new();
        from.to.take(expected.as_bytes().len() as u64 + 1).read_to_end(&mut hash)?;
        if hash != expected.as_bytes() {
            return Err(bad(DAMAGED).into());
        }
        Ok(Self { film, facts: header.facts })
    }
}

const DAMAGED: &str = "the film file is cut short or damaged";

fn bad(message: &str) -> FilmError {
    FilmError::Layout(message.to_owned())
}

/// Why a film cannot be read.
enum Bad {
    Io(io::Error),
    Film(FilmError),
}

impl Bad {
    fn of_file(self, path: &Path) -> FilmError {
        match self {
            Self::Io(e) if e.kind() == io::ErrorKind::UnexpectedEof => FilmError::format(path, DAMAGED),
            Self::Io(e) => FilmError::io(path, e),
            Self::Film(FilmError::Layout(message) | FilmError::Merge(message)) => {
                FilmError::format(path, message)
            }
            Self::Film(other) => other,
        }
    }
}

impl From<io::Error> for Bad {
    fn from(e: io::Error) -> Self {
        Self::Io(e)
    }
}

impl From<FilmError> for Bad {
    fn from(e: FilmError) -> Self {
        Self::Film(e)
    }
}

/// The checked header.
fn header(from: &mut Hashed<impl BufRead>) -> Result<Header, Bad> {
    let mut start = Vec::new();
    from.by_ref().take((MAGIC.len() + VERSION.len()) as u64).read_to_end(&mut start)?;
    let version = start.strip_prefix(MAGIC).ok_or_else(|| bad("it is not a film file"))?;
    if version != VERSION {
        return Err(bad("it is a film file of another version").into());
    }
    let mut line = Vec::new();
    from.by_ref().take(LONGEST_HEADER).read_until(b'\n', &mut line)?;
    let line = line.strip_suffix(b"\n").ok_or_else(|| bad(DAMAGED))?;
    let header: Header = serde_json::from_slice(line)
        .map_err(|e| bad(&format!("the film file's header cannot be read: {e}")))?;
    header.layout.check()?;
    header.check()?;
    Ok(header)
}

impl Header {
    /// Whether the counts are those of the samples that are said to be there, and all else makes sense.
    fn check(&self) -> Result<(), FilmError> {
        let ranges = self.facts.samples.as_slice();
        let expected = ranges.iter().map(|r| passes_by_half(r.clone()));
        let expected = expected.fold([0, 0], |sum, n| [sum[0] + n[0], sum[1] + n[1]]);
        let eye = self.counts.map(|c| c.eye_samples);
        let light = self.counts.map(|c| c.light_samples);
        let all = |counts| counts == expected;
        let none = |counts| counts == [0, 0];
        let counted = (all(eye) && (all(light) || none(light))) || (none(eye) && all(light));
        let in_reach = ranges.last().is_none_or(|r| r.end <= SAMPLE_NUMBERS);
        if !counted || !in_reach || self.facts.samples.total() > MOST_SAMPLES {
            return Err(bad("the film file's numbers of samples do not fit together"));
        }
        if !(0.0..LONGEST_TIME).contains(&self.facts.seconds) {
            return Err(bad("the film file's time of rendering makes no sense"));
        }
        let Provenance { scene, scene_hash, settings } = &self.facts.provenance;
        let mut texts = [scene, scene_hash].into_iter().chain(settings.iter().flat_map(|(n, v)| [n, v]));
        if texts.any(|t| t.chars().any(char::is_control)) {
            return Err(bad("the film file's header holds control characters"));
        }
        Ok(())
    }
}

/// Bytes that are hashed on their way.
struct Hashed<T> {
    to: T,
    hasher: blake3::Hasher,
}

impl<W: Write> Write for Hashed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.to.write(bytes)?;
        self.hasher.update(&bytes[..count]);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

impl<R: Read> Read for Hashed<R> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let count = self.to.read(bytes)?;
        self.hasher.update(&bytes[..count]);
        Ok(count)
    }
}

impl<R: BufRead> BufRead for Hashed<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.to.fill_buf()
    }

    fn consume(&mut self, count: usize) {
        // What is consumed is in the buffer.
        if let Ok(bytes) = self.to.fill_buf() {
            self.hasher.update(&bytes[..count]);
        }
        self.to.consume(count);
    }
}

/// Sums as compressed bytes: those of equal weight lie together, because the upper ones are nearly all alike.
fn pack(sums: impl ExactSizeIterator<Item = [i64; CHANNELS]>) -> Vec<u8> {
    let count = sums.len();
    let mut bytes = vec![0; 8 * CHANNELS * count];
    for (i, sums) in sums.enumerate() {
        for (c, sum) in sums.into_iter().enumerate() {
            for (k, byte) in sum.to_le_bytes().into_iter().enumerate() {
                bytes[(8 * c + k) * count + i] = byte;
            }
        }
    }
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::fast());
    // Memory takes whatever is written to it.
    let _ = encoder.write_all(&bytes);
    encoder.finish().unwrap_or_default()
}

/// The sums of the next chunk, which has exactly so many pixels.
fn chunk_of(
    from: &mut Hashed<impl Read>,
    count: usize,
) -> Result<impl Iterator<Item = [i64; CHANNELS]>, Bad> {
    let mut length = [0; 8];
    from.read_exact(&mut length)?;
    let (length, raw) = (u64::from_le_bytes(length), 8 * CHANNELS * count);
    let mut packed = Vec::new();
    // Deflate makes nothing longer by more than a thousandth and a few bytes.
    if length <= raw as u64 + raw as u64 / 1000 + 64 {
        from.by_ref().take(length).read_to_end(&mut packed)?;
    }
    if packed.len() as u64 != length {
        return Err(bad(DAMAGED).into());
    }
    let bytes = inflated(&packed, raw).ok_or_else(|| bad(DAMAGED))?;
    let sum =
        move |i: usize, c: usize| i64::from_le_bytes(std::array::from_fn(|k| bytes[(8 * c + k) * count + i]));
    Ok((0..count).map(move |i| std::array::from_fn(|c| sum(i, c))))
}

/// The next so many sums beyond 64 bits.
fn turns_of(from: &mut impl Read, count: u64) -> Result<Vec<(u64, i64)>, Bad> {
    let mut turns = Vec::new();
    for _ in 0..count {
        let (mut number, mut of) = ([0; 8], [0; 8]);
        from.read_exact(&mut number)?;
        from.read_exact(&mut of)?;
        turns.push((u64::from_le_bytes(number), i64::from_le_bytes(of)));
    }
    Ok(turns)
}

/// Exactly so many bytes; `None` if the compressed ones hold anything else.
fn inflated(packed: &[u8], length: usize) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut decoder = DeflateDecoder::new(packed);
    decoder.by_ref().take(length as u64 + 1).read_to_end(&mut bytes).ok()?;
    (bytes.len() == length && decoder.total_in() == packed.len() as u64).then_some(bytes)
}
