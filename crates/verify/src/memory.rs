//! How much memory is needed, before any is taken.

use caustica_math::{MemoryLimit, Rgb};
use caustica_render::available_threads;
use caustica_scene::description::Crop;

use crate::explain::MOST_PATTERNS;
use crate::tally::Powers;
use crate::verify::VerifyError;

/// What a picture of some size takes to be looked into.
#[derive(Clone, Copy, Debug)]
pub struct Need {
    doing: &'static str,
    window: Crop,
    bytes: u64,
}

impl Need {
    /// Whether there is so much.
    ///
    /// # Errors
    /// If there is not.
    pub fn check(self, limit: MemoryLimit) -> Result<(), VerifyError> {
        let Crop { width, height, .. } = self.window;
        limit.check(self.bytes).map_err(|shortage| VerifyError::Memory {
            doing: self.doing,
            width,
            height,
            shortage,
        })
    }
}

/// Parts of the work that are there at once: one for each thread, and some that wait for their turn.
fn at_once(threads: Option<usize>) -> u64 {
    threads.unwrap_or_else(available_threads) as u64 + 2
}

fn pixels(window: Crop) -> u64 {
    u64::from(window.width) * u64::from(window.height)
}

/// To verify a window by so many estimators, whose light is sorted into so many blocks, and to show what was found.
pub fn for_verifying(window: Crop, (estimators, blocks): (usize, usize), threads: Option<usize>) -> Need {
    let (estimators, at_once) = (estimators as u64, at_once(threads));
    // One of each estimator here and on the page, the reference, those that are being made; and the maps' colours.
    let pictures = 2 * estimators + at_once + 6;
    let pixel = pictures * size_of::<Rgb>() as u64 + 8 * (estimators + 1);
    // Of each estimator, and of each set of those that reach the same; there are not many more of the latter.
    let sorted = 2 * (estimators + 1) * (blocks as u64) * Powers::memory_of_a_block();
    Need { doing: "verify", window, bytes: pixels(window) * pixel + at_once * sorted }
}

/// To explain a region.
pub fn for_explaining(region: Crop, threads: Option<usize>) -> Need {
    let layers = MOST_PATTERNS * (at_once(threads) + 1);
    Need { doing: "explain", window: region, bytes: pixels(region) * layers * size_of::<f32>() as u64 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_told_with_the_figure() {
        let window = |side| Crop { x: 0, y: 0, width: side, height: side };
        let needs =
            |side| [for_verifying(window(side), (11, 64), Some(2)), for_explaining(window(side), Some(2))];
        for need in needs(96) {
            need.check(MemoryLimit::Bytes(100_000_000)).unwrap();
        }
        for (need, doing) in needs(20_000).into_iter().zip(["verify", "explain"]) {
            let told = need.check(MemoryLimit::Bytes(100_000_000)).unwrap_err().to_string();
            assert!(told.starts_with(&format!("to {doing} 20000 × 20000 pixels needs ")), "{told}");
            assert!(told.contains("MB of memory, and 100 MB are there"), "{told}");
        }
    }
}
