//! Materials made of others: what a point is, how often, and what is refused.

use caustica_math::{Frame, Rgb, Vec2, Vec3, Wavelengths};
use caustica_scene::bsdf::{Bsdf, Walk};
use caustica_scene::bvh::Ray;
use caustica_scene::description::{
    BumpRule, Image, Material, MaterialId, MaterialKind, Texture, TextureTransform, Wrapper,
};
use caustica_scene::surface::SurfacePoint;
use caustica_scene::{Description, Origin, Scene};
use caustica_testkit::build::{diffuse, emit, glass, quad, scene, sphere};
use caustica_testkit::materials::{blend, bump, mask, normal_map, thin_glass, two_sided};

/// A square of 2 in z = 0, facing +z, of the material, under a lamp.
fn square(make: impl Fn(&mut Description) -> MaterialId) -> Scene {
    let mut d = scene(4);
    let m = make(&mut d);
    quad(&mut d, [-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], m);
    let black = diffuse(&mut d, 0.0);
    let lamp = quad(&mut d, [-1.0, -1.0, 9.0], [0.0, 2.0, 0.0], [2.0, 0.0, 0.0], black);
    emit(&mut d, lamp, 1.0);
    Scene::new(d).unwrap().0
}

fn point(scene: &Scene, at: [f32; 2]) -> SurfacePoint {
    let ray = Ray { origin: Vec3::new(at[0], at[1], 1.0), direction: -Vec3::Z, t_max: 2.0 };
    scene.closest(&ray).unwrap()
}

/// The albedo of the diffuse part that it is; `None` for none.
fn part(scene: &Scene, at: [f32; 2], prev: Vec3, label: f64) -> Option<f32> {
    match scene.placed(&point(scene, at), prev, label, Wavelengths::Rgb).bsdf {
        Bsdf::Diffuse(d) => Some(d.albedo[0]),
        Bsdf::Null => None,
        other => panic!("{other:?}"),
    }
}

#[test]
fn parts_are_as_frequent_as_they_are_large() {
    let nested = square(|d| {
        let [a, b, c] = [0.1, 0.2, 0.3].map(|albedo| diffuse(d, albedo));
        let inner = blend(d, Rgb::splat(0.25), [a, b]);
        let outer = blend(d, Rgb::splat(0.5), [inner, c]);
        mask(d, Rgb::splat(0.8).into(), outer)
    });
    let n = 10_000;
    let mut counts = std::collections::BTreeMap::new();
    for i in 0..n {
        let label = (f64::from(i) + 0.5) / f64::from(n);
        *counts.entry(part(&nested, [0.3, 0.2], Vec3::Z, label).map(f32::to_bits)).or_insert(0) += 1;
    }
    for (part, share) in [(Some(0.1), 0.3), (Some(0.2), 0.1), (Some(0.3_f32), 0.4), (None, 0.2)] {
        let found = f64::from(counts[&part.map(f32::to_bits)]) / f64::from(n);
        assert!((found - share).abs() < 1e-3, "{part:?}: {found} of {share}");
    }
}

#[test]
fn whole_parts_leave_nothing_to_chance() {
    let ends = [0.0, 0.5, 1.0 - f64::EPSILON];
    for label in ends {
        let with = |opacity: f32| {
            let s = square(|d| {
                let inner = diffuse(d, 0.1);
                mask(d, Rgb::splat(opacity).into(), inner)
            });
            part(&s, [0.0; 2], Vec3::Z, label)
        };
        assert_eq!([with(0.0), with(1.0), with(7.0)], [None, Some(0.1), Some(0.1)]);
        let with = |weight: f32| {
            let s = square(|d| {
                let inner = [diffuse(d, 0.1), diffuse(d, 0.2)];
                blend(d, Rgb::splat(weight), inner)
            });
            part(&s, [0.0; 2], Vec3::Z, label)
        };
        assert_eq!([with(0.0), with(1.0)], [Some(0.1), Some(0.2)]);
    }
    // A texture decides by the place.
    let s = square(|d| {
        let inner = diffuse(d, 0.1);
        let (value1, value2) = (Rgb::WHITE, Rgb::BLACK);
        let opacity =
            Texture::Checkerboard { delta: [0.0; 2], scale: [0.5; 2], shear: [0.0; 2], value1, value2 };
        mask(d, opacity, inner)
    });
    assert_eq!(part(&s, [-0.5, -0.5], Vec3::Z, 0.5), Some(0.1));
    assert_eq!(part(&s, [0.5, -0.5], Vec3::Z, 0.5), None);
}

#[test]
fn each_side_is_its_own_front() {
    let s = square(|d| {
        let (front, back) = (diffuse(d, 0.1), diffuse(d, 0.2));
        two_sided(d, front, back)
    });
    let up = Vec3::new(0.1, 0.2, 0.9).normalized();
    let placed = |prev| s.placed(&point(&s, [0.0; 2]), prev, 0.0, Wavelengths::Rgb);
    assert_eq!((part(&s, [0.0; 2], up, 0.0), placed(up).turned), (Some(0.1), false));
    assert_eq!((part(&s, [0.0; 2], -up, 0.0), placed(-up).turned), (Some(0.2), true));
    // The back of the back is seen from in front.
    let s = square(|d| {
        let [a, b, c] = [0.1, 0.2, 0.3].map(|albedo| diffuse(d, albedo));
        let inner = two_sided(d, b, c);
        two_sided(d, a, inner)
    });
    assert_eq!(part(&s, [0.0; 2], -up, 0.0), Some(0.2));
}

fn ramp(d: &mut Description, scale: f32) -> MaterialId {
    let pixels = [0.0, 1.0, 2.0, 3.0].map(Rgb::splat).into();
    let image = d.add_image(Image { width: 4, height: 1, pixels });
    let inner = diffuse(d, 0.5);
    let height = Texture::Image { image, transform: TextureTransform::default() };
    d.add_material(MaterialKind::Wrapped(Wrapper::Bump { height, scale, rule: BumpRule::default(), inner }))
}

/// A ramp that rises by 4·scale over u = 1, which is 2 in space, leans back by half the slope.
#[test]
fn bumps_lean_away_from_the_slope() {
    let s = square(|d| ramp(d, 0.3));
    let p = point(&s, [0.1, 0.2]);
    let placed = s.placed(&p, Vec3::Z, 0.0, Wavelengths::Rgb);
    let normal = p.frame.to_world(placed.bump.unwrap().normal);
    assert!((normal - Vec3::new(-0.6, 0.0, 1.0).normalized()).length() < 1e-5, "{normal:?}");
}

/// Heights against a sphere's own geometry: a bump that grows with u leans the normal towards smaller longitudes.
#[test]
fn bumps_on_spheres() {
    let mut d = scene(4);
    let m = ramp(&mut d, 0.1);
    sphere(&mut d, [0.0; 3], 2.0, m);
    let black = diffuse(&mut d, 0.0);
    let lamp = quad(&mut d, [-1.0, -1.0, 9.0], [0.0, 2.0, 0.0], [2.0, 0.0, 0.0], black);
    emit(&mut d, lamp, 1.0);
    let s = Scene::new(d).unwrap().0;
    let p = s.closest(&Ray { origin: Vec3::new(5.0, 0.1, 0.3), direction: -Vec3::X, t_max: 9.0 }).unwrap();
    let normal = p.frame.to_world(s.placed(&p, Vec3::X, 0.0, Wavelengths::Rgb).bump.unwrap().normal);
    let [by_u, by_v] = s.surfaces().derivatives(&p).unwrap();
    // It is at right angles to what is raised by 0.4 a unit of u and nothing by v.
    let raised = by_u + p.normal * 0.4;
    assert!(normal.dot(raised).abs() < 1e-4 * raised.length() && normal.dot(by_v).abs() < 1e-4, "{normal:?}");
    assert!(normal.dot(p.normal) > 0.9);
}

#[test]
fn normal_maps_tell_the_normal() {
    let s = square(|d| {
        let inner = diffuse(d, 0.5);
        let rule = BumpRule::default();
        let normals = Rgb::new(0.8, 0.5, 0.9).into();
        d.add_material(MaterialKind::Wrapped(Wrapper::NormalMap { normals, rule, inner }))
    });
    let p = point(&s, [0.1, 0.2]);
    let normal = |s: &Scene, prev| {
        let placed = s.placed(&p, prev, 0.0, Wavelengths::Rgb);
        placed.bump.unwrap().normal
    };
    let expected = Vec3::new(0.6, 0.0, 0.8).normalized();
    assert!((p.frame.to_world(normal(&s, Vec3::Z)) - expected).length() < 1e-6);
    // On the back of a sheet it leans the same way in space as the sheet's own normal is turned.
    let s = square(|d| {
        let inner = diffuse(d, 0.5);
        let (rule, normals) = (BumpRule::default(), Rgb::new(0.8, 0.5, 0.9).into());
        let both = two_sided(d, inner, inner);
        d.add_material(MaterialKind::Wrapped(Wrapper::NormalMap { normals, rule, inner: both }))
    });
    let turned = Frame { z: -p.frame.z, ..p.frame };
    assert!((turned.to_world(normal(&s, -Vec3::Z)) + expected).length() < 1e-6);
}

#[test]
fn thin_glass_reflects_twice() {
    let s = square(|d| d.add_material(thin_glass()));
    let bsdf = s.bsdf(&point(&s, [0.0; 2]), Wavelengths::Rgb);
    // R = 0.04 at each side: 2R/(1 + R).
    let found = bsdf.sample(Walk::FromCamera, Vec3::Z, [0.0; 3]).unwrap();
    assert!((found.value[0] - 0.08 / 1.04).abs() < 1e-6, "{found:?}");
    let through = bsdf.sample(Walk::FromLight, -Vec3::Z, [0.0, 0.0, 0.9]).unwrap();
    assert!((through.value[0] - 0.96 / 1.04).abs() < 1e-6 && through.direction == Vec3::Z, "{through:?}");
    assert_eq!(bsdf.radiance_scale(1.0, -1.0), 1.0);
}

/// Only what asks for it pays.
#[test]
fn flags() {
    let flags = |make: &dyn Fn(&mut Description) -> MaterialId| {
        let s = square(make);
        let f = s.surfaces().shapes[0];
        [f.needs_uv, f.needs_tangents, f.is_wrapped, f.is_mixed]
    };
    let grey = |d: &mut Description| diffuse(d, 0.5);
    assert_eq!(flags(&grey), [false; 4]);
    assert_eq!(flags(&|d| d.add_material(MaterialKind::Null)), [false, false, true, false]);
    let masked = |d: &mut Description| {
        let inner = grey(d);
        mask(d, Rgb::splat(0.5).into(), inner)
    };
    assert_eq!(flags(&masked), [false, false, true, true]);
    let bumped = |d: &mut Description| {
        let inner = masked(d);
        bump(d, 0.1, BumpRule::default(), inner)
    };
    assert_eq!(flags(&bumped), [true, true, true, true]);
    let mapped = |d: &mut Description| {
        let inner = grey(d);
        normal_map(d, 0.1, BumpRule::default(), inner)
    };
    assert_eq!(flags(&mapped), [true, true, true, false]);
}

fn refused(make: impl Fn(&mut Description) -> MaterialId) -> String {
    let mut d = scene(4);
    let m = make(&mut d);
    for (i, m) in d.materials.iter_mut().enumerate() {
        m.origin = Some(Origin { file: "a.xml".into(), line: 1 + i as u32, column: 2, span: None });
    }
    sphere(&mut d, [0.0; 3], 1.0, m);
    Scene::new(d).expect_err("it is refused").to_string()
}

#[test]
fn what_cannot_be_made() {
    let message = refused(|d| {
        let clear = glass(d);
        two_sided(d, clear, clear)
    });
    assert!(
        message.starts_with("a.xml:2:2: a two-sided material is made of one that light passes"),
        "{message}"
    );
    let message = refused(|d| {
        let inner = mask(d, Rgb::WHITE.into(), MaterialId(1));
        mask(d, Rgb::WHITE.into(), inner)
    });
    assert!(message.contains("one is inside of itself"), "{message}");
    let message = refused(|d| mask(d, Rgb::WHITE.into(), MaterialId(7)));
    assert!(message.starts_with("a.xml:1:2: a material is made of one that does not exist"), "{message}");
    let deep = |n: u32| {
        move |d: &mut Description| {
            let mut m = diffuse(d, 0.5);
            // Twice each: what is looked at once a path would take for ever.
            (0..n).for_each(|_| m = blend(d, Rgb::splat(0.5), [m, m]));
            // The outermost first.
            let last = d.materials.len() - 1;
            let Material { kind, .. } = d.materials[last].clone();
            d.materials.insert(0, Material { kind, origin: None });
            for m in &mut d.materials {
                if let MaterialKind::Wrapped(Wrapper::Blend { inner, .. }) = &mut m.kind {
                    inner.iter_mut().for_each(|id| id.0 += 1);
                }
            }
            MaterialId(0)
        }
    };
    assert!(refused(deep(65)).contains("nested more than 64 deep"));
    square(deep(60));
    let message = refused(|d| {
        let inner = diffuse(d, 0.5);
        bump(d, f32::NAN, BumpRule::default(), inner)
    });
    assert!(message.contains("the scale of a bump map is not finite"), "{message}");
}

#[test]
fn uvs_lie_as_the_tests_here_believe() {
    let s = square(|d| ramp(d, 0.3));
    let p = point(&s, [0.1, 0.2]);
    assert!((p.uv.x - 0.55).abs() < 1e-6 && (p.uv.y - 0.6).abs() < 1e-6 && p.uv != Vec2::default());
}
