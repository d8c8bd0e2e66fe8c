//! What a scene takes while it is made ready, so that one that cannot fit is refused before it is begun.

use caustica_math::memory::{MemoryLimit, MemoryShortage};

use crate::bvh::TreeQuality;
use crate::description::{
    CameraKind, Description, Geometry, ImageId, LightKind, MaterialKind, Shape, Texture,
};
use crate::diagnostic::{Cause, Diagnostic};
use crate::light::{Light, SkyLight, SunLight};

/// Bytes a primitive that the tree takes when it is done, and while it is built.
const TREE: u64 = 62;
const TREE_WHILE_BUILT: u64 = 100;

/// Bytes of an edge while borders are looked for.
const EDGE: u64 = 28;

/// Bytes of a triangle that emits, in the tables by which it is chosen and in those that these are made from.
const LAMP_TRIANGLE: u64 = 24;

/// Bytes of a lamp, or of a triangle of one, in the hierarchy, and in the list that this is made from.
const LAMP_PART: u64 = 148 + 64;

/// Bytes that a lamp takes beside its own: its power, its part of the choice, and what it keeps elsewhere.
const LAMP: u64 = 256;

/// Bytes of a pixel of an environment, or of a picture that is thrown, in the table by which it is chosen, and in what that is made from.
const ENVIRONMENT_PIXEL: u64 = 12;

/// Bytes of an instance: its transforms, its box, and itself in the tree.
const INSTANCE: u64 = 400;

/// Bytes of an irradiance meter's tables for each triangle.
const METER_TRIANGLE: u64 = 80;

/// The most bytes that [`Scene::within`](crate::Scene::within) takes at a time, beside the description's own.
pub fn needed(d: &Description, tree: TreeQuality) -> u64 {
    let size = |s: &Shape| match &s.geometry {
        Geometry::Mesh(m) => {
            let corners = 12 * (m.positions.len() + m.normals.len()) + 8 * m.uvs.len();
            (m.triangles.len() as u64, (corners + 16 * m.triangles.len()) as u64)
        }
        Geometry::Sphere { .. } => (1, 64),
    };
    let (mut primitives, mut tables, mut edges, mut lamps) = (0, 0, 0, 0);
    for shape in d.all_shapes() {
        let (count, bytes) = size(shape);
        primitives += count;
        tables += bytes + 48;
        if is_transparent(d, shape) {
            edges = edges.max(3 * EDGE * count);
        }
        if shape.emission.is_some() {
            lamps += (LAMP_TRIANGLE + LAMP_PART) * count + LAMP + size_of::<Light>() as u64;
        }
    }
    tables += INSTANCE * d.instances.len() as u64;
    if let CameraKind::IrradianceMeter { shape } = d.camera.kind {
        tables += METER_TRIANGLE * d.shapes.get(shape as usize).map_or(0, |s| size(s).0);
    }
    for light in &d.lights {
        lamps += LAMP + LAMP_PART + size_of::<Light>() as u64 + tables_of(&light.kind, d);
    }
    let more = |bytes: u64| if tree == TreeQuality::Spatial { bytes * 13 / 10 } else { bytes };
    tables + more(TREE_WHILE_BUILT * primitives).max(more(TREE * primitives) + edges.max(lamps))
}

/// Bytes of the tables of a lamp.
fn tables_of(light: &LightKind, d: &Description) -> u64 {
    let of_image =
        |i: &ImageId| d.images.get(i.0 as usize).map_or(0, |i| i.pixels.len() as u64 * ENVIRONMENT_PIXEL);
    match light {
        LightKind::Environment { image, .. } => of_image(image),
        LightKind::Sky { .. } => SkyLight::CELLS as u64 * ENVIRONMENT_PIXEL,
        LightKind::Sun { .. } => size_of::<SunLight>() as u64 + SunLight::TABLE,
        LightKind::Projector { irradiance: Texture::Image { image, .. }, .. } => of_image(image),
        // A checkerboard of 64 × 64 cells.
        LightKind::Projector { .. } => (1 << 12) * ENVIRONMENT_PIXEL,
        LightKind::Collimated { shape, .. } => {
            let triangles = |s: &Shape| match &s.geometry {
                Geometry::Mesh(m) => m.triangles.len() as u64,
                Geometry::Sphere { .. } => 1,
            };
            d.shapes.get(*shape as usize).map_or(0, |s| LAMP_TRIANGLE * triangles(s))
        }
        _ => 0,
    }
}

/// Whether a shape may be. (What wrappers hold is not looked at.)
fn is_transparent(d: &Description, shape: &Shape) -> bool {
    let kind = d.materials.get(shape.material.0 as usize).map(|m| &m.kind);
    kind.is_some_and(|kind| kind.refracts() || matches!(kind, MaterialKind::Wrapped(_)))
}

/// Refuses a scene that does not fit.
pub(crate) fn check(d: &Description, tree: TreeQuality, memory: MemoryLimit) -> Result<(), Diagnostic> {
    memory.check(needed(d, tree)).map_err(|e| shortage("the scene", e))
}

/// "`what` needs … MB of memory, and … MB are there".
pub fn shortage(what: &str, e: MemoryShortage) -> Diagnostic {
    Diagnostic { cause: Cause::Memory, ..Diagnostic::error(format!("{what} {e}")) }
}
