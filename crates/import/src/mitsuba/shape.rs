//! `<shape>`.

use std::path::Path;

use caustica_math::{Transform, Vec3};
use caustica_scene::Diagnostic;
use caustica_scene::description::{Geometry, MaterialId, Mesh, Shape};

use super::class::Class;
use super::context::{Context, Format};
use super::fields::Fields;
use super::{bsdf, emitter, solids};
use crate::nori::range::Bounds;

const SHAPES: &[&str] = &["obj", "ply", "sphere", "rectangle", "disk", "cube", "cylinder"];
const UNSUPPORTED: &[&str] = &[
    "serialized",
    "shapegroup",
    "instance",
    "linearcurve",
    "bsplinecurve",
    "sdfgrid",
    "ellipsoids",
    "ellipsoidsmesh",
    "hair",
    "heightfield",
    "merge",
];

/// A surface in its own frame, and what moves that into the shape's.
struct Surface {
    geometry: Geometry,
    name: String,
    placed: Transform,
}

pub(super) fn read(index: usize, cx: &mut Context) -> Result<(), Diagnostic> {
    let mut fields = Fields::new(cx.tree, index);
    let plugin = fields.plugin();
    if UNSUPPORTED.contains(&plugin) {
        fields.warn(format!("the {} is not supported yet; it is left out", fields.title()));
        fields.finish_unread(cx);
        return Ok(());
    }
    let to_world = fields.transform("to_world")?;
    let flipped = fields.boolean("flip_normals", false)? ^ fields.boolean("flip_normal", false)?;
    let mut surface = surface(&mut fields, (to_world, flipped), cx)?;
    if let Geometry::Mesh(mesh) = &mut surface.geometry
        && flipped
    {
        flip(mesh);
    }
    let emitter = fields.child(Class::Emitter)?;
    let material = material(&mut fields, emitter.is_some(), cx)?;
    let emission = match emitter {
        Some(emitter) => emitter::read_area(emitter, cx)?,
        None => None,
    };
    for class in [Class::Medium, Class::Subsurface] {
        for (child, _) in fields.children(class) {
            fields.warn_at("participating media are not supported yet; it is left out", &child.origin);
        }
    }
    fields.unsupported(&["interior", "exterior"]);
    let place = cx.description.shapes.len() as u32;
    cx.meters.extend(fields.children(Class::Sensor).into_iter().map(|(_, sensor)| (sensor, place)));
    let name = fields.object.id.clone().unwrap_or(surface.name);
    let origin = Some(fields.object.origin.clone());
    fields.finish(cx);
    let (geometry, to_world) = (surface.geometry, surface.placed.then(to_world));
    cx.description.shapes.push(Shape { name, geometry, to_world, material, emission, origin });
    Ok(())
}

/// The shape's material: the last one, as several are allowed where an included part has one of its own.
fn material(fields: &mut Fields, is_lamp: bool, cx: &mut Context) -> Result<MaterialId, Diagnostic> {
    match fields.child(Class::Bsdf)? {
        Some(index) => bsdf::read(index, cx),
        None => Ok(cx.default_material(is_lamp)),
    }
}

fn surface(
    fields: &mut Fields,
    (to_world, flipped): (Transform, bool),
    cx: &mut Context,
) -> Result<Surface, Diagnostic> {
    let mesh =
        |mesh, name: &str, placed| Surface { geometry: Geometry::Mesh(mesh), name: name.into(), placed };
    let here = Transform::IDENTITY;
    Ok(match fields.plugin() {
        "obj" => file(fields, Format::Obj, &to_world, cx)?,
        "ply" => file(fields, Format::Ply, &to_world, cx)?,
        "rectangle" => mesh(solids::rectangle(), "rectangle", here),
        "cube" => mesh(solids::cube(), "cube", here),
        "disk" => {
            fields.warn(approximated("disk", solids::SEGMENTS));
            mesh(solids::disk(), "disk", here)
        }
        "cylinder" => {
            fields.warn(approximated("cylinder", 2 * solids::SEGMENTS));
            let p0 = fields.point("p0")?.unwrap_or_default();
            let p1 = fields.point("p1")?.unwrap_or([0.0, 0.0, 1.0]);
            let radius = fields.float("radius", 1.0, Bounds::Positive)?;
            let placed = solids::along(p0, p1, radius)
                .ok_or_else(|| fields.error("`p0` and `p1` of the cylinder are the same"))?;
            mesh(solids::cylinder(), "cylinder", placed)
        }
        "sphere" => sphere(fields, (to_world, flipped))?,
        _ => return Err(fields.unknown_plugin(SHAPES)),
    })
}

fn approximated(what: &str, triangles: u32) -> String {
    format!("the {what} is shown as a mesh of {triangles} triangles")
}

fn sphere(fields: &mut Fields, (to_world, flipped): (Transform, bool)) -> Result<Surface, Diagnostic> {
    let center = fields.point("center")?.unwrap_or_default().map(f64::from);
    let radius = fields.float("radius", 1.0, Bounds::Positive)?;
    let placed = Transform::scale([f64::from(radius); 3]).then(Transform::translate(center));
    let name = "sphere".to_owned();
    if flipped || to_world.uniform_scale().is_none() {
        let mesh = solids::sphere();
        fields.warn(approximated("sphere", mesh.triangles.len() as u32));
        return Ok(Surface { geometry: Geometry::Mesh(mesh), name, placed });
    }
    // Mitsuba's u begins at +x, ours at −x.
    let placed = Transform::rotate(180.0, [0.0, 0.0, 1.0]).then(placed);
    Ok(Surface { geometry: Geometry::Sphere { center: Vec3::ZERO, radius: 1.0 }, name, placed })
}

fn file(
    fields: &mut Fields,
    format: Format,
    to_world: &Transform,
    cx: &mut Context,
) -> Result<Surface, Diagnostic> {
    let (file, property) = fields.file_name()?;
    let mut mesh = cx.mesh(file, format, &property.value_origin)?;
    // With its usual value, v = 0 is an image's lower edge: as here.
    let upright = fields.boolean("flip_tex_coords", format == Format::Obj)?;
    if !upright {
        mesh.uvs.iter_mut().for_each(|uv| uv.y = 1.0 - uv.y);
    }
    if fields.boolean("face_normals", false)? {
        mesh.normals.clear();
    } else if mesh.normals.is_empty() {
        mesh.normals = solids::smooth_normals(&mesh, to_world);
    }
    fields.ignore(&["vertex_normals", "shape_index"]);
    fields.unsupported(&["collapse", "max_smooth_angle"]);
    let name = Path::new(file).file_name().map_or(file.into(), |n| n.to_string_lossy()).into_owned();
    Ok(Surface { geometry: Geometry::Mesh(mesh), name, placed: Transform::IDENTITY })
}

/// Turns a mesh inside out.
fn flip(mesh: &mut Mesh) {
    mesh.normals.iter_mut().for_each(|n| *n = -*n);
    mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
}
