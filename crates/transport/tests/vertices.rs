//! What vertices tell about themselves.

use caustica_math::{Vec3, Wavelengths};
use caustica_scene::bsdf::Walk;
use caustica_scene::bvh::Ray;
use caustica_scene::description::MaterialKind;
use caustica_scene::{Description, Scene};
use caustica_testkit::agreement::flatten;
use caustica_testkit::build::{diffuse, glass, scene, sphere};
use caustica_testkit::materials::two_sided;
use caustica_transport::vertex::Vertex;

/// Where a ray along +z through the middle of a ball arrives, from outside or from inside.
fn arrival(scene: &Scene, inside: bool) -> Vertex {
    let origin = Vec3::new(0.1, 0.2, if inside { 0.0 } else { -3.0 });
    let ray = Ray { origin, direction: Vec3::Z, t_max: f32::INFINITY };
    let point = scene.closest(&ray).expect("the ball");
    Vertex::new(scene, point, -Vec3::Z, Wavelengths::Rgb, || 0.5)
}

fn ball(material: impl Fn(&mut Description) -> caustica_scene::description::MaterialId) -> Scene {
    let mut d = scene(4);
    let material = material(&mut d);
    sphere(&mut d, [0.0; 3], 1.0, material);
    flatten(d)
}

/// Radiance that a camera outside of glass of index 1.5 sees is smaller by 1/1.5² than inside.
#[test]
fn refraction_scales_radiance_and_reflection_does_not() {
    let glass = ball(glass);
    let close = |a: f32, b: f32| (a - b).abs() < 1e-5;
    let (outside, inside) = (arrival(&glass, false), arrival(&glass, true));
    assert!(close(outside.radiance_scale(Vec3::Z), 1.0 / 2.25), "{}", outside.radiance_scale(Vec3::Z));
    assert!(close(inside.radiance_scale(Vec3::Z), 2.25), "{}", inside.radiance_scale(Vec3::Z));
    assert_eq!([&outside, &inside].map(|v| v.radiance_scale(-Vec3::Z)), [1.0; 2]);
    let wall = arrival(&ball(|d| diffuse(d, 0.5)), false);
    assert_eq!(wall.radiance_scale(-Vec3::Z), 1.0);
}

/// Each side has its own material, and the surface's geometric normal stays where it is.
#[test]
fn two_sided_surfaces_scatter_on_either_side() {
    let both = ball(|d| {
        let (front, back) = (diffuse(d, 0.5), diffuse(d, 0.25));
        two_sided(d, front, back)
    });
    for (inside, albedo) in [(false, 0.5), (true, 0.25)] {
        let v = arrival(&both, inside);
        let found = v.scatter(Walk::FromCamera, -Vec3::Z).expect("it is seen").value[1];
        let expected = albedo * v.point.normal.dot(Vec3::Z).abs() * std::f32::consts::FRAC_1_PI;
        assert!((found - expected).abs() < 1e-5, "{found} {expected}");
        assert!(v.side(-Vec3::Z) > 0.0 && v.scatter(Walk::FromCamera, Vec3::Z).is_none());
        assert_eq!(v.point.normal.z > 0.0, inside);
    }
}

/// What is not there lets light pass, whatever the shading normals.
#[test]
fn nothing_lets_light_pass() {
    let v = arrival(&ball(|d| d.add_material(MaterialKind::Null)), false);
    let (next, scatter, delta) = v.sample(Walk::FromLight, [0.0; 3]).expect("it passes");
    assert!(delta && (next - Vec3::Z).length() < 1e-6 && (scatter.value[1] - 1.0).abs() < 1e-6);
    assert!(!v.is_connectible() && v.radiance_scale(Vec3::Z) == 1.0);
}

/// Dirac lobes cannot be joined with, others can.
#[test]
fn what_can_be_joined() {
    assert!(!arrival(&ball(glass), false).is_connectible());
    assert!(arrival(&ball(|d| diffuse(d, 0.5)), false).is_connectible());
}
