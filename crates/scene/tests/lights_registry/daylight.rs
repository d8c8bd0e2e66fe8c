//! The sky and its sun.

use std::f64::consts::PI;

use caustica_math::{Frame, Rgb, Transform, Vec3, Wavelengths};
use caustica_scene::Scene;
use caustica_scene::description::{Daylight, LightKind};
use caustica_scene::light::LightPoint;
use caustica_testkit::build;

use super::{Example, View, over_sphere, view};

/// With the sun at that height, in degrees, over +y.
pub fn daylight(height: f64, turbidity: f32) -> Daylight {
    let (s, c) = libm::sincos(height.to_radians());
    Daylight { to_world: Transform::IDENTITY, to_sun: [0.0, c as f32, s as f32], turbidity }
}

pub fn examples() -> Vec<Example> {
    let sky = |daylight| LightKind::Sky { daylight, albedo: Rgb::new(0.1, 0.3, 0.6), scale: 2.0 };
    let sun = |height, aperture, darkened| LightKind::Sun {
        daylight: daylight(height, 3.5),
        aperture,
        scale: 0.5,
        darkened,
    };
    let turned = Daylight { to_world: Transform::rotate(50.0, [1.0, 2.0, 0.5]), ..daylight(30.0, 2.0) };
    let suns = [
        ("sun", sun(40.0, 0.5358, true), 0.5358),
        ("narrow sun", sun(25.0, 0.01, false), 0.01),
        ("wide sun", sun(60.0, 40.0, false), 40.0),
        ("sun cut by the horizon", sun(4.0, 30.0, true), 30.0),
    ];
    let mut all: Vec<Example> = suns.map(|(name, kind, aperture)| under_a_sun(name, kind, aperture)).into();
    all.push(under_a_sky("sky", sky(daylight(15.0, 6.0))));
    all.push(under_a_sky("turned sky", sky(turned)));
    all
}

/// A ball in that light, with the power of an irradiance of one.
fn lit(name: &'static str, kind: LightKind) -> Example {
    let mut d = build::scene(8);
    let m = build::diffuse(&mut d, 0.5);
    build::sphere(&mut d, [5.0, 0.0, 0.0], 0.5, m);
    build::light(&mut d, kind);
    let (scene, warnings) = Scene::new(d).unwrap();
    assert!(warnings.is_empty(), "{name}: {warnings:?}");
    let radius = f64::from(scene.bounding_sphere().1);
    Example { name, scene, power: PI * radius * radius, views: vec![] }
}

fn under_a_sky(name: &'static str, kind: LightKind) -> Example {
    let mut example = lit(name, kind);
    example.power *= over_sphere(&example, |_| 1.0);
    for towards in [[0.0, 0.6, 0.8], [0.0, 0.8, 0.6]] {
        let v = view([0.0; 3], towards, None);
        let irradiance = over_sphere(&example, |d| f64::from(v.normal.dot(d).max(0.0)));
        example.views.push(View { irradiance: Some(irradiance), ..v });
    }
    example
}

fn under_a_sun(name: &'static str, kind: LightKind, aperture: f64) -> Example {
    let mut example = lit(name, kind);
    let LightKind::Sun { daylight, .. } = kind else { panic!("a sun") };
    let middle = Vec3::from(daylight.to_sun);
    let over = |example: &Example, f: &dyn Fn(Vec3) -> f64| over_disc(example, middle, aperture, f);
    example.power *= over(&example, &|_| 1.0);
    for v in [view([0.0; 3], daylight.to_sun, None), view([0.0; 3], [0.6, 0.0, 0.8], None)] {
        let irradiance = over(&example, &|d| f64::from(v.normal.dot(d).max(0.0)));
        example.views.push(View { irradiance: Some(irradiance), ..v });
    }
    example
}

/// ∫ L·f dω over a disc of that diameter, by a fine grid of directions.
fn over_disc(example: &Example, middle: Vec3, degrees: f64, f: impl Fn(Vec3) -> f64) -> f64 {
    let frame = Frame::from_normal(middle);
    let (n, query) = (400, example.query());
    // It is as much wider as directions are rounded.
    let h = 2.0 * (libm::sin(degrees.to_radians() / 4.0) + 1.25e-7).powi(2);
    let mut sum = 0.0;
    for i in 0..n * n {
        let [u, v] = [i % n, i / n].map(|k| (f64::from(k) + 0.5) / f64::from(n));
        let (r, z) = ((u * h * (2.0 - u * h)).sqrt(), 1.0 - u * h);
        let (s, c) = libm::sincos(2.0 * PI * v);
        let d = frame.to_world(Vec3::new((r * c) as f32, (r * s) as f32, z as f32));
        let radiance = query.radiance(&LightPoint::infinite(0, d), -d);
        sum += f64::from(Wavelengths::Rgb.luminance(radiance)) * f(d);
    }
    sum * 2.0 * PI * h / f64::from(n * n)
}
