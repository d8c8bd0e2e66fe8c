//! Surfaces as rays find them: flat tables of corners and triangles, and the points that are hit.

mod border;

use caustica_math::elementary::{asin, atan2};
use caustica_math::{Frame, Transform, Vec2, Vec3};

use crate::bvh::{Hit, SphereData};
use crate::description::{Geometry, Mesh, Shape};
use crate::diagnostic::Diagnostic;

/// No index.
const NONE: u32 = u32::MAX;

/// A shape in the flat tables.
#[derive(Clone, Copy, Debug)]
pub struct FlatShape {
    /// Index into the scene's materials.
    pub material: u32,
    /// Index into the scene's lamps, if it is one.
    pub light: Option<u32>,
    /// Ids of its primitives.
    pub first_primitive: u32,
    /// How many primitives it has.
    pub primitive_count: u32,
    /// Whether anything looks at its texture coordinates. Spheres leave theirs at zero otherwise, because
    /// two arcs cost as much as all the rest of a hit.
    pub needs_uv: bool,
    first_position: u32,
    first_normal: u32,
    first_uv: u32,
}

/// A point on a surface.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// Where.
    pub position: Vec3,
    /// The geometric normal, of length one.
    pub normal: Vec3,
    /// Shading frame; its z is the shading normal.
    pub frame: Frame,
    /// Texture coordinates.
    pub uv: Vec2,
    /// Index of the shape.
    pub shape: u32,
    /// Id of the triangle or sphere.
    pub primitive: u32,
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
    /// Shapes in the order of the description.
    pub shapes: Vec<FlatShape>,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    triangles: Vec<[u32; 3]>,
    triangle_shapes: Vec<u32>,
    spheres: Vec<FlatSphere>,
}

#[derive(Clone, Copy, Debug)]
struct FlatSphere {
    data: SphereData,
    shape: u32,
    /// World to shape directions, for the uv coordinates.
    rows: [Vec3; 3],
}

/// The relative error of a hit's position, with room to spare: a dozen roundings of 2⁻²⁴.
pub(crate) const POSITION_ERROR: f32 = 1e-6;

impl Surfaces {
    /// Flattens the shapes, taking their meshes; pushes warnings.
    ///
    /// # Errors
    /// A vertex that is not finite, an index out of range, a transform that cannot be inverted, a sphere
    /// that is scaled unevenly, a radius that is not positive, more than 2²⁷ primitives.
    pub fn new(shapes: &mut [Shape], warnings: &mut Vec<Diagnostic>) -> Result<Self, Diagnostic> {
        let mut surfaces = Self::default();
        for (index, shape) in shapes.iter_mut().enumerate() {
            if !shape.to_world.is_invertible() {
                return Err(shape_error(shape, "has a transform that cannot be inverted"));
            }
            let geometry = std::mem::replace(&mut shape.geometry, Geometry::Mesh(Mesh::default()));
            match geometry {
                Geometry::Mesh(mesh) => surfaces.add_mesh(index as u32, mesh, shape, warnings)?,
                // Spheres follow all triangles: see below.
                sphere @ Geometry::Sphere { .. } => {
                    shape.geometry = sphere;
                    surfaces.shapes.push(surfaces.empty_shape(shape));
                }
            }
        }
        for (index, shape) in shapes.iter().enumerate() {
            if let Geometry::Sphere { center, radius } = shape.geometry {
                surfaces.add_sphere(index as u32, (center, radius), shape)?;
            }
        }
        if surfaces.triangles.len() + surfaces.spheres.len() > crate::bvh::MAX_PRIMITIVES {
            return Err(Diagnostic::error(format!(
                "the scene has {} triangles and {} spheres; at most {} are supported",
                surfaces.triangles.len(),
                surfaces.spheres.len(),
                crate::bvh::MAX_PRIMITIVES
            )));
        }
        Ok(surfaces)
    }

    fn empty_shape(&self, shape: &Shape) -> FlatShape {
        FlatShape {
            material: shape.material.0,
            light: None,
            first_primitive: self.triangles.len() as u32,
            primitive_count: 0,
            needs_uv: true,
            first_position: self.positions.len() as u32,
            first_normal: NONE,
            first_uv: NONE,
        }
    }

    fn add_mesh(
        &mut self,
        index: u32,
        mesh: Mesh,
        shape: &Shape,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<(), Diagnostic> {
        let mut flat = self.empty_shape(shape);
        let count = mesh.positions.len();
        for (what, n) in [("normals", mesh.normals.len()), ("texture coordinates", mesh.uvs.len())] {
            if n != 0 && n != count {
                return Err(shape_error(shape, &format!("has {count} vertices but {n} {what}")));
            }
        }
        if self.positions.len() + count > NONE as usize {
            return Err(shape_error(shape, "has too many vertices"));
        }
        self.add_vertices(&mut flat, &mesh, shape)?;
        let (mut degenerate, mut kept) = (0usize, 0u32);
        for corners in &mesh.triangles {
            if corners.iter().any(|c| *c as usize >= count) {
                return Err(shape_error(shape, "has a triangle whose corner does not exist"));
            }
            match self.orient(&flat, corners.map(|c| c + flat.first_position), shape.to_world.mirrors()) {
                Some(triangle) => {
                    self.triangles.push(triangle);
                    self.triangle_shapes.push(index);
                    kept += 1;
                }
                None => degenerate += 1,
            }
        }
        flat.primitive_count = kept;
        if kept == 0 {
            return Err(shape_error(shape, "has no triangle with an area")
                .hint("check that the mesh file is not empty and the transform does not flatten it"));
        }
        if degenerate > 0 {
            warnings.push(
                Diagnostic::warning(format!(
                    "{}: left out {degenerate} triangles without an area",
                    shape.name
                ))
                .at(shape.origin.clone()),
            );
        }
        self.shapes.push(flat);
        Ok(())
    }

    fn add_vertices(&mut self, flat: &mut FlatShape, mesh: &Mesh, shape: &Shape) -> Result<(), Diagnostic> {
        for (i, p) in mesh.positions.iter().enumerate() {
            let world = shape.to_world.point(*p);
            // Squares of coordinates must stay finite too.
            if !world.is_finite() || world.abs().max_element() > 1e15 {
                return Err(shape_error(
                    shape,
                    &format!("has a vertex (number {}) that is not finite", i + 1),
                ));
            }
            self.positions.push(world);
        }
        if !mesh.normals.is_empty() {
            flat.first_normal = self.normals.len() as u32;
            // A normal that says nothing is stored as zero: the geometric one is used in its place.
            let world = |n: &Vec3| shape.to_world.normal(*n).try_normalized().unwrap_or(Vec3::ZERO);
            self.normals.extend(mesh.normals.iter().map(world));
        }
        if !mesh.uvs.is_empty() {
            flat.first_uv = self.uvs.len() as u32;
            self.uvs.extend_from_slice(&mesh.uvs);
        }
        Ok(())
    }

    /// Orders a triangle's corners so that its geometric normal points out: by the winding, which a
    /// mirroring transform reverses, unless all three shading normals are on the other side. `None` if the
    /// triangle has no area.
    fn orient(&self, flat: &FlatShape, [a, b, c]: [u32; 3], mirrored: bool) -> Option<[u32; 3]> {
        let p = |i: u32| self.positions[i as usize];
        let normal = (p(b) - p(a)).cross(p(c) - p(a));
        normal.try_normalized().filter(|_| normal.length_squared() > 0.0)?;
        let mut outward = if mirrored { -normal } else { normal };
        if flat.first_normal != NONE {
            let side = |i: u32| self.shading_normal(flat, i).dot(outward);
            if side(a) < 0.0 && side(b) < 0.0 && side(c) < 0.0 {
                outward = -outward;
            }
        }
        Some(if outward.dot(normal) > 0.0 { [a, b, c] } else { [a, c, b] })
    }

    fn shading_normal(&self, flat: &FlatShape, vertex: u32) -> Vec3 {
        self.normals[(vertex - flat.first_position + flat.first_normal) as usize]
    }

    fn add_sphere(
        &mut self,
        index: u32,
        (center, radius): (Vec3, f32),
        shape: &Shape,
    ) -> Result<(), Diagnostic> {
        let scale = shape.to_world.uniform_scale().ok_or_else(|| {
            shape_error(shape, "is a sphere that its transform stretches into something else")
                .hint("use the same scale on all three axes, or a mesh")
        })?;
        let data = SphereData { center: shape.to_world.point(center), radius: radius * scale };
        if !data.center.is_finite() || data.center.abs().max_element() > 1e15 {
            return Err(shape_error(shape, "is a sphere whose centre is not finite"));
        }
        if !(data.radius > 0.0 && data.radius < 1e15) {
            return Err(shape_error(shape, "is a sphere whose radius is not a positive number"));
        }
        let to_shape: Transform = shape.to_world.inverse();
        // Rows of the inverse's linear part, scaled to length one by the uniform scale.
        let column = |axis: Vec3| to_shape.vector(axis) * scale;
        let (x, y, z) = (column(Vec3::X), column(Vec3::Y), column(Vec3::Z));
        let row = |i: usize| Vec3::new(x[i], y[i], z[i]);
        let flat = &mut self.shapes[index as usize];
        flat.first_primitive = (self.triangles.len() + self.spheres.len()) as u32;
        flat.primitive_count = 1;
        self.spheres.push(FlatSphere { data, shape: index, rows: [row(0), row(1), row(2)] });
        Ok(())
    }

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
    }

    /// The point that was hit, coming from `origin` along `direction`.
    #[inline(always)]
    pub fn point(&self, hit: &Hit, origin: Vec3, direction: Vec3) -> SurfacePoint {
        if (hit.primitive as usize) < self.triangles.len() {
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
        let normal = (b - a).cross(c - a);
        // Tiny triangles have normals whose squared length underflows.
        let squared = normal.length_squared();
        let normal = if squared > 1e-30 {
            normal * (1.0 / squared.sqrt())
        } else {
            normal.try_normalized().unwrap_or(Vec3::Z)
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
            frame: Frame::from_normal(shading),
            uv,
            shape,
            primitive,
            offset: extent * POSITION_ERROR + f32::MIN_POSITIVE,
        }
    }

    /// The point of a sphere with the given outward normal.
    #[inline]
    pub fn sphere_point(&self, primitive: u32, normal: Vec3) -> SurfacePoint {
        let sphere = &self.spheres[primitive as usize - self.triangles.len()];
        let d = &sphere.data;
        let uv = if self.shapes[sphere.shape as usize].needs_uv {
            let [x, y, z] = sphere.rows.map(|row| row.dot(normal));
            Vec2::new(
                0.5 + atan2(y, x) * (0.5 * std::f32::consts::FRAC_1_PI),
                0.5 + asin(z) * std::f32::consts::FRAC_1_PI,
            )
        } else {
            Vec2::default()
        };
        SurfacePoint {
            position: d.center + normal * d.radius,
            normal,
            frame: Frame::from_normal(normal),
            uv,
            shape: sphere.shape,
            primitive,
            offset: (d.center.abs().max_element() + d.radius) * POSITION_ERROR + f32::MIN_POSITIVE,
        }
    }
}

/// "`mesh.obj` has …", at the shape's place.
fn shape_error(shape: &Shape, what: &str) -> Diagnostic {
    Diagnostic::error(format!("{} {what}", shape.name)).at(shape.origin.clone())
}
