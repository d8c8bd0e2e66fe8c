//! The table of what bidirectional renderers are known to get wrong, each row with a scene of its own.

use caustica_math::{Filter, Rgb};
use caustica_scene::Description;
use caustica_scene::description::{CameraKind, Crop, LightKind, MaterialKind};

use crate::build::{light, scene};
use crate::known_failures::{
    caster, lamp_out_of_focus, leaning_normals, mirrored, nested_interfaces, point_at_the_floor, scaled,
    specular_chains, spot, textured_emitters, three_rooms, unequal_lamps,
};
use crate::scenes::{ball, bulb, furnace, lit_by, plastic_kind, rough_glass_kind, sky};

/// A row of the table.
pub struct Row {
    /// What goes wrong elsewhere.
    pub what: &'static str,
    /// Where it was told of.
    pub threads: &'static str,
    /// A scene that would show it.
    pub scene: Description,
}

fn row(what: &'static str, threads: &'static str, scene: Description) -> Row {
    Row { what, threads, scene }
}

/// All rows but that on media, which are not rendered yet.
pub fn rows() -> Vec<Row> {
    let mut rows = shading_and_weights();
    rows.extend(cameras_and_films());
    rows.extend(lamps_and_scenes());
    rows
}

fn shading_and_weights() -> Vec<Row> {
    let grey = MaterialKind::Diffuse { albedo: Rgb::splat(0.8).into() };
    vec![
        row(
            "shading normals: light walks lack the adjoint factor",
            "pbrt-v4 #385, #526, #13; pbrt-v3 #94",
            leaning_normals(grey),
        ),
        row("the same on rough glass", "pbrt-v4 #385", leaning_normals(rough_glass_kind())),
        row("weights with specular chains", "pbrt-v4 #326", specular_chains()),
        row("next-event and emission densities mixed up", "found by reading", unequal_lamps()),
        row("single-strategy images black or wrong", "pbrt-v4 #299", ball(plastic_kind())),
        row("roulette missing from the weights", "measured on LuxCore BIDIR 2.11", long_paths()),
        row(
            "black through glass, light lost behind glass",
            "mitsuba3 #181, #916; pbrt-v3 #197; pbrt-v4 #228",
            bulb(),
        ),
        row("nested interfaces", "mitsuba3 #181", nested_interfaces()),
        row("caustics only with flipped normals", "BlendLuxCore #758", caster(true)),
        row("negative scale with vertex normals, lamps that flip", "pbrt-v3 #229", mirrored(true)),
    ]
}

/// A box whose light bounces long.
fn long_paths() -> Description {
    let mut d = ball(plastic_kind());
    d.materials.iter_mut().for_each(|m| {
        if let MaterialKind::Diffuse { albedo } = &mut m.kind {
            *albedo = Rgb::splat(0.9).into();
        }
    });
    d
}

fn cameras_and_films() -> Vec<Row> {
    let with = |kind| {
        let mut d = ball(plastic_kind());
        d.camera.kind = kind;
        d
    };
    let mut cropped = ball(plastic_kind());
    (cropped.film.width, cropped.film.height) = (32, 24);
    cropped.film.filter = Filter::Gaussian { radius: 3.0, stddev: 1.2 };
    cropped.film.crop = Some(Crop { x: 8, y: 4, width: 16, height: 12 });
    let mut filtered = ball(plastic_kind());
    filtered.film.filter = Filter::Mitchell { radius: 2.5, b: 1.0 / 3.0, c: 1.0 / 3.0 };
    let mut around = with(CameraKind::Environment);
    around.camera.to_world = caustica_math::Transform::translate([0.2, 0.4, -0.5]);
    (around.film.width, around.film.height) = (32, 16);
    vec![
        row("thin lens: splats miss vignetting or lens density", "pbrt-v4 #458", lamp_out_of_focus()),
        row("crop window: splats normalised differently", "pbrt-v4 #347", cropped),
        row(
            "orthographic cameras abort or are refused",
            "pbrt-v4 #279; LuxCore #667",
            with(CameraKind::Orthographic),
        ),
        row("360° cameras abort or are refused", "mitsuba3 #198", around),
        row("the pixel filter is ignored by light tracing", "LuxCore #413", filtered),
        row(
            "the same seed on every thread",
            "SORT #35; mitsuba #184; LuxCore #255",
            ball(rough_glass_kind()),
        ),
    ]
}

fn lamps_and_scenes() -> Vec<Row> {
    let mut white = furnace();
    white.materials[0].kind = MaterialKind::Diffuse { albedo: Rgb::splat(0.9).into() };
    white.shapes[0].emission = Some(Rgb::splat(0.1).into());
    let mut alone = scene(16);
    sky(&mut alone);
    let mut constant = scene(16);
    light(&mut constant, LightKind::Constant { radiance: Rgb::WHITE });
    let sun = LightKind::Directional { direction: [0.2, -0.3, 1.0], irradiance: Rgb::splat(3.0) };
    vec![
        row("narrow spots, spot cosines in emission densities", "pbrt-v4 #362, #468", spot(true, 3.0, 4.0)),
        row("closed white furnace fails", "mitsuba #80", white),
        row("a scene lit by an environment map alone is black", "sig-graphics-audio #42", alone),
        row("a constant environment and nothing else", "mitsuba #80", constant),
        row("a point light produces fireflies of 80,000 and more", "mitsuba #132", point_at_the_floor()),
        row("large interiors: PT ≠ BDPT by percents", "pbrt-v3 #73, #87, #179", three_rooms()),
        row("brightness depends on distance (a thousandth)", "LuxCore #678, #237", scaled(1e-3)),
        row("brightness depends on distance (a thousandfold)", "LuxCore #239, #216", scaled(1e3)),
        row("irradiance off by π between light types", "LuxCore #580", lit_by(sun)),
        row("textured emitters sampled wrongly", "mitsuba3 #1363; BlendLuxCore #79", textured_emitters()),
    ]
}
