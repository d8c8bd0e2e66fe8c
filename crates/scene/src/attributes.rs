//! Which attributes meshes need: those that the textures of their shapes look up.

use std::collections::BTreeSet;

use crate::description::{
    Attribute, Description, Domain, Geometry, LightKind, Material, MaterialKind, Mesh, Shape, Texture,
};
use crate::diagnostic::Diagnostic;

/// Indices of names.
type Names = BTreeSet<u32>;

/// Drops what no texture looks up.
///
/// # Errors
/// A shape that lacks what its textures look up, or has it in a wrong number or with values that are no colours; names
/// that are listed twice.
///
/// Materials must have been found to end: see [`crate::traits::of_all`].
pub(crate) fn resolve(d: &mut Description) -> Result<(), Diagnostic> {
    let distinct: BTreeSet<&String> = d.attributes.iter().collect();
    if distinct.len() != d.attributes.len() {
        return Err(Diagnostic::error("the description lists an attribute twice"));
    }
    let mut of_materials = vec![None; d.materials.len()];
    (0..d.materials.len()).for_each(|i| drop(of_material(i, &d.materials, &mut of_materials)));
    let mut thrown = vec![Names::new(); d.shapes.len()];
    for light in &d.lights {
        if let LightKind::Collimated { shape, exitance } = &light.kind {
            thrown[*shape as usize].extend(name(exitance));
        }
    }
    let own = d.shapes.iter_mut().zip(thrown);
    let inside = d.groups.iter_mut().flat_map(|g| &mut g.shapes).map(|s| (s, Names::new()));
    for (shape, mut needed) in own.chain(inside) {
        needed.extend(of_materials[shape.material.0 as usize].iter().flatten());
        needed.extend(shape.emission.as_ref().and_then(name));
        let names: Vec<&str> = needed.into_iter().map(|i| d.attributes[i as usize].as_str()).collect();
        keep(shape, &names)?;
    }
    Ok(())
}

fn name(texture: &Texture) -> Option<u32> {
    if let Texture::Attribute { attribute, .. } = texture { Some(attribute.0) } else { None }
}

/// What a material looks up, with all that is inside of it.
fn of_material(index: usize, materials: &[Material], known: &mut [Option<Names>]) -> Names {
    if let Some(names) = &known[index] {
        return names.clone();
    }
    let kind = &materials[index].kind;
    let mut names: Names = kind.textures().into_iter().filter_map(name).collect();
    if let MaterialKind::Wrapped(wrapper) = kind {
        for inner in wrapper.inner() {
            names.extend(of_material(inner.0 as usize, materials, known));
        }
    }
    known[index] = Some(names.clone());
    names
}

/// Keeps those attributes of a shape.
fn keep(shape: &mut Shape, names: &[&str]) -> Result<(), Diagnostic> {
    let Shape { geometry, name, origin, .. } = shape;
    let error = |what: String| Diagnostic::error(format!("{name} {what}")).at(origin.clone());
    let Geometry::Mesh(mesh) = geometry else {
        return names.first().map_or(Ok(()), |wanted| {
            let message = format!("is a sphere without the attribute `{wanted}`, which its texture looks up");
            Err(error(message).hint("only meshes have attributes"))
        });
    };
    for wanted in names {
        let Some(attribute) = mesh.attributes.iter().find(|a| a.name == *wanted) else {
            return Err(error(format!("has no attribute `{wanted}`, which its texture looks up"))
                .hint(hint(&mesh.attributes)));
        };
        fits(attribute, mesh).map_err(error)?;
    }
    mesh.attributes.retain(|a| names.contains(&a.name.as_str()));
    Ok(())
}

fn hint(attributes: &[Attribute]) -> String {
    let names: Vec<String> = attributes.iter().take(10).map(|a| format!("`{}`", a.name)).collect();
    match names.len() {
        0 => "the mesh has no attributes".into(),
        _ => format!("the mesh has {}", names.join(", ")),
    }
}

fn fits(attribute: &Attribute, mesh: &Mesh) -> Result<(), String> {
    let (count, what) = match attribute.domain {
        Domain::Vertex => (mesh.positions.len(), "vertices"),
        Domain::Face => (mesh.triangles.len(), "triangles"),
    };
    let Attribute { name, values, .. } = attribute;
    if values.len() != count {
        return Err(format!("has {count} {what} but {} values of the attribute `{name}`", values.len()));
    }
    match values.iter().position(|v| !v.is_valid()) {
        Some(bad) => {
            Err(format!("has an attribute `{name}` whose value {} is negative or not finite", bad + 1))
        }
        None => Ok(()),
    }
}
