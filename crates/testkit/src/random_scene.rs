//! Random scenes that are valid: what fuzzers and property tests render.
//!
//! A scene is a function of bytes, so that a fuzzer that changes bytes changes a part of the scene, and a shorter
//! input is a simpler one. [`bytes_of_seed`] makes inputs out of nothing.

mod choices;
mod things;

use caustica_math::{Filter, Rgb, Transform, stream::mix64};
use caustica_scene::Description;
use caustica_scene::description::{Camera, CameraKind, Crop, Daylight, FilmSettings, Image, LightKind};

use crate::build::light;
pub use choices::Choices;

/// How large scenes are: what one unit is in the world.
const SCALES: [f32; 8] = [1.0, 1.0, 1.0, 1e-3, 1e3, 1e-6, 1e6, 1e2];

/// Parameters of filters that make hardly one.
const PARAMETERS: [f32; 6] = [1.0, 1e-6, 0.01, 30.0, -1e6, 1e30];

/// Bytes for a scene, by a seed.
pub fn bytes_of_seed(seed: u64) -> Vec<u8> {
    let word = |i: u64| mix64(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ i).to_le_bytes();
    (0..64).flat_map(word).collect()
}

/// A scene: one to six shapes of any material, now and then one of them as instances, meshes with colours of their own,
/// up to three lamps beside those that are surfaces, any camera, and a film of a few pixels with any filter. A quarter of all scenes has numbers at the edges of what is valid.
///
/// Everything is valid for [`caustica_scene::Scene::new`] but what rounding may spoil at extreme scales.
pub fn random_scene(choices: &mut Choices) -> Description {
    let mut d = Description::default();
    choices.set_wild();
    let scale = *choices.pick(if choices.is_wild() { &SCALES } else { &SCALES[..1] });
    let pixels: Vec<Rgb> = (0..16).map(|_| choices.light()).collect();
    d.add_image(Image { width: 4, height: 4, pixels: pixels.into() });
    let pixels: Vec<Rgb> = (0..6).map(|_| choices.albedo()).collect();
    d.add_image(Image { width: 3, height: 2, pixels: pixels.into() });
    film(&mut d, choices);
    camera(&mut d, scale, choices);
    for _ in 0..=choices.below(6) {
        things::shape(&mut d, scale, choices);
    }
    // Lamps name shapes by their numbers, which are settled by then.
    if choices.below(4) == 3 {
        things::instances(&mut d, scale, choices);
    }
    for _ in 0..choices.below(4) {
        lamp(&mut d, scale, choices);
    }
    d
}

fn film(d: &mut Description, choices: &mut Choices) {
    let (width, height) = (1 + choices.below(8) as u32, 1 + choices.below(6) as u32);
    let crop = choices.once_in(4).then(|| {
        let (x, y) = (choices.below(width as usize) as u32, choices.below(height as usize) as u32);
        Crop { x, y, width: 1.max(width - x), height: 1.max(height - y) }
    });
    let radius = 0.1 + 3.0 * choices.unit();
    let parameter = if choices.is_wild() { *choices.pick(&PARAMETERS) } else { choices.signed() };
    let filter = match choices.below(6) {
        0 => Filter::Box { radius: 0.5 },
        1 => Filter::Box { radius },
        2 => Filter::Tent { radius },
        3 => Filter::Gaussian { radius, stddev: parameter.abs().max(1e-6) },
        4 => Filter::Lanczos { lobes: 1 + choices.below(4) as u32 },
        _ => Filter::Mitchell { radius, b: parameter, c: choices.signed() },
    };
    d.film = FilmSettings { width, height, crop, filter };
}

fn camera(d: &mut Description, scale: f32, choices: &mut Choices) {
    let fov = if choices.is_wild() {
        *choices.pick(&[60.0, 1e-3, 1.0, 179.0, 179.99])
    } else {
        5.0 + 165.0 * choices.unit()
    };
    let kind = match choices.below(6) {
        0 => CameraKind::Perspective { fov },
        1 => CameraKind::ThinLens {
            fov,
            aperture_radius: choices.unit() * scale,
            focus_distance: (0.1 + 4.0 * choices.unit()) * scale,
        },
        2 => CameraKind::Orthographic,
        3 => CameraKind::RadianceMeter,
        4 => CameraKind::IrradianceMeter { shape: 0 },
        _ => CameraKind::Environment,
    };
    let s = f64::from(scale);
    let place = |choices: &mut Choices| choices.vector().map(|c| f64::from(c) * 2.0 * s);
    let mut to_world = Transform::look_at([0.0, 0.0, -4.0 * s], [0.0; 3], [0.0, 1.0, 0.0]);
    if choices.once_in(2) {
        let turned = Transform::look_at(place(choices), place(choices), [0.1, 1.0, 0.0]);
        if turned.is_invertible() {
            to_world = turned;
        }
    }
    if kind == CameraKind::Orthographic {
        to_world = Transform::scale([2.0 * s; 3]).then(to_world);
    }
    let principal_point = if choices.once_in(4) { [choices.unit(), choices.unit()] } else { [0.5; 2] };
    let hides_lamps = choices.once_in(8);
    let (near, far) = (1e-4 * scale, 1e4 * scale);
    d.camera = Camera { kind, to_world, near, far, principal_point, hides_lamps, origin: None };
}

fn lamp(d: &mut Description, scale: f32, choices: &mut Choices) {
    let position = choices.vector().map(|c| 2.0 * c * scale);
    let direction = choices.direction();
    let colour = choices.light();
    // Light spreads over the square of the scene's size.
    let spread = colour * (scale * scale);
    let kind = match choices.below(10) {
        0 => LightKind::Point { position, intensity: spread },
        1 => {
            let narrowest = if choices.is_wild() { 1e-3 } else { 0.5 };
            let outer_angle = narrowest + 179.5 * choices.unit();
            let inner_angle = outer_angle * choices.unit();
            LightKind::Spot { position, direction, intensity: spread, inner_angle, outer_angle }
        }
        2 => LightKind::Directional { direction, irradiance: colour },
        3 => LightKind::Constant { radiance: colour },
        4 => LightKind::Sky {
            daylight: daylight(choices),
            albedo: choices.albedo().map(|c| c.min(1.0)),
            scale: 4.0 * choices.unit(),
        },
        5 => {
            let narrowest = if choices.is_wild() { 0.01 } else { 0.5 };
            let aperture = narrowest + 170.0 * choices.unit() * choices.unit();
            let (scale, darkened) = (4.0 * choices.unit(), choices.once_in(2));
            LightKind::Sun { daylight: daylight(choices), aperture, scale, darkened }
        }
        6 => projector(position, direction, (scale * scale, choices)),
        7 => linear_spot(position, direction, (spread, choices)),
        8 => match things::collimated(d, choices) {
            Some(kind) => kind,
            None => LightKind::Constant { radiance: colour },
        },
        _ => LightKind::Environment {
            image: caustica_scene::description::ImageId(choices.below(2) as u32),
            to_world: Transform::rotate(f64::from(choices.signed()) * 180.0, [0.0, 1.0, 0.3]),
            scale: choices.unit(),
            rows: Default::default(),
        },
    };
    light(d, kind);
}

/// By day.
fn daylight(choices: &mut Choices) -> Daylight {
    let to_world = Transform::rotate(f64::from(choices.signed()) * 180.0, [1.0, 0.2, 0.3]);
    let [x, y, z] = choices.direction();
    let to_sun = to_world.vector(caustica_math::Vec3::new(x, y, z.abs() + 0.01)).to_array();
    Daylight { to_world, to_sun, turbidity: 1.0 + 9.0 * choices.unit() }
}

/// A frame at that place whose +z goes in that direction.
fn aimed([x, y, z]: [f32; 3], direction: [f32; 3]) -> Transform {
    let at = [x, y, z].map(f64::from);
    let target = [0, 1, 2].map(|i| at[i] + f64::from(direction[i]));
    Transform::look_at(at, target, [1.0, 0.0, 0.3])
}

fn projector(position: [f32; 3], direction: [f32; 3], (scale, choices): (f32, &mut Choices)) -> LightKind {
    LightKind::Projector {
        to_world: aimed(position, direction),
        irradiance: things::texture(true, choices),
        scale: scale * choices.unit(),
        fov: if choices.is_wild() {
            *choices.pick(&[60.0, 0.01, 179.0])
        } else {
            5.0 + 150.0 * choices.unit()
        },
        aspect: 0.25 + 3.0 * choices.unit(),
    }
}

fn linear_spot(
    position: [f32; 3],
    direction: [f32; 3],
    (intensity, choices): (Rgb, &mut Choices),
) -> LightKind {
    let outer_angle = if choices.is_wild() {
        *choices.pick(&[40.0, 1e-3, 89.9, 180.0])
    } else {
        1.0 + 88.0 * choices.unit()
    };
    let picture = (outer_angle < 90.0 && choices.once_in(2)).then(|| things::texture(false, choices));
    let inner_angle = outer_angle * choices.unit();
    let to_world = aimed(position, direction);
    LightKind::LinearSpot { to_world, intensity, picture, inner_angle, outer_angle }
}
