//! Normals that are not the surface's own: densities, and what the two rules say.
//!
//! Together the tests of each function have the significance level 0.01 (Šidák); seeds are fixed.

use crate::registry::{WALKS, metal, next_3d, random, random_direction};
use caustica_math::stats::sidak;
use caustica_math::{Frame, Spectrum, Vec3};
use caustica_scene::bsdf::{Bsdf, Bump, Dielectric, Diffuse, Facets, RoughConductor, RoughDielectric, Walk};
use caustica_scene::description::BumpRule;
use caustica_testkit::chi_square::{ChiSquareConfig, chi_square_sphere};

const RULES: [BumpRule; 2] =
    [BumpRule { flips: true, shadows: true }, BumpRule { flips: false, shadows: false }];

fn bumps() -> Vec<Bump> {
    let normals = [[0.0, 0.0, 1.0], [0.3, -0.1, 1.0], [-0.9, 0.8, 1.0]].map(|n| Vec3::from(n).normalized());
    RULES.into_iter().flat_map(|rule| normals.map(|normal| Bump { normal, rule })).collect()
}

fn bsdfs() -> Vec<Bsdf> {
    vec![
        Bsdf::Diffuse(Diffuse { albedo: Spectrum([0.9, 0.5, 0.2, 0.0]) }),
        Bsdf::RoughConductor(RoughConductor::new(metal("Cu", Spectrum::ONE), Facets::ggx(0.3))),
        Bsdf::RoughDielectric(RoughDielectric::new(Facets::ggx(0.3), Dielectric::new(1.5, 1.0))),
    ]
}

fn given() -> [Vec3; 4] {
    [[0.0, 0.0, 1.0], [0.6, 0.2, 0.5], [-0.8, 0.7, 0.1], [0.5, -0.4, -0.6]]
        .map(|d| Vec3::from(d).normalized())
}

#[test]
fn samples_follow_their_densities() {
    let mut found = vec![];
    for (bsdf, bump) in bsdfs().iter().flat_map(|bsdf| bumps().into_iter().map(move |bump| (bsdf, bump))) {
        for walk in WALKS {
            for given in given().into_iter().filter(|g| g.z > 0.0 || bsdf.transmits()) {
                let name = format!("{bsdf:?} {bump:?} {walk:?} {given:?}");
                let mut sample = |u| bump.sample(bsdf, walk, given, u).map(|s| s.direction);
                let pdf = |v: Vec3| {
                    f64::from(match walk {
                        Walk::FromCamera => bump.eval(bsdf, v, given).to_light_pdf.get(),
                        Walk::FromLight => bump.eval(bsdf, given, v).to_camera_pdf.get(),
                    })
                };
                let config =
                    ChiSquareConfig { samples: 20_000, tolerance: 5e-3, ..ChiSquareConfig::default() };
                found.push((chi_square_sphere(&name, &mut sample, &pdf, config).unwrap(), name));
            }
        }
    }
    let level = sidak(0.01, found.len());
    for (p, name) in found {
        assert!(p > level, "{name}: p = {p:e}");
    }
}

#[test]
fn samples_agree_with_eval() {
    for (bsdf, bump) in bsdfs().iter().flat_map(|bsdf| bumps().into_iter().map(move |bump| (bsdf, bump))) {
        let mut stream = random(20);
        for (walk, _) in WALKS.into_iter().flat_map(|w| (0..2_000).map(move |i| (w, i))) {
            let given = random_direction(&mut stream);
            let Some(s) = bump.sample(bsdf, walk, given, next_3d(&mut stream)) else { continue };
            let (e, pdf, reverse) = match walk {
                Walk::FromCamera => {
                    let e = bump.eval(bsdf, s.direction, given);
                    (e, e.to_light_pdf, e.to_camera_pdf)
                }
                Walk::FromLight => {
                    let e = bump.eval(bsdf, given, s.direction);
                    (e, e.to_camera_pdf, e.to_light_pdf)
                }
            };
            let all = [e.value.0[1], pdf.get(), reverse.get()];
            assert_eq!(all, [s.value.0[1], s.pdf.get(), s.reverse_pdf.get()], "{bump:?}");
            assert!(all.iter().all(|x| x.is_finite() && *x > 0.0), "{all:?}");
        }
    }
}

/// A normal that is the surface's own changes nothing but what is rounded.
#[test]
fn the_own_normal_is_no_bump() {
    for (bsdf, rule) in bsdfs().iter().flat_map(|b| RULES.map(|r| (b, r))) {
        let bump = Bump { normal: Vec3::Z, rule };
        let mut stream = random(21);
        for _ in 0..1_000 {
            let (l, c) = (random_direction(&mut stream), random_direction(&mut stream));
            let (a, b) = (bump.eval(bsdf, l, c), bsdf.eval(l, c));
            let close = |a: f32, b: f32| (a - b).abs() <= 1e-4 * b.abs();
            assert!(close(a.value[1], b.value[1]), "{a:?} {b:?}");
            if !b.value.is_black() {
                assert!(close(a.to_light_pdf.get(), b.to_light_pdf.get()), "{a:?} {b:?}");
                assert!(close(a.to_camera_pdf.get(), b.to_camera_pdf.get()), "{a:?} {b:?}");
            }
        }
    }
}

/// The value is the BSDF's in the other frame, where light goes to decides which one; nothing is scattered between
/// different sides of the two normals.
#[test]
fn what_the_rules_say() {
    let bsdf = Bsdf::Diffuse(Diffuse { albedo: Spectrum([0.9, 0.5, 0.2, 0.0]) });
    let mut seen = [0; 3];
    for bump in bumps() {
        let mut stream = random(22);
        for _ in 0..2_000 {
            let (l, c) = (random_direction(&mut stream), random_direction(&mut stream));
            let n = bump.normal;
            let away = c.z * c.dot(n) <= 0.0;
            let n = if away && bump.rule.flips { Vec3::new(-n.x, -n.y, n.z) } else { n };
            let lit = l.z > 0.0 && c.z > 0.0 && l.dot(n) > 0.0 && c.dot(n) > 0.0;
            let tan2 = |v: Vec3| (1.0 - v.z * v.z) / (v.z * v.z);
            let dimmed = 2.0 / (1.0 + (1.0 + (tan2(n) / 8.0).min(1.0) * tan2(l)).sqrt());
            let dimmed = if bump.rule.shadows { dimmed } else { 1.0 };
            let expected = if lit { 0.5 * std::f32::consts::FRAC_1_PI * l.dot(n) * dimmed } else { 0.0 };
            let found = bump.eval(&bsdf, l, c).value[1];
            assert!(
                (found - expected).abs() <= 1e-4 * (expected + 1e-3),
                "{bump:?} {l:?} {c:?}: {found} {expected}"
            );
            seen[usize::from(lit) + usize::from(lit && away)] += 1;
        }
    }
    assert!(seen.iter().all(|n| *n > 50), "{seen:?}");
}

#[test]
fn frames_are_frames() {
    for bump in bumps() {
        for f in [bump.frame(false), bump.frame(true)] {
            let Frame { x, y, z } = f;
            assert!((x.cross(y) - z).length() < 1e-5 && x.dot(z).abs() < 1e-6 && z.z > 0.0);
        }
        assert_eq!(bump.share(false) + bump.share(true), 1.0);
    }
}
