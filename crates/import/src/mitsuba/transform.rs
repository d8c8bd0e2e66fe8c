//! `<transform>` and the operations in it, each applied after those before it.

use caustica_math::Transform;
use caustica_scene::Diagnostic;
use roxmltree::Node;

use super::file::{File, Variables, tag_range};
use super::value;
use crate::nori::transform::{affine, hint};
use crate::nori::value::{Bad, numbers};
use crate::suggest;

const OPERATIONS: &[&str] = &["translate", "matrix", "rotate", "scale", "lookat"];

/// Whether a tag is that of an operation.
pub(super) fn is_operation(tag: &str) -> bool {
    OPERATIONS.contains(&tag)
}

/// The product of the operations.
pub(super) fn parse(file: &File, node: Node, variables: &mut Variables) -> Result<Transform, Diagnostic> {
    let mut transform = Transform::IDENTITY;
    for child in file.elements(node)? {
        let operation = operation(file, child, variables)?;
        if !operation.is_invertible() {
            let error = file.error("this transform cannot be inverted", tag_range(child));
            return Err(error.hint(hint(child.tag_name().name())));
        }
        transform = transform.then(operation);
    }
    if !transform.is_invertible() {
        return Err(file.error("this transform cannot be inverted", tag_range(node)));
    }
    Ok(transform)
}

fn operation(file: &File, node: Node, variables: &mut Variables) -> Result<Transform, Diagnostic> {
    let known: &[&str] = match node.tag_name().name() {
        "translate" | "scale" => &["value", "x", "y", "z"],
        "matrix" => &["value"],
        "rotate" => &["angle", "value", "x", "y", "z"],
        "lookat" | "lookAt" => &["origin", "target", "up"],
        other => {
            let message = format!("unknown transform operation <{}>", suggest::shorten(other));
            return Err(file.error(message, tag_range(node)).hint(suggest::hint(other, OPERATIONS)));
        }
    };
    file.check_leaf(node, known)?;
    Ok(match node.tag_name().name() {
        "translate" => Transform::translate(value::triple(file, node, 0.0, variables)?),
        "scale" => Transform::scale(value::triple(file, node, 1.0, variables)?),
        "rotate" => {
            let angle = file.attribute(node, "angle", variables)?;
            let degrees = numbers(&angle.value, 1..=1).map_err(|bad| file.bad(&angle, bad))?[0];
            Transform::rotate(degrees, value::triple(file, node, 0.0, variables)?)
        }
        "matrix" => {
            let text = file.attribute(node, "value", variables)?;
            matrix(&text.value).map_err(|bad| file.bad(&text, bad))?
        }
        _ => look_at(file, node, variables)?,
    })
}

/// Sixteen numbers in rows; or nine, without the last row and the last column.
fn matrix(text: &str) -> Result<Transform, Bad> {
    let m = numbers(text, 9..=16)?;
    let m = match <[f64; 16]>::try_from(m) {
        Ok(whole) => whole,
        Err(m) if m.len() == 9 => {
            [m[0], m[1], m[2], 0.0, m[3], m[4], m[5], 0.0, m[6], m[7], m[8], 0.0, 0.0, 0.0, 0.0, 1.0]
        }
        Err(m) => {
            let message = format!("expected 9 or 16 numbers and found {}", m.len());
            return Err(Bad { message, range: 0..text.len() });
        }
    };
    affine(m, text)
}

fn look_at(file: &File, node: Node, variables: &mut Variables) -> Result<Transform, Diagnostic> {
    let mut triple = |name| -> Result<[f64; 3], Diagnostic> {
        let text = file.attribute(node, name, variables)?;
        let v = numbers(&text.value, 3..=3).map_err(|bad| file.bad(&text, bad))?;
        Ok([v[0], v[1], v[2]])
    };
    let (origin, target) = (triple("origin")?, triple("target")?);
    let up = node.has_attribute("up").then(|| triple("up")).transpose()?;
    Ok(look(origin, target, up))
}

/// From `origin` to `target`, any way up if none is given.
pub(super) fn look(origin: [f64; 3], target: [f64; 3], up: Option<[f64; 3]>) -> Transform {
    // Any direction will do; the axis farthest from the line of sight is never parallel to it.
    let across = || {
        let along = [0, 1, 2].map(|i| (target[i] - origin[i]).abs());
        let least = (0..3).min_by(|a, b| along[*a].total_cmp(&along[*b])).unwrap_or(0);
        [0, 1, 2].map(|i| f64::from(i == least))
    };
    Transform::look_at(origin, target, up.unwrap_or_else(across))
}

#[cfg(test)]
mod tests {
    use super::*;
    use caustica_math::Vec3;

    #[test]
    fn nine_numbers_are_the_linear_part() {
        let t = matrix("0 1 0  2 0 0  0 0 3").unwrap();
        let p = t.point(Vec3::new(1.0, 10.0, 100.0));
        assert_eq!([p.x, p.y, p.z], [10.0, 2.0, 300.0]);
        assert!(matrix("1 2 3").is_err() && matrix("1 0 0 0 0 1 0 0 0 0 1").is_err());
    }
}
