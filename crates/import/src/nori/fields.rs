//! Typed access to an object's properties and children, and account of those that nobody asked for.

use caustica_math::{Rgb, Transform};
use caustica_scene::Diagnostic;

use super::class::Class;
use super::context::Context;
use super::range::{Bounds, Radiometry};
use super::tree::{Object, Place, Property};
use super::value::Value;
use crate::suggest::{self, shorten};

/// An object while its plugin reads it. Names that are lists have aliases; the first is the usual one.
pub(super) struct Fields<'o, 'p> {
    object: &'o Object,
    place: Place<'p>,
    /// Which properties were asked for.
    used: Vec<bool>,
    /// Which children were asked for.
    taken: Vec<bool>,
    /// All property names that were asked for.
    known: Vec<&'static str>,
    warnings: Vec<Diagnostic>,
}

impl<'o, 'p> Fields<'o, 'p> {
    pub(super) fn new(object: &'o Object, place: Place<'p>) -> Self {
        Self {
            object,
            place,
            used: vec![false; object.properties.len()],
            taken: vec![false; object.children.len()],
            known: Vec::new(),
            warnings: Vec::new(),
        }
    }

    /// An error about the whole object.
    pub(super) fn error(&self, message: impl Into<String>) -> Diagnostic {
        self.place.error(message, self.object.range.clone())
    }

    /// An error about the value of a property.
    pub(super) fn error_in(&self, property: &Property, message: impl Into<String>) -> Diagnostic {
        self.place.error(message, property.value_range.clone())
    }

    /// A warning about the value of a property.
    pub(super) fn warn_in(&mut self, property: &Property, message: impl Into<String>) {
        let origin = self.place.source.origin(property.value_range.clone());
        self.warnings.push(Diagnostic::warning(message).at(Some(origin)));
    }

    /// What the object is, for messages.
    pub(super) fn title(&self) -> String {
        match self.object.plugin.as_str() {
            "" => self.object.class.tag().to_owned(),
            plugin => format!("{} `{}`", self.object.class.tag(), shorten(plugin)),
        }
    }

    /// The error for a `type` that is not among the plugins.
    pub(super) fn unknown_plugin(&self, plugins: &[&str]) -> Diagnostic {
        let message = format!("unknown {}", self.title());
        let hint = suggest::hint(&self.object.plugin, plugins);
        self.place.error(message, self.object.plugin_range.clone()).hint(hint)
    }

    /// The error for a `type` that is known and deliberately left out.
    pub(super) fn unsupported(&self) -> Diagnostic {
        let range = self.object.plugin_range.clone();
        self.place.error(format!("the {} is not supported yet", self.title()), range)
    }

    /// The property of that name: the last one, if there are several.
    pub(super) fn find(&mut self, names: &[&'static str]) -> Option<&'o Property> {
        self.known.extend_from_slice(names);
        let mut found: Option<&'o Property> = None;
        for (property, used) in self.object.properties.iter().zip(&mut self.used) {
            if !names.contains(&property.name.as_str()) {
                continue;
            }
            *used = true;
            if let Some(earlier) = found {
                let message = format!("`{}` is given again and this value is not used", earlier.name);
                let origin = self.place.source.origin(earlier.range.clone());
                self.warnings.push(Diagnostic::warning(message).at(Some(origin)));
            }
            found = Some(property);
        }
        found
    }

    fn get<T>(
        &mut self,
        names: &[&'static str],
        kind: &str,
        pick: impl Fn(&'o Value) -> Option<T>,
    ) -> Result<Option<(T, &'o Property)>, Diagnostic> {
        let Some(property) = self.find(names) else { return Ok(None) };
        match pick(&property.value) {
            Some(value) => Ok(Some((value, property))),
            None => {
                let message = format!("`{}` must be {kind}, but is {}", property.name, property.value.kind());
                Err(self.place.error(message, property.range.clone()))
            }
        }
    }

    /// The error for a property that must be there.
    pub(super) fn missing(&self, name: &str, kind: &str) -> Diagnostic {
        self.error(format!("the {} needs {kind} `{name}`", self.title()))
    }

    /// An integer in a range, if it is there.
    pub(super) fn integer(
        &mut self,
        names: &[&'static str],
        range: std::ops::RangeInclusive<i64>,
    ) -> Result<Option<i64>, Diagnostic> {
        let pick = |v: &Value| if let Value::Integer(i) = v { Some(*i) } else { None };
        let Some((value, property)) = self.get(names, "an integer", pick)? else { return Ok(None) };
        if range.contains(&value) {
            return Ok(Some(value));
        }
        let (least, most) = (range.start(), range.end());
        let name = &property.name;
        Err(self.error_in(property, format!("`{name}` must be from {least} to {most}, but is {value}")))
    }

    /// A number within bounds, if it is there.
    pub(super) fn float_if_any(
        &mut self,
        names: &[&'static str],
        bounds: Bounds,
    ) -> Result<Option<f32>, Diagnostic> {
        let pick = |v: &Value| if let Value::Float(f) = v { Some(*f) } else { None };
        let Some((value, property)) = self.get(names, "a float", pick)? else { return Ok(None) };
        match bounds.check(value) {
            Ok(value) => Ok(Some(value)),
            Err(rule) => Err(self.error_in(property, format!("`{}` {rule}, but is {value}", property.name))),
        }
    }

    pub(super) fn float(
        &mut self,
        names: &[&'static str],
        default: f32,
        bounds: Bounds,
    ) -> Result<f32, Diagnostic> {
        Ok(self.float_if_any(names, bounds)?.unwrap_or(default))
    }

    pub(super) fn string(
        &mut self,
        names: &[&'static str],
    ) -> Result<Option<(&'o str, &'o Property)>, Diagnostic> {
        self.get(names, "a string", |v| if let Value::String(s) = v { Some(s.as_str()) } else { None })
    }

    /// A `filename` that must be there.
    pub(super) fn file_name(&mut self) -> Result<(&'o str, &'o Property), Diagnostic> {
        match self.string(&["filename"])? {
            Some(("", property)) => Err(self.error_in(property, "`filename` is empty")),
            Some(found) => Ok(found),
            None => Err(self.missing("filename", "the string")),
        }
    }

    pub(super) fn transform(&mut self, names: &[&'static str]) -> Result<Transform, Diagnostic> {
        let pick = |v: &Value| if let Value::Transform(t) = v { Some(**t) } else { None };
        Ok(self.get(names, "a transform", pick)?.map_or(Transform::IDENTITY, |(t, _)| t))
    }

    /// A point in space, if it is there.
    pub(super) fn point(&mut self, names: &[&'static str]) -> Result<Option<[f32; 3]>, Diagnostic> {
        let found = self.get(names, "a point", |v| if let Value::Point(p) = v { Some(p) } else { None })?;
        found.map(|(values, property)| self.tuple(values, property)).transpose()
    }

    /// A direction of any length but zero, if it is there. Forks write some as points.
    pub(super) fn direction(&mut self, names: &[&'static str]) -> Result<Option<[f32; 3]>, Diagnostic> {
        let Some((values, property)) = self.get(names, "a vector", coordinates)? else { return Ok(None) };
        let direction = self.tuple::<3>(values, property)?;
        if caustica_math::Vec3::new(direction[0], direction[1], direction[2]).try_normalized().is_none() {
            return Err(self.error_in(property, format!("the direction `{}` has no length", property.name)));
        }
        Ok(Some(direction))
    }

    /// Two coordinates, if they are there. Forks write them as points or vectors.
    pub(super) fn pair(
        &mut self,
        names: &[&'static str],
    ) -> Result<Option<([f32; 2], &'o Property)>, Diagnostic> {
        let Some((values, property)) = self.get(names, "a point or vector", coordinates)? else {
            return Ok(None);
        };
        Ok(Some((self.tuple(values, property)?, property)))
    }

    fn tuple<const N: usize>(&self, values: &[f64], property: &Property) -> Result<[f32; N], Diagnostic> {
        if values.len() != N {
            let message = format!("`{}` must have {N} coordinates, but has {}", property.name, values.len());
            return Err(self.error_in(property, message));
        }
        let mut tuple = [0.0; N];
        for (to, from) in tuple.iter_mut().zip(values) {
            *to = *from as f32;
            if !to.is_finite() {
                return Err(self.error_in(property, format!("`{}` is too large", property.name)));
            }
        }
        Ok(tuple)
    }

    /// A colour, if it is there.
    pub(super) fn color(
        &mut self,
        names: &[&'static str],
        radiometry: Radiometry,
    ) -> Result<Option<Rgb>, Diagnostic> {
        let pick = |v: &Value| if let Value::Color(c) = v { Some(*c) } else { None };
        let Some((values, property)) = self.get(names, "a color", pick)? else { return Ok(None) };
        self.check_color(values, property, radiometry).map(Some)
    }

    /// A colour or, as some forks have it, a number for a grey.
    pub(super) fn color_or_float(
        &mut self,
        names: &[&'static str],
        radiometry: Radiometry,
    ) -> Result<Option<Rgb>, Diagnostic> {
        let pick = |v: &Value| match v {
            Value::Color(c) => Some(*c),
            Value::Float(f) => Some([*f; 3]),
            _ => None,
        };
        let Some((values, property)) = self.get(names, "a color", pick)? else { return Ok(None) };
        self.check_color(values, property, radiometry).map(Some)
    }

    fn check_color(
        &mut self,
        values: [f64; 3],
        property: &Property,
        radiometry: Radiometry,
    ) -> Result<Rgb, Diagnostic> {
        let color = Rgb(values.map(|v| v as f32));
        let name = &property.name;
        if !color.is_valid() {
            return Err(self.error_in(property, format!("`{name}` must be finite and not negative")));
        }
        if color.max_channel() > 1.0 {
            match radiometry {
                Radiometry::Light => {}
                Radiometry::Reflectance => {
                    self.warn_in(
                        property,
                        format!("`{name}` is more than 1: it reflects more light than it gets"),
                    );
                }
                Radiometry::Share => {
                    return Err(self.error_in(property, format!("`{name}` may not be more than 1")));
                }
            }
        }
        Ok(color)
    }

    /// The objects of a class inside of this one.
    pub(super) fn children(&mut self, class: Class) -> Vec<&'o Object> {
        self.take(|child| child.class == class)
    }

    /// The object of a class inside of this one, of which there may be one.
    pub(super) fn child(&mut self, class: Class) -> Result<Option<&'o Object>, Diagnostic> {
        let children = self.children(class);
        match children.get(1) {
            Some(second) => Err(self.one_too_many(second)),
            None => Ok(children.first().copied()),
        }
    }

    /// The texture that is named as one of `names`, or that has no name.
    pub(super) fn texture(&mut self, names: &[&str]) -> Result<Option<&'o Object>, Diagnostic> {
        let textures = self.take(|child| {
            let named = child.names.iter().any(|n| names.contains(&n.as_str()));
            child.class == Class::Texture && (named || child.names.is_empty())
        });
        match textures.get(1) {
            Some(second) => Err(self.one_too_many(second)),
            None => Ok(textures.first().copied()),
        }
    }

    fn one_too_many(&self, second: &Object) -> Diagnostic {
        let message = format!("the {} has more than one {}", self.title(), second.class.tag());
        self.place.error(message, second.range.clone())
    }

    fn take(&mut self, wanted: impl Fn(&Object) -> bool) -> Vec<&'o Object> {
        let mut found = Vec::new();
        for (child, taken) in self.object.children.iter().zip(&mut self.taken) {
            if !*taken && wanted(child) {
                *taken = true;
                found.push(child);
            }
        }
        found
    }

    /// Ends the reading: objects that nobody asked for are errors, and properties are warnings.
    pub(super) fn finish(self, cx: &mut Context) -> Result<(), Diagnostic> {
        for (child, taken) in self.object.children.iter().zip(&self.taken) {
            if !taken {
                return Err(self.misplaced(child));
            }
        }
        let title = self.title();
        self.warnings.into_iter().for_each(|w| cx.warnings.push(w));
        for (property, used) in self.object.properties.iter().zip(&self.used) {
            if *used {
                continue;
            }
            let message = format!("unknown property `{}` of the {title}", shorten(&property.name));
            let warning = Diagnostic::warning(message).at(cx.origin(&property.range));
            cx.warnings.push(match suggest::nearest(&property.name, self.known.iter().copied()) {
                Some(name) => warning.hint(format!("did you mean `{name}`?")),
                None => warning,
            });
        }
        Ok(())
    }

    fn misplaced(&self, child: &Object) -> Diagnostic {
        if matches!(child.class, Class::Medium | Class::Phase) {
            return Fields::new(child, self.place).unsupported();
        }
        let what = Fields::new(child, self.place).title();
        let title = self.title();
        self.place.error(format!("a {what} cannot stand inside of a {title}"), child.range.clone())
    }
}

/// Coordinates, whether called a point or a vector.
fn coordinates(value: &Value) -> Option<&Vec<f64>> {
    match value {
        Value::Point(p) | Value::Vector(p) => Some(p),
        _ => None,
    }
}
