//! How surfaces lie under their texture coordinates, and frames that follow them.

use caustica_math::{Frame, Transform, Vec2, Vec3, warp};
use caustica_scene::description::{Geometry, MaterialId, Mesh, Shape};
use caustica_scene::surface::{SurfacePoint, Surfaces};

fn flatten(geometry: Geometry, to_world: Transform) -> Surfaces {
    let material = MaterialId(0);
    let shape = Shape { name: "thing".into(), geometry, to_world, material, emission: None, origin: None };
    let mut surfaces = Surfaces::new(&mut [shape], &mut vec![]).unwrap();
    surfaces.shapes[0].needs_tangents = true;
    surfaces
}

fn placed() -> Transform {
    Transform::scale([2.0, -2.0, 2.0])
        .then(Transform::rotate(70.0, [1.0, 2.0, 3.0]))
        .then(Transform::translate([1.0, -4.0, 2.0]))
}

fn triangle(uvs: [[f32; 2]; 3]) -> Mesh {
    Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(0.3, 1.0, 0.2)],
        normals: vec![Vec3::new(0.1, 0.0, 1.0), Vec3::new(0.0, 0.2, 1.0), Vec3::new(-0.3, 0.0, 1.0)],
        uvs: uvs.map(|[x, y]| Vec2::new(x, y)).to_vec(),
        triangles: vec![[0, 1, 2]],
        attributes: vec![],
    }
}

/// What derivatives are for: a step in uv is a step in space. And x leads up ∂p/∂u in a right-handed frame.
fn check(p: &SurfacePoint, q: &SurfacePoint, [by_u, by_v]: [Vec3; 2], tolerance: f32) {
    let step = by_u * (q.uv.x - p.uv.x) + by_v * (q.uv.y - p.uv.y);
    let error = (q.position - p.position - step).length();
    assert!(error <= tolerance * step.length(), "{error} of {step:?}");
    let f = p.frame;
    assert!((f.x.cross(f.y) - f.z).length() < 1e-5 && f.x.dot(f.z).abs() < 1e-5);
    assert!(f.x.dot(by_u) > 0.0 && f.y.dot(by_u).abs() < 1e-5 * by_u.length(), "{f:?} {by_u:?}");
}

#[test]
fn triangles_are_linear_in_uv() {
    for uvs in [[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], [[3.0, 1.0], [2.5, 1.5], [3.2, 1.25]]] {
        let s = flatten(Geometry::Mesh(triangle(uvs)), placed());
        let p = s.triangle_point(0, 0.2, 0.3);
        for b in [[0.5, 0.1], [0.1, 0.8]] {
            check(&p, &s.triangle_point(0, b[0], b[1]), s.derivatives(&p).unwrap(), 1e-5);
        }
    }
}

#[test]
fn spheres_are_curved_in_uv() {
    let s = {
        let mut s = flatten(Geometry::Sphere { center: Vec3::new(0.5, 0.0, 0.0), radius: 1.5 }, placed());
        s.shapes[0].needs_uv = true;
        s
    };
    for i in 0..200 {
        let normal = warp::uniform_sphere([(i as f32 + 0.5) / 200.0, (i as f32 * 0.618).fract()]);
        let p = s.sphere_point(0, normal);
        // Not over the seam of u, and not beside a pole, where the step bends.
        if (0.2..0.8).contains(&p.uv.y) && (0.05..0.95).contains(&p.uv.x) {
            let f = Frame::from_normal(normal);
            for side in [f.x, f.y] {
                let q = s.sphere_point(0, (normal + side * 1e-3).normalized());
                check(&p, &q, s.derivatives(&p).unwrap(), 1e-2);
            }
        }
    }
}

#[test]
fn where_uvs_say_nothing_any_frame_will_do() {
    let flat = [[0.5, 0.5]; 3];
    let line = [[0.0, 0.0], [0.5, 0.5], [1.0, 1.0]];
    for m in [triangle(flat), triangle(line), Mesh { uvs: vec![], ..triangle(flat) }] {
        let s = flatten(Geometry::Mesh(m), Transform::IDENTITY);
        let p = s.triangle_point(0, 0.2, 0.3);
        assert_eq!(s.derivatives(&p), None);
        assert_eq!(p.frame, Frame::from_normal(p.frame.z));
    }
    let s = flatten(Geometry::Sphere { center: Vec3::ZERO, radius: 2.0 }, Transform::IDENTITY);
    for pole in [Vec3::Z, -Vec3::Z] {
        let p = s.sphere_point(0, pole);
        assert_eq!((s.derivatives(&p), p.frame), (None, Frame::from_normal(pole)));
    }
}

#[test]
fn frames_that_nobody_looks_at_are_arbitrary() {
    let mut s = flatten(Geometry::Mesh(triangle([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]])), placed());
    let led = s.triangle_point(0, 0.2, 0.3);
    s.shapes[0].needs_tangents = false;
    let free = s.triangle_point(0, 0.2, 0.3);
    assert_eq!(free.frame, Frame::from_normal(free.frame.z));
    assert_eq!(led.frame.z, free.frame.z);
    assert_ne!(led.frame.x, free.frame.x);
}
