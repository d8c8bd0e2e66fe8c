//! Values of properties.

use std::ops::Range;

use caustica_math::Transform;

/// A typed value.
#[derive(Clone, Debug)]
pub(super) enum Value {
    /// No plugin has one so far: it is checked and dropped.
    Boolean,
    Integer(i64),
    /// Infinite values are let through: what they mean depends on the property.
    Float(f64),
    String(String),
    /// Two or three coordinates.
    Point(Vec<f64>),
    /// Two or three coordinates.
    Vector(Vec<f64>),
    Color([f64; 3]),
    Transform(Box<Transform>),
}

impl Value {
    /// The type, with its article.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Self::Boolean => "a boolean",
            Self::Integer(_) => "an integer",
            Self::Float(_) => "a float",
            Self::String(_) => "a string",
            Self::Point(_) => "a point",
            Self::Vector(_) => "a vector",
            Self::Color(_) => "a color",
            Self::Transform(_) => "a transform",
        }
    }
}

/// Tags of properties other than transforms.
pub(super) const TAGS: &[&str] =
    &["boolean", "integer", "float", "string", "point", "point2", "vector", "vector2", "color", "rgb"];

/// What is wrong with a text, and where in it.
#[derive(Debug)]
pub(crate) struct Bad {
    pub(crate) message: String,
    pub(crate) range: Range<usize>,
}

/// The value that a property's tag and text stand for; the tag must be one of [`TAGS`].
pub(super) fn parse(tag: &str, text: &str) -> Result<Value, Bad> {
    Ok(match tag {
        "boolean" => boolean(text).map(|_| Value::Boolean)?,
        "integer" => Value::Integer(integer(text)?),
        "float" => Value::Float(float(text)?),
        "point" | "point2" => Value::Point(numbers(text, 2..=3)?),
        "vector" | "vector2" => Value::Vector(numbers(text, 2..=3)?),
        "color" | "rgb" => Value::Color(array(text)?),
        _ => Value::String(text.to_owned()),
    })
}

/// The text is something else than was expected.
fn is_not(what: &str, text: &str) -> Bad {
    Bad { message: format!("`{}` is not {what}", crate::suggest::shorten(text)), range: 0..text.len() }
}

pub(crate) fn boolean(text: &str) -> Result<bool, Bad> {
    match text.trim().to_ascii_lowercase().as_str() {
        "true" => Ok(true),
        "false" => Ok(false),
        _ => Err(is_not("a boolean (true or false)", text)),
    }
}

pub(crate) fn integer(text: &str) -> Result<i64, Bad> {
    text.trim().parse().map_err(|_| is_not("an integer", text))
}

/// Any number, an infinite one too.
pub(crate) fn float(text: &str) -> Result<f64, Bad> {
    let number = text.trim().parse().ok().filter(|float: &f64| !float.is_nan());
    number.ok_or_else(|| is_not("a number", text))
}

/// Exactly `N` finite numbers.
pub(super) fn array<const N: usize>(text: &str) -> Result<[f64; N], Bad> {
    let mut values = [0.0; N];
    values.copy_from_slice(&numbers(text, N..=N)?);
    Ok(values)
}

/// Finite numbers separated by commas and white space, as many as `count` allows.
pub(crate) fn numbers(text: &str, count: std::ops::RangeInclusive<usize>) -> Result<Vec<f64>, Bad> {
    let mut values = Vec::new();
    let mut words = 0;
    for word in text.split([',', ' ', '\t', '\r', '\n']).filter(|w| !w.is_empty()) {
        words += 1;
        if words > *count.end() {
            continue;
        }
        match word.parse::<f64>() {
            Ok(value) if value.is_finite() => values.push(value),
            Ok(_) => {
                return Err(Bad { message: format!("`{word}` is not finite"), range: range(text, word) });
            }
            Err(_) => {
                let message = format!("`{}` is not a number", crate::suggest::shorten(word));
                return Err(Bad { message, range: range(text, word) });
            }
        }
    }
    if count.contains(&words) {
        return Ok(values);
    }
    let expected = match (*count.start(), *count.end()) {
        (a, b) if a == b => format!("{a} numbers"),
        (a, usize::MAX) => format!("at least {a} numbers"),
        (a, b) => format!("{a} to {b} numbers"),
    };
    Err(Bad { message: format!("expected {expected} and found {words}"), range: 0..text.len() })
}

/// Where `part` is in `whole`, of which it is a slice.
fn range(whole: &str, part: &str) -> Range<usize> {
    let start = part.as_ptr() as usize - whole.as_ptr() as usize;
    start..start + part.len()
}
