//! `<film>`, `<rfilter>` and `<sampler>`.

use caustica_scene::Diagnostic;
use caustica_scene::description::{Crop, FilmSettings, Filter};

use super::class::Class;
use super::context::Context;
use super::fields::Fields;
use crate::nori::camera::{self, LONGEST_SIDE};
use crate::nori::range::Bounds;

const FILMS: &[&str] = &["hdrfilm", "ldrfilm", "specfilm", "tiledhdrfilm", "mfilm"];
const FILTERS: &[&str] = &["box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"];
const SAMPLERS: &[&str] =
    &["independent", "stratified", "multijitter", "orthogonal", "ldsampler", "halton", "hammersley", "sobol"];

/// The widest filter: every sample is added to all pixels that it covers.
const WIDEST_FILTER: f64 = 32.0;

/// The pixel itself.
pub(super) const PIXEL: Filter = Filter::Box { radius: 0.5 };

/// What a sensor without a film has.
pub(super) fn usual() -> FilmSettings {
    FilmSettings {
        width: 768,
        height: 576,
        crop: None,
        filter: Filter::Gaussian { radius: 2.0, stddev: 0.5 },
    }
}

pub(super) fn read(index: usize, cx: &mut Context) -> Result<FilmSettings, Diagnostic> {
    let mut fields = Fields::new(cx.tree, index);
    if !FILMS.contains(&fields.plugin()) {
        return Err(fields.unknown_plugin(FILMS));
    }
    let mut film = usual();
    let side = |fields: &mut Fields, name, default: u32| {
        Ok(fields.integer(name, 1..=LONGEST_SIDE)?.map_or(default, |v| v as u32))
    };
    film.width = side(&mut fields, "width", film.width)?;
    film.height = side(&mut fields, "height", film.height)?;
    film.crop = crop(&mut fields, &film)?;
    if let Some(filter) = fields.child(Class::Filter)? {
        film.filter = read_filter(filter, cx)?;
    }
    camera::check_film(&film).map_err(|message| fields.error(message))?;
    // How files are written is said by the command line.
    fields.ignore(&[
        "file_format",
        "pixel_format",
        "component_format",
        "banner",
        "high_quality_edges",
        "sample_border",
        "compensate",
        "attach_log",
        "channel_names",
        "variable",
        "digits",
        "tonemap_method",
    ]);
    fields.unsupported(&["gamma", "exposure", "key", "burn"]);
    for (band, _) in fields.children(Class::Spectrum) {
        fields.warn_at("the film's bands are not supported; it shows red, green and blue", &band.origin);
    }
    fields.finish(cx);
    Ok(film)
}

fn crop(fields: &mut Fields, film: &FilmSettings) -> Result<Option<Crop>, Diagnostic> {
    let x = fields.integer("crop_offset_x", 0..=LONGEST_SIDE)?;
    let y = fields.integer("crop_offset_y", 0..=LONGEST_SIDE)?;
    let width = fields.integer("crop_width", 1..=LONGEST_SIDE)?;
    let height = fields.integer("crop_height", 1..=LONGEST_SIDE)?;
    Ok(camera::crop(film, [x, y, width, height]))
}

/// Mitchell and Netravali look at 0 to 1; far outside, the lobes drown the picture in noise.
const LOBES: Bounds = Bounds::Between(-100.0, 100.0);

fn read_filter(index: usize, cx: &mut Context) -> Result<Filter, Diagnostic> {
    let mut fields = Fields::new(cx.tree, index);
    let radius =
        |fields: &mut Fields, default| fields.float("radius", default, Bounds::UpTo(0.0, WIDEST_FILTER));
    let filter = match fields.plugin() {
        "box" => Filter::Box { radius: radius(&mut fields, 0.5)? },
        "tent" => Filter::Tent { radius: radius(&mut fields, 1.0)? },
        "gaussian" => {
            let stddev = fields.float("stddev", 0.5, Bounds::UpTo(0.0, 0.25 * WIDEST_FILTER))?;
            Filter::Gaussian { radius: 4.0 * stddev, stddev }
        }
        "mitchell" => {
            // Old versions write all names in lower case.
            let mut parameter = |names: [&'static str; 2]| {
                let given = fields.float_if_any(names[0], LOBES)?;
                Ok::<f32, Diagnostic>(given.or(fields.float_if_any(names[1], LOBES)?).unwrap_or(1.0 / 3.0))
            };
            Filter::Mitchell { radius: 2.0, b: parameter(["B", "b"])?, c: parameter(["C", "c"])? }
        }
        "catmullrom" => Filter::Mitchell { radius: 2.0, b: 0.0, c: 0.5 },
        "lanczos" => {
            let lobes = fields.integer("lobes", 1..=WIDEST_FILTER as i64)?.unwrap_or(3);
            Filter::Lanczos { lobes: lobes as u32 }
        }
        _ => return Err(fields.unknown_plugin(FILTERS)),
    };
    fields.finish(cx);
    Ok(filter)
}

/// All samplers give the same picture, with more or less noise; ours has one of its own.
pub(super) fn read_sampler(index: usize, cx: &mut Context) -> Result<(), Diagnostic> {
    let mut fields = Fields::new(cx.tree, index);
    if !SAMPLERS.contains(&fields.plugin()) {
        return Err(fields.unknown_plugin(SAMPLERS));
    }
    if let Some(samples) = fields.integer("sample_count", 1..=i64::from(u32::MAX))? {
        cx.description.samples = samples as u32;
    }
    fields.ignore(&["seed", "jitter", "strength", "scramble", "dimension"]);
    fields.finish(cx);
    Ok(())
}
