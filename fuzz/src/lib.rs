//! Joins the targets of `caustica-fuzzing` with libFuzzer.

use caustica_fuzzing::{Dice, Target};
pub use libfuzzer_sys;

/// Changes an input: half of the time as the format suggests, otherwise as libFuzzer does.
pub fn mutate(target: &Target, data: &mut [u8], size: usize, (most, seed): (usize, u32)) -> usize {
    let mut dice = Dice::new(seed.into());
    if dice.once_in(2) {
        return libfuzzer_sys::fuzzer_mutate(data, size, most);
    }
    let mut input = data[..size].to_vec();
    (target.mutate)(&mut input, &mut dice);
    let length = input.len().min(most);
    data[..length].copy_from_slice(&input[..length]);
    length
}

/// Lets panics pass that a reader catches: decoders of other people may panic. libFuzzer's own hook would end the
/// process; what nobody catches still does.
pub fn forgive_caught_panics() {
    std::panic::set_hook(Box::new(|info| eprintln!("{info}")));
}

/// The target of that name as a libFuzzer program.
#[macro_export]
macro_rules! target {
    ($name:literal) => {
        use std::sync::LazyLock;

        use $crate::libfuzzer_sys::{fuzz_mutator, fuzz_target};

        static TARGET: LazyLock<&caustica_fuzzing::Target> =
            LazyLock::new(|| caustica_fuzzing::target($name));

        fuzz_target!(
            init: $crate::forgive_caught_panics(),
            |data: &[u8]| (TARGET.run)(data)
        );

        fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
            $crate::mutate(&TARGET, data, size, (max_size, seed))
        });
    };
}
