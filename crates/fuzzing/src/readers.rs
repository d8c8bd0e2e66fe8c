//! Files that people hand us.

use caustica_film::FilmRecord;
use std::sync::LazyLock;

use caustica_import::{
    Loaded, Provision, TestKind, Trust, decode_image, load_with, parse_nori_with, read_obj, read_ply,
    read_serialized,
};
use caustica_scene::description::Mesh;
use caustica_scene::{Cause, Description, Diagnostic, MemoryLimit, Scene};

use crate::{folder, images, meshes};

/// Scenes of more shapes are read and not made ready, which would take the time of many inputs.
const MOST_SHAPES: usize = 20_000;

/// A scene file: it is read, and what it describes is made ready to be rendered. Errors must have a place.
///
/// # Panics
/// If a promise is broken.
pub fn nori_xml(data: &[u8]) {
    write_files();
    let text = String::from_utf8_lossy(data);
    match parse_nori_with(&text, "s.xml", folder().path(), Trust::OwnFolder) {
        Err(error) => check_place(&error, "s.xml", &text),
        Ok(Loaded { scene, tests, warnings, .. }) => {
            warnings.iter().filter(|w| w.origin.is_some()).for_each(|w| check_place(w, "s.xml", &text));
            let stages = tests.into_iter().flat_map(|test| {
                let scenes = match test.kind {
                    TestKind::TTest { scenes, .. } => scenes,
                    TestKind::Chi2Test { .. } => Vec::new(),
                };
                scenes.into_iter().chain([test.stage])
            });
            scene.into_iter().chain(stages).for_each(make_ready);
        }
    }
}

/// Writes what scenes name.
fn write_files() {
    static FILES: LazyLock<()> = LazyLock::new(|| {
        let small = [
            ("tri.obj", crate::seeds::TRIANGLE.as_bytes().to_vec()),
            ("part.xml", crate::seeds::PART.as_bytes().to_vec()),
            ("curve.spd", b"400 0.1\n500 0.6\n700 0.9\n".to_vec()),
        ];
        for (name, bytes) in small.into_iter().chain(images::named()).chain(meshes::named()) {
            std::fs::write(folder().path().join(name), bytes).expect("a small file");
        }
    });
    LazyLock::force(&FILES);
}

/// A scene file of Mitsuba's, likewise.
///
/// # Panics
/// If a promise is broken.
pub fn mitsuba_xml(data: &[u8]) {
    write_files();
    let path = folder().path().join("m.xml");
    std::fs::write(&path, data).expect("a temporary file");
    let (name, text) = (path.display().to_string(), String::from_utf8_lossy(data));
    let provision = Provision { trust: Trust::OwnFolder, variables: &[] };
    match load_with(&path, &provision) {
        Err(error) => check_place(&error, &name, &text),
        Ok(Loaded { scene, warnings, .. }) => {
            warnings.iter().filter(|w| w.origin.is_some()).for_each(|w| check_place(w, &name, &text));
            scene.into_iter().for_each(make_ready);
        }
    }
}

fn make_ready(description: Description) {
    if description.shapes.len() > MOST_SHAPES {
        return;
    }
    if let Ok((scene, _)) = Scene::new(description) {
        let (center, radius) = scene.bounding_sphere();
        assert!(center.is_finite() && radius > 0.0 && radius.is_finite(), "bounds {center:?}, {radius}");
        assert!(scene.lamps().power() >= 0.0, "power {}", scene.lamps().power());
    }
}

/// A diagnostic names a place that the text has.
fn check_place(diagnostic: &Diagnostic, file: &str, text: &str) {
    let origin = diagnostic.origin.as_ref().unwrap_or_else(|| panic!("no place: {diagnostic}"));
    if origin.file != file {
        return;
    }
    assert!(origin.line >= 1 && origin.line as usize <= text.matches('\n').count() + 1, "{diagnostic}");
    assert!(origin.column >= 1, "{diagnostic}");
    if let Some((start, length)) = origin.span {
        assert!(start + length <= text.len() + 1, "{diagnostic}");
    }
}

/// A mesh: what is read has indices and numbers that hold.
///
/// # Panics
/// If a promise is broken.
pub fn obj(data: &[u8]) {
    match read_obj(data, "m.obj") {
        Err(error) => {
            let line = error.origin.as_ref().unwrap_or_else(|| panic!("no place: {error}")).line as usize;
            assert!((1..=data.iter().filter(|b| **b == b'\n').count() + 1).contains(&line), "{error}");
        }
        Ok(read) => {
            let mesh = read.mesh;
            let vertices = mesh.positions.len();
            assert!(!mesh.triangles.is_empty());
            assert!(mesh.triangles.iter().flatten().all(|v| (*v as usize) < vertices));
            assert!(mesh.positions.iter().all(|p| p.is_finite()));
            assert!(mesh.normals.is_empty() || mesh.normals.len() == vertices);
            assert!(mesh.normals.iter().all(|n| n.try_normalized().is_some()));
            assert!(mesh.uvs.is_empty() || mesh.uvs.len() == vertices);
        }
    }
}

/// A PLY mesh, likewise.
///
/// # Panics
/// If a promise is broken.
pub fn ply(data: &[u8]) {
    match read_ply(data, "m.ply") {
        Err(error) => assert!(error.origin.as_ref().is_some_and(|o| o.line >= 1), "{error}"),
        Ok(read) => check_mesh(&read.mesh),
    }
}

/// The meshes of a serialized file, which may not take more memory than they are allowed.
///
/// # Panics
/// If a promise is broken.
pub fn serialized(data: &[u8]) {
    for index in 0..3 {
        match read_serialized(data, "m.serialized", index, MemoryLimit::Bytes(64 << 20)) {
            Err(error) => assert!(error.cause == Cause::Memory || error.to_string().contains("m.serialized")),
            Ok(mesh) => check_mesh(&mesh),
        }
    }
}

fn check_mesh(mesh: &Mesh) {
    let vertices = mesh.positions.len();
    assert!(!mesh.triangles.is_empty());
    assert!(mesh.triangles.iter().flatten().all(|v| (*v as usize) < vertices));
    assert!(mesh.positions.iter().all(|p| p.is_finite()));
    assert!([0, vertices].contains(&mesh.normals.len()) && [0, vertices].contains(&mesh.uvs.len()));
}

/// A picture for textures: what is read is as large as it says, and has only values that light can have.
///
/// # Panics
/// If a promise is broken.
pub fn images(data: &[u8]) {
    if let Ok(read) = decode_image(data, "image") {
        let image = read.image;
        assert_eq!(image.pixels.len(), image.width as usize * image.height as usize);
        assert!(image.pixels.iter().all(|p| p.is_valid()));
    }
}

/// A rendered picture, as `caustica develop` reads it.
///
/// # Panics
/// If a promise is broken.
pub fn exr(data: &[u8]) {
    let path = folder().path().join("film.exr");
    std::fs::write(&path, data).expect("a temporary file");
    if let Ok((picture, _)) = caustica_film::read_exr(&path) {
        let pixels = picture.window.pixels();
        assert_eq!(picture.eye.len() as u64, pixels);
        assert_eq!(picture.light.len() as u64, pixels);
        assert!(picture.window.x + picture.window.width <= picture.width);
        assert!(picture.window.y + picture.window.height <= picture.height);
    }
}

/// Reads a film file, and writes it again: as it is, and with the hash that its bytes should have, because hardly any
/// changed file has the right one.
///
/// # Panics
/// If a promise is broken.
pub fn film(data: &[u8]) {
    one_film(data);
    if let Some(body) = data.len().checked_sub(blake3::OUT_LEN).map(|end| &data[..end]) {
        one_film(&[body, blake3::hash(body).as_bytes()].concat());
    }
}

fn one_film(data: &[u8]) {
    if let Ok(record) = FilmRecord::parse(data) {
        assert_eq!(record.film.sums().len() as u64, record.film.layout().window.pixels());
        assert!(record.check_mergeable(&record).is_err() || record.facts.samples.total() == 0);
        let path = folder().path().join("again.film");
        record.write(&path).expect("a temporary file");
        let again = FilmRecord::read(&path).expect("a film that was just written");
        assert!(again.film.bits_equal(&record.film));
        assert_eq!(again.facts, record.facts);
    }
}
