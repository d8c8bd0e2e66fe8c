//! What a sample is made of, each part by itself, and whole samples: nanoseconds by Criterion.
//!
//! Inputs are drawn beforehand and gone through in turn, so that no branch can be learnt by heart. A figure
//! has the cost of fetching the next input in it, a nanosecond or so.

use std::hint::black_box;

use caustica::description::{Filter, Integrator, MaterialKind, Technique};
use caustica::film::{Film, FilmLayout, Window};
use caustica::math::{
    PixelFilter, SampleId, SampleStream, Sampler, Spectrum, StreamId, Vec2, Wavelengths, warp,
};
use caustica::scene::bsdf::{
    Bsdf, Conductor, Dielectric, Diffuse, Facets, Microfacet, RoughConductor, RoughDielectric, Walk,
};
use caustica::scene::bvh::Bvh;
use caustica::transport::{Kernel, Scratch, Sink};
use caustica::{Description, Rgb, Scene, Settings, Vec3};
use caustica_bench::rays::Rays;
use caustica_bench::rooms::Room;
use caustica_testkit::agreement::flatten;
use caustica_testkit::scenes;
use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion};

/// Inputs of one kernel.
const INPUTS: usize = 4096;

/// Times `f` on one input after the other.
fn each<T, R>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    name: &str,
    inputs: &[T],
    mut f: impl FnMut(&T) -> R,
) {
    let mut turn = 0;
    group.bench_function(name, |b| {
        b.iter(|| {
            turn = if turn + 1 == inputs.len() { 0 } else { turn + 1 };
            f(black_box(&inputs[turn]))
        });
    });
}

fn stream() -> SampleStream {
    SampleStream::new(StreamId { seed: 3, pixel: 0, sample: 0, walk: 0 })
}

fn inputs<T>(make: impl FnMut(&mut SampleStream) -> T) -> Vec<T> {
    let (mut s, mut make) = (stream(), make);
    (0..INPUTS).map(|_| make(&mut s)).collect()
}

/// Rays through the tree: first hits of bounces, any hit of connections.
fn tree(c: &mut Criterion) {
    for (name, size) in [("5k", 5_000), ("160k", 160_000)] {
        let room = Room::new(size);
        let tree = Bvh::new(&room.positions, &room.triangles, &[]);
        let rays = Rays::new(&room, &tree, 100_000);
        let mut group = c.benchmark_group("tree");
        each(&mut group, &format!("closest {name}"), &rays.bounce, |r| tree.closest(r));
        each(&mut group, &format!("occluded {name}"), &rays.connection, |r| tree.occluded(r));
    }
}

/// A stream of a sample with six pairs of numbers, as many as a path of two bounces takes.
fn numbers(c: &mut Criterion) {
    let mut group = c.benchmark_group("six pairs of numbers");
    for (name, sampler) in [("sobol", Sampler::Sobol), ("independent", Sampler::Independent)] {
        let ids = inputs(|s| {
            let pixel = s.next_2d().map(|u| (u * 640.0) as u32);
            SampleId { seed: 1, pixel, sample: (s.next_1d() * 64.0) as u32 }
        });
        each(&mut group, name, &ids, |id| {
            let mut stream = SampleStream::of_sample(sampler, *id, 0);
            (0..6).map(|_| stream.next_2d()[0]).sum::<f32>()
        });
    }
}

/// One BSDF of every kind.
fn bsdfs() -> Vec<(&'static str, Bsdf)> {
    let w = Wavelengths::Rgb;
    let copper = match scenes::metal_kind(None) {
        MaterialKind::Conductor { eta, k, .. } => {
            Conductor { eta: w.spectrum(eta), k: w.spectrum(k), reflectance: Spectrum::ONE }
        }
        _ => unreachable!("a smooth metal"),
    };
    let grey = w.spectrum(Rgb::splat(0.5));
    vec![
        ("diffuse", Bsdf::Diffuse(Diffuse { albedo: grey })),
        ("mirror", Bsdf::Mirror { reflectance: grey }),
        ("dielectric", Bsdf::Dielectric(Dielectric::new(1.5, 1.0))),
        (
            "rough dielectric",
            Bsdf::RoughDielectric(RoughDielectric::new(Facets::ggx(0.3), Dielectric::new(1.5, 1.0))),
        ),
        ("conductor", Bsdf::Conductor(copper)),
        ("rough conductor", Bsdf::RoughConductor(RoughConductor::new(copper, Facets::ggx(0.2)))),
        ("microfacet", Bsdf::Microfacet(Microfacet::new(grey, 0.2, 1.5, 1.0))),
    ]
}

/// Sampling and evaluating BSDFs; evaluation between directions that sampling finds.
fn scattering(c: &mut Criterion) {
    let given = inputs(|s| {
        let [u, v] = s.next_2d();
        (warp::cosine_hemisphere(s.next_2d()), [u, v, s.next_1d()])
    });
    for (name, bsdf) in bsdfs() {
        let bsdf = black_box(bsdf);
        let mut group = c.benchmark_group("bsdf");
        each(&mut group, &format!("sample {name}"), &given, |(d, u)| bsdf.sample(Walk::FromCamera, *d, *u));
        if bsdf.is_delta() {
            continue;
        }
        let pairs: Vec<(Vec3, Vec3)> = given
            .iter()
            .filter_map(|(d, u)| Some((bsdf.sample(Walk::FromCamera, *d, *u)?.direction, *d)))
            .collect();
        each(&mut group, &format!("eval {name}"), &pairs, |(a, b)| bsdf.eval(*a, *b));
    }
}

/// The lamps of a scene: found from places in a box of side two, and densities of finding what was found.
fn lamps_of(c: &mut Criterion, name: &str, description: Description) {
    let scene = flatten(description);
    let lights = scene.lights(Wavelengths::Rgb);
    let asked = inputs(|s| {
        let ([x, y], z) = (s.next_2d(), s.next_1d());
        let place = Vec3::new(x, y, z) * 1.8 - Vec3::splat(0.9);
        (place, s.next_2d(), s.next_2d())
    });
    let found: Vec<_> = asked
        .iter()
        .filter_map(|(from, choice, u)| Some((*from, lights.sample_towards(*from, *choice, *u)?.point)))
        .collect();
    let mut group = c.benchmark_group("lamp");
    each(&mut group, &format!("sample_towards {name}"), &asked, |(from, choice, u)| {
        lights.sample_towards(*from, *choice, *u)
    });
    each(&mut group, &format!("towards_pdf {name}"), &found, |(from, p)| lights.towards_pdf(*from, p));
    each(&mut group, &format!("sample_emission {name}"), &asked, |(from, choice, u)| {
        lights.sample_emission(*choice, *u, [from.x.abs(), from.y.abs()])
    });
}

fn lamps(c: &mut Criterion) {
    lamps_of(c, "rectangle", scenes::open_box());
    lamps_of(c, "sphere", scenes::bulb());
    lamps_of(c, "environment", scenes::under_the_sky(MaterialKind::Diffuse { albedo: Rgb::WHITE.into() }));
}

/// Splats of one thread into a film of 400 × 300 pixels.
fn film(c: &mut Criterion) {
    let (width, height) = (400, 300);
    let window = Window { x: 0, y: 0, width, height };
    let film = match Film::new(FilmLayout { width, height, window, quantum_exponent: -30 }) {
        Ok(film) => film,
        Err(e) => panic!("{e}"),
    };
    let Some(mut buffer) = film.light_buffer() else { panic!("no memory for splats") };
    let splats = inputs(|s| {
        let [x, y] = s.next_2d();
        (Vec2::new(x * width as f32, y * height as f32), Rgb::splat(s.next_1d()))
    });
    for (name, filter) in filters() {
        let mut group = c.benchmark_group("film");
        each(&mut group, &format!("splat {name}"), &splats, |(at, value)| {
            film.splat_into(&mut buffer, &filter, *at, *value);
        });
    }
    let mut group = c.benchmark_group("film");
    each(&mut group, "add_eye", &splats, |(at, value)| film.add_eye([at.x as u32, at.y as u32], *value));
}

fn filters() -> [(&'static str, PixelFilter); 2] {
    [("box", Filter::Box { radius: 0.5 }), ("gaussian", Filter::default())]
        .map(|(name, filter)| (name, PixelFilter::new(&filter)))
}

/// Offsets drawn by the pixel filter, and its values.
fn pixel_filter(c: &mut Criterion) {
    let places = inputs(|s| s.next_2d());
    for (name, filter) in filters() {
        let mut group = c.benchmark_group("pixel filter");
        each(&mut group, &format!("sample {name}"), &places, |u| filter.sample(*u));
        each(&mut group, &format!("eval {name}"), &places, |[x, y]| filter.eval(*x, *y));
    }
}

/// Takes what it gets and keeps a sum, so that nothing can be left out.
struct Sum(f32);

impl Sink for Sum {
    fn eye(&mut self, value: Rgb) {
        self.0 += value.0[0];
    }

    fn splat(&mut self, _: Vec2, value: Rgb) {
        self.0 += value.0[0];
    }
}

/// Whole samples, without their film.
fn samples(c: &mut Criterion) {
    let scenes = [("built-in", caustica::default_scene::description()), ("plain box", scenes::open_box())];
    for (name, description) in scenes {
        let scene: Scene = flatten(description);
        let (width, height) = (scene.film.width, scene.film.height);
        let ids = inputs(|s| {
            let [x, y] = s.next_2d();
            ([(x * width as f32) as u32, (y * height as f32) as u32], (s.next_1d() * 64.0) as u32)
        });
        let mut group = c.benchmark_group("sample");
        for (method, integrator) in [("path", Integrator::Path(Technique::Mis)), ("bdpt", Integrator::Bdpt)] {
            let kernel = Kernel::new(&scene, Settings { integrator, ..Settings::default() });
            let (mut scratch, mut sink) = (Scratch::default(), Sum(0.0));
            each(&mut group, &format!("{method} {name}"), &ids, |(pixel, sample)| {
                kernel.sample(*pixel, *sample, &mut scratch, &mut sink);
            });
            black_box(sink.0);
        }
    }
}

fn main() {
    let mut c = Criterion::default().configure_from_args();
    for group in [tree, numbers, scattering, lamps, film, pixel_filter, samples] {
        group(&mut c);
    }
    c.final_summary();
}
