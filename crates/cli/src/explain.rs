//! `caustica explain`.

use std::process::ExitCode;

use caustica::description::{Crop, Integrator};
use caustica_verify::{Explanation, Question, explain};

use caustica_report::percent;

use crate::args::Explain;
use crate::console::Console;
use crate::failure::Failure;
use crate::interrupt::Interrupts;
use crate::progress::Bar;
use crate::render::integrator;
use crate::verify::{more_samples, open_small};

/// Rows of the table.
const ROWS: usize = 12;

pub fn run(args: &Explain, console: &mut Console) -> Result<ExitCode, Failure> {
    let (scene, names, depths) = open_small(&args.source, console)?;
    let window = scene.film.window();
    if let Some(r) = args.region {
        check(r, window)?;
    }
    let chosen = integrator(&args.integrator, &scene).unwrap_or(Integrator::Bdpt);
    let question = Question {
        region: args.region,
        settings: args.sampling.or(depths).suited(&scene).settings(chosen),
        samples: args.spp,
        threads: args.source.threads.map(usize::from),
        names: &names,
    };
    let interrupts = Interrupts::listen();
    interrupts.stop_at_once();
    let bar = Bar::new(console.is_talkative());
    let answer =
        explain(&scene, &question, &interrupts.control, |fraction| bar.show_part("looking", fraction));
    bar.finish();
    let answer = answer?;
    console.warn(more_samples(args.spp, answer.samples));
    console.result(&answer, || text(&answer))?;
    Ok(ExitCode::SUCCESS)
}

fn check(r: Crop, w: Crop) -> Result<(), Failure> {
    let fits = |start: u32, size: u32, first: u32, whole: u32| {
        start >= first && start.checked_add(size).is_some_and(|end| end <= first + whole)
    };
    if fits(r.x, r.width, w.x, w.width) && fits(r.y, r.height, w.y, w.height) {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "the region reaches beyond the picture of {} × {} pixels from {},{} that is looked at; `--resolution` \
         makes it larger",
        w.width, w.height, w.x, w.y
    )))
}

fn text(a: &Explanation) -> String {
    let [x, y, width, height] = a.region;
    let mut text = format!(
        "{width} × {height} pixels from {x},{y}, {} samples each: mean luminance {:.5}, one sample is off by {}\n\n",
        a.samples,
        a.mean,
        percent(a.per_sample)
    );
    if !a.rows.is_empty() {
        text += &format!(
            "{:<16} {:>8} {:>8} {:>11}  {:<22} {:<26} {}\n",
            "paths", "light", "noise", "per sample", "from", "found by strategies", "missed by"
        );
    }
    for r in a.rows.iter().take(ROWS) {
        let missed = if r.missed_by.is_empty() { "–".to_owned() } else { r.missed_by.join(", ") };
        text += &format!(
            "{:<16} {:>8} {:>8} {:>11}  {:<22} {:<26} {missed}\n",
            r.pattern,
            percent(r.light),
            percent(r.noise),
            format!("{:.2}", r.per_sample),
            r.lamp,
            r.strategies.join(", "),
        );
    }
    for m in &a.missing {
        text += &format!("{:<16} {:>8} missing\n", m.pattern, format!("~{}", percent(m.share)));
    }
    text += "\n";
    for sentence in &a.sentences {
        text += &format!("{sentence}\n");
    }
    text
}
