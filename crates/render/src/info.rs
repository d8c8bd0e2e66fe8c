//! What was loaded.

use caustica_scene::Scene;
use caustica_scene::description::{CameraKind, Description, Geometry, LightKind, MaterialKind, Wrapper};
use serde::Serialize;

use crate::names::integrator_name;

/// A scene in figures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneInfo {
    /// Width and height of the full picture.
    pub resolution: [u32; 2],
    /// The part of it that is rendered, if that is not all: x, y, width, height.
    pub crop: Option<[u32; 4]>,
    /// The kind of camera.
    pub camera: &'static str,
    /// The integrator that the scene asks for.
    pub integrator: &'static str,
    /// Samples per pixel that the scene asks for.
    pub samples: u32,
    /// Surfaces.
    pub shapes: usize,
    /// Triangles of all meshes, those of groups once.
    pub triangles: usize,
    /// Analytic spheres, those of groups once.
    pub spheres: usize,
    /// Groups of shapes.
    pub groups: usize,
    /// Instances of groups.
    pub instances: usize,
    /// Triangles that stand in the scene, those of groups in every instance.
    pub placed_triangles: u64,
    /// Materials by kind, with how many there are.
    pub materials: Vec<(&'static str, usize)>,
    /// Lamps by kind, with how many there are.
    pub lights: Vec<(&'static str, usize)>,
    /// The power of all lamps in W.
    pub power: f64,
    /// Lower and upper corner of all surfaces; absent if there are none.
    pub bounds: Option<[[f32; 3]; 2]>,
    /// Bytes of the tree, the surfaces and the images.
    pub memory: Memory,
}

/// Where memory goes, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Memory {
    /// The ray-intersection tree with its triangles.
    pub tree: usize,
    /// Vertices, normals, texture coordinates and indices.
    pub surfaces: usize,
    /// Images.
    pub images: usize,
    /// The film that a render would use.
    pub film: usize,
}

impl Memory {
    /// The sum.
    pub fn total(&self) -> usize {
        self.tree + self.surfaces + self.images + self.film
    }
}

/// The part of [`SceneInfo`] that flattening the description takes away.
#[derive(Clone, Debug)]
pub struct Outline {
    camera: &'static str,
    integrator: &'static str,
    samples: u32,
    shapes: usize,
    groups: usize,
    materials: Vec<(&'static str, usize)>,
    lights: Vec<(&'static str, usize)>,
}

/// Notes what a description holds.
pub fn outline(d: &Description) -> Outline {
    let area = d.shapes.iter().filter(|s| s.emission.is_some()).map(|s| match s.geometry {
        Geometry::Mesh(_) => "area (mesh)",
        Geometry::Sphere { .. } => "area (sphere)",
    });
    Outline {
        camera: camera_name(&d.camera.kind),
        integrator: integrator_name(&d.integrator),
        samples: d.samples,
        shapes: d.all_shapes().count(),
        groups: d.groups.len(),
        materials: count(d.materials.iter().map(|m| material_name(&m.kind))),
        lights: count(area.chain(d.lights.iter().map(|l| light_name(&l.kind)))),
    }
}

/// Describes a scene; `outline` is of the description that it was made from.
pub fn describe(scene: &Scene, outline: Outline) -> SceneInfo {
    let bounds = scene.bvh().bounds();
    let window = scene.film.window();
    let [triangles, spheres] = scene.surfaces().kept();
    let pixels: usize = scene.images().iter().map(|i| size_of_val(&*i.pixels)).sum();
    SceneInfo {
        resolution: [scene.film.width, scene.film.height],
        crop: scene.film.crop.map(|c| [c.x, c.y, c.width, c.height]),
        camera: outline.camera,
        integrator: outline.integrator,
        samples: outline.samples,
        shapes: outline.shapes,
        triangles,
        spheres,
        groups: outline.groups,
        instances: scene.surfaces().instances(),
        placed_triangles: scene.surfaces().placed()[0],
        materials: outline.materials,
        lights: outline.lights,
        power: scene.lamps().power(),
        bounds: (!bounds.is_empty()).then(|| [bounds.min.to_array(), bounds.max.to_array()]),
        memory: Memory {
            tree: scene.bvh().memory(),
            surfaces: scene.surfaces().memory(),
            images: pixels,
            film: window.width as usize * window.height as usize * 96,
        },
    }
}

/// Names with how often each occurs, in the order in which they first do.
fn count(names: impl Iterator<Item = &'static str>) -> Vec<(&'static str, usize)> {
    let mut counts: Vec<(&'static str, usize)> = Vec::new();
    for name in names {
        match counts.iter_mut().find(|c| c.0 == name) {
            Some(c) => c.1 += 1,
            None => counts.push((name, 1)),
        }
    }
    counts
}

fn camera_name(kind: &CameraKind) -> &'static str {
    match kind {
        CameraKind::Perspective { .. } => "perspective",
        CameraKind::ThinLens { .. } => "thinlens",
        CameraKind::Orthographic => "orthographic",
        CameraKind::Environment => "environment",
        CameraKind::RadianceMeter => "radiancemeter",
        CameraKind::IrradianceMeter { .. } => "irradiancemeter",
    }
}

/// The plugin name of a material.
pub(crate) fn material_name(kind: &MaterialKind) -> &'static str {
    match kind {
        MaterialKind::Diffuse { .. } => "diffuse",
        MaterialKind::Mirror { .. } => "mirror",
        MaterialKind::Dielectric { .. } => "dielectric",
        MaterialKind::RoughDielectric { .. } => "roughdielectric",
        MaterialKind::Conductor { .. } => "conductor",
        MaterialKind::RoughConductor { .. } => "roughconductor",
        MaterialKind::Microfacet { .. } => "microfacet",
        MaterialKind::Plastic { .. } => "plastic",
        MaterialKind::RoughPlastic { .. } => "roughplastic",
        MaterialKind::Principled(_) => "principled",
        MaterialKind::PrincipledThin(_) => "principledthin",
        MaterialKind::ThinDielectric { .. } => "thindielectric",
        MaterialKind::Null => "null",
        MaterialKind::Wrapped(Wrapper::Mask { .. }) => "mask",
        MaterialKind::Wrapped(Wrapper::Blend { .. }) => "blendbsdf",
        MaterialKind::Wrapped(Wrapper::TwoSided { .. }) => "twosided",
        MaterialKind::Wrapped(Wrapper::Bump { .. }) => "bumpmap",
        MaterialKind::Wrapped(Wrapper::NormalMap { .. }) => "normalmap",
    }
}

fn light_name(kind: &LightKind) -> &'static str {
    match kind {
        LightKind::Point { .. } => "point",
        LightKind::Spot { .. } | LightKind::LinearSpot { .. } => "spot",
        LightKind::Projector { .. } => "projector",
        LightKind::Collimated { .. } => "collimated surface",
        LightKind::Directional { .. } => "directional",
        LightKind::Constant { .. } => "constant environment",
        LightKind::Environment { .. } => "environment map",
        LightKind::Sky { .. } => "sky",
        LightKind::Sun { .. } => "sun",
    }
}
