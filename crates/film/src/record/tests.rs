use std::fs;

use caustica_math::filter::PixelFilter;
use caustica_math::stream::{SampleStream, StreamId};
use caustica_math::{Filter, Rgb, Vec2};

use super::*;
use crate::layout::{FilmLayout, Window};

fn layout() -> FilmLayout {
    let window = Window { x: 3, y: 1, width: 17, height: 11 };
    FilmLayout { width: 24, height: 16, window, quantum_exponent: -30 }
}

fn provenance() -> Provenance {
    let settings = [("integrator", "bdpt"), ("seed", "7")].map(|(n, v)| (n.to_owned(), v.to_owned()));
    Provenance { scene: "küche.xml".into(), scene_hash: "ab12".into(), settings: settings.into() }
}

/// A film of those samples, with values of all sizes and signs.
fn record(samples: std::ops::Range<u64>) -> FilmRecord {
    let (film, filter) = (DualFilm::new(layout()).unwrap(), PixelFilter::new(&Filter::default()));
    for pass in samples.clone() {
        let mut s = SampleStream::new(StreamId { seed: 3, pixel: 0, sample: pass as u32, walk: 0 });
        for y in 0..16 {
            for x in 0..24 {
                let size = 10f32.powi((s.next_1d() * 12.0) as i32 - 8);
                let value = Rgb::new(s.next_1d(), s.next_1d() - 0.5, s.next_1d()) * size;
                film.half(pass).add_eye([x, y], value);
                film.half(pass).splat_light(&filter, Vec2::new(x as f32, y as f32), value);
            }
        }
    }
    film.finish_passes(samples.clone(), true, true);
    let facts = FilmFacts { provenance: provenance(), samples: samples.into(), seconds: 1.5 };
    FilmRecord { film, facts }
}

#[test]
fn merged_films_have_the_bits_of_one_in_any_order_and_grouping() {
    let whole = record(0..9);
    let merged = |order: [std::ops::Range<u64>; 3]| {
        let [a, b, c] = order;
        let (mut left, mut right) = (record(a), record(b));
        right.merge(&record(c)).unwrap();
        left.merge(&right).unwrap();
        left
    };
    for order in [[0..2, 2..5, 5..9], [5..9, 0..2, 2..5], [2..5, 5..9, 0..2]] {
        let all = merged(order);
        assert!(all.film.bits_equal(&whole.film));
        assert_eq!((all.facts.samples.to_string().as_str(), all.facts.seconds), ("0..9", 4.5));
    }
}

#[test]
fn films_of_something_else_are_refused_and_leave_the_first_as_it_is() {
    let mut first = record(0..2);
    let before = first.film.fingerprint();
    let changed = |change: &dyn Fn(&mut FilmRecord)| {
        let mut other = record(2..4);
        change(&mut other);
        other
    };
    let set = |r: &mut FilmRecord, n: &str, v: &str| r.facts.provenance.settings.insert(n.into(), v.into());
    type Change<'a> = &'a dyn Fn(&mut FilmRecord);
    let cases: [(Change<'_>, &str); 5] = [
        (&|r| r.facts.provenance.scene_hash.clear(), "they differ in what `küche.xml` holds"),
        (
            &|r| {
                r.facts.provenance.scene_hash.clear();
                r.facts.provenance.scene = "bad.xml".into();
            },
            "they differ in the scene (`küche.xml` and `bad.xml`)",
        ),
        (&|r| _ = set(r, "seed", "8"), "they differ in the seed (7 and 8)"),
        (&|r| _ = set(r, "maxDepth", "3"), "they differ in the maxDepth (not set and 3)"),
        (&|r| r.facts.samples = (1..5).into(), "both hold the samples 1..2"),
    ];
    for (change, expected) in cases {
        let error = first.merge(&changed(change)).unwrap_err().to_string();
        assert_eq!(error, expected);
    }
    let other_size = FilmLayout { quantum_exponent: -29, ..layout() };
    let other = FilmRecord { film: DualFilm::new(other_size).unwrap(), ..record(2..4) };
    let error = first.merge(&other).unwrap_err().to_string();
    assert!(error.contains("24 × 16 pixels (of them 17 × 11 from 3, 1) in quanta of 2^-29"), "{error}");
    assert_eq!((first.film.fingerprint(), first.facts.samples.total()), (before, 2));
    // The name alone is no difference.
    first.merge(&changed(&|r| r.facts.provenance.scene = "kopie.xml".into())).unwrap();
}

#[test]
fn files_round_trip_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.film");
    for samples in [0..0, 0..1, 5..9] {
        let written = record(samples);
        written.write(&path).unwrap();
        let read = FilmRecord::read(&path).unwrap();
        assert!(read.film.bits_equal(&written.film));
        assert_eq!(read.facts, written.facts);
        let bytes = fs::read(&path).unwrap();
        assert!(FilmRecord::is_film(&bytes));
        read.write(&path).unwrap();
        assert_eq!(fs::read(&path).unwrap(), bytes);
    }
}

/// Films of more pixels than a chunk has.
#[test]
fn large_films_round_trip() {
    let window = Window { x: 0, y: 0, width: 300, height: 500 };
    let layout = FilmLayout { width: 300, height: 500, window, quantum_exponent: -20 };
    let film = DualFilm::new(layout).unwrap();
    for i in 0..150_000u32 {
        let pass = u64::from(i % 2);
        film.half(pass).add_eye([i % 300, i / 300], Rgb::new(i as f32, -1.0, 1.0 / (i + 1) as f32));
    }
    film.finish_passes(0..2, true, false);
    let facts = FilmFacts { provenance: provenance(), samples: (0..2).into(), seconds: 0.0 };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.film");
    write_film(&path, &film, &facts).unwrap();
    assert!(FilmRecord::read(&path).unwrap().film.bits_equal(&film));
}

/// The bytes of a file with a changed header and a right hash.
fn with_header(bytes: &[u8], change: impl Fn(String) -> String) -> Vec<u8> {
    let start = bytes.iter().position(|b| *b == b'\n').unwrap() + 1;
    let end = start + bytes[start..].iter().position(|b| *b == b'\n').unwrap();
    let header = change(String::from_utf8(bytes[start..end].to_vec()).unwrap());
    sealed([&bytes[..start], header.as_bytes(), &bytes[end..bytes.len() - 32]].concat())
}

fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let hash = blake3::hash(&bytes);
    bytes.extend_from_slice(hash.as_bytes());
    bytes
}

#[test]
fn damaged_and_foreign_files_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.film");
    record(0..3).write(&path).unwrap();
    let bytes = fs::read(&path).unwrap();
    let error = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        match FilmRecord::read(&path) {
            Ok(_) => panic!("was read"),
            Err(e) => e.to_string(),
        }
    };
    for length in [16, 17, 60, bytes.len() / 2, bytes.len() - 1] {
        assert!(error(&bytes[..length]).contains("cut short or damaged"), "{length}");
    }
    assert!(error(b"").contains("not a film file") && error(&bytes[..5]).contains("not a film file"));
    assert!(error(&[&bytes[..], b"more"].concat()).contains("cut short or damaged"));
    assert!(error(b"caustica film 2\n{}").contains("another version"));
    for at in (0..bytes.len()).step_by(97) {
        let mut changed = bytes.clone();
        changed[at] ^= 4;
        let _ = error(&changed);
    }
    let header = |from: &str, to: &str| {
        let changed = with_header(&bytes, |h| {
            assert!(h.contains(from), "{h}");
            h.replacen(from, to, 1)
        });
        error(&changed)
    };
    assert!(header("\"width\":24", "\"width\":24000000").contains("longer than"));
    assert!(header("\"height\":11", "\"height\":10").contains("cut short or damaged"));
    assert!(header("\"start\":0", "\"start\":1").contains("do not fit together"));
    assert!(header("\"end\":3", "\"end\":4").contains("do not fit together"));
    assert!(header("\"eye_samples\":2", "\"eye_samples\":0").contains("do not fit together"));
    assert!(header("\"end\":3", "\"end\":99999999999").contains("do not fit together"));
    assert!(header("\"seconds\":1.5", "\"seconds\":1e300").contains("makes no sense"));
    assert!(header("küche", "k\\u001b[2Jche").contains("control characters"));
    assert!(header("\"seconds\":", "\"second\":").contains("header cannot be read"));
    assert!(error(&sealed([&bytes[..bytes.len() - 32], b"more"].concat())).contains("damaged"));
    assert!(error(&sealed(bytes[..bytes.len() - 40].to_vec())).contains("damaged"));
    let missing = FilmRecord::read(&folder.path().join("none.film"));
    assert!(matches!(missing, Err(FilmError::Io { .. })));
}

/// A header that announces a film larger than the memory, and one whose sums unpack to more than they should.
#[test]
fn announcements_are_not_believed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.film");
    record(0..2).write(&path).unwrap();
    let bytes = fs::read(&path).unwrap();
    let huge = with_header(&bytes, |h| {
        h.replacen("\"width\":24,\"height\":16", "\"width\":8388608,\"height\":8388608", 1).replacen(
            "\"width\":17,\"height\":11",
            "\"width\":8388000,\"height\":8388000",
            1,
        )
    });
    let error = FilmRecord::parse(&huge).unwrap_err();
    assert!(matches!(error, FilmError::TooLarge { .. }), "{error:?}");
    // One that the memory would hold, but not so short a file.
    let large = with_header(&bytes, |h| {
        h.replacen("\"width\":24,\"height\":16", "\"width\":9000,\"height\":4000", 1).replacen(
            "\"width\":17,\"height\":11",
            "\"width\":4500,\"height\":3900",
            1,
        )
    });
    let start = std::time::Instant::now();
    assert!(FilmRecord::parse(&large).unwrap_err().to_string().contains("damaged"));
    assert!(start.elapsed().as_secs_f64() < 0.2);
    let small = with_header(&bytes, |h| h.replacen("\"width\":17", "\"width\":1", 1));
    assert!(FilmRecord::parse(&small).unwrap_err().to_string().contains("damaged"));
}

/// Sums beyond 64 bits, up and down, are kept exactly.
#[test]
fn sums_beyond_64_bits_survive_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.film");
    let bright = record(0..3);
    for _ in 0..13 {
        bright.film.half(0).add_eye([10, 8], Rgb::splat(1e30));
        bright.film.half(1).add_eye([11, 8], Rgb::splat(-1e30));
    }
    bright.write(&path).unwrap();
    let read = FilmRecord::read(&path).unwrap();
    assert!(read.film.bits_equal(&bright.film));
    let count =
        |half: usize, end: i64| read.film.halves()[half].sums().flatten().filter(|s| *s == end).count();
    assert_eq!((count(0, i64::MAX), count(1, i64::MIN)), (3, 3));
    // What cannot be is refused.
    let bytes = fs::read(&path).unwrap();
    let at = bytes.len() - 32 - 6 * 16;
    for (offset, value) in [(0, u64::MAX), (8, 0), (8, 1 << 40), (16, 0)] {
        let mut changed = bytes[..bytes.len() - 32].to_vec();
        changed[at + offset..at + offset + 8].copy_from_slice(&value.to_le_bytes());
        let told = FilmRecord::parse(&sealed(changed)).err().map(|e| e.to_string());
        assert!(told.as_ref().is_some_and(|t| t.contains("largest sums make no sense")), "{told:?}");
    }
    // An ordinary film is written as before.
    record(0..3).write(&path).unwrap();
    assert!(!String::from_utf8_lossy(&fs::read(&path).unwrap()).contains("beyond"));
}
