//! `shapegroup` and `instance`.

use caustica_scene::Diagnostic;
use caustica_scene::description::{Group, GroupId, Instance};

use super::class::Class;
use super::context::Context;
use super::fields::Fields;
use super::shape;
use super::tree::error;

/// The group of a `shapegroup`, which is made once; nothing if it has no shapes.
pub(super) fn group(index: usize, cx: &mut Context) -> Result<Option<GroupId>, Diagnostic> {
    if let Some(known) = cx.groups.get(&index) {
        return Ok(*known);
    }
    let mut fields = Fields::new(cx.tree, index);
    let mut shapes = Vec::new();
    for (child, inner) in fields.children(Class::Shape) {
        if ["shapegroup", "instance"].contains(&cx.tree.objects[inner].plugin.as_str()) {
            let message = "a shapegroup holds no instances and no other shapegroup";
            return Err(error(message, &child.origin).hint("instance each group by itself"));
        }
        let (meters, lights) = (cx.meters.len(), cx.description.lights.len());
        let Some(shape) = shape::read_surface(Fields::new(cx.tree, inner), cx)? else { continue };
        if shape.emission.is_some() || cx.description.lights.len() > lights {
            let message = format!("the lamp `{}` stands in a shapegroup", shape.name);
            return Err(
                error(message, &child.origin).hint("what has instances cannot emit: put it beside them")
            );
        }
        if cx.meters.len() > meters {
            let message = format!("`{}` with its sensor stands in a shapegroup", shape.name);
            return Err(error(message, &child.origin).hint("a meter is in one place: put it beside them"));
        }
        shapes.push(shape);
    }
    if let Some(property) = fields.find("to_world") {
        let message = "`to_world` of a shapegroup says nothing: its shapes and its instances have their own";
        fields.warn_at(message, &property.origin);
    }
    if shapes.is_empty() {
        fields.warn("the shapegroup has no shapes: its instances show nothing");
    }
    let name = fields.object.id.clone().unwrap_or_else(|| "a shapegroup".to_owned());
    let origin = Some(fields.object.origin.clone());
    fields.finish(cx);
    let groups = &mut cx.description.groups;
    let id = (!shapes.is_empty()).then(|| {
        groups.push(Group { name, shapes, origin });
        GroupId(groups.len() as u32 - 1)
    });
    cx.groups.insert(index, id);
    Ok(id)
}

pub(super) fn read(mut fields: Fields, cx: &mut Context) -> Result<(), Diagnostic> {
    let to_world = fields.transform("to_world")?;
    let index = match fields.children(Class::Shape)[..] {
        [(_, index)] if cx.tree.objects[index].plugin == "shapegroup" => index,
        [(child, index)] => {
            let other = Fields::new(cx.tree, index).title();
            return Err(error(
                format!("an instance shows a shapegroup, but this is a {other}"),
                &child.origin,
            ));
        }
        [] => {
            let hint = "refer to one: <ref id=\"…\"/>";
            return Err(fields.error("the instance names no shapegroup").hint(hint));
        }
        [_, (second, _), ..] => return Err(error("an instance shows one shapegroup", &second.origin)),
    };
    let origin = Some(fields.object.origin.clone());
    fields.finish(cx);
    if let Some(group) = group(index, cx)? {
        cx.description.instances.push(Instance { group, to_world, origin });
    }
    Ok(())
}
