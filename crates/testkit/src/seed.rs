//! Seeds of statistical tests: fixed, so that a test that passes keeps passing, unless fresh ones are asked for.

use std::sync::LazyLock;

use caustica_math::stream::mix64;

/// The environment variable that gives all statistical tests other seeds.
pub const VARIABLE: &str = "CAUSTICA_SEED";

/// The seed `fixed`, or another that depends on it and on the whole number in `CAUSTICA_SEED`. A test of level α
/// then fails once in 1/α seeds.
///
/// # Panics
/// If the variable is set and is no whole number.
pub fn seed(fixed: u64) -> u64 {
    static FRESH: LazyLock<Option<u64>> = LazyLock::new(|| {
        let text = std::env::var(VARIABLE).ok()?;
        Some(text.parse().unwrap_or_else(|_| panic!("{VARIABLE} must be a whole number, not `{text}`")))
    });
    mixed(fixed, *FRESH)
}

/// 32 bits, to which tests may add small numbers.
fn mixed(fixed: u64, fresh: Option<u64>) -> u64 {
    fresh.map_or(fixed, |fresh| mix64(mix64(fresh) ^ fixed) >> 32)
}

#[cfg(test)]
mod tests {
    use super::mixed;

    #[test]
    fn fresh_seeds_depend_on_both_numbers() {
        assert_eq!(mixed(7, None), 7);
        let seeds = [mixed(7, Some(0)), mixed(7, Some(1)), mixed(8, Some(0)), mixed(8, Some(1)), 7, 8];
        for (i, a) in seeds.iter().enumerate() {
            assert!(!seeds[..i].contains(a), "{seeds:?}");
        }
    }
}
