//! Everything that [`Scene::new`] refuses or warns about; and that good scenes pass in silence.

use caustica_math::{Rgb, Transform, Vec3};
use caustica_scene::description::{
    CameraKind, Crop, Geometry, Image, ImageId, LightKind, MaterialId, MaterialKind, Mesh, PixelLookup,
    Roughness, Texture, TextureTransform, Wrap,
};
use caustica_scene::{Description, Diagnostic, Origin, Scene, Severity};
use caustica_testkit::build;

const PICTURE: Texture = Texture::Image {
    image: ImageId(3),
    transform: TextureTransform {
        scale: [1.0; 2],
        shear: [0.0; 2],
        offset: [0.0; 2],
        wrap: Wrap::Repeat,
        filter: PixelLookup::Bilinear,
    },
};

fn place(line: u32) -> Option<Origin> {
    Some(Origin { file: "scene.xml".into(), line, column: 0, span: None })
}

/// A lamp above a floor: nothing to complain about.
fn good() -> Description {
    let mut d = build::scene(8);
    d.camera.origin = place(1);
    let m = build::diffuse(&mut d, 0.5);
    d.materials[0].origin = place(2);
    let floor = build::quad(&mut d, [-2.0, 0.0, -2.0], [0.0, 0.0, 4.0], [4.0, 0.0, 0.0], m);
    d.shapes[floor].name = "floor".into();
    d.shapes[floor].origin = place(3);
    let lamp = build::quad(&mut d, [-1.0, 2.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], m);
    d.shapes[lamp].name = "lamp".into();
    d.shapes[lamp].origin = place(4);
    build::emit(&mut d, lamp, 1.0);
    d
}

fn refused(change: impl FnOnce(&mut Description)) -> String {
    let mut d = good();
    change(&mut d);
    let e = Scene::new(d).expect_err("it is refused");
    assert_eq!(e.severity, Severity::Error);
    e.to_string()
}

fn warnings(change: impl FnOnce(&mut Description)) -> Vec<String> {
    let mut d = good();
    change(&mut d);
    let (_, warnings) = Scene::new(d).unwrap();
    assert!(warnings.iter().all(|w| w.severity == Severity::Warning));
    warnings.iter().map(Diagnostic::to_string).collect()
}

/// The change leads to one warning that begins so.
#[track_caller]
fn warns(begin: &str, change: impl FnOnce(&mut Description)) {
    let w = warnings(change);
    assert!(w.len() == 1 && w[0].starts_with(begin), "{w:?}");
}

#[track_caller]
fn refuses(begin: &str, change: impl FnOnce(&mut Description)) {
    let e = refused(change);
    assert!(e.starts_with(begin), "{e}");
}

fn lamp(d: &mut Description, kind: LightKind) {
    d.lights.push(caustica_scene::description::Light { kind, origin: place(9) });
}

#[test]
fn a_good_scene_is_silent() {
    assert_eq!(warnings(|_| ()), Vec::<String>::new());
}

#[test]
fn cameras() {
    refuses("scene.xml:1: the camera's transform cannot be inverted", |d| {
        d.camera.to_world = Transform::scale([1.0, 0.0, 1.0]);
    });
    refuses("scene.xml:1: the camera's transform shears space", |d| {
        d.camera.to_world = Transform::rotate(30.0, [0.0, 0.0, 1.0]).then(Transform::scale([1.0, 2.0, 1.0]));
    });
    for (near, far) in [(1.0, 1.0), (2.0, 1.0), (-1.0, 1.0), (f32::NAN, 1.0), (1.0, f32::NAN)] {
        refuses("scene.xml:1: the camera's far clip", |d| (d.camera.near, d.camera.far) = (near, far));
    }
    let lens =
        |fov, aperture_radius, focus_distance| CameraKind::ThinLens { fov, aperture_radius, focus_distance };
    let (nan, inf) = (f32::NAN, f32::INFINITY);
    for kind in [
        CameraKind::Perspective { fov: 0.0 },
        CameraKind::Perspective { fov: 180.0 },
        CameraKind::Perspective { fov: nan },
        lens(50.0, -0.1, 1.0),
        lens(50.0, nan, 1.0),
        lens(50.0, inf, 1.0),
        lens(50.0, 0.1, 0.0),
        lens(50.0, 0.1, nan),
        lens(50.0, 0.1, inf),
    ] {
        refuses("scene.xml:1: the camera's field of view", |d| d.camera.kind = kind);
    }
    // A mirror, and scales along the axes of the camera, are no shear.
    let mirrored = Transform::scale([-1.0, 3.0, 2.0]).then(Transform::rotate(20.0, [1.0, 1.0, 1.0]));
    assert!(warnings(|d| d.camera.to_world = mirrored).is_empty());
}

#[test]
fn references() {
    refuses("scene.xml:3: floor names a material, an image or an attribute that does not exist", |d| {
        d.shapes[0].material = MaterialId(7);
    });
    refuses("scene.xml:4: lamp names a material, an image or an attribute that does not exist", |d| {
        d.shapes[1].emission = Some(PICTURE);
    });
    refuses("scene.xml:2: a material's texture names an image or an attribute that does not exist", |d| {
        d.materials[0].kind = MaterialKind::Diffuse { albedo: PICTURE };
    });
    refuses("scene.xml:2: a material's texture names an image or an attribute that does not exist", |d| {
        d.materials[0].kind =
            MaterialKind::Microfacet { alpha: 0.1, interior_ior: 1.5, exterior_ior: 1.0, kd: PICTURE };
    });
    refuses("scene.xml:9: an environment names an image that does not exist", |d| {
        lamp(
            d,
            LightKind::Environment {
                image: ImageId(0),
                to_world: Transform::IDENTITY,
                scale: 1.0,
                rows: Default::default(),
            },
        );
    });
}

#[test]
fn images() {
    for (width, height, count) in [(2, 2, 3), (0, 0, 0), (3, 0, 0), (0, 3, 0), (u32::MAX, u32::MAX, 1)] {
        refuses("an image's pixels do not match its size", |d| {
            d.add_image(Image { width, height, pixels: vec![Rgb::BLACK; count].into() });
        });
    }
}

#[test]
fn colours() {
    for bad in [f32::NAN, f32::INFINITY, -0.1] {
        let bad = Rgb::new(1.0, bad, 1.0);
        let checkers = Texture::Checkerboard {
            delta: [0.0; 2],
            scale: [1.0; 2],
            shear: [0.0; 2],
            value1: Rgb::WHITE,
            value2: bad,
        };
        for texture in [bad.into(), checkers] {
            refuses("scene.xml:4: lamp emits a colour that is negative or not finite", |d| {
                d.shapes[1].emission = Some(texture);
            });
            refuses("scene.xml:2: a material's colour is negative or not finite", |d| {
                d.materials[0].kind = MaterialKind::Diffuse { albedo: texture };
            });
        }
        refuses("an image has values that are negative or not finite", |d| {
            d.add_image(Image { width: 1, height: 1, pixels: [bad].into() });
        });
    }
}

#[test]
fn crops() {
    let inside = [(0, 0, 8, 8), (7, 7, 1, 1), (2, 3, 4, 5)];
    for (x, y, width, height) in inside {
        assert!(warnings(|d| d.film.crop = Some(Crop { x, y, width, height })).is_empty());
    }
    let outside = [(0, 0, 9, 8), (8, 0, 1, 1), (0, 7, 1, 2), (0, 0, 0, 1), (0, 0, 1, 0), (u32::MAX, 0, 2, 1)];
    for (x, y, width, height) in outside {
        let crop = Crop { x, y, width, height };
        refuses(&format!("the crop window {width}×{height} at ({x}, {y}) does not lie"), |d| {
            d.film.crop = Some(crop);
        });
    }
    refuses("the crop window 0×8", |d| d.film.width = 0);
}

#[test]
fn lamps_that_cannot_be() {
    let (position, intensity) = ([0.0, 1.0, 0.0], Rgb::WHITE);
    let direction = [0.0, -1.0, 0.0];
    let spot = |direction, inner_angle, outer_angle| LightKind::Spot {
        position,
        direction,
        intensity,
        inner_angle,
        outer_angle,
    };
    for (inner, outer) in
        [(20.0, 10.0), (-1.0, 10.0), (0.0, 0.0), (10.0, 181.0), (f32::NAN, 10.0), (1.0, f32::NAN)]
    {
        refuses("scene.xml:9: a spot's angles must satisfy", |d| lamp(d, spot(direction, inner, outer)));
    }
    for bad in [[0.0; 3], [f32::NAN, 0.0, 1.0], [f32::INFINITY, 0.0, 0.0]] {
        let begin = "scene.xml:9: the lamp's direction must not be zero";
        refuses(begin, |d| lamp(d, spot(bad, 10.0, 20.0)));
        refuses(begin, |d| lamp(d, LightKind::Directional { direction: bad, irradiance: intensity }));
    }
    for bad in [f32::NAN, f32::INFINITY, 1e30] {
        refuses("scene.xml:9: the lamp's position must be finite", |d| {
            lamp(d, LightKind::Point { position: [0.0, bad, 0.0], intensity });
        });
    }
    for bad in [f32::NAN, f32::INFINITY, -1.0] {
        let c = Rgb::new(5.0, 1.0, bad);
        for kind in [
            LightKind::Point { position, intensity: c },
            LightKind::Directional { direction, irradiance: c },
            LightKind::Constant { radiance: c },
        ] {
            refuses("scene.xml:9: a lamp's colour must be finite and not negative", |d| lamp(d, kind));
        }
    }
    let sheared = Transform::rotate(30.0, [0.0, 0.0, 1.0]).then(Transform::scale([1.0, 2.0, 1.0]));
    for (to_world, what) in
        [(Transform::scale([1.0, 0.0, 1.0]), "cannot be inverted"), (sheared, "shears space")]
    {
        refuses(&format!("scene.xml:9: the environment's transform {what}"), |d| {
            let image = d.add_image(Image { width: 1, height: 1, pixels: [Rgb::WHITE].into() });
            lamp(d, LightKind::Environment { image, to_world, scale: 1.0, rows: Default::default() });
        });
    }
}

#[test]
fn lamps_that_emit_nothing() {
    warns("scene.xml:4: lamp is a lamp that emits nothing", |d| {
        build::emit(d, 1, 0.0);
        build::point_light(d, [0.0, 1.0, 0.0], 1.0);
    });
    let position = [0.0, 1.0, 0.0];
    let begin = "scene.xml:9: this lamp emits nothing";
    warns(begin, |d| lamp(d, LightKind::Point { position, intensity: Rgb::BLACK }));
    warns(begin, |d| lamp(d, LightKind::Constant { radiance: Rgb::BLACK }));
    warns(begin, |d| {
        let image = d.add_image(Image { width: 2, height: 1, pixels: [Rgb::BLACK; 2].into() });
        lamp(
            d,
            LightKind::Environment {
                image,
                to_world: Transform::IDENTITY,
                scale: 1.0,
                rows: Default::default(),
            },
        );
    });
    // A lamp without an area is a shape without one.
    refuses("scene.xml:4: lamp has no triangle with an area", |d| {
        let Geometry::Mesh(m) = &mut d.shapes[1].geometry else { panic!() };
        m.positions.fill(Vec3::X);
    });
}

#[test]
fn nothing_to_see() {
    warns("the scene has no light: the picture will be black", |d| d.shapes[1].emission = None);
    let (scene, w) = Scene::new(Description::default()).unwrap();
    let w: Vec<_> = w.iter().map(ToString::to_string).collect();
    assert!(
        w.len() == 2 && w[0].starts_with("the scene has no light") && w[1] == "the scene has no surfaces",
        "{w:?}"
    );
    let (center, radius) = scene.bounding_sphere();
    assert!(center.is_finite() && radius > 0.0 && scene.lamps().is_empty() && scene.lamps().power() == 0.0);
    let query = scene.lights(Default::default());
    assert!(query.sample_emission([0.5; 2], [0.5; 2], [0.5; 2]).is_none());
    assert!(query.sample_towards(Vec3::ZERO, [0.5; 2], [0.5; 2]).is_none());
}

#[test]
fn dielectrics_that_are_not_closed() {
    let begin = "scene.xml:3: floor is transparent but not closed";
    warns(begin, |d| d.shapes[0].material = build::glass(d));
    warns(begin, |d| {
        d.shapes[0].material = d.add_material(MaterialKind::rough_dielectric(Roughness::ggx(0.1), 1.5, 1.0));
    });
    let closed = |d: &mut Description| {
        let glass = build::glass(d);
        let ball = build::ellipsoid(4, [0.1; 3]);
        build::sphere(d, [0.0, 1.0, 0.0], 0.1, glass);
        build::add(d, "ball", Geometry::Mesh(closed_seam(ball)), glass);
    };
    assert!(warnings(closed).is_empty());
}

/// Such as the glass, the water and the air of a glass of water, which meet in a ring.
#[test]
fn dielectrics_that_close_each_other() {
    let warned = |holes: usize| {
        warnings(|d| {
            let glass = build::glass(d);
            let mut part = closed_seam(build::ellipsoid(4, [0.1; 3]));
            let mut rest = part.clone();
            rest.triangles = part.triangles.split_off(20);
            rest.triangles.truncate(rest.triangles.len() - holes);
            build::add(d, "part", Geometry::Mesh(part), glass);
            build::add(d, "rest", Geometry::Mesh(rest), glass);
        })
    };
    assert!(warned(0).is_empty());
    let w = warned(1);
    assert!(w.len() == 1 && w[0].starts_with("rest is transparent but not closed"), "{w:?}");
}

/// Joins the corners along the seam and at the poles, which sines and cosines put a little apart.
fn closed_seam(mut m: Mesh) -> Mesh {
    for p in &mut m.positions {
        *p = Vec3::from(p.to_array().map(|c| (c * 1e4).round() * 1e-4));
    }
    m.normals.clear();
    m
}

#[test]
fn lamps_that_face_away() {
    let begin = "scene.xml:4: lamp is a lamp that faces away from everything";
    let reverse = |d: &mut Description, shape: usize| {
        let Geometry::Mesh(m) = &mut d.shapes[shape].geometry else { panic!() };
        m.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    };
    warns(begin, |d| reverse(d, 1));
    // It faces the back of the floor, which is black; unless that lets light through.
    warns(begin, |d| reverse(d, 0));
    let w = warnings(|d| {
        reverse(d, 0);
        d.shapes[0].material = build::glass(d);
    });
    assert!(w.len() == 1 && w[0].contains("not closed"), "{w:?}");
    // A sphere has all sides.
    let w = warnings(|d| {
        d.shapes[1].geometry = Geometry::Sphere { center: Vec3::new(0.0, 1.0, 0.0), radius: 0.1 };
    });
    assert!(w.is_empty(), "{w:?}");
}

#[test]
fn albedos_above_one() {
    warns("scene.xml:2: a diffuse albedo above one reflects more light than arrives", |d| {
        d.materials[0].kind = MaterialKind::Diffuse { albedo: Rgb::new(0.5, 1.01, 0.5).into() };
    });
    assert!(
        warnings(|d| d.materials[0].kind = MaterialKind::Diffuse { albedo: Rgb::WHITE.into() }).is_empty()
    );
}

#[test]
fn left_out_triangles_are_told_with_the_scene() {
    warns("scene.xml:3: floor: left out 1 triangles without an area", |d| {
        let Geometry::Mesh(m) = &mut d.shapes[0].geometry else { panic!() };
        m.triangles.push([0, 0, 1]);
    });
    refuses("scene.xml:3: floor has no triangle with an area", |d| {
        d.shapes[0].geometry = Geometry::Mesh(Mesh::default());
    });
}
