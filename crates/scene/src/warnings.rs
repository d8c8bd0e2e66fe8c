//! What is merely suspicious about a scene.

use crate::description::{Description, MaterialKind, Principled, PrincipledThin, Shape, Texture};
use crate::diagnostic::Diagnostic;
use crate::scene::Scene;
use crate::surface::Surfaces;

/// Pushes a warning for everything that can be rendered but is probably not meant.
pub(crate) fn check(scene: &Scene, description: &Description, warnings: &mut Vec<Diagnostic>) {
    if scene.lamps().are_black() {
        warnings.push(
            Diagnostic::warning("the scene has no light: the picture will be black")
                .hint("give a mesh or sphere an `area` emitter, or add a point or environment light"),
        );
    }
    if description.shapes.is_empty() && description.instances.is_empty() {
        warnings.push(Diagnostic::warning("the scene has no surfaces"));
    }
    open_dielectrics(scene, description, warnings);
    lamps_that_face_away(scene, description, warnings);
    bright_albedos(description, warnings);
    clipped(scene, warnings);
    if warnings.len() > MOST_WARNINGS {
        let more = warnings.len() - MOST_WARNINGS;
        warnings.truncate(MOST_WARNINGS);
        warnings.push(Diagnostic::warning(format!("there are {more} more warnings, which are not shown")));
    }
}

/// The most warnings that are kept: more of them help nobody.
const MOST_WARNINGS: usize = 1000;

/// Lamps beyond so many are not looked at one by one: it takes many rays each.
const MOST_LAMPS: usize = 1000;

/// Clip planes that leave nothing of the scene.
fn clipped(scene: &Scene, warnings: &mut Vec<Diagnostic>) {
    let (center, radius) = scene.bounding_sphere();
    let (near, far) = scene.camera.clips();
    let distance = (center - scene.camera.position()).length();
    let plane = match () {
        () if scene.bvh().bounds().is_empty() => return,
        () if distance + radius < near => "nearer than its near",
        () if distance - radius > far => "farther than its far",
        () => return,
    };
    warnings.push(
        Diagnostic::warning(format!("the camera sees no surface: all are {plane} clip plane")).hint(
            "clip planes are in the scene's units: `nearClip` and `farClip`, 1e-4 and 1e4 if nobody says",
        ),
    );
}

/// A dielectric mesh that is not closed, alone or by others, refracts light into a medium that it never leaves.
fn open_dielectrics(scene: &Scene, description: &Description, warnings: &mut Vec<Diagnostic>) {
    let transparent = |shape: &Shape| scene.traits_of(shape.material).bounds_a_medium;
    let unclosed = |surfaces: &Surfaces, shapes: &[Shape]| {
        let candidates: Vec<usize> = (0..shapes.len()).filter(|i| transparent(&shapes[*i])).collect();
        surfaces.unclosed(&candidates)
    };
    let groups = scene.surfaces().groups().zip(&description.groups);
    let parts = groups.map(|(surfaces, group)| (surfaces, &group.shapes));
    let parts = std::iter::once((scene.surfaces(), &description.shapes)).chain(parts);
    let open = parts.flat_map(|(s, shapes)| unclosed(s, shapes).into_iter().map(|i| &shapes[i]));
    for shape in open {
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

/// A flat lamp that lies on another surface, or faces out of the scene, lights nothing; and one that lies in another
/// surface is seen by some paths and not by others.
fn lamps_that_face_away(scene: &Scene, description: &Description, warnings: &mut Vec<Diagnostic>) {
    let lamps = description.shapes.iter().enumerate().filter(|(_, s)| s.emission.is_some());
    for (index, shape) in lamps.take(MOST_LAMPS) {
        let (what, hint) = if scene.lies_in_another(index) {
            (
                "lies in the plane of another surface: which of them is seen is left to rounding",
                "move it a little in front of the surface",
            )
        } else if scene.faces_nothing(index) {
            (
                "is a lamp that faces away from everything",
                "a lamp emits on the side of its normal: reverse its triangles",
            )
        } else {
            continue;
        };
        let message = format!("{} {what}", shape.name);
        warnings.push(Diagnostic::warning(message).at(shape.origin.clone()).hint(hint));
    }
}

fn bright_albedos(description: &Description, warnings: &mut Vec<Diagnostic>) {
    for m in &description.materials {
        let (what, colour) = match &m.kind {
            MaterialKind::Diffuse { albedo: t } | MaterialKind::Microfacet { kd: t, .. } => {
                ("a diffuse albedo", brightest(t))
            }
            MaterialKind::Mirror { reflectance: c } => ("a reflectance", c.max_channel()),
            MaterialKind::Conductor { reflectance: t, .. }
            | MaterialKind::RoughConductor { reflectance: t, .. } => ("a reflectance", brightest(t)),
            MaterialKind::Dielectric { reflectance, transmittance, .. }
            | MaterialKind::RoughDielectric { reflectance, transmittance, .. }
            | MaterialKind::ThinDielectric { reflectance, transmittance, .. } => {
                ("a factor on what glass gives back", brightest(reflectance).max(brightest(transmittance)))
            }
            MaterialKind::Plastic { diffuse, reflectance, .. }
            | MaterialKind::RoughPlastic { diffuse, reflectance, .. } => {
                ("a reflectance", brightest(diffuse).max(brightest(reflectance)))
            }
            MaterialKind::Principled(Principled { base_color: t, .. })
            | MaterialKind::PrincipledThin(PrincipledThin { base_color: t, .. }) => {
                ("a base color", brightest(t))
            }
            MaterialKind::Null | MaterialKind::Wrapped(_) => continue,
        };
        if colour > 1.0 {
            let message = format!("{what} above one reflects more light than arrives");
            warnings.push(Diagnostic::warning(message).at(m.origin.clone()));
        }
    }
}

/// The largest channel of a texture without images and attributes.
fn brightest(texture: &Texture) -> f32 {
    match texture {
        Texture::Constant(c) => c.max_channel(),
        Texture::Checkerboard { value1, value2, .. } => value1.max_channel().max(value2.max_channel()),
        Texture::Image { .. } | Texture::Attribute { .. } => 0.0,
    }
}
