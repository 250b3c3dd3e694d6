//! Rows of like sounds without a bouncing ball: taps, claps, keys, a clock, the hits of a game.

use serde::{Deserialize, Serialize};

use super::bursts::add_burst;
use super::instant_s;
use super::scene::{Mode, within};
use crate::Error;
use crate::random::SplitMix64;
use crate::units::real;

/// A row of sounds, at intervals that stay equal, shrink, grow or are irregular.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Taps {
    /// Time of the first sound in seconds from the start of the recording.
    pub first_s: f64,
    /// Number of sounds.
    pub count: usize,
    /// Interval from the first to the second, in seconds.
    pub interval_s: f64,
    /// Ratio of each interval to the one before; below 1 the row quickens. Default 1.
    #[serde(default = "one")]
    pub interval_factor: f64,
    /// Standard deviation of ln interval. Default 0.
    #[serde(default)]
    pub interval_scatter: f64,
    /// Peak of the first in dB of full scale.
    pub level_db: f64,
    /// Change of level from one sound to the next, in dB. Default 0.
    #[serde(default)]
    pub level_step_db: f64,
    /// Standard deviation of the level, in dB. Default 0.
    #[serde(default)]
    pub level_scatter_db: f64,
    /// Contact time of each, in seconds.
    pub contact_time_s: f64,
    /// Modes that ring.
    pub modes: Vec<Mode>,
    /// Standard deviation of ln level of each mode from one to the next. Default 0.
    #[serde(default)]
    pub level_scatter: f64,
    /// Standard deviation of ln frequency of each mode from one to the next. Default 0.
    #[serde(default)]
    pub frequency_scatter: f64,
}

/// Shortest interval in seconds.
const SHORTEST_S: f64 = 1e-3;

const fn one() -> f64 {
    1.0
}

impl Taps {
    pub(super) fn check(&self) -> Result<(), Error> {
        within("first_s", self.first_s, 0.0..=86_400.0, "0 to a day")?;
        within("count", real(self.count), 0.0..=1e5, "0 to 100000")?;
        within(
            "interval_s",
            self.interval_s,
            SHORTEST_S..=1e4,
            "1 ms or more",
        )?;
        within(
            "interval_factor",
            self.interval_factor,
            0.1..=10.0,
            "0.1 to 10",
        )?;
        within(
            "interval_scatter",
            self.interval_scatter,
            0.0..=3.0,
            "0 to 3",
        )?;
        within("level_db", self.level_db, -200.0..=40.0, "-200 to 40")?;
        within(
            "level_step_db",
            self.level_step_db,
            -40.0..=40.0,
            "-40 to 40",
        )?;
        within(
            "level_scatter_db",
            self.level_scatter_db,
            0.0..=40.0,
            "0 to 40",
        )?;
        within(
            "contact_time_s",
            self.contact_time_s,
            1e-6..=1.0,
            "1 us to 1 s",
        )?;
        within("level_scatter", self.level_scatter, 0.0..=3.0, "0 to 3")?;
        within(
            "frequency_scatter",
            self.frequency_scatter,
            0.0..=1.0,
            "0 to 1",
        )?;
        self.modes.iter().try_for_each(Mode::check)
    }

    /// Adds the row to samples, as far as these go.
    pub(super) fn add(&self, rate: f64, rng: &mut SplitMix64, samples: &mut [f64]) {
        let end_s = instant_s(samples.len(), rate);
        let (mut at_s, mut interval_s) = (self.first_s, self.interval_s);
        for number in 0..self.count {
            if at_s >= end_s {
                return;
            }
            let modes = self.modes.iter().map(|mode| Mode {
                frequency_hz: mode.frequency_hz * rng.factor(self.frequency_scatter),
                level: mode.level * rng.factor(self.level_scatter),
                ..*mode
            });
            let modes: Vec<Mode> = modes.collect();
            let off_db = real(number) * self.level_step_db + self.level_scatter_db * rng.normal();
            let level_db = self.level_db + off_db;
            add_burst(&modes, self.contact_time_s, at_s, level_db, rate, samples);
            at_s += (interval_s * rng.factor(self.interval_scatter)).max(SHORTEST_S);
            interval_s *= self.interval_factor;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::samples_in;

    #[test]
    fn taps_come_faster_and_louder_by_their_factors() {
        let taps = Taps {
            first_s: 0.1,
            count: 4,
            interval_s: 0.2,
            interval_factor: 0.5,
            interval_scatter: 0.0,
            level_db: -30.0,
            level_step_db: 6.0,
            level_scatter_db: 0.0,
            contact_time_s: 1e-3,
            modes: vec![Mode {
                frequency_hz: 2_000.0,
                decay_s: 2e-3,
                level: 1.0,
            }],
            level_scatter: 0.0,
            frequency_scatter: 0.0,
        };
        let (rate, mut samples) = (8_000.0, vec![0.0; 8_000]);
        taps.add(rate, &mut SplitMix64::new(1), &mut samples);
        for (at_s, level_db) in [(0.1, -30.0), (0.3, -24.0), (0.4, -18.0), (0.45, -12.0)] {
            let at = samples_in(at_s, rate);
            assert!(samples[at - 30..=at].iter().all(|x| x.abs() < 1e-3));
            let peak = samples[at..at + 40]
                .iter()
                .fold(0.0, |m: f64, x| m.max(x.abs()));
            assert!(
                (20.0 * peak.log10() - level_db).abs() < 0.1,
                "{at_s}: {peak}"
            );
        }
        assert!(
            samples[samples_in(0.55, rate)..]
                .iter()
                .all(|x| x.abs() < 1e-6)
        );
    }
}
