//! Shapes of Mitsuba's scenes: groups and instances, files, and which way surfaces face.

use std::io::Write;

use crate::common::{good, refused, warned};
use caustica_import::parse_mitsuba;
use caustica_math::{Transform, Vec3};
use caustica_scene::bvh::Ray;
use caustica_scene::description::{Geometry, GroupId, Mesh};
use caustica_scene::{Description, Scene};
use flate2::Compression;
use flate2::write::ZlibEncoder;

fn scene(inner: &str) -> String {
    format!("<scene version='3.0.0'><sensor type='perspective'/>{inner}</scene>")
}

/// What a ray hits of a scene with that shape: normal and texture coordinates as Mitsuba has them, if there is a
/// texture.
fn seen(shape: &str, origin: [f32; 3], direction: [f32; 3]) -> ([f32; 3], [f32; 2]) {
    let lit = scene(&format!("<emitter type='constant'/>{shape}"));
    let mut d = good(&lit);
    let checks = caustica_scene::description::Texture::Checkerboard {
        delta: [0.0; 2],
        shear: [0.0; 2],
        scale: [1.0; 2],
        value1: caustica_math::Rgb::BLACK,
        value2: caustica_math::Rgb::BLACK,
    };
    d.materials[0].kind = caustica_scene::description::MaterialKind::Diffuse { albedo: checks };
    let scene = Scene::new(d).unwrap().0;
    let ray = Ray { origin: origin.into(), direction: direction.into(), t_max: f32::INFINITY };
    let p = scene.closest(&ray).expect("a hit");
    (p.frame.z.to_array(), [p.uv.x, 1.0 - p.uv.y])
}

fn near<const N: usize>(a: [f32; N], b: [f32; N], what: &str) {
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 2e-3), "{what}: {a:?}, not {b:?}");
}

const MIRROR: &str = "<transform name='to_world'><scale x='1' y='-1' z='1'/></transform>";
const FLIP: &str = "<boolean name='flip_normals' value='true'/>";

/// Normals and texture coordinates as Mitsuba 3.9 tells them.
#[test]
fn normals_and_texture_coordinates_are_mitsuba_s() {
    let down = ([0.5, 0.2, 5.0], [0.0, 0.0, -1.0]);
    let side = ([5.0, 0.2, 0.5], [-1.0, 0.0, 0.0]);
    let tube =
        "<point name='p0' value='0 0 1'/><point name='p1' value='0 0 -1'/><float name='radius' value='.5'/>";
    for (plugin, inner, (origin, direction), normal, uv) in [
        ("disk", "", down, [0.0, 0.0, 1.0], [0.5385, 0.0606]),
        ("disk", FLIP, down, [0.0, 0.0, -1.0], [0.5385, 0.0606]),
        ("disk", MIRROR, down, [0.0, 0.0, 1.0], [0.5385, 0.9394]),
        ("rectangle", MIRROR, down, [0.0, 0.0, -1.0], [0.75, 0.4]),
        ("cube", MIRROR, ([0.3, 0.2, 5.0], [0.0, 0.0, -1.0]), [0.0, 0.0, 1.0], [0.4, 0.65]),
        ("cylinder", "", side, [0.9798, 0.2, 0.0], [0.0320, 0.5]),
        ("cylinder", FLIP, side, [-0.9798, -0.2, 0.0], [0.0320, 0.5]),
        ("cylinder", MIRROR, side, [0.9798, 0.2, 0.0], [0.9680, 0.5]),
        ("cylinder", tube, side, [0.9165, 0.4, 0.0], [0.9345, 0.25]),
        ("sphere", "", side, [0.8426, 0.2, 0.5], [0.0371, 0.3333]),
        ("sphere", FLIP, side, [-0.8426, -0.2, -0.5], [0.0371, 0.3333]),
        ("sphere", MIRROR, side, [-0.8426, -0.2, -0.5], [0.9629, 0.3333]),
    ] {
        let what = format!("{plugin} {inner}");
        let found = seen(&format!("<shape type='{plugin}'>{inner}</shape>"), origin, direction);
        near(found.0, normal, &what);
        near(found.1, uv, &what);
    }
}

/// By the winding a mirrored mesh is inside out; normals of its own keep it as it is. (So does Mitsuba.)
#[test]
fn mirrored_meshes() {
    let folder = tempfile::tempdir().unwrap();
    let corners = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";
    std::fs::write(folder.path().join("plain.obj"), format!("{corners}f 1 2 3 4\n")).unwrap();
    let own = format!("{corners}vn 0 0 1\nf 1//1 2//1 3//1 4//1\n");
    std::fs::write(folder.path().join("own.obj"), own).unwrap();
    for (file, faces, mirror, up) in [
        ("plain", "false", "", true),
        ("plain", "false", MIRROR, false),
        ("plain", "true", MIRROR, false),
        ("own", "false", MIRROR, true),
        ("own", "true", MIRROR, false),
    ] {
        let shape = format!(
            "<shape type='obj'><string name='filename' value='{file}.obj'/>\
             <boolean name='face_normals' value='{faces}'/>{mirror}</shape>"
        );
        let d = parse_mitsuba(&scene(&shape), "s.xml", folder.path(), &[]).unwrap().scene.unwrap();
        let ray = Ray { origin: Vec3::new(0.2, 0.3, 5.0), direction: -Vec3::Z, t_max: f32::INFINITY };
        let p = Scene::new(d).unwrap().0.closest(&ray).unwrap();
        assert_eq!((p.normal.z > 0.0, p.frame.z.z > 0.0), (up, up), "{file} {faces} {mirror}");
    }
}

/// Colours of corners and of faces reach materials and lamps; what has none is told where it stands.
#[test]
fn mesh_attributes() {
    let folder = tempfile::tempdir().unwrap();
    let head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n\
        property list uchar int vertex_indices\nproperty float heat_1\nend_header\n";
    let rows = "0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2 0.25\n";
    std::fs::write(folder.path().join("m.ply"), format!("{head}{rows}")).unwrap();
    let read = |inner: &str| {
        let mesh = format!("<shape type='ply'><string name='filename' value='m.ply'/>{inner}</shape>");
        parse_mitsuba(&scene(&mesh), "s.xml", folder.path(), &[]).unwrap()
    };
    let texture = |slot: &str, name: &str| {
        format!(
            "<texture type='mesh_attribute' name='{slot}'><string name='name' value='{name}'/>\
             <float name='scale' value='.5'/></texture>"
        )
    };
    let seen = |name: &str| {
        let read = read(&format!("<bsdf type='diffuse'>{}</bsdf>", texture("reflectance", name)));
        assert_eq!(read.warnings, []);
        let scene = Scene::new(read.scene.unwrap()).map_err(|e| e.to_string())?.0;
        let ray = Ray { origin: Vec3::new(0.25, 0.5, 5.0), direction: -Vec3::Z, t_max: f32::INFINITY };
        let rgb = caustica_math::Wavelengths::Rgb;
        match scene.bsdf(&scene.closest(&ray).unwrap(), rgb) {
            caustica_scene::bsdf::Bsdf::Diffuse(found) => Ok(rgb.rgb(found.albedo).0),
            other => Err(format!("{other:?}")),
        }
    };
    near(seen("vertex_color").unwrap(), [0.125, 0.125, 0.25], "corners");
    near(seen("face_heat").unwrap(), [0.125; 3], "faces");
    let missing = seen("vertex_heat").unwrap_err();
    let hint = "the mesh has `vertex_color`, `face_heat`";
    assert!(missing.contains("m.ply has no attribute `vertex_heat`") && missing.contains(hint), "{missing}");

    let lamp = read(&format!("<emitter type='area'>{}</emitter>", texture("radiance", "vertex_color")));
    let d = lamp.scene.unwrap();
    assert!(matches!(d.shapes[0].emission, Some(caustica_scene::description::Texture::Attribute { .. })));
    Scene::new(d).unwrap();

    let named = |inner: &str| {
        scene(&format!(
            "<shape type='cube'><bsdf type='diffuse'>§<texture type='mesh_attribute' \
            name='reflectance'>{inner}</texture></bsdf></shape>"
        ))
    };
    refused(&named(""), "needs the string `name`");
    let other = named("<string name='name' value='§color'/>").replacen('§', "", 1);
    refused(&other, "the attribute `color` is neither of vertices nor of faces");
    let both = texture("intensity", "vertex_color");
    refused(&scene(&format!("§<emitter type='point'>{both}</emitter>")), "cannot be a `mesh_attribute`");
}

const GROUP: &str = "<shape type='shapegroup' id='g'><shape type='cube'><transform name='to_world'>\
    <scale value='.5'/></transform></shape><shape type='sphere' id='ball'/></shape>";

#[test]
fn groups_are_made_once() {
    let place = "<transform name='to_world'><translate x='3'/></transform>";
    let d = good(&scene(&format!(
        "<shape type='instance'>{place}<ref id='g'/></shape>{GROUP}<shape type='rectangle'/>\
         <shape type='instance' id='second'><ref id='g'/></shape>"
    )));
    assert_eq!((d.shapes.len(), d.groups.len(), d.instances.len()), (1, 1, 2));
    let group = &d.groups[0];
    assert_eq!((group.name.as_str(), group.shapes[1].name.as_str()), ("g", "ball"));
    assert_eq!(group.shapes[0].to_world.point(Vec3::X), Vec3::X * 0.5);
    assert!(d.instances.iter().all(|i| i.group == GroupId(0)));
    assert_eq!(d.instances[0].to_world, Transform::translate([3.0, 0.0, 0.0]));
    let inline = "<shape type='instance'><shape type='shapegroup'><shape type='disk'/></shape></shape>";
    assert_eq!(good(&scene(inline)).groups[0].shapes.len(), 1);
}

#[test]
fn what_instances_cannot_be() {
    let with = |inner: &str| scene(&format!("{GROUP}{inner}"));
    refused(&with("§<shape type='instance'/>"), "names no shapegroup");
    refused(
        &with("<shape type='instance'>§<shape type='cube'/></shape>"),
        "shows a shapegroup, but this is a shape `cube`",
    );
    refused(&with("<shape type='instance'><ref id='g'/><ref id='§g'/></shape>"), "shows one shapegroup");
    let nested = "<shape type='shapegroup'>§<shape type='instance'><ref id='g'/></shape></shape>";
    refused(&with(nested), "holds no instances");
    let lamp = "<shape type='shapegroup'>§<shape type='cube'><emitter type='area'/></shape></shape>";
    refused(&with(lamp), "stands in a shapegroup");
    refused(&with(&lamp.replace("'area'", "'directionalarea'")), "stands in a shapegroup");
    let meter =
        "<shape type='shapegroup'>§<shape type='cube'><sensor type='irradiancemeter'/></shape></shape>";
    refused(&with(meter), "with its sensor");
    let empty = "<shape type='§shapegroup' id='e'/><shape type='instance'><ref id='e'/></shape>";
    let d: Description = warned(&with(empty), "has no shapes");
    assert!(d.instances.is_empty());
    let moved = "<shape type='shapegroup'>§<transform name='to_world'/><shape type='cube'/></shape>";
    warned(&with(moved), "says nothing");
}

/// A file of two squares, the second one at z = 1.
fn serialized() -> Vec<u8> {
    let (mut bytes, mut places) = (Vec::new(), Vec::new());
    for height in [0.0_f32, 1.0] {
        places.extend((bytes.len() as u64).to_le_bytes());
        bytes.extend([0x1C, 0x04, 4, 0]);
        let mut b = vec![2, 0x10, 0, 0, b'a', 0];
        b.extend([4_u64, 2].iter().flat_map(|n| n.to_le_bytes()));
        let corners = [[0.0_f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        corners.iter().for_each(|[x, y]| b.extend([*x, *y, height].iter().flat_map(|c| c.to_le_bytes())));
        corners.iter().for_each(|uv| b.extend(uv.iter().flat_map(|c| c.to_le_bytes())));
        b.extend([0_u32, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
        let mut encoder = ZlibEncoder::new(&mut bytes, Compression::default());
        encoder.write_all(&b).unwrap();
        encoder.finish().unwrap();
    }
    bytes.extend(places);
    bytes.extend(2_u32.to_le_bytes());
    bytes
}

#[test]
fn serialized_meshes() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("m.serialized"), serialized()).unwrap();
    let shape = |inner: &str| {
        format!("<shape type='serialized'><string name='filename' value='m.serialized'/>{inner}</shape>")
    };
    let read = |text: String| parse_mitsuba(&scene(&text), "s.xml", folder.path(), &[]);
    let index = |i: u32| shape(&format!("<integer name='shape_index' value='{i}'/>"));
    let loaded = read(shape("") + &index(1) + &shape("")).unwrap();
    assert_eq!(loaded.warnings, []);
    let d = loaded.scene.unwrap();
    let mesh = |i: usize| -> &Mesh {
        let Geometry::Mesh(mesh) = &d.shapes[i].geometry else { panic!() };
        mesh
    };
    assert_eq!([0, 1, 2].map(|i| mesh(i).positions[2].z), [0.0, 1.0, 0.0]);
    // v runs down here, and normals are made where there are none.
    assert_eq!(mesh(0).uvs[2].y, 0.0);
    assert!(mesh(1).normals.iter().all(|n| *n == Vec3::Z));
    let error = read(index(2)).unwrap_err();
    assert!(error.to_string().contains("no mesh of number 2") && error.origin.is_some(), "{error}");
}
