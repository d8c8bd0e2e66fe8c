//! Large and degenerate trees: their depth, size and repeatability.

use std::time::Instant;

use crate::soups::{Soup, brute_force, in_cube, random, some_ray};
use caustica_math::Vec3;
use caustica_scene::Scene;
use caustica_scene::bvh::{Bvh, Ray, SphereData};
use caustica_scene::description::{Description, Geometry, Mesh};
use caustica_testkit::build;

const TRIANGLE: [Vec3; 3] = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];

fn down_at(x: f32, y: f32) -> Ray {
    Ray { origin: Vec3::new(x, y, 1.0), direction: Vec3::new(0.0, 0.0, -1.0), t_max: f32::INFINITY }
}

#[test]
fn a_hundred_thousand_identical_triangles() {
    let mut soup = Soup { corners: vec![TRIANGLE; 100_000], ..Soup::default() };
    let ray = down_at(0.2, 0.2);
    assert_eq!(soup.tree().closest(&ray).map(|h| h.primitive), Some(0));
    soup.spheres = vec![SphereData { center: Vec3::new(0.2, 0.2, -2.0), radius: 0.5 }; 50_000];
    let tree = soup.tree();
    assert_eq!(tree.closest(&ray).map(|h| h.primitive), Some(0));
    let up = Ray { origin: Vec3::new(0.2, 0.2, -9.0), direction: Vec3::Z, t_max: f32::INFINITY };
    assert_eq!(tree.closest(&up).map(|h| h.primitive), Some(100_000));
    assert!(tree.occluded(&up) && !tree.occluded(&Ray { t_max: 6.0, ..up }));
}

/// Triangles that shrink towards a corner, by a half (down to subnormal sizes) and by a thousandth, are what
/// makes a surface-area heuristic split off one at a time.
#[test]
fn nested_triangles_do_not_overflow_the_stack() {
    for (count, factor) in [(140, 0.5_f32), (100_000, 0.9995)] {
        let mut size = 1.0;
        let mut soup = Soup::default();
        for _ in 0..count {
            soup.corners.push(TRIANGLE.map(|p| (p + Vec3::splat(0.1)) * size));
            size *= factor;
        }
        let tree = soup.tree();
        // Through all of the boxes: towards the corner to which they shrink.
        let ray = Ray { origin: Vec3::splat(3.0), direction: Vec3::splat(-1.0), t_max: f32::INFINITY };
        assert!(tree.closest(&ray).is_some() && tree.occluded(&ray));
        let primitives = soup.one_by_one();
        let mut s = random(4);
        for _ in 0..20 {
            let ray = some_ray(&soup, &mut s);
            assert_eq!(tree.closest(&ray), brute_force(&primitives, &ray), "{count}: {ray:?}");
        }
    }
}

#[test]
fn the_same_tree_twice() {
    let soup = Soup::of_many_scales(20_000, 1).with_spheres(500, 2);
    let [a, b] = [(); 2].map(|()| format!("{:?}", soup.tree()));
    assert!(a == b);
    let one_thread = rayon_free(&soup);
    assert!(a == one_thread);
}

/// The tree built where no second thread can help.
fn rayon_free(soup: &Soup) -> String {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| format!("{:?}", soup.tree()))
}

/// A bumpy square of `n` × `n` cells.
fn terrain(n: u32) -> Mesh {
    let mut s = random(5);
    let mut mesh = Mesh::default();
    for i in 0..=n {
        for j in 0..=n {
            mesh.positions.push(Vec3::new(i as f32, j as f32, 3.0 * s.next_1d()));
            mesh.normals.push(Vec3::Z);
        }
    }
    for i in 0..n {
        for j in 0..n {
            let a = i * (n + 1) + j;
            let b = a + n + 1;
            mesh.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
        }
    }
    mesh
}

#[test]
fn a_million_triangles_take_less_than_200_megabytes() {
    let mut d = Description::default();
    let m = build::diffuse(&mut d, 0.5);
    build::add(&mut d, "terrain", Geometry::Mesh(terrain(708)), m);
    let start = Instant::now();
    let scene: Scene = Scene::new(d).unwrap().0;
    let seconds = start.elapsed().as_secs_f64();
    let count = scene.surfaces().triangles().len();
    let (tree, tables) = (scene.bvh().memory(), scene.surfaces().memory());
    println!(
        "{count} triangles: {seconds:.2} s, tree {} MB, tables {} MB",
        tree / 1_000_000,
        tables / 1_000_000
    );
    assert!(count > 1_000_000 && tree + tables < 200_000_000, "{tree} + {tables} bytes");

    let start = Instant::now();
    let mut s = random(6);
    let rays = 200_000;
    let mut hits = 0;
    for _ in 0..rays {
        let from = (in_cube(&mut s) + Vec3::splat(1.0)) * 354.0;
        let to = (in_cube(&mut s) + Vec3::splat(1.0)) * 354.0;
        let ray = Ray {
            origin: Vec3::new(from.x, from.y, 200.0),
            direction: Vec3::new(to.x - from.x, to.y - from.y, -200.0),
            t_max: f32::INFINITY,
        };
        hits += u32::from(scene.bvh().closest(&ray).is_some());
    }
    println!("{:.0} ns a ray", start.elapsed().as_secs_f64() / f64::from(rays) * 1e9);
    assert_eq!(hits, rays, "the terrain has no holes");
}

#[test]
fn coordinates_at_the_limit_are_handled() {
    let far = 1e15;
    let positions = [Vec3::new(far, 0.0, 0.0), Vec3::new(far, far, 0.0), Vec3::new(far, 0.0, far)];
    let tree = Bvh::new(&positions, &[[0, 1, 2]; 9], &[]);
    let ray = Ray { origin: Vec3::ZERO, direction: Vec3::new(1.0, 0.1, 0.1), t_max: f32::INFINITY };
    assert_eq!(tree.closest(&ray).map(|h| h.primitive), Some(0));
}
