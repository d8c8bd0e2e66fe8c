//! Shapes as meshes, in Mitsuba's own frames, with texture coordinates whose v is 1 less Mitsuba's.

use std::f64::consts::TAU;

use caustica_math::elementary::atan2;
use caustica_math::{Transform, Vec2, Vec3};
use caustica_scene::description::Mesh;

/// The parts that a circle is cut into.
pub(super) const SEGMENTS: u32 = 256;

/// Corners being collected.
#[derive(Default)]
struct Builder(Mesh);

impl Builder {
    fn corner(&mut self, p: [f64; 3], n: [f64; 3], uv: [f64; 2]) -> u32 {
        let to_vec = |v: [f64; 3]| Vec3::new(v[0] as f32, v[1] as f32, v[2] as f32);
        self.0.positions.push(to_vec(p));
        self.0.normals.push(to_vec(n));
        self.0.uvs.push(Vec2::new(uv[0] as f32, (1.0 - uv[1]) as f32));
        self.0.positions.len() as u32 - 1
    }

    /// Two triangles that share the side from the first corner to the third.
    fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        self.0.triangles.extend([[a, b, c], [a, c, d]]);
    }
}

/// Sine and cosine of a part of the whole turn.
fn turn(part: u32) -> (f64, f64) {
    libm::sincos(TAU * f64::from(part % SEGMENTS) / f64::from(SEGMENTS))
}

/// From −1 to 1 in x and y, facing +z.
pub(super) fn rectangle() -> Mesh {
    let mut b = Builder::default();
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
        .map(|[u, v]| b.corner([2.0 * u - 1.0, 2.0 * v - 1.0, 0.0], [0.0, 0.0, 1.0], [u, v]));
    b.quad(corners);
    b.0
}

/// Along which axes u and v grow on each side of Mitsuba's cube (as its texture coordinates there tell).
const CUBE_SIDES: [[[f64; 3]; 2]; 6] = [
    [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]],
    [[-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]],
    [[0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
    [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
    [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0]],
];

/// From −1 to 1 in x, y and z; each side has the texture once.
pub(super) fn cube() -> Mesh {
    let mut b = Builder::default();
    for [u_axis, v_axis] in CUBE_SIDES {
        // On every side u × v is inward.
        let normal = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            v_axis[j] * u_axis[k] - v_axis[k] * u_axis[j]
        });
        let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]].map(|[u, v]| {
            let at = |i: usize| normal[i] + (2.0 * u - 1.0) * u_axis[i] + (2.0 * v - 1.0) * v_axis[i];
            b.corner([at(0), at(1), at(2)], normal, [u, v])
        });
        b.quad(corners);
    }
    b.0
}

/// Of radius 1 around the z axis, facing +z; u is the radius and v the angle. Its area is 10⁻⁴ less than a circle's.
pub(super) fn disk() -> Mesh {
    let mut b = Builder::default();
    let normal = [0.0, 0.0, 1.0];
    for i in 0..SEGMENTS {
        let part = |i: u32| f64::from(i) / f64::from(SEGMENTS);
        let ((s0, c0), (s1, c1)) = (turn(i), turn(i + 1));
        let middle = b.corner([0.0; 3], normal, [0.0, 0.5 * (part(i) + part(i + 1))]);
        let from = b.corner([c0, s0, 0.0], normal, [1.0, part(i)]);
        let to = b.corner([c1, s1, 0.0], normal, [1.0, part(i + 1)]);
        b.0.triangles.push([middle, from, to]);
    }
    b.0
}

/// Of radius 1 around the z axis, from z = 0 to 1, open, facing outward; u is the angle and v the height.
pub(super) fn cylinder() -> Mesh {
    let mut b = Builder::default();
    for i in 0..=SEGMENTS {
        let (s, c) = turn(i);
        let u = f64::from(i) / f64::from(SEGMENTS);
        let low = b.corner([c, s, 0.0], [c, s, 0.0], [u, 0.0]);
        b.corner([c, s, 1.0], [c, s, 0.0], [u, 1.0]);
        if i < SEGMENTS {
            b.quad([low, low + 2, low + 3, low + 1]);
        }
    }
    b.0
}

/// Of radius 1, facing outward; u is the angle around the z axis and v that from it.
pub(super) fn sphere() -> Mesh {
    const RINGS: u32 = SEGMENTS / 2;
    let mut b = Builder::default();
    for ring in 0..=RINGS {
        let (sin, cos) = libm::sincos(0.5 * TAU * f64::from(ring) / f64::from(RINGS));
        for i in 0..=SEGMENTS {
            let (s, c) = turn(i);
            let p = [sin * c, sin * s, cos];
            b.corner(p, p, [f64::from(i) / f64::from(SEGMENTS), f64::from(ring) / f64::from(RINGS)]);
        }
    }
    let row = SEGMENTS + 1;
    for ring in 0..RINGS {
        for i in 0..SEGMENTS {
            let upper = ring * row + i;
            let lower = upper + row;
            // At the poles one of the two has no area.
            if ring + 1 < RINGS {
                b.0.triangles.push([upper, lower, lower + 1]);
            }
            if ring > 0 {
                b.0.triangles.push([upper, lower + 1, upper + 1]);
            }
        }
    }
    b.0
}

/// What moves a cylinder from the z axis to the line between two points. `None` if they are the same.
pub(super) fn along(p0: [f32; 3], p1: [f32; 3], radius: f32) -> Option<Transform> {
    let (p0, p1) = (p0.map(f64::from), p1.map(f64::from));
    let axis = [0, 1, 2].map(|i| p1[i] - p0[i]);
    let length = axis.iter().map(|a| a * a).sum::<f64>().sqrt();
    if !(length > 0.0 && length.is_finite()) {
        return None;
    }
    let [x, y, z] = axis.map(|a| a / length);
    // Where u begins: Mitsuba has the frame of Duff et al. (Building an orthonormal basis, revisited, 2017).
    let sign = 1.0_f64.copysign(z);
    let a = -1.0 / (sign + z);
    let (s, t) = ([1.0 + sign * x * x * a, sign * x * y * a, -sign * x], [x * y * a, sign + y * y * a, -y]);
    let row = |i: usize| [s[i], t[i], [x, y, z][i], p0[i]];
    let turned = Transform::from_rows([row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]]);
    let radius = f64::from(radius);
    Some(Transform::scale([radius, radius, length]).then(turned))
}

/// Normals of a mesh that has none: at each corner the mean of those of its triangles, weighed by their angles there
/// (G. Thürmer and C. A. Wüthrich, Computing vertex normals from polygonal facets, 1998), in the world.
pub(super) fn smooth_normals(mesh: &Mesh, to_world: &Transform) -> Vec<Vec3> {
    let mut sums = vec![[0.0_f64; 3]; mesh.positions.len()];
    let places: Vec<Vec3> = mesh.positions.iter().map(|p| to_world.point(*p)).collect();
    // A mirroring transform keeps outside outside.
    let side = if to_world.mirrors() { -1.0 } else { 1.0 };
    for triangle in &mesh.triangles {
        let p = triangle.map(|i| places[i as usize]);
        let across = (p[1] - p[0]).cross(p[2] - p[0]);
        let Some(normal) = across.try_normalized() else { continue };
        // The product of any two sides has that length.
        let twice_the_area = across.length();
        for i in 0..3 {
            let (a, b) = (p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
            let angle = f64::from(atan2(twice_the_area, a.dot(b)));
            let sum = &mut sums[triangle[i] as usize];
            *sum = [
                sum[0] + angle * side * f64::from(normal.x),
                sum[1] + angle * side * f64::from(normal.y),
                sum[2] + angle * side * f64::from(normal.z),
            ];
        }
    }
    let from_world = to_world.inverse();
    let local = |s: [f64; 3]| {
        let n = from_world.normal(Vec3::new(s[0] as f32, s[1] as f32, s[2] as f32));
        n.try_normalized().unwrap_or(Vec3::ZERO)
    };
    sums.into_iter().map(local).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cross_area(mesh: &Mesh) -> (f64, bool) {
        let mut area = 0.0;
        let mut agree = true;
        for t in &mesh.triangles {
            let p = t.map(|i| mesh.positions[i as usize]);
            let n = (p[1] - p[0]).cross(p[2] - p[0]);
            area += 0.5 * f64::from(n.length());
            agree &= t.iter().all(|i| n.dot(mesh.normals[*i as usize]) > 0.0);
        }
        (area, agree)
    }

    #[test]
    fn areas_and_sides() {
        let pi = std::f64::consts::PI;
        for (mesh, expected) in
            [(rectangle(), 4.0), (cube(), 24.0), (disk(), pi), (cylinder(), 2.0 * pi), (sphere(), 4.0 * pi)]
        {
            let (area, agree) = cross_area(&mesh);
            assert!((area / expected - 1.0).abs() < 3e-4 && agree, "{area} {expected} {agree}");
        }
    }

    #[test]
    fn cubes_have_their_texture_as_mitsuba_places_it() {
        let mesh = cube();
        for (p, n, uv) in [
            ([1.0, 1.0, 1.0], [1.0, 0.0, 0.0], [1.0, 0.0]),
            ([-1.0, -1.0, 1.0], [-1.0, 0.0, 0.0], [0.0, 1.0]),
            ([1.0, -1.0, -1.0], [0.0, -1.0, 0.0], [0.0, 1.0]),
            ([-1.0, 1.0, -1.0], [0.0, 1.0, 0.0], [1.0, 1.0]),
            ([1.0, 1.0, 1.0], [0.0, 0.0, 1.0], [1.0, 1.0]),
            ([-1.0, 1.0, -1.0], [0.0, 0.0, -1.0], [0.0, 0.0]),
        ] {
            let found = (0..mesh.positions.len())
                .find(|i| mesh.positions[*i] == Vec3::from(p) && mesh.normals[*i] == Vec3::from(n));
            let at = mesh.uvs[found.expect("a corner")];
            assert_eq!([at.x, 1.0 - at.y], uv, "{p:?} {n:?}");
        }
    }

    #[test]
    fn smooth_normals_of_a_sphere_are_its_points() {
        let mut mesh = sphere();
        let to_world = Transform::scale([2.0, 1.0, -1.0]);
        mesh.normals = smooth_normals(&mesh, &Transform::IDENTITY);
        let off = |mesh: &Mesh| {
            let inner = mesh
                .positions
                .iter()
                .zip(&mesh.normals)
                .filter(|(p, _)| p.z.abs() < 0.99 && p.y.abs() > 0.01);
            inner.map(|(p, n)| (*p - *n).length()).fold(0.0, f32::max)
        };
        assert!(off(&mesh) < 0.01, "{}", off(&mesh));
        // A stretched one has those of the stretched surface.
        let n = smooth_normals(&mesh, &to_world);
        assert!(n.iter().zip(&mesh.positions).all(|(n, p)| p.z.abs() > 0.99 || n.dot(*p) > 0.9));
    }
}
