//! Where recordings come from: files, or scenes of the program.

use std::path::PathBuf;

use bounce_audio::audio::read_file;
use bounce_audio::synth::render;
use bounce_audio::synth::scene::preset;

use super::recording::Recording;
use super::sources::name;

/// Scenes of all kinds of ball, surface, room and recorder; each is made with seed 1.
const SCENES: [&str; 23] = [
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
    "stereo",
    "phone",
    "hum",
    "noisy",
    "unlike",
    "half-alike",
    "thuds",
    "wandering",
];

/// A recording by what it is made from.
#[derive(Debug)]
pub(crate) enum Source {
    File(PathBuf),
    Scene(&'static str),
}

/// The scenes that are listened to where no file is named.
pub(crate) fn scenes() -> impl Iterator<Item = Source> {
    SCENES.into_iter().map(Source::Scene)
}

impl Source {
    pub(crate) fn name(&self) -> String {
        match self {
            Self::File(path) => name(path),
            Self::Scene(scene) => (*scene).to_owned(),
        }
    }

    pub(crate) fn recording(&self) -> Recording {
        match self {
            Self::File(path) => {
                let read = read_file(path).unwrap();
                Recording {
                    channels: read.channels,
                    rate: f64::from(read.sample_rate_hz),
                }
            }
            Self::Scene(name) => {
                let made = render(&preset(name).unwrap(), 1).unwrap();
                let first = std::iter::once(made.samples);
                Recording {
                    channels: first.chain(made.more_channels).collect(),
                    rate: f64::from(made.truth.sample_rate_hz),
                }
            }
        }
    }
}
