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
    /// The transport crate's test of it: its file without `.rs`, and its name.
    pub test: (&'static str, &'static str),
    /// Whether all integrators could be wrong alike, so that only the test tells, by figures that are known.
    pub shared: bool,
    /// A scene that would show it.
    pub scene: Description,
}

fn row(
    what: &'static str,
    threads: &'static str,
    test: (&'static str, &'static str),
    scene: Description,
) -> Row {
    Row { what, threads, test, shared: false, scene }
}

impl Row {
    /// An error that integrators can share.
    fn shared(self) -> Self {
        Self { shared: true, ..self }
    }
}

/// A test of `tests/known_failures.rs`.
fn named(test: &'static str) -> (&'static str, &'static str) {
    ("known_failures", test)
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
            named("shading_normals"),
            leaning_normals(grey),
        ),
        row(
            "the same on rough glass",
            "pbrt-v4 #385",
            named("shading_normals"),
            leaning_normals(rough_glass_kind()),
        ),
        row(
            "weights with specular chains",
            "pbrt-v4 #326",
            named("specular_chains_between_diffuse_surfaces"),
            specular_chains(),
        ),
        row(
            "next-event and emission densities mixed up",
            "found by reading",
            named("light_sampler_densities"),
            unequal_lamps(),
        ),
        row(
            "single-strategy images black or wrong",
            "pbrt-v4 #299",
            named("single_strategies"),
            ball(plastic_kind()),
        ),
        row(
            "roulette missing from the weights",
            "measured on LuxCore BIDIR 2.11",
            named("roulette"),
            long_paths(),
        )
        .shared(),
        row(
            "black through glass, light lost behind glass",
            "mitsuba3 #181, #916; pbrt-v3 #197; pbrt-v4 #228",
            ("strategies", "radiance_inside_glass"),
            bulb(),
        )
        .shared(),
        row("nested interfaces", "mitsuba3 #181", named("behind_glass"), nested_interfaces()),
        row(
            "caustics only with flipped normals",
            "BlendLuxCore #758",
            named("flipped_normals"),
            caster(true),
        )
        .shared(),
        row(
            "negative scale with vertex normals, lamps that flip",
            "pbrt-v3 #229",
            named("mirrored_transforms"),
            mirrored(true),
        )
        .shared(),
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
        row(
            "thin lens: splats miss vignetting or lens density",
            "pbrt-v4 #458",
            named("thin_lens"),
            lamp_out_of_focus(),
        ),
        row("crop window: splats normalised differently", "pbrt-v4 #347", named("crop_window"), cropped)
            .shared(),
        row(
            "orthographic cameras abort or are refused",
            "pbrt-v4 #279; LuxCore #667",
            named("all_cameras"),
            with(CameraKind::Orthographic),
        ),
        row("360° cameras abort or are refused", "mitsuba3 #198", named("all_cameras"), around),
        row("the pixel filter is ignored by light tracing", "LuxCore #413", named("pixel_filters"), filtered),
        row(
            "the same seed on every thread",
            "SORT #35; mitsuba #184; LuxCore #255",
            named("seeds"),
            ball(rough_glass_kind()),
        )
        .shared(),
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
        row(
            "narrow spots, spot cosines in emission densities",
            "pbrt-v4 #362, #468",
            named("narrow_spots"),
            spot(true, 3.0, 4.0),
        ),
        row("closed white furnace fails", "mitsuba #80", named("closed_furnace"), white).shared(),
        row(
            "a scene lit by an environment map alone is black",
            "sig-graphics-audio #42",
            named("environment_alone"),
            alone,
        )
        .shared(),
        row("a constant environment and nothing else", "mitsuba #80", named("environment_alone"), constant)
            .shared(),
        row(
            "a point light produces fireflies of 80,000 and more",
            "mitsuba #132",
            named("point_light_fireflies"),
            point_at_the_floor(),
        )
        .shared(),
        row(
            "large interiors: PT ≠ BDPT by percents",
            "pbrt-v3 #73, #87, #179",
            named("large_interior"),
            three_rooms(),
        ),
        row(
            "brightness depends on distance (a thousandth)",
            "LuxCore #678, #237",
            named("scale"),
            scaled(1e-3),
        )
        .shared(),
        row(
            "brightness depends on distance (a thousandfold)",
            "LuxCore #239, #216",
            named("scale"),
            scaled(1e3),
        )
        .shared(),
        row("irradiance off by π between light types", "LuxCore #580", named("irradiance"), lit_by(sun))
            .shared(),
        row(
            "textured emitters sampled wrongly",
            "mitsuba3 #1363; BlendLuxCore #79",
            named("emitters_with_textures"),
            textured_emitters(),
        ),
    ]
}
