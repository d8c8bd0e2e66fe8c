//! `<sensor>`.
//!
//! Mitsuba's cameras look along +z with +x to the left, as ours do.

use caustica_math::elementary::{atan2, tan};
use caustica_math::{Transform, Vec3};
use caustica_scene::Diagnostic;
use caustica_scene::description::{Camera, CameraKind, FilmSettings};

use super::class::Class;
use super::context::Context;
use super::fields::Fields;
use super::film;
use super::transform::look;
use super::tree::error;
use crate::nori::range::Bounds;

const SENSORS: &[&str] =
    &["perspective", "thinlens", "orthographic", "radiancemeter", "irradiancemeter", "spherical"];

/// What looks almost like one of ours.
const SHOWN: &[(&str, &str)] = &[("perspective_rdist", "perspective"), ("telecentric", "orthographic")];

/// What measures other things than pictures are made of.
const UNSUPPORTED: &[&str] =
    &["distant", "hdistant", "batch", "fluencemeter", "mradiancemeter", "microphone"];

/// Whether there is a camera for the sensor.
pub(super) fn is_supported(plugin: &str) -> bool {
    !UNSUPPORTED.contains(&plugin)
}

/// Reads a sensor; `shape` is the one that it is attached to, by its place in the description.
pub(super) fn read(index: usize, shape: Option<u32>, cx: &mut Context) -> Result<(), Diagnostic> {
    let mut fields = Fields::new(cx.tree, index);
    let kind = plugin(&mut fields)?;
    let given = fields.child(Class::Film)?;
    cx.description.film = match given {
        Some(film) => film::read(film, cx)?,
        None => film::usual(),
    };
    if let Some(sampler) = fields.child(Class::Sampler)? {
        film::read_sampler(sampler, cx)?;
    }
    let film = &mut cx.description.film;
    let meters = matches!(kind, "radiancemeter" | "irradiancemeter");
    if meters {
        meter_film(&mut fields, film, given.is_some());
    }
    let aspect = film.width as f32 / film.height as f32;
    let kind = match (kind, shape) {
        ("orthographic", _) => CameraKind::Orthographic,
        ("spherical", _) => CameraKind::Environment,
        ("radiancemeter", _) => CameraKind::RadianceMeter,
        ("irradiancemeter", Some(shape)) => CameraKind::IrradianceMeter { shape },
        ("irradiancemeter", None) => {
            let error = fields.error("the sensor `irradiancemeter` must stand inside of a shape");
            return Err(error.hint("move it into the `<shape>` whose irradiance is wanted"));
        }
        (kind, _) => lens(&mut fields, kind == "thinlens", aspect)?,
    };
    let camera = Camera { kind, origin: Some(fields.object.origin.clone()), ..Camera::default() };
    let camera = if meters { meter(&mut fields, camera)? } else { picture(&mut fields, camera)? };
    cx.description.camera = Camera { hides_lamps: cx.hides_lamps, ..camera };
    fields.ignore(&["shutter_open", "shutter_close"]);
    fields.unsupported(&["srf"]);
    fields.finish(cx);
    Ok(())
}

/// The plugin whose camera is used.
fn plugin<'t>(fields: &mut Fields<'t>) -> Result<&'t str, Diagnostic> {
    let plugin = fields.plugin();
    if UNSUPPORTED.contains(&plugin) {
        let message = format!("the {} is not supported", fields.title());
        let hint = format!("use one of {}", SENSORS[..5].join(", "));
        return Err(error(message, &fields.object.plugin_origin).hint(hint));
    }
    if let Some((_, shown)) = SHOWN.iter().find(|(name, _)| *name == plugin) {
        fields.warn(format!("the {} is not supported; `{shown}` is used instead", fields.title()));
        fields.unsupported(&["kc"]);
        if *shown == "orthographic" {
            fields.unsupported(&["aperture_radius", "focus_distance"]);
        }
        return Ok(shown);
    }
    if SENSORS.contains(&plugin) { Ok(plugin) } else { Err(fields.unknown_plugin(SENSORS)) }
}

/// A meter shows one number; a radiance meter's film must have one pixel, in Mitsuba.
fn meter_film(fields: &mut Fields<'_>, film: &mut FilmSettings, given: bool) {
    let many = u64::from(film.width) * u64::from(film.height);
    let most = if fields.plugin() == "radiancemeter" { 1 } else { 4096 };
    if !given || many > most {
        if given {
            fields.warn(format!("the {} shows one number: its film has one pixel here", fields.title()));
        }
        (film.width, film.height, film.crop) = (1, 1, None);
    }
    if !given {
        film.filter = film::PIXEL;
    }
}

/// Place, clip planes and principal point of a camera that shows pictures.
fn picture(fields: &mut Fields<'_>, camera: Camera) -> Result<Camera, Diagnostic> {
    let near = fields.float("near_clip", 1e-2, Bounds::NotNegative)?;
    let far = fields.float("far_clip", 1e4, Bounds::PositiveOrInfinite)?;
    if near >= far {
        return Err(fields.error(format!("`near_clip` ({near}) must be less than `far_clip` ({far})")));
    }
    let to_world = fields.transform("to_world")?;
    let mut principal_point = [0.5; 2];
    if let CameraKind::Perspective { .. } | CameraKind::ThinLens { .. } = camera.kind {
        let names = ["principal_point_offset_x", "principal_point_offset_y"];
        for (place, name) in principal_point.iter_mut().zip(names) {
            // The film is moved, so that what is ahead is seen on the other side.
            *place -= fields.float(name, 0.0, Bounds::Finite)?;
        }
    }
    Ok(Camera { to_world, near, far, principal_point, ..camera })
}

/// Place of a meter, which has no clip planes. One in a shape stands where the shape does.
fn meter(fields: &mut Fields<'_>, camera: Camera) -> Result<Camera, Diagnostic> {
    let mut to_world = Transform::IDENTITY;
    if camera.kind == CameraKind::RadianceMeter {
        let placed = fields.transform_if_any("to_world")?;
        let ray = (fields.point("origin")?, fields.direction("direction")?);
        to_world = match (placed, ray) {
            (Some(placed), _) => placed,
            (None, (None, None)) => Transform::IDENTITY,
            (None, (Some(origin), Some(direction))) => along(origin, direction)
                .ok_or_else(|| fields.error("`origin` and `direction` are too large to be a ray"))?,
            (None, (Some(_), None)) => return Err(fields.missing("direction", "the vector")),
            (None, (None, Some(_))) => return Err(fields.missing("origin", "the point")),
        };
    } else if fields.transform_if_any("to_world")?.is_some() {
        return Err(
            fields.error("the sensor `irradiancemeter` has the place of its shape, and no `to_world`")
        );
    }
    fields.ignore(&["near_clip", "far_clip"]);
    Ok(Camera { to_world, near: 0.0, far: f32::INFINITY, ..camera })
}

/// A frame at `origin` that looks in `direction`.
fn along(origin: [f32; 3], direction: [f32; 3]) -> Option<Transform> {
    let forward = Vec3::from(direction).try_normalized()?.to_array().map(f64::from);
    let origin = origin.map(f64::from);
    // Far enough for the target to differ from the origin.
    let distance = origin.iter().fold(1.0_f64, |most, c| most.max(c.abs()));
    let placed = look(origin, [0, 1, 2].map(|i| origin[i] + distance * forward[i]), None);
    placed.is_invertible().then_some(placed)
}

fn lens(fields: &mut Fields<'_>, thin: bool, aspect: f32) -> Result<CameraKind, Diagnostic> {
    let fov = field_of_view(fields, aspect)?;
    if !thin {
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
