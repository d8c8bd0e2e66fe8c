//! `<texture>` and `<spectrum>`, and colours that may be either.
//!
//! Texture coordinates have v = 0 at an image's upper edge in Mitsuba and at the lower one here: shapes are built with
//! 1 − v, and textures are placed for it.

use caustica_math::{Rgb, Transform, Vec3};
use caustica_scene::Diagnostic;
use caustica_scene::description::{Texture, TextureTransform};

use super::context::Context;
use super::fields::Fields;
use super::spectrum::{Curve, Role};
use super::tree::Value;
use crate::nori::range::Bounds;

const TEXTURES: &[&str] =
    &["bitmap", "checkerboard", "rgb", "srgb", "uniform", "d65", "blackbody", "regular", "irregular"];
const UNSUPPORTED: &[&str] = &["mesh_attribute", "volume", "grid", "scale", "wireframe", "curvature"];

/// A colour property, or a texture or spectrum of that name, if either is there.
pub(super) fn slot(
    fields: &mut Fields,
    name: &'static str,
    role: Role,
    cx: &mut Context,
) -> Result<Option<Texture>, Diagnostic> {
    let color = fields.color(name, role)?;
    match (color, fields.texture(name)) {
        (Some(_), Some(_)) => {
            Err(fields.error(format!("`{name}` of the {} is both a color and a texture", fields.title())))
        }
        (_, Some(index)) => read(index, role, cx).map(Some),
        (color, None) => Ok(color.map(Texture::Constant)),
    }
}

/// The same where the renderer takes no texture.
pub(super) fn constant(
    fields: &mut Fields,
    name: &'static str,
    role: Role,
    cx: &mut Context,
) -> Result<Option<Rgb>, Diagnostic> {
    let Some(texture) = slot(fields, name, role, cx)? else { return Ok(None) };
    Ok(Some(match texture {
        Texture::Constant(color) => color,
        Texture::Checkerboard { value1, value2, .. } => {
            flat(fields, name);
            (value1 + value2) * 0.5
        }
        Texture::Image { image, .. } => {
            flat(fields, name);
            mean(&cx.description.images[image.0 as usize].pixels)
        }
    }))
}

fn flat(fields: &mut Fields, name: &str) {
    let message = format!("`{name}` of the {} cannot be textured yet; its mean is used", fields.title());
    fields.warn(message);
}

fn mean(pixels: &[Rgb]) -> Rgb {
    let mut sum = [0.0_f64; 3];
    for pixel in pixels {
        (0..3).for_each(|i| sum[i] += f64::from(pixel.0[i]));
    }
    Rgb(sum.map(|s| (s / pixels.len() as f64) as f32))
}

fn read(index: usize, role: Role, cx: &mut Context) -> Result<Texture, Diagnostic> {
    let mut fields = Fields::new(cx.tree, index);
    let texture = match fields.plugin() {
        "bitmap" => bitmap(&mut fields, cx)?,
        "checkerboard" => checkerboard(&mut fields, role, cx)?,
        "rgb" | "srgb" => one(&mut fields, "color", role)?.into(),
        "uniform" => one(&mut fields, "value", role)?.into(),
        "d65" => {
            let color = fields.color("color", role)?.or(fields.color("value", role)?).unwrap_or(Rgb::WHITE);
            (color * fields.float("scale", 1.0, Bounds::NotNegative)?).into()
        }
        "blackbody" => {
            let temperature = fields.float("temperature", 5000.0, Bounds::Between(0.0, 1e6))?.into();
            let scale = fields.float("scale", 1.0, Bounds::NotNegative)?.into();
            Curve::Blackbody { temperature, scale }.rgb(role).0.into()
        }
        "regular" | "irregular" => samples(&mut fields, role)?.into(),
        known if UNSUPPORTED.contains(&known) => {
            let message = format!("the {} is not supported yet; shown as grey", fields.title());
            fields.warn(message);
            fields.finish_unread(cx);
            return Ok(Rgb::splat(0.5).into());
        }
        _ => return Err(fields.unknown_plugin(TEXTURES)),
    };
    fields.finish(cx);
    Ok(texture)
}

fn one(fields: &mut Fields, name: &'static str, role: Role) -> Result<Rgb, Diagnostic> {
    fields.color(name, role)?.ok_or_else(|| fields.missing(name, "the color"))
}

fn bitmap(fields: &mut Fields, cx: &mut Context) -> Result<Texture, Diagnostic> {
    let (file, property) = fields.file_name()?;
    let image = cx.image(file, &property.value_origin)?;
    let [scale, offset] = to_uv(fields)?;
    if let Some((mode, p)) = fields.choice("wrap_mode", &["repeat", "mirror", "clamp"])?
        && mode != "repeat"
    {
        fields.warn_at(
            format!("the wrap mode `{mode}` is not supported yet; the image repeats"),
            &p.value_origin,
        );
    }
    if let Some((mode, p)) = fields.choice("filter_type", &["bilinear", "nearest", "trilinear", "ewa"])?
        && mode != "bilinear"
    {
        fields.warn_at(format!("the filter `{mode}` is not supported yet; it is bilinear"), &p.value_origin);
    }
    if fields.boolean("raw", false)? {
        fields.warn("`raw` is not supported yet; PNG and JPEG are taken as sRGB");
    }
    fields.ignore(&["format", "accel", "cache", "max_anisotropy"]);
    fields.unsupported(&["gamma", "channel"]);
    // The row at v′ = v·scale + offset from the upper edge, by 1 − v.
    let transform = TextureTransform { scale, offset: [offset[0], 1.0 - scale[1] - offset[1]] };
    Ok(Texture::Image { image, transform })
}

fn checkerboard(fields: &mut Fields, role: Role, cx: &mut Context) -> Result<Texture, Diagnostic> {
    let value1 = constant(fields, "color0", role, cx)?.unwrap_or(Rgb::splat(0.4));
    let value2 = constant(fields, "color1", role, cx)?.unwrap_or(Rgb::splat(0.2));
    let [s, o] = to_uv(fields)?;
    // A field is half a unit of u′ = u·s + o; v is 1 − v here.
    Ok(Texture::Checkerboard {
        scale: [0.5 / s[0], -0.5 / s[1]],
        delta: [-2.0 * o[0], -2.0 * (s[1] + o[1])],
        value1,
        value2,
    })
}

/// Scale and offset of texture coordinates.
fn to_uv(fields: &mut Fields) -> Result<[[f32; 2]; 2], Diagnostic> {
    let transform = fields.transform("to_uv")?;
    let (u, v) = (transform.vector(Vec3::X), transform.vector(Vec3::Y));
    let offset = translation(&transform);
    if u.y.abs() + v.x.abs() > 1e-6 * (u.x.abs() + v.y.abs()) || u.x == 0.0 || v.y == 0.0 {
        fields.warn("`to_uv` may only scale and move so far; it is left out");
        return Ok([[1.0; 2], [0.0; 2]]);
    }
    Ok([[u.x, v.y], offset])
}

/// How far coordinates are moved: by the fourth column, or by the third of a 3 × 3 matrix.
fn translation(transform: &Transform) -> [f32; 2] {
    let (fourth, third) = (transform.point(Vec3::ZERO), transform.vector(Vec3::Z));
    [fourth.x + third.x, fourth.y + third.y]
}

/// A spectrum as lists of wavelengths and values.
fn samples(fields: &mut Fields, role: Role) -> Result<Rgb, Diagnostic> {
    if let Some(property) = fields.find("value")
        && let Value::Spectrum(curve) = &property.value
    {
        return Ok(curve.rgb(role).0);
    }
    let mut list = |name: &'static str| -> Result<Vec<f64>, Diagnostic> {
        let Some((text, property)) = fields.string(name)? else { return Ok(Vec::new()) };
        crate::nori::value::numbers(text, 1..=10_000)
            .map_err(|bad| super::tree::error(bad.message, &property.value_origin))
    };
    let (mut wavelengths, values) = (list("wavelengths")?, list("values")?);
    if wavelengths.is_empty() {
        let first = fields.float("wavelength_min", 360.0, Bounds::Positive)?;
        let last = fields.float("wavelength_max", 830.0, Bounds::Positive)?;
        let step = f64::from(last - first) / (values.len().max(2) - 1) as f64;
        wavelengths = (0..values.len()).map(|i| f64::from(first) + step * i as f64).collect();
    }
    if wavelengths.len() != values.len() {
        return Err(fields.error("the spectrum has not as many wavelengths as values"));
    }
    let curve = Curve::from_samples(wavelengths.into_iter().zip(values).collect());
    Ok(curve.map_err(|why| fields.error(why))?.rgb(role).0)
}
