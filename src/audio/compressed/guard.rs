//! A wall against mistakes of the readers and decoders.

use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs what is not ours; none if it panicked.
///
/// symphonia counts with numbers of the file in a few places, and then asserts what need not hold: a damaged MP4 can make
/// it panic (`fixtures/crashes/compressed`). What did so must not be asked again. The command keeps quiet about it; another
/// program that uses the library prints what its own panic hook prints.
pub(super) fn guarded<T>(work: impl FnOnce() -> T) -> Option<T> {
    catch_unwind(AssertUnwindSafe(work)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_nothing() {
        assert_eq!(guarded(|| 1), Some(1));
        assert_eq!(guarded(|| -> u8 { panic!("overflow") }), None);
    }
}
