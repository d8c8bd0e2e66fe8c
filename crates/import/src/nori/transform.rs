//! `<transform>` and the operations in it.

use caustica_math::Transform;
use caustica_scene::Diagnostic;
use roxmltree::Node;

use super::tree::{self, Place};
use super::value::{self, Bad};
use crate::suggest;

const OPERATIONS: &[&str] = &["translate", "matrix", "rotate", "scale", "lookat"];

/// Whether a tag is that of an operation.
pub(super) fn is_operation(tag: &str) -> bool {
    OPERATIONS.contains(&tag)
}

/// The product of the operations, each applied after those before it.
pub(super) fn parse(place: Place, node: Node) -> Result<Transform, Diagnostic> {
    let mut transform = Transform::IDENTITY;
    for child in tree::elements(place, node)? {
        let operation = operation(place, child)?;
        if !operation.is_invertible() {
            let error = place.error("this transform cannot be inverted", tree::tag_range(child));
            return Err(error.hint(hint(child.tag_name().name())));
        }
        transform = transform.then(operation);
    }
    if !transform.is_invertible() {
        return Err(place.error("this transform cannot be inverted", tree::tag_range(node)));
    }
    Ok(transform)
}

/// What may be wrong with an operation that cannot be inverted.
pub(crate) fn hint(tag: &str) -> &'static str {
    match tag {
        "scale" => "no factor may be zero",
        "rotate" => "the axis may not be zero",
        "matrix" => "the matrix is singular",
        "translate" => "the numbers are too large",
        _ => "origin and target must differ, and up may not be parallel to the line between them",
    }
}

fn operation(place: Place, node: Node) -> Result<Transform, Diagnostic> {
    let attributes: &[&str] = match node.tag_name().name() {
        "translate" | "matrix" | "scale" => &["value"],
        "rotate" => &["angle", "axis"],
        "lookat" | "lookAt" => &["origin", "target", "up"],
        other => {
            let message = format!("unknown transform operation <{}>", suggest::shorten(other));
            return Err(place.error(message, tree::tag_range(node)).hint(suggest::hint(other, OPERATIONS)));
        }
    };
    tree::check_attributes(place, node, attributes, &[])?;
    if let Some(child) = tree::elements(place, node)?.first() {
        let message = format!("nothing can stand inside <{}>", node.tag_name().name());
        return Err(place.error(message, tree::tag_range(*child)));
    }
    let triple = |name| read(place, node, name, value::array::<3>);
    Ok(match node.tag_name().name() {
        "translate" => Transform::translate(triple("value")?),
        "scale" => Transform::scale(triple("value")?),
        "rotate" => {
            let [angle] = read(place, node, "angle", value::array::<1>)?;
            Transform::rotate(angle, triple("axis")?)
        }
        "matrix" => read(place, node, "value", |text| affine(value::array(text)?, text))?,
        _ => Transform::look_at(triple("origin")?, triple("target")?, triple("up")?),
    })
}

/// The transform of a matrix in rows, of which `text` tells.
pub(crate) fn affine(m: [f64; 16], text: &str) -> Result<Transform, Bad> {
    if m[12..] != [0.0, 0.0, 0.0, 1.0] {
        // Under a projective map neither normals nor distances along rays mean anything.
        let message = "the last row of the matrix must be 0 0 0 1".into();
        return Err(Bad { message, range: 0..text.len() });
    }
    let row = |i: usize| [m[4 * i], m[4 * i + 1], m[4 * i + 2], m[4 * i + 3]];
    Ok(Transform::from_rows([row(0), row(1), row(2), row(3)]))
}

fn read<T>(
    place: Place,
    node: Node,
    name: &str,
    parse: impl Fn(&str) -> Result<T, Bad>,
) -> Result<T, Diagnostic> {
    let attribute = tree::attribute(place, node, name)?;
    parse(attribute.value()).map_err(|bad| place.bad_value(attribute, bad))
}
