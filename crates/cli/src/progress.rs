use std::time::Duration;

use caustica::Progress;
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

/// A progress bar on the standard error, or nothing.
pub struct Bar(Option<ProgressBar>);

/// Steps of the bar.
const STEPS: u64 = 1000;

impl Bar {
    /// A bar, unless it is to be `hidden`.
    pub fn new(hidden: bool) -> Self {
        if hidden {
            return Self(None);
        }
        let bar = ProgressBar::new(STEPS);
        if let Ok(style) = ProgressStyle::with_template("{bar:28.cyan/blue} {msg}") {
            bar.set_style(style.progress_chars("━╸─"));
        }
        Self(Some(bar))
    }

    /// Shows how far a session is.
    pub fn show(&self, p: &Progress) {
        let Some(bar) = &self.0 else { return };
        bar.set_position((p.fraction * STEPS as f64) as u64);
        let samples = if p.total == u32::MAX {
            format!("{:.1} spp", p.samples)
        } else {
            format!("{:.1}/{} spp", p.samples, p.total)
        };
        let remaining = if p.fraction > 0.001 {
            let seconds = p.elapsed.as_secs_f64() * (1.0 / p.fraction - 1.0);
            format!("{} left", HumanDuration(Duration::from_secs_f64(seconds.min(1e9))))
        } else {
            "…".to_owned()
        };
        bar.set_message(format!(
            "{:3.0}%  {samples}  {:.2} M samples/s  {}  {remaining}",
            p.fraction * 100.0,
            p.rate * 1e-6,
            HumanDuration(p.elapsed),
        ));
    }

    /// Says something above the bar.
    pub fn note(&self, message: &str) {
        if let Some(bar) = &self.0 {
            bar.println(message);
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}
