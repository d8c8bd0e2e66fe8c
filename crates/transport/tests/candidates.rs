//! What a sample delivers is the sum of what it tells of. Roulette among what an eye path can be joined with changes
//! single samples, and no mean.

use caustica_math::stats::{Moments, student_t_test};
use caustica_math::{Rgb, Vec2};
use caustica_testkit::agreement::flatten;
use caustica_testkit::build::point_light;
use caustica_testkit::oracle::lanes;
use caustica_testkit::scenes::{ball, glass_kind, instanced, open_box, plastic_kind, under_the_sky};
use caustica_transport::{Contribution, Kernel, Scratch, Settings, Sink};

/// The eye image's value of a sample, with every connection or with roulette.
#[derive(Default)]
struct Eye<const ALL: bool>(f64);

impl<const ALL: bool> Sink for Eye<ALL> {
    const KEEPS_ALL: bool = ALL;

    fn eye(&mut self, value: Rgb) {
        self.0 = f64::from(value.luminance());
    }

    fn splat(&mut self, _: Vec2, _: Rgb) {}
}

/// Significance 10⁻⁴. One sample in some that differs shows that there is something to test.
#[test]
fn negligible_candidates_are_left_out_without_bias() {
    let scene = flatten(open_box());
    // Long paths have the most connections, and the smallest.
    let settings = Settings { roulette_start: Some(6), ..Settings::default() };
    let kernel = Kernel::new(&scene, settings);
    let window = scene.film.window();
    let mut scratch = Scratch::default();
    let (mut differences, mut differ, mut total) = (Moments::default(), 0, 0.0);
    for sample in 0..200 {
        for (x, y) in (0..window.height).flat_map(|y| (0..window.width).map(move |x| (x, y))) {
            let (mut all, mut some) = (Eye::<true>::default(), Eye::<false>::default());
            kernel.sample([window.x + x, window.y + y], sample, &mut scratch, &mut all);
            kernel.sample([window.x + x, window.y + y], sample, &mut scratch, &mut some);
            differences.push(some.0 - all.0);
            differ += u32::from(some.0 != all.0);
            total += all.0;
        }
    }
    let n = differences.count as f64;
    assert!(f64::from(differ) > 0.2 * n, "{differ} of {n} samples differ");
    let p = student_t_test(&differences, 0.0);
    assert!(p > 1e-4, "the mean {} changes by {}: p = {p}", total / n, differences.mean);
}

/// Adds up what is told, and compares it with what is delivered.
#[derive(Default)]
struct Sums {
    told: [f64; 3],
    /// The contribution that must be splatted next.
    splat: [f64; 3],
    eye: Rgb,
    delivered: u32,
    splatted: u32,
    wrong: Vec<String>,
}

impl Sums {
    fn compare(&mut self, what: &str, value: Rgb, told: [f64; 3]) {
        let most = told.iter().fold(0.0_f64, |a, b| a.max(*b));
        let close = |lane: usize| (f64::from(value.0[lane]) - told[lane]).abs() <= 1e-5 * most;
        if !(0..3).all(close) {
            self.wrong.push(format!("{what} {value:?}, told of {told:?}"));
        }
    }
}

impl Sink for Sums {
    const PROBES: bool = true;
    const WEIGHS_ALL: bool = true;

    fn eye(&mut self, value: Rgb) {
        self.compare("delivered", value, self.told);
        self.delivered += u32::from(self.told != [0.0; 3]);
        (self.eye, self.told) = (value, [0.0; 3]);
    }

    fn splat(&mut self, _: Vec2, value: Rgb) {
        self.compare("splatted", value, self.splat);
        self.splatted += 1;
        self.splat = [0.0; 3];
    }

    fn contribution(&mut self, c: &Contribution<'_>) {
        let sum: f32 = c.weights.iter().sum();
        if !c.weights.iter().all(|w| (0.0..=1.0).contains(w)) || sum > 1.0 + 1e-5 {
            self.wrong.push(format!("{}: weights {:?}", c.strategy, c.weights));
        }
        let value = lanes(c.unweighted).map(|lane| lane * f64::from(c.weight * c.filter_weight));
        if c.strategy.t > 1 {
            self.told = [0, 1, 2].map(|lane| self.told[lane] + value[lane]);
        } else {
            if self.splat != [0.0; 3] {
                self.wrong.push(format!("{:?} was told of and not splatted", self.splat));
            }
            self.splat = value;
        }
    }
}

/// Nor does it matter who listens.
#[test]
fn what_is_delivered_is_the_sum_of_what_is_told() {
    let mut lamps = open_box();
    point_light(&mut lamps, [0.3, 0.6, -0.2], 1.0);
    let scenes = [lamps, ball(glass_kind(false)), under_the_sky(plastic_kind()), instanced()];
    for (i, description) in scenes.into_iter().enumerate() {
        let scene = flatten(description);
        let kernel = Kernel::new(&scene, Settings::default());
        let window = scene.film.window();
        let (mut scratch, mut sums) = (Scratch::default(), Sums::default());
        for pixel in 0..window.width * window.height {
            let pixel = [window.x + pixel % window.width, window.y + pixel / window.width];
            for sample in 0..4 {
                let mut eye = Eye::<true>::default();
                kernel.sample(pixel, sample, &mut scratch, &mut sums);
                kernel.sample(pixel, sample, &mut scratch, &mut eye);
                let seen = f64::from(sums.eye.luminance());
                if eye.0 != seen {
                    sums.wrong.push(format!("{} delivered, to who listens {seen}", eye.0));
                }
            }
        }
        let first = sums.wrong.iter().take(8).cloned().collect::<Vec<_>>().join("\n");
        assert!(sums.wrong.is_empty(), "scene {i}: {} wrong:\n{first}", sums.wrong.len());
        assert!(sums.delivered > 100 && sums.splatted > 100, "{i}: {}, {}", sums.delivered, sums.splatted);
    }
}
