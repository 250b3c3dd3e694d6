//! The sound of this ball: the mean of its impacts, learnt from those that stand alone.

use super::refine::interpolate::shifted;
use super::refine::whiten::Whitener;
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

/// `Σ aᵢ·bᵢ` over two sequences of one length, in sums that run side by side.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    const LANES: usize = 8;
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let mut sums = [0.0; LANES];
    for (x, y) in a.iter().zip(b) {
        for (sum, (x, y)) in sums.iter_mut().zip(x.iter().zip(y)) {
            *sum += x * y;
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + rest
}

/// Transforms are this many times as long as the shorter sequence, or a little longer: most of each is then of use, and
/// it fits the cache.
const TRANSFORM_LENGTHS: usize = 6;

/// Correlates sequences by Fourier transforms, which it remembers the plans of.
#[derive(Default)]
pub(super) struct Correlator {
    planner: realfft::RealFftPlanner<f64>,
}

impl std::fmt::Debug for Correlator {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Correlator").finish_non_exhaustive()
    }
}

/// [`Correlator::correlate`] for once.
pub(super) fn correlate(a: &[f64], b: &[f64]) -> Option<Vec<f64>> {
    Correlator::default().correlate(a, b)
}

impl Correlator {
    /// `Σ_j a[k + j]·b[j]` for every k at which b lies within a, by Fourier transforms of stretches of a that overlap by b.
    pub(super) fn correlate(&mut self, a: &[f64], b: &[f64]) -> Option<Vec<f64>> {
        let count = a.len().checked_sub(b.len())? + 1;
        let length = (TRANSFORM_LENGTHS * b.len())
            .min(a.len())
            .next_power_of_two();
        let forward = self.planner.plan_fft_forward(length);
        let inverse = self.planner.plan_fft_inverse(length);
        let (mut stretch, mut spectrum) = (forward.make_input_vec(), forward.make_output_vec());
        let (mut ahead, mut back) = (forward.make_scratch_vec(), inverse.make_scratch_vec());
        let mut sound = forward.make_output_vec();
        stretch[..b.len()].copy_from_slice(b);
        forward
            .process_with_scratch(&mut stretch, &mut spectrum, &mut ahead)
            .ok()?;
        for x in &mut spectrum {
            *x = x.conj() / real(length);
        }
        let mut out = Vec::with_capacity(count);
        // Of each stretch the last values wrap around.
        let step = length - b.len() + 1;
        for start in (0..count).step_by(step) {
            let end = (start + length).min(a.len());
            stretch[..end - start].copy_from_slice(&a[start..end]);
            stretch[end - start..].fill(0.0);
            forward
                .process_with_scratch(&mut stretch, &mut sound, &mut ahead)
                .ok()?;
            for (x, y) in sound.iter_mut().zip(&spectrum) {
                *x *= y;
            }
            // Rounding leaves a trace of an imaginary part where a real signal has none.
            sound.first_mut()?.im = 0.0;
            sound.last_mut()?.im = 0.0;
            inverse
                .process_with_scratch(&mut sound, &mut stretch, &mut back)
                .ok()?;
            out.extend_from_slice(&stretch[..step.min(count - start)]);
        }
        Some(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    #[test]
    fn correlation_is_that_of_the_definition() {
        let mut rng = SplitMix64::new(2);
        let a: Vec<f64> = (0..999).map(|_| rng.normal()).collect();
        for width in [1, 2, 7, 64, 500, 999] {
            let b: Vec<f64> = (0..width).map(|_| rng.normal()).collect();
            let fast = correlate(&a, &b).unwrap();
            assert_eq!(fast.len(), 1_000 - width);
            for (k, (f, window)) in fast.iter().zip(a.windows(width)).enumerate() {
                let s = dot(window, &b);
                // A thousand terms of size 1 in double precision.
                assert!((f - s).abs() < 1e-11, "width {width}, lag {k}: {f} vs {s}");
            }
        }
        assert!(correlate(&a[..3], &a[..4]).is_none());
    }
}
