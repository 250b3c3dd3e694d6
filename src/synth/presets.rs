//! The scenes that come with the program: the files of `assets/scenes`, by name.

use super::scene::Scene;
use crate::Error;

macro_rules! scenes {
    ($(#[$about:meta])* $suite:ident: $($name:literal),* $(,)?) => {
        $(#[$about])*
        const $suite: &[(&str, &str)] = &[
            $(($name, include_str!(concat!("../../assets/scenes/", $name, ".toml")))),*
        ];
    };
}

scenes!(
    /// Name and text of each scene of the suite: drops first, then recordings that hold none.
    SUITE:
    "steel",
    "pingpong",
    "rubber",
    "dead",
    "superball",
    "paper",
    "tennis",
    "golf",
    "marble",
    "basketball",
    "squash",
    "stone",
    "loud-echo",
    "hall",
    "plate",
    "uneven",
    "knocks",
    "stereo",
    "phone",
    "clipped",
    "hum",
    "low-rate",
    "eight-bit",
    "high-rate",
    "late-start",
    "early-stop",
    "three-drops",
    "two-balls",
    "speech",
    "noisy",
    "footsteps",
    "rolling",
    "far",
    "caught",
    "silence",
    "noise",
    "tone",
    "babble",
    "rapping",
    "walking",
    "metronome",
    "rumble",
);

scenes!(
    /// Name and text of each scene of the second suite: drops that are hard to find or to follow, then sounds taken for one.
    FOUND:
    "odd-bounce",
    "odd-twice",
    "other-surface",
    "splice",
    "drop-out",
    "scatter-5",
    "scatter-8",
    "by-turns",
    "eight-of-steel",
    "liveliest",
    "first-sample",
    "ten-metres",
    "two-impacts",
    "three-impacts",
    "copies",
    "knocked-before",
    "match",
    "words-and-tennis",
    "unlike",
    "half-alike",
    "no-two-alike",
    "thuds",
    "wandering",
    "thumps",
    "words",
    "quick-taps",
    "slow-taps",
    "two-clocks",
    "applause",
);

/// Names of the scenes of the suite: those with drops first, then those that hold none.
pub fn names() -> impl Iterator<Item = &'static str> {
    SUITE.iter().map(|(name, _)| *name)
}

/// Names of the scenes of the second suite: odd, short, lively or disturbed drops, then recordings that hold none.
pub fn found_names() -> impl Iterator<Item = &'static str> {
    FOUND.iter().map(|(name, _)| *name)
}

/// Seed of the recording of this number of a scene in a suite, by the scene's name (FNV-1a of 32 bits in the low half; exact in JSON):
/// scenes made with one seed share the luck of their bounces, and are one sample of it however many they are.
#[must_use]
pub fn seed(name: &str, number: u64) -> u64 {
    let hash = name.bytes().fold(0x811c_9dc5_u32, |hash, byte| {
        (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
    });
    number.wrapping_shl(32) | u64::from(hash)
}

/// The scene of this name.
///
/// # Errors
/// [`Error::Argument`] if there is none, with the way to those that there are.
pub fn preset(name: &str) -> Result<Scene, Error> {
    let found = SUITE.iter().chain(FOUND).find(|(known, _)| *known == name);
    let (_, text) = found.ok_or_else(|| Error::Argument {
        argument: "--preset",
        got: format!("'{name}'"),
        expected: "a name that synth --list gives (steel, pingpong, rubber, …)",
    })?;
    Scene::from_toml(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_is_read_and_bears_the_name_of_its_file() {
        for name in names().chain(found_names()) {
            let scene = preset(name).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert_eq!(scene.name, name);
            assert!(scene.about.len() > 15, "{name} says nothing about itself");
        }
    }

    #[test]
    fn each_scene_of_a_suite_has_seeds_of_its_own() {
        // FNV-1a of "a" is 0xe40c292c by its authors' table.
        assert_eq!(seed("a", 2), 0x2_e40c_292c);
        let all = names().chain(found_names());
        let mut seeds: Vec<u64> = all.flat_map(|n| [1, 2].map(|k| seed(n, k))).collect();
        let count = seeds.len();
        seeds.sort_unstable();
        seeds.dedup();
        assert_eq!(seeds.len(), count);
    }

    #[test]
    fn a_name_is_that_of_one_scene() {
        let mut all: Vec<&str> = names().chain(found_names()).collect();
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count);
    }

    #[test]
    fn the_suite_has_24_families_of_drops_and_more_than_4_without() {
        let (with, without): (Vec<&str>, Vec<&str>) =
            names().partition(|name| !preset(name).unwrap().drops.is_empty());
        assert!(
            with.len() >= 24 && without.len() > 4,
            "{with:?} {without:?}"
        );
    }
}
