//! `<sensor>`, `<film>`, `<rfilter>` and `<sampler>`.
//!
//! Mitsuba's cameras look along +z with +x to the left, as ours do.

use caustica_math::elementary::{atan2, tan};
use caustica_scene::Diagnostic;
use caustica_scene::description::{Camera, CameraKind, Crop, FilmSettings, Filter};

use super::class::Class;
use super::context::Context;
use super::fields::Fields;
use super::tree::error;
use crate::nori::camera::{self, LONGEST_SIDE};
use crate::nori::range::Bounds;

const SENSORS: &[&str] = &["perspective", "thinlens", "orthographic"];
const FILMS: &[&str] = &["hdrfilm", "ldrfilm", "specfilm", "tiledhdrfilm", "mfilm"];
const FILTERS: &[&str] = &["box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"];
const SAMPLERS: &[&str] =
    &["independent", "stratified", "multijitter", "orthogonal", "ldsampler", "halton", "hammersley", "sobol"];

/// The widest filter: every sample is added to all pixels that it covers.
const WIDEST_FILTER: f64 = 32.0;

pub(super) fn read(index: usize, cx: &mut Context) -> Result<(), Diagnostic> {
    let mut fields = Fields::new(cx.tree, index);
    if !SENSORS.contains(&fields.plugin()) {
        return Err(fields.unknown_plugin(SENSORS));
    }
    match fields.child(Class::Film)? {
        Some(film) => cx.description.film = read_film(film, cx)?,
        None => cx.description.film = usual_film(),
    }
    if let Some(sampler) = fields.child(Class::Sampler)? {
        read_sampler(sampler, cx)?;
    }
    let film = &cx.description.film;
    let kind = kind(&mut fields, film.width as f32 / film.height as f32)?;
    let near = fields.float("near_clip", 1e-2, Bounds::NotNegative)?;
    let far = fields.float("far_clip", 1e4, Bounds::PositiveOrInfinite)?;
    if near >= far {
        return Err(fields.error(format!("`near_clip` ({near}) must be less than `far_clip` ({far})")));
    }
    let to_world = fields.transform("to_world")?;
    let origin = Some(fields.object.origin.clone());
    cx.description.camera = Camera { kind, to_world, near, far, origin };
    for name in ["principal_point_offset_x", "principal_point_offset_y"] {
        if fields.float(name, 0.0, Bounds::Finite)? != 0.0 {
            fields.warn(format!("`{name}` is not supported yet; the principal point is the centre"));
        }
    }
    fields.ignore(&["shutter_open", "shutter_close"]);
    fields.unsupported(&["srf"]);
    fields.finish(cx);
    Ok(())
}

fn kind(fields: &mut Fields, aspect: f32) -> Result<CameraKind, Diagnostic> {
    if fields.plugin() == "orthographic" {
        return Ok(CameraKind::Orthographic);
    }
    let fov = field_of_view(fields, aspect)?;
    if fields.plugin() == "perspective" {
        fields.ignore(&["focus_distance"]);
        return Ok(CameraKind::Perspective { fov });
    }
    let radius = fields.float_if_any("aperture_radius", Bounds::NotNegative)?;
    let focus = fields.float_if_any("focus_distance", Bounds::Positive)?;
    let aperture_radius = radius.ok_or_else(|| fields.missing("aperture_radius", "the float"))?;
    match focus {
        // Without an opening, a lens is a pinhole.
        _ if aperture_radius == 0.0 => Ok(CameraKind::Perspective { fov }),
        Some(focus_distance) => Ok(CameraKind::ThinLens { fov, aperture_radius, focus_distance }),
        None => Err(fields.missing("focus_distance", "the float")),
    }
}

/// The horizontal field of view in degrees. A focal length is that of a film of 36 mm × 24 mm and tells the angle of
/// the diagonal.
pub(super) fn field_of_view(fields: &mut Fields, aspect: f32) -> Result<f32, Diagnostic> {
    let given = fields.float_if_any("fov", Bounds::Between(0.0, 180.0))?;
    let axes = &["x", "y", "diagonal", "smaller", "larger"];
    let axis = fields.choice("fov_axis", axes)?.map_or("x", |(axis, _)| axis);
    let focal = fields.string("focal_length")?;
    let half_tangent = |degrees: f32| tan(0.5 * degrees.to_radians());
    let (half, axis) = match (given, focal) {
        (Some(_), Some(_)) => return Err(fields.error("give `fov` or `focal_length`, not both")),
        (Some(fov), None) => (half_tangent(fov), axis),
        (None, focal) => {
            let (text, origin) = focal.map_or(("50mm", &fields.object.origin), |(t, p)| (t, &p.value_origin));
            let length = text.trim().trim_end_matches("mm").trim_end().parse::<f32>().unwrap_or(f32::NAN);
            if !(length > 0.0 && length.is_finite()) {
                return Err(error("`focal_length` must be a length such as 50mm", origin));
            }
            (0.5 * (36.0_f32 * 36.0 + 24.0 * 24.0).sqrt() / length, "diagonal")
        }
    };
    let across = match axis {
        "y" => half * aspect,
        "smaller" if aspect > 1.0 => half * aspect,
        "larger" if aspect < 1.0 => half * aspect,
        "diagonal" => half / (1.0 + 1.0 / (aspect * aspect)).sqrt(),
        // Across already: angles that are given so keep their bits.
        _ => return Ok(given.unwrap_or_else(|| 2.0 * atan2(half, 1.0).to_degrees())),
    };
    Ok(2.0 * atan2(across, 1.0).to_degrees())
}

fn usual_film() -> FilmSettings {
    FilmSettings {
        width: 768,
        height: 576,
        crop: None,
        filter: Filter::Gaussian { radius: 2.0, stddev: 0.5 },
    }
}

fn read_film(index: usize, cx: &mut Context) -> Result<FilmSettings, Diagnostic> {
    let mut fields = Fields::new(cx.tree, index);
    if !FILMS.contains(&fields.plugin()) {
        return Err(fields.unknown_plugin(FILMS));
    }
    let mut film = usual_film();
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
            let parameter = |fields: &mut Fields, names: [&'static str; 2]| {
                let upper = fields.float_if_any(names[0], Bounds::Finite)?;
                let lower = fields.float_if_any(names[1], Bounds::Finite)?;
                Ok::<f32, Diagnostic>(upper.or(lower).unwrap_or(1.0 / 3.0))
            };
            let (b, c) = (parameter(&mut fields, ["A", "a"])?, parameter(&mut fields, ["B", "b"])?);
            Filter::Mitchell { radius: radius(&mut fields, 2.0)?, b, c }
        }
        "catmullrom" => Filter::Mitchell { radius: 2.0, b: 0.0, c: 0.5 },
        "lanczos" => {
            fields.ignore(&["lobes"]);
            fields.warn("the filter `lanczos` is not supported yet; `catmullrom` is used instead");
            Filter::Mitchell { radius: 2.0, b: 0.0, c: 0.5 }
        }
        _ => return Err(fields.unknown_plugin(FILTERS)),
    };
    fields.finish(cx);
    Ok(filter)
}

/// All of them give the same picture, with more or less noise; ours has a sampler of its own.
fn read_sampler(index: usize, cx: &mut Context) -> Result<(), Diagnostic> {
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
