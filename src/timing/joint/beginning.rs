//! Where the sound that all impacts have in common begins, wherever the detector saw them.

use super::time_walk::Corrected;
use crate::signal::constant_fraction;
use crate::signal::interpolate::shifted;
use crate::signal::template::aligned::{Cut, mean};
use crate::units::{real, samples_in};

/// The begin is sought so far from the places, either way, in seconds …
const AROUND_S: f64 = 4e-3;
/// … with so much sound before and after it, which is more than the constant fraction looks at.
const LEVEL_S: f64 = 3.5e-3;
/// Power of the noise that is taken to be there, as a share of that of the sound: what a codec puts before a sound is quieter.
const AUDIBLE: f64 = 0.01;

impl Corrected<'_> {
    /// Begin of the common sound in samples after the places, corrected for their walk.
    ///
    /// Times and template leave undetermined what all times have in common: it is where the detector saw the loudest impact, off
    /// by milliseconds where a sound rises slowly. The mean of the sounds at their places has all of the rise, and none of the
    /// detector in it.
    pub(super) fn beginning(&self) -> f64 {
        let rate = self.joint.started.rate;
        let (around, level) = (samples_in(AROUND_S, rate), samples_in(LEVEL_S, rate));
        let before = around + level;
        let mean = self.mean_around(before);
        let nominal = level_change(&mean, level);
        constant_fraction::between_samples(&mean, nominal, rate).unwrap_or(real(nominal))
            - real(before)
    }

    /// Mean of the sounds of the impacts so far either way of their places, the others taken out; of those that stand alone,
    /// if any does.
    fn mean_around(&self, reach: usize) -> Vec<f64> {
        let (joint, started) = (&self.joint, self.joint.started);
        let flights = &started.flights;
        let far = |flight: Option<&f64>| flight.is_none_or(|&f| f > real(2 * reach));
        let alone =
            |&i: &usize| far(i.checked_sub(1).and_then(|i| flights.get(i))) && far(flights.get(i));
        let count = joint.places.len();
        let mut of: Vec<usize> = (0..count).filter(alone).collect();
        if of.is_empty() {
            of = (0..count).collect();
        }
        let cut = |i: usize| {
            let place = joint.places[i];
            let later = self.walk.shift(started.contact_stretches[i]);
            let begin = place.position + later - real(reach);
            let mut sound = shifted(&started.sound, begin, 2 * reach);
            joint.take_out_others(i, begin, &mut sound);
            Cut {
                amplitude: place.amplitude,
                sound,
            }
        };
        mean(&of.into_iter().map(cut).collect::<Vec<Cut>>())
    }
}

/// Where a sound grows from one level to another, so far from its ends at least.
///
/// # Formula
/// `−n₀·ln σ₀² − n₁·ln σ₁²` is greatest: twice the log-likelihood of normal samples of one variance before, and of a larger one after.
fn level_change(sound: &[f64], margin: usize) -> usize {
    let total: f64 = sound.iter().map(|x| x * x).sum();
    let floor = AUDIBLE * total / real(sound.len()) + f64::MIN_POSITIVE;
    let mut before = 0.0;
    let mut best = (f64::NEG_INFINITY, sound.len() / 2);
    for (k, x) in sound.iter().enumerate() {
        let (first, second) = (real(k), real(sound.len() - k));
        let (quiet, loud) = (before / first, (total - before) / second);
        if (margin..=sound.len() - margin).contains(&k) && quiet < loud {
            let ln = -first * (quiet + floor).ln() - second * (loud + floor).ln();
            if ln > best.0 {
                best = (ln, k);
            }
        }
        before += x * x;
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    #[test]
    fn a_level_changes_where_noise_grows_and_not_where_it_falls() {
        let mut rng = SplitMix64::new(2);
        let level = |k: usize| match k {
            0..400 => 2.0,
            400..700 => 0.5,
            700.. => 1.5,
        };
        let sound: Vec<f64> = (0..1000).map(|k| level(k) * rng.normal()).collect();
        let found = level_change(&sound, 300);
        assert!(found.abs_diff(700) < 5, "{found}");
        // Of silence nothing is known.
        assert_eq!(level_change(&[0.0; 100], 10), 50);
    }
}
