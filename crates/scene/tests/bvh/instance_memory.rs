//! Thousands of instances of a large mesh take the memory of one.

use caustica_math::{Transform, Vec3};
use caustica_scene::bvh::{Ray, TreeQuality};
use caustica_scene::description::{Geometry, Mesh};
use caustica_scene::memory::needed;
use caustica_scene::{Description, Scene};
use caustica_testkit::build;

/// A bumpy square of `n` × `n` cells of edge 1/n.
fn terrain(n: u32) -> Mesh {
    let height = |i: u32, j: u32| ((i * 7919 + j * 104_729) % 1000) as f32 * 1e-4;
    let side = 1.0 / n as f32;
    let corner = |i: u32, j: u32| Vec3::new(i as f32 * side, height(i, j), j as f32 * side);
    let corners = (0..=n).flat_map(|i| (0..=n).map(move |j| corner(i, j)));
    let cell = |k: u32| {
        let a = k / n * (n + 1) + k % n;
        [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
    };
    Mesh { positions: corners.collect(), triangles: (0..n * n).flat_map(cell).collect(), ..Mesh::default() }
}

fn field(cells: u32, instances: u32) -> Description {
    let mut d = Description::default();
    let m = build::diffuse(&mut d, 0.5);
    build::add(&mut d, "terrain", Geometry::Mesh(terrain(cells)), m);
    let group = build::group(&mut d, 0);
    for i in 0..instances {
        let to = [f64::from(i % 71), 0.0, f64::from(i / 71)];
        let turned =
            Transform::translate([-0.5, 0.0, -0.5]).then(Transform::rotate(f64::from(i), [0.0, 1.0, 0.0]));
        build::instance(&mut d, group, turned.then(Transform::translate(to)));
    }
    d
}

#[test]
fn five_thousand_instances_of_a_million_triangles() {
    let (cells, instances) = (708, 5000);
    let [one, many] = [1, instances].map(|n| needed(&field(cells, n), TreeQuality::Fast));
    assert!(many < one * 11 / 10, "{many} bytes for {instances} instances, {one} for one");
    let scene = Scene::new(field(cells, instances)).unwrap().0;
    let (tree, tables) = (scene.bvh().memory(), scene.surfaces().memory());
    let [kept, placed] = [scene.surfaces().kept()[0] as u64, scene.surfaces().placed()[0]];
    println!(
        "{placed} triangles placed, {kept} kept: tree {tree} bytes, tables {tables} bytes, {many} foretold"
    );
    assert!(kept > 1_000_000 && placed == kept * u64::from(instances));
    assert!(tree + tables < 110 * kept as usize, "{tree} + {tables}");
    let down = Ray { origin: Vec3::new(30.1, 5.0, 40.2), direction: Vec3::new(0.01, -1.0, 0.0), t_max: 10.0 };
    let p = scene.closest(&down).expect("a field");
    assert!(p.position.y > -1e-3 && p.position.y < 0.11 && p.normal.y > 0.0, "{p:?}");
}
