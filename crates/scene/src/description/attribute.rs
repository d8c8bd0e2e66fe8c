use caustica_math::Rgb;
use serde::{Deserialize, Serialize};

/// The index of a name in [`super::Description::attributes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct AttributeId(pub u32);

/// Colours of a mesh, which textures look up by their name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Attribute {
    /// The name; no two attributes of a mesh share one.
    pub name: String,
    /// What has a value each.
    pub domain: Domain,
    /// The values; numbers are greys. Those that a texture looks up must be finite, and none negative.
    pub values: Vec<Rgb>,
}

/// What parts of a mesh have values of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Domain {
    /// Corners; between them values are interpolated.
    Vertex,
    /// Triangles.
    Face,
}
