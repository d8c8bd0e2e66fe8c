//! Layers beside the picture tell what is seen first, by the picture's own samples, whoever makes them.

use caustica_film::Channel;
use caustica_math::{Filter, Rgb, Vec3};
use caustica_render::{Control, RenderOptions, Session};
use caustica_scene::description::{
    BumpRule, Crop, Integrator, Layer, LayerKind, LightKind, MaterialKind, Texture, Wrapper,
};
use caustica_scene::{Description, Scene};
use caustica_testkit::build::{diffuse, emit, glass, light, quad, scene, sphere};
use caustica_transport::Settings;

const SIDE: usize = 16;

/// A ball before a wall that fills the left half, and nothing in the right one.
fn ball_and_wall() -> Description {
    let mut d = scene(SIDE as u32);
    let clay = d.add_material(MaterialKind::Diffuse { albedo: Rgb::new(0.2, 0.4, 0.6).into() });
    let field = |value1, value2| Texture::Checkerboard {
        delta: [0.0; 2],
        scale: [0.5; 2],
        shear: [0.0; 2],
        value1: Rgb::splat(value1),
        value2: Rgb::splat(value2),
    };
    let fields = d.add_material(MaterialKind::Diffuse { albedo: field(0.25, 0.75) });
    // The camera looks along +z with +x to the left.
    quad(&mut d, [0.0, -10.0, 6.0], [20.0, 0.0, 0.0], [0.0, 20.0, 0.0], fields);
    sphere(&mut d, [0.0, 0.0, 4.0], 0.5, clay);
    light(&mut d, LightKind::Constant { radiance: Rgb::WHITE });
    d
}

fn all() -> Vec<Layer> {
    LayerKind::ALL.iter().map(|kind| kind.name().parse().unwrap()).collect()
}

fn options(samples: u32, threads: usize) -> RenderOptions {
    let settings = Settings { integrator: Integrator::Depth, seed: 5, ..Settings::default() };
    RenderOptions { settings, samples, threads: Some(threads), ..RenderOptions::default() }
}

fn of(scene: &Scene, options: RenderOptions, layers: &[Layer]) -> Vec<Channel> {
    let session = Session::new(scene, options).unwrap();
    session.run(&Control::default(), |_| ()).unwrap();
    session.layers(layers).unwrap()
}

/// A pixel of a layer's channels.
fn at<const N: usize>(channels: &[Channel], layer: &str, [x, y]: [usize; 2]) -> [f32; N] {
    let mut of_layer = channels.iter().filter(|c| c.name.rsplit_once('.').unwrap().0 == layer);
    let pixel = [(); N].map(|()| of_layer.next().unwrap().values[y * SIDE + x]);
    assert!(of_layer.next().is_none(), "{layer} has more channels");
    pixel
}

#[track_caller]
fn near<const N: usize>(a: [f32; N], b: [f32; N], off: f32) {
    assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() <= off), "{a:?} is not {b:?}");
}

#[test]
fn a_wall_is_known_exactly() {
    let scene = Scene::new(ball_and_wall()).unwrap().0;
    let channels = of(&scene, options(64, 2), &all());
    assert_eq!(channels.len(), 3 + 1 + 3 + 2 + 6 + 6 + 4 + 2);
    let tan = 1.0 / 3.0_f32.sqrt();
    // A pixel is so wide on the wall.
    let step = 6.0 * tan * 2.0 / SIDE as f32;
    for pixel in [[1, 2], [0, 15], [3, 9]] {
        let [x, y] = pixel.map(|c| c as f32 + 0.5 - SIDE as f32 / 2.0);
        let [px, py, pz] = at(&channels, "position", pixel);
        near([px, py, pz], [-x * step, -y * step, 6.0], 2e-3);
        near(at(&channels, "sh_normal", pixel), [0.0, 0.0, 1.0], 1e-6);
        near(at(&channels, "geo_normal", pixel), [0.0, 0.0, 1.0], 1e-6);
        near(at(&channels, "uv", pixel), [px / 20.0, (py + 10.0) / 20.0], 1e-5);
        near(at(&channels, "dp_du", pixel), [20.0, 0.0, 0.0], 1e-4);
        near(at(&channels, "dp_dv", pixel), [0.0, 20.0, 0.0], 1e-4);
        near(at(&channels, "duv_dx", pixel), [-step / 20.0, 0.0], 1e-5);
        near(at(&channels, "duv_dy", pixel), [0.0, -step / 20.0], 1e-5);
        let [depth] = at(&channels, "depth", pixel);
        near([depth], [(px * px + py * py + 36.0).sqrt()], 0.01);
        let upper = py > 0.0;
        near(at(&channels, "albedo", pixel), [if upper { 0.75 } else { 0.25 }; 3], 1e-6);
        let second = (py + 10.0) / 20.0 > px / 20.0;
        let indices: [[f32; 1]; 2] = ["shape_index", "prim_index"].map(|name| at(&channels, name, pixel));
        assert_eq!(indices, [[1.0], [f32::from(u8::from(second))]]);
    }
}

#[test]
fn a_ball_and_what_is_missed() {
    let scene = Scene::new(ball_and_wall()).unwrap().0;
    let channels = of(&scene, options(64, 2), &all());
    let pixel = [8, 7];
    let p: [f32; 3] = at(&channels, "position", pixel);
    let n: [f32; 3] = at(&channels, "sh_normal", pixel);
    near(p, [n[0] * 0.5, n[1] * 0.5, 4.0 + n[2] * 0.5], 1e-5);
    near(at(&channels, "albedo", pixel), [0.2, 0.4, 0.6], 1e-6);
    assert_eq!(at(&channels, "shape_index", pixel), [2.0]);
    assert_eq!(at(&channels, "prim_index", pixel), [0.0]);
    let [u, v]: [f32; 2] = at(&channels, "uv", pixel);
    assert!((0.0..1.0).contains(&u) && (0.0..1.0).contains(&v));
    for channel in &channels {
        assert_eq!(channel.values[3 * SIDE + 14], 0.0, "{}", channel.name);
    }
}

/// By the other direction of v, as in Mitsuba's images.
#[test]
fn v_may_grow_downwards() {
    let scene = Scene::new(ball_and_wall()).unwrap().0;
    let layers = |v_down| ["uv", "dp_dv", "duv_dy"].map(|k| Layer { v_down, ..k.parse().unwrap() });
    let [up, down] = [false, true].map(|v_down| of(&scene, options(4, 1), &layers(v_down)));
    let pixel = [1, 2];
    let ([u, v], uv) = (at(&up, "uv", pixel), at(&down, "uv", pixel));
    near(uv, [u, 1.0 - v], 1e-6);
    let [_, y, _]: [f32; 3] = at(&up, "dp_dv", pixel);
    near(at(&down, "dp_dv", pixel), [0.0, -y, 0.0], 0.0);
    let [_, v]: [f32; 2] = at(&up, "duv_dy", pixel);
    near(at(&down, "duv_dy", pixel), [0.0, -v], 1e-6);
}

/// The bits depend on neither threads, tiles nor pauses, and a crop's are those of the whole.
#[test]
fn whoever_makes_them_they_are_the_same() {
    let mut d = ball_and_wall();
    (d.film.width, d.film.height, d.film.filter) = (40, 28, Filter::Gaussian { radius: 2.0, stddev: 0.5 });
    let scene = Scene::new(d.clone()).unwrap().0;
    let one = of(&scene, options(8, 1), &all());
    assert_eq!(one, of(&scene, options(8, 3), &all()));
    let paused = Session::new(&scene, options(8, 2)).unwrap();
    paused.run_for(caustica_render::Budget { samples: 3, time: None }, &Control::default(), |_| ()).unwrap();
    paused.run(&Control::default(), |_| ()).unwrap();
    assert_eq!(one, paused.layers(&all()).unwrap());
    // Beyond the most samples nothing changes.
    assert_eq!(of(&scene, options(64, 2), &all()), of(&scene, options(70, 2), &all()));
    assert_ne!(one, of(&scene, options(64, 2), &all()));
    d.film.crop = Some(Crop { x: 5, y: 3, width: 21, height: 18 });
    let crop = of(&Scene::new(d).unwrap().0, options(8, 2), &all());
    for (whole, crop) in one.iter().zip(&crop) {
        for (i, value) in crop.values.iter().enumerate() {
            assert_eq!(*value, whole.values[(i / 21 + 3) * 40 + i % 21 + 5], "{}", crop.name);
        }
    }
}

/// Samples of filters with lobes have signs: what is the same everywhere stays so.
#[test]
fn means_by_filters_with_lobes() {
    let mut d = ball_and_wall();
    d.film.filter = Filter::Lanczos { lobes: 3 };
    let scene = Scene::new(d).unwrap().0;
    for samples in 1..7 {
        let channels = of(&scene, options(samples, 1), &all());
        near(at(&channels, "sh_normal", [2, 12]), [0.0, 0.0, 1.0], 1e-5);
        assert_eq!(at(&channels, "shape_index", [8, 7]), [2.0]);
    }
}

/// A normal map leans the shading normal and no other; lamps that the camera does not see are not there.
#[test]
fn mapped_normals_and_hidden_lamps() {
    let mut d = ball_and_wall();
    let rule = BumpRule { flips: false, shadows: false };
    let inner = d.shapes[0].material;
    let normals = Texture::Constant(Rgb::new(0.65, 0.5, 0.9));
    d.shapes[0].material = d.add_material(MaterialKind::Wrapped(Wrapper::NormalMap { normals, rule, inner }));
    d.camera.hides_lamps = true;
    let mut beam = d.clone();
    light(&mut beam, LightKind::Collimated { shape: 1, exitance: Rgb::WHITE.into() });
    emit(&mut d, 1, 1.0);
    let channels = of(&Scene::new(d).unwrap().0, options(4, 1), &all());
    assert_eq!(channels, of(&Scene::new(beam).unwrap().0, options(4, 1), &all()));
    // In the frame that follows u.
    let expected = Vec3::new(0.3, 0.0, 0.8).normalized().to_array();
    near(at(&channels, "sh_normal", [2, 12]), expected, 1e-5);
    near(at(&channels, "geo_normal", [2, 12]), [0.0, 0.0, 1.0], 0.0);
    near(at(&channels, "shape_index", [7, 7]), [1.0], 0.0);
}

/// Layers are the same by every integrator: their samples are those of the film, not of the walks.
#[test]
fn every_integrator_has_them() {
    let mut d = ball_and_wall();
    let glass = glass(&mut d);
    d.shapes[1].material = glass;
    diffuse(&mut d, 0.5);
    let scene = Scene::new(d).unwrap().0;
    let by = |integrator| {
        let settings = Settings { integrator, ..options(4, 1).settings };
        of(&scene, RenderOptions { settings, ..options(4, 1) }, &all())
    };
    assert_eq!(by(Integrator::Bdpt), by(Integrator::Light));
    assert_eq!(by(Integrator::Bdpt), by(Integrator::Depth));
    near(at(&by(Integrator::Bdpt), "albedo", [8, 7]), [1.0; 3], 1e-6);
}

#[test]
fn layers_of_one_name_are_refused() {
    let scene = Scene::new(ball_and_wall()).unwrap().0;
    let session = Session::new(&scene, options(1, 1)).unwrap();
    let layers: Vec<Layer> = ["n:sh_normal", "n:position"].map(|l| l.parse().unwrap()).to_vec();
    assert!(session.check_layers(&layers).unwrap_err().to_string().contains("two layers are called `n`"));
    assert!(session.layers(&layers).is_err());
    assert_eq!(session.layers(&[]).unwrap(), []);
}
