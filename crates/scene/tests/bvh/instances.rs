//! Instances look as what they are instances of would look in their place.

use crate::soups::bodies::{ball, cube};
use crate::soups::{in_cube, random};
use caustica_math::{Rgb, SampleStream, Transform, Vec3, Wavelengths, warp};
use caustica_scene::bvh::{Bvh, Hit, Instance, Instances, Ray, SphereData, TreeQuality};
use caustica_scene::description::{Geometry, GroupId, MaterialId, MaterialKind, Texture};
use caustica_scene::surface::SurfacePoint;
use caustica_scene::{Description, Scene};
use caustica_testkit::build;
use caustica_testkit::scenes::{flattened, instanced};

/// A turn and a shift of numbers without any pattern.
fn turned(scale: [f64; 3], to: [f64; 3]) -> Transform {
    Transform::scale(scale).then(Transform::rotate(37.0, [0.3, -1.0, 0.4])).then(Transform::translate(to))
}

fn made(d: Description) -> Scene {
    Scene::new(d).unwrap().0
}

/// Into a cube of edge 2 around a place, from around it.
fn inward(center: Vec3, radius: f32, s: &mut SampleStream) -> Ray {
    let origin = center + warp::uniform_sphere(s.next_2d()) * (radius * 3.0);
    let target = center + in_cube(s) * radius;
    Ray { origin, direction: target - origin, t_max: f32::INFINITY }
}

/// Whether two points are the same but for rounding, of a scene of the size of one.
fn agree(a: &SurfacePoint, b: &SurfacePoint) -> bool {
    (a.position - b.position).length() < 1e-5
        && (a.normal - b.normal).length() < 1e-4
        // Between corners normals are mixed before or after they are stretched.
        && (a.frame.z - b.frame.z).length() < 0.1
        && (a.uv.x - b.uv.x).abs().max((a.uv.y - b.uv.y).abs()) < 1e-3
}

/// Every ray hits the same thing as in the scene without groups, of the same material, in the same place.
#[test]
fn hits_are_those_of_the_flattened_scene() {
    // Meshes alone: a sphere cannot be stretched otherwise.
    let mut d = instanced();
    d.groups[0].shapes.truncate(2);
    // Texture coordinates are looked at where there is a texture.
    let (value1, value2) = (Rgb::splat(0.2), Rgb::splat(0.8));
    let albedo = Texture::Checkerboard { delta: [0.0; 2], scale: [0.3; 2], shear: [0.0; 2], value1, value2 };
    d.materials.iter_mut().for_each(|m| m.kind = MaterialKind::Diffuse { albedo });
    let kinds = d.groups[0].shapes.len();
    let own = d.shapes.len();
    let (a, b) = (made(d.clone()), made(flattened(d)));
    let (mut s, mut hits, mut inside, mut unlike) = (random(1), 0, 0, 0);
    for _ in 0..60_000 {
        let ray = inward(Vec3::ZERO, 1.0, &mut s);
        let (p, q) = (a.closest(&ray), b.closest(&ray));
        assert_eq!(p.is_some(), a.occluded(&ray), "{ray:?}");
        let instanced = p.is_some_and(|p| p.instance != Hit::NO_INSTANCE);
        assert_eq!(instanced, p.is_some_and(|p| p.shape as usize >= own));
        let (Some(p), Some(q)) = (&p, &q) else {
            unlike += u32::from(p.is_some() != q.is_some());
            continue;
        };
        hits += 1;
        let shape = q.shape as usize;
        let expected = if shape < own { shape } else { own + (shape - own) % kinds };
        inside += u32::from(shape >= own);
        if p.shape as usize != expected || !agree(p, q) {
            println!("{ray:?}:\n{p:?}\n{q:?}");
            unlike += 1;
        }
        let segment = Ray { t_max: 0.999, direction: p.position - ray.origin, ..ray };
        assert!(!a.occluded(&segment), "{segment:?}");
    }
    // At edges rounding decides.
    assert!(unlike <= 3, "{unlike} of {hits} hits differ");
    assert!(hits > 20_000 && inside > 3_000, "{hits} hits, {inside} of them in instances");
}

/// A sphere that an instance stretches is the ellipsoid.
#[test]
fn spheres_are_stretched() {
    let radii = [0.5, 1.5, 0.8];
    let mut d = Description::default();
    let m = build::diffuse(&mut d, 0.5);
    build::sphere(&mut d, [0.0; 3], 1.0, m);
    let group = build::group(&mut d, 0);
    let to = [3.0, -2.0, 1.0];
    build::instance(&mut d, group, Transform::scale(radii).then(Transform::translate(to)));
    let scene = made(d);
    let (center, mut s) = (Vec3::from(to.map(|c| c as f32)), random(2));
    for _ in 0..10_000 {
        let Some(p) = scene.closest(&inward(center, 1.5, &mut s)) else { continue };
        let local = p.position - center;
        let on = |power: i32| Vec3::from([0, 1, 2].map(|i| local[i] / (radii[i] as f32).powi(power)));
        assert!((on(1).length() - 1.0).abs() < 1e-5, "{p:?}");
        assert!((on(2).normalized() - p.normal).length() < 1e-4, "{p:?}");
    }
}

/// What a ray hits of a heap of instances, one on the other, is the first hit of all of them, one by one.
#[test]
fn the_first_hit_is_found() {
    let soup = crate::soups::Soup::of_lattice(60, 3).with_spheres(10, 4);
    let places: Vec<Transform> = {
        let mut s = random(5);
        let place = |i: usize| {
            // Some in the same place: the first of them is hit.
            let to = in_cube(&mut s).to_array().map(f64::from);
            if i.is_multiple_of(5) { Transform::IDENTITY } else { turned([0.3, -0.5, 0.4], to) }
        };
        (0..40).map(place).collect()
    };
    let place = |t: &Transform| {
        let [to_world, to_group] = t.affine().unwrap();
        Instance { group: 0, to_world, to_group }
    };
    let around = |places: &[Transform], quality| {
        let instances = Instances::new(vec![soup.tree()], places.iter().map(place).collect());
        let floor = [Vec3::new(-3.0, 0.0, -3.0), Vec3::new(3.0, 0.0, -3.0), Vec3::new(0.0, 0.0, 5.0)];
        let ball = [SphereData { center: Vec3::ZERO, radius: 0.2 }];
        match places.len() {
            1 => Bvh::with_instances((&[], &[]), &[], instances, quality),
            _ => Bvh::with_instances((&floor, &[[0, 1, 2]]), &ball, instances, quality),
        }
    };
    let plain = Bvh::new(
        &[Vec3::new(-3.0, 0.0, -3.0), Vec3::new(3.0, 0.0, -3.0), Vec3::new(0.0, 0.0, 5.0)],
        &[[0, 1, 2]],
        &[SphereData { center: Vec3::ZERO, radius: 0.2 }],
    );
    let trees = [TreeQuality::Fast, TreeQuality::Spatial].map(|q| around(&places, q));
    let portable = around(&places, TreeQuality::Fast).portable();
    let alone: Vec<Bvh> = places.iter().map(|p| around(&[*p], TreeQuality::Fast)).collect();
    let (mut s, mut inside, mut ties) = (random(6), 0, 0);
    for _ in 0..20_000 {
        let ray = crate::soups::some_ray(&soup, &mut s);
        let own = plain.closest(&ray).into_iter();
        let hits = alone.iter().enumerate();
        let hits = hits.filter_map(|(i, t)| Some(Hit { instance: i as u32, ..t.closest(&ray)? }));
        let all: Vec<Hit> = own.chain(hits).collect();
        let first = all.iter().copied().reduce(|a, b| if b.t < a.t { b } else { a });
        ties += usize::from(all.iter().filter(|h| first.is_some_and(|f| f.t == h.t)).count() > 1);
        inside += usize::from(first.is_some_and(|f| f.instance != Hit::NO_INSTANCE));
        for tree in trees.iter().chain([&portable]) {
            assert_eq!(tree.closest(&ray), first, "{ray:?}");
            assert_eq!(tree.occluded(&ray), first.is_some(), "{ray:?}");
        }
    }
    assert!(inside > 5000 && ties > 500, "{inside} in instances, {ties} ties");
}

/// Scales, distances in units of them, and how instances are stretched beside.
const PLACES: [(f64, f64); 6] =
    [(1e-3, 0.0), (1.0, 0.0), (1e4, 0.0), (1e-3, 30.0), (1.0, 100.0), (1e4, 10.0)];
const STRETCHES: [[f64; 3]; 3] = [[1.0; 3], [0.3, 1.0, 2.0], [-1.0, 0.05, 0.4]];

/// One convex body, instanced.
struct Body {
    name: String,
    scene: Scene,
    /// From the world to where it lies around the origin.
    back: Transform,
    center: Vec3,
    radius: f32,
}

fn bodies() -> Vec<Body> {
    let mut bodies = Vec::new();
    for (scale, distance) in PLACES {
        for stretch in STRETCHES {
            for kind in 0..4 {
                let mut d = Description::default();
                let m = build::diffuse(&mut d, 0.5);
                // Groups may lie far from their origin themselves.
                let within = if kind == 1 { [40.0, -30.0, 20.0] } else { [0.0; 3] };
                let geometry = match kind {
                    0 => Geometry::Mesh(ball(16)),
                    1 | 2 => Geometry::Mesh(cube(kind)),
                    _ => Geometry::Sphere { center: Vec3::ZERO, radius: 1.0 },
                };
                build::add(&mut d, "body", geometry, m);
                d.shapes[0].to_world = Transform::translate(within);
                let group = build::group(&mut d, 0);
                let to = [0.7, -1.0, 0.4].map(|c| c * scale * distance);
                let place = turned(stretch.map(|s| s * scale), to);
                build::instance(&mut d, group, place);
                let center = place.point(Vec3::from(within.map(|c| c as f32)));
                let name = format!("body {kind} of {scale}, {distance}, {stretch:?}");
                let back = place.inverse().then(Transform::translate(within.map(|c| -c)));
                bodies.push(Body { name, scene: made(d), back, center, radius: 2.0 * scale as f32 });
            }
        }
    }
    bodies
}

impl Body {
    /// A point that a ray into the body hits, but not right at an edge: there the wall beside it may be nearer than the
    /// offset.
    fn hit(&self, s: &mut SampleStream) -> Option<SurfacePoint> {
        let ray = inward(self.center, self.radius * 0.4, s);
        let p = self.scene.closest(&ray)?;
        assert!(p.normal.dot(ray.direction) < 0.0, "outside is outside: {p:?}");
        let local = self.back.point(p.position).abs().to_array();
        (local.iter().filter(|c| **c > 0.998).count() <= 1).then_some(p)
    }
}

/// No ray that leaves a convex body meets it again, and any two of its points see each other inside.
#[test]
fn nothing_shadows_itself() {
    for body in bodies() {
        let Body { name, scene, .. } = &body;
        let (mut s, mut falsely_hit, mut falsely_hidden, mut looked) = (random(7), 0, 0, 0);
        for i in 0..6000 {
            let (Some(p), Some(q)) = (body.hit(&mut s), body.hit(&mut s)) else { continue };
            let mut direction = warp::uniform_sphere(s.next_2d());
            if i % 3 == 0 {
                // Grazing.
                direction = (direction - p.normal * (p.normal.dot(direction) * 0.999)).normalized();
            }
            direction = direction * 1.0_f32.copysign(p.normal.dot(direction));
            let ray = Ray { origin: p.off_surface(direction), direction, t_max: f32::INFINITY };
            falsely_hit += u32::from(scene.occluded(&ray));
            let d = q.position - p.position;
            // Points of one face have no inside between them.
            if p.normal.dot(d) < -1e-3 * d.length() && q.normal.dot(d) > 1e-3 * d.length() {
                let (from, to) = (p.off_surface(d), q.off_surface(-d));
                falsely_hidden += u32::from(!scene.visible(from, to)) + u32::from(!scene.visible(to, from));
                looked += 1;
            }
        }
        assert!(looked > 200, "{name}: {looked}");
        assert_eq!([falsely_hit, falsely_hidden], [0; 2], "{name}: {looked}");
    }
}

/// No ray slips out between two triangles.
#[test]
fn instances_are_watertight() {
    for Body { name, scene, center, .. } in bodies() {
        let mut s = random(8);
        for _ in 0..4000 {
            let direction = warp::uniform_sphere(s.next_2d());
            let ray = Ray { origin: center, direction, t_max: f32::INFINITY };
            assert!(scene.closest(&ray).is_some() && scene.occluded(&ray), "{name}: {ray:?}");
        }
    }
}

#[test]
fn materials_are_those_of_the_group() {
    let mut d = instanced();
    d.groups[0].shapes[1].material = MaterialId(0);
    let own = d.shapes.len();
    let scene = made(d);
    let kinds: Vec<_> = (own..own + 3)
        .map(|i| {
            let point = scene.surfaces().some_point(i as u32);
            assert_eq!(point.shape as usize, i);
            std::mem::discriminant(&scene.bsdf(&point, Wavelengths::Rgb))
        })
        .collect();
    assert!(kinds[0] != kinds[1] && kinds[1] != kinds[2] && kinds[0] != kinds[2]);
}

/// A way to spoil a scene.
type Change = fn(&mut Description);

#[test]
fn what_cannot_be_is_refused() {
    let changes: [(&str, Change); 7] = [
        ("a lamp in the group", |d| d.groups[0].shapes[0].emission = d.shapes[4].emission),
        ("a group that has no shapes", |d| d.groups[0].shapes.clear()),
        ("does not exist", |d| d.instances[1].group = GroupId(1)),
        ("cannot be inverted", |d| d.instances[1].to_world = Transform::scale([1.0, 0.0, 1.0])),
        ("projective", |d| {
            let mut rows: [[f64; 4]; 4] = Transform::IDENTITY.into();
            rows[3][0] = 0.5;
            d.instances[1].to_world = Transform::from_rows(rows);
        }),
        ("too large or too small", |d| d.instances[1].to_world = Transform::scale([1e-20; 3])),
        ("farther than", |d| d.instances[1].to_world = Transform::translate([0.0, 1e20, 0.0])),
    ];
    for (message, change) in changes {
        let mut d = instanced();
        change(&mut d);
        let error = Scene::new(d).unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }
}

#[test]
fn glass_in_groups_is_looked_at_for_gaps() {
    let mut d = instanced();
    let mut closed = cube(1);
    closed.positions.iter_mut().for_each(|p| *p *= 0.2);
    d.groups[0].shapes[0].geometry = Geometry::Mesh(closed);
    assert_eq!(Scene::new(d.clone()).unwrap().1, []);
    let Geometry::Mesh(egg) = &mut d.groups[0].shapes[0].geometry else { panic!() };
    egg.triangles.pop();
    let warnings = Scene::new(d).unwrap().1;
    assert!(warnings[0].to_string().contains("egg is transparent but not closed"), "{warnings:?}");
}
