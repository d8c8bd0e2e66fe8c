//! Closed convex meshes whose triangles share their corners.

use std::collections::BTreeMap;

use caustica_math::Vec3;
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
