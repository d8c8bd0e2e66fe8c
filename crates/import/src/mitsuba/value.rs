//! Values of properties.

use caustica_scene::Diagnostic;
use roxmltree::Node;

use super::file::{File, Text, Variables};
use super::spectrum::Curve;
use super::tree::Value;
use crate::nori::value::{Bad, boolean, float, integer, numbers};
use crate::suggest;

/// Tags of properties other than transforms.
pub(super) const TAGS: &[&str] =
    &["boolean", "integer", "float", "string", "point", "vector", "rgb", "srgb", "spectrum", "blackbody"];

/// The attributes of a property's tag.
pub(super) fn attributes(tag: &str) -> &'static [&'static str] {
    match tag {
        "point" | "vector" => &["name", "value", "x", "y", "z"],
        "spectrum" => &["name", "value", "filename", "intent", "unit"],
        "rgb" | "srgb" => &["name", "value", "intent"],
        "blackbody" => &["name", "temperature", "scale"],
        "float" => &["name", "value", "unit"],
        _ => &["name", "value"],
    }
}

/// The value of a property's tag, one of [`TAGS`], unless it lies in a file.
pub(super) fn parse(file: &File, node: Node, variables: &mut Variables) -> Result<Value, Diagnostic> {
    let tag = node.tag_name().name();
    match tag {
        "point" => return triple(file, node, 0.0, variables).map(Value::Point),
        "vector" => return triple(file, node, 0.0, variables).map(Value::Vector),
        "blackbody" => return blackbody(file, node, variables),
        _ => {}
    }
    let text = file.attribute(node, "value", variables)?;
    let value = scalar(tag, &text.value).map_err(|bad| file.bad(&text, bad))?;
    if tag == "float" {
        return unit(file, node, value, variables);
    }
    Ok(value)
}

fn scalar(tag: &str, text: &str) -> Result<Value, Bad> {
    Ok(match tag {
        "boolean" => Value::Boolean(boolean(text)?),
        "integer" => Value::Integer(integer(text)?),
        "float" => Value::Float(float(text)?),
        "rgb" => Value::Rgb(rgb(text)?),
        "srgb" => Value::Rgb(rgb(text)?.map(decode)),
        "spectrum" => Value::Spectrum(Curve::parse(text)?),
        _ => Value::String(text.to_owned()),
    })
}

/// Angles and lengths in other units than Mitsuba's degrees and the scene's own.
fn unit(file: &File, node: Node, value: Value, variables: &mut Variables) -> Result<Value, Diagnostic> {
    let (Some(unit), Value::Float(number)) = (file.attribute_if_any(node, "unit", variables)?, &value) else {
        return Ok(value);
    };
    match unit.value.as_str() {
        "deg" | "degree" | "degrees" => Ok(value),
        "rad" | "radian" | "radians" => Ok(Value::Float(number.to_degrees())),
        other => {
            let message = format!("unknown unit `{}`", suggest::shorten(other));
            let hint = suggest::hint(other, &["degrees", "radians"]);
            Err(file.error(message, unit.range.clone()).hint(hint))
        }
    }
}

/// Three numbers, one for a grey, or `#rrggbb`.
fn rgb(text: &str) -> Result<[f64; 3], Bad> {
    if let Some(hex) = text.trim().strip_prefix('#') {
        let code = u32::from_str_radix(hex, 16).ok().filter(|_| hex.len() == 6 && hex.is_ascii());
        let Some(code) = code else {
            let message = format!("`{}` is not a colour such as #ff8000", suggest::shorten(text));
            return Err(Bad { message, range: 0..text.len() });
        };
        return Ok([16, 8, 0].map(|shift| f64::from(code >> shift & 255) / 255.0));
    }
    match numbers(text, 1..=3)?[..] {
        [grey] => Ok([grey; 3]),
        [r, g, b] => Ok([r, g, b]),
        _ => Err(Bad { message: "expected 1 or 3 numbers and found 2".into(), range: 0..text.len() }),
    }
}

/// sRGB's transfer function.
fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// Coordinates: in `value`, or as `x`, `y` and `z`, each `missing` if it is not there. A single `value` is all three.
pub(super) fn triple(
    file: &File,
    node: Node,
    missing: f64,
    variables: &mut Variables,
) -> Result<[f64; 3], Diagnostic> {
    let mut values = [missing; 3];
    let Some(text) = file.attribute_if_any(node, "value", variables)? else {
        for (value, name) in values.iter_mut().zip(["x", "y", "z"]) {
            if let Some(text) = file.attribute_if_any(node, name, variables)? {
                *value = number(file, &text)?;
            }
        }
        return Ok(values);
    };
    let read = numbers(&text.value, 1..=3).map_err(|bad| file.bad(&text, bad))?;
    match read[..] {
        [x] => values = [x; 3],
        [x, y] => (values[0], values[1]) = (x, y),
        [x, y, z] => values = [x, y, z],
        _ => {}
    }
    Ok(values)
}

fn number(file: &File, text: &Text) -> Result<f64, Diagnostic> {
    numbers(&text.value, 1..=1).map(|n| n[0]).map_err(|bad| file.bad(text, bad))
}

fn blackbody(file: &File, node: Node, variables: &mut Variables) -> Result<Value, Diagnostic> {
    let text = file.attribute(node, "temperature", variables)?;
    // Older files write the unit behind the number.
    let word = text.value.trim().trim_end_matches(['K', 'k']).trim_end();
    let temperature = word.parse().unwrap_or(f64::NAN);
    if !(temperature > 0.0 && temperature < 1e6) {
        return Err(file.error("a temperature must be between 0 and a million kelvin", text.range.clone()));
    }
    let scale = match file.attribute_if_any(node, "scale", variables)? {
        Some(text) => number(file, &text)?,
        None => 1.0,
    };
    Ok(Value::Spectrum(Curve::Blackbody { temperature, scale }))
}
