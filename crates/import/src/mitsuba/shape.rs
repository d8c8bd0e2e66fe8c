//! `<shape>`.

use std::path::Path;

use caustica_math::{Transform, Vec3};
use caustica_scene::Diagnostic;
use caustica_scene::description::{Geometry, MaterialId, Mesh, Shape};

use super::class::Class;
use super::context::{Context, Format};
use super::fields::Fields;
use super::{bsdf, emitter, instance, solids};
use crate::nori::range::Bounds;

const SHAPES: &[&str] = &[
    "obj",
    "ply",
    "serialized",
    "sphere",
    "rectangle",
    "disk",
    "cube",
    "cylinder",
    "shapegroup",
    "instance",
];
const UNSUPPORTED: &[&str] = &[
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
    /// Whether it is to be turned inside out.
    flipped: bool,
}

pub(super) fn read(index: usize, cx: &mut Context) -> Result<(), Diagnostic> {
    let fields = Fields::new(cx.tree, index);
    match fields.plugin() {
        "shapegroup" => instance::group(index, cx).map(|_| ()),
        "instance" => instance::read(fields, cx),
        _ => {
            let shape = read_surface(fields, cx)?;
            cx.description.shapes.extend(shape);
            Ok(())
        }
    }
}

/// A shape that is a surface by itself; nothing if it is not supported.
pub(super) fn read_surface(mut fields: Fields, cx: &mut Context) -> Result<Option<Shape>, Diagnostic> {
    let plugin = fields.plugin();
    if UNSUPPORTED.contains(&plugin) {
        fields.warn(format!("the {} is not supported yet; it is left out", fields.title()));
        fields.finish_unread(cx);
        return Ok(None);
    }
    let to_world = fields.transform("to_world")?;
    let flipped = fields.boolean("flip_normals", false)? ^ fields.boolean("flip_normal", false)?;
    let mut surface = surface(&mut fields, (to_world, flipped), cx)?;
    let from_file = ["obj", "ply", "serialized"].contains(&fields.plugin());
    if let Geometry::Mesh(mesh) = &surface.geometry
        && !from_file
    {
        cx.count_made(mesh, &fields.object.origin)?;
    }
    if let Geometry::Mesh(mesh) = &mut surface.geometry
        && surface.flipped
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
    Ok(Some(Shape { name, geometry, to_world, material, emission, origin }))
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
    let mesh = |mesh, name: &str| Surface {
        geometry: Geometry::Mesh(mesh),
        name: name.into(),
        placed: Transform::IDENTITY,
        flipped,
    };
    Ok(match fields.plugin() {
        "obj" => file(fields, Format::Obj, (&to_world, flipped), cx)?,
        "ply" => file(fields, Format::Ply, (&to_world, flipped), cx)?,
        "serialized" => {
            let index = fields.integer("shape_index", 0..=u32::MAX.into())?.unwrap_or(0) as u32;
            file(fields, Format::Serialized(index), (&to_world, flipped), cx)?
        }
        // The normal is that of the transformed sides.
        "rectangle" => {
            Surface { flipped: flipped ^ to_world.mirrors(), ..mesh(solids::rectangle(), "rectangle") }
        }
        "cube" => mesh(solids::cube(), "cube"),
        "disk" => mesh(solids::disk(), "disk"),
        "cylinder" => {
            let p0 = fields.point("p0")?.unwrap_or_default();
            let p1 = fields.point("p1")?.unwrap_or([0.0, 0.0, 1.0]);
            let radius = fields.float("radius", 1.0, Bounds::Positive)?;
            let placed = solids::along(p0, p1, radius)
                .ok_or_else(|| fields.error("`p0` and `p1` of the cylinder are the same"))?;
            Surface { placed, ..mesh(solids::cylinder(), "cylinder") }
        }
        "sphere" => sphere(fields, (to_world, flipped))?,
        _ => return Err(fields.unknown_plugin(SHAPES)),
    })
}

fn sphere(fields: &mut Fields, (to_world, flipped): (Transform, bool)) -> Result<Surface, Diagnostic> {
    let center = fields.point("center")?.unwrap_or_default().map(f64::from);
    let radius = fields.float("radius", 1.0, Bounds::Positive)?;
    let placed = Transform::scale([f64::from(radius); 3]).then(Transform::translate(center));
    let name = "sphere".to_owned();
    // A mirrored sphere is inside out.
    let flipped = flipped ^ to_world.mirrors();
    if flipped || to_world.uniform_scale().is_none() {
        return Ok(Surface { geometry: Geometry::Mesh(solids::sphere()), name, placed, flipped });
    }
    // Mitsuba's u begins at +x, ours at −x.
    let placed = Transform::rotate(180.0, [0.0, 0.0, 1.0]).then(placed);
    let geometry = Geometry::Sphere { center: Vec3::ZERO, radius: 1.0 };
    Ok(Surface { geometry, name, placed, flipped })
}

fn file(
    fields: &mut Fields,
    format: Format,
    (to_world, flipped): (&Transform, bool),
    cx: &mut Context,
) -> Result<Surface, Diagnostic> {
    let (file, property) = fields.file_name()?;
    let mut mesh = cx.mesh(file, format, &property.value_origin)?;
    // With its usual value, v = 0 is an image's lower edge: as here.
    let upright = match format {
        Format::Serialized(_) => false,
        _ => fields.boolean("flip_tex_coords", format == Format::Obj)?,
    };
    if !upright {
        mesh.uvs.iter_mut().for_each(|uv| uv.y = 1.0 - uv.y);
    }
    let flat = fields.boolean("face_normals", false)?;
    // Normals of its own keep a mirrored mesh's outside outside; by the winding it is inside out.
    let flipped = flipped ^ (to_world.mirrors() && (flat || mesh.normals.is_empty()));
    if flat {
        mesh.normals.clear();
    } else if mesh.normals.is_empty() {
        mesh.normals = solids::smooth_normals(&mesh, to_world);
    }
    fields.ignore(&["vertex_normals"]);
    fields.unsupported(&["collapse", "max_smooth_angle"]);
    let name = Path::new(file).file_name().map_or(file.into(), |n| n.to_string_lossy()).into_owned();
    Ok(Surface { geometry: Geometry::Mesh(mesh), name, placed: Transform::IDENTITY, flipped })
}

/// Turns a mesh inside out.
fn flip(mesh: &mut Mesh) {
    mesh.normals.iter_mut().for_each(|n| *n = -*n);
    mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
}
