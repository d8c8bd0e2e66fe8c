//! Materials of many lobes and materials made of others, for the scenes of tests.

use caustica_math::Rgb;
use caustica_scene::Description;
use caustica_scene::description::{
    Attribute, BumpRule, Distribution, Domain, Geometry, Image, MaterialId, MaterialKind, Principled,
    PrincipledThin, Roughness, Scalar, Shadowing, Texture, TextureTransform, Wrapper,
};

use crate::build::{diffuse, glass};

/// A checkerboard of two greys, so many fields wide.
pub fn checks(fields: f32, greys: [f32; 2]) -> Texture {
    let [value1, value2] = greys.map(Rgb::splat);
    Texture::Checkerboard { delta: [0.2; 2], scale: [1.0 / fields; 2], shear: [0.0; 2], value1, value2 }
}

/// A texture by colours of a mesh, given the number of each corner or triangle. (Spheres get none.)
pub fn attribute(d: &mut Description, shape: usize, domain: Domain, color: impl Fn(usize) -> Rgb) -> Texture {
    let name = format!("{domain:?}");
    if let Geometry::Mesh(mesh) = &mut d.shapes[shape].geometry {
        let count = if domain == Domain::Vertex { mesh.positions.len() } else { mesh.triangles.len() };
        let values = (0..count).map(color).collect();
        mesh.attributes.push(Attribute { name: name.clone(), domain, values });
    }
    Texture::Attribute { attribute: d.add_attribute(&name), scale: 1.0 }
}

/// Colours that jump from each number to the next.
pub fn motley(i: usize) -> Rgb {
    let channel = |k: usize| 0.1 + 0.8 * (i * k % 11) as f32 / 10.0;
    Rgb::new(channel(3), channel(5), channel(7))
}

fn wrapped(d: &mut Description, wrapper: Wrapper) -> MaterialId {
    d.add_material(MaterialKind::Wrapped(wrapper))
}

/// A material with holes.
pub fn mask(d: &mut Description, opacity: Texture, inner: MaterialId) -> MaterialId {
    wrapped(d, Wrapper::Mask { opacity, inner })
}

/// Two materials, the second with that share.
pub fn blend(d: &mut Description, weight: impl Into<Texture>, inner: [MaterialId; 2]) -> MaterialId {
    wrapped(d, Wrapper::Blend { weight: weight.into(), inner })
}

/// A material for either side.
pub fn two_sided(d: &mut Description, front: MaterialId, back: MaterialId) -> MaterialId {
    wrapped(d, Wrapper::TwoSided { front, back })
}

/// Waves of that height on a material.
pub fn bump(d: &mut Description, scale: f32, rule: BumpRule, inner: MaterialId) -> MaterialId {
    let pixels = (0..64).map(|i| Rgb::splat((i * i * 7 % 13) as f32 / 13.0)).collect();
    let image = d.add_image(Image { width: 8, height: 8, pixels });
    let height = Texture::Image { image, transform: TextureTransform::default() };
    wrapped(d, Wrapper::Bump { height, scale, rule, inner })
}

/// Normals that lean by that much to all sides.
pub fn normal_map(d: &mut Description, lean: f32, rule: BumpRule, inner: MaterialId) -> MaterialId {
    let side = |i: u32, k: u32| 0.5 + 0.5 * lean * ((i * k % 11) as f32 / 5.0 - 1.0);
    let pixels = (0..64).map(|i| Rgb::new(side(i, 3), side(i, 7), 0.9)).collect();
    let image = d.add_image(Image { width: 8, height: 8, pixels });
    let normals = Texture::Image { image, transform: TextureTransform::default() };
    wrapped(d, Wrapper::NormalMap { normals, rule, inner })
}

/// Plastic of a smooth coat: a Dirac lobe beside a smooth one.
pub fn smooth_plastic(nonlinear: bool) -> MaterialKind {
    let (interior_ior, exterior_ior) = (1.7, 1.0);
    let (diffuse, reflectance) = (Rgb::new(0.7, 0.5, 0.3).into(), Rgb::new(0.8, 0.9, 1.0).into());
    MaterialKind::Plastic { interior_ior, exterior_ior, diffuse, reflectance, nonlinear }
}

/// Plastic of a rough coat.
pub fn rough_plastic() -> MaterialKind {
    MaterialKind::RoughPlastic {
        distribution: Distribution::Beckmann,
        alpha: 0.2,
        interior_ior: 1.5,
        exterior_ior: 1.0,
        diffuse: Rgb::new(0.7, 0.5, 0.3).into(),
        reflectance: Rgb::new(0.8, 0.9, 1.0).into(),
        nonlinear: true,
    }
}

/// Beckmann's microfacets, with different roughnesses in the two directions.
pub fn brushed(alpha: [f32; 2]) -> Roughness {
    let alpha = alpha.map(Scalar::Constant);
    Roughness { distribution: Distribution::Beckmann, shadowing: Shadowing::Separable, alpha }
}

/// A principled material of all lobes.
pub fn principled() -> MaterialKind {
    MaterialKind::Principled(Principled {
        base_color: Rgb::new(0.7, 0.5, 0.3).into(),
        roughness: 0.5.into(),
        anisotropic: 0.6.into(),
        metallic: 0.3.into(),
        spec_trans: 0.5.into(),
        eta: 1.4,
        spec_tint: 0.3.into(),
        sheen: 0.5.into(),
        sheen_tint: 0.5.into(),
        flatness: 0.4.into(),
        clearcoat: 0.5.into(),
        clearcoat_gloss: 0.0.into(),
    })
}

/// A principled material of something thin, of all lobes.
pub fn principled_thin() -> MaterialKind {
    MaterialKind::PrincipledThin(PrincipledThin {
        base_color: Rgb::new(0.7, 0.5, 0.3).into(),
        anisotropic: 0.4.into(),
        spec_trans: 0.4.into(),
        spec_tint: 0.3.into(),
        sheen: 0.5.into(),
        flatness: 0.4.into(),
        diff_trans: 0.9.into(),
        ..PrincipledThin::default()
    })
}

/// Thin glass.
pub fn thin_glass() -> MaterialKind {
    let (reflectance, transmittance) = (Rgb::WHITE.into(), Rgb::WHITE.into());
    MaterialKind::ThinDielectric { interior_ior: 1.5, exterior_ior: 1.0, reflectance, transmittance }
}

/// Leaves, green on both sides, between gaps.
pub fn leaves(d: &mut Description) -> MaterialId {
    let green = d.add_material(MaterialKind::Diffuse { albedo: Rgb::new(0.2, 0.6, 0.1).into() });
    let dark = diffuse(d, 0.3);
    let both = two_sided(d, green, dark);
    mask(d, checks(4.0, [0.2, 0.9]), both)
}

/// Here clear glass and there a diffuse surface.
pub fn frosted(d: &mut Description) -> MaterialId {
    let (clear, white) = (glass(d), diffuse(d, 0.8));
    blend(d, checks(3.0, [0.3, 0.7]), [clear, white])
}
