//! The objects of a scene, with variables replaced, other files included and references resolved.

use std::collections::BTreeMap;

use caustica_math::Transform;
use caustica_scene::{Diagnostic, Origin};

use super::class::Class;
use super::spectrum::Curve;
use crate::suggest;

/// The deepest nesting of objects, references followed.
const DEEPEST: u32 = 64;

/// An object: a plugin with its properties and the objects inside of it.
pub(super) struct Object {
    pub(super) class: Class,
    /// The value of `type`; empty for a scene.
    pub(super) plugin: String,
    pub(super) id: Option<String>,
    pub(super) properties: Vec<Property>,
    pub(super) children: Vec<Child>,
    /// The tag.
    pub(super) origin: Origin,
    /// The value of `type`.
    pub(super) plugin_origin: Origin,
}

/// A named value.
pub(super) struct Property {
    pub(super) name: String,
    pub(super) value: Value,
    /// The tag.
    pub(super) origin: Origin,
    /// The value, where it is written as an attribute.
    pub(super) value_origin: Origin,
}

/// An object inside of another one.
pub(super) struct Child {
    /// What it is to its parent.
    pub(super) name: Option<String>,
    pub(super) target: Target,
    /// Where it stands or is referred to.
    pub(super) origin: Origin,
}

/// Which object.
pub(super) enum Target {
    /// By its place in the tree.
    Object(usize),
    /// By its id: only until references are resolved.
    Id(String),
}

/// A typed value.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Boolean(bool),
    Integer(i64),
    /// Infinite values are let through: what they mean depends on the property.
    Float(f64),
    String(String),
    Point([f64; 3]),
    Vector([f64; 3]),
    Rgb([f64; 3]),
    Spectrum(Curve),
    Transform(Box<Transform>),
}

impl Value {
    /// The type, with its article.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Self::Boolean(_) => "a boolean",
            Self::Integer(_) => "an integer",
            Self::Float(_) => "a float",
            Self::String(_) => "a string",
            Self::Point(_) => "a point",
            Self::Vector(_) => "a vector",
            Self::Rgb(_) => "a color",
            Self::Spectrum(_) => "a spectrum",
            Self::Transform(_) => "a transform",
        }
    }
}

/// All objects of a scene.
#[derive(Default)]
pub(super) struct Tree {
    pub(super) objects: Vec<Object>,
    /// Objects by id.
    pub(super) ids: BTreeMap<String, usize>,
    /// Other names of ids.
    pub(super) aliases: BTreeMap<String, (String, Origin)>,
}

/// An error at a place.
pub(super) fn error(message: impl Into<String>, origin: &Origin) -> Diagnostic {
    Diagnostic::error(message).at(Some(origin.clone()))
}

impl Tree {
    /// The objects inside of an object, after references are resolved.
    pub(super) fn children<'t>(&'t self, object: &'t Object) -> impl Iterator<Item = (&'t Child, usize)> {
        object.children.iter().filter_map(|child| match child.target {
            Target::Object(index) => Some((child, index)),
            Target::Id(_) => None,
        })
    }

    /// Replaces ids by places. Fails where an id is unknown or objects lie in themselves.
    pub(super) fn resolve(&mut self) -> Result<(), Diagnostic> {
        for (alias, (id, origin)) in &self.aliases {
            let Some(index) = self.ids.get(id) else { return Err(unknown_id(id, &self.ids, origin)) };
            self.ids.insert(alias.clone(), *index);
        }
        for object in &mut self.objects {
            for child in &mut object.children {
                if let Target::Id(id) = &child.target {
                    let found = self.ids.get(id);
                    let index = found.ok_or_else(|| unknown_id(id, &self.ids, &child.origin))?;
                    child.target = Target::Object(*index);
                }
            }
        }
        self.check_nesting()
    }

    /// Walks through all objects without recursion, as references may be chained without end.
    fn check_nesting(&self) -> Result<(), Diagnostic> {
        const OPEN: u32 = u32::MAX;
        // How deep objects lie below each one; 0 before it is known.
        let mut heights = vec![0; self.objects.len()];
        for root in 0..self.objects.len() {
            let mut stack = vec![(root, 0)];
            while let Some((index, next)) = stack.pop() {
                let children = &self.objects[index].children;
                if heights[index] != 0 && next == 0 {
                    continue;
                }
                heights[index] = OPEN;
                let Some(child) = children.get(next) else {
                    let below = self.children(&self.objects[index]).map(|(_, c)| heights[c]).max();
                    heights[index] = below.unwrap_or(0) + 1;
                    if heights[index] > DEEPEST {
                        return Err(error("objects are nested too deeply", &self.objects[index].origin));
                    }
                    continue;
                };
                stack.push((index, next + 1));
                if let Target::Object(target) = child.target {
                    if heights[target] == OPEN {
                        return Err(error("this object contains itself", &child.origin));
                    }
                    stack.push((target, 0));
                }
            }
        }
        Ok(())
    }
}

fn unknown_id(id: &str, ids: &BTreeMap<String, usize>, origin: &Origin) -> Diagnostic {
    let error = error(format!("nothing has the id `{}`", suggest::shorten(id)), origin);
    match suggest::nearest(id, ids.keys().map(String::as_str)) {
        Some(near) => error.hint(format!("did you mean `{near}`?")),
        None => error,
    }
}
