//! Which side of a surface is outside, and what is told about its points.

use std::f32::consts::PI;

use caustica_math::{Transform, Vec2, Vec3, elementary, warp};
use caustica_scene::bvh::Ray;
use caustica_scene::description::{Geometry, Mesh, Shape, Texture};
use caustica_scene::surface::{SurfacePoint, Surfaces};
use caustica_scene::{Description, Diagnostic, Origin, Scene};
use caustica_testkit::build;

fn shape(geometry: Geometry, to_world: Transform) -> Shape {
    let origin = Some(Origin { file: "a.xml".into(), line: 7, column: 3, span: None });
    Shape {
        name: "thing".into(),
        geometry,
        to_world,
        material: caustica_scene::description::MaterialId(0),
        emission: None,
        origin,
    }
}

fn flatten(geometry: Geometry, to_world: Transform) -> Result<(Surfaces, Vec<Diagnostic>), Diagnostic> {
    let mut warnings = vec![];
    Surfaces::new(&mut [shape(geometry, to_world)], &mut warnings).map(|s| (s, warnings))
}

fn mesh(mesh: Mesh, to_world: Transform) -> Surfaces {
    flatten(Geometry::Mesh(mesh), to_world).unwrap().0
}

fn refused(geometry: Geometry, to_world: Transform) -> String {
    flatten(geometry, to_world).expect_err("it is refused").to_string()
}

/// A triangle in the plane z = 0 whose winding points along +z.
fn triangle() -> Mesh {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    Mesh { positions, triangles: vec![[0, 1, 2]], ..Mesh::default() }
}

fn tetrahedron() -> Mesh {
    Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z],
        triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        ..Mesh::default()
    }
}

fn middle(s: &Surfaces) -> SurfacePoint {
    s.triangle_point(0, 1.0 / 3.0, 1.0 / 3.0)
}

fn with_normals(mut m: Mesh, normals: [[f32; 3]; 3]) -> Mesh {
    m.normals = normals.map(Vec3::from).to_vec();
    m
}

#[test]
fn the_normal_follows_the_winding() {
    assert_eq!(middle(&mesh(triangle(), Transform::IDENTITY)).normal, Vec3::Z);
    let mut reversed = triangle();
    reversed.triangles = vec![[0, 2, 1]];
    assert_eq!(middle(&mesh(reversed, Transform::IDENTITY)).normal, -Vec3::Z);
    let turned = Transform::rotate(90.0, [0.0, 1.0, 0.0]);
    assert!((middle(&mesh(triangle(), turned)).normal - Vec3::X).length() < 1e-6);
}

/// Outside stays outside under every combination of mirrors, with and without vertex normals.
#[test]
fn mirrors_keep_outside_outside() {
    let signs = [1.0, -2.0];
    for (x, y, z) in signs.iter().flat_map(|x| signs.iter().flat_map(move |y| signs.map(|z| (*x, *y, z)))) {
        let place = Transform::rotate(30.0, [1.0, 1.0, 0.0]).then(Transform::translate([5.0, 0.0, 0.0]));
        let to_world = Transform::scale([x, y, z]).then(place);
        let center = to_world.point(Vec3::splat(0.2));
        let mut smooth = tetrahedron();
        smooth.normals = smooth.positions.iter().map(|p| *p - Vec3::splat(0.2)).collect();
        for m in [tetrahedron(), smooth] {
            let s = mesh(m, to_world);
            for t in 0..4 {
                let p = s.triangle_point(t, 0.3, 0.3);
                assert!(p.normal.dot(p.position - center) > 0.0, "({x}, {y}, {z}), triangle {t}");
                assert!(p.frame.z.dot(p.normal) > 0.0);
            }
            assert!(!s.has_border(0), "({x}, {y}, {z})");
        }
    }
}

#[test]
fn a_triangle_is_turned_only_if_all_normals_oppose() {
    let down = [0.1, 0.0, -1.0];
    let up = [0.0, 0.1, 1.0];
    let normal = |n: [[f32; 3]; 3]| {
        let p = middle(&mesh(with_normals(triangle(), n), Transform::IDENTITY));
        (p.normal, p.frame.z)
    };
    let (n, shading) = normal([down; 3]);
    assert_eq!(n, -Vec3::Z);
    assert!((shading - Vec3::from(down).normalized()).length() < 1e-6);
    for mixed in [[up, down, down], [down, up, down], [down, down, up], [up, up, down], [up; 3]] {
        let (n, shading) = normal(mixed);
        assert!(n == Vec3::Z && shading.z > 0.0, "{mixed:?}");
    }
    // Corners and what belongs to them turn together.
    let mut m = with_normals(triangle(), [down; 3]);
    m.uvs = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| Vec2::new(x, y)).to_vec();
    let s = mesh(m, Transform::IDENTITY);
    let p = s.triangle_point(0, 0.2, 0.5);
    assert!((p.uv.x - p.position.x).abs() < 1e-6 && (p.uv.y - p.position.y).abs() < 1e-6, "{p:?}");
}

#[test]
fn useless_normals_fall_back_to_the_geometry() {
    let nan = f32::NAN;
    for bad in [[0.0; 3], [nan, 0.0, 1.0], [0.0, 0.0, f32::INFINITY]] {
        let p = middle(&mesh(with_normals(triangle(), [bad; 3]), Transform::IDENTITY));
        assert!(p.normal == Vec3::Z && p.frame.z == Vec3::Z, "{bad:?}: {p:?}");
        // One that is good decides alone.
        let one = with_normals(triangle(), [bad, [0.6, 0.0, 0.8], bad]);
        let p = middle(&mesh(one, Transform::IDENTITY));
        assert!((p.frame.z - Vec3::new(0.6, 0.0, 0.8)).length() < 1e-6, "{bad:?}: {p:?}");
    }
    let cancelling = [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
    let p = mesh(with_normals(triangle(), cancelling), Transform::IDENTITY).triangle_point(0, 0.5, 0.0);
    assert_eq!(p.frame.z, Vec3::Z);
}

#[test]
fn attributes_are_interpolated() {
    let mut m = with_normals(triangle(), [[0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [0.0, 0.6, 0.8]]);
    m.uvs = [[1.0, 2.0], [3.0, 5.0], [-1.0, 0.0]].map(|[x, y]| Vec2::new(x, y)).to_vec();
    // A normal is not carried along like a vector: the plane is stretched sixfold along x.
    let s = mesh(m, Transform::scale([6.0, 1.0, 1.0]));
    let p = s.triangle_point(0, 0.5, 0.25);
    assert!((p.position - Vec3::new(3.0, 0.25, 0.0)).length() < 1e-6);
    assert!((p.uv - Vec2::new(1.5, 3.0)).x.abs() < 1e-6 && (p.uv.y - 3.0).abs() < 1e-6);
    let carried = [Vec3::Z, Vec3::new(0.1, 0.0, 0.8).normalized(), Vec3::new(0.0, 0.6, 0.8)];
    let expected = (carried[0] * 0.25 + carried[1] * 0.5 + carried[2] * 0.25).normalized();
    assert!((p.frame.z - expected).length() < 1e-6, "{:?} {expected:?}", p.frame.z);
    assert_eq!(p.normal, Vec3::Z);
    let plain = mesh(triangle(), Transform::IDENTITY).triangle_point(0, 0.5, 0.25);
    assert_eq!(plain.uv, Vec2::new(0.5, 0.25), "without coordinates of its own, the barycentric ones");
}

/// ½ + atan2(y, x)/2π and ½ + asin(z)/π of the normal in the sphere's own frame, wherever that is turned to;
/// sampled and hit points agree. Without a texture nothing asks for them.
#[test]
fn spheres_have_longitude_and_latitude() {
    let to_world = Transform::scale([2.0, -2.0, 2.0])
        .then(Transform::rotate(70.0, [1.0, 2.0, 3.0]))
        .then(Transform::translate([1.0, -4.0, 2.0]));
    let scene = |texture: Texture| {
        let mut d = Description::default();
        let m = build::diffuse(&mut d, 0.5);
        let s = build::sphere(&mut d, [0.5, 0.0, 0.0], 1.5, m);
        d.shapes[s].to_world = to_world;
        d.shapes[s].emission = Some(texture);
        Scene::new(d).unwrap().0
    };
    let one = caustica_math::Rgb::WHITE;
    let checkers =
        Texture::Checkerboard { delta: [0.0; 2], scale: [0.1; 2], shear: [0.0; 2], value1: one, value2: one };
    let (textured, plain) = (scene(checkers), scene(one.into()));
    let center = to_world.point(Vec3::new(0.5, 0.0, 0.0));
    for i in 0..200 {
        let own = warp::uniform_sphere([(i as f32 + 0.5) / 200.0, (i as f32 * 0.618).fract()]);
        let normal = to_world.normal(own).normalized();
        let uv =
            Vec2::new(0.5 + elementary::atan2(own.y, own.x) / (2.0 * PI), 0.5 + elementary::asin(own.z) / PI);
        let ray = Ray { origin: center + normal * 9.0, direction: -normal, t_max: f32::INFINITY };
        let (sampled, hit) = (textured.surfaces().sphere_point(0, normal), textured.closest(&ray).unwrap());
        for p in [sampled, hit] {
            assert!((p.uv.x - uv.x).abs() < 2e-5 && (p.uv.y - uv.y).abs() < 2e-5, "{:?} {uv:?}", p.uv);
            assert!((p.normal - normal).length() < 2e-6 && p.frame.z == p.normal);
            assert!(((p.position - center).length() - 3.0).abs() < 1e-5);
        }
        assert_eq!(plain.closest(&ray).unwrap().uv, Vec2::default());
    }
}

#[test]
fn spheres_stay_spheres() {
    let sphere = |radius: f32| Geometry::Sphere { center: Vec3::ZERO, radius };
    let message = refused(sphere(1.0), Transform::scale([1.0, 1.0, 1.001]));
    assert!(message.starts_with("a.xml:7:3: thing is a sphere that its transform stretches"), "{message}");
    for bad in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let message = refused(sphere(bad), Transform::IDENTITY);
        assert!(
            message.contains(&format!("thing is a sphere whose radius, {bad}, is not a positive number")),
            "{message}"
        );
    }
    for (bad, why) in [(f32::NAN, "not finite"), (f32::INFINITY, "not finite"), (1e30, "farther than 1e15")] {
        let center = Vec3::new(0.0, bad, 0.0);
        let message = refused(Geometry::Sphere { center, radius: 1.0 }, Transform::IDENTITY);
        assert!(message.contains(&format!("thing is a sphere whose centre is {why}")), "{message}");
    }
    let (s, _) = flatten(sphere(2.0), Transform::scale([-3.0; 3])).unwrap();
    assert_eq!(s.sphere(0).unwrap().radius, 6.0);
}

#[test]
fn bad_meshes_are_refused_by_name_and_place() {
    for (bad, why) in [(f32::NAN, "not finite"), (f32::INFINITY, "not finite"), (1e20, "farther than 1e15")] {
        let mut m = triangle();
        m.positions[1].y = bad;
        let message = refused(Geometry::Mesh(m), Transform::IDENTITY);
        let begin = format!("a.xml:7:3: thing has a vertex (number 2) that is {why}");
        assert!(message.starts_with(&begin), "{message}");
    }
    let mut m = triangle();
    m.triangles.push([0, 1, 3]);
    let message = refused(Geometry::Mesh(m), Transform::IDENTITY);
    assert!(
        message.contains("thing has a triangle whose corner 3 does not exist (its corners are 0 to 2)"),
        "{message}"
    );
    let mut m = triangle();
    m.normals = vec![Vec3::Z; 2];
    let message = refused(Geometry::Mesh(m.clone()), Transform::IDENTITY);
    assert!(message.contains("thing has 3 vertices but 2 normals"), "{message}");
    m.normals.clear();
    m.uvs = vec![Vec2::default(); 4];
    let message = refused(Geometry::Mesh(m), Transform::IDENTITY);
    assert!(message.contains("thing has 3 vertices but 4 texture coordinates"), "{message}");
    for flat in [Transform::scale([1.0, 0.0, 1.0]), Transform::scale([f64::NAN, 1.0, 1.0])] {
        let message = refused(Geometry::Mesh(triangle()), flat);
        assert!(message.contains("thing has a transform that cannot be inverted"), "{message}");
    }
}

#[test]
fn triangles_without_area_are_left_out() {
    let mut m = triangle();
    m.positions.push(Vec3::X * 0.5);
    m.triangles = vec![[0, 0, 1], [0, 1, 3], [0, 1, 2], [2, 2, 2]];
    let (s, warnings) = flatten(Geometry::Mesh(m.clone()), Transform::IDENTITY).unwrap();
    assert_eq!(s.triangles(), [[0, 1, 2]]);
    assert_eq!(warnings.len(), 1);
    let message = warnings[0].to_string();
    assert!(message.starts_with("a.xml:7:3: thing: left out 3 triangles without an area"), "{message}");
    m.triangles.remove(2);
    let message = refused(Geometry::Mesh(m), Transform::IDENTITY);
    assert!(message.contains("thing has no triangle with an area"), "{message}");
    let message = refused(Geometry::Mesh(Mesh::default()), Transform::IDENTITY);
    assert!(message.contains("thing has no triangle with an area"), "{message}");
}

#[test]
fn borders_are_found() {
    let has_border = |m| mesh(m, Transform::IDENTITY).has_border(0);
    assert!(has_border(triangle()));
    assert!(!has_border(tetrahedron()));
    let mut open = tetrahedron();
    open.triangles.pop();
    assert!(has_border(open));
    // Corners of their own for every triangle, and a zero of the other sign.
    let whole = tetrahedron();
    let mut torn = Mesh::default();
    for t in &whole.triangles {
        let first = torn.positions.len() as u32;
        torn.positions.extend(t.map(|c| whole.positions[c as usize]));
        torn.triangles.push([first, first + 1, first + 2]);
    }
    torn.positions[0] = Vec3::new(-0.0, 0.0, -0.0);
    assert!(!has_border(torn.clone()));
    torn.positions[0].x = 1e-6;
    assert!(has_border(torn));
    let mut reversed = tetrahedron();
    reversed.triangles[2].swap(0, 1);
    assert!(has_border(reversed), "one triangle faces the other way");
    let mut both = tetrahedron();
    both.triangles.extend(tetrahedron().triangles);
    assert!(!has_border(both), "twice closed is closed");
    let (ball, _) =
        flatten(Geometry::Sphere { center: Vec3::ZERO, radius: 1.0 }, Transform::IDENTITY).unwrap();
    assert!(!ball.has_border(0));
}

/// Shapes find their own primitives when meshes and spheres alternate.
#[test]
fn primitives_know_their_shapes() {
    let sphere = || Geometry::Sphere { center: Vec3::ZERO, radius: 1.0 };
    let geometries = [sphere(), Geometry::Mesh(triangle()), sphere(), Geometry::Mesh(tetrahedron())];
    let mut shapes = geometries.map(|g| shape(g, Transform::IDENTITY));
    let s = Surfaces::new(&mut shapes, &mut vec![]).unwrap();
    let owners: Vec<u32> = (0..7).map(|p| s.shape_of(p)).collect();
    assert_eq!(owners, [1, 3, 3, 3, 3, 0, 2]);
    for (i, flat) in s.shapes.iter().enumerate() {
        assert!((0..flat.primitive_count).all(|p| s.shape_of(flat.first_primitive + p) == i as u32));
        assert_eq!(s.sphere(flat.first_primitive).is_some(), i % 2 == 0);
    }
    let [a, _, _] = s.corners(2);
    assert_eq!(a, Vec3::ZERO);
    assert_eq!(s.triangle_point(1, 0.2, 0.3).shape, 3);
    assert_eq!(s.sphere_point(6, Vec3::X).shape, 2);
}
