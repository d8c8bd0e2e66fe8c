//! `<texture>` and `<spectrum>`, and colours that may be either.
//!
//! Texture coordinates have v = 0 at an image's upper edge in Mitsuba and at the lower one here: shapes are built with
//! 1 − v, and textures are placed for it.

use caustica_math::{Rgb, Transform, Vec3};
use caustica_scene::Diagnostic;
use caustica_scene::description::{PixelLookup, Texture, TextureTransform, Wrap};

use super::context::Context;
use super::fields::Fields;
use super::spectrum::{Curve, Role};
use super::tree::Value;
use crate::image::Codes;
use crate::nori::range::Bounds;

const TEXTURES: &[&str] = &[
    "bitmap",
    "checkerboard",
    "mesh_attribute",
    "rgb",
    "srgb",
    "uniform",
    "d65",
    "blackbody",
    "regular",
    "irregular",
];
const UNSUPPORTED: &[&str] = &["volume", "grid", "scale", "wireframe", "curvature"];

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
        Texture::Attribute { .. } => {
            let message = format!("`{name}` of the {} cannot be a `mesh_attribute`", fields.title());
            return Err(fields.error(message).hint("give one color"));
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

pub(super) fn read(index: usize, role: Role, cx: &mut Context) -> Result<Texture, Diagnostic> {
    let mut fields = Fields::new(cx.tree, index);
    let texture = match fields.plugin() {
        "bitmap" => bitmap(&mut fields, cx)?,
        "checkerboard" => checkerboard(&mut fields, role, cx)?,
        "mesh_attribute" => mesh_attribute(&mut fields, cx)?,
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
    let codes = if fields.boolean("raw", false)? { Codes::Raw } else { Codes::Srgb };
    let image = cx.image_of(file, codes, &property.value_origin)?;
    let ToUv { u, v } = to_uv(fields)?;
    let wrap = match fields.choice("wrap_mode", &["repeat", "mirror", "clamp"])? {
        Some(("mirror", _)) => Wrap::Mirror,
        Some(("clamp", _)) => Wrap::Clamp,
        _ => Wrap::Repeat,
    };
    let filter = match fields.choice("filter_type", &["bilinear", "nearest", "trilinear", "ewa"])? {
        Some(("nearest", _)) => PixelLookup::Nearest,
        Some((mode @ ("trilinear" | "ewa"), p)) => {
            let message = format!("there is no filter `{mode}` any more; it is bilinear");
            fields.warn_at(message, &p.value_origin);
            PixelLookup::Bilinear
        }
        _ => PixelLookup::Bilinear,
    };
    fields.ignore(&["format", "accel", "cache", "max_anisotropy"]);
    fields.unsupported(&["gamma", "channel"]);
    // The place is u′ and v′ from the upper edge, by 1 − v.
    let transform = TextureTransform {
        scale: [u[0], v[1]],
        shear: [-u[1], -v[0]],
        offset: [u[2] + u[1], 1.0 - v[1] - v[2]],
        wrap,
        filter,
    };
    Ok(Texture::Image { image, transform })
}

fn checkerboard(fields: &mut Fields, role: Role, cx: &mut Context) -> Result<Texture, Diagnostic> {
    let value1 = constant(fields, "color0", role, cx)?.unwrap_or(Rgb::splat(0.4));
    let value2 = constant(fields, "color1", role, cx)?.unwrap_or(Rgb::splat(0.2));
    let ToUv { mut u, mut v } = to_uv(fields)?;
    if u[0] == 0.0 || v[1] == 0.0 {
        // Both count alike, and not both can be so.
        std::mem::swap(&mut u, &mut v);
    }
    // A field is half a unit of u′ and v′; v is 1 − v here.
    Ok(Texture::Checkerboard {
        scale: [0.5 / u[0], -0.5 / v[1]],
        shear: [-2.0 * u[1], 2.0 * v[0]],
        delta: [-2.0 * (u[1] + u[2]), -2.0 * (v[1] + v[2])],
        value1,
        value2,
    })
}

/// Colours of the mesh. (Whether it has them is seen where it becomes a surface.)
fn mesh_attribute(fields: &mut Fields, cx: &mut Context) -> Result<Texture, Diagnostic> {
    let Some((name, property)) = fields.string("name")? else {
        return Err(fields.missing("name", "the string").hint("such as `vertex_color`"));
    };
    if !["vertex_", "face_"].iter().any(|start| name.starts_with(start)) {
        let message =
            format!("the attribute `{}` is neither of vertices nor of faces", crate::suggest::shorten(name));
        return Err(super::tree::error(message, &property.value_origin)
            .hint("its name begins with `vertex_` or `face_`"));
    }
    let scale = fields.float("scale", 1.0, Bounds::NotNegative)?;
    Ok(Texture::Attribute { attribute: cx.description.add_attribute(name), scale })
}

/// Where texture coordinates are taken: u′ = u[0]·u + u[1]·v + u[2], and v′ likewise.
struct ToUv {
    u: [f32; 3],
    v: [f32; 3],
}

fn to_uv(fields: &mut Fields) -> Result<ToUv, Diagnostic> {
    let transform = fields.transform("to_uv")?;
    let (x, y) = (transform.vector(Vec3::X), transform.vector(Vec3::Y));
    let offset = translation(&transform);
    let squares = x.x * x.x + x.y * x.y + y.x * y.x + y.y * y.y;
    if (x.x * y.y - x.y * y.x).abs() <= 1e-9 * squares {
        fields.warn("`to_uv` cannot be inverted; it is left out");
        return Ok(ToUv { u: [1.0, 0.0, 0.0], v: [0.0, 1.0, 0.0] });
    }
    // What a rotation by a right angle leaves of the cosine is nothing.
    let exact = |c: f32, other: f32| if c.abs() <= 1e-7 * other.abs() { 0.0 } else { c };
    let u = [exact(x.x, y.x), exact(y.x, x.x), offset[0]];
    let v = [exact(x.y, y.y), exact(y.y, x.y), offset[1]];
    Ok(ToUv { u, v })
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
