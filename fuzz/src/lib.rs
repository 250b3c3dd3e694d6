//! The targets of `tests/fuzz`, for libFuzzer, which looks for new paths where the tests only try at random.

#[path = "../../tests/fuzz/choose.rs"]
mod choose;
#[path = "../../tests/fuzz/targets.rs"]
pub mod targets;

use bounce_audio::random::SplitMix64;
use targets::Target;

/// Runs a target; the random numbers that it needs beside follow from the input.
pub fn run(target: Target, input: &[u8]) {
    let seed = input.iter().fold(0, |seed: u64, &byte| {
        seed.wrapping_mul(0x100_0000_01B3) ^ u64::from(byte)
    });
    (target.run)(input, &mut SplitMix64::new(seed));
}
