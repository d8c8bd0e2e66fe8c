//! Scenes that tests share.

use caustica_math::{Rgb, Transform};
use caustica_scene::Description;
use caustica_scene::description::{
    CameraKind, Daylight, Geometry, Image, LightKind, MaterialId, MaterialKind, Roughness, Texture,
    TextureTransform,
};

use crate::build::{
    add, diffuse, ellipsoid, emit, group, instance, light, look, point_light, quad, scene, sphere,
};

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
pub fn inside_out(d: &mut Description, material: MaterialId) -> usize {
    let mut mesh = ellipsoid(96, [1.0; 3]);
    for t in &mut mesh.triangles {
        t.swap(1, 2);
    }
    mesh.normals.clear();
    add(d, "shell", Geometry::Mesh(mesh), material)
}

/// A glass ball in a furnace: radiance inside scales by η², outside it is that of the furnace.
pub fn glass_furnace() -> Description {
    let mut d = furnace();
    let m = d.add_material(MaterialKind::dielectric(1.5, 1.0));
    sphere(&mut d, [0.1, 0.0, 0.5], 0.2, m);
    d
}

/// An open box (floor, back and left walls, ceiling) from −1 to 1 with a lamp below the ceiling, seen from the
/// front: what most agreement scenes start from. The lamp is shape 4.
pub fn open_box() -> Description {
    let mut d = scene(16);
    look(&mut d, [0.0, 0.0, -3.2], [0.0, 0.0, 0.0]);
    d.camera.kind = CameraKind::Perspective { fov: 45.0 };
    let (white, red) = (diffuse(&mut d, 0.7), diffuse(&mut d, 0.4));
    quad(&mut d, [-1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], white);
    quad(&mut d, [-1.0, -1.0, 1.0], [0.0, 2.0, 0.0], [2.0, 0.0, 0.0], white);
    quad(&mut d, [-1.0, -1.0, -1.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0], red);
    quad(&mut d, [-1.0, 1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], white);
    let lamp = quad(&mut d, [-0.4, 0.95, -0.4], [0.8, 0.0, 0.0], [0.0, 0.0, 0.8], white);
    emit(&mut d, lamp, 8.0);
    d
}

/// The box without its lamp.
pub fn dark_box() -> Description {
    let mut d = open_box();
    d.shapes.pop();
    d
}

/// The box with a ball of some material.
pub fn ball(kind: MaterialKind) -> Description {
    let mut d = open_box();
    let m = d.add_material(kind);
    sphere(&mut d, [0.1, -0.4, 0.1], 0.5, m);
    d
}

/// Glass of index 1.5, in either order.
pub fn glass_kind(inverted: bool) -> MaterialKind {
    let (interior_ior, exterior_ior) = if inverted { (1.0, 1.5) } else { (1.5, 1.0) };
    MaterialKind::dielectric(interior_ior, exterior_ior)
}

/// Rough glass.
pub fn rough_glass_kind() -> MaterialKind {
    MaterialKind::rough_dielectric(Roughness::ggx(0.3), 1.5, 1.0)
}

/// Copper, smooth or rough.
pub fn metal_kind(alpha: Option<f32>) -> MaterialKind {
    let (eta, k) = (Rgb::new(0.2, 0.92, 1.1), Rgb::new(3.91, 2.45, 2.14));
    match alpha {
        None => MaterialKind::conductor(eta, k),
        Some(alpha) => MaterialKind::rough_conductor(Roughness::ggx(alpha), eta, k),
    }
}

/// Nori's plastic.
pub fn plastic_kind() -> MaterialKind {
    MaterialKind::Microfacet {
        alpha: 0.2,
        interior_ior: 1.5,
        exterior_ior: 1.0,
        kd: Rgb::new(0.3, 0.2, 0.4).into(),
    }
}

/// The box with a coarse ellipsoid whose shading normals lean far from the geometric ones.
pub fn smooth_mesh(kind: MaterialKind) -> Description {
    let mut d = open_box();
    let m = d.add_material(kind);
    let index = add(&mut d, "ellipsoid", Geometry::Mesh(ellipsoid(5, [0.6, 0.45, 0.5])), m);
    d.shapes[index].to_world = Transform::translate([0.0, -0.5, 0.0]);
    d
}

/// The box with three instances of a glass egg on a tile beside a metal ball: turned, stretched and mirrored.
pub fn instanced() -> Description {
    let mut d = open_box();
    let first = d.shapes.len();
    let (glass, red) = (d.add_material(glass_kind(false)), diffuse(&mut d, 0.5));
    let metal = d.add_material(metal_kind(Some(0.3)));
    add(&mut d, "egg", Geometry::Mesh(ellipsoid(6, [0.3, 0.4, 0.3])), glass);
    d.shapes[first].to_world = Transform::translate([0.0, 0.45, 0.0]);
    quad(&mut d, [-0.4, 0.0, -0.4], [0.0, 0.0, 0.8], [0.8, 0.0, 0.0], red);
    sphere(&mut d, [0.45, 0.2, 0.0], 0.15, metal);
    let group = group(&mut d, first);
    let turned = Transform::rotate(40.0, [0.0, 1.0, 0.2]);
    for (change, to) in [
        (turned.then(Transform::scale([0.9; 3])), [-0.45, -0.9, 0.2]),
        (Transform::scale([0.7, 1.1, 0.8]).then(turned), [0.5, -0.95, -0.2]),
        (Transform::scale([-0.6, 0.8, 0.5]), [0.1, 0.0, 0.5]),
    ] {
        instance(&mut d, group, change.then(Transform::translate(to)));
    }
    d
}

/// The same scene without groups: every instance has shapes of its own.
pub fn flattened(mut d: Description) -> Description {
    let groups = std::mem::take(&mut d.groups);
    for i in std::mem::take(&mut d.instances) {
        let shapes = groups[i.group.0 as usize].shapes.iter().cloned();
        d.shapes.extend(shapes.map(|mut s| {
            s.to_world = s.to_world.then(i.to_world);
            s
        }));
    }
    d
}

/// An environment with a sun, as an image of 16 × 8 pixels.
pub fn sky(d: &mut Description) {
    let mut pixels: Vec<Rgb> = (0..128).map(|i| Rgb::splat(0.3 + 0.02 * (i % 16) as f32)).collect();
    pixels[2 * 16 + 5] = Rgb::new(60.0, 50.0, 40.0);
    let image = d.add_image(Image { width: 16, height: 8, pixels: pixels.into() });
    let to_world = Transform::rotate(40.0, [0.0, 1.0, 0.2]);
    light(d, LightKind::Environment { image, to_world, scale: 0.5, rows: Default::default() });
}

/// Daylight in a scene whose +y is up.
pub fn daylight(to_sun: [f32; 3]) -> Daylight {
    Daylight { to_world: Transform::rotate(-90.0, [1.0, 0.0, 0.0]), to_sun, turbidity: 4.0 }
}

/// A clear sky, whose radiance is about 1.
pub fn dome(d: &mut Description, to_sun: [f32; 3]) {
    let albedo = Rgb::new(0.2, 0.3, 0.5);
    light(d, LightKind::Sky { daylight: daylight(to_sun), albedo, scale: 8.0 });
}

/// A sun of some diameter in degrees, darkened, whose irradiance is about 1.
pub fn sun(d: &mut Description, to_sun: [f32; 3], aperture: f32) {
    light(d, LightKind::Sun { daylight: daylight(to_sun), aperture, scale: 1.0, darkened: true });
}

/// A ball on a floor under a sky.
pub fn under_the_sky(kind: MaterialKind) -> Description {
    let mut d = scene(16);
    look(&mut d, [0.0, 1.0, -3.0], [0.0, 0.3, 0.0]);
    let (white, ball) = (diffuse(&mut d, 0.6), d.add_material(kind));
    quad(&mut d, [-2.0, 0.0, -2.0], [0.0, 0.0, 4.0], [4.0, 0.0, 0.0], white);
    sphere(&mut d, [0.0, 0.6, 0.0], 0.5, ball);
    sky(&mut d);
    d
}

/// The dark box under the given lamp.
pub fn lit_by(kind: LightKind) -> Description {
    let mut d = dark_box();
    let plastic = d.add_material(plastic_kind());
    sphere(&mut d, [0.2, -0.5, 0.0], 0.4, plastic);
    light(&mut d, kind);
    d
}

/// The box with a lamp, a floor and a ball that are textured.
pub fn textured() -> Description {
    let mut d = open_box();
    let checks = |a, b| Texture::Checkerboard {
        delta: [0.0; 2],
        scale: [0.25; 2],
        shear: [0.0; 2],
        value1: Rgb::splat(a),
        value2: Rgb::splat(b),
    };
    d.materials[0].kind = MaterialKind::Diffuse { albedo: checks(0.1, 0.8) };
    let pixels: Vec<Rgb> = (0..16).map(|i| Rgb::splat(if i == 5 { 30.0 } else { 2.0 })).collect();
    let image = d.add_image(Image { width: 4, height: 4, pixels: pixels.into() });
    let lamp = Texture::Image { image, transform: TextureTransform::default() };
    d.shapes[4].emission = Some(lamp);
    let shade = diffuse(&mut d, 0.3);
    let ball = sphere(&mut d, [0.3, -0.5, 0.0], 0.3, shade);
    d.shapes[ball].emission = Some(checks(0.0, 0.8));
    d
}

/// The dark box with a lamp in a glass bulb: light that no next-event estimation finds.
pub fn bulb() -> Description {
    let mut d = dark_box();
    let (glass, black) = (d.add_material(glass_kind(false)), diffuse(&mut d, 0.2));
    sphere(&mut d, [0.0, 0.2, 0.0], 0.45, glass);
    let lamp = sphere(&mut d, [0.0, 0.2, 0.0], 0.25, black);
    emit(&mut d, lamp, 3.0);
    d
}
