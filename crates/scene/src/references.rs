//! What parts of a description refer to, and the colours they name.

use crate::description::{Description, LightKind, Texture};
use crate::diagnostic::Diagnostic;

/// Whether the colours of a texture are finite and none is negative. (Images are looked at apart.)
fn is_valid(texture: &Texture) -> bool {
    match texture {
        Texture::Constant(c) => c.is_valid(),
        Texture::Checkerboard { value1, value2, .. } => value1.is_valid() && value2.is_valid(),
        Texture::Image { .. } => true,
    }
}

/// Every id must name something, and every colour be one.
pub(crate) fn check(d: &Description) -> Result<(), Diagnostic> {
    let image_exists = |t: &Texture| match t {
        Texture::Image { image, .. } => (image.0 as usize) < d.images.len(),
        _ => true,
    };
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
        if !textures.iter().all(|t| image_exists(t)) {
            return Err(Diagnostic::error("a material's texture names an image that does not exist")
                .at(m.origin.clone()));
        }
        if !textures.into_iter().all(is_valid) {
            return Err(
                Diagnostic::error("a material's colour is negative or not finite").at(m.origin.clone())
            );
        }
    }
    for s in &d.shapes {
        if s.material.0 as usize >= d.materials.len() || s.emission.as_ref().is_some_and(|t| !image_exists(t))
        {
            return Err(Diagnostic::error(format!(
                "{} names a material or an image that does not exist",
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
        if let LightKind::Environment { image, .. } = l.kind
            && image.0 as usize >= d.images.len()
        {
            return Err(
                Diagnostic::error("an environment names an image that does not exist").at(l.origin.clone())
            );
        }
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
