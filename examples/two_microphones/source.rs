//! Where recordings of two channels come from: files, or scenes with known delays.

use std::path::PathBuf;

use bounce_audio::audio::read_file;
use bounce_audio::synth::render;
use bounce_audio::synth::scene::{Scene, preset};

use super::sources::name;

/// Seeds of each scene.
const SEEDS: u64 = 3;
/// How unlike each other the impacts of the ball that wanders are, and each in both channels.
const UNLIKE: [f64; 4] = [0.0, 0.3, 0.6, 1.0];

/// A recording by what it is made from.
#[derive(Debug)]
pub(crate) enum Source {
    File(PathBuf),
    Scene(Box<Scene>, u64),
}

/// Two channels of one recording.
#[derive(Debug)]
pub(crate) struct Stereo {
    pub(crate) channels: [Vec<f32>; 2],
    pub(crate) rate: f64,
    /// When impacts are heard in both, as far as that is known.
    pub(crate) onsets_s: Vec<[f64; 2]>,
}

/// The scenes that are listened to where no file is named.
pub(crate) fn scenes() -> impl Iterator<Item = Source> {
    let wandering = UNLIKE.map(|unlike| {
        let mut scene = preset("wandering").unwrap();
        scene.drops[0].unlike = unlike;
        for channel in &mut scene.recorder.channels {
            channel.unlike = unlike;
        }
        scene.name = format!("wandering, unlike {unlike}");
        scene
    });
    let scenes = std::iter::once(preset("stereo").unwrap()).chain(wandering);
    scenes.flat_map(|scene| (1..=SEEDS).map(move |seed| Source::Scene(scene.clone().into(), seed)))
}

impl Source {
    pub(crate) fn name(&self) -> String {
        match self {
            Self::File(path) => name(path),
            Self::Scene(scene, seed) => format!("{}, seed {seed}", scene.name),
        }
    }

    /// Its first two channels.
    pub(crate) fn stereo(&self) -> Stereo {
        match self {
            Self::File(path) => {
                let read = read_file(path).unwrap();
                let mut channels = read.channels.into_iter();
                Stereo {
                    channels: [channels.next().unwrap(), channels.next().unwrap()],
                    rate: f64::from(read.sample_rate_hz),
                    onsets_s: Vec::new(),
                }
            }
            Self::Scene(scene, seed) => {
                let mut made = render(scene, *seed).unwrap();
                let onsets_s = made.truth.drops.iter().flat_map(|drop| {
                    let both = drop.onsets_s.iter().zip(&drop.more_onsets_s[0]);
                    both.map(|(first, second)| [*first, *second])
                });
                Stereo {
                    onsets_s: onsets_s.collect(),
                    channels: [made.samples, made.more_channels.swap_remove(0)],
                    rate: f64::from(made.truth.sample_rate_hz),
                }
            }
        }
    }
}
