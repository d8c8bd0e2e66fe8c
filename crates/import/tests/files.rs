//! Scene files and the files that they name.

use std::fs;

use caustica_import::load;
use caustica_scene::description::Geometry;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

fn scene(inner: &str) -> String {
    format!("<scene><camera type='perspective'/><integrator type='path'/>\n{inner}</scene>")
}

#[test]
fn paths_start_at_the_folder_of_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("meshes")).unwrap();
    fs::write(folder.path().join("meshes/tri.obj"), TRIANGLE).unwrap();
    let mesh = "<mesh type='obj'><string name='filename' value='meshes/tri.obj'/></mesh>";
    fs::write(folder.path().join("s.xml"), scene(&format!("{mesh}{mesh}"))).unwrap();
    let loaded = load(&folder.path().join("s.xml")).unwrap();
    assert_eq!(loaded.warnings, []);
    let shapes = loaded.scene.unwrap().shapes;
    assert_eq!(shapes[0].name, "tri.obj");
    assert_eq!(shapes[0].geometry, shapes[1].geometry);
    let Geometry::Mesh(mesh) = &shapes[1].geometry else { panic!() };
    assert_eq!(mesh.triangles.len(), 1);
}

#[test]
fn mistakes_in_a_mesh_are_placed_in_it() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("bad.obj"), "v 0 0 0\nv 1 x 0\n").unwrap();
    let mesh = "<mesh type='obj'><string name='filename' value='bad.obj'/></mesh>";
    fs::write(folder.path().join("s.xml"), scene(mesh)).unwrap();
    let origin = load(&folder.path().join("s.xml")).unwrap_err().origin.unwrap();
    assert!(origin.file.ends_with("bad.obj"));
    assert_eq!((origin.line, origin.column), (2, 5));
}

#[test]
fn warnings_about_a_mesh_come_once() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("m.obj"), format!("{TRIANGLE}f 1 1 1\n")).unwrap();
    let mesh = "<mesh type='obj'><string name='filename' value='m.obj'/></mesh>";
    fs::write(folder.path().join("s.xml"), scene(&format!("{mesh}{mesh}"))).unwrap();
    assert_eq!(load(&folder.path().join("s.xml")).unwrap().warnings.len(), 1);
}

#[test]
fn scene_files_that_are_none() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.xml");
    let error = load(&path).unwrap_err();
    assert!(error.message.contains("there is no such file"), "{error}");
    let error = load(folder.path()).unwrap_err();
    assert!(error.message.contains("not a regular file"), "{error}");
    fs::write(&path, b"<scene>\n  <\xC3\xA9\xFF").unwrap();
    let error = load(&path).unwrap_err();
    let origin = error.origin.clone().unwrap();
    assert!(error.message.contains("not UTF-8"), "{error}");
    assert_eq!((origin.line, origin.column), (2, 5));
    fs::write(&path, vec![b' '; (64 << 20) + 1]).unwrap();
    let error = load(&path).unwrap_err();
    assert!(error.message.contains("larger than 64 MiB"), "{error}");
}
