//! What a ray hits in a tree is what it hits when every primitive is asked: to the bit, and whatever the
//! shape of the tree.

use crate::soups::{Soup, brute_force, in_cube, random, some_ray};
use caustica_math::{Vec3, warp};
use caustica_scene::bvh::{Bvh, Hit, Ray, SphereData};

/// The ray without its end.
fn endless(origin: Vec3, direction: Vec3) -> Ray {
    Ray { origin, direction, t_max: f32::INFINITY }
}

/// Compares the tree with its primitives one by one, for that many rays, with and without an end.
/// Returns how many hit.
fn compare(what: &str, soup: &Soup, rays: usize) -> usize {
    let (tree, primitives) = (soup.tree(), soup.one_by_one());
    let mut s = random(99);
    let mut hits = 0;
    for i in 0..rays {
        let ray = some_ray(soup, &mut s);
        let expected = brute_force(&primitives, &ray);
        let found = tree.closest(&ray);
        assert_eq!(found, expected, "{what}: ray {i}: {ray:?}");
        assert_eq!(tree.occluded(&ray), expected.is_some(), "{what}: shadow ray {i}: {ray:?}");
        let Some(Hit { t, .. }) = expected else { continue };
        hits += 1;
        // A ray that ends on the surface meets it; one that ends before does not; and beyond it nothing changes.
        for (t_max, seen) in [(t, true), (t.next_down(), false), (t * 0.5, false), (t * 1.5, true)] {
            let short = Ray { t_max, ..ray };
            let expected = brute_force(&primitives, &short);
            assert_eq!(expected.is_some(), seen, "{what}: ray {i} up to {t_max}: {ray:?}");
            assert_eq!(tree.closest(&short), expected, "{what}: ray {i} up to {t_max}: {ray:?}");
            assert_eq!(tree.occluded(&short), seen, "{what}: shadow ray {i} up to {t_max}: {ray:?}");
        }
    }
    hits
}

#[test]
fn heaps_of_every_size_equal_brute_force() {
    for (i, count) in [1, 2, 3, 4, 5, 8, 17, 100, 1000].into_iter().enumerate() {
        let name = 10 * i as u32;
        let rays = 100_000 / (count + 60);
        let hits = compare("many scales", &Soup::of_many_scales(count, name), rays);
        assert!(hits > rays / 20, "{hits} of {rays} rays hit {count} triangles");
        compare("slivers", &Soup::of_slivers(count, name + 1), rays);
        compare("lattice", &Soup::of_lattice(count, name + 2), rays);
        compare("spheres", &Soup::default().with_spheres(count, name + 3), rays);
        let mixed = Soup::of_many_scales(count, name + 4).with_spheres(count, name + 5);
        compare("mixed", &mixed, rays);
    }
}

#[test]
fn a_large_heap_equals_brute_force() {
    let soup = Soup::of_many_scales(9_000, 1000).with_spheres(1_000, 1001);
    assert!(compare("ten thousand", &soup, 150) > 75);
}

/// Every triangle four times, its corners in another order each time: the first copy is what is hit.
#[test]
fn of_coincident_triangles_the_first_is_hit() {
    for (name, original) in [(1, Soup::of_many_scales(60, 1)), (2, Soup::of_lattice(60, 2))] {
        let mut soup = Soup::default();
        soup.corners.extend(original.corners.iter().map(|[a, b, c]| [*b, *c, *a]));
        soup.corners.extend(original.corners.iter().map(|[a, b, c]| [*a, *c, *b]));
        soup.corners.extend(&original.corners);
        soup.corners.extend(&original.corners);
        let tree = soup.tree();
        compare("coincident", &soup, 1500);
        let mut s = random(name);
        for _ in 0..1500 {
            let ray = some_ray(&soup, &mut s);
            if let Some(h) = tree.closest(&ray) {
                assert!(h.primitive < 180, "the third copy is never later than the fourth: {h:?}");
            }
        }
    }
}

#[test]
fn concentric_primitives_equal_brute_force() {
    let mut soup = Soup::default();
    for i in 0..200 {
        let (r, mut s) = (1.0 + i as f32 / 7.0, random(i));
        let [a, b] = [(); 2].map(|()| warp::uniform_sphere(s.next_2d()) * r);
        // Twice the centre of its box is zero on every axis.
        soup.corners.push([a, -a, b * 0.5]);
        soup.spheres.push(SphereData { center: Vec3::ZERO, radius: r });
        soup.spheres.push(SphereData { center: Vec3::ZERO, radius: r });
    }
    compare("concentric", &soup, 500);
}

/// An independent test in double precision, on rays that do not graze an edge.
#[test]
fn hits_are_where_geometry_has_them() {
    let soup = Soup::of_many_scales(300, 5);
    let tree = soup.tree();
    let (mut s, mut sure) = (random(6), 0);
    for _ in 0..2000 {
        let origin = in_cube(&mut s) * 3.0;
        let ray = endless(origin, in_cube(&mut s) - origin);
        let crossings: Vec<_> = soup.corners.iter().map(|c| moller_trumbore(c, &ray)).collect();
        if crossings.iter().any(|c| c.margin.abs() < 1e-3 && c.t > 0.0) {
            continue;
        }
        sure += 1;
        let first = (0..crossings.len())
            .filter(|i| crossings[*i].margin > 0.0 && crossings[*i].t > 0.0)
            .min_by(|a, b| crossings[*a].t.total_cmp(&crossings[*b].t));
        let found = tree.closest(&ray);
        assert_eq!(found.map(|h| h.primitive as usize), first, "{ray:?}");
        if let (Some(h), Some(i)) = (found, first) {
            let c = &crossings[i];
            assert!((f64::from(h.t) / c.t - 1.0).abs() < 1e-4, "{h:?} at {}", c.t);
            assert!((f64::from(h.b1) - c.b[0]).abs() < 2e-3 && (f64::from(h.b2) - c.b[1]).abs() < 2e-3);
        }
    }
    assert!(sure > 500, "only {sure} rays graze nothing");
}

/// Where a ray crosses a triangle's plane, in double precision.
struct Crossing {
    t: f64,
    b: [f64; 2],
    /// The least barycentric coordinate: positive inside.
    margin: f64,
}

fn moller_trumbore(corners: &[Vec3; 3], ray: &Ray) -> Crossing {
    let wide = |v: Vec3| v.to_array().map(f64::from);
    let sub = |a: [f64; 3], b: [f64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let [p, q, r] = corners.map(wide);
    let (e1, e2, o, d) = (sub(q, p), sub(r, p), sub(wide(ray.origin), p), wide(ray.direction));
    let h = cross(d, e2);
    let det = dot(e1, h);
    let k = cross(o, e1);
    let (b1, b2) = (dot(o, h) / det, dot(d, k) / det);
    Crossing { t: dot(e2, k) / det, b: [b1, b2], margin: b1.min(b2).min(1.0 - b1 - b2) }
}

#[test]
fn empty_and_flat_worlds() {
    let nothing = Bvh::new(&[], &[], &[]);
    let ray = endless(Vec3::ZERO, Vec3::X);
    assert!(nothing.closest(&ray).is_none() && !nothing.occluded(&ray) && nothing.bounds().is_empty());
    // In its own plane a triangle is not there, on either of its sides it is.
    let soup = Soup { corners: vec![[Vec3::ZERO, Vec3::X, Vec3::Y]], ..Soup::default() };
    let tree = soup.tree();
    for zero in [0.0, -0.0] {
        assert!(!tree.occluded(&endless(Vec3::new(-1.0, 0.25, zero), Vec3::new(1.0, 0.0, zero))));
        for side in [1.0, -1.0] {
            let ray = endless(Vec3::new(0.25, 0.25, side), Vec3::new(zero, zero, -side));
            let h = tree.closest(&ray).unwrap();
            assert_eq!((h.t, h.b1, h.b2), (1.0, 0.25, 0.25));
        }
    }
    assert!(!tree.occluded(&endless(Vec3::new(0.25, 0.25, 1.0), Vec3::ZERO)), "no direction, no hit");
    assert!(!tree.occluded(&endless(Vec3::splat(f32::NAN), Vec3::X)), "no place, no hit");
}

/// Lengths of the direction scale distances and change nothing else.
#[test]
fn directions_may_have_any_length() {
    let soup = Soup::of_many_scales(50, 7).with_spheres(20, 8);
    let tree = soup.tree();
    let mut s = random(9);
    for _ in 0..500 {
        let origin = in_cube(&mut s) * 3.0;
        let direction = in_cube(&mut s) - origin;
        let Some(unit) = tree.closest(&endless(origin, direction)) else { continue };
        for exponent in [-40, -20, -3, 3, 20, 40] {
            // Powers of two leave all roundings as they are.
            let k = libm::ldexpf(1.0, exponent);
            let h = tree.closest(&endless(origin, direction * k)).expect("it hits at any length");
            assert_eq!((h.primitive, h.t * k, h.b1, h.b2), (unit.primitive, unit.t, unit.b1, unit.b2));
        }
    }
}
