//! A wall against mistakes of the readers and decoders.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Whether a panic of this thread would be caught and told as damage of the file: a panic hook may keep quiet about it.
#[must_use]
pub fn is_guarded() -> bool {
    GUARDED.get()
}

/// Runs what is not ours; none if it panicked.
///
/// symphonia counts with numbers of the file in a few places, and then asserts what need not hold: a damaged MP4 can make
/// it panic (`fixtures/crashes/compressed`). What did so must not be asked again. The command keeps quiet about it; another
/// program that uses the library prints what its own panic hook prints.
pub(super) fn guarded<T>(work: impl FnOnce() -> T) -> Option<T> {
    let outside = GUARDED.replace(true);
    let done = catch_unwind(AssertUnwindSafe(work)).ok();
    GUARDED.set(outside);
    done
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hook_is_told_what_will_be_caught() {
        assert_eq!(guarded(is_guarded), Some(true));
        assert_eq!(guarded(|| -> u8 { panic!("overflow") }), None);
        assert!(!is_guarded());
    }

    #[test]
    fn a_panic_is_nothing() {
        assert_eq!(guarded(|| 1), Some(1));
        assert_eq!(guarded(|| -> u8 { panic!("overflow") }), None);
    }
}
