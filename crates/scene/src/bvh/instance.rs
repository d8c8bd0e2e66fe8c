//! Trees inside of a tree: a group has its tree once, and stands wherever it has instances.
//!
//! A ray is taken into the group's frame, where its direction keeps what length it gets: so distances along it are the
//! same numbers in both. An instance is a primitive of the outer tree, of a leaf of its own.

use std::sync::Arc;

use caustica_math::{Affine, Vec3};

use super::{Bounds, Bvh, Hit, Ray};

/// Where a group stands.
#[derive(Clone, Copy, Debug)]
pub struct Instance {
    /// The group's number.
    pub group: u32,
    /// Group to world.
    pub to_world: Affine,
    /// World to group.
    pub to_group: Affine,
}

impl Instance {
    /// The ray in the group's frame, with the same distances along it.
    #[inline]
    fn ray(&self, ray: &Ray) -> Ray {
        let (origin, direction) = (self.to_group.point(ray.origin), self.to_group.vector(ray.direction));
        Ray { origin, direction, t_max: ray.t_max }
    }

    /// The box around it, wide enough for the rounding of hits.
    fn bounds(&self, tree: &Bvh) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        for part in tree.parts() {
            for i in 0..8 {
                let pick = |axis: usize| if i >> axis & 1 == 0 { part.min[axis] } else { part.max[axis] };
                bounds = bounds.with(self.to_world.point(Vec3::new(pick(0), pick(1), pick(2))));
            }
        }
        if bounds.is_empty() {
            return bounds;
        }
        let extent = tree.bounds().min.abs().max(tree.bounds().max.abs());
        let room = self.to_world.magnitude(extent) * ROUNDING;
        Bounds { min: bounds.min - room, max: bounds.max + room }
    }
}

/// More than the relative error of a hit's place.
const ROUNDING: f32 = 2e-6;

/// The groups' trees and where they stand.
#[derive(Debug, Default)]
pub struct Instances {
    groups: Vec<Bvh>,
    places: Arc<[Instance]>,
    boxes: Vec<Bounds>,
}

impl Instances {
    /// From the groups' trees, which have no instances themselves, and all places.
    pub fn new(groups: Vec<Bvh>, places: Arc<[Instance]>) -> Self {
        let boxes = places.iter().map(|p| p.bounds(&groups[p.group as usize])).collect();
        Self { groups, places, boxes }
    }

    /// The box around each.
    pub(crate) fn boxes(&self) -> &[Bounds] {
        &self.boxes
    }

    pub(super) fn memory(&self) -> usize {
        let groups: usize = self.groups.iter().map(Bvh::memory).sum();
        groups + size_of_val(&*self.places) + size_of_val(&*self.boxes)
    }

    /// As on CPUs without AVX2.
    pub(super) fn portable(self) -> Self {
        Self { groups: self.groups.into_iter().map(Bvh::portable).collect(), ..self }
    }

    /// The first hit in an instance.
    ///
    /// None comes before the instance's own box: as for triangles, what is hit so does not depend on the boxes in which
    /// the tree keeps it.
    pub(super) fn closest(&self, index: usize, ray: &Ray) -> Option<Hit> {
        let place = &self.places[index];
        let hit = self.groups[place.group as usize].closest(&place.ray(ray))?;
        Some(Hit { t: hit.t.max(entry(&self.boxes[index], ray)), instance: index as u32, ..hit })
    }

    /// Whether anything is hit in an instance.
    pub(super) fn occluded(&self, index: usize, ray: &Ray) -> bool {
        let place = &self.places[index];
        self.groups[place.group as usize].occluded(&place.ray(ray))
    }
}

/// Where a ray enters a box, to the bits that [`super::ray::LaneRay::enter`] finds.
fn entry(bounds: &Bounds, ray: &Ray) -> f32 {
    let along = |axis: usize| {
        let (o, d) = (ray.origin[axis], ray.direction[axis]);
        let d = if d.abs() < f32::MIN_POSITIVE { f32::MIN_POSITIVE.copysign(d) } else { d };
        let plane = if d < 0.0 { bounds.max[axis] } else { bounds.min[axis] };
        (plane - o) * (1.0 / d)
    };
    along(0).max(along(1)).max(along(2)).max(0.0)
}
