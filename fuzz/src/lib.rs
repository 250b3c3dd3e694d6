//! The targets of `tests/fuzz`, for libFuzzer, which looks for new paths where the tests only try at random.

#[path = "../../tests/fuzz/choose.rs"]
mod choose;
#[path = "../../tests/fuzz/targets.rs"]
#[allow(dead_code, reason = "libFuzzer changes inputs by itself")]
mod targets;

use bounce_audio::random::SplitMix64;

/// Runs a target by its name. The random numbers that it needs beside follow from the input.
pub fn run(name: &str, input: &[u8]) {
    let seed = input.iter().fold(0, |seed: u64, &byte| {
        seed.wrapping_mul(0x100_0000_01B3) ^ u64::from(byte)
    });
    let target = targets::all().into_iter().find(|t| t.name == name);
    let target = target.expect("the name of a target");
    (target.run)(input, &mut SplitMix64::new(seed));
}

/// The names of the targets, each with valid inputs to begin from.
pub fn seeds() -> Vec<(&'static str, Vec<Vec<u8>>)> {
    let targets = targets::all().into_iter();
    targets.map(|t| (t.name, (t.valid)())).collect()
}
