//! Worker threads that share out a film's tiles, pass after pass.

use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

use caustica_film::Window;

use crate::queue::Queue;
use crate::session::{Control, Progress, RenderError};

/// Edge of a tile in pixels: small enough to share out evenly, large enough to keep caches warm.
const TILE: u32 = 16;

/// How often progress is told.
const TICK: Duration = Duration::from_millis(100);

/// The shortest wait for the end of the time, or of a pass that outlasts it.
const SHORTEST_TICK: Duration = Duration::from_millis(5);

/// For how long to render.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// Samples per pixel that the film has at the end, at most.
    pub samples: u32,
    /// Stops with the pass that runs when this is over.
    pub time: Option<Duration>,
}

/// Work on the passes of a window.
pub(crate) struct Workers<'a> {
    pub window: Window,
    /// The number of the first sample.
    pub start: u64,
    /// Passes that are done already: the budget counts them.
    pub done: u64,
    pub budget: Budget,
    pub threads: usize,
    pub control: &'a Control,
}

/// The units that one worker gets: a pass and a tile of it.
pub(crate) struct Units<'a> {
    start: u64,
    queue: &'a Queue,
    tiles: &'a [Window],
    finished: bool,
}

impl Iterator for Units<'_> {
    type Item = (u32, Window);

    fn next(&mut self) -> Option<Self::Item> {
        let (pass, unit) = self.queue.next(self.finished)?;
        self.finished = true;
        Some(((self.start + pass) as u32, self.tiles[unit as usize]))
    }
}

impl Workers<'_> {
    /// Runs `work` on every thread until the samples or the time are used up, or the control says stop. Only whole
    /// passes are done, and the time is enough for one at least. Returns how many passes were added. `progress` is
    /// called about ten times a second, on this thread.
    pub fn run(
        &self,
        work: impl Fn(Units<'_>) + Sync,
        mut progress: impl FnMut(&Progress),
    ) -> Result<u64, RenderError> {
        let start = Instant::now();
        let tiles = tiles(self.window);
        let queue = Queue::new(tiles.len() as u64, self.done, u64::from(self.budget.samples));
        let (sender, receiver) = mpsc::channel::<()>();
        std::thread::scope(|scope| {
            for i in 0..self.threads {
                let sender = sender.clone();
                let (start, queue, tiles, work) = (self.start, &queue, &tiles, &work);
                let worker = std::thread::Builder::new().name(format!("render {i}"));
                let spawned = worker.spawn_scoped(scope, move || {
                    work(Units { start, queue, tiles, finished: false });
                    drop(sender);
                });
                if let Err(e) = spawned {
                    queue.stop();
                    return Err(RenderError::Threads(e));
                }
            }
            drop(sender);
            // The channel closes when all workers are done.
            while receiver.recv_timeout(self.tick(start)) == Err(RecvTimeoutError::Timeout) {
                let late = self.budget.time.is_some_and(|t| start.elapsed() >= t);
                if self.control.is_stopped() || (late && queue.has_begun()) {
                    queue.stop();
                }
                progress(&self.progress(&queue, start));
            }
            Ok(())
        })?;
        progress(&self.progress(&queue, start));
        Ok(queue.progress().added as u64)
    }

    /// How long to wait before looking at the time again.
    fn tick(&self, start: Instant) -> Duration {
        let left = self.budget.time.map(|t| t.saturating_sub(start.elapsed())).unwrap_or(TICK);
        left.clamp(SHORTEST_TICK, TICK)
    }

    fn progress(&self, queue: &Queue, start: Instant) -> Progress {
        let passes = queue.progress();
        let elapsed = start.elapsed();
        let by_time = self.budget.time.map_or(0.0, |t| elapsed.as_secs_f64() / t.as_secs_f64().max(1e-9));
        Progress {
            samples: passes.passes,
            total: self.budget.samples,
            fraction: passes.fraction.max(by_time).min(1.0),
            elapsed,
            rate: passes.added * self.window.pixels() as f64 / elapsed.as_secs_f64().max(1e-9),
        }
    }
}

/// The tiles of a pass. They begin at multiples of their size, wherever the window does, so that they hold whole groups of
/// pixels that share light paths.
fn tiles(w: Window) -> Vec<Window> {
    let steps = |start: u32, size: u32| {
        let end = start + size;
        let first = start / TILE * TILE;
        (first..end).step_by(TILE as usize).map(move |at| (at.max(start), at.saturating_add(TILE).min(end)))
    };
    steps(w.y, w.height)
        .flat_map(|(y, bottom)| {
            steps(w.x, w.width).map(move |(x, right)| Window { x, y, width: right - x, height: bottom - y })
        })
        .collect()
}

/// The pixels of a tile.
pub(crate) fn pixels(tile: Window) -> impl Iterator<Item = [u32; 2]> {
    (tile.y..tile.y + tile.height).flat_map(move |y| (tile.x..tile.x + tile.width).map(move |x| [x, y]))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn tiles_cover_each_pixel_once_and_begin_at_multiples_of_their_size() {
        for (x, y, width, height) in [(0, 0, 64, 48), (5, 3, 1, 1), (17, 31, 40, 2), (15, 16, 18, 33)] {
            let window = Window { x, y, width, height };
            let tiles = tiles(window);
            let all: Vec<[u32; 2]> = tiles.iter().flat_map(|tile| pixels(*tile)).collect();
            assert_eq!(all.len() as u32, width * height);
            assert_eq!(
                all.iter().collect::<BTreeSet<_>>(),
                pixels(window).collect::<Vec<_>>().iter().collect()
            );
            let of = |at: u32| at / TILE;
            assert!(
                tiles.iter().all(|t| of(t.x) == of(t.x + t.width - 1) && of(t.y) == of(t.y + t.height - 1))
            );
        }
    }
}
