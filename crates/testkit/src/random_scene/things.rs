//! Shapes and what they are made of.

use caustica_math::{Rgb, Transform, Vec2, Vec3};
use caustica_scene::Description;
use caustica_scene::description::{
    Attribute, BumpRule, Distribution, Domain, Geometry, ImageId, Light, LightKind, MaterialId, MaterialKind,
    Mesh, Principled, PrincipledThin, Roughness, Scalar, Shadowing, Texture, TextureTransform, Wrapper,
};

use super::choices::Choices;
use crate::build::{add, ellipsoid, group, instance, quad, sphere};
use crate::materials::thin_glass;

/// Adds a shape, with its material and, now and then, light.
pub fn shape(d: &mut Description, scale: f32, choices: &mut Choices) {
    let material = material(d, choices);
    let far = if choices.is_wild() { *choices.pick(&[1.0, 1.0, 1e3, 1e6]) } else { 1.0 };
    let center = choices.vector().map(|c| 1.5 * c * scale * far);
    let size = scale * (0.05 + choices.unit());
    let index = match choices.below(7) {
        0 => sphere(d, center, size, material),
        1 => {
            let (u, v) = (choices.direction(), choices.vector());
            quad(d, center, u.map(|c| c * size), v.map(|c| c * size), material)
        }
        2 => add(d, "body", Geometry::Mesh(body(choices)), material),
        3 => room(d, 3.0 * scale, material),
        4 => add(d, "soup", Geometry::Mesh(soup(choices)), material),
        5 => twin(d, material),
        _ => sphere(d, [0.0; 3], 5.0 * scale, material),
    };
    if matches!(d.shapes[index].geometry, Geometry::Mesh(_))
        && matches!(d.shapes[index].name.as_str(), "body" | "soup")
    {
        d.shapes[index].to_world = placed(center, size, choices);
    }
    if choices.once_in(2) {
        d.shapes[index].emission = Some(texture(true, choices));
    }
    if choices.once_in(3) {
        colours(d, index, choices);
    }
}

/// Gives a mesh colours of its own, which its material and, now and then, its emission look up.
fn colours(d: &mut Description, index: usize, choices: &mut Choices) {
    let Geometry::Mesh(mesh) = &mut d.shapes[index].geometry else { return };
    let (domain, count) = match choices.once_in(2) {
        true => (Domain::Face, mesh.triangles.len()),
        false => (Domain::Vertex, mesh.positions.len()),
    };
    let palette: Vec<Rgb> = (0..4).map(|_| choices.albedo()).collect();
    let values = palette.iter().copied().cycle().take(count).collect();
    let name = "vertex_color".to_owned();
    mesh.attributes = vec![Attribute { name: name.clone(), domain, values }];
    let attribute = d.add_attribute(&name);
    let colour = Texture::Attribute { attribute, scale: choices.unit() };
    d.shapes[index].material = d.add_material(MaterialKind::Diffuse { albedo: colour });
    if d.shapes[index].emission.is_some() && choices.once_in(2) {
        let scale = choices.light().max_channel();
        d.shapes[index].emission = Some(Texture::Attribute { attribute, scale });
    }
}

/// A lamp that emits along the normals of one of the shapes that are none yet.
pub fn collimated(d: &Description, choices: &mut Choices) -> Option<LightKind> {
    let taken = |i: usize| {
        let thrown = |l: &Light| matches!(l.kind, LightKind::Collimated { shape, .. } if shape as usize == i);
        d.shapes[i].emission.is_some() || d.lights.iter().any(thrown)
    };
    let free: Vec<usize> = (0..d.shapes.len()).filter(|i| !taken(*i)).collect();
    let shape = *free.get(choices.below(free.len()))? as u32;
    Some(LightKind::Collimated { shape, exitance: texture(true, choices) })
}

/// Shows the last shape that is no lamp as one to three instances.
pub fn instances(d: &mut Description, scale: f32, choices: &mut Choices) {
    let Some(last) = d.shapes.iter().rposition(|s| s.emission.is_none()) else { return };
    let shape = d.shapes.remove(last);
    d.shapes.push(shape);
    let group = group(d, d.shapes.len() - 1);
    for _ in 0..=choices.below(3) {
        let factors = [(); 3].map(|()| {
            let size = f64::from(0.5 + choices.unit());
            if choices.once_in(4) { -size } else { size }
        });
        let turned = Transform::rotate(f64::from(choices.signed()) * 180.0, [0.3, 1.0, 0.2]);
        let to = choices.vector().map(|c| f64::from(c * scale));
        instance(d, group, Transform::scale(factors).then(turned).then(Transform::translate(to)));
    }
}

/// A transform that may turn, stretch and mirror.
fn placed(center: [f32; 3], size: f32, choices: &mut Choices) -> Transform {
    let factor = |choices: &mut Choices| {
        let wide = if choices.is_wild() { *choices.pick(&[2.0, 1e-6, 1e-3, 1e3, 1e6]) } else { 2.0 };
        let stretch = if choices.unit() > 0.5 { 1.0 } else { wide };
        f64::from(size) * if choices.once_in(4) { -stretch } else { stretch }
    };
    let factors = [factor(choices), factor(choices), factor(choices)];
    let turned = Transform::rotate(f64::from(choices.signed()) * 180.0, [0.3, 1.0, 0.2]);
    Transform::scale(factors).then(turned).then(Transform::translate(center.map(f64::from)))
}

/// A closed mesh with smooth normals, or without.
fn body(choices: &mut Choices) -> Mesh {
    let mut mesh = ellipsoid(2 + choices.below(4) as u32, [1.0, 0.3 + choices.unit(), 0.7]);
    if choices.once_in(2) {
        mesh.normals.clear();
    }
    if choices.once_in(4) {
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    mesh
}

/// Triangles that cross, touch and lie on each other, some of them without area.
fn soup(choices: &mut Choices) -> Mesh {
    let corners = 3 + choices.below(8);
    let mut mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], ..Mesh::default() };
    while mesh.positions.len() < corners {
        let p = if choices.once_in(4) { [1.0, 0.0, 0.0] } else { choices.vector() };
        mesh.positions.push(p.into());
    }
    mesh.triangles.push([0, 1, 2]);
    for _ in 0..choices.below(8) {
        mesh.triangles.push([0; 3].map(|_| choices.below(corners) as u32));
    }
    if choices.once_in(3) {
        // Of any length but zero, and on either side.
        mesh.normals = (0..corners).map(|_| choices.direction().into()).collect();
    }
    if choices.once_in(2) {
        mesh.uvs = (0..corners).map(|_| Vec2::new(9.0 * choices.signed(), choices.signed())).collect();
    }
    mesh
}

/// A box around everything, its normals inward.
fn room(d: &mut Description, half: f32, material: MaterialId) -> usize {
    let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * (2.0 * half);
    let positions = (0..8).map(|i| corner(i) - Vec3::splat(half)).collect();
    let faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let triangles = faces.iter().flat_map(|[a, b, c, e]| [[*a, *b, *c], [*a, *c, *e]]).collect();
    add(d, "room", Geometry::Mesh(Mesh { positions, triangles, ..Mesh::default() }), material)
}

/// The last shape again, in the same place.
fn twin(d: &mut Description, material: MaterialId) -> usize {
    let Some(mut shape) = d.shapes.last().cloned() else { return room(d, 1.0, material) };
    shape.material = material;
    d.shapes.push(shape);
    d.shapes.len() - 1
}

/// Of that α along the tangent.
fn roughness(choices: &mut Choices, alpha: f32) -> Roughness {
    Roughness {
        distribution: *choices.pick(&[Distribution::Ggx, Distribution::Beckmann]),
        shadowing: *choices.pick(&[Shadowing::Correlated, Shadowing::Separable]),
        alpha: [alpha.into(), (alpha * choices.pick(&[1.0, 0.3, 2.0])).into()],
    }
}

fn material(d: &mut Description, choices: &mut Choices) -> MaterialId {
    let (interior_ior, exterior_ior) = if choices.is_wild() && choices.once_in(2) {
        let iors = [1.0, 1.5, 1.000_001, 1e-3, 1e3, 1.33];
        (*choices.pick(&iors), *choices.pick(&iors))
    } else {
        (1.0 + choices.unit(), 1.0)
    };
    let alpha =
        if choices.is_wild() { *choices.pick(&[0.1, 1e-4, 1e-6, 1.0, 10.0]) } else { 0.01 + choices.unit() };
    let metal = |choices: &mut Choices| (choices.albedo() * 3.0 + Rgb::splat(0.05), choices.albedo() * 5.0);
    let kind = match choices.below(11) {
        0 => MaterialKind::Diffuse { albedo: texture(false, choices) },
        1 => MaterialKind::Mirror { reflectance: choices.albedo() },
        2 => MaterialKind::dielectric(interior_ior, exterior_ior),
        3 => MaterialKind::rough_dielectric(roughness(choices, alpha), interior_ior, exterior_ior),
        4 => {
            let (eta, k) = metal(choices);
            MaterialKind::Conductor { eta, k, reflectance: choices.albedo().into() }
        }
        5 => {
            let (eta, k) = metal(choices);
            let roughness = roughness(choices, alpha);
            MaterialKind::RoughConductor { roughness, eta, k, reflectance: texture(false, choices) }
        }
        6 => MaterialKind::Microfacet { alpha, interior_ior, exterior_ior, kd: texture(false, choices) },
        7 => MaterialKind::Plastic {
            interior_ior,
            exterior_ior,
            diffuse: texture(false, choices),
            reflectance: texture(false, choices),
            nonlinear: choices.once_in(2),
        },
        8 => MaterialKind::RoughPlastic {
            distribution: *choices.pick(&[Distribution::Ggx, Distribution::Beckmann]),
            alpha,
            interior_ior,
            exterior_ior,
            diffuse: texture(false, choices),
            reflectance: texture(false, choices),
            nonlinear: choices.once_in(2),
        },
        9 => principled(choices, interior_ior),
        _ => principled_thin(choices, interior_ior),
    };
    let inner = d.add_material(kind);
    if choices.below(3) < 2 { inner } else { wrapped(d, inner, choices) }
}

/// A material made of that one and others.
fn wrapped(d: &mut Description, inner: MaterialId, choices: &mut Choices) -> MaterialId {
    let rule = BumpRule { flips: choices.once_in(2), shadows: choices.once_in(2) };
    let other = d.add_material(match choices.below(4) {
        0 => MaterialKind::Null,
        1 => thin_glass(),
        _ => MaterialKind::Diffuse { albedo: texture(false, choices) },
    });
    let wrapper = match choices.below(6) {
        0 => Wrapper::Mask { opacity: texture(false, choices), inner },
        1 | 2 => Wrapper::Blend { weight: texture(false, choices), inner: [inner, other] },
        3 => Wrapper::NormalMap { normals: texture(false, choices), rule, inner },
        4 => Wrapper::Bump { height: texture(false, choices), scale: choices.signed(), rule, inner },
        _ => {
            // What light passes through has no two sides.
            let dark = d.add_material(MaterialKind::Diffuse { albedo: texture(false, choices) });
            let light = d.add_material(MaterialKind::Mirror { reflectance: choices.albedo() });
            Wrapper::TwoSided { front: dark, back: light }
        }
    };
    d.add_material(MaterialKind::Wrapped(wrapper))
}

/// A share, often none.
fn share(choices: &mut Choices) -> Scalar {
    if choices.once_in(2) { 0.0.into() } else { choices.unit().into() }
}

fn principled(choices: &mut Choices, eta: f32) -> MaterialKind {
    MaterialKind::Principled(Principled {
        base_color: texture(false, choices),
        roughness: share(choices),
        anisotropic: share(choices),
        metallic: share(choices),
        spec_trans: share(choices),
        eta,
        spec_tint: share(choices),
        sheen: share(choices),
        sheen_tint: share(choices),
        flatness: share(choices),
        clearcoat: share(choices),
        clearcoat_gloss: share(choices),
    })
}

fn principled_thin(choices: &mut Choices, eta: f32) -> MaterialKind {
    MaterialKind::PrincipledThin(PrincipledThin {
        base_color: texture(false, choices),
        roughness: share(choices),
        anisotropic: share(choices),
        spec_trans: share(choices),
        eta: eta.into(),
        spec_tint: share(choices),
        sheen: share(choices),
        sheen_tint: share(choices),
        flatness: share(choices),
        diff_trans: (2.0 * choices.unit()).into(),
    })
}

/// A texture of light or of reflectance.
pub fn texture(of_light: bool, choices: &mut Choices) -> Texture {
    let colour = |choices: &mut Choices| if of_light { choices.light() } else { choices.albedo() };
    match choices.below(4) {
        0 | 1 => colour(choices).into(),
        2 => Texture::Checkerboard {
            delta: [choices.signed(), choices.signed()],
            scale: [0.01 + choices.unit(), -0.01 - choices.unit()],
            shear: [0.0; 2],
            value1: colour(choices),
            value2: colour(choices),
        },
        _ => Texture::Image {
            image: ImageId(u32::from(!of_light)),
            transform: TextureTransform {
                scale: [3.0 * choices.signed(), 1.0],
                offset: [choices.signed(), 0.0],
                ..TextureTransform::default()
            },
        },
    }
}
