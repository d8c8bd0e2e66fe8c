//! Sums beyond 64 bits.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicI64, Ordering::Relaxed};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::FilmError;

/// How often sums went round what 64 bits hold: a sum is its 64 bits and 2⁶⁴ times its turns. So the whole is exact, and
/// depends on no order, also where the way there leads beyond and back. There are hardly ever any.
#[derive(Debug, Default)]
pub(crate) struct Turns {
    any: AtomicBool,
    /// By the number of the sum; none is zero.
    of: Mutex<BTreeMap<u64, i64>>,
}

/// Nothing that is read has more.
const MOST: u64 = 1 << 32;

impl Turns {
    /// Adds to the sum of that number, and notes a turn if it makes one.
    #[inline]
    pub fn add(&self, (number, sum): (u64, &AtomicI64), count: i64) {
        let before = sum.fetch_add(count, Relaxed);
        if before.checked_add(count).is_none() {
            self.note(number, count.signum());
        }
    }

    /// The same for a sum that no other thread sees, such as a part of that one.
    #[inline]
    pub fn add_alone(&self, (number, sum): (u64, &mut i64), count: i64) {
        let (after, turned) = sum.overflowing_add(count);
        *sum = after;
        if turned {
            self.note(number, count.signum());
        }
    }

    #[cold]
    fn note(&self, number: u64, turns: i64) {
        let mut of = self.lock();
        let own = of.entry(number).or_default();
        *own = own.saturating_add(turns);
        if *own == 0 {
            of.remove(&number);
        }
        self.any.store(true, Relaxed);
    }

    /// Adds others.
    pub fn merge(&self, others: &Self) {
        for (number, turns) in others.all() {
            self.note(number, turns);
        }
    }

    /// All of them, by the numbers of their sums.
    pub fn all(&self) -> Vec<(u64, i64)> {
        if !self.any.load(Relaxed) {
            return Vec::new();
        }
        self.lock().iter().map(|(number, turns)| (*number, *turns)).collect()
    }

    /// What was written by [`Turns::all`], of so many sums.
    ///
    /// # Errors
    /// What that cannot have written.
    pub fn restore(&mut self, all: Vec<(u64, i64)>, sums: u64) -> Result<(), FilmError> {
        let ordered = all.windows(2).all(|pair| pair[0].0 < pair[1].0);
        let sound =
            |(number, turns): &(u64, i64)| *number < sums && (1..MOST).contains(&turns.unsigned_abs());
        if !ordered || !all.iter().all(sound) {
            return Err(FilmError::Layout("the film file's largest sums make no sense".to_owned()));
        }
        *self = Self { any: AtomicBool::new(!all.is_empty()), of: Mutex::new(all.into_iter().collect()) };
        Ok(())
    }

    /// The sum of that number, or the end of what 64 bits hold.
    #[inline]
    pub fn shown(&self, number: u64, sum: i64) -> i64 {
        if !self.any.load(Relaxed) {
            return sum;
        }
        match self.lock().get(&number) {
            None => sum,
            Some(turns) if *turns < 0 => i64::MIN,
            Some(_) => i64::MAX,
        }
    }

    /// A thread that panics here leaves whole numbers behind.
    fn lock(&self) -> MutexGuard<'_, BTreeMap<u64, i64>> {
        self.of.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
