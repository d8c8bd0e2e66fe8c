//! Random scenes are valid, and are not all dark.

use caustica_math::Rgb;
use caustica_scene::Scene;
use caustica_testkit::random_scene::{Choices, bytes_of_seed, random_scene};
use caustica_transport::{Kernel, Scratch, Settings, Sink};

/// Adds up what a kernel gives.
#[derive(Default)]
struct Sum(f32);

impl Sink for Sum {
    fn eye(&mut self, value: Rgb) {
        self.0 += value.max_channel();
    }

    fn splat(&mut self, _: caustica_math::Vec2, value: Rgb) {
        self.0 += value.max_channel();
    }
}

fn brightness(scene: &Scene) -> f32 {
    let kernel = Kernel::new(scene, Settings { max_depth: Some(4), ..Settings::default() });
    let (mut scratch, mut sum) = (Scratch::default(), Sum::default());
    let window = scene.film.window();
    for y in window.y..window.y + window.height {
        for x in window.x..window.x + window.width {
            kernel.sample([x, y], 0, &mut scratch, &mut sum);
        }
    }
    sum.0
}

#[test]
fn nearly_all_are_valid_and_most_are_lit() {
    let (mut valid, mut lit, mut shapes) = (0, 0, 0);
    for seed in 0..500 {
        let bytes = bytes_of_seed(seed);
        let description = random_scene(&mut Choices::new(&bytes));
        shapes += description.shapes.len();
        match Scene::new(description) {
            Ok((scene, _)) => {
                valid += 1;
                lit += u32::from(brightness(&scene) > 0.0);
            }
            Err(e) => println!("seed {seed}: {e}"),
        }
    }
    println!("{valid} of 500 valid, {lit} lit, {shapes} shapes");
    assert!(valid >= 480 && lit >= 200, "{valid} of 500 valid, {lit} lit");
}

#[test]
fn no_bytes_are_a_scene_too() {
    let description = random_scene(&mut Choices::new(&[]));
    assert_eq!(description.shapes.len(), 1);
    Scene::new(description).unwrap();
}
