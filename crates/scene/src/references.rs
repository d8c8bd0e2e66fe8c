//! What parts of a description refer to, and the colours they name.

use crate::description::{Description, LightKind, Texture};
use crate::diagnostic::Diagnostic;
use crate::figures::placement;

/// Whether the colours of a texture are finite and none is negative. (Images and attributes are looked at apart.)
fn is_valid(texture: &Texture) -> bool {
    match texture {
        Texture::Constant(c) => c.is_valid(),
        Texture::Checkerboard { value1, value2, .. } => value1.is_valid() && value2.is_valid(),
        Texture::Image { .. } | Texture::Attribute { .. } => true,
    }
}

/// Whether there is what a texture names.
fn exists(texture: &Texture, d: &Description) -> bool {
    match texture {
        Texture::Constant(_) | Texture::Checkerboard { .. } => true,
        Texture::Image { image, .. } => (image.0 as usize) < d.images.len(),
        Texture::Attribute { attribute, .. } => (attribute.0 as usize) < d.attributes.len(),
    }
}

/// What a lamp refers to.
fn light(kind: &LightKind, d: &Description) -> Result<(), Diagnostic> {
    let texture = match kind {
        LightKind::Environment { image, .. } if image.0 as usize >= d.images.len() => {
            return Err(Diagnostic::error("an environment names an image that does not exist"));
        }
        LightKind::Collimated { shape, .. } if *shape as usize >= d.shapes.len() => {
            return Err(Diagnostic::error("a lamp names a shape that does not exist"));
        }
        LightKind::Projector { irradiance: t, .. } | LightKind::Collimated { exitance: t, .. } => t,
        LightKind::LinearSpot { picture: Some(t), .. } => t,
        _ => return Ok(()),
    };
    if matches!(texture, Texture::Attribute { .. }) && !matches!(kind, LightKind::Collimated { .. }) {
        return Err(Diagnostic::error("a lamp's picture is an attribute of a mesh")
            .hint("use an image: what is thrown from a point lies on no mesh"));
    }
    if !exists(texture, d) {
        return Err(Diagnostic::error("a lamp's picture names an image or an attribute that does not exist"));
    }
    if !is_valid(texture) {
        return Err(Diagnostic::error("a lamp's colour must be finite and not negative"));
    }
    placement(texture, "a lamp's picture")
}

/// Groups have shapes and no lamps, and instances are of groups that exist.
fn groups(d: &Description) -> Result<(), Diagnostic> {
    for group in &d.groups {
        if let Some(lamp) = group.shapes.iter().find(|s| s.emission.is_some()) {
            let message = format!("{} is a lamp in the group {}", lamp.name, group.name);
            return Err(Diagnostic::error(message)
                .at(lamp.origin.clone())
                .hint("what has instances cannot emit: put the lamp beside them"));
        }
    }
    for instance in &d.instances {
        let group = d.groups.get(instance.group.0 as usize);
        if group.is_none_or(|g| g.shapes.is_empty()) {
            return Err(Diagnostic::error("an instance is of a group that has no shapes or does not exist")
                .at(instance.origin.clone()));
        }
    }
    Ok(())
}

/// Every id must name something, and every colour be one.
pub(crate) fn check(d: &Description) -> Result<(), Diagnostic> {
    for image in &d.images {
        if image.width == 0
            || image.height == 0
            || image.pixels.len() != image.width as usize * image.height as usize
        {
            return Err(Diagnostic::error("an image's pixels do not match its size"));
        }
        if !image.pixels.iter().all(|p| p.is_valid()) {
            return Err(Diagnostic::error("an image has values that are negative or not finite"));
        }
    }
    for m in &d.materials {
        let textures = m.kind.textures();
        if !textures.iter().all(|t| exists(t, d)) {
            return Err(Diagnostic::error(
                "a material's texture names an image or an attribute that does not exist",
            )
            .at(m.origin.clone()));
        }
        if !textures.into_iter().all(is_valid) {
            return Err(
                Diagnostic::error("a material's colour is negative or not finite").at(m.origin.clone())
            );
        }
    }
    groups(d)?;
    for s in d.all_shapes() {
        if s.material.0 as usize >= d.materials.len() || s.emission.as_ref().is_some_and(|t| !exists(t, d)) {
            return Err(Diagnostic::error(format!(
                "{} names a material, an image or an attribute that does not exist",
                s.name
            ))
            .at(s.origin.clone()));
        }
        if !s.emission.as_ref().is_none_or(is_valid) {
            return Err(Diagnostic::error(format!(
                "{} emits a colour that is negative or not finite",
                s.name
            ))
            .at(s.origin.clone()));
        }
    }
    for l in &d.lights {
        light(&l.kind, d).map_err(|e| e.at(l.origin.clone()))?;
    }
    let w = d.film.window();
    let inside =
        |start: u32, size: u32, full: u32| size > 0 && start.checked_add(size).is_some_and(|e| e <= full);
    if !inside(w.x, w.width, d.film.width) || !inside(w.y, w.height, d.film.height) {
        return Err(Diagnostic::error(format!(
            "the crop window {}×{} at ({}, {}) does not lie within the picture of {}×{} pixels",
            w.width, w.height, w.x, w.y, d.film.width, d.film.height
        )));
    }
    Ok(())
}
