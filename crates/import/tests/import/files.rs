//! Scene files and the files that they name.

use std::fs;

use caustica_import::{Provision, Trust, load, load_with};
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

/// A folder with `outside.obj` and `secret/in.obj`, and beside them `scene/` with `in.obj` and `sub/in.obj`.
fn two_folders() -> tempfile::TempDir {
    let root = tempfile::tempdir().unwrap();
    for folder in ["scene/sub", "secret"] {
        fs::create_dir_all(root.path().join(folder)).unwrap();
    }
    for file in ["outside.obj", "secret/in.obj", "scene/in.obj", "scene/sub/in.obj"] {
        fs::write(root.path().join(file), TRIANGLE).unwrap();
    }
    root
}

/// What comes of a scene in `scene/` that names `file`, on line 2.
fn naming(root: &tempfile::TempDir, file: &str, trust: Trust) -> Result<(), caustica_scene::Diagnostic> {
    let path = root.path().join("scene/s.xml");
    fs::write(&path, scene(&format!("<mesh type='obj'><string name='filename' value='{file}'/></mesh>")))
        .unwrap();
    load_with(&path, &Provision { trust, variables: &[] })
        .map(|loaded| assert_eq!(loaded.scene.unwrap().shapes.len(), 1))
}

#[test]
fn trusted_scenes_name_files_anywhere() {
    let root = two_folders();
    let absolute = root.path().join("outside.obj").display().to_string();
    for file in ["in.obj", "sub/in.obj", "../outside.obj", "../secret/in.obj", &absolute] {
        naming(&root, file, Trust::Full).unwrap();
    }
}

#[test]
fn untrusted_scenes_name_files_of_their_own_folder() {
    let root = two_folders();
    for file in ["in.obj", "./in.obj", "sub/in.obj", "sub/../in.obj", "sub/./../sub/in.obj"] {
        naming(&root, file, Trust::OwnFolder).unwrap();
    }
    let absolute = root.path().join("scene/in.obj").display().to_string();
    // What does not exist is refused by the same words as what does.
    let outside =
        ["../outside.obj", "../nothing.obj", "sub/../../outside.obj", "/nothing.obj", &absolute, "..", "/"];
    for file in outside {
        let error = naming(&root, file, Trust::OwnFolder).unwrap_err();
        assert!(error.message.contains("outside of the scene's folder"), "{file}: {error}");
        assert!(error.message.contains(&format!("the mesh `{file}`")) || file.len() > 30, "{file}: {error}");
        let origin = error.origin.unwrap();
        assert_eq!((origin.line, origin.column), (2, 49), "{file}");
        assert!(origin.file.ends_with("s.xml"));
    }
    let error = naming(&root, "nothing.obj", Trust::OwnFolder).unwrap_err();
    assert!(error.message.contains("there is no such file"), "{error}");
    assert!(error.origin.is_some());
}

#[test]
fn untrusted_scenes_name_no_images_elsewhere() {
    let root = two_folders();
    let path = root.path().join("scene/s.xml");
    let sky = "<emitter type='envmap'><string name='filename' value='../sky.png'/></emitter>";
    fs::write(&path, scene(sky)).unwrap();
    let error = load_with(&path, &Provision { trust: Trust::OwnFolder, variables: &[] }).unwrap_err();
    assert!(error.message.contains("the image `../sky.png`") && error.message.contains("outside"), "{error}");
}

#[test]
fn untrusted_mitsuba_scenes_stay_in_their_folder_too() {
    let root = two_folders();
    fs::write(root.path().join("inner.xml"), "<scene version='3.0.0'/>").unwrap();
    fs::write(root.path().join("scene/inner.xml"), "<scene version='3.0.0'/>").unwrap();
    let path = root.path().join("scene/s.xml");
    let mesh = |name: &str| format!("<shape type='obj'><string name='filename' value='{name}'/></shape>");
    let load = |content: &str, trust| {
        fs::write(&path, format!("<scene version='3.0.0'><sensor type='perspective'/>\n{content}\n</scene>"))
            .unwrap();
        load_with(&path, &Provision { trust, variables: &[] })
    };
    for content in [
        "<include filename='../inner.xml'/>".to_owned(),
        "<path value='..'/>".to_owned(),
        mesh("../outside.obj"),
        format!("<path value='sub'/>{}", mesh("../../outside.obj")),
        "<emitter type='envmap'><string name='filename' value='../sky.exr'/></emitter>".to_owned(),
    ] {
        let error = load(&content, Trust::OwnFolder).unwrap_err();
        assert!(error.message.contains("outside of the scene's folder"), "{content}: {error}");
        assert_eq!(error.origin.unwrap().line, 2, "{content}");
    }
    for content in
        ["<include filename='inner.xml'/>".to_owned(), format!("<path value='sub'/>{}", mesh("in.obj"))]
    {
        load(&content, Trust::OwnFolder).unwrap();
    }
    load(&mesh("../outside.obj"), Trust::Full).unwrap();
}

#[cfg(unix)]
#[test]
fn untrusted_scenes_follow_no_links_out_of_their_folder() {
    use std::os::unix::fs::symlink;
    let root = two_folders();
    symlink(root.path().join("outside.obj"), root.path().join("scene/link.obj")).unwrap();
    symlink(root.path().join("secret"), root.path().join("scene/folder")).unwrap();
    symlink("sub/in.obj", root.path().join("scene/inner.obj")).unwrap();
    for file in ["link.obj", "folder/in.obj", "folder/../outside.obj"] {
        naming(&root, file, Trust::Full).unwrap();
        let error = naming(&root, file, Trust::OwnFolder).unwrap_err();
        assert!(error.message.contains("outside of the scene's folder"), "{file}: {error}");
    }
    naming(&root, "inner.obj", Trust::OwnFolder).unwrap();
}
