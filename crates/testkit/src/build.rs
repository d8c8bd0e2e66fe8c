//! Short ways to describe small scenes.

use caustica_math::{Filter, Rgb, Transform, Vec2, Vec3};
use caustica_scene::Description;
use caustica_scene::description::{
    Camera, CameraKind, FilmSettings, Geometry, Group, GroupId, Instance, Light, LightKind, MaterialId,
    MaterialKind, Mesh, Shape, Texture,
};

/// A description with a small square film, a box filter and a pinhole at the origin that looks along +z.
pub fn scene(resolution: u32) -> Description {
    Description {
        camera: Camera { kind: CameraKind::Perspective { fov: 60.0 }, ..Camera::default() },
        film: FilmSettings {
            width: resolution,
            height: resolution,
            crop: None,
            filter: Filter::Box { radius: 0.5 },
        },
        ..Description::default()
    }
}

/// Places the camera.
pub fn look(d: &mut Description, origin: [f64; 3], target: [f64; 3]) {
    d.camera.to_world = Transform::look_at(origin, target, [0.0, 1.0, 0.0]);
}

/// A grey diffuse material.
pub fn diffuse(d: &mut Description, albedo: f32) -> MaterialId {
    d.add_material(MaterialKind::Diffuse { albedo: Rgb::splat(albedo).into() })
}

/// Glass of index 1.5.
pub fn glass(d: &mut Description) -> MaterialId {
    d.add_material(MaterialKind::dielectric(1.5, 1.0))
}

/// Adds a shape.
pub fn add(d: &mut Description, name: &str, geometry: Geometry, material: MaterialId) -> usize {
    d.shapes.push(Shape {
        name: name.into(),
        geometry,
        to_world: Transform::IDENTITY,
        material,
        emission: None,
        origin: None,
    });
    d.shapes.len() - 1
}

/// Adds a sphere.
pub fn sphere(d: &mut Description, center: [f32; 3], radius: f32, material: MaterialId) -> usize {
    add(d, "sphere", Geometry::Sphere { center: center.into(), radius }, material)
}

/// Adds a parallelogram from a corner along two edges; its normal is `u` × `v`.
pub fn quad(d: &mut Description, corner: [f32; 3], u: [f32; 3], v: [f32; 3], material: MaterialId) -> usize {
    let (p, u, v) = (Vec3::from(corner), Vec3::from(u), Vec3::from(v));
    let mesh = Mesh {
        positions: vec![p, p + u, p + u + v, p + v],
        uvs: [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec2::new(x, y)).to_vec(),
        normals: vec![],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        attributes: vec![],
    };
    add(d, "quad", Geometry::Mesh(mesh), material)
}

/// Makes a group of the shapes from number `first` on.
pub fn group(d: &mut Description, first: usize) -> GroupId {
    let shapes = d.shapes.split_off(first);
    d.groups.push(Group { name: "group".into(), shapes, origin: None });
    GroupId(d.groups.len() as u32 - 1)
}

/// Shows a group.
pub fn instance(d: &mut Description, group: GroupId, to_world: Transform) {
    d.instances.push(Instance { group, to_world, origin: None });
}

/// Makes a shape a lamp of grey radiance.
pub fn emit(d: &mut Description, shape: usize, radiance: f32) {
    d.shapes[shape].emission = Some(Texture::Constant(Rgb::splat(radiance)));
}

/// Adds a lamp without a surface.
pub fn light(d: &mut Description, kind: LightKind) {
    d.lights.push(Light { kind, origin: None });
}

/// Adds a point light.
pub fn point_light(d: &mut Description, position: [f32; 3], intensity: f32) {
    light(d, LightKind::Point { position, intensity: Rgb::splat(intensity) });
}

/// A triangulated sphere of `n` × 2`n` cells with smooth normals, scaled differently on each axis; its shading
/// normals lean away from the geometric ones by the coarseness.
pub fn ellipsoid(n: u32, radii: [f32; 3]) -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..=n {
        for j in 0..=2 * n {
            let theta = std::f32::consts::PI * i as f32 / n as f32;
            let phi = std::f32::consts::PI * j as f32 / n as f32;
            let (st, ct) = caustica_math::elementary::sin_cos(theta);
            let (sp, cp) = caustica_math::elementary::sin_cos(phi);
            let p = Vec3::new(st * cp, ct, st * sp);
            mesh.positions.push(Vec3::new(p.x * radii[0], p.y * radii[1], p.z * radii[2]));
            mesh.normals.push(Vec3::new(p.x / radii[0], p.y / radii[1], p.z / radii[2]));
            mesh.uvs.push(Vec2::new(j as f32 / (2 * n) as f32, i as f32 / n as f32));
        }
    }
    let row = 2 * n + 1;
    for i in 0..n {
        for j in 0..2 * n {
            let (a, b) = (i * row + j, (i + 1) * row + j);
            if i > 0 {
                mesh.triangles.push([a, a + 1, b]);
            }
            if i + 1 < n {
                mesh.triangles.push([a + 1, b + 1, b]);
            }
        }
    }
    mesh
}
