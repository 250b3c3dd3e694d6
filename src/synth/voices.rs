//! The sounds of the impacts of one drop, and how they differ.

use super::scene::{DropScene, Mode};
use super::sound::Sound;
use crate::random::SplitMix64;

/// Standard deviation of the level of each mode of impacts that are wholly unlike each other, in dB. Measured: octave bands of
/// the first 12 ms of impacts scatter about a smooth fall by 0.5 to 2 dB, 1.5 to 3, 2 to 4, 2 to 4 and 4 to 7 in five recordings
/// of real drops; this is the last one.
const UNLIKE_MODE_DB: f64 = 6.0;
/// The same of whole impacts, in dB. Measured: what the bands have in common scatters by 0.4 to 4.4 dB there.
const UNLIKE_IMPACT_DB: f64 = 3.0;
/// ln of the pressure in 1 dB.
const LN_OF_DB: f64 = std::f64::consts::LN_10 / 20.0;

/// Factor on the level of a mode, and what is added to its phase in radians, of sounds that are unlike each other from 0 to 1.
pub(super) fn unlike(unlike: f64, rng: &mut SplitMix64) -> (f64, f64) {
    let factor = rng.factor(level_scatter(unlike));
    let phase = std::f64::consts::PI * unlike * (2.0 * rng.uniform() - 1.0);
    (factor, phase)
}

/// Standard deviation of ln level of each mode, of sounds that are unlike each other from 0 to 1.
pub(super) fn level_scatter(unlike: f64) -> f64 {
    LN_OF_DB * UNLIKE_MODE_DB * unlike
}

/// What an impact's speed and way say of its loudness and contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Blow {
    pub(super) speed_m_per_s: f64,
    /// That over the speed of the first impact.
    pub(super) of_first: f64,
    /// Factor on the pressure by the way to the microphone.
    pub(super) fading: f64,
    /// Length of the first contact in seconds.
    pub(super) contact_time_s: f64,
}

/// The random numbers by which the impacts of a drop differ, each kind with a stream of its own.
#[derive(Debug)]
pub(super) struct Voices<'a> {
    drop: &'a DropScene,
    lowest_hz: f64,
    loudness: SplitMix64,
    pitches: SplitMix64,
    unlike: SplitMix64,
}

impl<'a> Voices<'a> {
    /// Of a drop with its seed; loudness goes on with a stream that was begun.
    pub(super) fn new(drop: &'a DropScene, seed: u64, loudness: SplitMix64) -> Self {
        let frequencies = drop.modes.iter().map(|m| m.frequency_hz);
        Self {
            drop,
            lowest_hz: frequencies.fold(f64::INFINITY, f64::min),
            loudness,
            pitches: SplitMix64::new(seed.rotate_left(32)),
            unlike: SplitMix64::new(seed.rotate_left(16)),
        }
    }

    /// Standard deviation of ln level of each mode.
    pub(super) fn level_scatter(&self) -> f64 {
        libm::hypot(self.drop.level_scatter, level_scatter(self.drop.unlike))
    }

    /// The sound of the next impact.
    ///
    /// # Formula
    /// ```text
    /// level = level₁·v·fading·exp(loudness + scatter)·(v/v₁)^(treble_loss·log₂(f/f_lowest))
    /// contact = ΔT·(v/v₁)^contact_exponent
    /// ```
    pub(super) fn next(&mut self, blow: Blow, levels: &mut SplitMix64) -> Sound {
        let drop = self.drop;
        let scatter = libm::exp(drop.loudness_scatter * self.loudness.normal());
        let own = self
            .unlike
            .factor(LN_OF_DB * UNLIKE_IMPACT_DB * drop.unlike);
        let loudness = blow.speed_m_per_s * blow.fading * scatter * own;
        let modes: Vec<(Mode, f64)> = drop
            .modes
            .iter()
            .map(|m| {
                let (own, phase) = unlike(drop.unlike, &mut self.unlike);
                let frequency_hz = m.frequency_hz * self.pitches.factor(drop.frequency_scatter);
                let level = m.level * loudness * libm::exp(drop.level_scatter * levels.normal());
                let mode = Mode {
                    frequency_hz,
                    level: level * own * self.treble(m.frequency_hz, blow.of_first),
                    ..*m
                };
                (mode, phase)
            })
            .collect();
        let force_s = blow.contact_time_s * libm::pow(blow.of_first, drop.contact_exponent);
        Sound::with_phases(modes, force_s)
    }

    /// Factor on the level of a mode of this frequency, at this share of the first speed.
    fn treble(&self, frequency_hz: f64, of_first: f64) -> f64 {
        let octaves = libm::log2(frequency_hz / self.lowest_hz);
        libm::pow(of_first, self.drop.treble_loss * octaves)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synth::scene::preset;
    use crate::synth::sound::rms;
    use crate::units::real;

    const RATE: f64 = 44_100.0;

    fn mean(values: &[f64]) -> f64 {
        values.iter().sum::<f64>() / real(values.len())
    }

    fn std(values: &[f64]) -> f64 {
        let mean = mean(values);
        rms(&values.iter().map(|x| x - mean).collect::<Vec<_>>())
    }

    fn blow(of_first: f64) -> Blow {
        Blow {
            speed_m_per_s: 2.0 * of_first,
            of_first,
            fading: 1.0,
            contact_time_s: 1e-4,
        }
    }

    /// Steel that sounds the same each time, but for a change.
    fn drop(change: impl Fn(&mut DropScene)) -> DropScene {
        let mut drop = preset("steel").unwrap().drops.remove(0);
        drop.level_scatter = 0.0;
        change(&mut drop);
        drop
    }

    /// Energy of each mode of some impacts at shares of the first speed, in dB.
    fn levels_db(drop: &DropScene, speeds: &[f64]) -> Vec<Vec<f64>> {
        let mut voices = Voices::new(drop, 5, SplitMix64::new(6));
        let mut rng = SplitMix64::new(7);
        let modes_db = |&speed: &f64| {
            let modes = voices.next(blow(speed), &mut rng).modes(RATE, 0.0, 1.0);
            let energy = |m: &crate::synth::Rendered| m.pressure.iter().map(|x| x * x).sum::<f64>();
            modes.iter().map(|m| 10.0 * energy(m).log10()).collect()
        };
        speeds.iter().map(modes_db).collect()
    }

    #[test]
    fn unlike_impacts_scatter_by_their_share_of_6_and_3_db() {
        for unlike in [0.0, 0.5, 1.0] {
            let levels = levels_db(&drop(|d| d.unlike = unlike), &[1.0; 1_000]);
            let of_mode: Vec<f64> = levels.iter().map(|l| l[0]).collect();
            let between: Vec<f64> = levels.iter().map(|l| l[0] - l[1]).collect();
            let expected = unlike * 45.0_f64.sqrt();
            assert!(
                (std(&of_mode) - expected).abs() <= 0.1 * expected + 1e-9,
                "{unlike}"
            );
            let expected = unlike * 72.0_f64.sqrt();
            assert!(
                (std(&between) - expected).abs() <= 0.1 * expected + 1e-9,
                "{unlike}"
            );
        }
    }

    #[test]
    fn phases_of_wholly_unlike_impacts_are_anywhere() {
        let drop = drop(|d| d.unlike = 1.0);
        let mut voices = Voices::new(&drop, 5, SplitMix64::new(6));
        let mut rng = SplitMix64::new(7);
        // The mode at an instant of its ring, over its root mean square: the sine of a phase that is anywhere has variance ½.
        let sines = (0..1_000).map(|_| {
            let mode = &voices.next(blow(1.0), &mut rng).modes(RATE, 0.0, 1.0)[0];
            let ring = &mode.pressure[40..80];
            ring[20] / rms(ring)
        });
        let sines: Vec<f64> = sines.collect();
        assert!(mean(&sines).abs() < 0.1, "{}", mean(&sines));
        assert!((std(&sines) - 1.0).abs() < 0.1, "{}", std(&sines));
    }

    #[test]
    fn treble_falls_by_6_db_an_octave_where_the_speed_halves() {
        let thud = drop(|d| {
            d.treble_loss = 1.0;
            d.modes[1].frequency_hz = 4.0 * d.modes[0].frequency_hz;
            d.modes[2].frequency_hz = 2.0 * d.modes[0].frequency_hz;
        });
        let levels = levels_db(&thud, &[1.0, 0.5]);
        let fallen = |mode: usize| levels[0][mode] - levels[1][mode];
        let halved = 20.0 * 2.0_f64.log10();
        assert!((fallen(0) - halved).abs() < 1e-9);
        assert!((fallen(2) - 2.0 * halved).abs() < 1e-9);
    }
}
