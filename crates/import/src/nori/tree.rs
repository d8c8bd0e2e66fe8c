//! XML to objects with typed properties, as the format defines them for all plugins alike.

use std::ops::Range;

use caustica_scene::Diagnostic;
use roxmltree::{Attribute, Node, NodeType};

use super::value::{self, Bad, Value};
use super::{class::Class, transform};
use crate::source::Source;
use crate::suggest;

/// The deepest nesting of objects: a test, its scene, a mesh, its material and its texture need five.
const DEEPEST: usize = 16;

/// An object: a plugin with its properties and the objects inside of it.
pub(super) struct Object {
    pub(super) class: Class,
    /// The value of `type`; empty for a scene.
    pub(super) plugin: String,
    /// The values of `name` and `id`.
    pub(super) names: Vec<String>,
    pub(super) properties: Vec<Property>,
    pub(super) children: Vec<Object>,
    /// The tag.
    pub(super) range: Range<usize>,
    /// The value of `type`.
    pub(super) plugin_range: Range<usize>,
}

/// A named value.
pub(super) struct Property {
    pub(super) name: String,
    pub(super) value: Value,
    /// The tag.
    pub(super) range: Range<usize>,
    /// The value, where it is written as an attribute.
    pub(super) value_range: Range<usize>,
}

/// The file that is being read: where errors are placed.
#[derive(Clone, Copy)]
pub(super) struct Place<'p> {
    pub(super) source: &'p Source<'p>,
}

impl Place<'_> {
    /// An error at a range of bytes.
    pub(super) fn error(self, message: impl Into<String>, range: Range<usize>) -> Diagnostic {
        Diagnostic::error(message).at(Some(self.source.origin(range)))
    }

    /// An error in the text of an attribute.
    pub(super) fn bad_value(self, attribute: Attribute, bad: Bad) -> Diagnostic {
        let mut range = attribute.range_value();
        // Where the text is written with references such as `&lt;`, offsets in it say nothing.
        if self.source.text().get(range.clone()) == Some(attribute.value()) {
            range = range.start + bad.range.start..range.start + bad.range.end;
        }
        self.error(bad.message, range)
    }
}

/// The object of a node and all in it.
pub(super) fn object(place: Place, node: Node, depth: usize) -> Result<Object, Diagnostic> {
    let tag = node.tag_name().name();
    let Some(class) = Class::from_tag(tag) else { return Err(unknown_tag(place, node)) };
    if depth > DEEPEST {
        return Err(place.error("objects are nested too deeply", tag_range(node)));
    }
    let required: &[&str] = if class.needs_type() { &["type"] } else { &[] };
    check_attributes(place, node, required, &["type", "name", "id"])?;
    let plugin = node.attribute_node("type");
    let mut object = Object {
        class,
        plugin: plugin.map_or("", |a| a.value()).to_owned(),
        names: ["name", "id"].iter().filter_map(|n| node.attribute(*n)).map(str::to_owned).collect(),
        properties: Vec::new(),
        children: Vec::new(),
        range: tag_range(node),
        plugin_range: plugin.map_or(tag_range(node), |a| a.range_value()),
    };
    for child in elements(place, node)? {
        let tag = child.tag_name().name();
        if tag == "transform" || value::TAGS.contains(&tag) {
            object.properties.push(property(place, child)?);
        } else {
            object.children.push(self::object(place, child, depth + 1)?);
        }
    }
    Ok(object)
}

fn property(place: Place, node: Node) -> Result<Property, Diagnostic> {
    let tag = node.tag_name().name();
    let is_transform = tag == "transform";
    check_attributes(place, node, if is_transform { &["name"] } else { &["name", "value"] }, &[])?;
    let (value, value_range) = if is_transform {
        (Value::Transform(Box::new(transform::parse(place, node)?)), tag_range(node))
    } else {
        if let Some(child) = elements(place, node)?.first() {
            return Err(place.error(format!("nothing can stand inside <{tag}>"), tag_range(*child)));
        }
        let text = attribute(place, node, "value")?;
        let value = value::parse(tag, text.value()).map_err(|bad| place.bad_value(text, bad))?;
        (value, text.range_value())
    };
    let name = attribute(place, node, "name")?.value().to_owned();
    Ok(Property { name, value, range: tag_range(node), value_range })
}

fn unknown_tag(place: Place, node: Node) -> Diagnostic {
    let tag = node.tag_name().name();
    let error = place.error(format!("unknown tag <{}>", suggest::shorten(tag)), tag_range(node));
    let tags = Class::tags().chain(value::TAGS.iter().copied()).chain(["transform"]);
    match suggest::nearest(tag, tags) {
        Some(candidate) => error.hint(format!("did you mean <{candidate}>?")),
        None if super::transform::is_operation(tag) => error.hint("it belongs inside of a <transform>"),
        None => error,
    }
}

/// The elements in a node; text that stands between them is an error.
pub(super) fn elements<'a, 'i>(place: Place, node: Node<'a, 'i>) -> Result<Vec<Node<'a, 'i>>, Diagnostic> {
    let mut elements = Vec::new();
    for child in node.children() {
        match child.node_type() {
            NodeType::Element => elements.push(child),
            NodeType::Text if !child.text().unwrap_or_default().trim().is_empty() => {
                return Err(stray_text(place, child));
            }
            _ => {}
        }
    }
    Ok(elements)
}

fn stray_text(place: Place, node: Node) -> Diagnostic {
    let range = node.range();
    let raw = place.source.text().get(range.clone()).unwrap_or_default();
    let start = range.start + raw.len() - raw.trim_start().len();
    let text = suggest::shorten(node.text().unwrap_or_default().trim());
    place.error(format!("stray text `{text}`"), start..start + raw.trim().len())
}

/// Checks that all of `required` and nothing but those and `optional` is there.
pub(super) fn check_attributes(
    place: Place,
    node: Node,
    required: &[&str],
    optional: &[&str],
) -> Result<(), Diagnostic> {
    let tag = node.tag_name().name();
    for attribute in node.attributes() {
        let name = attribute.name();
        if !required.contains(&name) && !optional.contains(&name) {
            let message = format!("<{tag}> has no attribute `{}`", suggest::shorten(name));
            let known: Vec<&str> = required.iter().chain(optional).copied().collect();
            return Err(place.error(message, attribute.range_qname()).hint(suggest::hint(name, &known)));
        }
    }
    required.iter().try_for_each(|name| attribute(place, node, name).map(|_| ()))
}

/// An attribute that must be there.
pub(super) fn attribute<'a, 'i>(
    place: Place,
    node: Node<'a, 'i>,
    name: &str,
) -> Result<Attribute<'a, 'i>, Diagnostic> {
    node.attribute_node(name).ok_or_else(|| {
        let message = format!("<{}> lacks the attribute `{name}`", node.tag_name().name());
        place.error(message, tag_range(node))
    })
}

/// The bytes of `<tag`.
pub(super) fn tag_range(node: Node) -> Range<usize> {
    let start = node.range().start;
    start..start + 1 + node.tag_name().name().len()
}
