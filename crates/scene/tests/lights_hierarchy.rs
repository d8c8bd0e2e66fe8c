//! The hierarchy by which next-event estimation chooses among many lamps: its probabilities add up to one, or to what is
//! not chosen in vain; they are those with which it chooses, and zero only where no light comes from.
//!
//! Together the tests of each function have the significance level 0.01 (Šidák); seeds are fixed.

use caustica_math::stats::{chi_square_test, sidak};
use caustica_math::{Rgb, SampleStream, StreamId, Transform, Vec3, Wavelengths, warp};
use caustica_scene::description::{Daylight, Geometry, LightKind};
use caustica_scene::light::{Anchor, Leaf, Light, LightPoint, Receiver};
use caustica_scene::{Description, Scene};
use caustica_testkit::build;
use caustica_testkit::seed::seed;

const SIGNIFICANCE: f64 = 0.01;

fn random(name: u32) -> SampleStream {
    SampleStream::new(StreamId { seed: seed(53), pixel: name, sample: 0, walk: 0 })
}

fn place(s: &mut SampleStream, size: f32) -> Vec3 {
    let ([x, y], z) = (s.next_2d(), s.next_1d());
    (Vec3::new(x, y, z) * 2.0 - Vec3::splat(1.0)) * size
}

/// A ball of triangles, spheres, quads, points and spots in a box, and a sky and a sun if asked for.
fn all_kinds(infinite: bool) -> Description {
    let (mut d, mut s) = (build::scene(8), random(1));
    let m = build::diffuse(&mut d, 0.5);
    let ball = build::add(&mut d, "ball", Geometry::Mesh(build::ellipsoid(5, [0.5, 0.2, 0.3])), m);
    d.shapes[ball].to_world = Transform::translate([0.4, -0.3, 0.2]);
    build::emit(&mut d, ball, 2.0);
    for i in 0..20 {
        let at = place(&mut s, 1.0).to_array();
        let brightness = 1.0 + i as f32;
        match i % 4 {
            0 => {
                let lamp = build::sphere(&mut d, at, 0.01 + 0.01 * i as f32, m);
                build::emit(&mut d, lamp, brightness);
            }
            1 => {
                let u = place(&mut s, 0.2);
                let v = place(&mut s, 0.2);
                let lamp = build::quad(&mut d, at, u.to_array(), v.to_array(), m);
                build::emit(&mut d, lamp, brightness);
            }
            2 => build::point_light(&mut d, at, 0.1 * brightness),
            _ => {
                let direction = place(&mut s, 1.0).to_array();
                let outer_angle = [3.0, 50.0, 120.0, 180.0][i / 4 % 4];
                let intensity = Rgb::splat(brightness);
                build::light(
                    &mut d,
                    LightKind::Spot { position: at, direction, intensity, inner_angle: 1.0, outer_angle },
                );
            }
        }
    }
    if infinite {
        build::light(&mut d, LightKind::Constant { radiance: Rgb::splat(0.2) });
        build::light(
            &mut d,
            LightKind::Directional { direction: [0.0, 1.0, 0.1], irradiance: Rgb::splat(0.5) },
        );
        let daylight = Daylight { to_world: Transform::IDENTITY, to_sun: [0.3, 0.2, 0.4], turbidity: 2.0 };
        build::light(&mut d, LightKind::Sun { daylight, aperture: 3.0, scale: 0.3, darkened: true });
    }
    d
}

fn scene(d: Description) -> Scene {
    Scene::new(d).unwrap().0
}

/// A point of a leaf.
fn point_of(scene: &Scene, leaf: Leaf, u: [f32; 2]) -> LightPoint {
    let surfaces = scene.surfaces();
    match scene.lamps().get(leaf.light) {
        Light::Area(_) => {
            let shape = surfaces.shapes.iter().find(|s| s.light == Some(leaf.light)).unwrap();
            let primitive = shape.first_primitive + leaf.part;
            let p = if surfaces.sphere(primitive).is_some() {
                surfaces.sphere_point(primitive, warp::uniform_sphere(u))
            } else {
                let [b1, b2] = warp::uniform_triangle(u);
                surfaces.triangle_point(primitive, b1, b2)
            };
            LightPoint::on_surface(leaf.light, &p)
        }
        Light::Point { position, .. } => point_at(leaf, *position),
        Light::Spot(spot) => point_at(leaf, spot.position),
        _ => LightPoint::infinite(leaf.light, warp::uniform_sphere(u)),
    }
}

fn point_at(leaf: Leaf, at: Vec3) -> LightPoint {
    LightPoint { anchor: Anchor::Point, at, ..LightPoint::infinite(leaf.light, Vec3::Z) }
}

/// Places near and far, with and without a normal.
fn receivers(count: u32) -> Vec<Receiver> {
    let mut s = random(2);
    let one = |i: u32| {
        let at = place(&mut s, [0.5, 1.0, 3.0, 100.0][i as usize % 4]);
        let normal = if i.is_multiple_of(3) { Vec3::ZERO } else { warp::uniform_sphere(s.next_2d()) };
        Receiver { at, normal }
    };
    (0..count).map(one).collect()
}

/// All leaves, and the lamps at infinity.
fn leaves(scene: &Scene) -> Vec<Leaf> {
    let infinite = (0..scene.lamps().len() as u32).filter(|i| scene.lamps().get(*i).is_infinite());
    let leaves = scene.lamps().parts().iter().copied();
    leaves.chain(infinite.map(|light| Leaf { light, part: 0 })).collect()
}

#[test]
fn probabilities_add_up() {
    for infinite in [false, true] {
        let scene = scene(all_kinds(infinite));
        let all = leaves(&scene);
        assert!(all.len() > 80);
        for to in receivers(300) {
            let mass = |leaf: &Leaf| scene.lamps().mass_for(&to, &point_of(&scene, *leaf, [0.5; 2])).0;
            let sum: f64 = all.iter().map(|leaf| f64::from(mass(leaf))).sum();
            assert!(sum < 1.0 + 1e-4, "{to:?}: {sum}");
            // A branch may promise light that neither of its children has: then nothing is chosen, but not often.
            // (Before a normal there may be nothing.)
            assert!(to.normal != Vec3::ZERO || sum > 0.9, "{to:?}: {sum}");
        }
    }
}

/// Of points and spheres some light comes from everywhere: nothing is chosen in vain.
#[test]
fn of_lamps_that_shine_everywhere_one_is_found() {
    let (mut d, mut s) = (build::scene(8), random(3));
    let m = build::diffuse(&mut d, 0.5);
    for i in 0..1000 {
        let at = place(&mut s, 1.0).to_array();
        if i % 2 == 0 {
            build::point_light(&mut d, at, 1.0);
        } else {
            let lamp = build::sphere(&mut d, at, 1e-3, m);
            build::emit(&mut d, lamp, 1e4);
        }
    }
    let scene = scene(d);
    for to in receivers(100).into_iter().filter(|to| to.normal == Vec3::ZERO) {
        let mass = |leaf: &Leaf| scene.lamps().mass_for(&to, &point_of(&scene, *leaf, [0.5; 2])).0;
        let sum: f64 = leaves(&scene).iter().map(|leaf| f64::from(mass(leaf))).sum();
        assert!((sum - 1.0).abs() < 1e-4, "{to:?}: {sum}");
        let lights = scene.lights(Wavelengths::Rgb);
        for _ in 0..100 {
            assert!(lights.sample_towards(to, s.next_2d(), s.next_2d()).is_some());
        }
    }
}

#[test]
fn choices_are_as_likely_as_they_say() {
    let scene = scene(all_kinds(true));
    let (lights, all) = (scene.lights(Wavelengths::Rgb), leaves(&scene));
    let tested: Vec<Receiver> = receivers(24);
    let alpha = sidak(SIGNIFICANCE, tested.len());
    for to in tested {
        let (mut s, n) = (random(4), 40_000);
        // What was chosen but sends nothing here is not returned: it is left out by both.
        let mut observed = vec![0.0; all.len()];
        for _ in 0..n {
            if let Some(t) = lights.sample_towards(to, s.next_2d(), s.next_2d()) {
                let told = lights.towards_pdf(to, &t.point).0;
                assert!((told - t.pdf.0).abs() <= 2e-4 * told, "{to:?}: {told} {t:?}");
                let light = t.point.light;
                let part = |l: &Leaf| point_of(&scene, *l, [0.3; 2]).primitive == t.point.primitive;
                let index = all.iter().position(|l| {
                    l.light == light
                        && (l.part == 0 && all.iter().filter(|m| m.light == light).count() == 1 || part(l))
                });
                observed[index.unwrap()] += 1.0;
            }
        }
        let expected: Vec<f64> = all
            .iter()
            .zip(&observed)
            .map(|(leaf, seen)| {
                let point = point_of(&scene, *leaf, [0.3; 2]);
                let mass = n as f64 * f64::from(scene.lamps().mass_for(&to, &point).0);
                // Lamps that send something for every choice of a point, or nothing.
                if *seen > 0.0 { mass } else { 0.0 }
            })
            .collect();
        // Parts of a lamp may be seen from the front or not at all; spheres from some places fail now and then.
        let both: Vec<(f64, f64)> =
            observed.iter().copied().zip(expected).filter(|(seen, _)| *seen > 0.0).collect();
        let (seen, told): (Vec<f64>, Vec<f64>) = both.into_iter().unzip();
        let rest = n as f64 - told.iter().sum::<f64>();
        let none = n as f64 - seen.iter().sum::<f64>();
        let (mut seen, mut told) = (seen, told);
        seen.push(none);
        told.push(rest.max(0.0));
        let p = chi_square_test(&seen, &told, 5.0, n as f64).p_value;
        assert!(p > alpha, "{to:?}: p = {p:e}");
    }
}

/// Wherever a lamp's light arrives, it can be found.
#[test]
fn no_light_without_a_probability() {
    for infinite in [false, true] {
        let scene = scene(all_kinds(infinite));
        let lights = scene.lights(Wavelengths::Rgb);
        let (mut s, mut lit) = (random(5), 0);
        for to in receivers(2000) {
            for leaf in leaves(&scene) {
                let point = point_of(&scene, leaf, s.next_2d());
                let (direction, distance) = point.direction_from(to.at);
                let faces = to.normal == Vec3::ZERO || to.normal.dot(direction) > 0.0;
                if distance > 0.0 && faces && !lights.radiance(&point, -direction).is_black() {
                    lit += 1;
                    let mass = scene.lamps().mass_for(&to, &point).0;
                    assert!(mass > 0.0, "{to:?} is lit by {point:?}");
                }
            }
        }
        assert!(lit > 50_000, "{lit}");
    }
}

/// The same for lamps, places and sizes of scenes at the ends of what is allowed.
#[test]
fn the_same_at_any_scale() {
    for size in [1e-6, 1.0, 1e6, 1e14] {
        let (mut d, mut s) = (build::scene(8), random(6));
        for _ in 0..100 {
            let intensity = if size > 1.0 { 1e8 } else { 1.0 };
            build::point_light(&mut d, place(&mut s, size).to_array(), intensity);
        }
        let scene = scene(d);
        for _ in 0..100 {
            let to = Receiver::from(place(&mut s, 2.0 * size));
            let mass = |leaf: &Leaf| scene.lamps().mass_for(&to, &point_of(&scene, *leaf, [0.5; 2])).0;
            let masses: Vec<f32> = leaves(&scene).iter().map(mass).collect();
            let sum: f32 = masses.iter().sum();
            assert!((sum - 1.0).abs() < 1e-3 && masses.iter().all(|m| *m > 0.0), "{size}: {sum}");
        }
    }
}

/// Lamps in one place, or on a line whose gaps double: trails have enough bits.
#[test]
fn lamps_that_no_plane_parts() {
    let (mut heap, mut line) = (build::scene(8), build::scene(8));
    for i in 0..5000 {
        build::point_light(&mut heap, [1.0, 2.0, 3.0], 1.0);
        let x = libm::exp2f(-100.0 + 0.02 * i as f32 * 1.2);
        build::point_light(&mut line, [x, 0.0, 0.0], 1.0);
    }
    for d in [heap, line] {
        let scene = scene(d);
        let to = Receiver::from(Vec3::new(0.5, 0.5, 0.5));
        let mass = |leaf: &Leaf| f64::from(scene.lamps().mass_for(&to, &point_of(&scene, *leaf, [0.5; 2])).0);
        let sum: f64 = leaves(&scene).iter().map(mass).sum();
        assert!((sum - 1.0).abs() < 1e-3, "{sum}");
    }
}

/// The same lamps make the same hierarchy.
#[test]
fn the_same_twice() {
    let [a, b] = [(); 2].map(|()| scene(all_kinds(true)));
    assert_eq!(a.lamps().parts(), b.lamps().parts());
    for to in receivers(100) {
        for leaf in leaves(&a) {
            let mass = |scene: &Scene| scene.lamps().mass_for(&to, &point_of(scene, leaf, [0.5; 2])).0;
            assert_eq!(mass(&a).to_bits(), mass(&b).to_bits());
        }
    }
}

/// What is near is likelier, and few lamps are chosen by power alone.
#[test]
fn near_lamps_are_likelier_where_there_are_many() {
    let row = |n: u32| {
        let mut d = build::scene(8);
        for i in 0..n {
            build::point_light(&mut d, [i as f32, 0.0, 0.0], 1.0);
        }
        scene(d)
    };
    let to = Receiver::from(Vec3::new(0.0, 0.5, 0.0));
    let first =
        |scene: &Scene| scene.lamps().mass_for(&to, &point_of(scene, Leaf { light: 0, part: 0 }, [0.5; 2])).0;
    assert!(row(4).lamps().parts().is_empty() && (first(&row(4)) - 0.25).abs() < 1e-6);
    assert!(first(&row(1000)) > 0.3, "{}", first(&row(1000)));
}
