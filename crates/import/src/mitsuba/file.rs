//! A file while it is read: places in it, and its attributes with variables replaced.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use caustica_scene::{Diagnostic, Origin};
use roxmltree::{Node, NodeType};

use super::tree::error;
use crate::nori::value::Bad;
use crate::source::Source;
use crate::suggest;

/// The longest value that variables may make.
const LONGEST_VALUE: usize = 1 << 20;

/// The version of Mitsuba that a file is written for, less its last part.
pub(super) type Version = (u32, u32);

/// A file.
#[derive(Clone, Copy)]
pub(super) struct File<'f> {
    pub(super) source: &'f Source<'f>,
    pub(super) version: Version,
}

/// An attribute's value.
pub(super) struct Text {
    pub(super) value: String,
    /// Where it stands.
    pub(super) range: Range<usize>,
    /// Whether it stands there letter by letter.
    verbatim: bool,
}

/// Named values that `$` stands for.
#[derive(Default)]
pub(super) struct Variables {
    values: BTreeMap<String, String>,
    used: BTreeSet<String>,
}

impl Variables {
    pub(super) fn new(values: &[(String, String)]) -> Self {
        Self { values: values.iter().cloned().collect(), used: BTreeSet::new() }
    }

    /// Gives a value to a name that has none.
    pub(super) fn default(&mut self, name: String, value: String) {
        // Asked for by a file, whether or not it is used then.
        self.used.insert(name.clone());
        self.values.entry(name).or_insert(value);
    }

    /// Those that no file asked for.
    pub(super) fn unused(&self) -> impl Iterator<Item = &str> {
        self.values.keys().filter(|name| !self.used.contains(*name)).map(String::as_str)
    }

    /// The names that files gave defaults to or used.
    pub(super) fn known(&self) -> Vec<&str> {
        self.used.iter().map(String::as_str).collect()
    }

    fn replace(&mut self, text: &str) -> Result<String, Diagnostic> {
        let mut pieces = text.split('$');
        let mut result = pieces.next().unwrap_or_default().to_owned();
        for piece in pieces {
            let longest = self.values.iter().filter(|(name, _)| piece.starts_with(name.as_str()));
            let Some((name, value)) = longest.max_by_key(|(name, _)| name.len()) else {
                return Err(self.undefined(piece));
            };
            result.push_str(value);
            result.push_str(&piece[name.len()..]);
            if result.len() > LONGEST_VALUE {
                return Err(Diagnostic::error("variables make this value too long"));
            }
            self.used.insert(name.clone());
        }
        Ok(result)
    }

    fn undefined(&self, piece: &str) -> Diagnostic {
        let end = piece.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(piece.len());
        let name = suggest::shorten(&piece[..end]);
        let hint = match suggest::nearest(&name, self.values.keys().map(String::as_str)) {
            Some(near) => format!("did you mean `${near}`?"),
            None => format!("give it a value: `-D {name}=…`, or <default name=\"{name}\" value=\"…\"/>"),
        };
        Diagnostic::error(format!("the variable `${name}` has no value")).hint(hint)
    }
}

impl File<'_> {
    pub(super) fn origin(&self, range: Range<usize>) -> Origin {
        self.source.origin(range)
    }

    pub(super) fn error(&self, message: impl Into<String>, range: Range<usize>) -> Diagnostic {
        error(message, &self.origin(range))
    }

    /// An error in an attribute's value.
    pub(super) fn bad(&self, text: &Text, bad: Bad) -> Diagnostic {
        let start = text.range.start;
        let range =
            if text.verbatim { start + bad.range.start..start + bad.range.end } else { text.range.clone() };
        self.error(bad.message, range)
    }

    /// An attribute's value, if it is there.
    pub(super) fn attribute_if_any(
        &self,
        node: Node,
        name: &str,
        variables: &mut Variables,
    ) -> Result<Option<Text>, Diagnostic> {
        let Some(attribute) = node.attribute_node(name) else { return Ok(None) };
        let range = attribute.range_value();
        let value =
            variables.replace(attribute.value()).map_err(|e| e.at(Some(self.origin(range.clone()))))?;
        let verbatim = self.source.text().get(range.clone()) == Some(value.as_str());
        Ok(Some(Text { value, range, verbatim }))
    }

    /// The value of an attribute that must be there.
    pub(super) fn attribute(
        &self,
        node: Node,
        name: &str,
        variables: &mut Variables,
    ) -> Result<Text, Diagnostic> {
        self.attribute_if_any(node, name, variables)?.ok_or_else(|| {
            let message = format!("<{}> lacks the attribute `{name}`", node.tag_name().name());
            self.error(message, tag_range(node))
        })
    }

    /// The elements in a node; text that stands between them is an error.
    pub(super) fn elements<'a, 'i>(&self, node: Node<'a, 'i>) -> Result<Vec<Node<'a, 'i>>, Diagnostic> {
        let mut elements = Vec::new();
        for child in node.children() {
            match child.node_type() {
                NodeType::Element => elements.push(child),
                NodeType::Text if !child.text().unwrap_or_default().trim().is_empty() => {
                    let text = suggest::shorten(child.text().unwrap_or_default().trim());
                    let range = child.range();
                    let raw = self.source.text().get(range.clone()).unwrap_or_default();
                    let start = range.start + raw.len() - raw.trim_start().len();
                    return Err(self.error(format!("stray text `{text}`"), start..start + raw.trim().len()));
                }
                _ => {}
            }
        }
        Ok(elements)
    }

    /// Checks that a node has no attributes but those, and nothing in it.
    pub(super) fn check_leaf(&self, node: Node, known: &[&str]) -> Result<(), Diagnostic> {
        self.check_attributes(node, known)?;
        match self.elements(node)?.first() {
            None => Ok(()),
            Some(child) => {
                let message = format!("nothing can stand inside <{}>", node.tag_name().name());
                Err(self.error(message, tag_range(*child)))
            }
        }
    }

    /// Checks that a node has no attributes but those.
    pub(super) fn check_attributes(&self, node: Node, known: &[&str]) -> Result<(), Diagnostic> {
        let unknown = node.attributes().find(|a| !known.contains(&a.name()));
        let Some(attribute) = unknown else { return Ok(()) };
        let tag = suggest::shorten(node.tag_name().name());
        let message = format!("<{tag}> has no attribute `{}`", suggest::shorten(attribute.name()));
        let hint = suggest::hint(attribute.name(), known);
        Err(self.error(message, attribute.range_qname()).hint(hint))
    }
}

/// The bytes of `<tag`.
pub(super) fn tag_range(node: Node) -> Range<usize> {
    let start = node.range().start;
    start..start + 1 + node.tag_name().name().len()
}
