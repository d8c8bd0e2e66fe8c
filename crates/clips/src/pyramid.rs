//! The pyramid summed up, strategy by strategy.

use caustica_canvas::Canvas;
use caustica_film::{Film, LightImage};
use caustica_math::Rgb;
use caustica_render::pyramid::{MOST_EDGES, Pyramid};
use caustica_render::{Control, Progress, RenderOptions};
use caustica_scene::Scene;
use caustica_video::{Corner, Summary, caption, cross_fade, label, side_by_side};

use crate::converge::duration;
use crate::reel::{ClipError, ClipOptions, Reel, Step, size_of};

/// What is summed.
#[derive(Clone, Debug)]
pub struct PyramidClip {
    /// Settings and samples; the integrator is `bdpt`.
    pub render: RenderOptions,
    /// The most edges of paths whose strategies are shown apart.
    pub rows: u32,
    /// For how many seconds the end is held.
    pub hold: f32,
}

/// The share of a strategy's time that its fade takes.
const FADE: f32 = 0.4;

/// Renders the pyramid and shows the sum so far at the left, and at the right the strategy that is being added. The
/// clip's seconds are shared out evenly. `rendering` is told how far the pyramid is; one that is stopped is shown with
/// the samples that it has.
///
/// # Errors
/// Films that do not fit into memory, and what encoding and writing say.
pub fn pyramid(
    scene: &Scene,
    what: &PyramidClip,
    (options, control): (&ClipOptions, &Control),
    rendering: impl FnMut(&Progress),
    progress: impl FnMut(Step),
) -> Result<Summary, ClipError> {
    let size = size_of(scene);
    // The longer paths are a step too.
    let rows = what.rows.clamp(1, MOST_EDGES);
    let steps = rows * (rows + 3) / 2 + 1;
    let (frames, held) = (options.frames().max(2 * steps), options.frames_of(what.hold));
    let double = [size[0].saturating_mul(2), size[1]];
    let mut reel = Reel::new(options, control, (double, frames + held), progress)?;
    let pyramid = Pyramid::new(scene, what.render.clone(), rows)?;
    let seconds = pyramid.run(control, rendering)?;
    let parts = parts(&pyramid);
    let mut sum = vec![Rgb::BLACK; size[0] as usize * size[1] as usize];
    let mut before = options.show(&sum, size)?;
    let right = format!("{} spp   {}", pyramid.whole().eye_samples(), duration(seconds));
    let mut last: Option<Canvas> = None;
    for (i, (name, pixels)) in parts.iter().enumerate() {
        sum.iter_mut().zip(pixels).for_each(|(sum, p)| *sum = *sum + *p);
        let (after, added) = (options.show(&sum, size)?, options.show(pixels, size)?);
        let starts = |part: usize| (part as u64 * u64::from(frames) / parts.len() as u64) as u32;
        let each = starts(i + 1) - starts(i);
        for frame in 0..each {
            let share = (frame + 1) as f32 / (each as f32 * FADE);
            let mut canvas = side_by_side(&cross_fade(&before, &after, share)?, &added)?;
            label(&mut canvas, &format!("sum of {}", i + 1), Corner::TopLeft);
            label(&mut canvas, name, Corner::TopRight);
            caption(&mut canvas, &options.title, &right);
            reel.push(&canvas)?;
            last = Some(canvas);
        }
        before = after;
    }
    for _ in 0..held {
        if let Some(canvas) = &last {
            reel.push(canvas)?;
        }
    }
    reel.finish()
}

/// What is added, in order, with its name: the strategies, then the longer paths.
fn parts(pyramid: &Pyramid<'_>) -> Vec<(String, Vec<Rgb>)> {
    let pixels = |film: &Film| film.develop().combined(LightImage::On);
    let mut steps: Vec<_> = pyramid
        .layers()
        .iter()
        .map(|l| (format!("+ s = {}, t = {}", l.strategy.s, l.strategy.t), pixels(&l.weighted)))
        .collect();
    steps.push((format!("+ paths of more than {} edges", pyramid.edges()), pixels(pyramid.rest())));
    steps
}
