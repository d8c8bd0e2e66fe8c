//! Lamps that throw pictures and beams.

use std::f64::consts::PI;

use caustica_math::{Rgb, Transform, Vec3};
use caustica_scene::description::{Image, ImageId, LightKind, Texture, TextureTransform};
use caustica_testkit::build;

use super::{COLOUR, Example, finish, luminance, view};

const AT: [f64; 3] = [1.0, 2.0, 3.0];

fn frame() -> Transform {
    Transform::look_at(AT, [1.5, 2.5, 7.0], [0.0, 1.0, 0.2])
}

fn alone(kind: LightKind, image: Option<Image>) -> caustica_scene::Description {
    let mut d = build::scene(8);
    d.images.extend(image);
    build::light(&mut d, kind);
    d
}

/// A picture without symmetries, dark in places, with a bright pixel in a corner.
fn picture() -> Image {
    let pixel = |i: u32| if i % 5 == 3 { Rgb::BLACK } else { Rgb::splat(0.2 + (i * 7 % 11) as f32 / 10.0) };
    let mut pixels: Vec<Rgb> = (0..48).map(pixel).collect();
    pixels[47] = Rgb::splat(20.0);
    Image { width: 8, height: 6, pixels: pixels.into() }
}

fn mean(image: &Image) -> f64 {
    image.pixels.iter().map(|p| f64::from(p.luminance())).sum::<f64>() / image.pixels.len() as f64
}

pub fn examples() -> Vec<Example> {
    let mut all = spots();
    all.extend(projectors());
    all.extend(collimated());
    all
}

fn spots() -> Vec<Example> {
    let lamp = |picture, inner_angle, outer_angle| LightKind::LinearSpot {
        to_world: frame(),
        intensity: COLOUR,
        picture,
        inner_angle,
        outer_angle,
    };
    // 2π(1 − (sin c − sin b)/(c − b)).
    let power = |inner: f64, outer: f64| {
        let [b, c] = [inner, outer].map(f64::to_radians);
        2.0 * PI * (1.0 - (libm::sin(c) - libm::sin(b)) / (c - b)) * luminance()
    };
    let on_axis = view([1.5, 2.5, 7.0], [1.0, 2.0, 3.0], luminance() / 16.5);
    let behind = view([0.5, 1.5, -1.0], [1.0, 2.0, 3.0], 0.0);
    let middle = Texture::Image { image: ImageId(0), transform: TextureTransform::default() };
    let image = picture();
    let mut all: Vec<Example> = [("linear spot", 20.0, 35.0), ("narrow linear spot", 0.5, 1.0)]
        .map(|(name, inner, outer)| {
            let d = alone(lamp(None, inner, outer), None);
            finish(name, d, power(inner.into(), outer.into()), vec![on_axis, behind])
        })
        .into();
    let d = alone(lamp(None, 70.0, 160.0), None);
    all.push(finish("wide linear spot", d, power(70.0, 160.0), vec![on_axis]));
    // Its power is found by going through all directions.
    let mut textured =
        finish("textured spot", alone(lamp(Some(middle), 30.0, 40.0), Some(image)), 1.0, vec![]);
    textured.power = over_cone(&textured, 40.0);
    all.push(textured);
    all
}

/// ∫ of the intensity over a cone around the axis, by a fine grid.
fn over_cone(example: &Example, degrees: f64) -> f64 {
    let (n, outer) = (600, degrees.to_radians());
    let query = example.query();
    let at = caustica_scene::light::LightPoint { at: frame().point(Vec3::ZERO), ..point() };
    let mut sum = 0.0;
    for i in 0..n {
        let theta = outer * (f64::from(i) + 0.5) / f64::from(n);
        let (sin, cos) = libm::sincos(theta);
        for j in 0..n {
            let (s, c) = libm::sincos(2.0 * PI * (f64::from(j) + 0.5) / f64::from(n));
            let local = Vec3::new((sin * c) as f32, (sin * s) as f32, cos as f32);
            let d = frame().vector(local).normalized();
            let intensity = query.radiance(&at, d);
            sum += sin * f64::from(caustica_math::Wavelengths::Rgb.luminance(intensity));
        }
    }
    sum * outer * 2.0 * PI / f64::from(n * n)
}

fn point() -> caustica_scene::light::LightPoint {
    use caustica_scene::light::{Anchor, LightPoint};
    LightPoint { anchor: Anchor::Point, ..LightPoint::infinite(0, Vec3::Z) }
}

fn projectors() -> Vec<Example> {
    let lamp = |irradiance, fov| LightKind::Projector {
        to_world: frame(),
        irradiance,
        scale: 2.0,
        fov,
        aspect: 1.5,
    };
    let half = |fov: f64| libm::tan(0.5 * fov.to_radians());
    let area = |fov: f64| 4.0 * half(fov) * half(fov) / 1.5;
    let image = picture();
    let on_picture = Texture::Image { image: ImageId(0), transform: TextureTransform::default() };
    let placed = Texture::Image {
        image: ImageId(0),
        transform: TextureTransform { scale: [1.5, 2.0], offset: [0.2, 0.1] },
    };
    // Across the axis at a distance, the irradiance is the picture's over its square.
    let on_axis = view([1.5, 2.5, 7.0], [1.0, 2.0, 3.0], 2.0 * luminance() / 16.5);
    let behind = view([0.5, 1.5, -1.0], [1.0, 2.0, 3.0], 0.0);
    let bright = 2.0 * mean(&image);
    let mut turned = finish(
        "textured and placed projector",
        alone(lamp(placed, 60.0), Some(image.clone())),
        1.0,
        vec![behind],
    );
    turned.power = over_cone(&turned, 60.0);
    vec![
        finish(
            "projector",
            alone(lamp(COLOUR.into(), 40.0), None),
            2.0 * area(40.0) * luminance(),
            vec![on_axis, behind],
        ),
        finish(
            "textured projector",
            alone(lamp(on_picture, 60.0), Some(image.clone())),
            bright * area(60.0),
            vec![behind],
        ),
        finish(
            "textured wide projector",
            alone(lamp(on_picture, 130.0), Some(image)),
            bright * area(130.0),
            vec![],
        ),
        turned,
    ]
}

/// A rectangle of one by two, and a ball, both by their normals alone. Nobody finds them by looking.
fn collimated() -> Vec<Example> {
    let mut beam = build::scene(8);
    let m = build::diffuse(&mut beam, 0.0);
    let q = build::quad(&mut beam, [-0.5, 2.0, -1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 2.0], m);
    build::light(&mut beam, LightKind::Collimated { shape: q as u32, exitance: COLOUR.into() });
    let mut ball = build::scene(8);
    let m = build::diffuse(&mut ball, 0.0);
    let s = build::sphere(&mut ball, [1.0, 2.0, 3.0], 0.5, m);
    build::light(&mut ball, LightKind::Collimated { shape: s as u32, exitance: COLOUR.into() });
    let below = view([0.0, 0.0, 0.0], [0.0, 9.0, 0.0], 0.0);
    vec![
        finish("beam along the normals", beam, 2.0 * luminance(), vec![below]),
        finish("ball along its normals", ball, PI * luminance(), vec![below]),
    ]
}
