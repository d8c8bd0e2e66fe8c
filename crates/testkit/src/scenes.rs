//! Scenes that tests share.

use caustica_scene::Description;
use caustica_scene::description::MaterialKind;

use crate::build::{diffuse, emit, point_light, scene, sphere};

/// Inside of a sphere of albedo ½ and emission ½: radiance 1 everywhere. The sphere's normals point out, so it is
/// made of a mesh turned inside out; see [`inside_out`].
pub fn furnace() -> Description {
    let mut d = scene(8);
    let m = diffuse(&mut d, 0.5);
    let shell = inside_out(&mut d, m);
    emit(&mut d, shell, 0.5);
    d
}

/// The same with a point light of intensity π at the centre, or four of π/4 there.
pub fn point_furnace(lamps: u32) -> Description {
    let mut d = scene(8);
    let m = diffuse(&mut d, 0.5);
    inside_out(&mut d, m);
    for _ in 0..lamps {
        point_light(&mut d, [0.0; 3], std::f32::consts::PI / lamps as f32);
    }
    d
}

/// A unit sphere whose normals point inward: a fine mesh with reversed triangles.
pub fn inside_out(d: &mut Description, material: caustica_scene::description::MaterialId) -> usize {
    let mut mesh = crate::build::ellipsoid(96, [1.0; 3]);
    for t in &mut mesh.triangles {
        t.swap(1, 2);
    }
    mesh.normals.clear();
    crate::build::add(d, "shell", caustica_scene::description::Geometry::Mesh(mesh), material)
}

/// A glass ball in a furnace: radiance inside scales by η², outside it is that of the furnace.
pub fn glass_furnace() -> Description {
    let mut d = furnace();
    let m = d.add_material(MaterialKind::Dielectric { interior_ior: 1.5, exterior_ior: 1.0 });
    sphere(&mut d, [0.1, 0.0, 0.5], 0.2, m);
    d
}
