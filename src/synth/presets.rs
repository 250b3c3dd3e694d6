//! The scenes that come with the program: the files of `assets/scenes`, by name.

use super::scene::Scene;
use crate::Error;

macro_rules! scenes {
    ($($name:literal),* $(,)?) => {
        /// Name and text of each scene.
        const SCENES: &[(&str, &str)] = &[
            $(($name, include_str!(concat!("../../assets/scenes/", $name, ".toml")))),*
        ];
    };
}

// Drops first, then recordings that hold none.
scenes!(
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

/// Names of the presets: those with drops first, then those that hold none.
pub fn names() -> impl Iterator<Item = &'static str> {
    SCENES.iter().map(|(name, _)| *name)
}

/// The scene of this name.
///
/// # Errors
/// [`Error::Argument`] if there is none, with the way to those that there are.
pub fn preset(name: &str) -> Result<Scene, Error> {
    let found = SCENES.iter().find(|(known, _)| *known == name);
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
        for name in names() {
            let scene = preset(name).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert_eq!(scene.name, name);
            assert!(scene.about.len() > 15, "{name} says nothing about itself");
        }
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
