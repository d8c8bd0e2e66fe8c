//! Where mirrors and glass are: what rays are aimed at that look for lamps behind them.

use caustica_math::{Frame, SolidAnglePdf, Vec3, warp};

use crate::bvh::{Bounds, Bvh};
use crate::surface::{FlatShape, Surfaces};

/// The most that are kept, the largest: all of them are looked at wherever rays are aimed.
const MOST: usize = 16;
/// Nearer to a ball's surface than this share of its radius, it covers no cone.
const MARGIN: f32 = 1e-3;

/// A ball around a shape that scatters by a Dirac lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Caster {
    /// Its centre.
    pub center: Vec3,
    /// Its radius.
    pub radius: f32,
}

/// The mirrors and glass of a scene.
#[derive(Clone, Debug, Default)]
pub struct Casters {
    list: Vec<Caster>,
}

impl Casters {
    /// The largest of the shapes that are casters, and of the instances of groups with any.
    pub(crate) fn new(surfaces: &Surfaces, tree: &Bvh, is_caster: impl Fn(&FlatShape) -> bool) -> Self {
        let alone = surfaces.alone().iter().filter(|s| is_caster(s)).map(|s| ball(s, surfaces));
        let inside =
            (0..).zip(tree.instance_boxes()).filter(|(i, _)| surfaces.inside(*i).iter().any(&is_caster));
        let mut list: Vec<Caster> = alone.chain(inside.map(|(_, bounds)| around(bounds))).collect();
        // Stable, so that of equal ones the first are kept.
        list.sort_by(|a, b| b.radius.total_cmp(&a.radius));
        list.truncate(MOST);
        Self { list }
    }

    /// The balls.
    pub fn iter(&self) -> impl Iterator<Item = &Caster> {
        self.list.iter()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The cones in which they are seen from a place, on the side of the normal `above` if there is one. `None` if it
    /// sees none; balls around the place itself do not count.
    #[inline]
    pub fn seen_from(&self, from: Vec3, above: Option<Vec3>) -> Option<Aim<'_>> {
        let mut aim = Aim { casters: self, from, above, solid_angle: 0.0 };
        aim.solid_angle = aim.cones().map(|c| c.one_minus_cos).sum();
        (aim.solid_angle > 0.0).then_some(aim)
    }
}

/// Directions from a place to mirrors and glass: each cone is chosen by its solid angle, and a direction in it
/// uniformly.
#[derive(Clone, Copy, Debug)]
pub struct Aim<'a> {
    casters: &'a Casters,
    from: Vec3,
    above: Option<Vec3>,
    /// Of all cones together, over 2π.
    solid_angle: f32,
}

struct Cone {
    axis: Vec3,
    sin_squared: f32,
    one_minus_cos: f32,
}

impl Aim<'_> {
    /// A direction.
    pub fn sample(&self, [u, v]: [f32; 2]) -> Option<Vec3> {
        let mut left = u * self.solid_angle;
        let mut last = None;
        for cone in self.cones() {
            let share = left / cone.one_minus_cos;
            left -= cone.one_minus_cos;
            last = Some((cone, share));
            if left < 0.0 {
                break;
            }
        }
        let (cone, share) = last?;
        let local = warp::uniform_cone([share.min(caustica_math::ONE_BELOW), v], cone.one_minus_cos);
        Some(Frame::from_normal(cone.axis).to_world(local))
    }

    /// The density of a unit direction, per solid angle.
    pub fn pdf(&self, direction: Vec3) -> SolidAnglePdf {
        let hit = self.cones().filter(|c| c.contains(direction)).count();
        SolidAnglePdf(hit as f32 * warp::uniform_cone_pdf(self.solid_angle).0)
    }

    fn cones(&self) -> impl Iterator<Item = Cone> {
        self.casters.list.iter().filter_map(|c| {
            let to = c.center - self.from;
            let (distance_squared, radius_squared) = (to.length_squared(), c.radius * c.radius);
            let outside = distance_squared > radius_squared * (1.0 + MARGIN);
            if !outside || self.above.is_some_and(|n| n.dot(to) + c.radius <= 0.0) {
                return None;
            }
            let sin_squared = radius_squared / distance_squared;
            let one_minus_cos = sin_squared / (1.0 + (1.0 - sin_squared).sqrt());
            let axis = to * (1.0 / distance_squared.sqrt());
            (one_minus_cos > 0.0).then_some(Cone { axis, sin_squared, one_minus_cos })
        })
    }
}

impl Cone {
    /// By the sine, as the cosines of narrow cones all round to one.
    fn contains(&self, direction: Vec3) -> bool {
        self.axis.dot(direction) > 0.0 && self.axis.cross(direction).length_squared() <= self.sin_squared
    }
}

/// A ball around a box.
fn around(bounds: &Bounds) -> Caster {
    let center = bounds.center();
    Caster { center, radius: (bounds.max - center).length() * (1.0 + 4.0 * f32::EPSILON) }
}

/// A ball around all of a shape: around its box's centre, if it is a mesh.
fn ball(flat: &FlatShape, surfaces: &Surfaces) -> Caster {
    if let Some(sphere) = surfaces.sphere(flat.first_primitive) {
        return Caster { center: sphere.center, radius: sphere.radius };
    }
    let corners = || {
        (flat.first_primitive..flat.first_primitive + flat.primitive_count).flat_map(|t| surfaces.corners(t))
    };
    let bounds = corners().fold(Bounds::EMPTY, Bounds::with);
    let center = bounds.center();
    let farthest = corners().map(|p| p.distance_squared(center)).fold(0.0, f32::max);
    Caster { center, radius: farthest.sqrt() * (1.0 + 4.0 * f32::EPSILON) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use caustica_math::{SampleStream, StreamId};

    fn casters() -> Casters {
        let ball = |x, y, z, radius| Caster { center: Vec3::new(x, y, z), radius };
        // Two that overlap as seen from the origin, a small one apart, one below, and one around the origin.
        let list = vec![
            ball(0.0, 0.0, 5.0, 1.0),
            ball(0.5, 0.0, 4.0, 1.0),
            ball(3.0, 0.0, 1.0, 0.01),
            ball(0.0, 0.0, -3.0, 1.0),
            ball(0.0, 0.5, 0.0, 2.0),
        ];
        Casters { list }
    }

    /// The share of directions in each of some cells, drawn and by the density: within 5σ.
    #[test]
    fn directions_follow_their_density() {
        let casters = casters();
        for above in [None, Some(Vec3::Z)] {
            let aim = casters.seen_from(Vec3::ZERO, above).unwrap();
            let mut s = SampleStream::new(StreamId { seed: 1, pixel: 0, sample: 0, walk: 0 });
            let cells = 4;
            let cell = |d: Vec3| ((d.z > 0.97) as usize) + 2 * ((d.x > 0.1) as usize);
            let (mut drawn, mut expected) = (vec![0.0; cells], vec![0.0; cells]);
            let n = 400_000;
            for _ in 0..n {
                let d = aim.sample(s.next_2d()).unwrap();
                assert!((d.length() - 1.0).abs() < 1e-5 && (above.is_none() || d.z > 0.0));
                drawn[cell(d)] += 1.0 / f64::from(n);
                let d = warp::uniform_sphere(s.next_2d());
                expected[cell(d)] += f64::from(aim.pdf(d).0 / warp::UNIFORM_SPHERE_PDF.0) / f64::from(n);
            }
            // The density over that of uniform directions is at most 50.
            assert!((expected.iter().sum::<f64>() - 1.0).abs() < 5.0 * (50.0 / f64::from(n)).sqrt());
            for (a, b) in drawn.iter().zip(&expected) {
                assert!(
                    (a - b).abs() < 5.0 * (51.0 * b / f64::from(n)).sqrt() + 1e-4,
                    "{drawn:?}, {expected:?}"
                );
            }
        }
    }

    #[test]
    fn narrow_cones_hold_what_is_drawn_in_them() {
        let casters = Casters { list: vec![Caster { center: Vec3::new(300.0, -400.0, 0.1), radius: 1e-3 }] };
        let aim = casters.seen_from(Vec3::ZERO, None).unwrap();
        let mut s = SampleStream::new(StreamId { seed: 2, pixel: 0, sample: 0, walk: 0 });
        let inside = (0..1000).filter(|_| aim.pdf(aim.sample(s.next_2d()).unwrap()).0 > 0.0).count();
        // Rounding of the direction, 10⁻⁷, is a twentieth of the cone's half angle.
        assert!(inside > 850, "{inside}");
    }

    #[test]
    fn nothing_is_seen_from_inside_or_below() {
        let casters = Casters { list: vec![Caster { center: Vec3::Z, radius: 0.5 }] };
        assert!(casters.seen_from(Vec3::new(0.0, 0.0, 1.2), None).is_none());
        assert!(casters.seen_from(Vec3::ZERO, Some(-Vec3::Z)).is_none());
        assert!(casters.seen_from(Vec3::ZERO, Some(Vec3::Z)).is_some());
        assert!(Casters::default().seen_from(Vec3::ZERO, None).is_none());
    }
}
