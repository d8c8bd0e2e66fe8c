//! `caustica verify`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use caustica::Scene;
use caustica::description::Integrator;
use caustica::film::check_writable;
use caustica::scene::Diagnostic;
use caustica::session::available_threads;
use caustica_report::{Verification, percent, write_verification};
use caustica_verify::{Options, Outcome, VerifyError, heat_map, verification, verify};
use serde::Serialize;

use crate::args::{Sampling, Source, Verify};
use crate::compare::report_failure;
use crate::console::Console;
use crate::failure::Failure;
use crate::interrupt::Interrupts;
use crate::loading::{self, Depths};
use crate::progress::Bar;

/// The longest side of the picture if nobody asks for a size.
const SIDE: u32 = 96;

/// The exit code if something differs.
const DIFFERS: u8 = 1;

/// What `--json` prints, beside warnings.
#[derive(Serialize)]
struct Told<'a> {
    agrees: bool,
    outputs: Vec<String>,
    #[serde(flatten)]
    verification: &'a Verification,
}

pub fn run(args: &Verify, console: &mut Console) -> Result<ExitCode, Failure> {
    let (scene, _, depths) = open_small(&args.source, console)?;
    let args = &Verify { sampling: args.sampling.or(depths).suited(&scene), ..args.clone() };
    let folder = args.output.clone().unwrap_or_else(|| args.source.beside("-verify"));
    let files = ["heat.png", "report.json", "index.html"].map(|name| folder.join(name));
    fs::create_dir_all(&folder)
        .map_err(|e| Failure::Output(format!("cannot make the folder `{}`: {e}", folder.display())))?;
    for file in &files {
        check_writable(file).map_err(|e| Failure::output(file, e))?;
    }
    let options = Options {
        settings: args.sampling.settings(Integrator::Bdpt),
        samples: args.spp,
        block: args.block,
        significance: args.significance,
        threads: args.source.threads.map(usize::from),
    };
    let outcome = measure(&scene, &options, console)?;
    console.warn(more_samples(args.spp, outcome.samples));
    let title = format!("{}: do all integrators agree?", args.source.name());
    let mut told =
        verification(&outcome, (&title, &args.source.name()), notes(&args.source, &args.sampling, &scene));
    save(&outcome, &mut told, (&folder, &files[0]))?;
    let outputs = files.iter().map(|f| f.display().to_string()).collect();
    let told = Told { agrees: outcome.agrees(), outputs, verification: &told };
    console.result(&told, || summary(&told))?;
    Ok(if told.agrees { ExitCode::SUCCESS } else { ExitCode::from(DIFFERS) })
}

/// The scene, in a small picture unless a size is asked for, and the names of its shapes.
pub fn open_small(source: &Source, console: &mut Console) -> Result<(Scene, Vec<String>, Depths), Failure> {
    let side = if source.resolution.is_some() || source.crop.is_some() { None } else { Some(SIDE) };
    loading::open_shrunk(source, side, console)
}

fn measure(scene: &Scene, options: &Options, console: &Console) -> Result<Outcome, Failure> {
    let interrupts = Interrupts::listen();
    interrupts.stop_at_once();
    let bar = Bar::new(console.is_talkative());
    let outcome =
        verify(scene, options, &interrupts.control, |stage| bar.show_part(stage.name, stage.fraction));
    bar.finish();
    Ok(outcome?)
}

impl From<VerifyError> for Failure {
    fn from(e: VerifyError) -> Self {
        match e {
            VerifyError::Render(e) => e.into(),
            VerifyError::Memory { .. } => Self::Machine(e.to_string()),
            other => Self::Usage(other.to_string()),
        }
    }
}

/// Samples are split into independent parts of equal size, so that there may be more of them than were asked for.
pub fn more_samples(asked: u32, taken: u32) -> Option<Diagnostic> {
    (taken != asked).then(|| {
        Diagnostic::warning(format!("{taken} samples a pixel were taken instead of {asked}"))
            .hint("they are split into independent parts of equal size, whose differences tell the noise")
    })
}

/// What was asked for, for people.
pub fn notes(source: &Source, sampling: &Sampling, scene: &Scene) -> Vec<(String, String)> {
    let window = scene.film.window();
    let threads = source.threads.map_or_else(available_threads, usize::from);
    let mut notes: Vec<(String, String)> =
        [("size", format!("{} × {} pixels", window.width, window.height)), ("threads", threads.to_string())]
            .map(|(name, value)| (name.to_owned(), value))
            .into();
    notes.extend(sampling.notes());
    notes
}

fn save(
    outcome: &Outcome,
    told: &mut Verification,
    (folder, heat): (&Path, &PathBuf),
) -> Result<(), Failure> {
    let unwritable =
        |e: &dyn std::fmt::Display| Failure::Output(format!("cannot write `{}`: {e}", heat.display()));
    heat_map(outcome, &told.title).and_then(|canvas| canvas.write_png(heat)).map_err(|e| unwritable(&e))?;
    told.heat_map = fs::read(heat).map_err(|e| unwritable(&e))?;
    write_verification(told, folder).map_err(|e| report_failure(folder, e))
}

fn summary(told: &Told<'_>) -> String {
    let mut text = format!(
        "{:<24} {:>22} {:>6} {:>7} {:>9} {:>9}  {}\n",
        "", "mean", "tests", "differ", "p", "untested", "verdict"
    );
    for e in &told.verification.estimators {
        text += &format!(
            "{:<24} {:>22} {:>6} {:>7} {:>9} {:>9}  {}\n",
            e.name,
            format!("{:.5} ± {:.5}", e.mean, e.error),
            e.tests,
            e.mismatches,
            if e.tests > 0 { format!("{:.1e}", e.smallest_p) } else { "–".to_owned() },
            percent(e.untested),
            e.verdict
        );
    }
    text += "\nWhat carries the light here, and who misses it:\n";
    for p in &told.verification.patterns {
        let missed = if p.missed_by.is_empty() {
            "reached by all".to_owned()
        } else {
            format!("missed by {}", p.missed_by.join("; "))
        };
        text += &format!("  {:<16} {:>6} from {}: {missed}\n", p.pattern, percent(p.share), p.lamp);
    }
    text += &format!("\n{}\n", told.verification.verdict);
    text + &format!("wrote {}", told.outputs.join(", "))
}
