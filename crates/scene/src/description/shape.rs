use caustica_math::{Transform, Vec2, Vec3};
use serde::{Deserialize, Serialize};

use super::{Attribute, MaterialId, Texture};
use crate::Origin;

/// A surface with its material and, if it is a lamp, its emission. It may lie in glass, or around the camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shape {
    /// A name for messages.
    pub name: String,
    /// The surface.
    pub geometry: Geometry,
    /// Shape frame to world. A mirroring transform keeps outside outside; one that cannot be inverted is an error.
    pub to_world: Transform,
    /// How it scatters.
    pub material: MaterialId,
    /// Radiance emitted from the side of the normal, if it is a lamp; from its other side it is a surface. A lamp in
    /// the plane of another surface gets a warning, as which of the two is seen is left to rounding.
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
        /// Radius; in the world between 10⁻¹⁵ and 10¹⁵.
        radius: f32,
    },
}

/// A triangle mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    /// Corners; in the world within 10¹⁵ of the origin.
    pub positions: Vec<Vec3>,
    /// Shading normals, one a corner, of any length; or none at all. At corners where they are zero or not finite the
    /// others count, or the geometric normal if all are so, and there is a warning.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, one a corner; or none at all. Those that are not finite count as (0, 0), with a warning.
    pub uvs: Vec<Vec2>,
    /// Three corners each, which must exist. Those without an area are left out, with a warning; if none is left, that
    /// is an error. The geometric normal is (b − a) × (c − a), turned where all three shading
    /// normals are on its other side.
    pub triangles: Vec<[u32; 3]>,
    /// What textures may look up. Those that no texture looks up are dropped.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub attributes: Vec<Attribute>,
}
