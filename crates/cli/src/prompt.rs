use std::io::{BufRead, Write};

use caustica::LightImage;

use crate::args::LightImageChoice;

/// What becomes of the light image; asks on the terminal if that is the choice. No answer means yes.
pub fn light_image(choice: LightImageChoice) -> LightImage {
    match choice {
        LightImageChoice::On => LightImage::On,
        LightImageChoice::Off => LightImage::Off,
        LightImageChoice::Only => LightImage::Only,
        LightImageChoice::Ask => {
            eprint!("Add the light image (caustics) to the picture? [Y/n/only] ");
            // A prompt that cannot be shown can still be answered.
            let _ = std::io::stderr().flush();
            let mut answer = String::new();
            let read = std::io::stdin().lock().read_line(&mut answer);
            match answer.trim().to_ascii_lowercase().as_str() {
                "n" | "no" | "off" if read.is_ok() => LightImage::Off,
                "o" | "only" if read.is_ok() => LightImage::Only,
                _ => LightImage::On,
            }
        }
    }
}
