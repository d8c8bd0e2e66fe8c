//! `<scene>`.

use caustica_scene::Diagnostic;

use super::class::Class;
use super::context::Context;
use super::fields::Fields;
use super::{emitter, integrator, sensor, shape};

pub(super) fn read(root: usize, cx: &mut Context) -> Result<(), Diagnostic> {
    let mut fields = Fields::new(cx.tree, root);
    let sensors = fields.children(Class::Sensor);
    let Some((_, first)) = sensors.first() else { return Err(fields.error("the scene has no sensor")) };
    for (other, _) in &sensors[1..] {
        fields.warn_at("there is more than one sensor; only the first is used", &other.origin);
    }
    sensor::read(*first, cx)?;
    match fields.child(Class::Integrator)? {
        Some(index) => integrator::read(index, cx)?,
        None => cx.description.integrator = integrator::USUAL,
    }
    for (_, index) in fields.children(Class::Shape) {
        shape::read(index, cx)?;
    }
    for (_, index) in fields.children(Class::Emitter) {
        emitter::read_light(index, cx)?;
    }
    // They are there to be referred to.
    for class in [Class::Bsdf, Class::Texture, Class::Spectrum] {
        fields.children(class);
    }
    for class in [Class::Medium, Class::Phase, Class::Volume] {
        for (child, _) in fields.children(class) {
            let message = format!("{} are not supported yet; they are left out", plural(class));
            fields.warn_at(message, &child.origin);
        }
    }
    fields.finish(cx);
    Ok(())
}

fn plural(class: Class) -> &'static str {
    match class {
        Class::Phase => "phase functions",
        Class::Volume => "volumes",
        _ => "participating media",
    }
}
