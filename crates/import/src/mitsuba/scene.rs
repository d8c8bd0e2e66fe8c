//! `<scene>`.

use caustica_scene::Diagnostic;

use super::class::Class;
use super::context::Context;
use super::fields::Fields;
use super::{emitter, integrator, sensor, shape};

pub(super) fn read(root: usize, cx: &mut Context) -> Result<(), Diagnostic> {
    let mut fields = Fields::new(cx.tree, root);
    let sensors = fields.children(Class::Sensor);
    match fields.child(Class::Integrator)? {
        Some(index) => integrator::read(index, cx)?,
        None => cx.description.integrator = integrator::USUAL,
    }
    for (_, index) in fields.children(Class::Shape) {
        shape::read(index, cx)?;
    }
    choose_sensor(&mut fields, sensors.into_iter().map(|(_, sensor)| sensor).collect(), cx)?;
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

/// Reads the first sensor that there is a camera for, in the scene or else in a shape.
fn choose_sensor(fields: &mut Fields<'_>, of_scene: Vec<usize>, cx: &mut Context) -> Result<(), Diagnostic> {
    let of_shapes = std::mem::take(&mut cx.meters).into_iter().map(|(sensor, shape)| (sensor, Some(shape)));
    let all: Vec<_> = of_scene.into_iter().map(|sensor| (sensor, None)).chain(of_shapes).collect();
    let tree = cx.tree;
    let usable = |(sensor, _): &&(usize, Option<u32>)| sensor::is_supported(&tree.objects[*sensor].plugin);
    let Some((sensor, shape)) = all.iter().find(usable).or(all.first()).copied() else {
        return Err(fields.error("the scene has no sensor").hint("add a `<sensor type=\"perspective\">`"));
    };
    for (other, _) in all.iter().filter(|other| other.0 != sensor) {
        let object = &tree.objects[*other];
        let message = match sensor::is_supported(&object.plugin) {
            true => "there is more than one sensor; only the first is used".to_owned(),
            false => format!("the sensor `{}` is not supported; another one is used", object.plugin),
        };
        fields.warn_at(message, &object.origin);
    }
    sensor::read(sensor, shape, cx)
}

fn plural(class: Class) -> &'static str {
    match class {
        Class::Phase => "phase functions",
        Class::Volume => "volumes",
        _ => "participating media",
    }
}
