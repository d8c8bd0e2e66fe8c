//! The rays that a renderer shoots.

use caustica_math::{Frame, SampleStream, StreamId, Vec3, warp};
use caustica_scene::bvh::{Bvh, Ray};

use crate::rooms::{HALF, Room};

/// Rays of all kinds into one room.
#[derive(Debug)]
pub struct Rays {
    /// From a pinhole, row by row.
    pub primary: Vec<Ray>,
    /// By cosine from where paths of up to four edges came.
    pub bounce: Vec<Ray>,
    /// Between points of two paths: segments.
    pub connection: Vec<Ray>,
    /// From points of paths to a lamp under the ceiling: segments.
    pub next_event: Vec<Ray>,
}

/// A place on a surface.
#[derive(Clone, Copy)]
struct Place {
    position: Vec3,
    normal: Vec3,
}

impl Place {
    fn off(&self, direction: Vec3) -> Vec3 {
        self.position + self.normal * 1e-5_f32.copysign(self.normal.dot(direction))
    }
}

impl Rays {
    /// About `count` of each kind.
    pub fn new(room: &Room, tree: &Bvh, count: usize) -> Self {
        let side = (count as f32).sqrt() as usize;
        let eye = Vec3::new(0.31, -0.94, 0.31) * HALF;
        let mut rays =
            Self { primary: Vec::new(), bounce: Vec::new(), connection: Vec::new(), next_event: Vec::new() };
        for i in 0..side * side {
            let (x, y) = ((i % side) as f32 / side as f32 - 0.5, (i / side) as f32 / side as f32 - 0.5);
            let direction = Vec3::new(1.4 * x - 0.3, 1.0, -1.4 * y - 0.3).normalized();
            rays.primary.push(Ray { origin: eye, direction, t_max: f32::INFINITY });
        }
        let mut light = Vec::new();
        for i in 0.. {
            if rays.bounce.len() >= count {
                break;
            }
            let mut s = stream(0, i as u32);
            let camera = rays.primary[i * 7919 % rays.primary.len()];
            let eye_path = walk(room, tree, camera, &mut s, &mut rays.bounce);
            let lamp = lamp(&mut s);
            let down = warp::cosine_hemisphere(s.next_2d());
            let ray =
                Ray { origin: lamp, direction: Vec3::new(down.x, down.y, -down.z), t_max: f32::INFINITY };
            light.clear();
            light.extend(walk(room, tree, ray, &mut s, &mut rays.bounce));
            for z in &eye_path {
                rays.next_event.push(Ray::between(z.off(lamp - z.position), self::lamp(&mut s)));
                for y in &light {
                    let d: Vec3 = y.position - z.position;
                    // A renderer does not ask where both cosines are zero.
                    if d.dot(z.normal) > 0.0 && d.dot(y.normal) < 0.0 {
                        rays.connection.push(Ray::between(z.off(d), y.off(-d)));
                    }
                }
            }
        }
        rays
    }
}

fn stream(walk: u32, sample: u32) -> SampleStream {
    SampleStream::new(StreamId { seed: 7, pixel: 0, sample, walk })
}

fn lamp(s: &mut SampleStream) -> Vec3 {
    let [x, y] = s.next_2d();
    Vec3::new((x - 0.5) * 0.5, (y - 0.5) * 0.5, 0.99) * HALF
}

/// Follows diffuse bounces; adds the rays that were shot after the first.
fn walk(room: &Room, tree: &Bvh, mut ray: Ray, s: &mut SampleStream, bounces: &mut Vec<Ray>) -> Vec<Place> {
    let mut places = Vec::new();
    for _ in 0..4 {
        let Some(hit) = tree.closest(&ray) else { break };
        let [a, b, c] = room.triangles[hit.primitive as usize].map(|v| room.positions[v as usize]);
        let Some(normal) = (b - a).cross(c - a).try_normalized() else { break };
        let normal = if normal.dot(ray.direction) > 0.0 { -normal } else { normal };
        let place = Place { position: a * (1.0 - hit.b1 - hit.b2) + b * hit.b1 + c * hit.b2, normal };
        places.push(place);
        let direction = Frame::from_normal(normal).to_world(warp::cosine_hemisphere(s.next_2d()));
        ray = Ray { origin: place.off(direction), direction, t_max: f32::INFINITY };
        bounces.push(ray);
    }
    places
}
