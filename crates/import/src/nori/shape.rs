//! `<mesh>`.

use std::path::Path;

use caustica_math::Vec3;
use caustica_scene::Diagnostic;
use caustica_scene::description::{Geometry, Shape};

use super::class::Class;
use super::context::Context;
use super::fields::Fields;
use super::range::Bounds;
use super::tree::Object;
use super::{bsdf, emitter};

const SHAPES: &[&str] = &["obj", "sphere"];

pub(super) fn read(object: &Object, cx: &mut Context) -> Result<(), Diagnostic> {
    let mut fields = Fields::new(object, cx.place);
    let (geometry, name) = match object.plugin.as_str() {
        "obj" => {
            let (file, property) = fields.file_name()?;
            let name = Path::new(file).file_name().map_or(file.into(), |n| n.to_string_lossy());
            (Geometry::Mesh(cx.mesh(file, &property.value_range)?), name.into_owned())
        }
        "sphere" => {
            let [x, y, z] = fields.point(&["center"])?.unwrap_or_default();
            let radius = fields.float(&["radius"], 1.0, Bounds::Positive)?;
            (Geometry::Sphere { center: Vec3::new(x, y, z), radius }, "sphere".to_owned())
        }
        _ => return Err(fields.unknown_plugin(SHAPES)),
    };
    let to_world = fields.transform(&["toWorld"])?;
    let material = match fields.child(Class::Bsdf)? {
        Some(object) => bsdf::read(object, cx)?,
        None => cx.default_material(),
    };
    let emission = match fields.child(Class::Emitter)? {
        Some(object) => Some(emitter::read_area(object, cx)?),
        None => None,
    };
    fields.finish(cx)?;
    let name = object.names.first().cloned().unwrap_or(name);
    let origin = cx.origin(&object.range);
    cx.description.shapes.push(Shape { name, geometry, to_world, material, emission, origin });
    Ok(())
}
