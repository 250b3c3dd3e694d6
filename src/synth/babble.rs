//! Sounds like speech.

use serde::{Deserialize, Serialize};

use super::decibels;
use super::scene::within;
use super::sound::rms;
use crate::Error;
use crate::random::SplitMix64;
use crate::units::{real, samples_in};

/// Words of four to nine voiced syllables that quicken and fade by a ratio, each with a hard onset: speech with the timing of
/// a dead ball.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Words {
    /// rms of the loudest syllable of a word in dB of full scale.
    pub level_db: f64,
    /// Pause from the end of a word to the start of the next, in seconds.
    pub every_s: f64,
}

impl Words {
    pub(super) fn check(self) -> Result<(), Error> {
        within("level_db", self.level_db, -200.0..=40.0, "-200 to 40")?;
        within("every_s", self.every_s, 1e-2..=1e3, "10 ms or more")
    }
}

/// The sound of a syllable.
#[derive(Debug, Clone, Copy)]
struct Manner {
    voiced: bool,
    /// Share of its time in which it swells; it fades over the rest.
    attack_share: f64,
    /// Amplitude of the hiss at its onset, as of a t or a k; a pulse of the voice is 1.
    burst: f64,
}

/// Shortest interval between syllables of a word, in seconds.
const SHORTEST_SYLLABLE_S: f64 = 0.04;

/// Decay of that hiss to 1/e, in seconds.
const BURST_S: f64 = 3e-3;

/// Adds words. Intervals begin with 0.15 to 0.5 s and shrink by 0.6 to 0.95 with 2 % of scatter; levels fall as they do.
pub(super) fn add_words(words: Words, rate: f64, rng: &mut SplitMix64, samples: &mut [f64]) {
    let manner = Manner {
        voiced: true,
        attack_share: 0.02,
        burst: 0.5,
    };
    let mut start = samples_in(words.every_s * rng.uniform(), rate);
    while start < samples.len() {
        let syllables = samples_in(4.0 + 6.0 * rng.uniform(), 1.0).min(9);
        let ratio = 0.6 + 0.35 * rng.uniform();
        let mut interval_s = 0.15 + 0.35 * rng.uniform();
        let mut level = decibels(words.level_db);
        for _ in 0..syllables {
            let count = samples_in(0.9 * interval_s, rate);
            let end = (start + count).min(samples.len());
            if start >= end {
                break;
            }
            let syllable = syllable(end - start, rate, manner, rng);
            add_at_level(level, &syllable, &mut samples[start..end]);
            start += samples_in(interval_s, rate);
            interval_s = (interval_s * ratio * rng.factor(0.02)).max(SHORTEST_SYLLABLE_S);
            level *= ratio * rng.factor(0.2);
        }
        start += samples_in(words.every_s, rate);
    }
}

/// Adds a sound whose rms is a level.
fn add_at_level(level: f64, sound: &[f64], samples: &mut [f64]) {
    let loudness = rms(sound);
    let gain = if loudness > 0.0 {
        level / loudness
    } else {
        0.0
    };
    for (x, y) in samples.iter_mut().zip(sound) {
        *x += gain * y;
    }
}

/// Speech-like bursts: syllables of 80 to 300 ms, two thirds of them voiced at a gliding pitch of 90 to 220 Hz, the
/// others hissed, each through three formants of its own, with pauses in between.
pub(super) fn add(level: f64, rate: f64, rng: &mut SplitMix64, samples: &mut [f64]) {
    let mut start = 0;
    while start < samples.len() {
        let length = samples_in(0.08 + 0.22 * rng.uniform(), rate);
        let end = (start + length).min(samples.len());
        let manner = Manner {
            voiced: rng.uniform() < 0.67,
            attack_share: 0.1,
            burst: 0.0,
        };
        let syllable = syllable(end - start, rate, manner, rng);
        add_at_level(level, &syllable, &mut samples[start..end]);
        start = end + samples_in(0.02 + 0.15 * rng.uniform() * rng.uniform(), rate);
    }
}

fn syllable(count: usize, rate: f64, manner: Manner, rng: &mut SplitMix64) -> Vec<f64> {
    let (pitch_hz, glide) = (90.0 + 130.0 * rng.uniform(), 0.4 * rng.uniform() - 0.2);
    let formants = [
        250.0 + 500.0 * rng.uniform(),
        900.0 + 1_300.0 * rng.uniform(),
        2_300.0 + 900.0 * rng.uniform(),
    ];
    let mut phase = 0.0;
    let mut source: Vec<f64> = (0..count)
        .map(|i| {
            let share = real(i) / real(count);
            phase += pitch_hz * (1.0 + glide * share) / rate;
            let pulse = if phase >= 1.0 { 1.0 } else { 0.0 };
            phase -= pulse;
            let excitation = if manner.voiced {
                pulse + 0.01 * rng.normal()
            } else {
                0.2 * rng.normal()
            };
            let swell = (share / manner.attack_share).min(1.0)
                * libm::cos(0.5 * std::f64::consts::PI * share);
            excitation * swell
        })
        .collect();
    if manner.burst > 0.0 {
        for (x, i) in source.iter_mut().zip(0_u32..) {
            let faded = libm::exp(-f64::from(i) / (BURST_S * rate));
            *x += manner.burst * faded * rng.normal();
        }
    }
    for hz in formants.into_iter().filter(|hz| *hz < 0.45 * rate) {
        resonate(&mut source, hz, 90.0, rate);
    }
    source
}

/// A two-pole resonance added to what comes in.
fn resonate(samples: &mut [f64], frequency_hz: f64, width_hz: f64, rate: f64) {
    let radius = libm::exp(-std::f64::consts::PI * width_hz / rate);
    let (a, b) = (
        2.0 * radius * libm::cos(std::f64::consts::TAU * frequency_hz / rate),
        -radius * radius,
    );
    let (mut y1, mut y2) = (0.0, 0.0);
    for x in samples {
        let y = *x + a * y1 + b * y2;
        (y2, y1) = (y1, y);
        *x = y;
    }
}
