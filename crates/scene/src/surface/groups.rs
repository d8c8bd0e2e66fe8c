//! Groups of surfaces, and the points that are hit in their instances.

use caustica_math::{Frame, Vec3};

use super::{FlatShape, POSITION_ERROR, SurfacePoint, Surfaces, is_reachable, tangents};
use crate::bvh::{Bvh, Hit, Instance, Instances, TreeQuality};
use crate::description::{self, Description};
use crate::diagnostic::Diagnostic;
use crate::traits::Traits;

/// The surfaces of a group, in its own frame.
#[derive(Debug)]
pub(super) struct Group {
    surfaces: Surfaces,
    /// The number of its first shape among all.
    first_shape: u32,
}

/// Transforms have no larger factors, and their inverses neither.
const LARGEST_FACTOR: f64 = 1e15;

impl Surfaces {
    /// Adds the description's groups, taking their meshes, and its instances.
    ///
    /// # Errors
    /// As [`Surfaces::new`]; an instance of nothing, one whose transform is projective, cannot be inverted or leads out
    /// of the range of numbers; too many instances.
    pub(crate) fn add_groups(
        &mut self,
        description: &mut Description,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<(), Diagnostic> {
        for group in &mut description.groups {
            let surfaces = Self::new(&mut group.shapes, warnings)?;
            let first_shape = self.shapes.len() as u32;
            self.shapes.extend_from_slice(&surfaces.shapes);
            self.groups.push(Group { surfaces, first_shape });
        }
        let most = crate::bvh::MAX_PRIMITIVES - self.triangles.len() - self.spheres.len();
        if description.instances.len() > most {
            return Err(Diagnostic::error(format!("the scene has more than {most} instances")));
        }
        let place = |i: &description::Instance| {
            let group = &description.groups[i.group.0 as usize];
            place(i).map_err(|what| {
                Diagnostic::error(format!("an instance of {} {what}", group.name)).at(i.origin.clone())
            })
        };
        self.instances = description.instances.iter().map(place).collect::<Result<_, _>>()?;
        Ok(())
    }

    /// Notes of every shape what its material and its emission ask for.
    pub(crate) fn mark(&mut self, traits: impl Iterator<Item = Traits>) {
        for (shape, traits) in self.shapes.iter_mut().zip(traits) {
            shape.needs_uv = traits.uses_uv;
            shape.needs_tangents = traits.is_oriented;
            shape.is_wrapped = traits.is_wrapped;
            shape.is_mixed = traits.is_mixed;
        }
        for group in &mut self.groups {
            let first = group.first_shape as usize;
            for (shape, known) in group.surfaces.shapes.iter_mut().zip(&self.shapes[first..]) {
                // Frames are made in the world.
                *shape = FlatShape { needs_tangents: false, ..*known };
            }
        }
    }

    /// The tree over everything; the error is the number of an instance that reaches beyond the range of numbers.
    pub(crate) fn tree(&self, quality: TreeQuality) -> Result<Bvh, u32> {
        let over = |s: &Self, instances| {
            Bvh::with_instances((&s.positions, &s.triangles), &s.spheres(), instances, quality)
        };
        let groups = self.groups.iter().map(|g| over(&g.surfaces, Instances::default())).collect();
        let instances = Instances::new(groups, self.instances.clone());
        match instances.boxes().iter().position(|b| !(is_reachable(b.min) && is_reachable(b.max))) {
            Some(beyond) => Err(beyond as u32),
            None => Ok(over(self, instances)),
        }
    }

    /// The point that was hit in an instance.
    #[cold]
    #[inline(never)]
    pub(super) fn point_inside(&self, hit: &Hit, origin: Vec3, direction: Vec3) -> SurfacePoint {
        let place = &self.instances[hit.instance as usize];
        let group = &self.groups[place.group as usize];
        let inside = Hit { instance: Hit::NO_INSTANCE, ..*hit };
        let (origin, direction) = (place.to_group.point(origin), place.to_group.vector(direction));
        let p = group.surfaces.point(&inside, origin, direction);
        let (shape, instance) = (p.shape + group.first_shape, hit.instance);
        let mut point = SurfacePoint { shape, instance, ..in_world(&p, place) };
        if self.shapes[shape as usize].needs_tangents {
            point.frame = tangents::frame(point.frame.z, self.derivatives(&point));
        }
        point
    }

    /// A point in an instance as one of its group, with the group's surfaces.
    pub(super) fn inside_of(&self, point: &SurfacePoint) -> Option<(&Self, SurfacePoint)> {
        let place = &self.instances[point.instance as usize];
        let surfaces = &self.groups[place.group as usize].surfaces;
        let normal = place.to_world.normal_back(point.normal).try_normalized()?;
        let position = place.to_group.point(point.position);
        Some((surfaces, SurfacePoint { instance: Hit::NO_INSTANCE, normal, position, ..*point }))
    }

    /// ∂p/∂u and ∂p/∂v at a point in an instance, in the world.
    pub(super) fn derivatives_inside(&self, point: &SurfacePoint) -> Option<[Vec3; 2]> {
        let place = &self.instances[point.instance as usize];
        let (surfaces, inside) = self.inside_of(point)?;
        let derivatives = surfaces.derivatives(&inside)?.map(|d| place.to_world.vector(d));
        derivatives.iter().all(|d| d.is_finite()).then_some(derivatives)
    }

    /// Some point of a shape, wherever its group stands.
    pub fn some_point(&self, shape: u32) -> SurfacePoint {
        if let Some((surfaces, inside)) = self.group_of(shape) {
            return SurfacePoint { shape, ..surfaces.some_point(inside) };
        }
        let primitive = self.shapes[shape as usize].first_primitive;
        match self.sphere(primitive) {
            Some(_) => self.sphere_point(primitive, Vec3::X),
            None => self.triangle_point(primitive, 0.3, 0.3),
        }
    }

    /// How many triangles and spheres are kept, those of groups with them.
    pub fn kept(&self) -> [usize; 2] {
        let own = [self.triangles.len(), self.spheres.len()];
        self.groups.iter().map(|g| g.surfaces.kept()).fold(own, |[a, b], [c, d]| [a + c, b + d])
    }

    /// How many triangles and spheres stand in the scene, those of groups in each of their instances.
    pub fn placed(&self) -> [u64; 2] {
        let own = [self.triangles.len(), self.spheres.len()].map(|n| n as u64);
        let groups = self.instances.iter().map(|i| self.groups[i.group as usize].surfaces.placed());
        groups.fold(own, |[a, b], [c, d]| [a + c, b + d])
    }

    /// The shapes that stand for themselves.
    pub(crate) fn alone(&self) -> &[FlatShape] {
        let count = self.groups.first().map_or(self.shapes.len(), |g| g.first_shape as usize);
        &self.shapes[..count]
    }

    /// The shapes of an instance's group.
    pub(crate) fn inside(&self, instance: u32) -> &[FlatShape] {
        &self.groups[self.instances[instance as usize].group as usize].surfaces.shapes
    }

    /// How many instances there are.
    pub fn instances(&self) -> usize {
        self.instances.len()
    }

    /// The surfaces of a shape's group, and its number among them.
    pub(super) fn group_of(&self, shape: u32) -> Option<(&Self, u32)> {
        let group = self.groups.iter().rev().find(|g| g.first_shape <= shape)?;
        Some((&group.surfaces, shape - group.first_shape))
    }

    /// The surfaces of each group, to be changed.
    pub(super) fn groups_mut(&mut self) -> impl Iterator<Item = &mut Self> {
        self.groups.iter_mut().map(|g| &mut g.surfaces)
    }

    /// The surfaces of each group, in its own frame.
    pub(crate) fn groups(&self) -> impl Iterator<Item = &Self> {
        self.groups.iter().map(|g| &g.surfaces)
    }
}

/// The place of an instance; or what is wrong with it.
fn place(instance: &description::Instance) -> Result<Instance, &'static str> {
    let [to_world, to_group] =
        instance.to_world.affine().ok_or("has a transform that cannot be inverted, or is projective")?;
    if [to_world, to_group].iter().any(|a| a.largest() > LARGEST_FACTOR) {
        return Err("has a transform with factors that are too large or too small");
    }
    Ok(Instance { group: instance.group.0, to_world, to_group })
}

/// A point of a group's frame in the world.
fn in_world(p: &SurfacePoint, place: &Instance) -> SurfacePoint {
    let position = place.to_world.point(p.position);
    let normal = place.to_group.normal_back(p.normal);
    // By so much is what lies along the normal stretched.
    let stretch = 1.0 / normal.length();
    let normal = normal * stretch;
    let shading = place.to_group.normal_back(p.frame.z).try_normalized();
    // A strong stretch may turn the shading normal to the other side: it says nothing useful then.
    let shading = shading.filter(|s| s.dot(normal) > 0.0).unwrap_or(normal);
    SurfacePoint {
        position,
        normal,
        frame: Frame::from_normal(shading),
        // The rounding of the point there and of its ray, which is taken back there, and that of the point here.
        offset: p.offset * stretch + position.abs().max_element() * POSITION_ERROR,
        ..*p
    }
}
