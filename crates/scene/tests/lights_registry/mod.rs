//! The one list of lamps that every test of lamps runs over.

// Each test binary uses its own part of this.
#![allow(dead_code)]

mod daylight;
mod polygons;
mod thrown;

use std::f64::consts::PI;

use caustica_math::{Rgb, SampleStream, StreamId, Transform, Vec3, Wavelengths};
use caustica_scene::description::{
    Domain, EnvironmentRows, Image, ImageId, LightKind, Texture, TextureTransform,
};
use caustica_scene::light::{Anchor, EnvironmentLight, Light, LightPoint, LightQuery};
use caustica_scene::{Description, Scene};
use caustica_testkit::build;
use caustica_testkit::materials::attribute;
use caustica_testkit::seed::seed;

/// A lamp, alone in its scene, and its power in W (as luminance).
pub struct Example {
    pub name: &'static str,
    pub scene: Scene,
    pub power: f64,
    /// Places from which it is looked for, and the irradiance that a surface there gets whose normal points
    /// along the vector, where geometry tells.
    pub views: Vec<View>,
}

/// A place from which a lamp is looked for.
#[derive(Clone, Copy)]
pub struct View {
    pub from: Vec3,
    pub normal: Vec3,
    pub irradiance: Option<f64>,
}

pub const COLOUR: Rgb = Rgb::new(3.0, 1.0, 0.25);

pub fn luminance() -> f64 {
    f64::from(COLOUR.luminance())
}

/// How many kinds [`kind_of`] tells apart.
pub const KINDS: usize = 11;

/// A number for each kind of lamp. A kind that is missing here does not compile; one that is missing from
/// [`examples`] fails the test that asks for all numbers.
pub fn kind_of(example: &Example) -> usize {
    match example.scene.lamps().get(0) {
        Light::Area(_) if example.scene.surfaces().sphere(0).is_some() => 0,
        Light::Area(_) => 1,
        Light::Point { .. } => 2,
        Light::Spot(_) => 3,
        Light::Directional(_) => 4,
        Light::Environment(EnvironmentLight::Constant(_)) => 5,
        Light::Environment(EnvironmentLight::Map(_)) => 6,
        Light::Projector(_) => 7,
        Light::Collimated(_) => 8,
        Light::Environment(EnvironmentLight::Sky(_)) => 9,
        Light::Environment(EnvironmentLight::Sun(_)) => 10,
    }
}

impl Example {
    pub fn query(&self) -> LightQuery<'_> {
        self.scene.lights(Wavelengths::Rgb)
    }

    /// What the lamp's points are attached to.
    pub fn anchor(&self) -> Anchor {
        match self.scene.lamps().get(0) {
            Light::Area(_) | Light::Collimated(_) => Anchor::Surface,
            Light::Point { .. } | Light::Spot(_) | Light::Projector(_) => Anchor::Point,
            Light::Directional(_) | Light::Environment(_) => Anchor::Infinite,
        }
    }

    /// The point of the lamp that is seen from `from` in the unit direction `v`.
    pub fn seen(&self, from: Vec3, v: Vec3) -> Option<LightPoint> {
        if self.anchor() == Anchor::Infinite {
            return Some(LightPoint::infinite(0, v));
        }
        let ray = caustica_scene::bvh::Ray { origin: from, direction: v, t_max: f32::INFINITY };
        let p = self.scene.closest(&ray)?;
        self.scene.lamp_at(&p)
    }
}

/// A stream of random numbers of that name.
pub fn random(name: u32) -> SampleStream {
    SampleStream::new(StreamId { seed: seed(31), pixel: name, sample: 0, walk: 0 })
}

fn view(from: [f32; 3], towards: [f32; 3], irradiance: impl Into<Option<f64>>) -> View {
    let from = Vec3::from(from);
    View { from, normal: (Vec3::from(towards) - from).normalized(), irradiance: irradiance.into() }
}

/// Examples of every kind of lamp.
pub fn examples() -> Vec<Example> {
    let mut all = spheres();
    all.extend(meshes());
    all.extend(polygons::examples());
    all.extend(points());
    all.extend(thrown::examples());
    all.extend(infinite());
    all.extend(daylight::examples());
    all
}

fn finish(name: &'static str, d: Description, power: f64, views: Vec<View>) -> Example {
    let (scene, _) = Scene::new(d).unwrap();
    Example { name, scene, power, views }
}

fn spheres() -> Vec<Example> {
    let lamp = |emission: Texture| {
        let mut d = build::scene(8);
        let m = build::diffuse(&mut d, 0.0);
        let s = build::sphere(&mut d, [1.0, 2.0, 3.0], 0.5, m);
        d.shapes[s].emission = Some(emission);
        d
    };
    // Irradiance at normal incidence: π·L·(r/d)².
    let c = [1.0, 2.0, 3.0];
    let at = |d: f32| view([1.0 + d, 2.0, 3.0], c, PI * luminance() * (0.5 / f64::from(d)).powi(2));
    let inside = view([1.0, 2.2, 3.0], c, 0.0);
    let area = 4.0 * PI * 0.25;
    let halves = Texture::Checkerboard {
        delta: [0.0; 2],
        scale: [9.0, 0.5],
        shear: [0.0; 2],
        value1: COLOUR,
        value2: Rgb([COLOUR.0[0] * 0.1, COLOUR.0[1] * 0.1, COLOUR.0[2] * 0.1]),
    };
    vec![
        finish(
            "sphere",
            lamp(COLOUR.into()),
            PI * area * luminance(),
            vec![at(8.0), at(2.0), at(0.75), at(0.502), at(0.50002), inside],
        ),
        finish(
            "textured sphere",
            lamp(halves),
            PI * area * luminance() * 0.55,
            vec![view([-1.0, 2.5, 2.0], c, None), view([1.2, 2.0, 3.8], c, None)],
        ),
    ]
}

fn meshes() -> Vec<Example> {
    // One by two metres at height 2, facing down.
    let lamp = |emission: Texture, image: Option<Image>| {
        let mut d = build::scene(8);
        d.images.extend(image);
        let m = build::diffuse(&mut d, 0.0);
        let q = build::quad(&mut d, [-0.5, 2.0, -1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 2.0], m);
        d.shapes[q].emission = Some(emission);
        d
    };
    let below = view([0.0, 0.0, 0.0], [0.0, 9.0, 0.0], luminance() * from_below());
    let beside = view([3.0, 1.5, 0.4], [0.2, 2.0, 0.0], None);
    let above = view([0.0, 3.0, 0.0], [0.0, 0.0, 0.0], 0.0);
    let grey = |v: f32| Rgb::splat(v);
    // Of all texture look-ups that estimate its power, none finds the bright pixel.
    let mut pixels = vec![grey(0.0); 32 * 32];
    pixels[32 * 21 + 13] = grey(500.0);
    let spark = Image { width: 32, height: 32, pixels: pixels.into() };
    let steps = Image { width: 2, height: 2, pixels: [1.0, 2.0, 3.0, 10.0].map(grey).into() };
    let image = Texture::Image { image: ImageId(0), transform: TextureTransform::default() };
    let mut ball = build::scene(8);
    let m = build::diffuse(&mut ball, 0.0);
    let mesh = build::ellipsoid(6, [0.5, 0.25, 0.5]);
    let s = build::add(&mut ball, "ball", caustica_scene::description::Geometry::Mesh(mesh), m);
    ball.shapes[s].emission = Some(COLOUR.into());
    let around = vec![view([1.0, 0.3, 0.2], [0.0; 3], None), view([0.1, 0.27, 0.0], [0.0; 3], None)];
    let area = area_of(&ball);
    vec![
        finish("mesh", lamp(COLOUR.into(), None), PI * 2.0 * luminance(), vec![below, beside, above]),
        finish(
            "textured mesh",
            lamp(image, Some(steps)),
            PI * 2.0 * 4.0,
            vec![View { irradiance: None, ..below }, beside],
        ),
        finish("mesh with a spark", lamp(image, Some(spark)), PI * 2.0 * 500.0 / 1024.0, vec![]),
        finish("ball of triangles", ball, PI * area * luminance(), around),
        by_attribute(Domain::Vertex, vec![beside]),
        by_attribute(Domain::Face, vec![beside]),
    ]
}

/// One by two metres, of two triangles in colours of their own or of four corners, whose mean is that of 1 and 3.
fn by_attribute(domain: Domain, views: Vec<View>) -> Example {
    let mut d = build::scene(8);
    let m = build::diffuse(&mut d, 0.0);
    let q = build::quad(&mut d, [-0.5, 2.0, -1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 2.0], m);
    let emission = attribute(&mut d, q, domain, |i| Rgb::splat(if i % 2 == 0 { 1.0 } else { 3.0 }));
    d.shapes[q].emission = Some(emission);
    let mean = if domain == Domain::Face { 2.0 } else { (2.0 * 1.0 + 3.0) / 3.0 };
    let name = if domain == Domain::Face { "textured faces" } else { "textured corners" };
    finish(name, d, PI * 2.0 * mean, views)
}

fn area_of(d: &Description) -> f64 {
    let caustica_scene::description::Geometry::Mesh(mesh) = &d.shapes[0].geometry else { return 0.0 };
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        f64::from((b - a).cross(c - a).length()) * 0.5
    };
    mesh.triangles.iter().map(area).sum()
}

/// ∫ cos² / d² over the square lamp from two metres straight below its middle, by a fine grid.
fn from_below() -> f64 {
    let (n, mut sum) = (400, 0.0);
    for i in 0..n {
        for j in 0..n {
            let [x, z] = [i, j].map(|k| (f64::from(k) + 0.5) / f64::from(n) - 0.5);
            let d2 = 4.0 + x * x + 4.0 * z * z;
            sum += 4.0 / (d2 * d2);
        }
    }
    sum * 2.0 / f64::from(n * n)
}

fn points() -> Vec<Example> {
    let position = [1.0, 2.0, 3.0];
    let lamp = |kind| {
        let mut d = build::scene(8);
        build::light(&mut d, kind);
        d
    };
    let on_axis = view([1.0, 2.0, 7.0], position, luminance() / 16.0);
    let spot = |inner_angle: f32, outer_angle: f32| {
        let d = lamp(LightKind::Spot {
            position,
            direction: [0.0, 0.0, 3.0],
            intensity: COLOUR,
            inner_angle,
            outer_angle,
        });
        let one_minus_cos = |a: f32| 2.0 * libm::sin(f64::from(a).to_radians() / 2.0).powi(2);
        (d, PI * (one_minus_cos(inner_angle) + one_minus_cos(outer_angle)) * luminance())
    };
    let mut all = vec![finish(
        "point",
        lamp(LightKind::Point { position, intensity: COLOUR }),
        4.0 * PI * luminance(),
        vec![on_axis, view([1.0, 0.0, 3.0], position, luminance() / 4.0)],
    )];
    let behind = view([1.0, 2.0, 1.0], position, 0.0);
    for (name, inner, outer) in [
        ("spot", 20.0, 35.0),
        ("narrow spot", 0.5, 1.0),
        ("laser", 0.01, 0.02),
        ("spot with a sharp rim", 30.0, 30.0),
        ("laser with a sharp rim", 0.5, 0.5),
    ] {
        let (d, power) = spot(inner, outer);
        all.push(finish(name, d, power, vec![on_axis, behind]));
    }
    let (d, power) = spot(100.0, 180.0);
    all.push(finish("wide spot", d, power, vec![on_axis]));
    all
}

/// A map with black regions, a sun, and bright pixels at both poles and at the seam.
fn sky() -> Image {
    let (w, h) = (32, 16);
    let mut pixels: Vec<Rgb> = (0..w * h)
        .map(|i| {
            let (x, y) = (i % w, i / w);
            if y >= 9 || x == 7 { Rgb::BLACK } else { Rgb::new(0.2, 0.1 * y as f32, 0.02 * x as f32) }
        })
        .collect();
    for (x, y, v) in [(20, 3, 2000.0), (5, 0, 300.0), (31, 6, 40.0), (0, 15, 200.0), (0, 12, 9.0)] {
        pixels[y * w + x] = Rgb::splat(v);
    }
    Image { width: w as u32, height: h as u32, pixels: pixels.into() }
}

fn infinite() -> Vec<Example> {
    let lamp = |kind, image: Option<Image>| {
        let mut d = build::scene(8);
        d.images.extend(image);
        let m = build::diffuse(&mut d, 0.5);
        build::sphere(&mut d, [5.0, 0.0, 0.0], 0.5, m);
        build::light(&mut d, kind);
        d
    };
    // The radius of the scene's bounds is what power at infinity refers to.
    let with_radius = |name, d: Description, per_area: f64, views| {
        let (scene, _) = Scene::new(d).unwrap();
        let radius = f64::from(scene.bounding_sphere().1);
        Example { name, scene, power: PI * radius * radius * per_area, views }
    };
    let up = view([0.0; 3], [0.0, 1.0, 0.0], None);
    let slanted = view([0.0; 3], [0.0, 0.8, 0.6], None);
    let directional = LightKind::Directional { direction: [0.0, -2.0, 0.0], irradiance: COLOUR };
    let constant = LightKind::Constant { radiance: COLOUR };
    let to_world = Transform::rotate(50.0, [1.0, 2.0, 0.5]);
    let turned = LightKind::Environment { image: ImageId(0), to_world, scale: 2.0, rows: Default::default() };
    let upright = LightKind::Environment {
        image: ImageId(0),
        to_world: Transform::IDENTITY,
        scale: 1.0,
        rows: EnvironmentRows::Inside,
    };
    let on_poles = LightKind::Environment {
        image: ImageId(0),
        to_world: Transform::IDENTITY,
        scale: 1.0,
        rows: EnvironmentRows::OnPoles,
    };
    let known = |v: View, e: f64| View { irradiance: Some(e), ..v };
    let mut all = vec![
        with_radius(
            "directional",
            lamp(directional, None),
            luminance(),
            vec![known(up, luminance()), known(slanted, 0.8 * luminance())],
        ),
        with_radius(
            "constant",
            lamp(constant, None),
            4.0 * PI * luminance(),
            vec![known(up, PI * luminance()), known(slanted, PI * luminance())],
        ),
    ];
    let maps = [
        ("environment map", upright),
        ("turned environment map", turned),
        ("environment map with rows on its poles", on_poles),
    ];
    for (name, kind) in maps {
        let mut example = with_radius(name, lamp(kind, Some(sky())), 1.0, vec![up, slanted]);
        example.power *= over_sphere(&example, |_| 1.0);
        for i in 0..2 {
            let n = example.views[i].normal;
            example.views[i].irradiance = Some(over_sphere(&example, |d| f64::from(n.dot(d).max(0.0))));
        }
        all.push(example);
    }
    let one = Image { width: 1, height: 1, pixels: [COLOUR].into() };
    all.push(with_radius(
        "environment of one pixel",
        lamp(upright, Some(one)),
        4.0 * PI * luminance(),
        vec![known(slanted, PI * luminance())],
    ));
    all
}

/// ∫ L·f dω over the sphere, by a fine grid of directions.
fn over_sphere(example: &Example, f: impl Fn(Vec3) -> f64) -> f64 {
    let (rows, columns) = (500, 1000);
    let query = example.query();
    let mut sum = 0.0;
    for i in 0..rows {
        let theta = PI * (f64::from(i) + 0.5) / f64::from(rows);
        let (sin, cos) = libm::sincos(theta);
        for j in 0..columns {
            let (s, c) = libm::sincos(2.0 * PI * (f64::from(j) + 0.5) / f64::from(columns));
            let d = Vec3::new((sin * s) as f32, cos as f32, (sin * c) as f32);
            let radiance = query.radiance(&LightPoint::infinite(0, d), -d);
            sum += sin * f64::from(Wavelengths::Rgb.luminance(radiance)) * f(d);
        }
    }
    sum * 2.0 * PI * PI / f64::from(rows * columns)
}
