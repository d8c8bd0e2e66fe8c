//! XML to a tree of objects.

use std::path::PathBuf;
use std::sync::Arc;

use caustica_scene::{Diagnostic, Origin};
use roxmltree::Node;

use super::class::Class;
use super::file::{File, Variables, Version, tag_range};
use super::paths::Paths;
use super::spectrum::Curve;
use super::tree::{Child, Object, Property, Target, Tree, Value};
use super::{transform, upgrade, value};
use crate::nori::document;
use crate::source::Source;
use crate::{files, suggest};

/// The deepest nesting of tags and of files.
const DEEPEST: usize = 32;
const DEEPEST_FILE: usize = 16;
/// The most files that a scene may include, and the most bytes of them.
const MOST_FILES: usize = 1000;
const MOST_BYTES: u64 = 256 << 20;
/// The most bytes of a file of a spectrum.
const LARGEST_SPECTRUM: u64 = 1 << 20;

/// The scene file being read, and all files in it.
pub(super) struct Parser<'p> {
    pub(super) variables: Variables,
    pub(super) paths: Paths<'p>,
    pub(super) tree: Tree,
    pub(super) warnings: Vec<Diagnostic>,
    files: usize,
    bytes: u64,
}

/// Where in the scene a node stands: in an object, so deep, in a file that is included so often.
#[derive(Clone, Copy)]
struct Level {
    tags: usize,
    files: usize,
}

impl<'p> Parser<'p> {
    pub(super) fn new(variables: Variables, paths: Paths<'p>) -> Self {
        Self { variables, paths, tree: Tree::default(), warnings: Vec::new(), files: 0, bytes: 0 }
    }

    /// Reads the scene in a file's text: its place in the tree.
    pub(super) fn scene(&mut self, source: &Source) -> Result<usize, Diagnostic> {
        let document = document::parse(source)?;
        let root = document.root_element();
        let file = File { source, version: version(source, root)? };
        let index = self.object(&file, root, Level { tags: 0, files: 0 })?;
        self.tree.resolve()?;
        Ok(index)
    }

    fn object(&mut self, file: &File, node: Node, level: Level) -> Result<usize, Diagnostic> {
        let tag = upgrade::tag(node.tag_name().name());
        let Some(class) = Class::from_tag(tag) else { return Err(unknown_tag(file, node)) };
        if level.tags > DEEPEST {
            return Err(file.error("objects are nested too deeply", tag_range(node)));
        }
        let mut known = vec!["type", "name", "id"];
        if class == Class::Scene {
            known.push("version");
        }
        file.check_attributes(node, &known)?;
        let plugin = match class {
            Class::Scene => None,
            _ => Some(file.attribute(node, "type", &mut self.variables)?),
        };
        let origin = file.origin(tag_range(node));
        let mut object = Object {
            class,
            plugin_origin: plugin.as_ref().map_or_else(|| origin.clone(), |p| file.origin(p.range.clone())),
            plugin: plugin.map(|p| upgrade::plugin(class, p.value, file.version)).unwrap_or_default(),
            id: file.attribute_if_any(node, "id", &mut self.variables)?.map(|id| id.value),
            properties: Vec::new(),
            children: Vec::new(),
            origin,
        };
        self.content(file, node, level, &mut object)?;
        upgrade::object(&mut object, file.version);
        let index = self.tree.objects.len();
        if let Some(id) = &object.id
            && self.tree.ids.insert(id.clone(), index).is_some()
        {
            let message = format!("the id `{}` is given again", suggest::shorten(id));
            return Err(file.error(message, tag_range(node)));
        }
        self.tree.objects.push(object);
        Ok(index)
    }

    /// What stands in an object's tag.
    fn content(
        &mut self,
        file: &File,
        node: Node,
        level: Level,
        object: &mut Object,
    ) -> Result<(), Diagnostic> {
        for child in file.elements(node)? {
            match child.tag_name().name() {
                "default" => self.default(file, child)?,
                "path" => self.path(file, child, level)?,
                "alias" => self.alias(file, child)?,
                "include" => self.include(file, child, level, object)?,
                "ref" => object.children.push(self.reference(file, child)?),
                "spectrum" if child.has_attribute("type") => self.child(file, child, level, object)?,
                tag if tag == "transform" || value::TAGS.contains(&tag) => {
                    let property = self.property(file, child)?;
                    object.properties.push(property);
                }
                _ => self.child(file, child, level, object)?,
            }
        }
        Ok(())
    }

    fn child(
        &mut self,
        file: &File,
        node: Node,
        level: Level,
        parent: &mut Object,
    ) -> Result<(), Diagnostic> {
        let name = self.name(file, node)?;
        let index = self.object(file, node, Level { tags: level.tags + 1, ..level })?;
        let origin = file.origin(tag_range(node));
        parent.children.push(Child { name, target: Target::Object(index), origin });
        Ok(())
    }

    /// The `name` of a property or object, as it is called today.
    fn name(&mut self, file: &File, node: Node) -> Result<Option<String>, Diagnostic> {
        let name = file.attribute_if_any(node, "name", &mut self.variables)?;
        Ok(name.map(|n| upgrade::name(n.value, file.version)))
    }

    fn property(&mut self, file: &File, node: Node) -> Result<Property, Diagnostic> {
        let tag = node.tag_name().name();
        let origin = file.origin(tag_range(node));
        let Some(name) = self.name(file, node)? else {
            return Err(file.error(format!("<{tag}> lacks the attribute `name`"), tag_range(node)));
        };
        if tag == "transform" {
            file.check_attributes(node, &["name"])?;
            let value = Value::Transform(Box::new(transform::parse(file, node, &mut self.variables)?));
            return Ok(Property { name, value, value_origin: origin.clone(), origin });
        }
        file.check_leaf(node, value::attributes(tag))?;
        let value = if tag == "spectrum" && node.has_attribute("filename") {
            self.spectrum_file(file, node)?
        } else {
            value::parse(file, node, &mut self.variables)?
        };
        let range = node.attribute_node("value").map_or(tag_range(node), |a| a.range_value());
        Ok(Property { name, value, origin, value_origin: file.origin(range) })
    }

    fn spectrum_file(&mut self, file: &File, node: Node) -> Result<Value, Diagnostic> {
        let name = file.attribute(node, "filename", &mut self.variables)?;
        let origin = file.origin(name.range);
        let bytes = self.read(&name.value, LARGEST_SPECTRUM, &origin)?.1;
        let curve = Curve::parse_file(&String::from_utf8_lossy(&bytes)).map_err(|why| {
            super::tree::error(format!("`{}` is no spectrum: {why}", suggest::shorten(&name.value)), &origin)
        })?;
        Ok(Value::Spectrum(curve))
    }

    /// A file that the scene names, and where it was found.
    fn read(&self, name: &str, limit: u64, origin: &Origin) -> Result<(PathBuf, Vec<u8>), Diagnostic> {
        let found = self.paths.find(name);
        match found.and_then(|path| files::read(&path, limit).map(|bytes| (path, bytes))) {
            Ok(read) => Ok(read),
            Err(why) => {
                let name = suggest::shorten(name);
                Err(super::tree::error(format!("cannot read the file `{name}`: {why}"), origin))
            }
        }
    }

    fn default(&mut self, file: &File, node: Node) -> Result<(), Diagnostic> {
        file.check_leaf(node, &["name", "value"])?;
        let name = file.attribute(node, "name", &mut self.variables)?;
        if name.value.is_empty() {
            return Err(file.error("a variable needs a name", tag_range(node)));
        }
        let value = file.attribute(node, "value", &mut self.variables)?;
        self.variables.default(name.value, value.value);
        Ok(())
    }

    fn path(&mut self, file: &File, node: Node, level: Level) -> Result<(), Diagnostic> {
        file.check_leaf(node, &["value"])?;
        if level.tags > 0 {
            return Err(file.error("<path> can only stand in <scene>", tag_range(node)));
        }
        let text = file.attribute(node, "value", &mut self.variables)?;
        self.paths.add(&text.value).map_err(|why| {
            let name = suggest::shorten(&text.value);
            file.error(format!("cannot look for files in `{name}`: {why}"), text.range.clone())
        })
    }

    fn alias(&mut self, file: &File, node: Node) -> Result<(), Diagnostic> {
        file.check_leaf(node, &["id", "as"])?;
        let id = file.attribute(node, "id", &mut self.variables)?;
        let alias = file.attribute(node, "as", &mut self.variables)?;
        let origin = file.origin(id.range);
        if self.tree.aliases.insert(alias.value.clone(), (id.value, origin)).is_some()
            || self.tree.ids.contains_key(&alias.value)
        {
            let message = format!("the id `{}` is given again", suggest::shorten(&alias.value));
            return Err(file.error(message, alias.range));
        }
        Ok(())
    }

    fn reference(&mut self, file: &File, node: Node) -> Result<Child, Diagnostic> {
        file.check_leaf(node, &["id", "name"])?;
        let id = file.attribute(node, "id", &mut self.variables)?;
        Ok(Child {
            name: self.name(file, node)?,
            target: Target::Id(id.value),
            origin: file.origin(id.range),
        })
    }

    /// Reads another file: what is in its scene, or the one object that it is.
    fn include(
        &mut self,
        file: &File,
        node: Node,
        level: Level,
        object: &mut Object,
    ) -> Result<(), Diagnostic> {
        file.check_leaf(node, &["filename"])?;
        let name = file.attribute(node, "filename", &mut self.variables)?;
        let origin = file.origin(name.range);
        self.files += 1;
        if level.files >= DEEPEST_FILE || self.files > MOST_FILES {
            let hint = "does a file include itself?";
            return Err(super::tree::error("too many files are included", &origin).hint(hint));
        }
        let (path, bytes) = self.read(&name.value, crate::LARGEST_SCENE_FILE, &origin)?;
        self.bytes += bytes.len() as u64;
        if self.bytes > MOST_BYTES {
            return Err(super::tree::error("the included files are too large together", &origin));
        }
        let shown: Arc<str> = path.display().to_string().into();
        let Ok(text) = std::str::from_utf8(&bytes) else {
            let message = format!("`{shown}` is not UTF-8 text");
            return Err(super::tree::error(message, &origin).hint("save the file with the encoding UTF-8"));
        };
        let source = Source::new(&shown, text);
        let document = document::parse(&source)?;
        let root = document.root_element();
        let level = Level { files: level.files + 1, ..level };
        if root.tag_name().name() == "scene" {
            let included = File { source: &source, version: version(&source, root)? };
            return self.content(&included, root, level, object);
        }
        self.child(&File { source: &source, version: file.version }, root, level, object)
    }
}

/// The version that a scene is written for.
fn version(source: &Source, root: Node) -> Result<Version, Diagnostic> {
    let Some(attribute) = root.attribute_node("version") else {
        let origin = source.origin(tag_range(root));
        let error = super::tree::error("<scene> lacks the attribute `version`", &origin);
        return Err(error.hint("such as version=\"3.0.0\""));
    };
    let mut parts = attribute.value().trim().split('.').map(str::parse::<u32>);
    match (parts.next(), parts.next(), parts.all(|part| part.is_ok())) {
        (Some(Ok(major)), Some(Ok(minor)), true) => Ok((major, minor)),
        _ => {
            let message = format!("`{}` is no version", suggest::shorten(attribute.value()));
            Err(super::tree::error(message, &source.origin(attribute.range_value())).hint("such as 3.0.0"))
        }
    }
}

fn unknown_tag(file: &File, node: Node) -> Diagnostic {
    let tag = node.tag_name().name();
    let error = file.error(format!("unknown tag <{}>", suggest::shorten(tag)), tag_range(node));
    let others = ["transform", "default", "path", "alias", "include", "ref"];
    let tags = Class::tags().chain(value::TAGS.iter().copied()).chain(others);
    match suggest::nearest(tag, tags) {
        Some(candidate) => error.hint(format!("did you mean <{candidate}>?")),
        None if transform::is_operation(tag) => error.hint("it belongs inside of a <transform>"),
        None => error,
    }
}
