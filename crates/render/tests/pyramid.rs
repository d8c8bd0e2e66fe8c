//! The pyramid's strategies add up to the picture.

use caustica_film::{Film, Picture};
use caustica_math::Rgb;
use caustica_math::stats::{Moments, sidak, welch_t_test};
use caustica_render::pyramid::Pyramid;
use caustica_render::{Control, RenderOptions, Session};
use caustica_scene::description::{LightKind, MaterialKind};
use caustica_scene::{Description, Scene};
use caustica_testkit::agreement::flatten;
use caustica_testkit::build::{diffuse, glass, light, look, quad, sphere};
use caustica_testkit::scenes::{ball, glass_kind, open_box, under_the_sky};
use caustica_testkit::seed::seed;
use caustica_transport::Settings;

fn options(samples: u32) -> RenderOptions {
    let settings = Settings { max_depth: Some(9), seed: 5, ..Settings::default() };
    RenderOptions { settings, samples, threads: Some(2), ..RenderOptions::default() }
}

fn scene(description: Description) -> Scene {
    flatten(description)
}

fn sums(film: &Film) -> Vec<i64> {
    film.sums().flatten().collect()
}

fn add(mut a: Vec<i64>, b: &Film) -> Vec<i64> {
    a.iter_mut().zip(sums(b)).for_each(|(a, b)| *a += b);
    a
}

#[test]
fn weighted_strategies_add_up_to_the_picture_to_the_bit() {
    for description in [open_box(), ball(glass_kind(false)), under_the_sky(glass_kind(false))] {
        let scene = scene(description);
        let pyramid = Pyramid::new(&scene, options(6), 4).unwrap();
        pyramid.run(&Control::default(), |_| ()).unwrap();
        assert_eq!(pyramid.layers().len(), 2 + 3 + 4 + 5);
        let together = pyramid.layers().iter().fold(sums(pyramid.rest()), |a, l| add(a, &l.weighted));
        assert_eq!(together, sums(pyramid.whole()));
        assert!(pyramid.whole().sums().flatten().any(|s| s != 0));
        assert_eq!(pyramid.whole().invalid(), 0);
    }
}

/// Weights lie between 0 and 1: up to rounding, no strategy's weighted light is negative, or more than without weights.
#[test]
fn weights_only_lessen() {
    let scene = scene(open_box());
    let samples = 6;
    let pyramid = Pyramid::new(&scene, options(samples), 4).unwrap();
    pyramid.run(&Control::default(), |_| ()).unwrap();
    for layer in pyramid.layers() {
        for (w, u) in sums(&layer.weighted).into_iter().zip(sums(&layer.unweighted)) {
            // Rounding, and the remainder of every other strategy's.
            let off = 20 * i64::from(samples) + u / 100_000;
            assert!(-off <= w && w <= u + off, "{}: {w} of {u}", layer.strategy);
        }
    }
}

/// Only strategies with t = 1 are in the light image, and those with t ≥ 2 in the eye image.
#[test]
fn strategies_keep_to_their_image() {
    let scene = scene(open_box());
    let pyramid = Pyramid::new(&scene, options(4), 3).unwrap();
    pyramid.run(&Control::default(), |_| ()).unwrap();
    for layer in pyramid.layers() {
        for film in [&layer.weighted, &layer.unweighted] {
            let lit = |channels: std::ops::Range<usize>| {
                film.sums().any(|s| s[channels.clone()].iter().any(|c| *c != 0))
            };
            let (eye, light) = (lit(0..3), lit(3..6));
            assert!(if layer.strategy.t == 1 { !eye } else { !light }, "{}", layer.strategy);
            assert!(eye || light, "{} is black", layer.strategy);
        }
    }
}

/// Where no weight is less than one, the weighted and the unweighted picture are the same: the lamp seen directly
/// and nothing else, by one strategy.
#[test]
fn unweighted_pictures_hold_all_of_their_light() {
    let scene = scene(open_box());
    let only = |strategies: &str| {
        let mut options = options(16);
        options.settings.strategies = strategies.parse().unwrap();
        let pyramid = Pyramid::new(&scene, options, 9).unwrap();
        pyramid.run(&Control::default(), |_| ()).unwrap();
        pyramid
    };
    let pyramid = only("s=0");
    for layer in pyramid.layers() {
        let [weighted, unweighted] = [&layer.weighted, &layer.unweighted].map(|f| f.develop().eye);
        for (w, u) in weighted.iter().zip(&unweighted) {
            let near = |c: usize| (w.0[c] - u.0[c]).abs() <= 1e-4 * u.0[c] + 1e-6;
            assert!((0..3).all(near), "{}: {w:?} {u:?}", layer.strategy);
        }
    }
}

/// Aimed rays share the paths of s = 0 with the walk, and the picture without weights holds the light of both: as much
/// as the walk finds alone, by Welch's t-test at 10⁻³ over parts of different seeds, Šidák-corrected over the strategies.
#[test]
fn unweighted_pictures_of_aimed_rays_hold_the_same_light() {
    // A floor under a sky, with a ball of glass that is seen in a mirror.
    let mut d = caustica_testkit::build::scene(6);
    look(&mut d, [0.0, 0.3, -0.6], [0.0, -0.35, 0.6]);
    let grey = diffuse(&mut d, 0.6);
    let mirror = d.add_material(MaterialKind::Mirror { reflectance: Rgb::splat(0.9) });
    let glass = glass(&mut d);
    quad(&mut d, [-1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], grey);
    sphere(&mut d, [0.0, -0.4, 0.6], 0.4, mirror);
    sphere(&mut d, [0.1, -0.7, -0.2], 0.25, glass);
    light(&mut d, LightKind::Constant { radiance: Rgb::splat(1.0) });
    let scene = scene(d);
    // The lengths of paths from the floor that is seen in the mirror through glass to the sky.
    let lengths = 3..=6;
    let [without, with] = [0, 2].map(|aimed_rays| {
        let mut means = vec![Moments::default(); 7];
        for part in 0..24 {
            let mut options = options(400);
            options.settings.aimed_rays = aimed_rays;
            options.settings.seed = seed(100 * u64::from(aimed_rays) + part);
            let pyramid = Pyramid::new(&scene, options, 6).unwrap();
            pyramid.run(&Control::default(), |_| ()).unwrap();
            for layer in pyramid.layers().iter().filter(|l| l.strategy.s == 0) {
                let eye = layer.unweighted.develop().eye;
                let mean = eye.iter().map(|p| f64::from(p.0[1])).sum::<f64>() / eye.len() as f64;
                means[layer.strategy.t as usize - 1].push(mean);
            }
        }
        means
    });
    let level = sidak(1e-3, lengths.clone().count());
    for edges in lengths {
        let p = welch_t_test(&without[edges], &with[edges], 0.0);
        println!("{edges} edges: {:.5} for {:.5}, p = {p:.2e}", with[edges].mean, without[edges].mean);
        assert!(p > level && with[edges].mean > 0.0, "{edges} edges: p = {p:.1e}");
    }
    // The rays were aimed: nothing else differs.
    assert!(with[6].variance() < without[6].variance() && with[6].mean != without[6].mean);
}

/// The whole is the picture that a session makes, but for roulette among small contributions.
#[test]
fn the_whole_is_the_picture() {
    let scene = scene(open_box());
    let pyramid = Pyramid::new(&scene, options(64), 2).unwrap();
    pyramid.run(&Control::default(), |_| ()).unwrap();
    let session = Session::new(&scene, options(64)).unwrap();
    session.run(&Control::default(), |_| ()).unwrap();
    let mean = |picture: Picture| {
        picture.eye.iter().chain(&picture.light).flat_map(|p| p.0).map(f64::from).sum::<f64>()
    };
    let (ours, theirs) = (mean(pyramid.whole().develop()), mean(session.film().develop()));
    assert!((ours / theirs - 1.0).abs() < 1e-3, "{ours} {theirs}");
    // Light paths are the same, and all of them are kept.
    assert_eq!(pyramid.whole().develop().light, session.film().develop().light);
}

/// The films do not depend on the number of threads.
#[test]
fn threads_do_not_matter() {
    let scene = scene(ball(glass_kind(false)));
    let films = [1, 3].map(|threads| {
        let pyramid =
            Pyramid::new(&scene, RenderOptions { threads: Some(threads), ..options(3) }, 3).unwrap();
        pyramid.run(&Control::default(), |_| ()).unwrap();
        pyramid
            .layers()
            .iter()
            .map(|l| (l.weighted.fingerprint(), l.unweighted.fingerprint()))
            .collect::<Vec<_>>()
    });
    assert_eq!(films[0], films[1]);
}
