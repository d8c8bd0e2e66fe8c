use std::sync::{Mutex, MutexGuard, PoisonError};

/// Hands out units of work in order, pass after pass, without a pause between passes; when asked to stop it
/// still hands out the rest of the pass that has begun, so that only whole passes are ever counted.
#[derive(Debug)]
pub(crate) struct Queue {
    state: Mutex<State>,
    units_per_pass: u64,
}

#[derive(Debug)]
struct State {
    next: u64,
    end: u64,
    done: u64,
}

impl Queue {
    pub(crate) fn new(units_per_pass: u64, passes: u64) -> Self {
        let end = units_per_pass.saturating_mul(passes);
        Self { state: Mutex::new(State { next: 0, end, done: 0 }), units_per_pass }
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

    /// Units done, and the number at which the queue ends.
    pub(crate) fn progress(&self) -> (u64, u64) {
        let state = self.lock();
        (state.done, state.end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stopping_finishes_the_pass() {
        let q = Queue::new(3, 10);
        assert_eq!(q.next(false), Some((0, 0)));
        q.next(true);
        q.next(true);
        assert_eq!(q.next(true), Some((1, 0)));
        q.stop();
        assert_eq!(q.next(true), Some((1, 1)));
        assert_eq!(q.next(true), Some((1, 2)));
        assert_eq!(q.next(true), None);
        assert_eq!(q.progress(), (6, 6));
    }

    #[test]
    fn stopping_before_the_start_or_between_passes_adds_nothing() {
        let q = Queue::new(3, 10);
        q.stop();
        assert_eq!(q.next(false), None);
        let q = Queue::new(1, 10);
        q.next(false);
        q.stop();
        assert_eq!(q.next(true), None);
        assert_eq!(q.progress(), (1, 1));
    }
}
