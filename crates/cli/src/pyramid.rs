//! `caustica pyramid`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use caustica::description::Integrator;
use caustica::film::{Film, Metadata, check_writable, write_layers};
use caustica::session::pyramid::{Layer, Pyramid};
use caustica::{LightImage, RenderOptions, Rgb};
use caustica_canvas::{Canvas, CanvasError, Cell, LegendLine, Row, SheetStyle, sheet};
use caustica_report::{StrategyImages, write_pyramid};
use serde::Serialize;

use crate::args::Pyramid as Arguments;
use crate::compare::report_failure;
use crate::console::Console;
use crate::failure::Failure;
use crate::interrupt::Interrupts;
use crate::loading;
use crate::progress::Bar;
use crate::render::loss_warnings;

/// The longest side of a picture on a sheet, in pixels.
const LARGEST_CELL: u32 = 240;

/// What `--json` prints, beside warnings.
#[derive(Serialize)]
struct Outcome {
    strategies: usize,
    samples: u64,
    seconds: f64,
    outputs: Vec<String>,
}

/// The files that are written.
struct Files {
    weighted: PathBuf,
    unweighted: PathBuf,
    layers: PathBuf,
    page: PathBuf,
}

pub fn run(args: &Arguments, console: &mut Console) -> Result<ExitCode, Failure> {
    let opened = loading::open(&args.source, console)?;
    let args = &Arguments { sampling: args.sampling.or(opened.depths).suited(&opened.scene), ..args.clone() };
    let files = Files::new(args)?;
    let options = RenderOptions {
        settings: args.sampling.settings(Integrator::Bdpt),
        samples: args.length.samples(opened.samples),
        time: args.length.time,
        threads: args.source.threads.map(usize::from),
        ..RenderOptions::default()
    };
    let pyramid = Pyramid::new(&opened.scene, options, args.rows)?;
    let interrupts = Interrupts::listen();
    let bar = Bar::new(console.is_talkative());
    let seconds = pyramid.run(&interrupts.control, |p| {
        bar.tell_stop(&interrupts.control);
        bar.show(p);
    });
    bar.finish();
    let outcome = Outcome {
        strategies: pyramid.layers().len(),
        samples: pyramid.whole().eye_samples(),
        seconds: seconds?,
        outputs: files.all().map(|p| p.display().to_string()).into(),
    };
    for (what, film) in losses(&pyramid) {
        console.warn(loss_warnings(&what, (film.invalid(), film.clamped())));
    }
    save(&pyramid, (args, &files), &outcome)?;
    console.result(&outcome, || summary(&outcome))?;
    Ok(ExitCode::SUCCESS)
}

impl Files {
    fn new(args: &Arguments) -> Result<Self, Failure> {
        let stem = args.output.clone().unwrap_or_else(|| args.source.beside("-pyramid"));
        let with = |ending: &str| {
            let mut name = stem.clone().into_os_string();
            name.push(ending);
            PathBuf::from(name)
        };
        let files = Self {
            weighted: with(".png"),
            unweighted: with("-unweighted.png"),
            layers: with(".exr"),
            page: with(".html"),
        };
        for file in files.all() {
            check_writable(file).map_err(|e| Failure::output(file, e))?;
        }
        Ok(files)
    }

    fn all(&self) -> [&Path; 4] {
        [&self.weighted, &self.unweighted, &self.layers, &self.page]
    }
}

/// The films in which contributions can be lost.
fn losses<'a>(pyramid: &'a Pyramid<'_>) -> impl Iterator<Item = (String, &'a Film)> {
    let unweighted = |l: &'a Layer| (format!("strategy {}, unweighted", l.strategy), &l.unweighted);
    std::iter::once(("the picture".to_owned(), pyramid.whole()))
        .chain(pyramid.layers().iter().map(unweighted))
}

/// What a strategy's film shows; only one of its two images has anything.
fn pixels(film: &Film) -> Vec<Rgb> {
    film.develop().combined(LightImage::On)
}

fn save(
    pyramid: &Pyramid<'_>,
    (args, files): (&Arguments, &Files),
    outcome: &Outcome,
) -> Result<(), Failure> {
    let window = pyramid.whole().layout().window;
    let images: Vec<StrategyImages> = pyramid
        .layers()
        .iter()
        .map(|Layer { strategy, weighted, unweighted }| StrategyImages {
            s: strategy.s,
            t: strategy.t,
            weighted: pixels(weighted),
            unweighted: pixels(unweighted),
        })
        .collect();
    let rest = pixels(pyramid.rest());
    let longer: &[Rgb] = if rest.iter().all(|p| *p == Rgb::BLACK) { &[] } else { &rest };
    let notes = notes(args, outcome);
    save_layers(pyramid, (&images, &rest), (&files.layers, &notes))?;
    for (path, weighted) in [(&files.weighted, true), (&files.unweighted, false)] {
        sheet_of((&images, longer), [window.width, window.height], weighted, args)
            .and_then(|canvas| canvas.write_png(path))
            .map_err(|e| Failure::Output(format!("cannot write `{}`: {e}", path.display())))?;
    }
    let page = caustica_report::Pyramid {
        title: format!("{}: strategies by path length", args.source.name()),
        width: window.width,
        height: window.height,
        strategies: images,
        rest: longer.to_vec(),
        notes,
    };
    write_pyramid(&page, &files.page).map_err(|e| report_failure(&files.page, e))
}

fn notes(args: &Arguments, outcome: &Outcome) -> Vec<(String, String)> {
    let mut notes: Vec<(String, String)> = [
        ("scene", args.source.name()),
        ("integrator", "bdpt".to_owned()),
        ("samples", outcome.samples.to_string()),
        ("seconds", format!("{:.1}", outcome.seconds)),
        ("rows", args.rows.to_string()),
    ]
    .map(|(name, value)| (name.to_owned(), value))
    .into();
    notes.extend(args.sampling.notes());
    notes
}

/// All strategies' pictures, weighted or not, one row a path length; and that of longer paths, if there is one.
fn sheet_of(
    (images, longer): (&[StrategyImages], &[Rgb]),
    size: [u32; 2],
    weighted: bool,
    args: &Arguments,
) -> Result<Canvas, CanvasError> {
    let (small_width, small_height) = cell_size(size);
    let develop = args.look.develop();
    let small =
        |pixels: &[Rgb]| Canvas::developed(pixels, size, develop)?.scaled_down(small_width, small_height);
    let cell = |i: &StrategyImages| -> Result<Cell, CanvasError> {
        let pixels = if weighted { &i.weighted } else { &i.unweighted };
        Ok(Cell::new(small(pixels)?, format!("s = {}, t = {}", i.s, i.t)))
    };
    let edges = |i: &StrategyImages| i.s + i.t - 1;
    let mut rows = Vec::new();
    for row in images.chunk_by(|a, b| edges(a) == edges(b)) {
        let label = match edges(&row[0]) {
            1 => "1 edge".to_owned(),
            n => format!("{n} edges"),
        };
        let cells = row.iter().map(|i| cell(i).map(Some)).collect::<Result<_, _>>()?;
        rows.push(Row { label, cells });
    }
    if weighted && !longer.is_empty() {
        let cell = Cell::new(small(longer)?, "all longer paths");
        rows.push(Row { label: "longer".to_owned(), cells: vec![Some(cell)] });
    }
    let what = if weighted { "weighted: these add up to the picture" } else { "without weights" };
    let legend = "s light and t camera vertices; t = 1 is the light image. Rows: edges of the path";
    let style = SheetStyle {
        title: Some(format!("{}, strategies {what}", args.source.name())),
        legend: vec![LegendLine { colour: None, text: legend.to_owned() }],
        centred: true,
        ..SheetStyle::default()
    };
    sheet(&rows, &style)
}

/// The size of a picture on the sheet.
fn cell_size([width, height]: [u32; 2]) -> (u32, u32) {
    let longest = width.max(height);
    if longest <= LARGEST_CELL {
        return (width, height);
    }
    let scaled = |side: u32| (u64::from(side) * u64::from(LARGEST_CELL) / u64::from(longest)).max(1) as u32;
    (scaled(width), scaled(height))
}

/// The whole as `combined`, what longer paths add as `rest`, and every strategy weighted as `s1t2` and unweighted as
/// `s1t2unweighted`.
fn save_layers(
    pyramid: &Pyramid<'_>,
    (images, rest): (&[StrategyImages], &[Rgb]),
    (path, notes): (&Path, &[(String, String)]),
) -> Result<(), Failure> {
    let whole = pixels(pyramid.whole());
    let names: Vec<String> = images.iter().map(|i| format!("s{}t{}", i.s, i.t)).collect();
    let unweighted: Vec<String> = names.iter().map(|n| format!("{n}unweighted")).collect();
    let mut layers: Vec<(&str, &[Rgb])> = vec![("combined", &whole), ("rest", rest)];
    for ((image, name), unweighted) in images.iter().zip(&names).zip(&unweighted) {
        layers.push((name, &image.weighted));
        layers.push((unweighted, &image.unweighted));
    }
    let mut metadata = Metadata::new();
    for (name, value) in notes {
        metadata.set(camel_case(name), value);
    }
    let layout = pyramid.whole().layout();
    write_layers(path, [layout.width, layout.height], layout.window, (&layers, &metadata))
        .map_err(|e| Failure::output(path, e))
}

/// "max depth" as the names of attributes are written: `maxDepth`.
fn camel_case(words: &str) -> String {
    let mut name = String::new();
    for word in words.split_whitespace() {
        let (first, rest) = word.split_at(1);
        let first = if name.is_empty() { first.to_owned() } else { first.to_uppercase() };
        name.push_str(&(first + rest));
    }
    name
}

fn summary(outcome: &Outcome) -> String {
    format!(
        "{} strategies, {} samples per pixel in {:.1} s\nwrote {}",
        outcome.strategies,
        outcome.samples,
        outcome.seconds,
        outcome.outputs.join(", ")
    )
}
