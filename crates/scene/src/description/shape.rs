use caustica_math::{Transform, Vec2, Vec3};
use serde::{Deserialize, Serialize};

use super::{MaterialId, Texture};
use crate::Origin;

/// A surface with its material and, if it is a lamp, its emission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shape {
    /// A name for messages.
    pub name: String,
    /// The surface.
    pub geometry: Geometry,
    /// Shape frame to world. A mirroring transform keeps outside outside.
    pub to_world: Transform,
    /// How it scatters.
    pub material: MaterialId,
    /// Radiance emitted from the side of the normal, if it is a lamp.
    pub emission: Option<Texture>,
    /// Where it stands in the file.
    pub origin: Option<Origin>,
}

/// A surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Geometry {
    /// Triangles.
    Mesh(Mesh),
    /// A sphere with its normal outward. uv = (½ + atan2(y, x)/2π, ½ + asin(z)/π) of the unit normal in
    /// the shape's frame.
    Sphere {
        /// Centre.
        center: Vec3,
        /// Radius, more than 0.
        radius: f32,
    },
}

/// A triangle mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    /// Corners.
    pub positions: Vec<Vec3>,
    /// Shading normals, one a corner, of any length but zero; or none at all.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, one a corner; or none at all.
    pub uvs: Vec<Vec2>,
    /// Three corners each. The geometric normal is (b − a) × (c − a), turned where all three shading
    /// normals are on its other side.
    pub triangles: Vec<[u32; 3]>,
}
