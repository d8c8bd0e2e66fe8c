//! What all pages share: their parts and the checks of their images.

use serde::Serialize;

use crate::ReportError;
use crate::comparison::Shown;

pub const STYLE: &str = concat!(
    include_str!("../templates/style/page.css"),
    include_str!("../templates/style/viewer.css"),
    include_str!("../templates/style/comparison.css"),
    include_str!("../templates/style/pyramid.css"),
    include_str!("../templates/style/verification.css"),
);

/// The scripts in one scope, in the order in which they need each other.
pub const SCRIPT: &str = concat!(
    include_str!("../templates/script/codec.js"),
    include_str!("../templates/script/colour.js"),
    include_str!("../templates/script/view.js"),
    include_str!("../templates/script/paint_cpu.js"),
    include_str!("../templates/script/paint_gl.js"),
    include_str!("../templates/script/gestures.js"),
    include_str!("../templates/script/controls.js"),
    include_str!("../templates/script/viewer.js"),
    include_str!("../templates/script/page.js"),
    include_str!("../templates/script/table.js"),
    include_str!("../templates/script/axes.js"),
    include_str!("../templates/script/curves.js"),
    include_str!("../templates/script/insets.js"),
    include_str!("../templates/script/comparison.js"),
    include_str!("../templates/script/pyramid.js"),
    include_str!("../templates/script/verification.js"),
    include_str!("../templates/script/start.js"),
);

/// An image as text, and the name under which the script finds it.
pub struct Blob {
    pub id: String,
    pub text: String,
}

impl Blob {
    pub fn new(id: String, text: String) -> Self {
        Self { id, text }
    }
}

/// JSON that can stand in a script element, whatever the strings in it say.
pub fn script_json(data: &impl Serialize) -> Result<String, ReportError> {
    Ok(serde_json::to_string(data)?.replace('<', "\\u003c"))
}

/// Whether `count` pixels fill the size.
pub fn check_count(name: &str, [width, height]: [u32; 2], count: usize) -> Result<(), ReportError> {
    if count == 0 || u64::from(width) * u64::from(height) != count as u64 {
        return Err(ReportError::PixelCount { name: name.to_owned(), width, height, pixels: count });
    }
    Ok(())
}

/// Whether an image has its pixels and the size of the first.
pub fn check_image(first: &Shown, image: &Shown) -> Result<(), ReportError> {
    let size = [image.width, image.height];
    if size != [first.width, first.height] {
        return Err(ReportError::SizesDiffer {
            name: image.name.clone(),
            width: image.width,
            height: image.height,
            first: first.name.clone(),
            first_width: first.width,
            first_height: first.height,
        });
    }
    check_count(&image.name, size, image.pixels.len())
}
