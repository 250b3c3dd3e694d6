//! What the room adds to an impact: early reflections and a diffuse tail.

use serde::{Deserialize, Serialize};

use super::decibels;
use super::place::Reflection;
use super::scene::within;
use super::sound::{Rendered, Sound};
use crate::Error;
use crate::random::SplitMix64;
use crate::units::{real, samples_in};

/// A reflection.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Echo {
    /// Seconds after the direct sound.
    pub delay_s: f64,
    /// dB relative to the direct sound.
    pub level_db: f64,
}

/// Reverberation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tail {
    /// Seconds after the direct sound at which it begins.
    pub start_s: f64,
    /// Time in which it falls by 60 dB, in seconds.
    pub decay60_s: f64,
    /// Energy of the whole tail in dB relative to the direct sound.
    pub level_db: f64,
}

/// Reflections a second. From 1,500 on, random clicks of either sign sound like smooth noise (Karjalainen and
/// Järveläinen, "Reverberation modeling using velvet noise", AES 30th Conf. 2007).
const DENSITY_PER_S: f64 = 1_500.0;
/// The share of an impact's energy that is reflected diffusely: what is left out is 40 dB below its own tail.
const REFLECTED_SHARE: f64 = 0.9999;

impl Echo {
    pub(super) fn check(&self) -> Result<(), Error> {
        within("delay_s", self.delay_s, 0.0..=10.0, "0 to 10 s")?;
        within("level_db", self.level_db, -200.0..=20.0, "-200 to 20")
    }
}

impl Tail {
    pub(super) fn check(&self) -> Result<(), Error> {
        within("start_s", self.start_s, 0.0..=10.0, "0 to 10 s")?;
        within("decay60_s", self.decay60_s, 1e-3..=20.0, "1 ms to 20 s")?;
        within("level_db", self.level_db, -200.0..=20.0, "-200 to 20")
    }
}

/// An impact as a microphone hears it first.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arrival<'a> {
    pub(super) sound: &'a Sound,
    pub(super) direct: &'a Rendered,
    pub(super) onset_s: f64,
    pub(super) gain: f64,
}

/// A room: the same for all impacts of a recording, but for what its walls send back.
#[derive(Debug, Clone)]
pub(super) struct Room<'a> {
    echoes: &'a [Echo],
    /// Delay in samples and gain of each diffuse reflection.
    taps: Vec<(usize, f64)>,
}

impl<'a> Room<'a> {
    pub(super) fn new(
        echoes: &'a [Echo],
        tail: Option<Tail>,
        rate: f64,
        mut rng: SplitMix64,
    ) -> Self {
        Self {
            echoes,
            taps: tail.map_or_else(Vec::new, |tail| taps(tail, rate, &mut rng)),
        }
    }

    /// Adds what comes back of an impact, by way of the walls too. Early reflections are evaluated at their own instants,
    /// diffuse ones fall on whole samples after the direct sound.
    pub(super) fn add(
        &self,
        arrival: Arrival<'_>,
        of_walls: impl Iterator<Item = Reflection>,
        rate: f64,
        samples: &mut [f64],
    ) {
        let Arrival { onset_s, gain, .. } = arrival;
        let echoes = self.echoes.iter().map(|echo| Reflection {
            later_s: echo.delay_s,
            level: decibels(echo.level_db),
        });
        for early in echoes.chain(of_walls) {
            arrival
                .sound
                .render(rate, onset_s + early.later_s, gain * early.level)
                .add_to(samples, 0, 1.0);
        }
        let held = arrival.direct.samples_holding(REFLECTED_SHARE);
        for &(delay, level) in &self.taps {
            arrival.direct.add_start_to(held, samples, delay, level);
        }
    }
}

/// One reflection in each cell of 1/density, at a random place in it and of random sign, under an exponential.
fn taps(tail: Tail, rate: f64, rng: &mut SplitMix64) -> Vec<(usize, f64)> {
    let cell_s = 1.0 / DENSITY_PER_S;
    let cells = samples_in(tail.decay60_s, DENSITY_PER_S).max(1);
    let mut taps: Vec<(usize, f64)> = (0..cells)
        .map(|cell| {
            let t_s = (real(cell) + rng.uniform()) * cell_s;
            let sign = if rng.uniform() < 0.5 { -1.0 } else { 1.0 };
            // 60 dB are a factor of 10^−3.
            let level = sign * libm::pow(10.0, -3.0 * t_s / tail.decay60_s);
            (samples_in(tail.start_s + t_s, rate), level)
        })
        .collect();
    let energy: f64 = taps.iter().map(|(_, a)| a * a).sum();
    let gain = decibels(tail.level_db) / libm::sqrt(energy);
    for (_, level) in &mut taps {
        *level *= gain;
    }
    taps
}

/// Seconds by which a sound arrives later over this distance: at 20 °C it travels 343 m/s.
pub(super) fn travel_s(distance_m: f64) -> f64 {
    distance_m / 343.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synth::instant_s;

    #[test]
    fn the_tail_has_its_energy_and_its_decay() {
        let tail = Tail {
            start_s: 0.01,
            decay60_s: 0.4,
            level_db: -6.0,
        };
        let taps = taps(tail, 48_000.0, &mut SplitMix64::new(3));
        let energy_after = |t: f64| -> f64 {
            let late = taps.iter().filter(|(d, _)| instant_s(*d, 48_000.0) >= t);
            late.map(|(_, a)| a * a).sum()
        };
        assert!((10.0 * energy_after(0.0).log10() + 6.0).abs() < 1e-9);
        // A fifth of the decay time is 12 dB.
        let fall = 10.0 * (energy_after(0.09) / energy_after(0.0)).log10();
        assert!((fall + 12.0).abs() < 0.3, "{fall}");
    }
}
