//! `<emitter>`.

use caustica_math::{Rgb, elementary};
use caustica_scene::Diagnostic;
use caustica_scene::description::{Light, LightKind, Texture};

use super::context::Context;
use super::fields::Fields;
use super::range::{Bounds, Radiometry};
use super::texture;
use super::tree::Object;

const LIGHTS: &[&str] = &[
    "point",
    "pointlight",
    "spot",
    "spotlight",
    "directional",
    "distant",
    "envmap",
    "environment",
    "constant",
    "area",
];

/// The emitter of a mesh: its radiance.
pub(super) fn read_area(object: &Object, cx: &mut Context) -> Result<Texture, Diagnostic> {
    let mut fields = Fields::new(object, cx.place);
    match object.plugin.as_str() {
        "area" => {}
        known if LIGHTS.contains(&known) => {
            let message = format!("the {} cannot stand inside of a mesh", fields.title());
            return Err(fields
                .error(message)
                .hint("only an `area` emitter can; put this one into the scene"));
        }
        _ => return Err(fields.unknown_plugin(&["area"])),
    }
    let radiance = texture::slot(&mut fields, &["radiance"], Radiometry::Light, cx)?
        .ok_or_else(|| fields.missing("radiance", "the color"))?;
    fields.finish(cx)?;
    Ok(radiance)
}

/// An emitter that is not a surface.
pub(super) fn read_light(object: &Object, cx: &mut Context) -> Result<(), Diagnostic> {
    let mut fields = Fields::new(object, cx.place);
    let kind = match object.plugin.as_str() {
        "point" | "pointlight" | "pointLight" => {
            let position = fields.point(&["position"])?.unwrap_or_default();
            let intensity = intensity(&mut fields, 4.0 * std::f32::consts::PI)?;
            LightKind::Point { position, intensity }
        }
        "spot" | "spotlight" | "spotLight" => spot(&mut fields)?,
        "directional" | "distant" => {
            let direction = fields.direction(&["direction"])?;
            let direction = direction.ok_or_else(|| fields.missing("direction", "the vector"))?;
            let names = &["radiance", "irradiance"];
            let irradiance = fields.color_or_float(names, Radiometry::Light)?;
            let irradiance = irradiance.ok_or_else(|| fields.missing("radiance", "the color"))?;
            LightKind::Directional { direction, irradiance }
        }
        "constant" => {
            let radiance = fields.color_or_float(&["radiance"], Radiometry::Light)?;
            let radiance = radiance.ok_or_else(|| fields.missing("radiance", "the color"))?;
            LightKind::Constant { radiance }
        }
        "envmap" | "environment" => {
            let (file, property) = fields.file_name()?;
            let image = cx.image(file, &property.value_range)?;
            let to_world = fields.transform(&["toWorld"])?;
            let scale = fields.float(&["scale", "strength"], 1.0, Bounds::NotNegative)?;
            LightKind::Environment { image, to_world, scale, rows: Default::default() }
        }
        "area" => {
            let error = fields.error("the emitter `area` cannot stand alone");
            return Err(error.hint("put it into the mesh that is to emit light"));
        }
        _ => return Err(fields.unknown_plugin(LIGHTS)),
    };
    fields.finish(cx)?;
    let origin = cx.origin(&object.range);
    cx.description.lights.push(Light { kind, origin });
    Ok(())
}

/// The intensity, given as such or as the power that it adds up to over `solid_angle`.
fn intensity(fields: &mut Fields, solid_angle: f32) -> Result<Rgb, Diagnostic> {
    let power = fields.color_or_float(&["power"], Radiometry::Light)?;
    let intensity = fields.color_or_float(&["intensity"], Radiometry::Light)?;
    match (power, intensity) {
        (Some(power), None) => Ok(power * (1.0 / solid_angle)),
        (None, Some(intensity)) => Ok(intensity),
        (None, None) => Err(fields.missing("power", "the color")),
        (Some(_), Some(_)) => Err(fields.error("give `power` or `intensity`, not both")),
    }
}

/// Forks disagree on the names and on whether an angle is given by its cosine.
fn spot(fields: &mut Fields) -> Result<LightKind, Diagnostic> {
    let position = fields.point(&["position"])?.unwrap_or_default();
    let direction = match (fields.direction(&["direction"])?, fields.point(&["target"])?) {
        (Some(direction), None) => direction,
        (None, Some(target)) => {
            let direction = [0, 1, 2].map(|i| target[i] - position[i]);
            if direction == [0.0; 3] {
                return Err(fields.error("`target` and `position` of the spot light are the same"));
            }
            direction
        }
        (None, None) => return Err(fields.missing("direction", "the vector")),
        (Some(_), Some(_)) => return Err(fields.error("give `direction` or `target`, not both")),
    };
    let outer = angle(fields, &["outerAngle", "totalWidth", "cutoffAngle", "falloff"], &["cosTotalWidth"])?;
    let inner = angle(fields, &["innerAngle", "falloffStart", "beamWidth", "cone"], &["cosFalloffStart"])?;
    let outer_angle = outer.ok_or_else(|| fields.missing("outerAngle", "the float"))?;
    let inner_angle = inner.unwrap_or(0.75 * outer_angle);
    if inner_angle > outer_angle {
        let message = format!("the inner angle ({inner_angle}°) is more than the outer one ({outer_angle}°)");
        return Err(fields.error(message));
    }
    let cosine = |degrees: f32| elementary::cos(degrees.to_radians());
    // The smoothstep between the two cosines is one half on average.
    let solid_angle = 2.0 * std::f32::consts::PI * (1.0 - 0.5 * (cosine(inner_angle) + cosine(outer_angle)));
    let intensity = intensity(fields, solid_angle)?;
    Ok(LightKind::Spot { position, direction, intensity, inner_angle, outer_angle })
}

/// A half angle in degrees, given in degrees or by its cosine.
fn angle(
    fields: &mut Fields,
    names: &[&'static str],
    cosine_names: &[&'static str],
) -> Result<Option<f32>, Diagnostic> {
    let cosine = fields.float_if_any(cosine_names, Bounds::Between(-1.0, 1.0))?;
    let degrees = fields.float_if_any(names, Bounds::UpTo(0.0, 180.0))?;
    Ok(degrees.or(cosine.map(|c| elementary::acos(c).to_degrees())))
}
