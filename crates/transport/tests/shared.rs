//! Light paths that pixels share: which, how often, and what that gains.

use std::collections::BTreeSet;
use std::f32::consts::PI;

use caustica_math::elementary::sin;
use caustica_math::stats::{Moments, sidak, student_t_test};
use caustica_math::{Rgb, Vec2};
use caustica_scene::Scene;
use caustica_scene::description::{CameraKind, Crop};
use caustica_testkit::agreement::flatten;
use caustica_testkit::scenes::{ball, glass_kind, point_furnace};
use caustica_testkit::seed::seed;
use caustica_transport::{Contribution, Kernel, Scratch, Settings, Sink};

/// The scene, seen through a window.
fn seen_through(window: Crop) -> Scene {
    let mut d = ball(glass_kind(false));
    (d.film.width, d.film.height) = (window.x + window.width, window.y + window.height);
    d.film.crop = Some(window);
    flatten(d)
}

fn pixels(w: Crop) -> impl Iterator<Item = [u32; 2]> {
    (0..w.width * w.height).map(move |i| [w.x + i % w.width, w.y + i / w.width])
}

fn settings(shared_light_paths: u32) -> Settings {
    Settings { shared_light_paths, max_depth: Some(8), seed: seed(3), ..Settings::default() }
}

/// All that a sample gives, to the bit, and from how many points of lamps light paths came that it was joined with.
#[derive(Debug, Default, PartialEq)]
struct Heard {
    eye: Vec<[u32; 3]>,
    splats: Vec<([u32; 2], [u32; 3])>,
    lamps: BTreeSet<[u32; 3]>,
}

impl Sink for Heard {
    const PROBES: bool = true;

    fn eye(&mut self, value: Rgb) {
        self.eye.push(value.0.map(f32::to_bits));
    }

    fn splat(&mut self, film: Vec2, value: Rgb) {
        self.splats.push(([film.x.to_bits(), film.y.to_bits()], value.0.map(f32::to_bits)));
    }

    fn contribution(&mut self, c: &Contribution<'_>) {
        if c.strategy.s > 1 && c.strategy.t > 1 {
            let at = c.path.lamp.at;
            self.lamps.insert([at.x, at.y, at.z].map(f32::to_bits));
        }
    }
}

fn heard(kernel: &Kernel<'_>, pixel: [u32; 2], sample: u32, scratch: &mut Scratch) -> Heard {
    let mut heard = Heard::default();
    kernel.sample(pixel, sample, scratch, &mut heard);
    heard
}

#[test]
fn samples_do_not_depend_on_what_was_asked_for_before() {
    for (width, height) in [(19, 10), (1, 7), (2, 2), (1, 1)] {
        let window = Crop { x: 3, y: 5, width, height };
        let scene = seen_through(window);
        for shared in [1, 2, 4, 8, 16] {
            let (kernel, other) = (Kernel::new(&scene, settings(shared)), Kernel::new(&scene, settings(4)));
            let mut scratch = Scratch::default();
            let order = kernel.in_groups(pixels(window));
            let sorted = |mut all: Vec<[u32; 2]>| {
                all.sort_unstable();
                all
            };
            assert_eq!(sorted(order.clone()), sorted(pixels(window).collect()));
            for pixel in order {
                for sample in [0, 5] {
                    let after_others = heard(&kernel, pixel, sample, &mut scratch);
                    assert_eq!(after_others, heard(&kernel, pixel, sample, &mut Scratch::default()));
                }
                heard(&other, pixel, 5, &mut scratch);
            }
        }
    }
}

#[test]
fn eye_paths_meet_as_many_light_paths_as_are_told() {
    let window = Crop { x: 2, y: 1, width: 20, height: 12 };
    let scene = seen_through(window);
    for shared in [1, 2, 4, 8, 16] {
        let kernel = Kernel::new(&scene, settings(shared));
        assert_eq!(kernel.shared_light_paths(), shared);
        let mut scratch = Scratch::default();
        let samples = pixels(window).flat_map(|pixel| (0..16).map(move |sample| (pixel, sample)));
        // Of one sample, some light paths may find nothing that the eye path sees.
        let met = samples.map(|(pixel, sample)| heard(&kernel, pixel, sample, &mut scratch).lamps.len());
        let most = met.max().unwrap() as u32;
        assert!(most <= shared && 2 * most > shared, "{most} of {shared}");
    }
}

/// Weights count light paths, and a light path splats into the pixels of others: the mean shows it if they are not counted
/// alike, as in windows in which groups do not fit. Seen from the centre of a sphere around a point light, k edges bring
/// ½^(k−1). Significance: 10⁻³ in all.
#[test]
fn windows_of_any_size_show_the_same_light() {
    const LONGEST: u32 = 4;
    let expected: f64 = (2..=LONGEST).map(|k| 0.5_f64.powi(k as i32 - 1)).sum();
    let parts = [(16, 1), (16, 4), (11, 4), (11, 16), (9, 8), (5, 2)];
    for (part, (width, shared)) in parts.into_iter().enumerate() {
        let mut d = point_furnace(1);
        (d.film.width, d.film.height) = (width, width);
        d.camera.kind = CameraKind::Environment;
        let scene = flatten(d);
        let settings =
            Settings { seed: seed(20 + part as u64), max_depth: Some(LONGEST), ..settings(shared) };
        let (kernel, mut scratch) = (Kernel::new(&scene, settings), Scratch::default());
        assert_eq!(kernel.shared_light_paths(), shared);
        let order = kernel.in_groups(pixels(Crop { x: 0, y: 0, width, height: width }));
        let mut moments = Moments::default();
        for pass in 0..80_000 / (width * width) {
            let mut sum = Sum { height: width as f32, sum: 0.0 };
            for pixel in &order {
                kernel.sample(*pixel, pass, &mut scratch, &mut sum);
            }
            moments.push(sum.sum / f64::from(width * width));
        }
        println!("{width}, {shared}: {} ± {}", moments.mean, moments.variance_of_mean().sqrt());
        // The sphere is a mesh: by so much it may be no sphere.
        let is_close = (moments.mean / expected - 1.0).abs() < 5e-4;
        let p = student_t_test(&moments, expected);
        assert!(is_close || p > sidak(1e-3, parts.len()), "{width}, {shared}: {}, p = {p:.1e}", moments.mean);
    }
}

/// The mean over all directions of what an environment camera sees, times its pixels.
struct Sum {
    height: f32,
    sum: f64,
}

impl Sink for Sum {
    const PROBES: bool = true;

    fn eye(&mut self, _: Rgb) {}

    fn splat(&mut self, _: Vec2, _: Rgb) {}

    fn contribution(&mut self, c: &Contribution<'_>) {
        let solid_angle = sin(PI * c.film.y / self.height) * 0.5 * PI;
        self.sum += f64::from(c.unweighted[1] * c.weight * solid_angle);
    }
}

/// The sum over pixels of the variance of what joined paths bring.
fn variance(scene: &Scene, window: Crop, shared: u32) -> f64 {
    const SAMPLES: u32 = 64;
    let strategies = "s>=2&t>=2".parse().unwrap();
    let kernel = Kernel::new(scene, Settings { strategies, ..settings(shared) });
    let mut scratch = Scratch::default();
    let one = |pixel| {
        let mut moments = [0.0; 2];
        for sample in 0..SAMPLES {
            let green = f32::from_bits(heard(&kernel, pixel, sample, &mut scratch).eye[0][1]);
            moments = [moments[0] + f64::from(green), moments[1] + f64::from(green).powi(2)];
        }
        let [mean, squares] = moments.map(|m| m / f64::from(SAMPLES));
        squares - mean * mean
    };
    pixels(window).map(one).sum()
}

#[test]
fn more_light_paths_are_less_noise() {
    let window = Crop { x: 0, y: 0, width: 16, height: 16 };
    let scene = seen_through(window);
    let [one, four] = [1, 4].map(|shared| variance(&scene, window, shared));
    println!("variance: {one} with one light path, {four} with four");
    assert!(four < 0.5 * one, "{one}, {four}");
}
