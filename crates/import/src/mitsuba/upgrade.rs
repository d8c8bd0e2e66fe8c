//! Scenes of versions before 2.0, as today's: what Mitsuba's documentation lists as changed.

use caustica_math::Transform;

use super::class::Class;
use super::file::Version;
use super::tree::{Object, Property, Value};

const UNDERSCORES: Version = (2, 0);

/// Tags that were called otherwise.
pub(super) fn tag(tag: &str) -> &str {
    match tag {
        "luminaire" => "emitter",
        "camera" => "sensor",
        _ => tag,
    }
}

/// A name in lower case with underscores, where it has capitals: `toWorld` is `to_world`, `intIOR` is `int_ior`.
pub(super) fn name(name: String, version: Version) -> String {
    if version >= UNDERSCORES {
        return name;
    }
    let mut result = String::with_capacity(name.len() + 4);
    let mut after_capital = true;
    for c in name.chars() {
        if c.is_ascii_uppercase() && !after_capital {
            result.push('_');
        }
        after_capital = c.is_ascii_uppercase();
        result.push(c.to_ascii_lowercase());
    }
    result
}

/// Plugins that were called otherwise.
pub(super) fn plugin(class: Class, plugin: String, version: Version) -> String {
    if version >= UNDERSCORES {
        return plugin;
    }
    match (class, plugin.as_str()) {
        (Class::Texture, "gridtexture") => "grid".into(),
        (Class::Texture, "vertexcolors") => "mesh_attribute".into(),
        (Class::Integrator, "path_simple") => "path".into(),
        _ => plugin,
    }
}

/// Properties that were called otherwise, or were several.
pub(super) fn object(object: &mut Object, version: Version) {
    if version >= UNDERSCORES {
        return;
    }
    let renamed: &[(&str, &str)] = match (object.class, object.plugin.as_str()) {
        (Class::Bsdf, "diffuse") => &[("diffuse_reflectance", "reflectance")],
        (Class::Integrator, "direct") => &[("luminaire_samples", "emitter_samples")],
        (Class::Emitter, "spot") => &[("cutoff", "cutoff_angle")],
        _ => &[],
    };
    let names = object.properties.iter_mut().map(|p| &mut p.name);
    for name in names.chain(object.children.iter_mut().filter_map(|c| c.name.as_mut())) {
        if let Some((_, new)) = renamed.iter().find(|(old, _)| old == name) {
            *name = (*new).to_owned();
        }
    }
    if object.class == Class::Texture {
        join_uv(object);
    }
    // Metals were copper if nothing else was said, and are perfect mirrors now.
    let is_metal = object.class == Class::Bsdf && object.plugin.ends_with("conductor");
    if is_metal && !object.properties.iter().any(|p| ["material", "eta", "k"].contains(&p.name.as_str())) {
        let origin = object.origin.clone();
        let value = Value::String("Cu".into());
        object.properties.push(Property {
            name: "material".into(),
            value,
            value_origin: origin.clone(),
            origin,
        });
    }
}

/// Scales and offsets of texture coordinates to one transform.
fn join_uv(object: &mut Object) {
    let is_uv =
        |p: &Property| ["uscale", "vscale", "uoffset", "voffset", "uvscale"].contains(&p.name.as_str());
    let (uv, rest): (Vec<Property>, Vec<Property>) =
        std::mem::take(&mut object.properties).into_iter().partition(is_uv);
    object.properties = rest;
    let Some(first) = uv.first() else { return };
    let (origin, value_origin) = (first.origin.clone(), first.value_origin.clone());
    let get = |names: [&str; 2], missing| {
        let found = uv.iter().find(|p| names.contains(&p.name.as_str())).map(|p| &p.value);
        match found {
            Some(Value::Float(x)) => *x,
            Some(Value::Integer(i)) => *i as f64,
            _ => missing,
        }
    };
    let scale = Transform::scale([get(["uscale", "uvscale"], 1.0), get(["vscale", "uvscale"], 1.0), 1.0]);
    let offset = Transform::translate([get(["uoffset", ""], 0.0), get(["voffset", ""], 0.0), 0.0]);
    let value = Value::Transform(Box::new(scale.then(offset)));
    object.properties.push(Property { name: "to_uv".into(), value, origin, value_origin });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_old() {
        let new = |old: &str| name(old.into(), (0, 6));
        for (old, today) in [
            ("toWorld", "to_world"),
            ("intIOR", "int_ior"),
            ("maxDepth", "max_depth"),
            ("cropOffsetX", "crop_offset_x"),
            ("alpha", "alpha"),
            ("B", "b"),
            ("specularReflectance", "specular_reflectance"),
        ] {
            assert_eq!(new(old), today);
        }
        assert_eq!(name("toWorld".into(), (3, 0)), "toWorld");
    }
}
