//! Roulette among what an eye path can be joined with changes single samples, and no mean.

use caustica_math::stats::{Moments, student_t_test};
use caustica_math::{Rgb, Vec2};
use caustica_testkit::agreement::flatten;
use caustica_testkit::scenes::open_box;
use caustica_transport::{Kernel, Scratch, Settings, Sink};

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
