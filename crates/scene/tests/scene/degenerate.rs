//! What becomes of numbers and shapes that make no sense, or almost none: an error with a hint, a warning, or a
//! defined result.

use caustica_math::{Filter, Rgb, Transform, Vec2, Vec3, Wavelengths};
use caustica_scene::bvh::Ray;
use caustica_scene::description::{
    CameraKind, Geometry, Image, ImageId, LightKind, MaterialKind, Mesh, Roughness, Texture, TextureTransform,
};
use caustica_scene::{Description, Scene, Severity};
use caustica_testkit::build;

const NAN: f32 = f32::NAN;
const INF: f32 = f32::INFINITY;

/// A floor under a point light.
fn floor() -> Description {
    let mut d = build::scene(4);
    let m = build::diffuse(&mut d, 0.5);
    build::quad(&mut d, [-2.0, -1.0, 1.0], [0.0, 0.0, 4.0], [4.0, 0.0, 0.0], m);
    build::point_light(&mut d, [0.0, 1.0, 3.0], 1.0);
    d
}

fn mesh(d: &mut Description) -> &mut Mesh {
    let Geometry::Mesh(mesh) = &mut d.shapes[0].geometry else { panic!() };
    mesh
}

fn made(change: impl FnOnce(&mut Description)) -> (Scene, Vec<String>) {
    let mut d = floor();
    change(&mut d);
    let (scene, warnings) = Scene::new(d).unwrap_or_else(|e| panic!("{e}"));
    (scene, warnings.iter().map(ToString::to_string).collect())
}

#[track_caller]
fn refused(with: &str, change: impl FnOnce(&mut Description)) {
    let mut d = floor();
    change(&mut d);
    let e = Scene::new(d).expect_err(with);
    assert!(e.severity == Severity::Error && e.to_string().contains(with), "{e}");
}

#[track_caller]
fn warned(with: &str, change: impl FnOnce(&mut Description)) -> Scene {
    let (scene, w) = made(change);
    assert!(w.len() == 1 && w[0].contains(with), "{w:?}");
    scene
}

fn down() -> Ray {
    Ray { origin: Vec3::new(0.5, 1.0, 2.0), direction: Vec3::new(0.0, -1.0, 0.0), t_max: INF }
}

#[test]
fn normals_that_say_nothing() {
    for bad in [Vec3::ZERO, Vec3::new(NAN, 0.0, 1.0), Vec3::new(0.0, -INF, 0.0)] {
        let all = warned("quad: 4 normals are zero or not finite", |d| mesh(d).normals = vec![bad; 4]);
        assert_eq!(all.closest(&down()).unwrap().frame.z, Vec3::Y);
        let lean = Vec3::new(0.6, 0.8, 0.0);
        let some = warned("quad: 1 normals are zero or not finite", |d| {
            mesh(d).normals = vec![lean, lean, bad, lean]
        });
        assert!((some.closest(&down()).unwrap().frame.z - lean).length() < 1e-6);
    }
    // Lengths do not matter, up to the ends of the range.
    for length in [1e-37, 1e-20, 1e20, 3e38] {
        let (scene, w) = made(|d| {
            mesh(d).normals = vec![Vec3::Y * length; 4];
            d.shapes[0].to_world = Transform::scale([1e-6; 3]);
            (d.camera.near, d.camera.far) = (0.0, 1e3);
        });
        assert_eq!(w, Vec::<String>::new());
        let p = scene.surfaces().triangle_point(0, 0.3, 0.3);
        assert_eq!(p.frame.z, Vec3::Y);
    }
}

#[test]
fn texture_coordinates_that_are_none() {
    let scene = warned("quad: 2 texture coordinates are not finite (they count as (0, 0))", |d| {
        mesh(d).uvs =
            vec![Vec2::new(NAN, 0.0), Vec2::new(1.0, INF), Vec2::new(1.0, 1.0), Vec2::new(3e38, 3e38)];
        let colours = (Rgb::WHITE, Rgb::BLACK);
        d.materials[0].kind = MaterialKind::Diffuse {
            albedo: Texture::Checkerboard {
                delta: [0.0; 2],
                scale: [1e-30; 2],
                shear: [0.0; 2],
                value1: colours.0,
                value2: colours.1,
            },
        };
    });
    for i in 0..100 {
        let b = i as f32 / 100.0;
        for triangle in [0, 1] {
            let p = scene.surfaces().triangle_point(triangle, b, 1.0 - b);
            assert!(format!("{:?}", scene.bsdf(&p, Wavelengths::Rgb)).contains("albedo"));
        }
    }
}

#[test]
fn corners_out_of_range() {
    refused("quad has a triangle whose corner 4 does not exist (its corners are 0 to 3)", |d| {
        mesh(d).triangles.push([0, 1, 4]);
    });
    refused("whose corner 4294967295 does not exist", |d| mesh(d).triangles[0] = [u32::MAX; 3]);
    refused("quad has a triangle whose corner 0 does not exist", |d| {
        mesh(d).uvs.clear();
        mesh(d).positions.clear();
    });
    refused("quad has 4 vertices but 1 normals", |d| mesh(d).normals = vec![Vec3::Y]);
}

/// Corners in a row by a hair: the normal is that of the triangle, not of the rounding.
#[test]
fn slivers_keep_their_normals() {
    let (a, b) = (Vec3::new(0.1, 0.2, 0.3), Vec3::new(1.7, 2.9, 3.1));
    for i in 0..200 {
        let side = Vec3::new(1.0, -0.5, 0.0) * (1e-6 * (1.0 + i as f32));
        let c = (a + b) * 0.5 + side;
        let wide = |v: Vec3| v.to_array().map(f64::from);
        let (u, v) = ([b, a], [c, a]);
        let [u, v] = [u, v].map(|[p, q]| [0, 1, 2].map(|i| wide(p)[i] - wide(q)[i]));
        let exact = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        let length = exact.iter().map(|x| x * x).sum::<f64>().sqrt();
        let exact = Vec3::from(exact.map(|x| (x / length) as f32));
        let (scene, _) = made(|d| {
            *mesh(d) = Mesh { positions: vec![a, b, c], triangles: vec![[0, 1, 2]], ..Mesh::default() };
        });
        let p = scene.surfaces().triangle_point(0, 0.2, 0.3);
        assert!((p.normal - exact).length() < 1e-6, "{:?} {exact:?}", p.normal);
    }
}

/// What a density could not be counted on is left out; what is tiny otherwise stays.
#[test]
fn tiny_triangles() {
    let scaled = |k: f32| move |d: &mut Description| mesh(d).positions.iter_mut().for_each(|p| *p *= k);
    for k in [1e-6, 1e-12, 1e-15] {
        let (scene, _) = made(scaled(k));
        assert_eq!(scene.surfaces().triangles().len(), 2, "{k}");
    }
    refused("quad has no triangle with an area", scaled(1e-20));
    let lamp = |k: f32| {
        made(|d| {
            scaled(k)(d);
            build::emit(d, 0, 1.0);
        })
    };
    let (scene, _) = lamp(1e-15);
    let e = scene.lights(Wavelengths::Rgb).sample_emission([0.01; 2], [0.3; 2], [0.3; 2]).unwrap();
    assert!(e.pdf.point.0.is_finite() && e.pdf.point.0 > 0.0);
}

#[test]
fn spheres_at_the_ends_of_the_range() {
    let sphere = |radius: f32| {
        move |d: &mut Description| d.shapes[0].geometry = Geometry::Sphere { center: Vec3::ZERO, radius }
    };
    for bad in [0.0, -0.0, -1.0, 1e-20, 1e20, NAN, INF] {
        refused("sphere whose radius", sphere(bad));
    }
    for good in [1e-15, 1e-6, 1e6, 9e14] {
        let (scene, _) = made(sphere(good));
        assert!(
            scene.closest(&Ray { origin: Vec3::ZERO, direction: Vec3::X, t_max: INF }).is_some(),
            "{good}"
        );
    }
}

#[test]
fn materials_out_of_range() {
    let with = |kind: MaterialKind| move |d: &mut Description| d.materials[0].kind = kind;
    for bad in [0.0, -1.0, NAN, INF, 1e-30, 1e30] {
        for (interior_ior, exterior_ior) in [(bad, 1.0), (1.0, bad), (bad, bad)] {
            for kind in [
                MaterialKind::dielectric(interior_ior, exterior_ior),
                MaterialKind::rough_dielectric(Roughness::ggx(0.1), interior_ior, exterior_ior),
                MaterialKind::Microfacet { alpha: 0.1, interior_ior, exterior_ior, kd: Rgb::BLACK.into() },
            ] {
                refused("glass has about 1.5", with(kind));
            }
        }
    }
    refused("and their ratio", with(MaterialKind::dielectric(1e4, 1e-4)));
    let (eta, k, reflectance) = (Rgb::splat(0.2), Rgb::splat(3.0), Rgb::WHITE.into());
    for alpha in [-1e-9, NAN, INF, 1e30] {
        refused(
            "a roughness of",
            with(MaterialKind::RoughConductor { roughness: Roughness::ggx(alpha), eta, k, reflectance }),
        );
    }
    for bad in [-0.1, NAN, INF].map(Rgb::splat) {
        refused("a material's colour", with(MaterialKind::Mirror { reflectance: bad }));
        refused("a material's colour", with(MaterialKind::Conductor { eta, k, reflectance: bad.into() }));
        refused("a metal's index", with(MaterialKind::Conductor { eta: bad, k, reflectance }));
        refused(
            "a metal's index",
            with(MaterialKind::RoughConductor { roughness: Roughness::ggx(0.1), eta, k: bad, reflectance }),
        );
    }
    for kind in [
        MaterialKind::Mirror { reflectance: Rgb::splat(2.0) },
        MaterialKind::Conductor { eta, k, reflectance: Rgb::splat(1e30).into() },
    ] {
        warned("a reflectance above one reflects more light", with(kind));
    }
}

#[test]
fn textures_out_of_range() {
    let checks = |delta, scale| Texture::Checkerboard {
        delta,
        scale,
        shear: [0.0; 2],
        value1: Rgb::WHITE,
        value2: Rgb::BLACK,
    };
    for texture in [checks([NAN, 0.0], [1.0; 2]), checks([0.0; 2], [1.0, 0.0]), checks([0.0; 2], [INF, 1.0])]
    {
        refused("a material's texture has fields", |d| {
            d.materials[0].kind = MaterialKind::Diffuse { albedo: texture }
        });
        refused("the emission of quad has fields", |d| d.shapes[0].emission = Some(texture));
    }
    for (scale, offset) in [([NAN; 2], [0.0; 2]), ([1.0; 2], [0.0, INF])] {
        refused("the emission of quad has a scale or an offset", |d| {
            d.add_image(Image { width: 1, height: 1, pixels: [Rgb::WHITE].into() });
            let transform = TextureTransform { scale, offset, ..TextureTransform::default() };
            d.shapes[0].emission = Some(Texture::Image { image: ImageId(0), transform });
        });
    }
    for scale in [-1.0, NAN, INF] {
        refused("the environment's scale", |d| {
            let image = d.add_image(Image { width: 1, height: 1, pixels: [Rgb::WHITE].into() });
            build::light(
                d,
                LightKind::Environment {
                    image,
                    to_world: Transform::IDENTITY,
                    scale,
                    rows: Default::default(),
                },
            );
        });
    }
}

#[test]
fn cameras_at_the_ends_of_the_range() {
    for fov in [1e-30, 1e-10] {
        refused("too near to 0 or 180", |d| d.camera.kind = CameraKind::Perspective { fov });
    }
    for fov in [1e-3, 179.9, 180.0_f32.next_down()] {
        let (scene, _) = made(|d| d.camera.kind = CameraKind::Perspective { fov });
        for film in [Vec2::new(2.0, 2.0), Vec2::default()] {
            let ray = scene.camera.ray(film, [0.5; 2]);
            assert!(ray.direction.is_finite() && ray.pdf.0.is_finite() && ray.pdf.0 > 0.0, "{ray:?}");
        }
    }
    for (aperture_radius, focus_distance) in [(1e30, 1.0), (0.1, 1e30), (0.1, 1e-30)] {
        refused("the camera's field of view", |d| {
            d.camera.kind = CameraKind::ThinLens { fov: 40.0, aperture_radius, focus_distance };
        });
    }
    for k in [1e-30, 1e30] {
        refused("its pixels have no size", |d| {
            d.camera.kind = CameraKind::Orthographic;
            d.camera.to_world = Transform::scale([k; 3]);
        });
    }
    for (place, why) in [(1e300, "not finite"), (1e20, "farther than 1e15")] {
        refused(&format!("the camera's position is {why}"), |d| {
            d.camera.to_world = Transform::translate([place, 0.0, 0.0]);
        });
    }
}

#[test]
fn filters_that_are_none() {
    for filter in [
        Filter::Box { radius: 0.0 },
        Filter::Tent { radius: NAN },
        Filter::Tent { radius: 1e9 },
        Filter::Lanczos { lobes: 0 },
        Filter::Lanczos { lobes: 33 },
        Filter::Gaussian { radius: 2.0, stddev: 0.0 },
        Filter::Mitchell { radius: 2.0, b: NAN, c: 0.0 },
    ] {
        refused("is no pixel filter", |d| d.film.filter = filter);
    }
}

#[test]
fn clip_planes_that_leave_nothing() {
    warned("all are nearer than its near clip plane", |d| (d.camera.near, d.camera.far) = (100.0, 200.0));
    warned("all are farther than its far clip plane", |d| {
        d.camera.to_world = Transform::translate([0.0, 0.0, -2e4]);
    });
}

/// A lamp in the plane of a ceiling is a matter of rounding, in front of it is not.
#[test]
fn lamps_in_the_plane_of_something_else() {
    let with_lamp_at = |y: f32| {
        move |d: &mut Description| {
            let m = build::diffuse(d, 0.5);
            build::quad(d, [-2.0, 1.0, 1.0], [4.0, 0.0, 0.0], [0.0, 0.0, 4.0], m);
            let lamp = build::quad(d, [-1.0, y, 2.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], m);
            build::emit(d, lamp, 1.0);
        }
    };
    warned("quad lies in the plane of another surface", with_lamp_at(1.0));
    assert_eq!(made(with_lamp_at(0.999)).1, Vec::<String>::new());
}

/// Of surfaces that coincide the one that comes first is hit.
#[test]
fn the_first_of_two_coincident_surfaces_is_hit() {
    let (scene, w) = made(|d| {
        let m = build::diffuse(d, 0.1);
        let twin = d.shapes[0].clone();
        d.shapes.push(twin);
        d.shapes[1].material = m;
        for _ in 0..2 {
            build::sphere(d, [0.0, 0.0, 3.0], 0.5, m);
        }
    });
    assert_eq!(w, Vec::<String>::new());
    assert_eq!(scene.closest(&down()).unwrap().shape, 0);
    let at_ball = Ray { origin: Vec3::ZERO, direction: Vec3::Z, t_max: INF };
    assert_eq!(scene.closest(&at_ball).unwrap().shape, 2);
}

#[test]
fn warnings_have_an_end() {
    let (_, w) = made(|d| {
        for _ in 0..1500 {
            build::point_light(d, [0.0; 3], 0.0);
        }
    });
    assert_eq!(w.len(), 1001);
    assert!(w[1000].contains("there are 500 more warnings"), "{}", w[1000]);
}

/// Light that is brighter than what `f32` can count over its area.
#[test]
fn the_brightest_lamps_have_a_power() {
    for radiance in [1e-30, 1e30, 3e38] {
        let (scene, _) = made(|d| {
            d.lights.clear();
            mesh(d).positions.iter_mut().for_each(|p| *p *= 1e6);
            d.camera.far = 1e9;
            build::emit(d, 0, radiance);
        });
        let expected = std::f64::consts::PI * 16e12 * f64::from(radiance);
        assert!((scene.lamps().power() / expected - 1.0).abs() < 1e-5, "{}", scene.lamps().power());
    }
}
