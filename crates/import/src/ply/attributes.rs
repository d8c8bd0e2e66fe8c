//! Properties beyond the usual ones: attributes of the mesh, by the names that Mitsuba gives them.
//!
//! `r g b` and `red green blue` are the attribute `color`, `heat_r heat_g heat_b` are `heat_color`, and `heat_x heat_y
//! heat_z` or `heat_0 heat_1 heat_2` or `heat_1 heat_2 heat_3` are `heat`. The first of three may stand alone and is a
//! number then. Names get `vertex_` or `face_` in front. What has another number of parts is skipped.

use std::collections::BTreeMap;

use caustica_math::Rgb;
use caustica_scene::description::{Attribute, Domain, Mesh};

use super::header::{Element, Kind};

/// How the parts of an attribute end, and what its name ends with.
const ENDINGS: [([&str; 3], &str); 4] =
    [(["r", "g", "b"], "_color"), (["x", "y", "z"], ""), (["0", "1", "2"], ""), (["1", "2", "3"], "")];

/// An attribute while its file is read.
pub(super) struct Columns {
    attribute: Attribute,
    /// Which properties its parts are.
    parts: [usize; 3],
    /// Its values count in units of that.
    unit: f32,
}

/// The attributes of an element that the mesh does not have yet, of properties that mean nothing else.
pub(super) fn find(
    element: &Element,
    (domain, mesh): (Domain, &Mesh),
    is_taken: impl Fn(&str) -> bool,
) -> Vec<Columns> {
    let mut alone = BTreeMap::new();
    let mut families: BTreeMap<&str, Vec<(&str, usize)>> = BTreeMap::new();
    for (index, property) in element.properties.iter().enumerate() {
        let name = property.name.as_str();
        if property.list.is_some() || is_taken(name) {
            continue;
        }
        match name.rsplit_once('_') {
            Some((family, end)) => families.entry(family).or_default().push((end, index)),
            None => drop(alone.entry(name).or_insert(index)),
        }
    }
    let mut all: Vec<Columns> = Vec::new();
    let mut add = |name: String, parts: [usize; 3]| {
        let is_color = name.ends_with("color");
        let in_bytes = parts.iter().all(|p| element.properties[*p].kind == Kind::U8);
        let unit = if is_color && in_bytes { 255.0 } else { 1.0 };
        let mut known = all.iter().map(|c| &c.attribute).chain(&mesh.attributes);
        if !known.any(|a| a.name == name) {
            all.push(Columns { attribute: Attribute { name, domain, values: Vec::new() }, parts, unit });
        }
    };
    let prefix = if domain == Domain::Vertex { "vertex_" } else { "face_" };
    let colours = [["r", "g", "b"], ["red", "green", "blue"]];
    let found = colours.iter().find_map(|names| all_of(names.map(|n| alone.get(n).copied())));
    if let Some(parts) = found {
        add(format!("{prefix}color"), parts);
    }
    for (family, members) in families {
        if let Some((parts, end)) = family_parts(&members) {
            add(format!("{prefix}{family}{end}"), parts);
        }
    }
    all
}

fn all_of([a, b, c]: [Option<usize>; 3]) -> Option<[usize; 3]> {
    Some([a?, b?, c?])
}

/// Which properties the parts of an attribute are, if they are one or three, and what its name ends with.
fn family_parts(members: &[(&str, usize)]) -> Option<([usize; 3], &'static str)> {
    ENDINGS.iter().find_map(|(ends, suffix)| {
        let part = |end: &str| members.iter().find(|m| m.0 == end).map(|m| m.1);
        let parts = match members {
            [(end, index)] if *end == ends[0] => [*index; 3],
            [_, _, _] => all_of(ends.map(part))?,
            _ => return None,
        };
        Some((parts, *suffix))
    })
}

impl Columns {
    /// Makes room for that many values.
    pub(super) fn reserve(&mut self, count: usize) {
        self.attribute.values.reserve_exact(count);
    }

    /// Adds the value of a row so many times, given the row's numbers.
    pub(super) fn push(&mut self, row: &[f32], times: usize) {
        let value = Rgb(self.parts.map(|p| row[p] / self.unit));
        self.attribute.values.extend(std::iter::repeat_n(value, times));
    }

    /// The attribute as it has been read.
    pub(super) fn finish(self) -> Attribute {
        self.attribute
    }
}
