//! `<emitter>`.
//!
//! Mitsuba finds a direction d of its environment's frame at u = atan2(d.x, −d.z)/2π, v = acos(d.y)/π from the upper
//! left corner. As atan2(x, −z) = π − atan2(x, z), that is u = ½ − atan2(x, z)/2π: ours. Its spot lights and directional
//! lights shine along +z of their own frames.

use caustica_math::{Rgb, Vec3};
use caustica_scene::Diagnostic;
use caustica_scene::description::{Light, LightKind, Texture};

use super::context::Context;
use super::fields::Fields;
use super::spectrum::Role;
use super::texture;
use crate::nori::range::Bounds;

const LIGHTS: &[&str] = &["point", "spot", "directional", "constant", "envmap", "area"];
const UNSUPPORTED: &[&str] =
    &["projector", "directionalarea", "sunsky", "sky", "sun", "timed_sunsky", "volumelight", "collimated"];

/// The emitter of a shape: its radiance; or nothing, if its kind is not supported.
pub(super) fn read_area(index: usize, cx: &mut Context) -> Result<Option<Texture>, Diagnostic> {
    let mut fields = Fields::new(cx.tree, index);
    match fields.plugin() {
        "area" => {}
        known if UNSUPPORTED.contains(&known) => {
            leave_out(fields, cx);
            return Ok(None);
        }
        known if LIGHTS.contains(&known) => {
            let message = format!("the {} cannot stand inside of a shape", fields.title());
            return Err(fields
                .error(message)
                .hint("only an `area` emitter can; put this one into the scene"));
        }
        _ => return Err(fields.unknown_plugin(&["area"])),
    }
    let radiance = texture::slot(&mut fields, "radiance", Role::Light, cx)?;
    fields.ignore(&["sampling_weight"]);
    fields.finish(cx);
    Ok(Some(radiance.unwrap_or(Rgb::WHITE.into())))
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
            LightKind::Environment { image, to_world, scale }
        }
        "area" => {
            let error = fields.error("the emitter `area` cannot stand alone");
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
    if inner_angle < outer_angle {
        fields.warn("the border of the cone falls off by a smooth curve, and in Mitsuba linearly");
    }
    fields.unsupported(&["texture"]);
    Ok(LightKind::Spot {
        position: to_array(to_world.point(Vec3::ZERO)),
        direction: to_array(to_world.vector(Vec3::Z)),
        intensity: light(fields, "intensity", cx)?,
        inner_angle,
        outer_angle,
    })
}
