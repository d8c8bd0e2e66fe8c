//! `caustica merge`.

use std::path::Path;
use std::process::ExitCode;

use caustica::film::{FilmRecord, check_writable};
use caustica::scene::Diagnostic;
use serde::Serialize;

use crate::args::Merge;
use crate::console::Console;
use crate::failure::Failure;
use crate::outputs::{check_replaceable, is_film};

/// What `--json` prints, beside warnings.
#[derive(Serialize)]
struct Outcome {
    scene: String,
    /// Such as `0..1000, 2000..3000`.
    samples: String,
    /// Samples per pixel.
    total: u64,
    /// Seconds of rendering of all films together.
    seconds: f64,
    noise: Option<f64>,
    output: String,
}

pub fn run(args: &Merge, console: &Console) -> Result<ExitCode, Failure> {
    let output = &args.output;
    if !is_film(output) {
        return Err(Failure::Usage(format!(
            "the output `{}` must end in .film; `caustica develop` makes a picture of it",
            output.display()
        )));
    }
    check_writable(output).map_err(|e| Failure::output(output, e))?;
    let mut films = args.films.iter();
    let Some(first) = films.next() else {
        return Err(Failure::Usage("name the films that are to be merged".to_owned()));
    };
    let mut sum = read(first)?;
    for path in films {
        let film = read(path)?;
        sum.merge(&film).map_err(|e| refusal(first, path, &e.to_string()))?;
    }
    if !args.force {
        check_replaceable(output, (sum.film.layout(), &sum.facts))?;
    }
    sum.write(output).map_err(|e| Failure::output(output, e))?;
    let facts = &sum.facts;
    let outcome = Outcome {
        scene: facts.provenance.scene.clone(),
        samples: facts.samples.to_string(),
        total: facts.samples.total(),
        seconds: facts.seconds,
        noise: sum.film.error_bars().and_then(|bars| bars.relative()),
        output: output.display().to_string(),
    };
    console.result(&outcome, || summary(&outcome, args.films.len()))?;
    Ok(ExitCode::SUCCESS)
}

fn read(path: &Path) -> Result<FilmRecord, Failure> {
    FilmRecord::read(path).map_err(|e| Failure::input(path, e))
}

fn refusal(first: &Path, other: &Path, why: &str) -> Failure {
    Diagnostic::error(format!(
        "`{}` cannot be added to `{}` and those before it: {why}",
        other.display(),
        first.display()
    ))
    .hint("films can be merged that are of one scene and the same settings, each of samples of its own: `--samples`")
    .into()
}

fn summary(o: &Outcome, films: usize) -> String {
    let noise = o.noise.map_or_else(String::new, |n| format!(", error {:.2} %", 100.0 * n));
    format!(
        "{}: {} samples per pixel ({}) of {films} film{}{noise}\nwrote {}",
        o.scene,
        o.total,
        o.samples,
        if films == 1 { "" } else { "s" },
        o.output
    )
}
