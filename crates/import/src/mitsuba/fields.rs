//! Typed access to an object's properties and children, and account of those that nobody asked for.

use caustica_math::{Rgb, Transform, Vec3};
use caustica_scene::{Diagnostic, Origin};

use super::class::Class;
use super::context::Context;
use super::spectrum::Role;
use super::tree::{Child, Object, Property, Tree, Value, error};
use crate::nori::range::Bounds;
use crate::suggest::{self, shorten};

/// An object while its plugin reads it.
pub(super) struct Fields<'t> {
    pub(super) object: &'t Object,
    tree: &'t Tree,
    /// Which properties were asked for.
    used: Vec<bool>,
    /// Which children were asked for.
    taken: Vec<bool>,
    /// All names that were asked for.
    known: Vec<&'static str>,
    warnings: Vec<Diagnostic>,
}

impl<'t> Fields<'t> {
    pub(super) fn new(tree: &'t Tree, index: usize) -> Self {
        let object = &tree.objects[index];
        Self {
            object,
            tree,
            used: vec![false; object.properties.len()],
            taken: vec![false; object.children.len()],
            known: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// The name of the plugin.
    pub(super) fn plugin(&self) -> &'t str {
        &self.object.plugin
    }

    /// An error about the whole object.
    pub(super) fn error(&self, message: impl Into<String>) -> Diagnostic {
        error(message, &self.object.origin)
    }

    /// Where the value of a property is, or the object if it has none of that name.
    pub(super) fn place_of(&self, name: &str) -> &'t Origin {
        let property = self.object.properties.iter().rfind(|p| p.name == name);
        property.map_or(&self.object.origin, |p| &p.value_origin)
    }

    /// A warning about the type of the object.
    pub(super) fn warn(&mut self, message: impl Into<String>) {
        self.warn_at(message, &self.object.plugin_origin);
    }

    pub(super) fn warn_at(&mut self, message: impl Into<String>, origin: &Origin) {
        self.warnings.push(Diagnostic::warning(message).at(Some(origin.clone())));
    }

    /// What the object is, for messages.
    pub(super) fn title(&self) -> String {
        match self.plugin() {
            "" => self.object.class.tag().to_owned(),
            plugin => format!("{} `{}`", self.object.class.tag(), shorten(plugin)),
        }
    }

    /// The error for a `type` that is not among the plugins.
    pub(super) fn unknown_plugin(&self, plugins: &[&str]) -> Diagnostic {
        let message = format!("unknown {}", self.title());
        error(message, &self.object.plugin_origin).hint(suggest::hint(self.plugin(), plugins))
    }

    /// The error for a property that must be there.
    pub(super) fn missing(&self, name: &str, kind: &str) -> Diagnostic {
        self.error(format!("the {} needs {kind} `{name}`", self.title()))
    }

    /// The property of that name: the last one, if there are several.
    pub(super) fn find(&mut self, name: &'static str) -> Option<&'t Property> {
        self.known.push(name);
        let mut found: Option<&'t Property> = None;
        for (property, used) in self.object.properties.iter().zip(&mut self.used) {
            if property.name != name {
                continue;
            }
            *used = true;
            if let Some(earlier) = found {
                let message = format!("`{name}` is given again and this value is not used");
                self.warnings.push(Diagnostic::warning(message).at(Some(earlier.origin.clone())));
            }
            found = Some(property);
        }
        found
    }

    /// Accepts properties that say nothing about the picture.
    pub(super) fn ignore(&mut self, names: &[&'static str]) {
        for name in names {
            self.find(name);
        }
    }

    /// Warns of properties that are understood and not followed.
    pub(super) fn unsupported(&mut self, names: &[&'static str]) {
        for name in names {
            let origin = self.find(name).map(|p| p.origin.clone());
            let child = self.take(|child, _| child.name.as_deref() == Some(*name)).first().map(|c| c.0);
            if let Some(origin) = origin.or(child.map(|c| c.origin.clone())) {
                let message =
                    format!("`{name}` of the {} is not supported yet; it is left out", self.title());
                self.warn_at(message, &origin);
            }
        }
    }

    fn get<T>(
        &mut self,
        name: &'static str,
        kind: &str,
        pick: impl Fn(&'t Value) -> Option<T>,
    ) -> Result<Option<(T, &'t Property)>, Diagnostic> {
        let Some(property) = self.find(name) else { return Ok(None) };
        match pick(&property.value) {
            Some(value) => Ok(Some((value, property))),
            None => {
                let message = format!("`{name}` must be {kind}, but is {}", property.value.kind());
                Err(error(message, &property.origin))
            }
        }
    }

    /// An integer in a range, if it is there.
    pub(super) fn integer(
        &mut self,
        name: &'static str,
        range: std::ops::RangeInclusive<i64>,
    ) -> Result<Option<i64>, Diagnostic> {
        let pick = |v: &Value| if let Value::Integer(i) = v { Some(*i) } else { None };
        let Some((value, property)) = self.get(name, "an integer", pick)? else { return Ok(None) };
        if range.contains(&value) {
            return Ok(Some(value));
        }
        let (least, most) = (range.start(), range.end());
        let message = format!("`{name}` must be from {least} to {most}, but is {value}");
        Err(error(message, &property.value_origin))
    }

    pub(super) fn boolean(&mut self, name: &'static str, default: bool) -> Result<bool, Diagnostic> {
        let pick = |v: &Value| if let Value::Boolean(b) = v { Some(*b) } else { None };
        Ok(self.get(name, "a boolean", pick)?.map_or(default, |(b, _)| b))
    }

    /// A number within bounds, if it is there. An integer will do.
    pub(super) fn float_if_any(
        &mut self,
        name: &'static str,
        bounds: Bounds,
    ) -> Result<Option<f32>, Diagnostic> {
        let pick = |v: &Value| match v {
            Value::Float(f) => Some(*f),
            Value::Integer(i) => Some(*i as f64),
            _ => None,
        };
        let Some((value, property)) = self.get(name, "a float", pick)? else { return Ok(None) };
        match bounds.check(value) {
            Ok(value) => Ok(Some(value)),
            Err(rule) => Err(error(format!("`{name}` {rule}, but is {value}"), &property.value_origin)),
        }
    }

    pub(super) fn float(
        &mut self,
        name: &'static str,
        default: f32,
        bounds: Bounds,
    ) -> Result<f32, Diagnostic> {
        Ok(self.float_if_any(name, bounds)?.unwrap_or(default))
    }

    pub(super) fn string(
        &mut self,
        name: &'static str,
    ) -> Result<Option<(&'t str, &'t Property)>, Diagnostic> {
        self.get(name, "a string", |v| if let Value::String(s) = v { Some(s.as_str()) } else { None })
    }

    /// A string that must be one of a few.
    pub(super) fn choice(
        &mut self,
        name: &'static str,
        choices: &[&'static str],
    ) -> Result<Option<(&'static str, &'t Property)>, Diagnostic> {
        let Some((text, property)) = self.string(name)? else { return Ok(None) };
        match choices.iter().find(|c| c.eq_ignore_ascii_case(text)) {
            Some(choice) => Ok(Some((choice, property))),
            None => {
                let message = format!("unknown `{name}` `{}`", shorten(text));
                Err(error(message, &property.value_origin).hint(suggest::hint(text, choices)))
            }
        }
    }

    /// A `filename` that must be there.
    pub(super) fn file_name(&mut self) -> Result<(&'t str, &'t Property), Diagnostic> {
        match self.string("filename")? {
            Some(("", property)) => Err(error("`filename` is empty", &property.value_origin)),
            Some(found) => Ok(found),
            None => Err(self.missing("filename", "the string")),
        }
    }

    pub(super) fn transform_if_any(&mut self, name: &'static str) -> Result<Option<Transform>, Diagnostic> {
        let pick = |v: &Value| if let Value::Transform(t) = v { Some(**t) } else { None };
        Ok(self.get(name, "a transform", pick)?.map(|(t, _)| t))
    }

    pub(super) fn transform(&mut self, name: &'static str) -> Result<Transform, Diagnostic> {
        Ok(self.transform_if_any(name)?.unwrap_or(Transform::IDENTITY))
    }

    /// A point in space, if it is there.
    pub(super) fn point(&mut self, name: &'static str) -> Result<Option<[f32; 3]>, Diagnostic> {
        let pick = |v: &Value| if let Value::Point(p) | Value::Vector(p) = v { Some(*p) } else { None };
        let Some((values, property)) = self.get(name, "a point", pick)? else { return Ok(None) };
        let point = values.map(|v| v as f32);
        if point.iter().all(|c| c.is_finite()) {
            return Ok(Some(point));
        }
        Err(error(format!("`{name}` is too large"), &property.value_origin))
    }

    /// A direction of any length but zero, if it is there.
    pub(super) fn direction(&mut self, name: &'static str) -> Result<Option<[f32; 3]>, Diagnostic> {
        let Some(d) = self.point(name)? else { return Ok(None) };
        if Vec3::new(d[0], d[1], d[2]).try_normalized().is_some() {
            return Ok(Some(d));
        }
        Err(error(format!("the direction `{name}` has no length"), self.place_of(name)))
    }

    /// A colour of a property, if it is there.
    pub(super) fn color(&mut self, name: &'static str, role: Role) -> Result<Option<Rgb>, Diagnostic> {
        let Some(property) = self.find(name) else { return Ok(None) };
        let color = match &property.value {
            Value::Rgb(c) => Rgb(c.map(|v| v as f32)),
            Value::Float(f) => Rgb::splat(*f as f32),
            Value::Integer(i) => Rgb::splat(*i as f32),
            Value::Spectrum(curve) => {
                let (color, clipped) = curve.rgb(role);
                if clipped {
                    let message = format!(
                        "the spectrum `{name}` is outside of what red, green and blue can show; it is clipped"
                    );
                    self.warn_at(message, &property.value_origin);
                }
                color
            }
            other => {
                let message = format!("`{name}` must be a color, but is {}", other.kind());
                return Err(error(message, &property.origin));
            }
        };
        if !color.is_valid() {
            return Err(error(format!("`{name}` must be finite and not negative"), &property.value_origin));
        }
        if role == Role::Reflectance && color.max_channel() > 1.0 {
            let message = format!("`{name}` is more than 1: it reflects more light than it gets");
            self.warn_at(message, &property.value_origin);
        }
        Ok(Some(color))
    }

    /// The objects of a class inside of this one, by their place in the tree.
    pub(super) fn children(&mut self, class: Class) -> Vec<(&'t Child, usize)> {
        self.take(|_, object| object.class == class)
    }

    /// The object of a class inside of this one, of which there may be one.
    pub(super) fn child(&mut self, class: Class) -> Result<Option<usize>, Diagnostic> {
        let children = self.children(class);
        match children.get(1) {
            Some((second, _)) => {
                let message = format!("the {} has more than one {}", self.title(), class.tag());
                Err(error(message, &second.origin))
            }
            None => Ok(children.first().map(|(_, index)| *index)),
        }
    }

    /// The texture or spectrum of that name.
    pub(super) fn texture(&mut self, name: &'static str) -> Option<usize> {
        self.known.push(name);
        let found = self.take(|child, object| object.class.is_color() && child.name.as_deref() == Some(name));
        found.last().map(|(_, index)| *index)
    }

    /// The texture inside of this one, whatever its name.
    pub(super) fn any_texture(&mut self) -> Option<usize> {
        self.take(|_, object| object.class == Class::Texture).last().map(|(_, index)| *index)
    }

    fn take(&mut self, wanted: impl Fn(&Child, &Object) -> bool) -> Vec<(&'t Child, usize)> {
        let mut found = Vec::new();
        for ((child, index), taken) in self.tree.children(self.object).zip(&mut self.taken) {
            if !*taken && wanted(child, &self.tree.objects[index]) {
                *taken = true;
                found.push((child, index));
            }
        }
        found
    }

    /// Ends the reading of an object of which nothing but its kind is understood.
    pub(super) fn finish_unread(mut self, cx: &mut Context) {
        self.warnings.drain(..).for_each(|w| cx.push(w));
    }

    /// Ends the reading: what nobody asked for gets warnings.
    pub(super) fn finish(mut self, cx: &mut Context) {
        let title = self.title();
        self.warnings.drain(..).for_each(|w| cx.push(w));
        for (property, _) in self.object.properties.iter().zip(&self.used).filter(|(_, used)| !**used) {
            let message = format!("unknown property `{}` of the {title}", shorten(&property.name));
            cx.push(self.with_hint(Diagnostic::warning(message), &property.name, &property.origin));
        }
        for ((child, index), _) in self.tree.children(self.object).zip(&self.taken).filter(|(_, t)| !**t) {
            let what = Fields::new(self.tree, index).title();
            let name = child.name.as_deref().unwrap_or_default();
            let message = format!("the {what} is nothing to a {title}; it is left out");
            cx.push(self.with_hint(Diagnostic::warning(message), name, &child.origin));
        }
    }

    fn with_hint(&self, warning: Diagnostic, name: &str, origin: &Origin) -> Diagnostic {
        let warning = warning.at(Some(origin.clone()));
        match suggest::nearest(name, self.known.iter().copied()) {
            Some(near) if near != name => warning.hint(format!("did you mean `{near}`?")),
            _ => warning,
        }
    }
}

impl Fields<'_> {
    /// Whether there is a texture of that name.
    pub(super) fn has_texture(&self, name: &str) -> bool {
        let mut children = self.tree.children(self.object);
        children.any(|(c, i)| c.name.as_deref() == Some(name) && self.tree.objects[i].class.is_color())
    }

    /// Counts all that is left as asked for.
    pub(super) fn take_rest(&mut self) {
        self.used.fill(true);
        self.taken.fill(true);
    }
}
