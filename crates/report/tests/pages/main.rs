//! Both pages in a real browser. Without one the tests pass with a notice.
//!
//! `CAUSTICA_SCREENSHOTS=FOLDER` keeps pictures of the sample pages there.

mod chrome;
mod comparison;
mod looks;
mod pyramid;
#[path = "../../examples/sample_report/pictures.rs"]
mod sample;

use caustica_math::Rgb;
use chrome::{Device, Page};

/// A window of 1440 × 900, with a mouse.
pub(crate) const LAPTOP: Device =
    Device { name: "laptop", width: 1440, height: 900, touch: false, dark: false };
/// A window of 390 × 844, with fingers.
pub(crate) const PHONE: Device = Device { name: "phone", width: 390, height: 844, touch: true, dark: false };

/// The display byte of a linear value, by the film's own tone map.
pub(crate) fn byte(linear: f32) -> u8 {
    caustica_film::to_display(Rgb::splat(linear), 0.0, caustica_film::ToneMap::Srgb)[0]
}

pub(crate) fn assert_near(shown: [u8; 3], expected: [u8; 3]) {
    assert!(shown.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 2), "{shown:?} is not {expected:?}");
}

/// Where an image pixel's middle is in the window, as the viewer's state has it.
pub(crate) fn place(page: &mut Page, x: f64, y: f64) -> [f64; 2] {
    let at = page.eval(&format!(
        "(() => {{ const {{ view, parts }} = caustica.viewer, box = parts.stage.getBoundingClientRect();
           return [box.left + box.width / 2 + ({x} + 0.5 - view.x) * view.scale,
                   box.top + box.height / 2 + ({y} + 0.5 - view.y) * view.scale]; }})()"
    ));
    [at[0].as_f64().unwrap(), at[1].as_f64().unwrap()]
}
