//! Knocks and steps: impacts that are no bounces.

use serde::{Deserialize, Serialize};

use super::scene::{Mode, within};
use super::sound::Sound;
use super::{decibels, followed_s, instant_s};
use crate::Error;
use crate::random::SplitMix64;

/// Knocks at random times, each with a sound of its own.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Knocks {
    /// How many a second, on average.
    pub per_s: f64,
    /// Peak of the loudest in dB of full scale; the others are up to 12 dB below it.
    pub level_db: f64,
}

/// Sounds at regular times: steps, or the ticks of a clock.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Steps {
    /// Seconds from one to the next.
    pub every_s: f64,
    /// Standard deviation of that, in seconds.
    pub jitter_s: f64,
    /// Peak in dB of full scale.
    pub level_db: f64,
    /// What rings, in Hz: 100 for a step, 3,000 for a tick.
    pub frequency_hz: f64,
    /// How long, in seconds to 1/e.
    pub decay_s: f64,
}

impl Knocks {
    pub(super) fn check(&self) -> Result<(), Error> {
        within("per_s", self.per_s, 0.0..=1e3, "0 to 1000")?;
        within("level_db", self.level_db, -200.0..=40.0, "-200 to 40")
    }
}

impl Steps {
    pub(super) fn check(&self) -> Result<(), Error> {
        within("every_s", self.every_s, 1e-2..=1e3, "10 ms or more")?;
        within(
            "jitter_s",
            self.jitter_s,
            0.0..=self.every_s,
            "0 to every_s",
        )?;
        within("level_db", self.level_db, -200.0..=40.0, "-200 to 40")?;
        within("frequency_hz", self.frequency_hz, 1.0..=1e6, "1 Hz or more")?;
        within("decay_s", self.decay_s, 1e-6..=10.0, "1 us to 10 s")
    }
}

/// Adds knocks: waiting times are exponential, pitch is 150 Hz to 4 kHz.
pub(super) fn add_knocks(knocks: Knocks, rate: f64, rng: &mut SplitMix64, samples: &mut [f64]) {
    let end_s = instant_s(samples.len(), rate);
    let mut at_s = 0.0;
    loop {
        // Without any knocks the first would come after infinite time.
        at_s -= libm::log(rng.uniform()) / knocks.per_s;
        if at_s >= end_s {
            return;
        }
        let lowest_hz = 150.0 * libm::pow(2.0, 3.7 * rng.uniform());
        let modes = [1.0, 1.83, 3.1].map(|overtone| Mode {
            frequency_hz: lowest_hz * overtone,
            decay_s: 2e-3 + 8e-3 * rng.uniform(),
            level: 0.3 + 0.7 * rng.uniform(),
        });
        let level_db = knocks.level_db - 12.0 * rng.uniform();
        let contact_s = 0.3e-3 + 1.2e-3 * rng.uniform();
        add_burst(&modes, contact_s, at_s, level_db, rate, samples);
    }
}

/// Adds steps, alternately of two feet: every other is 2 dB quieter and a fifth lower.
pub(super) fn add_steps(steps: Steps, rate: f64, rng: &mut SplitMix64, samples: &mut [f64]) {
    let end_s = instant_s(samples.len(), rate);
    let mut at_s = steps.every_s * rng.uniform();
    let mut left = false;
    while at_s < end_s {
        let (pitch, level_db) = if left { (0.8, -2.0) } else { (1.0, 0.0) };
        let modes = [(1.0, 1.0), (2.7, 0.4)].map(|(overtone, level)| Mode {
            frequency_hz: pitch * overtone * steps.frequency_hz,
            decay_s: steps.decay_s / overtone,
            level: level * libm::exp(0.1 * rng.normal()),
        });
        let contact_s = 0.3 / steps.frequency_hz;
        let level_db = steps.level_db + level_db;
        add_burst(&modes, contact_s, at_s, level_db, rate, samples);
        // Steps keep their order however much they jitter.
        at_s += (steps.every_s + steps.jitter_s * rng.normal()).max(0.2 * steps.every_s);
        left = !left;
    }
}

/// Adds a sound whose peak has a level.
pub(super) fn add_burst(
    modes: &[Mode],
    contact_s: f64,
    at_s: f64,
    level_db: f64,
    rate: f64,
    samples: &mut [f64],
) {
    let sound = Sound::new(modes, contact_s).at_most(followed_s(samples.len(), rate));
    let burst = sound.render(rate, at_s, 1.0);
    let peak = burst.peak();
    if peak > 0.0 {
        burst.add_to(samples, 0, decibels(level_db) / peak);
    }
}
