use std::sync::{Mutex, PoisonError};
use std::thread;

/// Items of a part: enough to outweigh the hand-out, few enough to share out evenly.
const PART: usize = 64;

/// Does `work` on all items, in parts that are handed out to threads; it is told the index of the part's
/// first item.
pub(super) fn for_all<T: Send>(items: &mut [T], threads: usize, work: &(dyn Fn(usize, &mut [T]) + Sync)) {
    let threads = threads.min(items.len().div_ceil(PART));
    let parts = Mutex::new(items.chunks_mut(PART).enumerate());
    let worker = || {
        loop {
            // A worker that panics takes the test down anyway.
            let next = parts.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some((i, part)) = next else { return };
            work(i * PART, part);
        }
    };
    thread::scope(|scope| {
        for _ in 1..threads {
            // This thread works too: one that cannot be had only costs time.
            if thread::Builder::new().spawn_scoped(scope, worker).is_err() {
                break;
            }
        }
        worker();
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_item_is_worked_on_once() {
        for (count, threads) in [(0, 4), (1, 4), (64, 1), (1000, 1), (1000, 3), (1000, 100)] {
            let mut items = vec![0; count];
            for_all(&mut items, threads, &|first, part| {
                for (i, item) in part.iter_mut().enumerate() {
                    *item += first + i + 1;
                }
            });
            assert!(items.iter().enumerate().all(|(i, item)| *item == i + 1), "{count} by {threads}");
        }
    }
}
