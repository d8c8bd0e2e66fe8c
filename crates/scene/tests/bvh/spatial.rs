//! Trees with spatial splits: what is hit is what is hit in the plain tree, to the bit.

use crate::soups::bodies::{ball, cube};
use crate::soups::{Soup, in_cube, of_scale, random, some_ray};
use caustica_math::{SampleStream, Vec3, warp};
use caustica_scene::bvh::{Bvh, Ray, TreeQuality};

/// The plain tree and the one with spatial splits.
fn trees(soup: &Soup) -> [Bvh; 2] {
    let positions: Vec<Vec3> = soup.corners.iter().flatten().copied().collect();
    let triangles: Vec<_> = (0..soup.corners.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    [TreeQuality::Fast, TreeQuality::Spatial]
        .map(|quality| Bvh::with_quality(&positions, &triangles, &soup.spheres, quality))
}

/// Asks both trees about the ray, with and without an end at the hit. Returns whether all answers are the same.
fn agree([plain, spatial]: &[Bvh; 2], ray: &Ray) -> bool {
    let found = plain.closest(ray);
    let same = |ray: &Ray| {
        plain.closest(ray) == spatial.closest(ray) && plain.occluded(ray) == spatial.occluded(ray)
    };
    let ends = found.iter().flat_map(|h| [h.t, h.t.next_down(), h.t * 1.5]);
    same(ray) && { ends }.all(|t_max| same(&Ray { t_max, ..*ray }))
}

/// Long thin triangles in all directions, at most that wide.
fn sticks(count: usize, width: f32, name: u32) -> Soup {
    let mut s = random(name);
    let mut stick = |_| {
        let (a, b) = (in_cube(&mut s), in_cube(&mut s));
        [a, b, b + in_cube(&mut s) * (width * of_scale(&mut s, -1.0, 0.0))]
    };
    Soup { corners: (0..count).map(&mut stick).collect(), ..Soup::default() }
}

/// Triangles of a stretched and turned closed body, in a crowd of them.
fn rods(count: usize, name: u32) -> Soup {
    let mut s = random(name);
    let mut soup = Soup::default();
    for i in 0..count {
        let mesh = if i % 2 == 0 { ball(3) } else { cube(1) };
        soup.corners.extend(rod(&mesh.positions, &mesh.triangles, in_cube(&mut s), &mut s));
    }
    soup
}

fn rod<'a>(
    positions: &'a [Vec3],
    triangles: &'a [[u32; 3]],
    center: Vec3,
    s: &mut SampleStream,
) -> impl Iterator<Item = [Vec3; 3]> + use<'a> {
    let along = warp::uniform_sphere(s.next_2d());
    let frame = caustica_math::Frame::from_normal(along);
    let place = move |p: Vec3| center + frame.to_world(Vec3::new(p.x * 0.01, p.y * 0.02, p.z));
    triangles.iter().map(move |t| t.map(|v| place(positions[v as usize])))
}

/// Returns whether anything was split.
fn assert_same(what: &str, soup: &Soup, rays: usize) -> bool {
    let trees = trees(soup);
    let mut s = random(77);
    let differ = (0..rays).filter(|_| !agree(&trees, &some_ray(soup, &mut s))).count();
    assert_eq!(differ, 0, "{what}: of {rays} rays");
    trees[0].memory() != trees[1].memory()
}

#[test]
fn heaps_of_all_kinds_are_hit_as_in_the_plain_tree() {
    for (i, count) in [1, 5, 40, 300, 3000].into_iter().enumerate() {
        let name = 10 * i as u32;
        let rays = 40_000;
        let split = assert_same("many scales", &Soup::of_many_scales(count, name), rays);
        assert!(split || count < 1000, "nothing was split");
        assert_same("lattice", &Soup::of_lattice(count, name + 1), rays);
        assert_same("mixed", &Soup::of_many_scales(count, name + 2).with_spheres(count, name + 3), rays);
        assert_same("sticks", &sticks(count, 0.1, name + 4), rays);
        assert_same("thin sticks", &sticks(count, 0.003, name + 5), rays);
        assert_same("slivers and sticks", &with_slivers(sticks(count, 0.1, name + 6), count), rays);
        assert_same("rods", &rods(count.div_ceil(20), name + 7), rays);
    }
}

fn with_slivers(mut soup: Soup, count: usize) -> Soup {
    soup.corners.extend(Soup::of_slivers(count / 4, 5).corners);
    soup
}

/// Closed rods near and far from the origin; every ray is aimed at an edge or a corner, from near and far.
#[test]
fn no_ray_slips_through_an_edge_that_was_cut() {
    let mut rays = 0;
    for (scale, distance) in [(1.0, 0.0), (1e-3, 0.0), (1e3, 1.0), (1.0, 100.0)] {
        let offset = Vec3::new(0.7, -1.0, 0.4) * (scale * distance);
        let mut soup = rods(100, 3);
        for p in soup.corners.iter_mut().flatten() {
            *p = *p * scale + offset;
        }
        let trees = trees(&soup);
        assert_ne!(trees[0].memory(), trees[1].memory(), "nothing was split");
        let mut s = random(4);
        for _ in 0..60_000 {
            let t = ((s.next_1d() * soup.corners.len() as f32) as usize).min(soup.corners.len() - 1);
            let [a, b, _] = soup.corners[t];
            let target = if s.next_1d() < 0.3 { a } else { a + (b - a) * s.next_1d() };
            let away = warp::uniform_sphere(s.next_2d()) * (scale * of_scale(&mut s, -2.0, 2.0));
            let ray = Ray { origin: target + away, direction: -away, t_max: f32::INFINITY };
            assert!(agree(&trees, &ray), "{scale}, {distance}: {ray:?}");
            rays += 4;
        }
    }
    assert!(rays >= 900_000);
}

/// The tree does not depend on how many threads build it.
#[test]
fn any_number_of_threads_builds_the_same_tree() {
    let mut soup = Soup::of_many_scales(20_000, 9);
    soup.corners.extend(sticks(500, 0.05, 10).corners);
    let build = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
        pool.install(|| format!("{:?}", trees(&soup)[1]))
    };
    assert!(build(1) == build(3));
    assert_ne!(trees(&soup)[0].memory(), trees(&soup)[1].memory(), "nothing was split");
}
