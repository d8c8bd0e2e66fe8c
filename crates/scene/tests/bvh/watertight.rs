//! No ray slips between two triangles that share an edge, and none meets the surface that it leaves, at any
//! scale and place.

use crate::soups::bodies::{ball, cube, placed};
use crate::soups::{in_cube, random};
use caustica_math::{SampleStream, Vec3, warp};
use caustica_scene::bvh::{Bvh, Ray};
use caustica_scene::description::{Geometry, Mesh};
use caustica_scene::surface::SurfacePoint;
use caustica_scene::{Description, Scene};
use caustica_testkit::build;

/// Scales and, in units of them, offsets of what is tested.
const PLACES: [(f32, f32); 6] =
    [(1e-3, 0.0), (1.0, 0.0), (1e4, 0.0), (1e-3, 30.0), (1.0, 100.0), (1e4, 10.0)];

fn offset(scale: f32, distance: f32) -> Vec3 {
    Vec3::new(0.7, -1.0, 0.4) * (scale * distance)
}

/// A corner, a point of an edge, or the middle of an edge.
fn on_an_edge(mesh: &Mesh, s: &mut SampleStream) -> Vec3 {
    let t = ((s.next_1d() * mesh.triangles.len() as f32) as usize).min(mesh.triangles.len() - 1);
    let corner = (s.next_1d() * 3.0) as usize % 3;
    let [a, b] = [corner, (corner + 1) % 3].map(|c| mesh.positions[mesh.triangles[t][c] as usize]);
    let along = match (s.next_1d() * 3.0) as u32 {
        0 => 0.0,
        1 => 0.5,
        _ => s.next_1d(),
    };
    a + (b - a) * along
}

/// Shoots at edges and corners; the first hit must be there, not on the other side of the body.
fn leaks(mesh: &Mesh, center: Vec3, scale: f32, rays: u32) -> u32 {
    let tree = Bvh::new(&mesh.positions, &mesh.triangles, &[]);
    let mut s = random(1);
    let mut leaks = 0;
    for i in 0..rays {
        let target = on_an_edge(mesh, &mut s);
        let outward = target - center;
        // From a place inside, or from one outside in front of the target.
        let origin = if i % 2 == 0 {
            center + in_cube(&mut s) * (0.4 * scale)
        } else {
            target + outward * (0.3 + 3.0 * s.next_1d()) + in_cube(&mut s) * (0.1 * scale)
        };
        let ray = Ray { origin, direction: target - origin, t_max: f32::INFINITY };
        let hit = tree.closest(&ray);
        if hit.is_none_or(|h| (h.t - 1.0).abs() > 0.05) || !tree.occluded(&ray) {
            leaks += 1;
        }
    }
    leaks
}

#[test]
fn no_ray_slips_through_an_edge() {
    let (mut rays, mut lost) = (0, 0);
    for (scale, distance) in PLACES {
        let center = offset(scale, distance);
        for mesh in [ball(8), cube(8)] {
            lost += leaks(&placed(mesh, scale, center), center, scale, 90_000);
            rays += 90_000;
        }
    }
    assert!(rays >= 1_000_000 && lost == 0, "{lost} of {rays} rays");
}

/// Rays along axes and diagonals from corner to corner of a lattice: they run in the planes of boxes, and
/// exactly through corners and edges.
#[test]
fn no_ray_slips_through_a_lattice() {
    let mesh = cube(4);
    let tree = Bvh::new(&mesh.positions, &mesh.triangles, &[]);
    let steps = [-2, -1, 0, 1, 2];
    let mut rays = 0;
    for (x, y, z) in steps.iter().flat_map(|x| steps.iter().flat_map(move |y| steps.map(|z| (*x, *y, z)))) {
        let origin = Vec3::from([x, y, z].map(|c| c as f32 * 0.25));
        for d in &mesh.positions {
            for zero in [0.0, -0.0] {
                let direction = Vec3::from(d.to_array().map(|c| if c == 0.0 { zero } else { c }));
                let ray = Ray { origin, direction, t_max: f32::INFINITY };
                let p = tree.closest(&ray).map(|h| origin + direction * h.t);
                rays += 1;
                assert!(
                    p.is_some_and(|p| (p.abs().max_element() - 1.0).abs() < 1e-5) && tree.occluded(&ray),
                    "{ray:?} ends at {p:?}"
                );
            }
        }
    }
    assert!(rays > 20_000);
}

/// A scene with one body.
fn scene_of(geometry: Geometry) -> Scene {
    let mut d = Description::default();
    let m = build::diffuse(&mut d, 0.5);
    build::add(&mut d, "body", geometry, m);
    Scene::new(d).unwrap().0
}

/// The bodies at their places.
fn bodies() -> impl Iterator<Item = (String, Scene)> {
    PLACES.into_iter().flat_map(|(scale, distance)| {
        let center = offset(scale, distance);
        let mesh = |m| scene_of(Geometry::Mesh(placed(m, scale, center)));
        [
            (format!("ball at {scale}, {distance}"), mesh(ball(16))),
            (format!("cube at {scale}, {distance}"), mesh(cube(3))),
            (format!("cube of 12 at {scale}, {distance}"), mesh(cube(1))),
            (format!("sphere at {scale}, {distance}"), scene_of(Geometry::Sphere { center, radius: scale })),
        ]
    })
}

/// A point of the body, but not right at an edge: there the wall beside it may be nearer than the offset.
fn random_point(scene: &Scene, s: &mut SampleStream) -> SurfacePoint {
    let surfaces = scene.surfaces();
    let count = surfaces.shapes[0].primitive_count;
    if surfaces.sphere(0).is_some() {
        surfaces.sphere_point(0, warp::uniform_sphere(s.next_2d()))
    } else {
        let t = ((s.next_1d() * count as f32) as u32).min(count - 1);
        let [b1, b2] = warp::uniform_triangle(s.next_2d());
        let inward = |b: f32| 1.0 / 3.0 + (b - 1.0 / 3.0) * 0.998;
        surfaces.triangle_point(t, inward(b1), inward(b2))
    }
}

/// From points of a convex body, sampled or hit, no ray to its outside meets it.
#[test]
fn nothing_shadows_itself_outside() {
    for (name, scene) in bodies() {
        let (center, radius) = scene.bounding_sphere();
        let mut s = random(2);
        let mut falsely_hit = 0;
        for i in 0..40_000 {
            let mut p = random_point(&scene, &mut s);
            if i % 2 == 0 {
                let origin = center + warp::uniform_sphere(s.next_2d()) * (radius * 3.0);
                let ray = Ray { origin, direction: p.position - origin, t_max: f32::INFINITY };
                p = scene.closest(&ray).unwrap_or(p);
            }
            let mut direction = warp::uniform_sphere(s.next_2d());
            if i % 3 == 0 {
                // Grazing.
                direction = (direction - p.normal * (p.normal.dot(direction) * 0.9999)).normalized();
            }
            direction = direction * 1.0_f32.copysign(p.normal.dot(direction));
            let ray = Ray { origin: p.off_surface(direction), direction, t_max: f32::INFINITY };
            falsely_hit += u32::from(scene.occluded(&ray));
        }
        assert_eq!(falsely_hit, 0, "{name}");
    }
}

/// Any two points inside of a convex body see each other.
#[test]
fn nothing_shadows_itself_inside() {
    for (name, scene) in bodies() {
        let mut s = random(3);
        let mut falsely_hidden = 0;
        for _ in 0..40_000 {
            let (p, q) = (random_point(&scene, &mut s), random_point(&scene, &mut s));
            let d = q.position - p.position;
            // Points of one face have no inside between them.
            if p.normal.dot(d) >= -1e-4 * d.length() || q.normal.dot(d) <= 1e-4 * d.length() {
                continue;
            }
            let (from, to) = (p.off_surface(d), q.off_surface(-d));
            falsely_hidden += u32::from(!scene.visible(from, to));
            falsely_hidden += u32::from(!scene.visible(to, from));
        }
        assert_eq!(falsely_hidden, 0, "{name}");
    }
}
