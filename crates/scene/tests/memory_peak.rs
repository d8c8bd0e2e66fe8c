//! What a scene takes while it is made ready is what is foretold, or a little less. Alone in its file, as the process
//! is measured; on Linux, where that can be.

use caustica_math::Vec3;
use caustica_scene::bvh::TreeQuality;
use caustica_scene::description::{CameraKind, Geometry, Mesh};
use caustica_scene::memory::needed;
use caustica_scene::{Description, MemoryLimit, Scene};
use caustica_testkit::build;

/// The most and the current memory of this process in bytes, where the system tells.
fn memory() -> Option<[u64; 2]> {
    let table = std::fs::read_to_string("/proc/self/status").ok()?;
    let kibibytes = |name: &str| {
        let rest = table.lines().find_map(|l| l.strip_prefix(name))?;
        rest.split_whitespace().next()?.parse::<u64>().ok()
    };
    Some([kibibytes("VmHWM:")? * 1024, kibibytes("VmRSS:")? * 1024])
}

/// A bumpy square of `n` × `n` cells.
fn terrain(n: u32) -> Mesh {
    let height = |i: u32, j: u32| ((i * 7919 + j * 104_729) % 1000) as f32 * 3e-3;
    let corners = (0..=n).flat_map(|i| (0..=n).map(move |j| Vec3::new(i as f32, height(i, j), j as f32)));
    let cell = |k: u32| {
        let a = k / n * (n + 1) + k % n;
        [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
    };
    Mesh { positions: corners.collect(), triangles: (0..n * n).flat_map(cell).collect(), ..Mesh::default() }
}

#[test]
fn the_peak_is_foretold() {
    let eye = CameraKind::Perspective { fov: 60.0 };
    let meter = CameraKind::IrradianceMeter { shape: 0 };
    let cases =
        [(TreeQuality::Fast, 500, eye), (TreeQuality::Spatial, 700, eye), (TreeQuality::Fast, 1000, meter)];
    for (tree, n, camera) in cases {
        let mut d = Description::default();
        let m = build::diffuse(&mut d, 0.5);
        build::add(&mut d, "terrain", Geometry::Mesh(terrain(n)), m);
        d.camera.kind = camera;
        (d.film.width, d.film.height) = (1, 1);
        let foretold = needed(&d, tree);
        let Some([_, before]) = memory() else { return };
        let scene = Scene::within(d, tree, MemoryLimit::Bytes(foretold)).unwrap();
        let [most, _] = memory().unwrap();
        let taken = most - before;
        println!("{tree:?}: {taken} bytes taken, {foretold} foretold, for {} triangles", 2 * n * n);
        assert!(taken < foretold && taken * 2 > foretold, "{tree:?}: {taken} bytes of {foretold}");
        drop(scene);
    }
}
