//! A render that converges.

use std::time::Duration;

use caustica_canvas::Canvas;
use caustica_film::{LightImage, Picture};
use caustica_render::{Budget, Control, RenderOptions, Session};
use caustica_scene::Scene;
use caustica_video::{Corner, Summary, caption, cross_fade, label, side_by_side, sweep, toggle, wipe};
use libm::{pow, round};

use crate::reel::{ClipError, ClipOptions, Reel, Step, size_of};

/// How the picture with its light image and that without share the frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Layout {
    /// A line sweeps over the picture; the light image is added at its left.
    #[default]
    Wipe,
    /// One, then the other, with a short fade.
    Toggle,
    /// Without at the left, with at the right.
    Side,
    /// With the light image alone.
    With,
    /// Without it alone.
    Without,
}

/// What converges.
#[derive(Clone, Debug)]
pub struct Converge {
    /// The integrator, threads, and how many samples the last frame has; time is a limit to them.
    pub render: RenderOptions,
    /// How the light image is shown.
    pub layout: Layout,
    /// For how many seconds the end is held.
    pub hold: f32,
}

/// A sweep of the line there and back, and a toggle there and back, take so many seconds.
const PERIOD: f32 = 4.0;

/// The share of a toggle's period that a fade takes.
const FADE: f32 = 0.06;

/// The pictures of a moment, and what is said about it.
struct Shown {
    with: Canvas,
    without: Canvas,
    text: String,
}

/// Renders, and shows the picture as samples double: each second of the clip has as many doublings as any other.
/// A clip that is
/// stopped ends with the pass that runs.
///
/// # Errors
/// A film that does not fit into memory, and what encoding and writing say.
pub fn converge(
    scene: &Scene,
    what: &Converge,
    options: &ClipOptions,
    control: &Control,
    progress: impl FnMut(Step),
) -> Result<Summary, ClipError> {
    let (frames, held) = (options.frames(), options.frames_of(what.hold));
    let [width, height] = size_of(scene);
    let size = [if what.layout == Layout::Side { width.saturating_mul(2) } else { width }, height];
    let mut reel = Reel::new(options, control, (size, frames + held), progress)?;
    let session = Session::new(scene, what.render.clone())?;
    let (mut seconds, mut samples) = (0.0, 0);
    let mut shown: Option<Shown> = None;
    for frame in 0..frames {
        if reel.is_stopped() {
            break;
        }
        let budget = budget(&what.render, frame + 1, (frames, seconds));
        if u64::from(budget.samples) > samples && budget.time.is_none_or(|t| !t.is_zero()) {
            let report = session.run_for(budget, control, |_| ())?;
            (seconds, samples) = (seconds + report.seconds, report.samples);
            shown = Some(develop(&session, options, seconds)?);
        }
        let Some(shown) = &shown else { break };
        reel.push(&compose(shown, what.layout, options, frame)?)?;
    }
    for frame in frames..frames + held {
        let Some(shown) = &shown else { break };
        reel.push(&compose(shown, what.layout, options, frame)?)?;
    }
    reel.finish()
}

/// What the film has after that many frames of all.
fn budget(render: &RenderOptions, done: u32, (frames, seconds): (u32, f64)) -> Budget {
    let share = f64::from(done) / f64::from(frames);
    let most = f64::from(render.samples.max(1));
    match render.time {
        None => Budget { samples: round(pow(most, share)).clamp(1.0, most) as u32, time: None },
        // A thousandth of the time at the start.
        Some(time) => {
            let until = time.as_secs_f64() * pow(1000.0, share - 1.0);
            let left = Duration::from_secs_f64((until - seconds).max(0.0));
            Budget {
                samples: render.samples,
                time: Some(if seconds == 0.0 { left.max(Duration::from_millis(1)) } else { left }),
            }
        }
    }
}

fn develop(session: &Session<'_>, options: &ClipOptions, seconds: f64) -> Result<Shown, ClipError> {
    let picture: Picture = session.film().develop_without_bars();
    let size = [picture.window.width, picture.window.height];
    let samples = picture.eye_samples.max(picture.light_samples);
    let show = |light_image| options.show(&picture.combined(light_image), size);
    Ok(Shown {
        with: show(LightImage::On)?,
        without: show(LightImage::Off)?,
        text: format!("{samples} spp   {}", duration(seconds)),
    })
}

fn compose(shown: &Shown, layout: Layout, options: &ClipOptions, frame: u32) -> Result<Canvas, ClipError> {
    let periods = options.time_of(frame) / PERIOD;
    let Shown { with, without, text } = shown;
    let mut canvas = match layout {
        Layout::Wipe => wipe(with, without, sweep(periods))?,
        Layout::Toggle => cross_fade(without, with, toggle(periods, FADE))?,
        Layout::Side => side_by_side(without, with)?,
        Layout::With => with.clone(),
        Layout::Without => without.clone(),
    };
    let tells = |with_it: bool| if with_it { "with light image" } else { "without light image" };
    match layout {
        Layout::Wipe => {
            let share = sweep(periods);
            if share > 0.35 {
                label(&mut canvas, tells(true), Corner::TopLeft);
            }
            if share < 0.65 {
                label(&mut canvas, tells(false), Corner::TopRight);
            }
        }
        Layout::Toggle => label(&mut canvas, tells(toggle(periods, FADE) > 0.5), Corner::TopLeft),
        Layout::Side => {
            label(&mut canvas, tells(false), Corner::TopLeft);
            label(&mut canvas, tells(true), Corner::TopRight);
        }
        Layout::With | Layout::Without => {}
    }
    caption(&mut canvas, &options.title, text);
    Ok(canvas)
}

/// "8.3 s", "2 min 05 s".
pub(crate) fn duration(seconds: f64) -> String {
    if seconds < 60.0 {
        return format!("{seconds:.1} s");
    }
    let whole = seconds as u64;
    match (whole / 3600, whole / 60 % 60, whole % 60) {
        (0, m, s) => format!("{m} min {s:02} s"),
        (h, m, _) => format!("{h} h {m:02} min"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_double_at_an_even_pace() {
        let render = RenderOptions { samples: 256, ..RenderOptions::default() };
        let at = |done| budget(&render, done, (80, 0.0)).samples;
        assert_eq!([at(1), at(10), at(20), at(70), at(80)], [1, 2, 4, 128, 256]);
        let timed = RenderOptions { time: Some(Duration::from_secs(10)), samples: u32::MAX, ..render };
        let until = |done, seconds| budget(&timed, done, (10, seconds)).time.unwrap().as_secs_f64();
        assert!((until(10, 4.0) - 6.0).abs() < 1e-6 && until(1, 5.0) == 0.0 && until(1, 0.0) >= 1e-3);
    }

    #[test]
    fn durations_read_well() {
        assert_eq!(duration(8.26), "8.3 s");
        assert_eq!(duration(125.9), "2 min 05 s");
        assert_eq!(duration(7265.0), "2 h 01 min");
    }
}
