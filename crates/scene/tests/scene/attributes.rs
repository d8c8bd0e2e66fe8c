//! Colours of meshes that textures look up by name.

use caustica_math::{Rgb, SampleStream, StreamId, Transform, Vec3, Wavelengths, warp};
use caustica_scene::bsdf::Bsdf;
use caustica_scene::bvh::Ray;
use caustica_scene::description::{
    Attribute, AttributeId, Domain, Geometry, LightKind, MaterialKind, Mesh, Texture,
};
use caustica_scene::{Description, Origin, Scene};
use caustica_testkit::build;
use caustica_testkit::materials::{attribute, mask, motley};

/// Two triangles, the first of which has no area, far from the origin.
const CORNERS: [[f32; 3]; 3] = [[40.0, 0.0, 3.0], [42.0, 0.5, 3.0], [40.5, 2.0, 4.0]];

fn mesh() -> Mesh {
    let positions = CORNERS.map(Vec3::from).to_vec();
    Mesh { positions, triangles: vec![[0, 1, 0], [0, 1, 2]], ..Mesh::default() }
}

fn description(domain: Domain, to_world: Transform) -> Description {
    let mut d = build::scene(8);
    let m = build::diffuse(&mut d, 0.5);
    let other = build::add(&mut d, "other", Geometry::Mesh(mesh()), m);
    let albedo = attribute(&mut d, other, domain, |_| Rgb::BLACK);
    let m = d.add_material(MaterialKind::Diffuse { albedo });
    let shape = build::add(&mut d, "mesh", Geometry::Mesh(mesh()), m);
    attribute(&mut d, shape, domain, motley);
    d.shapes[shape].to_world = to_world;
    d.shapes[shape].origin = Some(Origin { file: "a.xml".into(), line: 7, column: 3, span: None });
    d
}

/// What the mesh reflects, next to what it should, where a ray hits it that aims at those weights of its corners.
fn seen(scene: &Scene, to_world: &Transform, domain: Domain, [b, c]: [f32; 2]) -> (Rgb, Rgb) {
    let weights = [1.0 - b - c, b, c];
    let at = |i: usize| Vec3::from(CORNERS[i]) * weights[i];
    let target = to_world.point(at(0) + at(1) + at(2));
    let corners = CORNERS.map(|p| to_world.point(p.into()));
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    let direction = Vec3::new(0.2, 0.1, 0.0) - normal;
    let ray = Ray { origin: target - direction * 2.0, direction, t_max: f32::INFINITY };
    let point = scene.closest(&ray).expect("a hit");
    let Bsdf::Diffuse(found) = scene.bsdf(&point, Wavelengths::Rgb) else { panic!("not diffuse") };
    let expected = match domain {
        Domain::Face => motley(1),
        Domain::Vertex => motley(0) * weights[0] + motley(1) * weights[1] + motley(2) * weights[2],
    };
    (Wavelengths::Rgb.rgb(found.albedo), expected)
}

fn check(d: Description, to_world: &Transform, domain: Domain) {
    let scene = Scene::new(d).unwrap().0;
    let mut s = SampleStream::new(StreamId { seed: 3, pixel: 0, sample: 0, walk: 0 });
    for _ in 0..100 {
        let u = warp::uniform_triangle(s.next_2d()).map(|b| 0.02 + 0.94 * b);
        let (found, expected) = seen(&scene, to_world, domain, u);
        let off = (0..3).map(|i| (found.0[i] - expected.0[i]).abs()).fold(0.0, f32::max);
        assert!(off < 2e-4, "{domain:?} {u:?}: {found:?}, not {expected:?}");
    }
}

/// Mirrored meshes have their corners in another order.
#[test]
fn colours_lie_where_their_corners_are() {
    let place = Transform::rotate(30.0, [0.3, 1.0, -0.2]).then(Transform::translate([0.0, 100.0, 3.0]));
    for to_world in [place, Transform::scale([-1.0, 2.0, 1.0]).then(place)] {
        for domain in [Domain::Vertex, Domain::Face] {
            let d = description(domain, to_world);
            check(d.clone(), &to_world, domain);
            // With attributes of the same name in groups, and in none.
            let mut grouped = d.clone();
            grouped.shapes[1].to_world = Transform::scale([1.0, 3.0, 1.0]);
            let group = build::group(&mut grouped, 1);
            let placed = Transform::scale([1.0, 3.0, 1.0]).inverse().then(to_world);
            build::instance(&mut grouped, group, Transform::translate([0.0, -500.0, 0.0]));
            build::instance(&mut grouped, group, placed);
            check(grouped, &to_world, domain);
        }
    }
}

fn refused(change: impl FnOnce(&mut Description)) -> String {
    let mut d = description(Domain::Vertex, Transform::IDENTITY);
    change(&mut d);
    Scene::new(d).expect_err("it is refused").to_string()
}

fn attributes(d: &mut Description) -> &mut Vec<Attribute> {
    let Geometry::Mesh(mesh) = &mut d.shapes[1].geometry else { panic!("a mesh") };
    &mut mesh.attributes
}

#[track_caller]
fn refuses(message: &str, change: impl FnOnce(&mut Description)) {
    let found = refused(change);
    assert!(found.contains(message), "{found}");
}

#[test]
fn what_is_missing_or_wrong_is_told() {
    let at = "a.xml:7:3";
    refuses(at, |d| attributes(d).clear());
    refuses("mesh has no attribute `Vertex`, which its texture looks up", |d| attributes(d).clear());
    refuses("the mesh has `other`", |d| attributes(d)[0].name = "other".into());
    refuses("3 vertices but 2 values of the attribute `Vertex`", |d| attributes(d)[0].values.truncate(2));
    refuses("2 triangles but 3 values", |d| attributes(d)[0].domain = Domain::Face);
    refuses("whose value 2 is negative or not finite", |d| attributes(d)[0].values[1] = Rgb::splat(f32::NAN));
    refuses("whose value 1 is negative", |d| attributes(d)[0].values[0] = Rgb::splat(-1.0));
    refuses("is a sphere without the attribute", |d| {
        d.shapes[1].geometry = Geometry::Sphere { center: Vec3::ZERO, radius: 1.0 };
    });
    let texture = |attribute, scale| Texture::Attribute { attribute: AttributeId(attribute), scale };
    let none = texture(9, 1.0);
    refuses("names an image or an attribute that does not exist", |d| {
        d.add_material(MaterialKind::Diffuse { albedo: none });
    });
    refuses("an image or an attribute that does not exist", |d| d.shapes[1].emission = Some(none));
    refuses("a scale that is negative or not finite", |d| {
        d.add_material(MaterialKind::Diffuse { albedo: texture(0, -1.0) });
    });
    refuses("a lamp's picture is an attribute of a mesh", |d| {
        let (to_world, irradiance) = (Transform::IDENTITY, texture(0, 1.0));
        build::light(d, LightKind::Projector { to_world, irradiance, scale: 1.0, fov: 30.0, aspect: 1.0 });
    });
    refuses("lists an attribute twice", |d| d.attributes.push("Vertex".into()));
    // Also where it is a lamp's, a beam's, or inside of another material.
    refuses("no attribute `x`", |d| {
        let attribute = d.add_attribute("x");
        d.shapes[1].emission = Some(Texture::Attribute { attribute, scale: 1.0 });
    });
    refuses("no attribute `x`", |d| {
        let exitance = Texture::Attribute { attribute: d.add_attribute("x"), scale: 1.0 };
        build::light(d, LightKind::Collimated { shape: 1, exitance });
    });
    refuses("no attribute `x`", |d| {
        let opacity = Texture::Attribute { attribute: d.add_attribute("x"), scale: 1.0 };
        let inner = d.shapes[1].material;
        d.shapes[1].material = mask(d, opacity, inner);
    });
    refuses("mesh has no attribute", |d| {
        attributes(d).clear();
        let group = build::group(d, 1);
        build::instance(d, group, Transform::IDENTITY);
    });
}

/// What nobody looks up may be anything.
#[test]
fn other_attributes_do_not_matter() {
    let mut d = description(Domain::Vertex, Transform::IDENTITY);
    let before = Scene::new(d.clone()).unwrap().0.surfaces().memory();
    let values = vec![Rgb::splat(f32::NAN); 1000];
    attributes(&mut d).push(Attribute { name: "wild".into(), domain: Domain::Face, values });
    let after = Scene::new(d).unwrap().0.surfaces().memory();
    assert_eq!(after, before);
}
