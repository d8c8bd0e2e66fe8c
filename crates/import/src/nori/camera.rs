//! `<camera>`, `<film>` and `<rfilter>`.

use caustica_scene::Diagnostic;
use caustica_scene::description::{Camera, CameraKind, Crop, FilmSettings, Filter};

use super::class::Class;
use super::context::Context;
use super::fields::Fields;
use super::range::Bounds;
use super::tree::Object;

/// The most pixels on a side of the picture, and in all of it.
pub(crate) const LONGEST_SIDE: i64 = 1 << 16;
const MOST_PIXELS: u64 = 1 << 28;

const CAMERAS: &[&str] =
    &["perspective", "thinlens", "orthographic", "environment", "spherical", "panoramic", "360"];
const FILTERS: &[&str] = &["gaussian", "mitchell", "tent", "box"];

/// The widest filter: every sample is added to all pixels that it covers.
const WIDEST_FILTER: f64 = 32.0;

pub(super) fn read(object: &Object, cx: &mut Context) -> Result<(), Diagnostic> {
    let mut fields = Fields::new(object, cx.place);
    let kind = kind(&mut fields, object)?;
    let near = fields.float(&["nearClip", "near"], 1e-4, Bounds::NotNegative)?;
    let far = fields.float(&["farClip", "far"], 1e4, Bounds::PositiveOrInfinite)?;
    if near >= far {
        return Err(fields.error(format!("`nearClip` ({near}) must be less than `farClip` ({far})")));
    }
    let to_world = fields.transform(&["toWorld"])?;
    cx.description.camera =
        Camera { kind, to_world, near, far, origin: cx.origin(&object.range), ..Camera::default() };
    let mut film = FilmSettings::default();
    film_properties(&mut fields, &mut film, cx)?;
    if let Some(object) = fields.child(Class::Film)? {
        let mut fields = Fields::new(object, cx.place);
        film_properties(&mut fields, &mut film, cx)?;
        fields.finish(cx)?;
    }
    check_film(&film).map_err(|message| fields.error(message))?;
    cx.description.film = film;
    fields.finish(cx)
}

fn kind(fields: &mut Fields, object: &Object) -> Result<CameraKind, Diagnostic> {
    let fov = |fields: &mut Fields| fields.float(&["fov"], 30.0, Bounds::Between(0.0, 180.0));
    Ok(match object.plugin.as_str() {
        "perspective" => CameraKind::Perspective { fov: fov(fields)? },
        "thinlens" => {
            let fov = fov(fields)?;
            let radius = ["apertureRadius", "lensRadius", "aperture"];
            let aperture_radius = fields.float(&radius, 0.0, Bounds::NotNegative)?;
            let distance = ["focusDistance", "focalDistance"];
            let focus_distance = fields.float_if_any(&distance, Bounds::Positive)?;
            match focus_distance {
                // Without an opening, a lens is a pinhole.
                _ if aperture_radius == 0.0 => CameraKind::Perspective { fov },
                Some(focus_distance) => CameraKind::ThinLens { fov, aperture_radius, focus_distance },
                None => return Err(fields.missing("focusDistance", "the float")),
            }
        }
        "orthographic" => CameraKind::Orthographic,
        "environment" | "spherical" | "panoramic" | "360" => CameraKind::Environment,
        _ => return Err(fields.unknown_plugin(CAMERAS)),
    })
}

fn film_properties(fields: &mut Fields, film: &mut FilmSettings, cx: &mut Context) -> Result<(), Diagnostic> {
    let side = |fields: &mut Fields, names, default: u32| {
        Ok(fields.integer(names, 1..=LONGEST_SIDE)?.map_or(default, |v| v as u32))
    };
    film.width = side(fields, &["width"], film.width)?;
    film.height = side(fields, &["height"], film.height)?;
    let x = fields.integer(&["cropOffsetX"], 0..=LONGEST_SIDE)?;
    let y = fields.integer(&["cropOffsetY"], 0..=LONGEST_SIDE)?;
    let width = fields.integer(&["cropWidth"], 1..=LONGEST_SIDE)?;
    let height = fields.integer(&["cropHeight"], 1..=LONGEST_SIDE)?;
    if let Some(window) = crop(film, [x, y, width, height]) {
        film.crop = Some(window);
    }
    if let Some(object) = fields.child(Class::Filter)? {
        film.filter = filter(object, cx)?;
    }
    Ok(())
}

/// The crop window of these offsets and sizes, if any is given: those that are not reach to the borders.
pub(crate) fn crop(film: &FilmSettings, [x, y, width, height]: [Option<i64>; 4]) -> Option<Crop> {
    x.or(y).or(width).or(height)?;
    let (x, y) = (x.unwrap_or(0) as u32, y.unwrap_or(0) as u32);
    let width = width.map_or(film.width.saturating_sub(x), |w| w as u32);
    let height = height.map_or(film.height.saturating_sub(y), |h| h as u32);
    Some(Crop { x, y, width, height })
}

/// Whether a film's size and its crop window can be.
pub(crate) fn check_film(film: &FilmSettings) -> Result<(), String> {
    let (width, height) = (film.width, film.height);
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        return Err(format!("{width} × {height} pixels are more than the {MOST_PIXELS} that are possible"));
    }
    let crop = film.window();
    if crop.width == 0 || crop.height == 0 || crop.x + crop.width > width || crop.y + crop.height > height {
        return Err(format!("the crop window leaves the picture of {width} × {height} pixels"));
    }
    Ok(())
}

/// Mitchell and Netravali look at 0 to 1; far outside, the lobes drown the picture in noise.
const LOBES: Bounds = Bounds::Between(-100.0, 100.0);

fn filter(object: &Object, cx: &mut Context) -> Result<Filter, Diagnostic> {
    let mut fields = Fields::new(object, cx.place);
    let radius =
        |fields: &mut Fields, default| fields.float(&["radius"], default, Bounds::UpTo(0.0, WIDEST_FILTER));
    let filter = match object.plugin.as_str() {
        "gaussian" => Filter::Gaussian {
            radius: radius(&mut fields, 2.0)?,
            stddev: fields.float(&["stddev"], 0.5, Bounds::Positive)?,
        },
        "mitchell" => Filter::Mitchell {
            radius: radius(&mut fields, 2.0)?,
            b: fields.float(&["B"], 1.0 / 3.0, LOBES)?,
            c: fields.float(&["C"], 1.0 / 3.0, LOBES)?,
        },
        "tent" => Filter::Tent { radius: radius(&mut fields, 1.0)? },
        "box" => Filter::Box { radius: radius(&mut fields, 0.5)? },
        _ => return Err(fields.unknown_plugin(FILTERS)),
    };
    fields.finish(cx)?;
    Ok(filter)
}
