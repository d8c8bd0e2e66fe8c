//! Work in numbered parts, on several threads, whose results are taken in order.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;

use caustica_render::{Control, RenderError};

/// Runs `work` for 0 to `count` − 1 and hands the results to `take` in that order, whichever thread was first; so that
/// what is made of them does not depend on threads. False if it was stopped before all were done.
///
/// # Errors
/// If no thread could be started.
pub fn run<T: Send>(
    (count, threads): (usize, usize),
    control: &Control,
    work: impl Fn(usize) -> T + Sync,
    mut take: impl FnMut(T),
) -> Result<bool, RenderError> {
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    std::thread::scope(|scope| {
        for i in 0..threads.clamp(1, count.max(1)) {
            let (sender, next, work) = (sender.clone(), &next, &work);
            let worker = std::thread::Builder::new().name(format!("verify {i}"));
            let spawned = worker.spawn_scoped(scope, move || {
                while !control.is_stopped() {
                    let part = next.fetch_add(1, Ordering::Relaxed);
                    if part >= count || sender.send((part, work(part))).is_err() {
                        return;
                    }
                }
            });
            if let Err(e) = spawned {
                next.store(count, Ordering::Relaxed);
                return Err(RenderError::Threads(e));
            }
        }
        drop(sender);
        let (mut waiting, mut taken) = (BTreeMap::new(), 0);
        for (part, result) in receiver {
            waiting.insert(part, result);
            while let Some(result) = waiting.remove(&taken) {
                take(result);
                taken += 1;
            }
        }
        Ok(taken == count)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_order() {
        for threads in [1, 3, 64] {
            let mut taken = Vec::new();
            let done = run((50, threads), &Control::default(), |i| i * i, |r| taken.push(r));
            assert!(done.unwrap());
            assert_eq!(taken, (0..50).map(|i| i * i).collect::<Vec<_>>());
        }
    }

    #[test]
    fn what_is_stopped_says_so() {
        let control = Control::default();
        let mut count = 0;
        let stop = |i| {
            if i == 3 {
                control.stop();
            }
        };
        assert!(!run((1000, 1), &control, stop, |()| count += 1).unwrap());
        assert_eq!(count, 4);
    }
}
