//! Closed rooms full of bumpy bodies.

use caustica_math::{Vec3, elementary};

/// Triangles in a room, as positions and indices.
#[derive(Debug, Default)]
pub struct Room {
    /// Corners.
    pub positions: Vec<Vec3>,
    /// Indices of corners.
    pub triangles: Vec<[u32; 3]>,
}

/// Half the side of the room, a cube around the origin.
pub const HALF: f32 = 1.0;
/// Bodies along each side of the lattice that they stand on.
const ROW: u32 = 3;

impl Room {
    /// A cube with 27 bodies of about as many triangles in all.
    pub fn new(triangles: usize) -> Self {
        let mut room = Self::default();
        room.add_walls();
        let each = triangles / (ROW * ROW * ROW) as usize;
        let rings = ((each as f32 / 4.0).sqrt() as u32).max(3);
        for i in 0..ROW * ROW * ROW {
            let place = [i % ROW, i / ROW % ROW, i / (ROW * ROW)];
            let center = Vec3::from(place.map(|c| (c as f32 - 1.0) * 0.62 * HALF));
            if i % 2 == 0 { room.add_ball(center, rings, i) } else { room.add_ring(center, rings, i) }
        }
        room
    }

    /// The same with a tangle of long flat sticks in all directions: one in 20 of the triangles.
    pub fn with_sticks(triangles: usize) -> Self {
        let mut room = Self::new(triangles);
        room.add_sticks(triangles / 40);
        room
    }

    /// A cube full of sticks and nothing else.
    pub fn of_sticks(triangles: usize) -> Self {
        let mut room = Self::default();
        room.add_walls();
        room.add_sticks(triangles / 2);
        room
    }

    /// Adds sticks, two triangles each.
    fn add_sticks(&mut self, count: usize) {
        // Equally spread in five dimensions: Roberts, "The Unreasonable Effectiveness of Quasirandom
        // Sequences", 2018.
        const STEPS: [f64; 5] = [0.834_957, 0.697_154, 0.582_093, 0.486_023, 0.405_808];
        for i in 0..count as u32 {
            let [x, y, z, u, v] = STEPS.map(|s| (f64::from(i) * s).fract() as f32);
            let center = (Vec3::new(x, y, z) * 2.0 - Vec3::splat(1.0)) * (0.7 * HALF);
            let (sin, cos) = elementary::sin_cos(u * std::f32::consts::TAU);
            let up = v * 2.0 - 1.0;
            let flat = (1.0 - up * up).sqrt();
            let along = Vec3::new(flat * cos, flat * sin, up) * (0.25 * HALF);
            let across = Vec3::new(-sin, cos, 0.0) * (0.002 * HALF);
            let first = self.positions.len() as u32;
            self.positions.extend([
                center - along - across,
                center + along - across,
                center + along + across,
                center - along + across,
            ]);
            self.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
    }

    fn add_walls(&mut self) {
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let corner = |a: f32, b: f32| {
                    let mut p = [0.0; 3];
                    p[axis] = side;
                    p[(axis + 1) % 3] = a;
                    p[(axis + 2) % 3] = b;
                    Vec3::from(p) * HALF
                };
                let first = self.positions.len() as u32;
                self.positions.extend([
                    corner(-1.0, -1.0),
                    corner(1.0, -1.0),
                    corner(1.0, 1.0),
                    corner(-1.0, 1.0),
                ]);
                self.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            }
        }
    }

    /// A closed grid of `2·rings` × `rings` cells, of which `place` gives the corners.
    fn add_grid(&mut self, rings: u32, place: impl Fn(f32, f32) -> Vec3) {
        let first = self.positions.len() as u32;
        let around = 2 * rings;
        for i in 0..=rings {
            for j in 0..around {
                self.positions.push(place(i as f32 / rings as f32, j as f32 / around as f32));
            }
        }
        let at = |i: u32, j: u32| first + i * around + j % around;
        for i in 0..rings {
            for j in 0..around {
                let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                self.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }

    fn add_ball(&mut self, center: Vec3, rings: u32, name: u32) {
        let phase = name as f32;
        self.add_grid(rings, |u, v| {
            let (theta, phi) = (u * std::f32::consts::PI, v * std::f32::consts::TAU);
            let [(st, ct), (sp, cp)] = [theta, phi].map(elementary::sin_cos);
            let bump = elementary::sin(9.0 * theta + phase) * elementary::sin(7.0 * phi);
            center + Vec3::new(st * cp, st * sp, ct) * (HALF * (0.2 + 0.015 * bump * st))
        });
    }

    fn add_ring(&mut self, center: Vec3, rings: u32, name: u32) {
        let tilt = elementary::sin_cos(name as f32);
        self.add_grid(rings, |u, v| {
            let [(s1, c1), (s2, c2)] = [u, v].map(|t| elementary::sin_cos(t * std::f32::consts::TAU));
            let tube = 0.06 + 0.01 * elementary::sin(50.0 * u + 30.0 * v);
            let (x, y, z) = ((0.16 + tube * c1) * c2, (0.16 + tube * c1) * s2, tube * s1);
            center + Vec3::new(x, y * tilt.1 - z * tilt.0, y * tilt.0 + z * tilt.1) * HALF
        });
    }
}
