//! `<texture>`, and colours that may be textures.

use caustica_math::Rgb;
use caustica_scene::Diagnostic;
use caustica_scene::description::{Texture, TextureTransform};

use super::context::Context;
use super::fields::Fields;
use super::range::{Bounds, Radiometry};
use super::tree::Object;

const TEXTURES: &[&str] = &["checkerboard_color", "constant_color", "image_texture"];

/// A colour property or a texture of the same name, if either is there.
pub(super) fn slot(
    fields: &mut Fields,
    names: &[&'static str],
    radiometry: Radiometry,
    cx: &mut Context,
) -> Result<Option<Texture>, Diagnostic> {
    let color = fields.color(names, radiometry)?;
    match (color, fields.texture(names)?) {
        (Some(_), Some(_)) => Err(fields.error(format!(
            "`{}` of the {} is both a color and a texture",
            names[0],
            fields.title()
        ))),
        (_, Some(object)) => read(object, radiometry, cx).map(Some),
        (color, None) => Ok(color.map(Texture::Constant)),
    }
}

fn read(object: &Object, radiometry: Radiometry, cx: &mut Context) -> Result<Texture, Diagnostic> {
    let mut fields = Fields::new(object, cx.place);
    let texture = match object.plugin.as_str() {
        "constant_color" => Texture::Constant(fields.color(&["value"], radiometry)?.unwrap_or(Rgb::BLACK)),
        "checkerboard_color" => {
            let delta = fields.pair(&["delta"])?.map_or([0.0; 2], |(delta, _)| delta);
            let scale = scale(&mut fields)?;
            let value1 = fields.color(&["value1"], radiometry)?.unwrap_or(Rgb::BLACK);
            let value2 = fields.color(&["value2"], radiometry)?.unwrap_or(Rgb::WHITE);
            Texture::Checkerboard { delta, scale, shear: [0.0; 2], value1, value2 }
        }
        "image_texture" => {
            let (file, property) = fields.file_name()?;
            let image = cx.image(file, &property.value_range)?;
            let scale = scale(&mut fields)?;
            let offset = fields.pair(&["offset", "delta"])?.map_or([0.0; 2], |(offset, _)| offset);
            Texture::Image {
                image,
                transform: TextureTransform { scale, offset, ..TextureTransform::default() },
            }
        }
        _ => return Err(fields.unknown_plugin(TEXTURES)),
    };
    fields.finish(cx)?;
    Ok(texture)
}

/// Two factors, or one for both; none may be zero.
fn scale(fields: &mut Fields) -> Result<[f32; 2], Diagnostic> {
    let names = &["scale"];
    let is_float = fields.find(names).is_some_and(|p| matches!(p.value, super::value::Value::Float(_)));
    if is_float {
        return Ok([fields.float(names, 1.0, Bounds::Positive)?; 2]);
    }
    let Some((scale, property)) = fields.pair(names)? else { return Ok([1.0; 2]) };
    if scale.contains(&0.0) {
        return Err(fields.error_in(property, "`scale` may not be zero"));
    }
    Ok(scale)
}
