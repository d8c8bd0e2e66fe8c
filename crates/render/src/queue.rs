use std::sync::{Mutex, MutexGuard, PoisonError};

/// Hands out units of work in order, pass after pass, without a pause between passes; when asked to stop it
/// still hands out the rest of the pass that has begun, so that only whole passes are ever counted.
#[derive(Debug)]
pub(crate) struct Queue {
    state: Mutex<State>,
    first: u64,
    units_per_pass: u64,
}

/// How far a queue is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct QueueProgress {
    /// Passes done, with those before the queue's first one.
    pub passes: f64,
    /// Passes that the queue has added.
    pub added: f64,
    /// The part of all passes that is done, in [0, 1].
    pub fraction: f64,
}

#[derive(Debug)]
struct State {
    next: u64,
    end: u64,
    done: u64,
}

impl Queue {
    /// A queue of the passes from `first` up to `end`.
    pub(crate) fn new(units_per_pass: u64, first: u64, end: u64) -> Self {
        let first = units_per_pass.saturating_mul(first);
        let end = units_per_pass.saturating_mul(end).max(first);
        Self { state: Mutex::new(State { next: first, end, done: first }), first, units_per_pass }
    }

    /// A worker that panicked takes the session down anyway.
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next unit: its pass, and its place in the pass. `finished` is whether the caller has done one.
    pub(crate) fn next(&self, finished: bool) -> Option<(u64, u64)> {
        let mut state = self.lock();
        state.done += u64::from(finished);
        if state.next >= state.end {
            return None;
        }
        let unit = state.next;
        state.next += 1;
        Some((unit / self.units_per_pass, unit % self.units_per_pass))
    }

    /// Ends with the pass that has begun.
    pub(crate) fn stop(&self) {
        let mut state = self.lock();
        state.end = state.end.min(state.next.div_ceil(self.units_per_pass) * self.units_per_pass);
    }

    /// Whether any unit has been handed out.
    pub(crate) fn has_begun(&self) -> bool {
        self.lock().next > self.first
    }

    /// How far it is; whole numbers of passes once no unit is out.
    pub(crate) fn progress(&self) -> QueueProgress {
        let State { done, end, .. } = *self.lock();
        let passes = |units: u64| units as f64 / self.units_per_pass as f64;
        QueueProgress {
            passes: passes(done),
            added: passes(done - self.first),
            fraction: if end == 0 { 1.0 } else { done as f64 / end as f64 },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn progress(q: &Queue) -> (f64, f64, f64) {
        let QueueProgress { passes, added, fraction } = q.progress();
        (passes, added, fraction)
    }

    #[test]
    fn stopping_finishes_the_pass() {
        let q = Queue::new(3, 0, 10);
        assert_eq!(q.next(false), Some((0, 0)));
        q.next(true);
        q.next(true);
        assert_eq!(q.next(true), Some((1, 0)));
        assert_eq!(progress(&q), (1.0, 1.0, 0.1));
        q.stop();
        assert_eq!(q.next(true), Some((1, 1)));
        assert_eq!(q.next(true), Some((1, 2)));
        assert_eq!(q.next(true), None);
        assert_eq!(progress(&q), (2.0, 2.0, 1.0));
    }

    #[test]
    fn stopping_before_the_start_or_between_passes_adds_nothing() {
        let q = Queue::new(3, 0, 10);
        assert!(!q.has_begun());
        q.stop();
        assert_eq!(q.next(false), None);
        assert_eq!(progress(&q), (0.0, 0.0, 1.0));
        let q = Queue::new(1, 0, 10);
        q.next(false);
        assert!(q.has_begun());
        q.stop();
        assert_eq!(q.next(true), None);
        assert_eq!(progress(&q), (1.0, 1.0, 1.0));
    }

    #[test]
    fn later_passes_follow_earlier_ones() {
        let q = Queue::new(2, 3, 5);
        assert!(!q.has_begun());
        assert_eq!(q.next(false), Some((3, 0)));
        q.next(true);
        q.next(true);
        q.next(true);
        assert_eq!(q.next(true), None);
        assert_eq!(progress(&q), (5.0, 2.0, 1.0));
        let over = Queue::new(2, 3, 1);
        assert_eq!(over.next(false), None);
        assert_eq!(progress(&over), (3.0, 0.0, 1.0));
    }
}
