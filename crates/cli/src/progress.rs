use std::cell::Cell;
use std::time::Duration;

use caustica::{Control, Progress};
use indicatif::{ProgressBar, ProgressStyle};

use crate::console::note;

/// A progress bar on the standard error, or nothing.
pub struct Bar {
    bar: Option<ProgressBar>,
    /// Whether it has told that the work is being stopped.
    told: Cell<bool>,
}

/// Steps of the bar.
const STEPS: u64 = 1000;

/// Before this part of the work is done, the remaining time is anybody's guess.
const GUESS: f64 = 0.001;

impl Bar {
    /// A bar, or nothing. Without a terminal the bar does not appear, but notes do.
    pub fn new(shown: bool) -> Self {
        if !shown {
            return Self { bar: None, told: Cell::new(false) };
        }
        let bar = ProgressBar::new(STEPS);
        // The end of the line is left to the `^C` that terminals echo.
        if let Ok(style) = ProgressStyle::with_template("{bar:12.cyan/blue} {wide_msg}    ") {
            bar.set_style(style.progress_chars("━╸─"));
        }
        Self { bar: Some(bar), told: Cell::new(false) }
    }

    /// Shows how far a session is.
    pub fn show(&self, p: &Progress) {
        if let Some(bar) = &self.bar {
            bar.set_position((p.fraction * STEPS as f64) as u64);
            bar.set_message(message(p));
        }
    }

    /// Says once that the work is being stopped, if it is.
    pub fn tell_stop(&self, control: &Control) {
        if control.is_stopped() && !self.told.replace(true) {
            self.note("stopping after this pass; Ctrl-C again stops at once, without a picture");
        }
    }

    /// Shows that a stage's picture is being measured.
    pub fn show_measuring(&self, stage: &str) {
        if let Some(bar) = &self.bar {
            bar.set_message(format!("{stage}  measuring"));
        }
    }

    /// Shows how far a stage of something larger is.
    pub fn show_stage(&self, stage: &str, p: &Progress) {
        if let Some(bar) = &self.bar {
            bar.set_position((p.fraction * STEPS as f64) as u64);
            bar.set_message(format!("{stage}  {}", message(p)));
        }
    }

    /// Shows what is being rendered, and which part of all work is done.
    pub fn show_part(&self, name: &str, fraction: f64) {
        if let Some(bar) = &self.bar {
            bar.set_position((fraction * STEPS as f64) as u64);
            bar.set_message(format!(
                "{:3.0}%  {name}  {} so far",
                fraction * 100.0,
                duration(bar.elapsed().as_secs_f64())
            ));
        }
    }

    /// Shows how many of a video's frames there are.
    pub fn show_frames(&self, done: u32, total: u32) {
        if let Some(bar) = &self.bar {
            bar.set_position(u64::from(done) * STEPS / u64::from(total.max(1)));
            bar.set_message(format!(
                "frame {done}/{total}  {} so far",
                duration(bar.elapsed().as_secs_f64())
            ));
        }
    }

    /// Says something above the bar.
    pub fn note(&self, message: &str) {
        match &self.bar {
            Some(bar) if bar.is_hidden() => note(format_args!("{message}\n")),
            Some(bar) => bar.println(message),
            None => {}
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

fn message(p: &Progress) -> String {
    let total = if p.total == u32::MAX { String::new() } else { format!("/{}", p.total) };
    let elapsed = p.elapsed.as_secs_f64();
    let left =
        if p.fraction > GUESS { duration(elapsed * (1.0 / p.fraction - 1.0)) } else { "…".to_owned() };
    format!(
        "{:3.0}%  {left} left  {:.1}{total} spp  {:.2} M samples/s  {} so far",
        p.fraction * 100.0,
        p.samples,
        p.rate * 1e-6,
        duration(elapsed),
    )
}

/// A time in its two largest units.
fn duration(seconds: f64) -> String {
    let s = Duration::try_from_secs_f64(seconds).map_or(u64::MAX, |d| d.as_secs());
    match (s / 86_400, s / 3600 % 24, s / 60 % 60, s % 60) {
        (0, 0, 0, s) => format!("{s}s"),
        (0, 0, m, s) => format!("{m}m{s:02}s"),
        (0, h, m, _) => format!("{h}h{m:02}m"),
        (d, _, _, _) if d > 9999 => "ages".to_owned(),
        (d, h, _, _) => format!("{d}d{h:02}h"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_two_units() {
        for (seconds, text) in
            [(0.4, "0s"), (61.0, "1m01s"), (7500.0, "2h05m"), (1e5, "1d03h"), (1e30, "ages")]
        {
            assert_eq!(duration(seconds), text);
        }
    }

    #[test]
    fn messages_tell_what_is_known() {
        let p = Progress {
            samples: 12.5,
            total: 50,
            fraction: 0.25,
            elapsed: Duration::from_secs(30),
            rate: 2.5e6,
        };
        assert_eq!(message(&p), " 25%  1m30s left  12.5/50 spp  2.50 M samples/s  30s so far");
        let p = Progress { total: u32::MAX, fraction: 0.0, ..p };
        assert_eq!(message(&p), "  0%  … left  12.5 spp  2.50 M samples/s  30s so far");
    }
}
