//! Lamps with flat sides, seen from everywhere: close, far, grazing, from their plane, from behind.

use std::f64::consts::PI;

use caustica_math::{Vec2, Vec3};
use caustica_scene::Description;
use caustica_scene::description::{Geometry, Mesh};
use caustica_testkit::build;

use super::{COLOUR, Example, View, area_of, finish, luminance, view};

pub fn examples() -> Vec<Example> {
    let tilted = [Vec3::new(0.2, 1.0, -0.4), Vec3::new(0.8, 0.2, 0.1), Vec3::new(-0.28, 1.32, -0.4)];
    let sheared = [Vec3::new(0.2, 1.0, -0.4), Vec3::new(1.0, 0.2, 0.0), Vec3::new(0.7, 0.6, -0.5)];
    let mut seven = corners_of(tilted);
    seven.rotate_left(1);
    vec![
        polygon("quad", corners_of(tilted), vec![[0, 1, 2], [0, 2, 3]]),
        // Triangles that begin anywhere, and a diagonal that goes the other way.
        polygon("quad cut elsewhere", seven, vec![[2, 0, 1], [2, 3, 0]]),
        polygon("sheared quad", corners_of(sheared), vec![[0, 1, 2], [0, 2, 3]]),
        polygon("triangle", corners_of(tilted), vec![[0, 1, 3]]),
        // Not flat along a straight fold: no parallelogram, though it has two triangles.
        folded(),
        cube(),
    ]
}

fn corners_of([corner, u, v]: [Vec3; 3]) -> [Vec3; 4] {
    [corner, corner + u, corner + u + v, corner + v]
}

fn lamp(mesh: Mesh) -> Description {
    let mut d = build::scene(8);
    let m = build::diffuse(&mut d, 0.0);
    let s = build::add(&mut d, "lamp", Geometry::Mesh(mesh), m);
    d.shapes[s].emission = Some(COLOUR.into());
    d
}

fn mesh(corners: &[Vec3], triangles: Vec<[u32; 3]>) -> Mesh {
    let uvs = (0..corners.len()).map(|i| Vec2::new(i as f32, 1.0)).collect();
    Mesh { positions: corners.to_vec(), triangles, uvs, ..Mesh::default() }
}

fn polygon(name: &'static str, corners: [Vec3; 4], triangles: Vec<[u32; 3]>) -> Example {
    let d = lamp(mesh(&corners, triangles.clone()));
    let area = area_of(&d);
    let [a, b, _, c] = corners;
    let (u, v) = (b - a, c - a);
    let normal = u.cross(v).normalized();
    // Shares of the two sides, and the height; looking at the lamp's plane straight on.
    let at = |x: f32, y: f32, height: f32| {
        let from = a + u * x + v * y + normal * height;
        let lit = |t: &[u32; 3]| lambert(from, t.map(|i| corners[i as usize]));
        let lit = if height < 0.0 { 0.0 } else { luminance() * triangles.iter().map(lit).sum::<f64>() };
        View { from, normal: -normal, irradiance: Some(lit) }
    };
    let views = vec![
        at(0.3, 0.4, 1.0),
        at(0.3, 0.4, 0.1),
        at(0.3, 0.4, 0.01),
        at(0.3, 0.4, 2e-3),
        at(0.02, 0.5, 0.05),
        at(1.0, 1.0, 0.3),
        at(1.4, 0.2, 0.06),
        at(-2.0, 3.0, 0.5),
        at(0.5, 0.5, 40.0),
        at(-0.5, 0.5, -0.2),
        at(0.5, 0.4, -0.01),
    ];
    finish(name, d, PI * area * luminance(), views)
}

/// The irradiance at `from` on a plane parallel to a triangle of radiance one (Lambert's formula for polygons,
/// Photometria, 1760).
fn lambert(from: Vec3, corners: [Vec3; 3]) -> f64 {
    let wide = |v: Vec3| v.to_array().map(f64::from);
    let from = wide(from);
    let d = corners.map(|c| [0, 1, 2].map(|k| wide(c)[k] - from[k]));
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let difference = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| a[k] - b[k]);
    let n = cross(difference(d[1], d[0]), difference(d[2], d[0]));
    let edge = |i: usize| {
        let (p, q) = (d[i], d[(i + 1) % 3]);
        let c = cross(p, q);
        let length = dot(c, c).sqrt();
        libm::atan2(length, dot(p, q)) * dot(c, n) / length / dot(n, n).sqrt()
    };
    (0.5 * (0..3).map(edge).sum::<f64>()).abs()
}

fn folded() -> Example {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.4], [0.0, 1.0, 0.0]].map(Vec3::from);
    let d = lamp(mesh(&corners, vec![[0, 1, 2], [0, 2, 3]]));
    let area = area_of(&d);
    let views =
        vec![view([0.5, 0.5, 1.0], [0.5, 0.5, 0.0], None), view([0.5, 0.45, 0.25], [0.5, 0.5, 0.0], None)];
    finish("folded quad", d, PI * area * luminance(), views)
}

fn cube() -> Example {
    let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 0.5;
    let corners: Vec<Vec3> = (0..8).map(corner).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
        .map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]);
    let d = lamp(mesh(&corners, faces.concat()));
    let c = [0.25; 3];
    let views = vec![
        view([0.6, 0.2, 0.3], c, None),
        view([0.505, 0.3, 0.2], c, None),
        view([0.7, 0.8, 0.6], c, None),
        view([9.0, 7.0, -5.0], c, None),
        view([0.2, 0.1, 0.3], c, Some(0.0)),
    ];
    finish("cube", d, PI * 1.5 * luminance(), views)
}
