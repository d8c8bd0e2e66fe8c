//! Closed meshes whose triangles share their corners.

use std::collections::BTreeMap;

use caustica_math::Vec3;
use caustica_math::elementary::sin_cos_turns;
use caustica_scene::description::Mesh;

/// The corners of a cube from −1 to 1 with `n` × `n` squares on each face, and the squares, counterclockwise
/// as seen from outside.
fn squares(n: i32) -> (Vec<Vec3>, Vec<[u32; 4]>) {
    let (mut positions, mut squares) = (vec![], vec![]);
    let mut indices = BTreeMap::new();
    for face in 0..6 {
        let (axis, side) = (face % 3, if face < 3 { 1 } else { -1 });
        let mut corner = |i: i32, j: i32| {
            let mut p = [0; 3];
            (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side * n, 2 * i - n, 2 * j - n);
            *indices.entry(p).or_insert_with(|| {
                positions.push(Vec3::from(p.map(|c| c as f32 / n as f32)));
                positions.len() as u32 - 1
            })
        };
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| corner(i, j));
            squares.push(if side > 0 { [a, b, c, d] } else { [a, d, c, b] });
        }
    }
    (positions, squares)
}

/// A cube from −1 to 1 with `n` × `n` squares on each face, two triangles each.
pub fn cube(n: i32) -> Mesh {
    let (positions, squares) = squares(n);
    let triangles = squares.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh { positions, triangles, ..Mesh::default() }
}

/// A unit ball: the cube's grid blown up, each square split so that the body is convex.
pub fn ball(n: i32) -> Mesh {
    let (mut positions, squares) = squares(n);
    for p in &mut positions {
        *p = p.normalized();
    }
    let split = |[a, b, c, d]: [u32; 4]| {
        let [p, q, r, s] = [a, b, c, d].map(|i| positions[i as usize]);
        if (q - p).cross(r - p).dot(s - p) <= 0.0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    let triangles = squares.into_iter().flat_map(split).collect();
    Mesh { positions, triangles, ..Mesh::default() }
}

/// The same mesh scaled and moved.
pub fn placed(mut mesh: Mesh, scale: f32, offset: Vec3) -> Mesh {
    for p in &mut mesh.positions {
        *p = *p * scale + offset;
    }
    mesh
}

/// A ring of square cells around the z axis, `n` along it and `m` around the tube of radius `r`.
pub fn torus(n: u32, m: u32, r: f32) -> Mesh {
    let turn = |i: u32, of: u32| sin_cos_turns(i as f32 / of as f32);
    let mut mesh = Mesh::default();
    for (i, j) in (0..n).flat_map(|i| (0..m).map(move |j| (i, j))) {
        let ((sin, cos), (up, out)) = (turn(i, n), turn(j, m));
        mesh.positions.push(Vec3::new(cos * (1.0 + r * out), sin * (1.0 + r * out), r * up));
        let at = |di: u32, dj: u32| (i + di) % n * m + (j + dj) % m;
        mesh.triangles.extend([[at(0, 0), at(1, 0), at(1, 1)], [at(0, 0), at(1, 1), at(0, 1)]]);
    }
    mesh
}

/// A closed prism of `n` sides from z = −1 to 1, of radius `r`: with a small one, its triangles are needles.
pub fn prism(n: u32, r: f32) -> Mesh {
    let mut mesh = Mesh { positions: vec![Vec3::new(0.0, 0.0, -1.0), Vec3::Z], ..Mesh::default() };
    for i in 0..n {
        let (sin, cos) = sin_cos_turns(i as f32 / n as f32);
        mesh.positions.extend([-1.0, 1.0].map(|z| Vec3::new(r * cos, r * sin, z)));
        let (a, b) = (2 + 2 * i, 2 + 2 * ((i + 1) % n));
        mesh.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1], [0, b, a], [1, a + 1, b + 1]]);
    }
    mesh
}
