//! What is merely suspicious about a scene.

use crate::description::{Description, MaterialKind, Texture};
use crate::diagnostic::Diagnostic;
use crate::scene::Scene;

/// Pushes a warning for everything that can be rendered but is probably not meant.
pub(crate) fn check(scene: &Scene, description: &Description, warnings: &mut Vec<Diagnostic>) {
    if scene.lamps().are_black() {
        warnings.push(
            Diagnostic::warning("the scene has no light: the picture will be black")
                .hint("give a mesh or sphere an `area` emitter, or add a point or environment light"),
        );
    }
    if description.shapes.is_empty() {
        warnings.push(Diagnostic::warning("the scene has no surfaces"));
    }
    open_dielectrics(scene, description, warnings);
    lamps_that_face_away(scene, description, warnings);
    bright_albedos(description, warnings);
}

/// A dielectric mesh that is not closed, alone or by others, refracts light into a medium that it never leaves.
fn open_dielectrics(scene: &Scene, description: &Description, warnings: &mut Vec<Diagnostic>) {
    let transparent = |index: &usize| {
        let material = description.shapes[*index].material;
        let kind = &description.materials[material.0 as usize].kind;
        matches!(kind, MaterialKind::Dielectric { .. } | MaterialKind::RoughDielectric { .. })
    };
    let shapes: Vec<usize> = (0..description.shapes.len()).filter(transparent).collect();
    for index in scene.surfaces().unclosed(&shapes) {
        let shape = &description.shapes[index];
        warnings.push(
            Diagnostic::warning(format!(
                "{} is transparent but not closed: what is behind its border counts as inside",
                shape.name
            ))
            .at(shape.origin.clone())
            .hint("close the mesh, with its normals outward, or give it another material"),
        );
    }
}

/// A flat lamp that lies on another surface, or faces out of the scene, lights nothing.
fn lamps_that_face_away(scene: &Scene, description: &Description, warnings: &mut Vec<Diagnostic>) {
    for (index, shape) in description.shapes.iter().enumerate() {
        if shape.emission.is_some() && scene.faces_nothing(index) {
            warnings.push(
                Diagnostic::warning(format!("{} is a lamp that faces away from everything", shape.name))
                    .at(shape.origin.clone())
                    .hint("a lamp emits on the side of its normal: reverse its triangles"),
            );
        }
    }
}

fn bright_albedos(description: &Description, warnings: &mut Vec<Diagnostic>) {
    for m in &description.materials {
        if let MaterialKind::Diffuse { albedo: Texture::Constant(c) } = &m.kind
            && c.max_channel() > 1.0
        {
            warnings.push(
                Diagnostic::warning("a diffuse albedo above one reflects more light than arrives")
                    .at(m.origin.clone()),
            );
        }
    }
}
