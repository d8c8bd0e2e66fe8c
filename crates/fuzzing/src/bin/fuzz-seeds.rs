//! Writes the seeds and the words of every target for cargo-fuzz: `fuzz-seeds FOLDER` makes
//! `FOLDER/corpus/TARGET/*` and `FOLDER/dictionaries/TARGET.dict`.

use std::fs;
use std::io;
use std::path::Path;
use std::process::ExitCode;

use caustica_fuzzing::{TARGETS, Target};

fn main() -> ExitCode {
    let folder = std::env::args_os().nth(1).unwrap_or_else(|| "fuzz".into());
    match TARGETS.iter().try_for_each(|target| write(Path::new(&folder), target)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("fuzz-seeds: {}: {error}", Path::new(&folder).display());
            ExitCode::FAILURE
        }
    }
}

fn write(folder: &Path, target: &Target) -> io::Result<()> {
    let corpus = folder.join("corpus").join(target.name);
    fs::create_dir_all(&corpus)?;
    for (i, seed) in (target.seeds)().iter().enumerate() {
        fs::write(corpus.join(format!("seed-{i}")), seed)?;
    }
    let dictionaries = folder.join("dictionaries");
    fs::create_dir_all(&dictionaries)?;
    let lines: String = target.words.iter().map(|word| format!("\"{}\"\n", escaped(word))).collect();
    fs::write(dictionaries.join(format!("{}.dict", target.name)), lines)
}

/// As libFuzzer reads it: everything but plain characters in hexadecimal.
fn escaped(word: &str) -> String {
    let byte = |b: u8| match b {
        b'"' | b'\\' => format!("\\x{b:02X}"),
        b' '..=b'~' => char::from(b).to_string(),
        _ => format!("\\x{b:02X}"),
    };
    word.bytes().map(byte).collect()
}
