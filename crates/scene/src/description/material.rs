use std::sync::Arc;

use caustica_math::Rgb;
use serde::{Deserialize, Serialize};

use super::{AttributeId, Distribution, Principled, PrincipledThin, Roughness, Scalar, Wrapper};
use crate::Origin;

/// The index of an image in [`super::Description::images`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ImageId(pub u32);

/// The index of a material in [`super::Description::materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MaterialId(pub u32);

/// A linear RGB image in rows from the top.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Image {
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
    /// `width`·`height` pixels, linear.
    pub pixels: Arc<[Rgb]>,
}

/// A colour that may vary over a surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Texture {
    /// The same everywhere.
    Constant(Rgb),
    /// Two colours by the parity of floor(u/scale.x + v·shear.x − delta.x) + floor(v/scale.y + u·shear.y − delta.y);
    /// even is `value1`.
    Checkerboard {
        /// Offset.
        delta: [f32; 2],
        /// Size of a field, not 0.
        scale: [f32; 2],
        /// What the other coordinate adds.
        shear: [f32; 2],
        /// Colour of the even fields.
        value1: Rgb,
        /// Colour of the odd fields.
        value2: Rgb,
    },
    /// An image, with v = 0 at its lower edge.
    Image {
        /// The image.
        image: ImageId,
        /// How uv coordinates are placed on it.
        transform: TextureTransform,
    },
    /// An attribute of the mesh, which must have it.
    Attribute {
        /// Its name.
        attribute: AttributeId,
        /// Factor on its values.
        scale: f32,
    },
}

impl From<Rgb> for Texture {
    fn from(c: Rgb) -> Self {
        Self::Constant(c)
    }
}

/// How an image lies on a surface: at (u·scale.x + v·shear.x + offset.x, v·scale.y + u·shear.y + offset.y).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TextureTransform {
    /// Factor on u and v.
    pub scale: [f32; 2],
    /// What the other coordinate adds.
    pub shear: [f32; 2],
    /// Added to both.
    pub offset: [f32; 2],
    /// What lies beyond its edges.
    pub wrap: Wrap,
    /// What lies between its pixels.
    pub filter: PixelLookup,
}

impl Default for TextureTransform {
    fn default() -> Self {
        let (wrap, filter) = (Wrap::default(), PixelLookup::default());
        Self { scale: [1.0; 2], shear: [0.0; 2], offset: [0.0; 2], wrap, filter }
    }
}

/// What lies beyond the edges of an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Wrap {
    /// The image again.
    #[default]
    Repeat,
    /// Its mirror image, and then the image again.
    Mirror,
    /// What is at the edge.
    Clamp,
}

/// What lies between the pixels of an image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum PixelLookup {
    /// A mean of four.
    #[default]
    Bilinear,
    /// The nearest.
    Nearest,
}

/// A material.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// What it is.
    pub kind: MaterialKind,
    /// Where it stands in the file.
    pub origin: Option<Origin>,
}

/// How a surface scatters light. Indices of refraction and their ratio lie between 10⁻⁶ and 10⁶, roughnesses and metals'
/// indices between 0 and 10⁶; reflectances above one get a warning. Roughnesses below 10⁻⁴ count as that. The side of the normal is "outside" (`exterior_ior`), the other
/// "inside".
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum MaterialKind {
    /// Lambertian, on the side of the normal; black on the other.
    Diffuse {
        /// Reflectance.
        albedo: Texture,
    },
    /// A perfect mirror on the side of the normal; black on the other.
    Mirror {
        /// Reflectance.
        reflectance: Rgb,
    },
    /// A smooth interface between two transparent media.
    Dielectric {
        /// Index of refraction inside.
        interior_ior: f32,
        /// Index of refraction outside.
        exterior_ior: f32,
        /// Factor on Fresnel's reflectance.
        reflectance: Texture,
        /// Factor on Fresnel's transmittance.
        transmittance: Texture,
    },
    /// A rough interface between two transparent media.
    RoughDielectric {
        /// Of the microfacets.
        roughness: Roughness,
        /// Index of refraction inside.
        interior_ior: f32,
        /// Index of refraction outside.
        exterior_ior: f32,
        /// Factor on Fresnel's reflectance.
        reflectance: Texture,
        /// Factor on Fresnel's transmittance.
        transmittance: Texture,
    },
    /// A smooth metal on the side of the normal.
    Conductor {
        /// Real part of the index, relative to the outside.
        eta: Rgb,
        /// Imaginary part of the index (extinction), relative to the outside.
        k: Rgb,
        /// Factor on the reflectance.
        reflectance: Texture,
    },
    /// A rough metal on the side of the normal.
    RoughConductor {
        /// Of the microfacets.
        roughness: Roughness,
        /// Real part of the index, relative to the outside.
        eta: Rgb,
        /// Imaginary part of the index (extinction), relative to the outside.
        k: Rgb,
        /// Factor on the reflectance.
        reflectance: Texture,
    },
    /// Nori's `microfacet`: a diffuse base and a Beckmann specular lobe of weight 1 − max(kd).
    Microfacet {
        /// Roughness α of Beckmann.
        alpha: f32,
        /// Index of refraction inside.
        interior_ior: f32,
        /// Index of refraction outside.
        exterior_ior: f32,
        /// Diffuse reflectance.
        kd: Texture,
    },
    /// A diffuse base under a smooth dielectric coat, on the side of the normal.
    Plastic {
        /// Index of refraction inside.
        interior_ior: f32,
        /// Index of refraction outside.
        exterior_ior: f32,
        /// Reflectance of the base.
        diffuse: Texture,
        /// Factor on what the coat reflects.
        reflectance: Texture,
        /// Whether light that the coat sends back to the base is coloured again.
        nonlinear: bool,
    },
    /// A diffuse base under a rough dielectric coat, on the side of the normal.
    RoughPlastic {
        /// Of the coat's microfacets.
        distribution: Distribution,
        /// Roughness of the coat.
        alpha: f32,
        /// Index of refraction inside.
        interior_ior: f32,
        /// Index of refraction outside.
        exterior_ior: f32,
        /// Reflectance of the base.
        diffuse: Texture,
        /// Factor on what the coat reflects.
        reflectance: Texture,
        /// Whether light that the coat sends back to the base is coloured again.
        nonlinear: bool,
    },
    /// Disney's principled material.
    Principled(Principled),
    /// Disney's principled material of something thin.
    PrincipledThin(PrincipledThin),
    /// A thin sheet of glass, through which light passes straight.
    ThinDielectric {
        /// Index of refraction of the sheet.
        interior_ior: f32,
        /// Index of refraction around it.
        exterior_ior: f32,
        /// Factor on what it reflects.
        reflectance: Texture,
        /// Factor on what it lets through.
        transmittance: Texture,
    },
    /// No surface at all: light passes straight through. It counts as a bounce, and casts a shadow where lamps are
    /// looked for.
    Null,
    /// Made of other materials.
    Wrapped(Wrapper),
}

/// What neither dims nor tints.
const WHITE: Texture = Texture::Constant(Rgb::WHITE);

impl MaterialKind {
    /// A smooth interface between two transparent media.
    pub fn dielectric(interior_ior: f32, exterior_ior: f32) -> Self {
        Self::Dielectric { interior_ior, exterior_ior, reflectance: WHITE, transmittance: WHITE }
    }

    /// A rough interface between two transparent media.
    pub fn rough_dielectric(roughness: Roughness, interior_ior: f32, exterior_ior: f32) -> Self {
        Self::RoughDielectric {
            roughness,
            interior_ior,
            exterior_ior,
            reflectance: WHITE,
            transmittance: WHITE,
        }
    }

    /// A smooth metal.
    pub fn conductor(eta: Rgb, k: Rgb) -> Self {
        Self::Conductor { eta, k, reflectance: WHITE }
    }

    /// A rough metal.
    pub fn rough_conductor(roughness: Roughness, eta: Rgb, k: Rgb) -> Self {
        Self::RoughConductor { roughness, eta, k, reflectance: WHITE }
    }

    /// Whether light passes into a medium behind the surface, which it leaves by another one.
    pub fn refracts(&self) -> bool {
        match self {
            Self::Dielectric { .. } | Self::RoughDielectric { .. } => true,
            Self::Principled(p) => p.spec_trans != Scalar::Constant(0.0),
            _ => false,
        }
    }

    /// Whether it scatters differently when the surface is turned about its normal.
    pub fn is_oriented(&self) -> bool {
        let turned = |anisotropic: &Scalar| *anisotropic != Scalar::Constant(0.0);
        match self {
            Self::RoughDielectric { roughness, .. } | Self::RoughConductor { roughness, .. } => {
                roughness.alpha[0] != roughness.alpha[1]
            }
            Self::Principled(p) => turned(&p.anisotropic),
            Self::PrincipledThin(p) => turned(&p.anisotropic),
            _ => false,
        }
    }

    /// All textures that the material itself looks up.
    pub fn textures(&self) -> Vec<&Texture> {
        let mut all = Vec::new();
        let mut scalars: Vec<&Scalar> = Vec::new();
        match self {
            Self::Diffuse { albedo: t } | Self::Microfacet { kd: t, .. } => all.push(t),
            Self::Mirror { .. } | Self::Null => {}
            Self::Wrapped(wrapper) => all.extend(wrapper.texture()),
            Self::Conductor { reflectance, .. } => all.push(reflectance),
            Self::Dielectric { reflectance, transmittance, .. }
            | Self::ThinDielectric { reflectance, transmittance, .. } => {
                all.extend([reflectance, transmittance]);
            }
            Self::RoughDielectric { roughness, reflectance, transmittance, .. } => {
                all.extend([reflectance, transmittance]);
                scalars.extend(&roughness.alpha);
            }
            Self::RoughConductor { roughness, reflectance, .. } => {
                all.push(reflectance);
                scalars.extend(&roughness.alpha);
            }
            Self::Plastic { diffuse, reflectance, .. } | Self::RoughPlastic { diffuse, reflectance, .. } => {
                all.extend([diffuse, reflectance]);
            }
            Self::Principled(p) => {
                all.push(&p.base_color);
                scalars.extend(p.scalars());
            }
            Self::PrincipledThin(p) => {
                all.push(&p.base_color);
                scalars.extend(p.scalars());
            }
        }
        all.extend(scalars.into_iter().filter_map(|s| match s {
            Scalar::Constant(_) => None,
            Scalar::Texture(t) => Some(t),
        }));
        all
    }
}
