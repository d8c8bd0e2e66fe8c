//! `<emitter>`.
//!
//! Mitsuba finds a direction d of its environment's frame at u = atan2(d.x, −d.z)/2π, v = acos(d.y)/π from the upper
//! left corner. As atan2(x, −z) = π − atan2(x, z), that is u = ½ − atan2(x, z)/2π: ours. Its spot lights, directional
//! lights and projectors shine along +z of their own frames.

use std::f32::consts::PI;

use caustica_math::{Rgb, Vec3};
use caustica_scene::Diagnostic;
use caustica_scene::description::{EnvironmentRows, Light, LightKind, Texture};

use super::context::Context;
use super::fields::Fields;
use super::spectrum::Role;
use super::{sensor, sunsky, texture};
use crate::nori::range::Bounds;

const LIGHTS: &[&str] =
    &["point", "spot", "projector", "directional", "constant", "envmap", "sunsky", "area", "directionalarea"];
const UNSUPPORTED: &[&str] = &["sky", "sun", "timed_sunsky", "volumelight", "collimated"];

/// The emitter of the shape that is to be added next: its radiance; or nothing, if it is a lamp of its own or its kind is
/// not supported.
pub(super) fn read_area(index: usize, cx: &mut Context) -> Result<Option<Texture>, Diagnostic> {
    let mut fields = Fields::new(cx.tree, index);
    let plugin = fields.plugin();
    match plugin {
        "area" | "directionalarea" => {}
        known if UNSUPPORTED.contains(&known) => {
            leave_out(fields, cx);
            return Ok(None);
        }
        known if LIGHTS.contains(&known) => {
            let message = format!("the {} cannot stand inside of a shape", fields.title());
            return Err(fields
                .error(message)
                .hint("only an `area` or `directionalarea` emitter can; put this one into the scene"));
        }
        _ => return Err(fields.unknown_plugin(&["area", "directionalarea"])),
    }
    let radiance = texture::slot(&mut fields, "radiance", Role::Light, cx)?.unwrap_or(Rgb::WHITE.into());
    fields.ignore(&["sampling_weight"]);
    let origin = Some(fields.object.origin.clone());
    fields.finish(cx);
    if plugin == "area" {
        return Ok(Some(radiance));
    }
    // The shape comes next.
    let kind = LightKind::Collimated { shape: cx.description.shapes.len() as u32, exitance: radiance };
    cx.description.lights.push(Light { kind, origin });
    Ok(None)
}

/// An emitter that is not a surface.
pub(super) fn read_light(index: usize, cx: &mut Context) -> Result<(), Diagnostic> {
    let mut fields = Fields::new(cx.tree, index);
    fields.ignore(&["sampling_weight"]);
    let kind = match fields.plugin() {
        "point" => {
            let position = position(&mut fields)?;
            LightKind::Point { position, intensity: light(&mut fields, "intensity", cx)? }
        }
        "spot" => spot(&mut fields, cx)?,
        "projector" => projector(&mut fields, cx)?,
        "directional" => {
            let direction = direction(&mut fields)?;
            LightKind::Directional { direction, irradiance: light(&mut fields, "irradiance", cx)? }
        }
        "constant" => LightKind::Constant { radiance: light(&mut fields, "radiance", cx)? },
        "envmap" => {
            let (file, property) = fields.file_name()?;
            let image = cx.image(file, &property.value_origin)?;
            let to_world = fields.transform("to_world")?;
            let scale = fields.float("scale", 1.0, Bounds::NotNegative)?;
            fields.ignore(&["mis_compensation", "cache"]);
            LightKind::Environment { image, to_world, scale, rows: EnvironmentRows::OnPoles }
        }
        "sunsky" => return sunsky::read(fields, cx),
        plugin @ ("area" | "directionalarea") => {
            let error = fields.error(format!("the emitter `{plugin}` cannot stand alone"));
            return Err(error.hint("put it into the shape that is to emit light"));
        }
        known if UNSUPPORTED.contains(&known) => {
            leave_out(fields, cx);
            return Ok(());
        }
        _ => return Err(fields.unknown_plugin(LIGHTS)),
    };
    let origin = Some(fields.object.origin.clone());
    fields.finish(cx);
    cx.description.lights.push(Light { kind, origin });
    Ok(())
}

fn leave_out(mut fields: Fields, cx: &mut Context) {
    fields.warn(format!("the {} is not supported yet; it is left out", fields.title()));
    fields.finish_unread(cx);
}

fn light(fields: &mut Fields, name: &'static str, cx: &mut Context) -> Result<Rgb, Diagnostic> {
    Ok(texture::constant(fields, name, Role::Light, cx)?.unwrap_or(Rgb::WHITE))
}

fn position(fields: &mut Fields) -> Result<[f32; 3], Diagnostic> {
    match (fields.point("position")?, fields.transform_if_any("to_world")?) {
        (Some(_), Some(_)) => Err(fields.error("give `position` or `to_world`, not both")),
        (Some(position), None) => Ok(position),
        (None, Some(to_world)) => Ok(to_array(to_world.point(Vec3::ZERO))),
        (None, None) => Ok([0.0; 3]),
    }
}

fn direction(fields: &mut Fields) -> Result<[f32; 3], Diagnostic> {
    match (fields.direction("direction")?, fields.transform_if_any("to_world")?) {
        (Some(_), Some(_)) => Err(fields.error("give `direction` or `to_world`, not both")),
        (Some(direction), None) => Ok(direction),
        (None, Some(to_world)) => Ok(to_array(to_world.vector(Vec3::Z))),
        (None, None) => Ok([0.0, 0.0, 1.0]),
    }
}

fn to_array(v: Vec3) -> [f32; 3] {
    [v.x, v.y, v.z]
}

fn spot(fields: &mut Fields, cx: &mut Context) -> Result<LightKind, Diagnostic> {
    let to_world = fields.transform("to_world")?;
    let outer_angle = fields.float("cutoff_angle", 20.0, Bounds::UpTo(0.0, 180.0))?;
    let inner_angle = fields.float("beam_width", 0.75 * outer_angle, Bounds::UpTo(0.0, 180.0))?;
    if inner_angle > outer_angle {
        let message = format!("`beam_width` ({inner_angle}°) is more than `cutoff_angle` ({outer_angle}°)");
        return Err(fields.error(message));
    }
    let picture = texture::slot(fields, "texture", Role::Reflectance, cx)?;
    if picture.is_some() && outer_angle >= 90.0 {
        let message = format!("`texture` needs a `cutoff_angle` below 90°, and it is {outer_angle}°");
        return Err(fields.error(message).hint("a flat picture cannot cover half of all directions"));
    }
    let intensity = light(fields, "intensity", cx)?;
    Ok(LightKind::LinearSpot { to_world, intensity, picture, inner_angle, outer_angle })
}

/// Its picture lies as one that a camera in its place would take.
fn projector(fields: &mut Fields, cx: &mut Context) -> Result<LightKind, Diagnostic> {
    let to_world = fields.transform("to_world")?;
    let irradiance = texture::slot(fields, "irradiance", Role::Light, cx)?.unwrap_or(Rgb::WHITE.into());
    // At distance one there is π times the picture's irradiance.
    let scale = PI * fields.float("scale", 1.0, Bounds::NotNegative)?;
    let aspect = match irradiance {
        Texture::Image { image, .. } => {
            let image = &cx.description.images[image.0 as usize];
            image.width as f32 / image.height as f32
        }
        _ => 1.0,
    };
    let fov = sensor::field_of_view(fields, aspect)?;
    Ok(LightKind::Projector { to_world, irradiance, scale, fov, aspect })
}
