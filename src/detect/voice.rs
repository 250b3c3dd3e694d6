//! The sound of this ball: the mean of its impacts, learnt from those that stand alone.

use crate::signal::correlate::{correlate, dot};
use crate::signal::interpolate::shifted;
use crate::signal::whiten::Whitener;
use crate::units::{real, samples_in};

/// The learnt sound begins this long before the onset, in seconds.
const BEFORE_S: f64 = 0.4e-3;
/// It is learnt over this many seconds at most: a ring, an echo from a wall some metres away …
const LONGEST_S: f64 = 45e-3;
/// … and at least this many, or there is nothing to take out.
const SHORTEST_S: f64 = 6e-3;
/// Fewest impacts that have a mean.
const FEWEST: usize = 3;
/// Rounds in which the mean and the amplitudes of the impacts settle.
const ROUNDS: usize = 3;
/// The part of the sound that is matched holds this share of its energy …
const MATCHED_SHARE: f64 = 0.8;
/// … within this range of lengths, in seconds: longer ones would reach into the next impact …
const MATCHED_S: (f64, f64) = (1.5e-3, 6e-3);
/// … but where the shortest flight known is long, up to this share of it: a thud of 100 Hz is not known by half a period.
const MATCHED_FLIGHT: f64 = 0.2;
const MATCHED_LONGEST_S: f64 = 20e-3;
/// The sound of one impact, whitened.
#[derive(Debug, Clone)]
pub(super) struct Voice {
    /// Samples of the mean impact.
    pub shape: Vec<f64>,
    /// Samples before the onset.
    pub before: usize,
    /// Samples that are matched.
    pub matched: usize,
}

impl Voice {
    /// The mean of the impacts that nothing follows for long enough.
    pub(super) fn learn(
        samples: &[f32],
        rate: f64,
        impacts_s: &[f64],
        whitener: &Whitener,
    ) -> Option<Self> {
        let mut flights: Vec<f64> = impacts_s.windows(2).map(|w| w[1] - w[0]).collect();
        flights.sort_by(|a, b| b.total_cmp(a));
        // A little of the flight is left free: the next impact must not be part of the sound of this one.
        let length_s = (0.9 * flights.get(FEWEST - 1)? - BEFORE_S).min(LONGEST_S);
        if length_s < SHORTEST_S {
            return None;
        }
        let before = samples_in(BEFORE_S, rate);
        let length = before + samples_in(length_s, rate);
        let alone = impacts_s
            .windows(2)
            .filter(|w| w[1] - w[0] > length_s + BEFORE_S)
            .map(|w| w[0]);
        let sounds: Vec<Vec<f64>> = alone
            .filter_map(|onset_s| sound_at(samples, rate, onset_s, before, length, whitener))
            .collect();
        if sounds.len() < FEWEST {
            return None;
        }
        let shape = mean_shape(&sounds, length);
        let shortest_s = flights.last().copied().unwrap_or(0.0);
        let most_s = (MATCHED_FLIGHT * shortest_s).clamp(MATCHED_S.1, MATCHED_LONGEST_S);
        let matched = matched_length(&shape, before, rate, most_s);
        Some(Self {
            shape,
            before,
            matched,
        })
    }

    /// The match of the whole voice with its matched part, from the lag `1 − matched` on.
    pub(super) fn own_match(&self) -> Option<Vec<f64>> {
        let mut padded = vec![0.0; self.matched - 1];
        padded.extend(&self.shape);
        padded.resize(padded.len() + self.matched, 0.0);
        let mut own = correlate(&padded, &self.shape[..self.matched])?;
        own.truncate(self.shape.len() + self.matched - 1);
        Some(own)
    }
}

/// The whitened sound around one onset, as if it fell on a sample.
fn sound_at(
    samples: &[f32],
    rate: f64,
    onset_s: f64,
    before: usize,
    length: usize,
    whitener: &Whitener,
) -> Option<Vec<f64>> {
    const MARGIN: usize = 16;
    let first = (onset_s * rate).floor();
    let start = samples_in(first, 1.0).checked_sub(before + MARGIN)?;
    let sound = whitener.apply(samples, start, start + length + 2 * MARGIN)?;
    Some(shifted(
        &sound,
        real(MARGIN) + onset_s * rate - first,
        length,
    ))
}

/// The shape s and amplitudes aᵢ that leave least of `xᵢ − aᵢ·s`: in turn aᵢ = ⟨xᵢ, s⟩/⟨s, s⟩ and s = Σaᵢxᵢ/Σaᵢ².
fn mean_shape(sounds: &[Vec<f64>], length: usize) -> Vec<f64> {
    let mut amplitudes = vec![1.0; sounds.len()];
    let mut shape = vec![0.0; length];
    for _ in 0..ROUNDS {
        shape.fill(0.0);
        let power: f64 = amplitudes.iter().map(|a| a * a).sum();
        for (sound, a) in sounds.iter().zip(&amplitudes) {
            for (s, x) in shape.iter_mut().zip(sound) {
                *s += a * x / power;
            }
        }
        let energy = dot(&shape, &shape).max(f64::MIN_POSITIVE);
        for (sound, a) in sounds.iter().zip(&mut amplitudes) {
            *a = dot(sound, &shape) / energy;
        }
    }
    shape
}

fn matched_length(shape: &[f64], before: usize, rate: f64, most_s: f64) -> usize {
    let energy = dot(shape, shape);
    let mut sum = 0.0;
    let enough = shape
        .iter()
        .position(|s| {
            sum += s * s;
            sum >= MATCHED_SHARE * energy
        })
        .unwrap_or(shape.len());
    let range = (
        before + samples_in(MATCHED_S.0, rate),
        before + samples_in(most_s, rate),
    );
    enough.clamp(range.0.min(shape.len()), range.1.min(shape.len()))
}
