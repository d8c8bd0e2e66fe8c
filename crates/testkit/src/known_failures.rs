//! Small scenes of what other bidirectional renderers are known to get wrong; the tests of the transport crate
//! are named after the complaints.

use caustica_math::elementary::sin_cos;
use caustica_math::{Rgb, Transform, Vec2, Vec3};
use caustica_scene::Description;
use caustica_scene::description::{
    Camera, CameraKind, Geometry, Image, LightKind, MaterialId, MaterialKind, Mesh, Roughness, Texture,
    TextureTransform,
};

use crate::build::{add, diffuse, ellipsoid, emit, glass, light, look, point_light, quad, scene, sphere};
use crate::scenes::{dark_box, open_box, sky};

/// A quad whose vertex normals all lean from its geometric normal by the vector `lean` (in units of the normal).
pub fn leaning_quad(
    d: &mut Description,
    [corner, u, v]: [[f32; 3]; 3],
    lean: [f32; 3],
    material: MaterialId,
) -> usize {
    let index = quad(d, corner, u, v, material);
    if let Geometry::Mesh(mesh) = &mut d.shapes[index].geometry {
        let normal = Vec3::from(u).cross(Vec3::from(v)).normalized() + Vec3::from(lean);
        mesh.normals = vec![normal; 4];
    }
    index
}

/// The box with a panel above its floor whose shading normals lean by 50 degrees, and a coarse egg, all of one
/// material.
pub fn leaning_normals(kind: MaterialKind) -> Description {
    let mut d = open_box();
    let m = d.add_material(kind);
    let panel = [[-0.8, -0.7, -0.8], [0.0, 0.0, 1.4], [1.6, 0.0, 0.0]];
    leaning_quad(&mut d, panel, [0.8, 0.0, -0.9], m);
    let egg = add(&mut d, "egg", Geometry::Mesh(ellipsoid(4, [0.3, 0.4, 0.3])), m);
    d.shapes[egg].to_world = Transform::translate([-0.2, -0.1, 0.2]);
    d
}

/// The dark box with a coarse lamp whose vertex normals make it look round.
pub fn smooth_lamp() -> Description {
    let mut d = dark_box();
    let m = diffuse(&mut d, 0.3);
    let lamp = add(&mut d, "lamp", Geometry::Mesh(ellipsoid(3, [0.5, 0.4, 0.4])), m);
    emit(&mut d, lamp, 3.0);
    d
}

/// The box with a small lamp near the edge of a wide view, through a wide lens that is focused behind it.
pub fn lamp_out_of_focus() -> Description {
    let mut d = dark_box();
    let m = diffuse(&mut d, 0.3);
    let lamp = sphere(&mut d, [0.7, 0.5, -0.6], 0.25, m);
    emit(&mut d, lamp, 6.0);
    look(&mut d, [0.0, 0.0, -1.9], [0.0; 3]);
    d.camera.kind = CameraKind::ThinLens { fov: 90.0, aperture_radius: 0.4, focus_distance: 3.0 };
    d
}

/// Light that passes mirrors and glass between diffuse surfaces: a mirror wall, a pane of glass in front of it,
/// a glass ball, and the lamp behind another pane.
pub fn specular_chains() -> Description {
    let mut d = open_box();
    let mirror = d.add_material(MaterialKind::Mirror { reflectance: Rgb::splat(0.9) });
    d.shapes[2].material = mirror;
    let glass = glass(&mut d);
    pane(&mut d, [-0.8, 0.7, -0.8], [1.6, 0.0, 0.0], [0.0, 0.0, 1.6], glass);
    pane(&mut d, [-0.6, -0.9, -0.6], [0.0, 0.0, 1.2], [0.0, 1.2, 0.0], glass);
    sphere(&mut d, [0.3, -0.6, 0.1], 0.35, glass);
    d
}

/// A closed slab of glass on a parallelogram, a tenth thick.
fn pane(d: &mut Description, corner: [f32; 3], u: [f32; 3], v: [f32; 3], glass: MaterialId) {
    let (p, a, b) = (Vec3::from(corner), Vec3::from(u), Vec3::from(v));
    let n = a.cross(b).normalized() * 0.1;
    let corners = [p, p + a, p + a + b, p + b, p + n, p + a + n, p + a + b + n, p + b + n];
    let sides = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
    let triangles = sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let mesh = Mesh { positions: corners.to_vec(), triangles, ..Mesh::default() };
    add(d, "pane", Geometry::Mesh(mesh), glass);
}

/// The dark box under a spot of the given half angles, which stands in view or out of it.
pub fn spot(in_view: bool, inner_angle: f32, outer_angle: f32) -> Description {
    let mut d = dark_box();
    let position = if in_view { [0.2, 0.3, -0.6] } else { [0.5, 0.8, -6.0] };
    let aim = [-0.3, -0.6, 1.0];
    let direction = [0, 1, 2].map(|i| aim[i] - position[i]);
    let (_, cos) = sin_cos((0.5 * (inner_angle + outer_angle)).to_radians());
    light(
        &mut d,
        LightKind::Spot {
            position,
            direction,
            intensity: Rgb::splat(0.5 / (1.0 - cos)),
            inner_angle,
            outer_angle,
        },
    );
    d
}

/// Lamps of very unequal power, found by different densities from a place than they emit by: a ball, a textured
/// panel, an environment map, a weak point.
pub fn unequal_lamps() -> Description {
    let mut d = dark_box();
    let m = diffuse(&mut d, 0.5);
    let ball = sphere(&mut d, [0.5, -0.6, 0.3], 0.25, m);
    emit(&mut d, ball, 2.0);
    let pixels: Vec<Rgb> = (0..16).map(|i| Rgb::splat(if i % 5 == 0 { 9.0 } else { 0.1 })).collect();
    let image = d.add_image(Image { width: 4, height: 4, pixels: pixels.into() });
    let panel = quad(&mut d, [-0.9, 0.2, 0.9], [0.0, 0.7, 0.0], [1.4, 0.0, 0.0], m);
    d.shapes[panel].emission = Some(Texture::Image { image, transform: TextureTransform::default() });
    sky(&mut d);
    point_light(&mut d, [-0.5, -0.3, -0.2], 0.15);
    d
}

/// A lantern of 1 W beside a plate of a town's size under the sun.
pub fn lantern_under_the_sun() -> Description {
    let mut d = scene(8);
    let m = diffuse(&mut d, 0.5);
    quad(&mut d, [-5000.0, 0.0, -5000.0], [0.0, 0.0, 1e4], [1e4, 0.0, 0.0], m);
    light(&mut d, LightKind::Directional { direction: [0.0, -1.0, 0.1], irradiance: Rgb::splat(1000.0) });
    point_light(&mut d, [0.0, 0.1, 0.0], 0.08);
    d
}

/// The dark box with a point light a millimetre above its floor, in view.
pub fn point_at_the_floor() -> Description {
    let mut d = dark_box();
    point_light(&mut d, [0.1, -0.999, 0.2], 1.0);
    d
}

/// An egg and a leaning lamp, both with vertex normals, and a lamp without, mirrored at x = 0: by a transform, or
/// written down that way.
pub fn mirrored(by_transform: bool) -> Description {
    let mut d = dark_box();
    let m = diffuse(&mut d, 0.8);
    let frosted = d.add_material(MaterialKind::rough_dielectric(Roughness::ggx(0.2), 1.5, 1.0));
    let mut mesh = ellipsoid(5, [0.3, 0.5, 0.4]);
    for p in &mut mesh.positions {
        *p += Vec3::new(0.35, -0.4, 0.125);
    }
    let egg = add(&mut d, "egg", Geometry::Mesh(mesh), frosted);
    let (x, z) = (Vec3::new(0.5, 0.25, 0.0), Vec3::new(0.0, 0.0, 0.5));
    let p = Vec3::new(-0.75, 0.5, -0.25);
    let panel = Mesh {
        positions: vec![p, p + x, p + x + z, p + z],
        normals: vec![x.cross(z) + Vec3::new(0.0, -0.125, 0.0625); 4],
        uvs: [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec2::new(x, y)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        attributes: vec![],
    };
    let panel = add(&mut d, "panel", Geometry::Mesh(panel), m);
    emit(&mut d, panel, 8.0);
    let bare = quad(&mut d, [0.875, -0.5, -0.25], [0.0, 0.0, 0.5], [0.0, 0.75, 0.0], m);
    emit(&mut d, bare, 4.0);
    for shape in [egg, panel, bare] {
        if by_transform {
            d.shapes[shape].to_world = Transform::scale([-1.0, 1.0, 1.0]);
        } else if let Geometry::Mesh(mesh) = &mut d.shapes[shape].geometry {
            for v in mesh.positions.iter_mut().chain(&mut mesh.normals) {
                v.x = -v.x;
            }
            for t in &mut mesh.triangles {
                t.swap(1, 2);
            }
        }
    }
    d
}

/// Three rooms in a row behind each other, joined by doors; the lamp is in the last, the camera in the first.
pub fn three_rooms() -> Description {
    let mut d = scene(16);
    look(&mut d, [-0.6, 0.0, -0.9], [0.5, 0.0, 1.0]);
    d.camera.kind = CameraKind::Perspective { fov: 70.0 };
    let white = diffuse(&mut d, 0.8);
    // Floor, ceiling, left, right, front and far wall of the whole row: x, y in ±1, z from −1 to 5.
    quad(&mut d, [-1.0, -1.0, -1.0], [0.0, 0.0, 6.0], [2.0, 0.0, 0.0], white);
    quad(&mut d, [-1.0, 1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 6.0], white);
    quad(&mut d, [-1.0, -1.0, -1.0], [0.0, 2.0, 0.0], [0.0, 0.0, 6.0], white);
    quad(&mut d, [1.0, -1.0, -1.0], [0.0, 0.0, 6.0], [0.0, 2.0, 0.0], white);
    quad(&mut d, [-1.0, -1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], white);
    quad(&mut d, [-1.0, -1.0, 5.0], [0.0, 2.0, 0.0], [2.0, 0.0, 0.0], white);
    // Walls between the rooms, each a box with two diffuse faces, with a door at one side.
    for (z, from, to) in [(1.0, -1.0, 0.3), (3.0, -0.3, 1.0)] {
        for (z, facing) in [(z - 0.02, false), (z + 0.02, true)] {
            let (across, up) = ([to - from, 0.0, 0.0], [0.0, 2.0, 0.0]);
            let (u, v) = if facing { (across, up) } else { (up, across) };
            quad(&mut d, [from, -1.0, z], u, v, white);
        }
    }
    let lamp = quad(&mut d, [-0.5, 0.9, 3.6], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], white);
    emit(&mut d, lamp, 40.0);
    d
}

/// The box with a glass ball, an egg with vertex normals, a lens camera and all lengths times `scale`.
pub fn scaled(scale: f32) -> Description {
    let mut d = open_box();
    let glass = glass(&mut d);
    sphere(&mut d, [-0.4, -0.6, 0.1], 0.35, glass);
    let grey = diffuse(&mut d, 0.6);
    let egg = add(&mut d, "egg", Geometry::Mesh(ellipsoid(6, [0.3, 0.5, 0.4])), grey);
    d.shapes[egg].to_world = Transform::translate([0.5, -0.4, 0.2]);
    light(&mut d, LightKind::Constant { radiance: Rgb::splat(0.25) });
    point_light(&mut d, [0.5, 0.5, -0.5].map(|c: f32| c * scale), 0.5 * scale * scale);
    let k = f64::from(scale);
    for shape in &mut d.shapes {
        shape.to_world = shape.to_world.then(Transform::scale([k; 3]));
    }
    let camera = Camera {
        kind: CameraKind::ThinLens { fov: 45.0, aperture_radius: 0.1 * scale, focus_distance: 3.0 * scale },
        to_world: Transform::look_at([0.0, 0.0, -3.2 * k], [0.0; 3], [0.0, 1.0, 0.0]),
        near: 0.001 * scale,
        far: 1e4 * scale,
        ..d.camera.clone()
    };
    d.camera = camera;
    d
}

/// A square plate of 2 × 2 and albedo ½, filled by a parallel camera above; the lamp is for the caller to add.
pub fn plate() -> Description {
    let mut d = scene(8);
    let m = diffuse(&mut d, 0.5);
    quad(&mut d, [-1.0, 0.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], m);
    d.camera.kind = CameraKind::Orthographic;
    d.camera.to_world = Transform::look_at([0.0, 0.5, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    d
}

/// A glass of water, all interfaces touching: a ball of water in a shell of glass, described by the indices on
/// both sides of each interface, with a pearl in the water; and a lamp behind a pane.
pub fn nested_interfaces() -> Description {
    let mut d = open_box();
    let outer = glass(&mut d);
    let inner = d.add_material(MaterialKind::dielectric(1.33, 1.5));
    let pearl = diffuse(&mut d, 0.8);
    sphere(&mut d, [0.0, -0.3, 0.0], 0.6, outer);
    // Touches the shell from inside at its lowest point.
    sphere(&mut d, [0.0, -0.4, 0.0], 0.5, inner);
    sphere(&mut d, [0.0, -0.55, 0.0], 0.3, pearl);
    pane(&mut d, [-0.9, 0.75, -0.9], [1.8, 0.0, 0.0], [0.0, 0.0, 1.8], outer);
    d
}

/// The box with a glass egg over its floor as caustic caster: its normals point out, or in with the indices
/// swapped.
pub fn caster(inward: bool) -> Description {
    let mut d = open_box();
    let (interior_ior, exterior_ior) = if inward { (1.0, 1.5) } else { (1.5, 1.0) };
    let m = d.add_material(MaterialKind::dielectric(interior_ior, exterior_ior));
    let mut mesh = ellipsoid(12, [0.4, 0.3, 0.4]);
    if inward {
        for t in &mut mesh.triangles {
            t.swap(1, 2);
        }
        for n in &mut mesh.normals {
            *n = -*n;
        }
    }
    let egg = add(&mut d, "egg", Geometry::Mesh(mesh), m);
    d.shapes[egg].to_world = Transform::translate([0.0, -0.5, 0.0]);
    d
}

/// Lamps with textures: a panel by an image, a ball by a checkerboard, an egg by another image through a
/// transform, most of each dark.
pub fn textured_emitters() -> Description {
    let mut d = dark_box();
    let m = diffuse(&mut d, 0.4);
    let pixels =
        |bright: usize| (0..64).map(|i| Rgb::splat(if i % bright == 0 { 12.0 } else { 0.0 })).collect();
    let first = d.add_image(Image { width: 8, height: 8, pixels: pixels(9) });
    let second = d.add_image(Image { width: 8, height: 8, pixels: pixels(5) });
    let image = |image, scale| Texture::Image {
        image,
        transform: TextureTransform { scale, offset: [0.3, 0.1], ..TextureTransform::default() },
    };
    let panel = quad(&mut d, [-0.6, 0.9, -0.6], [1.2, 0.0, 0.0], [0.0, 0.0, 1.2], m);
    d.shapes[panel].emission = Some(image(first, [1.0, 1.0]));
    let ball = sphere(&mut d, [0.5, -0.5, 0.2], 0.4, m);
    d.shapes[ball].emission = Some(Texture::Checkerboard {
        delta: [0.1, 0.2],
        scale: [0.2, 0.3],
        shear: [0.0; 2],
        value1: Rgb::BLACK,
        value2: Rgb::splat(1.5),
    });
    let mut egg = ellipsoid(6, [0.3, 0.3, 0.3]);
    egg.normals.clear();
    let egg = add(&mut d, "egg", Geometry::Mesh(egg), m);
    d.shapes[egg].to_world = Transform::translate([-0.5, -0.5, 0.0]);
    d.shapes[egg].emission = Some(image(second, [2.0, 3.0]));
    d
}
