//! A million lamps: loading and sampling take no longer than a million other things, and none is lost.

use caustica_math::{SampleStream, StreamId, Vec3, Wavelengths};
use caustica_scene::description::{Geometry, Mesh};
use caustica_scene::light::LightPoint;
use caustica_scene::{Description, Scene};
use caustica_testkit::build;

const MILLION: u32 = 1_000_000;

fn random() -> SampleStream {
    SampleStream::new(StreamId { seed: 1, pixel: 2, sample: 3, walk: 4 })
}

fn floor() -> Description {
    let mut d = build::scene(4);
    let m = build::diffuse(&mut d, 0.5);
    build::quad(&mut d, [-9.0, -1.0, -9.0], [0.0, 0.0, 18.0], [18.0, 0.0, 0.0], m);
    d
}

fn made(d: Description) -> Scene {
    let (scene, warnings) = Scene::new(d).unwrap();
    assert_eq!(warnings, []);
    scene
}

/// Samples both ways; all are finite.
fn sample(scene: &Scene) {
    let (lights, mut s) = (scene.lights(Wavelengths::Rgb), random());
    for _ in 0..10_000 {
        let (choice, u, v) = (s.next_2d(), s.next_2d(), s.next_2d());
        let e = lights.sample_emission(choice, u, v).unwrap();
        assert!(e.pdf.point.0.is_finite() && e.pdf.point.0 > 0.0);
        if let Some(t) = lights.sample_towards(Vec3::ZERO, choice, u) {
            assert!(t.pdf.0.is_finite() && t.distance > 0.0);
        }
    }
}

/// All but one of them are weak.
#[test]
fn a_million_point_lights() {
    let mut d = floor();
    let mut s = random();
    for i in 0..MILLION {
        let [x, z] = s.next_2d();
        build::point_light(&mut d, [18.0 * x - 9.0, 1.0, 18.0 * z - 9.0], if i == 7 { 1e9 } else { 1e-3 });
    }
    let scene = made(d);
    assert_eq!(scene.lamps().len() as u32, MILLION);
    let lights = scene.lights(Wavelengths::Rgb);
    let lost = (0..MILLION).filter(|i| {
        let light = LightPoint::infinite(*i, Vec3::Y);
        lights.towards_pdf(Vec3::ZERO, &light).0 <= 0.0
    });
    assert_eq!(lost.count(), 0);
    sample(&scene);
}

/// A square of many small triangles and one large one, as one lamp.
#[test]
fn a_million_triangles_that_emit() {
    let mut d = floor();
    let n = 707;
    let place = |i: u32, j: u32| Vec3::new(i as f32 * 1e-3, 1.0, j as f32 * 1e-3);
    let mut mesh = Mesh {
        positions: (0..=n).flat_map(|i| (0..=n).map(move |j| place(i, j))).collect(),
        ..Mesh::default()
    };
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let a = i * (n + 1) + j;
        mesh.triangles.extend([[a, a + n + 2, a + 1], [a, a + n + 1, a + n + 2]].map(|[a, b, c]| [a, b, c]));
    }
    let first = mesh.positions.len() as u32;
    mesh.positions.extend([
        Vec3::new(-9.0, 1.0, -9.0),
        Vec3::new(9.0, 1.0, -9.0),
        Vec3::new(-9.0, 1.0, -1.0),
    ]);
    mesh.triangles.push([first, first + 1, first + 2]);
    let m = build::diffuse(&mut d, 0.5);
    let lamp = build::add(&mut d, "lamp", Geometry::Mesh(mesh), m);
    build::emit(&mut d, lamp, 1.0);
    let scene = made(d);
    let (lights, flat) = (scene.lights(Wavelengths::Rgb), scene.surfaces().shapes[lamp]);
    let lost = (flat.first_primitive..flat.first_primitive + flat.primitive_count).filter(|t| {
        let p = scene.surfaces().triangle_point(*t, 0.3, 0.3);
        lights.emission_pdf(&LightPoint::on_surface(0, &p), p.normal).point.0 <= 0.0
    });
    assert_eq!(lost.count(), 0);
    sample(&scene);
}

/// Lamps of their own: not each of so many is looked at for what it faces.
#[test]
fn a_hundred_thousand_spheres_and_quads_that_emit() {
    let mut d = floor();
    let mut s = random();
    for i in 0..100_000 {
        let [x, z] = s.next_2d().map(|c| 18.0 * c - 9.0);
        let lamp = if i % 2 == 0 {
            build::sphere(&mut d, [x, 0.5, z], 1e-3, caustica_scene::description::MaterialId(0))
        } else {
            let m = caustica_scene::description::MaterialId(0);
            build::quad(&mut d, [x, 1.0 + i as f32 * 1e-5, z], [1e-2, 0.0, 0.0], [0.0, 0.0, 1e-2], m)
        };
        build::emit(&mut d, lamp, 1.0);
    }
    let scene = made(d);
    assert_eq!(scene.lamps().len(), 100_000);
    sample(&scene);
}
