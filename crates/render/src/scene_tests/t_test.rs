use caustica_import::TestKind;
use caustica_math::stats::{Moments, sidak, student_t_test};
use caustica_math::{Filter, Rgb, SampleStream, Sampler, StreamId, Vec2, Vec3, Wavelengths};
use caustica_scene::bsdf::{Bsdf, Walk};
use caustica_scene::description::{Crop, Integrator};
use caustica_scene::light::Anchor;
use caustica_scene::{Description, Diagnostic, Origin, Scene};
use caustica_transport::{Kernel, Scratch, Settings, Sink};

use super::parallel::for_all;
use super::{Job, Outcome, alone, bsdf, bsdf_name, figure, stream_seed};

/// Runs a `ttest`.
pub(super) fn run(job: &Job<'_>, tell: &mut dyn FnMut(Outcome)) {
    let TestKind::TTest { sample_count, references, angles, distances, scenes } = &job.test.kind else {
        return;
    };
    let stage = &job.test.stage;
    let mut run = Run { job, samples: *sample_count, references, next: 0, tell };
    if !scenes.is_empty() {
        run.scenes(scenes);
    } else if stage.lights.is_empty() && stage.shapes.is_empty() {
        run.bsdfs(stage, angles);
    } else {
        run.emitters(stage, distances);
    }
}

/// A test with the references that are left.
struct Run<'a> {
    job: &'a Job<'a>,
    samples: u64,
    references: &'a [f64],
    /// The next reference.
    next: usize,
    tell: &'a mut dyn FnMut(Outcome),
}

/// Consecutive samples.
#[derive(Clone, Copy)]
struct Block {
    seed: u64,
    first: u32,
}

impl Block {
    /// The stream of the block's sample of that index.
    fn stream(self, index: usize) -> SampleStream {
        // No walk of the kernel has this number.
        let walk = u32::MAX;
        SampleStream::new(StreamId { seed: self.seed, pixel: 0, sample: self.first + index as u32, walk })
    }
}

/// Fills in the values of a block.
type Estimator<'a> = &'a (dyn Fn(Block, &mut [f64]) + Sync);

/// How many values are held at a time.
const BATCH: u64 = 1 << 16;

impl Run<'_> {
    fn bsdfs(&mut self, stage: &Description, angles: &[f64]) {
        for index in 0..stage.materials.len() {
            let origin = stage.materials[index].origin.as_ref();
            let name = bsdf_name(stage, index);
            let bsdf = bsdf(stage, index);
            for angle in angles {
                let (sin, cos) = libm::sincos(angle.to_radians());
                let given = Vec3::new(sin as f32, 0.0, cos as f32);
                let name = format!("{name}, {angle}°");
                self.case(&name, origin, &bsdf, &|bsdf, block, values| {
                    each(block, values, |s| sample_weight(bsdf, given, s));
                });
            }
        }
    }

    fn emitters(&mut self, stage: &Description, distances: &[f64]) {
        for (index, (origin, emitter)) in emitters(stage).into_iter().enumerate() {
            let scene = Scene::new(emitter).map(|(scene, _)| scene);
            for distance in distances {
                let name = format!("emitter {}, distance {distance}", index + 1);
                let from = Vec3::new(0.0, 0.0, *distance as f32);
                self.case(&name, origin.as_ref(), &scene, &|scene, block, values| {
                    each(block, values, |s| irradiance(scene, from, s));
                });
            }
        }
    }

    fn scenes(&mut self, scenes: &[Description]) {
        for (index, description) in scenes.iter().enumerate() {
            let integrator = description.integrator;
            let mut description = description.clone();
            description.film.filter = Filter::Box { radius: 0.5 };
            let scene = Scene::new(description).map(|(scene, _)| scene);
            self.case(&format!("scene {}", index + 1), None, &scene, &|scene, block, values| {
                film_means(scene, integrator, block, values);
            });
        }
    }

    /// Tests the mean of what `estimate` finds against the next reference, if there is something to ask.
    fn case<T: Sync>(
        &mut self,
        name: &str,
        origin: Option<&Origin>,
        subject: &Result<T, Diagnostic>,
        estimate: &(dyn Fn(&T, Block, &mut [f64]) + Sync),
    ) {
        let index = self.next;
        self.next += 1;
        let outcome = match subject {
            Ok(subject) => {
                let verdict = self.verdict(index, &|block, values| estimate(subject, block, values));
                self.job.outcome(name, origin, verdict)
            }
            Err(why) => self.job.refusal(name, origin, why),
        };
        (self.tell)(outcome);
    }

    fn verdict(&self, index: usize, estimate: Estimator<'_>) -> (bool, String) {
        let moments = self.moments(stream_seed(self.job.seed, index as u64), estimate);
        let reference = self.references[index];
        let alpha = sidak(self.job.test.significance, self.references.len());
        let p_value = student_t_test(&moments, reference);
        let [mean, reference, p, a] = [moments.mean, reference, p_value, alpha].map(figure);
        let n = moments.count;
        let detail = format!("mean {mean}, reference {reference}, p-value {p}, α {a}, {n} samples");
        (p_value >= alpha && moments.mean.is_finite(), detail)
    }

    /// The moments of all samples, taken in the order of the samples whichever thread made them.
    fn moments(&self, seed: u64, estimate: Estimator<'_>) -> Moments {
        let mut moments = Moments::default();
        let mut values = vec![0.0; self.samples.min(BATCH) as usize];
        for batch in 0..self.samples.div_ceil(BATCH) {
            let seed = stream_seed(seed, batch);
            let values = &mut values[..(self.samples - batch * BATCH).min(BATCH) as usize];
            for_all(values, self.job.threads, &|first, part| {
                estimate(Block { seed, first: first as u32 }, part);
            });
            values.iter().for_each(|v| moments.push(*v));
        }
        moments
    }
}

/// Values that need but a stream each.
fn each(block: Block, values: &mut [f64], estimate: impl Fn(&mut SampleStream) -> f64) {
    for (i, value) in values.iter_mut().enumerate() {
        *value = estimate(&mut block.stream(i));
    }
}

/// The luminance of the weight of one sample of a BSDF.
fn sample_weight(bsdf: &Bsdf, given: Vec3, stream: &mut SampleStream) -> f64 {
    let [u0, u1] = stream.next_2d();
    bsdf.sample(Walk::FromCamera, given, [u0, u1, stream.next_1d()])
        .map_or(0.0, |s| f64::from(Wavelengths::Rgb.luminance(s.value)) / f64::from(s.pdf.get()))
}

/// The luminance that one sample of the lamps sends to a place, over its density in solid angle; for lamps
/// without extent, the irradiance across the ray.
fn irradiance(scene: &Scene, from: Vec3, stream: &mut SampleStream) -> f64 {
    let wavelengths = Wavelengths::Rgb;
    let (choice, u) = (stream.next_2d(), stream.next_2d());
    let Some(lamp) = scene.lights(wavelengths).sample_towards(from, choice, u) else { return 0.0 };
    let falloff = match lamp.point.anchor {
        Anchor::Infinite => 1.0,
        Anchor::Surface | Anchor::Point => {
            f64::from(lamp.point.cos(lamp.direction)) / f64::from(lamp.distance).powi(2)
        }
    };
    f64::from(wavelengths.luminance(lamp.radiance)) * falloff / f64::from(lamp.pdf.0)
}

/// The emitters of the stage in the order of the file, each alone, with its origin.
fn emitters(stage: &Description) -> Vec<(Option<Origin>, Description)> {
    let lights = stage.lights.iter().map(|light| {
        let description = Description { lights: vec![light.clone()], ..alone(stage, vec![]) };
        (light.origin.clone(), description)
    });
    let shapes = stage.shapes.iter().map(|s| (s.origin.clone(), alone(stage, vec![s.clone()])));
    let mut emitters: Vec<_> = lights.chain(shapes).collect();
    emitters.sort_by_key(|(origin, _)| origin.as_ref().map(|o| (o.line, o.column)));
    emitters
}

/// Estimates of the film's mean luminance.
fn film_means(scene: &Scene, integrator: Integrator, block: Block, values: &mut [f64]) {
    // The t-test counts every sample as independent of the others.
    let (sampler, shared_light_paths) = (Sampler::Independent, 1);
    let settings =
        Settings { integrator, seed: block.seed, sampler, shared_light_paths, ..Settings::default() };
    let kernel = Kernel::new(scene, settings);
    let mut scratch = Scratch::default();
    let window = scene.film.window();
    for (i, value) in values.iter_mut().enumerate() {
        let [u, v] = block.stream(i).next_2d();
        let at = |u: f32, start: u32, size: u32| start + ((u * size as f32) as u32).min(size - 1);
        let pixel = [at(u, window.x, window.width), at(v, window.y, window.height)];
        let mut sink = FilmSum { window, sum: Rgb::BLACK };
        kernel.sample(pixel, block.first + i as u32, &mut scratch, &mut sink);
        *value = f64::from(sink.sum.luminance());
    }
}

/// All that one sample brings to the film. The mean of a splat over all pixels and over all light paths of a
/// pass is the splat itself, since the two are equally many and it counts for one pixel.
struct FilmSum {
    window: Crop,
    sum: Rgb,
}

impl Sink for FilmSum {
    fn eye(&mut self, value: Rgb) {
        self.sum = self.sum + value;
    }

    fn splat(&mut self, film: Vec2, value: Rgb) {
        let w = self.window;
        let inside = |x: f32, start: u32, size: u32| x >= start as f32 && x < (start + size) as f32;
        if inside(film.x, w.x, w.width) && inside(film.y, w.y, w.height) {
            self.sum = self.sum + value;
        }
    }
}
