//! Scenes and references of Mitsuba's own test data, where they lie beside the repository.
//!
//! The rule is that of Mitsuba's tests: with K seeds, z = |mean − reference| / √(variance/K + reference's variance) in
//! XYZ, and 99.75 % of all pixels and channels must have a p-value above α = 1 − 0.99^(1/pixels).

use std::path::{Path, PathBuf};

use caustica::description::Integrator;
use caustica::import::load;
use caustica::{RenderOptions, Rgb, Scene, Session, Settings};

const SEEDS: u64 = 32;
const REFERENCE_SAMPLES: f64 = 32_000.0;
const VARIANCE_FLOOR: f64 = 1e-4;
const BLOCK: usize = 8;

/// The folder, unless it is not there.
fn fixtures() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/fixtures/mitsuba/tests/scenes");
    folder.is_dir().then_some(folder)
}

/// A picture in rows, as XYZ.
struct Picture {
    width: usize,
    pixels: Vec<[f64; 3]>,
}

fn xyz([r, g, b]: [f64; 3]) -> [f64; 3] {
    [
        0.412_453 * r + 0.357_580 * g + 0.180_423 * b,
        0.212_671 * r + 0.715_160 * g + 0.072_169 * b,
        0.019_334 * r + 0.119_193 * g + 0.950_227 * b,
    ]
}

/// An EXR file, whose values may be negative where they are variances.
fn reference(path: &Path) -> Picture {
    use exr::prelude::*;
    let image = read_first_rgba_layer_from_file(
        path,
        |size, _| (size.width(), vec![[0.0; 3]; size.area()]),
        |(width, pixels): &mut (usize, Vec<[f64; 3]>), at, (r, g, b, _): (f32, f32, f32, f32)| {
            pixels[at.y() * *width + at.x()] = xyz([r, g, b].map(f64::from));
        },
    );
    let (width, pixels) = image.unwrap().layer_data.channel_data.pixels;
    Picture { width, pixels }
}

/// The scene's picture by some seeds, with so many samples each.
fn render(path: &Path, samples: u32, integrator: Option<Integrator>) -> Vec<Vec<[f64; 3]>> {
    let loaded = load(path).unwrap_or_else(|e| panic!("{e}"));
    let description = loaded.scene.unwrap();
    let integrator = integrator.unwrap_or(description.integrator);
    let (scene, _) = Scene::new(description).unwrap();
    let one = |seed| {
        let settings = Settings { integrator, max_depth: loaded.max_depth, seed, ..Settings::default() };
        let options = RenderOptions { settings, samples, threads: Some(2), ..RenderOptions::default() };
        let session = Session::new(&scene, options).unwrap();
        session.run(&Default::default(), |_| ()).unwrap();
        let picture = session.film().develop();
        let sum = picture.eye.iter().zip(&picture.light).map(|(a, b)| *a + *b);
        sum.map(|Rgb(c)| xyz(c.map(f64::from))).collect()
    };
    (0..SEEDS).map(one).collect()
}

/// The part of pixels and channels that pass, and the sorted ratios of the blocks' luminances.
fn compare(images: &[Vec<[f64; 3]>], reference: &Picture, variance: &Picture) -> (f64, Vec<f64>) {
    let pixels = reference.pixels.len();
    let alpha = 1.0 - libm::pow(0.99, 1.0 / pixels as f64);
    let k = images.len() as f64;
    let mean = |i: usize, c: usize| images.iter().map(|image| image[i][c]).sum::<f64>() / k;
    let mut passed = 0;
    for i in 0..pixels {
        for c in 0..3 {
            let m = mean(i, c);
            let own =
                images.iter().map(|image| (image[i][c] - m) * (image[i][c] - m)).sum::<f64>() / (k - 1.0);
            let theirs = variance.pixels[i][c].max(VARIANCE_FLOOR) / REFERENCE_SAMPLES;
            let z = (m - reference.pixels[i][c]).abs() / (own / k + theirs).sqrt();
            passed += usize::from(libm::erfc(z / std::f64::consts::SQRT_2) > alpha);
        }
    }
    let mut ratios = Vec::new();
    for row in (0..pixels / reference.width).step_by(BLOCK) {
        for column in (0..reference.width).step_by(BLOCK) {
            let inside = (0..BLOCK * BLOCK).map(|i| (row + i / BLOCK) * reference.width + column + i % BLOCK);
            let sums = inside.fold((0.0, 0.0), |s, i| (s.0 + mean(i, 1), s.1 + reference.pixels[i][1]));
            ratios.push(sums.0.max(1e-6) / sums.1.max(1e-6));
        }
    }
    ratios.sort_by(f64::total_cmp);
    (passed as f64 / (3 * pixels) as f64, ratios)
}

/// Renders a scene and returns the part that passes. The blocks' median must be right in any case.
fn check(scene: &str, references: &str, samples: u32, integrator: Option<Integrator>) -> Option<f64> {
    let folder = fixtures()?;
    let images = render(&folder.join(scene), samples, integrator);
    let refs = folder.join(scene).with_file_name("refs");
    let picture = reference(&refs.join(format!("{references}_ref_rgb.exr")));
    let variance = reference(&refs.join(format!("{references}_ref_rgb_var.exr")));
    let (passed, ratios) = compare(&images, &picture, &variance);
    let [low, median, high] =
        [0.05, 0.5, 0.95].map(|part| ratios[((ratios.len() - 1) as f64 * part).round() as usize]);
    println!("{scene} {integrator:?}: {passed:.5} pass; blocks {low:.4} {median:.4} {high:.4}");
    assert!((median - 1.0).abs() < 0.005, "{scene}: {median}");
    assert!(low > 0.97 && high < 1.1, "{scene}: {low} {high}");
    Some(passed)
}

fn agrees(scene: &str, references: &str, samples: u32, integrator: Option<Integrator>) {
    if let Some(passed) = check(scene, references, samples, integrator) {
        assert!(passed >= 0.9975, "{scene} {integrator:?}: {passed}");
    }
}

#[test]
fn all_scenes_load() {
    let Some(folder) = fixtures() else { return };
    let mut loaded = 0;
    for group in ["infinite_mirrors", "floating_sphere", "bsdf_spheres"] {
        for entry in std::fs::read_dir(folder.join(group)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|e| e == "xml") {
                let read = load(&path).unwrap_or_else(|e| panic!("{e}"));
                Scene::new(read.scene.unwrap()).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
                read.warnings.iter().for_each(|w| println!("{w}"));
                loaded += 1;
            }
        }
    }
    assert_eq!(loaded, 7);
}

#[test]
fn directional_light() {
    let scene = "floating_sphere/test_directional_direct.xml";
    agrees(scene, "test_directional", 32, None);
    agrees(scene, "test_directional", 32, Some(Integrator::Bdpt));
    agrees(scene, "test_directional", 256, Some(Integrator::Light));
}

#[test]
fn mirrors_in_mirrors() {
    agrees("infinite_mirrors/scene_path.xml", "scene", 16, None);
    agrees("infinite_mirrors/scene_path.xml", "scene", 128, Some(Integrator::Bdpt));
}

#[test]
fn textured_diffuse() {
    let scene = "bsdf_spheres/test_textured_diffuse_path.xml";
    agrees(scene, "test_textured_diffuse", 16, None);
    agrees(scene, "test_textured_diffuse", 128, Some(Integrator::Bdpt));
    agrees(scene, "test_textured_diffuse", 1024, Some(Integrator::Light));
}

#[test]
fn bump_map() {
    let scene = "bsdf_spheres/test_bumpmap_path.xml";
    agrees(scene, "test_bumpmap", 64, None);
    agrees(scene, "test_bumpmap", 128, Some(Integrator::Bdpt));
}

#[test]
fn rough_glass() {
    let scene = "bsdf_spheres/test_roughdielectric_path.xml";
    agrees(scene, "test_roughdielectric", 256, None);
    agrees(scene, "test_roughdielectric", 256, Some(Integrator::Bdpt));
}

/// Twelve materials, by direct light.
#[test]
fn twelve_materials() {
    for (scene, reference) in [
        ("bsdf_spheres/test_arealight_path.xml", "test_arealight"),
        ("bsdf_spheres/test_envmap_path.xml", "test_envmap"),
    ] {
        agrees(scene, reference, 32, None);
        agrees(scene, reference, 128, Some(Integrator::Bdpt));
    }
}
