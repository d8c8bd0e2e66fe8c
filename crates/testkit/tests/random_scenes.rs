//! Random scenes are valid, and are not all dark.

use caustica_math::Rgb;
use caustica_scene::Scene;
use caustica_scene::description::{Shape, Texture};
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

/// All kinds of lamps and of colours are drawn.
#[test]
fn lamps_and_colours_of_every_kind() {
    let mut drawn = std::collections::BTreeMap::new();
    for seed in 0..500 {
        let d = random_scene(&mut Choices::new(&bytes_of_seed(seed)));
        let lamps = d.lights.iter().map(|l| format!("{:?}", l.kind));
        let mut words: Vec<String> =
            lamps.map(|l| l.split([' ', '(']).next().unwrap_or_default().to_owned()).collect();
        let named = |t: &Texture| matches!(t, Texture::Attribute { .. });
        let is_coloured =
            |s: &Shape| d.materials[s.material.0 as usize].kind.textures().into_iter().any(named);
        words.extend(d.all_shapes().any(is_coloured).then(|| "colours".into()));
        words.extend(d.all_shapes().any(|s| s.emission.as_ref().is_some_and(named)).then(|| "glow".into()));
        if Scene::new(d).is_ok() {
            words.into_iter().for_each(|word| *drawn.entry(word).or_insert(0) += 1);
        }
    }
    println!("{drawn:?}");
    let kinds = [
        "Point",
        "Spot",
        "LinearSpot",
        "Projector",
        "Collimated",
        "Directional",
        "Constant",
        "Environment",
        "Sky",
        "Sun",
    ];
    for kind in kinds.into_iter().chain(["colours", "glow"]) {
        assert!(drawn.get(kind).is_some_and(|n| *n >= 10), "{kind}: {drawn:?}");
    }
}

#[test]
fn no_bytes_are_a_scene_too() {
    let description = random_scene(&mut Choices::new(&[]));
    assert_eq!(description.shapes.len(), 1);
    Scene::new(description).unwrap();
}
