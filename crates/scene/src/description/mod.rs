//! The description of a scene: plain owned data that readers produce and users edit.
//!
//! Units are SI: lengths in metres, radiance in W·m⁻²·sr⁻¹, intensity in W·sr⁻¹, irradiance in W·m⁻²;
//! angles are in degrees. Colours are linear BT.709 RGB.
//!
//! [`Scene::new`](crate::Scene::new) refuses numbers that cannot be rendered with, and says which: what is not finite,
//! colours that are negative, places beyond 10¹⁵ from the origin. A scene may be as small as 10⁻⁶ or as large as 10⁶
//! and more; nothing in it has an absolute size but the camera's clip planes. Where light or densities leave the range
//! of `f32` all the same, contributions are left out, and the film counts them as invalid.
//!
//! Of surfaces that coincide the one that comes first is seen where a ray meets both at the same distance, and
//! otherwise either, by rounding; rays that leave one start beyond the other.

mod attribute;
mod camera;
mod instance;
mod integrator;
mod layer;
mod light;
mod material;
mod principled;
mod roughness;
mod shape;
mod wrapper;

use serde::{Deserialize, Serialize};

pub use attribute::{Attribute, AttributeId, Domain};
pub use camera::{Camera, CameraKind, Crop, FilmSettings};
pub use caustica_math::Filter;
pub use instance::{Group, GroupId, Instance};
pub use integrator::{Integrator, Technique};
pub use layer::{Layer, LayerKind};
pub use light::{Daylight, EnvironmentRows, Light, LightKind};
pub use material::{
    Image, ImageId, Material, MaterialId, MaterialKind, PixelLookup, Texture, TextureTransform, Wrap,
};
pub use principled::{Principled, PrincipledThin};
pub use roughness::{Distribution, Roughness, Scalar, Shadowing};
pub use shape::{Geometry, Mesh, Shape};
pub use wrapper::{BumpRule, Wrapper};

/// A whole scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Description {
    /// The eye.
    pub camera: Camera,
    /// The picture's size, crop and pixel filter.
    pub film: FilmSettings,
    /// The algorithm that the scene asks for.
    pub integrator: Integrator,
    /// Samples per pixel that the scene asks for.
    pub samples: u32,
    /// Images, named by textures and environment maps.
    pub images: Vec<Image>,
    /// Names of attributes of meshes, each once, named by textures.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub attributes: Vec<String>,
    /// Materials, named by shapes.
    pub materials: Vec<Material>,
    /// Surfaces, with their materials and, for lamps, their emission.
    pub shapes: Vec<Shape>,
    /// Groups of surfaces, named by instances.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub groups: Vec<Group>,
    /// Where groups are seen.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub instances: Vec<Instance>,
    /// Lamps that are not surfaces.
    pub lights: Vec<Light>,
}

impl Description {
    /// Adds a material and returns its id.
    pub fn add_material(&mut self, kind: MaterialKind) -> MaterialId {
        self.materials.push(Material { kind, origin: None });
        MaterialId(self.materials.len() as u32 - 1)
    }

    /// All surfaces: those that stand for themselves, then those of the groups in turn. [`crate::surface::Surfaces`]
    /// numbers them so.
    pub fn all_shapes(&self) -> impl Iterator<Item = &Shape> {
        self.shapes.iter().chain(self.groups.iter().flat_map(|g| &g.shapes))
    }

    /// The id of an attribute's name, which is added if it is new.
    pub fn add_attribute(&mut self, name: &str) -> AttributeId {
        let known = self.attributes.iter().position(|n| n == name);
        AttributeId(known.unwrap_or_else(|| {
            self.attributes.push(name.to_owned());
            self.attributes.len() - 1
        }) as u32)
    }

    /// Adds an image and returns its id.
    pub fn add_image(&mut self, image: Image) -> ImageId {
        self.images.push(image);
        ImageId(self.images.len() as u32 - 1)
    }
}
