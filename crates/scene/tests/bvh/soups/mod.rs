//! Heaps of primitives and bundles of rays that trees are tested with.

pub mod bodies;

use caustica_math::{SampleStream, StreamId, Vec3, elementary, warp};
use caustica_scene::bvh::{Bvh, Hit, Ray, SphereData};

/// Triangles with corners of their own, and spheres.
#[derive(Clone, Default)]
pub struct Soup {
    pub corners: Vec<[Vec3; 3]>,
    pub spheres: Vec<SphereData>,
}

/// A stream of random numbers of that name.
pub fn random(name: u32) -> SampleStream {
    SampleStream::new(StreamId { seed: 2718, pixel: name, sample: 0, walk: 0 })
}

/// Uniform in a cube of edge 2.
pub fn in_cube(s: &mut SampleStream) -> Vec3 {
    let [x, y] = s.next_2d();
    Vec3::new(x, y, s.next_1d()) * 2.0 - Vec3::splat(1.0)
}

/// 10^x for uniform x.
pub fn of_scale(s: &mut SampleStream, low: f32, high: f32) -> f32 {
    elementary::pow(10.0, low + (high - low) * s.next_1d())
}

/// An integer coordinate from −2 to 2.
fn lattice(s: &mut SampleStream) -> f32 {
    (s.next_1d() * 5.0).floor() - 2.0
}

impl Soup {
    /// Triangles of sizes from a millionth to three times the heap's.
    pub fn of_many_scales(count: usize, name: u32) -> Self {
        let mut s = random(name);
        let triangle = |_| {
            let (center, size) = (in_cube(&mut s), of_scale(&mut s, -6.0, 0.5));
            [(); 3].map(|()| center + in_cube(&mut s) * size)
        };
        Self { corners: (0..count).map(triangle).collect(), ..Self::default() }
    }

    /// Triangles with next to no width, or with none: corners in a row, or two of them the same.
    pub fn of_slivers(count: usize, name: u32) -> Self {
        let mut s = random(name);
        let triangle = |i: usize| {
            let (a, b) = (in_cube(&mut s), in_cube(&mut s));
            let along = a + (b - a) * s.next_1d();
            [
                a,
                b,
                if i.is_multiple_of(4) { b } else { along + in_cube(&mut s) * of_scale(&mut s, -8.0, -3.0) },
            ]
        };
        Self { corners: (0..count).map(triangle).collect(), ..Self::default() }
    }

    /// Triangles in planes across an axis, with corners on a coarse lattice: many lie in one plane, and
    /// many are the same.
    pub fn of_lattice(count: usize, name: u32) -> Self {
        let mut s = random(name);
        let triangle = |i: usize| {
            let (axis, level) = (i % 3, lattice(&mut s));
            [(); 3].map(|()| {
                let mut p = [lattice(&mut s), lattice(&mut s), lattice(&mut s)];
                p[axis] = level;
                Vec3::from(p)
            })
        };
        Self { corners: (0..count).map(triangle).collect(), ..Self::default() }
    }

    /// Adds spheres of sizes from a thousandth to a third of the heap's.
    pub fn with_spheres(mut self, count: usize, name: u32) -> Self {
        let mut s = random(name);
        self.spheres.extend(
            (0..count)
                .map(|_| SphereData { center: in_cube(&mut s), radius: 0.3 * of_scale(&mut s, -3.0, 0.0) }),
        );
        self
    }

    /// The tree over everything.
    pub fn tree(&self) -> Bvh {
        let positions: Vec<Vec3> = self.corners.iter().flatten().copied().collect();
        let triangles: Vec<_> =
            (0..self.corners.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        Bvh::new(&positions, &triangles, &self.spheres)
    }

    /// A tree over each primitive alone: with these the same test of a ray with a primitive runs, but
    /// nothing is sorted, skipped or cut short.
    pub fn one_by_one(&self) -> Vec<Bvh> {
        let triangles = self.corners.iter().map(|c| Bvh::new(c, &[[0, 1, 2]], &[]));
        triangles.chain(self.spheres.iter().map(|s| Bvh::new(&[], &[], &[*s]))).collect()
    }
}

/// The first hit by asking every primitive; of those at the same distance, the one of the lowest id.
pub fn brute_force(primitives: &[Bvh], ray: &Ray) -> Option<Hit> {
    let hits = primitives
        .iter()
        .enumerate()
        .filter_map(|(id, one)| one.closest(ray).map(|h| Hit { primitive: id as u32, ..h }));
    hits.min_by(|a, b| a.t.total_cmp(&b.t).then(a.primitive.cmp(&b.primitive)))
}

/// A ray of any kind: from anywhere to anywhere, along axes and in planes across them (with zeros of
/// both signs), towards corners and edges of the heap, at all lengths of direction.
pub fn some_ray(soup: &Soup, s: &mut SampleStream) -> Ray {
    let mut origin = in_cube(s) * 3.0;
    let kind = (s.next_1d() * 6.0) as u32;
    let zero = if s.next_1d() < 0.5 { 0.0 } else { -0.0 };
    let mut direction = match kind {
        0 => warp::uniform_sphere(s.next_2d()),
        1 => {
            origin = Vec3::from([lattice(s), lattice(s), lattice(s)]);
            along_axis(s, zero)
        }
        2 => {
            let d = warp::uniform_sphere(s.next_2d());
            origin.z = lattice(s);
            Vec3::new(d.x, d.y, zero)
        }
        3 => along_axis(s, zero),
        _ if soup.corners.is_empty() => in_cube(s) - origin,
        _ => {
            let t = ((s.next_1d() * soup.corners.len() as f32) as usize).min(soup.corners.len() - 1);
            let [a, b, _] = soup.corners[t];
            let at = if kind == 4 { a } else { a + (b - a) * s.next_1d() };
            at - origin
        }
    };
    if s.next_1d() < 0.5 {
        direction *= of_scale(s, -10.0, 10.0);
    }
    Ray { origin, direction, t_max: f32::INFINITY }
}

fn along_axis(s: &mut SampleStream, zero: f32) -> Vec3 {
    let mut d = [zero; 3];
    d[(s.next_1d() * 3.0) as usize % 3] = if s.next_1d() < 0.5 { 1.0 } else { -1.0 };
    Vec3::from(d)
}
