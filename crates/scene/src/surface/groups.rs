//! Groups of surfaces, and the points that are hit in their instances.

use caustica_math::{Frame, Vec3};

use super::{POSITION_ERROR, SurfacePoint, Surfaces, is_reachable};
use crate::bvh::{Bvh, Hit, Instance, Instances, TreeQuality};
use crate::description::{self, Description};
use crate::diagnostic::Diagnostic;

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

    /// Notes of every shape whether anything looks at its texture coordinates.
    pub(crate) fn set_needs_uv(&mut self, needs: impl Iterator<Item = bool>) {
        self.shapes.iter_mut().zip(needs).for_each(|(shape, needs)| shape.needs_uv = needs);
        for group in &mut self.groups {
            let first = group.first_shape as usize;
            let shapes = &mut group.surfaces.shapes;
            shapes.iter_mut().zip(&self.shapes[first..]).for_each(|(s, known)| s.needs_uv = known.needs_uv);
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
        SurfacePoint { shape, instance, ..in_world(&p, place) }
    }

    /// Some point of a shape, wherever its group stands.
    pub fn some_point(&self, shape: u32) -> SurfacePoint {
        if let Some(group) = self.groups.iter().rev().find(|g| g.first_shape <= shape) {
            return SurfacePoint { shape, ..group.surfaces.some_point(shape - group.first_shape) };
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

    /// How many instances there are.
    pub fn instances(&self) -> usize {
        self.instances.len()
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
