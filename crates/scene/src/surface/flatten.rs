//! From shapes to tables: what of them can be rendered, and what says nothing.

use caustica_math::{Transform, Vec2, Vec3};

use super::{FlatShape, FlatSphere, NONE, Surfaces, exact_normal};
use crate::bvh::SphereData;
use crate::description::{Geometry, Mesh, Shape};
use crate::diagnostic::Diagnostic;

/// Coordinates and radii are not larger.
pub(crate) const FARTHEST: f32 = 1e15;
/// Radii are not smaller: a density on the sphere must stay finite.
const LEAST_RADIUS: f32 = 1e-15;

impl Surfaces {
    /// Flattens the shapes, taking their meshes; pushes warnings: of triangles without an area, which are left
    /// out, and of normals and texture coordinates that say nothing.
    ///
    /// # Errors
    /// A vertex that is not finite, an index out of range, a transform that cannot be inverted, a sphere
    /// that is scaled unevenly, a radius that is not positive, more than 2²⁷ primitives.
    pub fn new(shapes: &mut [Shape], warnings: &mut Vec<Diagnostic>) -> Result<Self, Diagnostic> {
        let mut surfaces = Self::default();
        surfaces.reserve(shapes);
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

    /// Makes room for all meshes at once: tables that grow take twice as much, and three times while they do.
    fn reserve(&mut self, shapes: &[Shape]) {
        let meshes = || {
            shapes.iter().filter_map(|s| match &s.geometry {
                Geometry::Mesh(m) => Some(m),
                Geometry::Sphere { .. } => None,
            })
        };
        self.positions.reserve_exact(meshes().map(|m| m.positions.len()).sum());
        self.normals.reserve_exact(meshes().map(|m| m.normals.len()).sum());
        self.uvs.reserve_exact(meshes().map(|m| m.uvs.len()).sum());
        let triangles = meshes().map(|m| m.triangles.len()).sum();
        self.triangles.reserve_exact(triangles);
        self.triangle_shapes.reserve_exact(triangles);
    }

    fn empty_shape(&self, shape: &Shape) -> FlatShape {
        FlatShape {
            material: shape.material.0,
            light: None,
            is_collimated: false,
            first_primitive: self.triangles.len() as u32,
            primitive_count: 0,
            needs_uv: true,
            needs_tangents: false,
            is_wrapped: false,
            is_mixed: false,
            first_position: self.positions.len() as u32,
            first_normal: NONE,
            first_uv: NONE,
            first_attribute: self.attributes.len() as u32,
        }
    }

    fn add_mesh(
        &mut self,
        index: u32,
        mut mesh: Mesh,
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
        warn_of_useless(&self.normals[self.normals.len() - mesh.normals.len()..], &mesh, shape, warnings);
        let (mut degenerate, mut kept) = (Vec::new(), 0u32);
        for (number, corners) in mesh.triangles.iter().enumerate() {
            if let Some(corner) = corners.iter().find(|c| **c as usize >= count) {
                let what = format!("has a triangle whose corner {corner} does not exist");
                return Err(shape_error(shape, &what)
                    .hint(format!("its corners are 0 to {}", count.saturating_sub(1))));
            }
            match self.orient(&flat, corners.map(|c| c + flat.first_position), shape.to_world.mirrors()) {
                Some(triangle) => {
                    self.triangles.push(triangle);
                    self.triangle_shapes.push(index);
                    kept += 1;
                }
                None => degenerate.push(number),
            }
        }
        flat.primitive_count = kept;
        if kept == 0 {
            return Err(shape_error(shape, "has no triangle with an area")
                .hint("check that the mesh file is not empty and the transform does not flatten it"));
        }
        if !degenerate.is_empty() {
            warnings.push(
                Diagnostic::warning(format!(
                    "{}: left out {} triangles without an area",
                    shape.name,
                    degenerate.len()
                ))
                .at(shape.origin.clone()),
            );
        }
        self.add_attributes(std::mem::take(&mut mesh.attributes), &degenerate);
        self.shapes.push(flat);
        Ok(())
    }

    fn add_vertices(&mut self, flat: &mut FlatShape, mesh: &Mesh, shape: &Shape) -> Result<(), Diagnostic> {
        for (i, p) in mesh.positions.iter().enumerate() {
            let world = shape.to_world.point(*p);
            if !is_reachable(world) {
                let what = format!("has a vertex (number {}) that is {}", i + 1, unreachable(world));
                return Err(shape_error(shape, &what));
            }
            self.positions.push(world);
        }
        if !mesh.normals.is_empty() {
            flat.first_normal = self.normals.len() as u32;
            self.normals.extend(mesh.normals.iter().map(|n| world_normal(&shape.to_world, *n)));
        }
        if !mesh.uvs.is_empty() {
            flat.first_uv = self.uvs.len() as u32;
            self.uvs.extend(mesh.uvs.iter().map(|uv| if is_finite(*uv) { *uv } else { Vec2::default() }));
        }
        Ok(())
    }

    /// Orders a triangle's corners so that its geometric normal points out: by the winding, which a
    /// mirroring transform reverses, unless all three shading normals are on the other side. `None` if the
    /// triangle has no area.
    fn orient(&self, flat: &FlatShape, [a, b, c]: [u32; 3], mirrored: bool) -> Option<[u32; 3]> {
        let normal = exact_normal([a, b, c].map(|i| self.positions[i as usize]))?;
        let mut outward = if mirrored { -normal } else { normal };
        if flat.first_normal != NONE {
            let side = |i: u32| self.shading_normal(flat, i).dot(outward);
            if side(a) < 0.0 && side(b) < 0.0 && side(c) < 0.0 {
                outward = -outward;
            }
        }
        Some(if outward.dot(normal) > 0.0 { [a, b, c] } else { [a, c, b] })
    }

    pub(super) fn shading_normal(&self, flat: &FlatShape, vertex: u32) -> Vec3 {
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
        if !is_reachable(data.center) {
            let what = format!("is a sphere whose centre is {}", unreachable(data.center));
            return Err(shape_error(shape, &what));
        }
        if !(data.radius >= LEAST_RADIUS && data.radius < FARTHEST) {
            let what = format!(
                "is a sphere whose radius, {}, is not a positive number that can be rendered",
                data.radius
            );
            return Err(shape_error(shape, &what)
                .hint(format!("radii lie between {LEAST_RADIUS:e} and {FARTHEST:e}")));
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
}

/// A shading normal in the world. One that says nothing, because it is zero or not finite, is zero there: the
/// other corners' are used in its place, or the geometric one.
fn world_normal(to_world: &Transform, normal: Vec3) -> Vec3 {
    // Of length one first where the length leaves the range of numbers.
    let of_unit = || to_world.normal(normal.try_normalized()?).try_normalized();
    to_world.normal(normal).try_normalized().or_else(of_unit).unwrap_or(Vec3::ZERO)
}

/// Warns of normals and texture coordinates that nothing can be made of.
fn warn_of_useless(normals: &[Vec3], mesh: &Mesh, shape: &Shape, warnings: &mut Vec<Diagnostic>) {
    let mut warn = |count: usize, what: &str, hint: &str| {
        if count > 0 {
            let message = format!("{}: {count} {what}", shape.name);
            warnings.push(Diagnostic::warning(message).at(shape.origin.clone()).hint(hint));
        }
    };
    let zero = normals.iter().filter(|n| **n == Vec3::ZERO).count();
    warn(zero, "normals are zero or not finite", "the geometric normals count there");
    let wild = mesh.uvs.iter().filter(|uv| !is_finite(**uv)).count();
    warn(wild, "texture coordinates are not finite", "they count as (0, 0)");
}

fn is_finite(uv: Vec2) -> bool {
    uv.x.is_finite() && uv.y.is_finite()
}

/// Whether a place is finite, and near enough for squares of distances to be so.
pub(crate) fn is_reachable(place: Vec3) -> bool {
    place.is_finite() && place.abs().max_element() <= FARTHEST
}

/// Why a place is not reachable.
pub(crate) fn unreachable(place: Vec3) -> String {
    if place.is_finite() { format!("farther than {FARTHEST:e} from the origin") } else { "not finite".into() }
}

/// "`mesh.obj` has …", at the shape's place.
fn shape_error(shape: &Shape, what: &str) -> Diagnostic {
    Diagnostic::error(format!("{} {what}", shape.name)).at(shape.origin.clone())
}
