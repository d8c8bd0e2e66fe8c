//! The colours of materials, as layers show them.

use caustica_math::{Rgb, Vec3, Wavelengths};
use caustica_scene::description::{BumpRule, MaterialId, MaterialKind, Roughness, Texture, Wrapper};
use caustica_scene::{Description, Scene};
use caustica_testkit::build::{quad, scene};

const GREEN: Rgb = Rgb([0.2, 0.5, 0.3]);
const RED: Rgb = Rgb([0.9, 0.1, 0.1]);

/// The albedo of a square of that material, seen from in front or from behind.
fn albedo(make: impl Fn(&mut Description) -> MaterialId, in_front: bool) -> Rgb {
    let mut d = scene(1);
    let material = make(&mut d);
    quad(&mut d, [0.0, 0.0, 5.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], material);
    let scene = Scene::new(d).unwrap().0;
    let prev = if in_front { Vec3::Z } else { -Vec3::Z };
    let point = scene.surfaces().some_point(0);
    Wavelengths::Rgb.rgb(scene.albedo(&point, prev, Wavelengths::Rgb))
}

#[track_caller]
fn near(found: Rgb, expected: Rgb) {
    let close = found.0.iter().zip(expected.0).all(|(a, b)| (a - b).abs() < 2e-4);
    assert!(close, "{found:?} is not {expected:?}");
}

fn plain(kind: MaterialKind) -> Rgb {
    albedo(|d| d.add_material(kind), true)
}

#[test]
fn materials() {
    let green = Texture::Constant(GREEN);
    near(plain(MaterialKind::Diffuse { albedo: green }), GREEN);
    near(plain(MaterialKind::Mirror { reflectance: RED }), RED);
    near(plain(MaterialKind::dielectric(1.5, 1.0)), Rgb::WHITE);
    near(plain(MaterialKind::rough_dielectric(Roughness::ggx(0.2), 1.5, 1.0)), Rgb::WHITE);
    near(plain(MaterialKind::Null), Rgb::WHITE);
    let (diffuse, reflectance) = (green, Rgb::WHITE.into());
    let (interior_ior, exterior_ior, nonlinear) = (1.5, 1.0, true);
    near(plain(MaterialKind::Plastic { interior_ior, exterior_ior, diffuse, reflectance, nonlinear }), GREEN);
    near(plain(MaterialKind::Microfacet { alpha: 0.1, interior_ior, exterior_ior, kd: green }), GREEN);
    // Of metal ((η − 1)² + k²)/((η + 1)² + k²), and of glass and sheets what they reflect and what they let through.
    let metal = MaterialKind::conductor(Rgb::new(0.2, 1.0, 2.0), Rgb::splat(3.0));
    near(plain(metal), Rgb::new(9.64 / 10.44, 9.0 / 13.0, 10.0 / 18.0));
    let transmittance = green;
    let glass = MaterialKind::Dielectric { interior_ior, exterior_ior, reflectance, transmittance };
    near(plain(glass), Rgb::splat(0.04) + GREEN * 0.96);
    let thin = MaterialKind::ThinDielectric { interior_ior, exterior_ior, reflectance, transmittance };
    near(plain(thin), Rgb::splat(0.08 / 1.04) + GREEN * (1.0 - 0.08 / 1.04));
}

#[test]
fn wrappers() {
    let colours = |d: &mut Description| {
        [GREEN, RED].map(|c| d.add_material(MaterialKind::Diffuse { albedo: c.into() }))
    };
    let wrapped = |d: &mut Description, wrapper| d.add_material(MaterialKind::Wrapped(wrapper));
    let blend = |weight: f32| {
        move |d: &mut Description| {
            let inner = colours(d);
            wrapped(d, Wrapper::Blend { weight: Rgb::splat(weight).into(), inner })
        }
    };
    near(albedo(blend(0.25), true), GREEN * 0.75 + RED * 0.25);
    near(albedo(blend(0.0), true), GREEN);
    let mask = |d: &mut Description| {
        let [inner, _] = colours(d);
        wrapped(d, Wrapper::Mask { opacity: Rgb::splat(0.1).into(), inner })
    };
    near(albedo(mask, true), GREEN);
    let sides = |d: &mut Description| {
        let [front, back] = colours(d);
        let rule = BumpRule { flips: true, shadows: true };
        let front = wrapped(d, Wrapper::NormalMap { normals: Rgb::WHITE.into(), rule, inner: front });
        wrapped(d, Wrapper::TwoSided { front, back })
    };
    near(albedo(sides, true), GREEN);
    near(albedo(sides, false), RED);
    // Blends of blends, as many ways as leaves of a tree of depth 40: it must end, and near the mean.
    let deep = |d: &mut Description| {
        (0..40).fold(colours(d), |inner, _| {
            let mixed = wrapped(d, Wrapper::Blend { weight: Rgb::splat(0.5).into(), inner });
            [mixed, mixed]
        })[0]
    };
    let mixed = albedo(deep, true);
    assert!(mixed.is_valid() && mixed.max_channel() <= 0.9, "{mixed:?}");
}
