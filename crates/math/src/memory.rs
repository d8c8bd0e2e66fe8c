//! How much memory there is, and whether something fits into it.
//!
//! Asking the system for memory does not tell: it promises more than it has, and ends the program when that is used.
//! So whatever may be large is compared with what is left before it is allocated.

use std::fmt;

/// Memory that may be taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MemoryLimit {
    /// What the machine has left when something is checked: see [`available`].
    #[default]
    Machine,
    /// So many bytes.
    Bytes(u64),
}

/// More memory is needed than there is; both in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemoryShortage {
    /// What is needed.
    pub needed: u64,
    /// What is there.
    pub available: u64,
}

impl MemoryLimit {
    /// Whether so many bytes can be taken.
    ///
    /// # Errors
    /// If there are fewer.
    pub fn check(self, needed: u64) -> Result<(), MemoryShortage> {
        let available = match self {
            Self::Machine => available(),
            Self::Bytes(bytes) => Some(bytes),
        };
        match available {
            Some(available) if needed > available => Err(MemoryShortage { needed, available }),
            _ => Ok(()),
        }
    }
}

impl fmt::Display for MemoryShortage {
    /// "needs 120 MB of memory, and 80 MB are there"
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let megabytes = |bytes: u64| bytes.div_ceil(1_000_000);
        let (needed, available) = (megabytes(self.needed), self.available / 1_000_000);
        write!(f, "needs {needed} MB of memory, and {available} MB are there")
    }
}

impl std::error::Error for MemoryShortage {}

/// The memory that new work can have, in bytes, where the system tells (Linux): what the machine has left, or the
/// container that the program runs in.
pub fn available() -> Option<u64> {
    let read = |path: &str| std::fs::read_to_string(path).ok();
    let machine = in_table(&read("/proc/meminfo")?, "MemAvailable:")?.checked_mul(1024)?;
    let number = |path: &str| read(path)?.trim().parse::<u64>().ok();
    let folder = "/sys/fs/cgroup/memory";
    // The second version of control groups, and the first. Files that the system keeps in memory can be dropped.
    let container = || {
        let (most, used) = (number(&format!("{folder}.max"))?, number(&format!("{folder}.current"))?);
        let files = in_table(&read(&format!("{folder}.stat"))?, "inactive_file ").unwrap_or(0);
        Some(most.saturating_sub(used.saturating_sub(files)))
    };
    let older = || {
        let most = number(&format!("{folder}/memory.limit_in_bytes"))?;
        let used = number(&format!("{folder}/memory.usage_in_bytes"))?;
        let files = in_table(&read(&format!("{folder}/memory.stat"))?, "total_inactive_file ").unwrap_or(0);
        Some(most.saturating_sub(used.saturating_sub(files)))
    };
    Some(container().or_else(older).map_or(machine, |c| c.min(machine)))
}

/// The number after a word at the beginning of a line.
fn in_table(table: &str, word: &str) -> Option<u64> {
    let rest = table.lines().find_map(|line| line.strip_prefix(word))?;
    rest.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_told_with_both_figures() {
        let limit = MemoryLimit::Bytes(80_999_999);
        assert!(limit.check(80_999_999).is_ok());
        let shortage = limit.check(119_000_001).unwrap_err();
        assert_eq!(shortage.to_string(), "needs 120 MB of memory, and 80 MB are there");
    }

    #[test]
    fn the_machine_has_some_but_not_all() {
        assert!(MemoryLimit::Machine.check(1).is_ok());
        if available().is_some() {
            assert!(MemoryLimit::Machine.check(u64::MAX).is_err());
        }
    }

    #[test]
    fn tables_are_read_by_line() {
        let table = "MemTotal:  7 kB\nMemAvailable:   1234 kB\n";
        assert_eq!(in_table(table, "MemAvailable:"), Some(1234));
        assert_eq!(in_table(table, "Swap:"), None);
    }
}
