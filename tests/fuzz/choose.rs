//! Choices at random.

use bounce_audio::random::SplitMix64;

/// A number below `end`, or 0 where there is none.
pub(crate) fn below(random: &mut SplitMix64, end: usize) -> usize {
    usize::try_from(random.next_u64() % end.max(1) as u64).unwrap_or(0)
}

/// One of several things.
pub(crate) fn one_of<'a, T>(random: &mut SplitMix64, of: &'a [T]) -> &'a T {
    &of[below(random, of.len())]
}
