//! Ctrl-C: the first one asks a render to stop, the second one ends the program.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use caustica::Control;

use crate::console::note;

/// The exit code of a program that was interrupted.
const INTERRUPTED: i32 = 130;

/// Listens to Ctrl-C, and to the signals by which systems ask programs to end.
pub struct Interrupts {
    /// Is stopped by the first one.
    pub control: Arc<Control>,
    /// Whether the next one ends the program.
    last: Arc<AtomicBool>,
}

impl Interrupts {
    /// Listens from now on. If that cannot be, Ctrl-C ends the program as it always does.
    pub fn listen() -> Self {
        let (control, last) = (Arc::new(Control::default()), Arc::new(AtomicBool::new(false)));
        let heard = (Arc::clone(&control), Arc::clone(&last));
        let handler = ctrlc::set_handler(move || {
            heard.0.stop();
            if heard.1.swap(true, Ordering::SeqCst) {
                note("\n");
                std::process::exit(INTERRUPTED);
            }
        });
        if let Err(e) = handler {
            note(format_args!("Ctrl-C ends the program without a picture: {e}\n"));
        }
        Self { control, last }
    }

    /// The next one ends the program.
    pub fn stop_at_once(&self) {
        self.last.store(true, Ordering::SeqCst);
    }
}
