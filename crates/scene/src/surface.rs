//! Surfaces as rays find them: flat tables of corners and triangles, and the points that are hit.

mod attributes;
mod border;
mod flatten;
mod groups;
mod tangents;

use std::sync::Arc;

use caustica_math::elementary::{asin, atan2};
use caustica_math::{Frame, Vec2, Vec3, spherical};

use crate::bvh::{Hit, Instance, SphereData};
use attributes::FlatAttribute;
use groups::Group;

pub use attributes::Site;
pub(crate) use flatten::{FARTHEST, is_reachable, unreachable};

/// No index.
const NONE: u32 = u32::MAX;

/// A shape in the flat tables.
#[derive(Clone, Copy, Debug)]
pub struct FlatShape {
    /// Index into the scene's materials.
    pub material: u32,
    /// Index into the scene's lamps, if it is one.
    pub light: Option<u32>,
    /// Whether it emits along its normals alone: no camera sees that, and none sees the shape if it hides lamps.
    pub is_collimated: bool,
    /// Ids of its primitives.
    pub first_primitive: u32,
    /// How many primitives it has.
    pub primitive_count: u32,
    /// Whether anything looks at its texture coordinates. Spheres leave theirs at zero otherwise, because
    /// two arcs cost as much as all the rest of a hit.
    pub needs_uv: bool,
    /// Whether anything depends on which way the shading frame's x points. It follows ∂p/∂u then, and is arbitrary
    /// otherwise.
    pub needs_tangents: bool,
    /// Whether its material is more than one BSDF in its place.
    pub is_wrapped: bool,
    /// Whether chance decides what its material is.
    pub is_mixed: bool,
    first_position: u32,
    first_normal: u32,
    first_uv: u32,
    first_attribute: u32,
}

/// A point on a surface.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// Where.
    pub position: Vec3,
    /// The geometric normal, of length one.
    pub normal: Vec3,
    /// Shading frame; its z is the shading normal. Its x follows ∂p/∂u where [`FlatShape::needs_tangents`] says so and
    /// there are texture coordinates to tell.
    pub frame: Frame,
    /// Texture coordinates.
    pub uv: Vec2,
    /// Index of the shape.
    pub shape: u32,
    /// Id of the triangle or sphere; in an instance, the id in its group.
    pub primitive: u32,
    /// Number of the instance that it lies in; [`Hit::NO_INSTANCE`] if in none.
    pub instance: u32,
    /// How far rays must start off the surface so that they do not meet it again, by rounding.
    pub offset: f32,
}

impl SurfacePoint {
    /// The start of a ray that leaves in `direction`, or the end of one that comes from there.
    #[inline]
    pub fn off_surface(&self, direction: Vec3) -> Vec3 {
        self.position + self.normal * self.offset.copysign(self.normal.dot(direction))
    }
}

/// The tables of all surfaces.
#[derive(Debug, Default)]
pub struct Surfaces {
    /// Shapes in the order of the description, then those of its groups, with primitives by their ids there.
    pub shapes: Vec<FlatShape>,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    triangles: Vec<[u32; 3]>,
    triangle_shapes: Vec<u32>,
    spheres: Vec<FlatSphere>,
    attributes: Vec<FlatAttribute>,
    groups: Vec<Group>,
    instances: Arc<[Instance]>,
}

#[derive(Clone, Copy, Debug)]
struct FlatSphere {
    data: SphereData,
    shape: u32,
    /// World to shape directions, for the uv coordinates.
    rows: [Vec3; 3],
}

impl FlatSphere {
    /// Texture coordinates where the outward normal is that.
    #[inline]
    fn uv(&self, normal: Vec3) -> Vec2 {
        let [x, y, z] = self.rows.map(|row| row.dot(normal));
        Vec2::new(
            0.5 + atan2(y, x) * (0.5 * std::f32::consts::FRAC_1_PI),
            0.5 + asin(z) * std::f32::consts::FRAC_1_PI,
        )
    }
}

/// The relative error of a hit's position, with room to spare: a dozen roundings of 2⁻²⁴.
pub(crate) const POSITION_ERROR: f32 = 1e-6;

/// Triangles without a larger area are left out: a density on one must stay finite.
const LEAST_AREA: f64 = 1e-36;
/// sin² of the angle of two sides below which their product is taken with more digits.
const THIN: f32 = 1e-6;

impl Surfaces {
    /// Corners of all triangles, for the tree.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// All triangles, for the tree; ids 0 and up.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// All spheres, for the tree; their ids follow those of the triangles.
    pub fn spheres(&self) -> Vec<SphereData> {
        self.spheres.iter().map(|s| s.data).collect()
    }

    /// The sphere of that primitive id, if it is one.
    #[inline]
    pub fn sphere(&self, primitive: u32) -> Option<&SphereData> {
        let index = (primitive as usize).checked_sub(self.triangles.len())?;
        self.spheres.get(index).map(|s| &s.data)
    }

    /// The corners of a triangle.
    #[inline]
    pub fn corners(&self, primitive: u32) -> [Vec3; 3] {
        self.triangles[primitive as usize].map(|v| self.positions[v as usize])
    }

    /// The shape that a primitive belongs to.
    #[inline]
    pub fn shape_of(&self, primitive: u32) -> u32 {
        match (primitive as usize).checked_sub(self.triangles.len()) {
            None => self.triangle_shapes[primitive as usize],
            Some(sphere) => self.spheres[sphere].shape,
        }
    }

    /// How many bytes the tables take.
    pub fn memory(&self) -> usize {
        size_of_val(&*self.positions)
            + size_of_val(&*self.normals)
            + size_of_val(&*self.uvs)
            + size_of_val(&*self.triangles)
            + size_of_val(&*self.triangle_shapes)
            + size_of_val(&*self.spheres)
            + self.attribute_memory()
            + self.groups().map(Self::memory).sum::<usize>()
    }

    /// The point that was hit, coming from `origin` along `direction`.
    #[inline(always)]
    pub fn point(&self, hit: &Hit, origin: Vec3, direction: Vec3) -> SurfacePoint {
        if hit.instance != Hit::NO_INSTANCE {
            self.point_inside(hit, origin, direction)
        } else if (hit.primitive as usize) < self.triangles.len() {
            self.point_between(hit.primitive, &hit.corners, [hit.b1, hit.b2])
        } else {
            let sphere = &self.spheres[hit.primitive as usize - self.triangles.len()];
            let n = origin + direction * hit.t - sphere.data.center;
            self.sphere_point(hit.primitive, n.normalized())
        }
    }

    /// The point of a triangle with the given barycentric coordinates of its second and third corner.
    #[inline]
    pub fn triangle_point(&self, primitive: u32, b1: f32, b2: f32) -> SurfacePoint {
        self.point_between(primitive, &self.corners(primitive), [b1, b2])
    }

    /// The same, with the corners at hand.
    #[inline(always)]
    fn point_between(&self, primitive: u32, &[a, b, c]: &[Vec3; 3], [b1, b2]: [f32; 2]) -> SurfacePoint {
        let b0 = 1.0 - b1 - b2;
        let position = a * b0 + b * b1 + c * b2;
        let (u, v) = (b - a, c - a);
        let normal = u.cross(v);
        let squared = normal.length_squared();
        // Of tiny triangles the square underflows, and of thin ones the product loses its digits.
        let normal = if squared > 1e-30 && squared > THIN * u.length_squared() * v.length_squared() {
            normal * (1.0 / squared.sqrt())
        } else {
            exact_normal([a, b, c]).unwrap_or(Vec3::Z)
        };
        let shape = self.triangle_shapes[primitive as usize];
        let flat = &self.shapes[shape as usize];
        let mut shading = normal;
        let corners = || self.triangles[primitive as usize];
        if flat.first_normal != NONE {
            let [na, nb, nc] = corners().map(|v| self.shading_normal(flat, v));
            let n = na * b0 + nb * b1 + nc * b2;
            let squared = n.length_squared();
            // Normals that cancel, or face the other way, say nothing useful.
            if squared > 1e-12 && n.dot(normal) > 0.0 {
                shading = n * (1.0 / squared.sqrt());
            }
        }
        let uv = if flat.first_uv == NONE || !flat.needs_uv {
            Vec2::new(b1, b2)
        } else {
            let uv = |v: u32| self.uvs[(v - flat.first_position + flat.first_uv) as usize];
            let [a, b, c] = corners();
            uv(a) * b0 + uv(b) * b1 + uv(c) * b2
        };
        let extent = a.abs().max(b.abs()).max(c.abs()).max_element();
        SurfacePoint {
            position,
            normal,
            frame: if flat.needs_tangents {
                tangents::frame(shading, self.triangle_derivatives(primitive, &[a, b, c]))
            } else {
                Frame::from_normal(shading)
            },
            uv,
            shape,
            primitive,
            instance: Hit::NO_INSTANCE,
            offset: extent * POSITION_ERROR + f32::MIN_POSITIVE,
        }
    }

    /// The point of a sphere with the given outward normal.
    #[inline]
    pub fn sphere_point(&self, primitive: u32, normal: Vec3) -> SurfacePoint {
        let sphere = &self.spheres[primitive as usize - self.triangles.len()];
        let d = &sphere.data;
        let flat = &self.shapes[sphere.shape as usize];
        let uv = if flat.needs_uv { sphere.uv(normal) } else { Vec2::default() };
        SurfacePoint {
            position: d.center + normal * d.radius,
            normal,
            frame: if flat.needs_tangents {
                tangents::frame(normal, sphere.derivatives(normal))
            } else {
                Frame::from_normal(normal)
            },
            uv,
            shape: sphere.shape,
            primitive,
            instance: Hit::NO_INSTANCE,
            offset: (d.center.abs().max_element() + d.radius) * POSITION_ERROR + f32::MIN_POSITIVE,
        }
    }
}

/// The unit normal of a triangle by its winding; `None` if its area is zero, or so small that a density on it
/// would not be finite.
fn exact_normal([a, b, c]: [Vec3; 3]) -> Option<Vec3> {
    let normal = spherical::cross(spherical::between(a, b), spherical::between(a, c));
    let length = spherical::dot(normal, normal).sqrt();
    (0.5 * length > LEAST_AREA).then(|| Vec3::from(normal.map(|n| (n / length) as f32)))
}
