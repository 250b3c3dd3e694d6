//! A constant-fraction discriminator: the time at which an impact's envelope first reaches a fixed share of its own peak.

use crate::signal::interpolate::shifted;
use crate::units::{real, samples_in};

/// The crossing of the threshold by a rising envelope, in samples of its window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Crossing {
    /// Position between samples.
    pub position: f64,
    /// Standard error by the noise on the slope.
    pub std: f64,
}

/// The share of the peak: low enough to be early in the rise, high enough to be clear of the noise.
const FRACTION: f64 = 0.3;
/// An envelope that is this many standard deviations above what was before is no chance of the noise. Measured, against off: the
/// worst twentieth of the suite's times by this discriminator alone is 330 µs for 430.
const CLEAR: f64 = 5.0;
/// Width of the smoothing, in seconds: about the rise of an impact.
const SMOOTHING_S: f64 = 0.1e-3;
/// The peak is sought this far before and after the coarse time, in seconds.
const EARLIEST_S: f64 = 0.8e-3;
const LATEST_S: f64 = 1.5e-3;

/// Places for each sample that a time is sought at: among the samples alone it hangs by a tenth of one on where they lie.
const FINER: usize = 8;

/// The [`time`] of a sound that begins near the sample `coarse`, sought between the samples too, since where it lies among these is
/// chance.
pub(crate) fn between_samples(sound: &[f64], coarse: usize, sample_rate_hz: f64) -> Option<f64> {
    let (coarse, rate) = (FINER * coarse, real(FINER) * sample_rate_hz);
    let length = length(coarse, rate).div_ceil(FINER).min(sound.len());
    let shifts = (0..FINER).map(|k| shifted(sound, real(k) / real(FINER), length));
    let shifts: Vec<Vec<f64>> = shifts.collect();
    let finer = (0..length).flat_map(|i| shifts.iter().map(move |s| s[i]));
    let finer: Vec<f64> = finer.collect();
    time(&finer, coarse, rate).map(|r| r.position / real(FINER))
}

/// How many samples are looked at, from the first on, for a sound that begins near the sample `coarse`.
pub(crate) fn length(coarse: usize, sample_rate_hz: f64) -> usize {
    coarse + samples_in(LATEST_S, sample_rate_hz) + smoothing(sample_rate_hz)
}

fn smoothing(sample_rate_hz: f64) -> usize {
    samples_in(SMOOTHING_S, sample_rate_hz).max(1)
}

/// The constant-fraction time of a sound that begins near the sample `coarse`; none if its peak is not clear of the noise.
#[must_use]
pub(crate) fn time(samples: &[f64], coarse: usize, sample_rate_hz: f64) -> Option<Crossing> {
    let from = coarse.saturating_sub(samples_in(EARLIEST_S, sample_rate_hz));
    let to = (coarse + samples_in(LATEST_S, sample_rate_hz)).min(samples.len());
    let envelope = envelope(samples, to, smoothing(sample_rate_hz));
    let peak = (from..to).max_by(|&a, &b| envelope[a].total_cmp(&envelope[b]))?;
    // The impact rises from the level of the ring of the one before.
    let before = &envelope[from.saturating_sub(to - from)..from];
    let level = before.iter().sum::<f64>() / real(before.len().max(1));
    let spread = (before.iter().map(|e| (e - level).powi(2)).sum::<f64>()
        / real(before.len().max(1)))
    .sqrt();
    if envelope[peak] < level + 2.0 * spread || before.is_empty() {
        return None;
    }
    let threshold = level + FRACTION * (envelope[peak] - level);
    // A ring of few modes falls below the threshold between its waves: the rise is the first that is clear of the noise.
    let clear = threshold.max(level + CLEAR * spread);
    let first = (from..peak).find(|&i| envelope[i] >= clear);
    let first = first.unwrap_or(peak);
    let above = (from..=first).rev().find(|&i| envelope[i] < threshold)? + 1;
    let slope = envelope[above] - envelope[above - 1];
    let position = real(above - 1) + (threshold - envelope[above - 1]) / slope;
    // The smoothed noise moves the crossing by spread/slope; the sampling of the envelope by some hundredths.
    let steepness = (envelope[peak] - level) / real((peak - above + 2).max(1));
    Some(Crossing {
        position,
        std: (spread / steepness).hypot(0.3),
    })
}

/// Root mean square over `2·reach + 1` samples with triangular weights, of the first `length` samples.
fn envelope(samples: &[f64], length: usize, reach: usize) -> Vec<f64> {
    let weights: Vec<f64> = (0..=2 * reach)
        .map(|i| real(reach + 1 - i.abs_diff(reach)))
        .collect();
    let total: f64 = weights.iter().sum();
    (0..length)
        .map(|centre| {
            let sum: f64 = weights
                .iter()
                .enumerate()
                .filter_map(|(i, w)| {
                    Some(w * samples.get((centre + i).checked_sub(reach)?)?.powi(2))
                })
                .sum();
            (sum / total).sqrt()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    const RATE: f64 = 48_000.0;
    const ONSET: usize = 480;

    /// A ring from the onset on in noise of standard deviation 1.
    fn ring(frequency_hz: f64, level: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut rng = SplitMix64::new(4);
        let sample = |i: usize| {
            let after_s = real(i.saturating_sub(ONSET)) / RATE;
            let phase = std::f64::consts::TAU * frequency_hz * after_s;
            level(after_s) * phase.sin()
        };
        (0..2_000).map(|i| sample(i) + rng.normal()).collect()
    }

    #[test]
    fn a_ring_that_is_loudest_after_some_waves_begins_with_the_first() {
        let growing = |after_s: f64| 100.0 * (0.6 + after_s / 1e-3).min(1.0);
        for frequency_hz in [500.0, 740.0, 2_330.0, 12_000.0] {
            for coarse in [ONSET - 20, ONSET, ONSET + 20] {
                let found = time(&ring(frequency_hz, growing), coarse, RATE).unwrap();
                let after_s = (found.position - real(ONSET)) / RATE;
                let quarter_s = 0.25 / frequency_hz;
                assert!(
                    (-0.1e-3..quarter_s).contains(&after_s),
                    "{frequency_hz} Hz: {after_s} s"
                );
            }
        }
    }

    #[test]
    fn a_sound_that_is_hardly_clear_of_the_noise_begins_where_it_rises_to_its_peak() {
        let found = time(&ring(3_000.0, |_| 4.0), ONSET, RATE).unwrap();
        assert!((found.position - real(ONSET)).abs() < 1.5e-3 * RATE);
    }

    #[test]
    fn noise_alone_has_no_beginning() {
        assert_eq!(time(&vec![0.0; 2_000], ONSET, RATE), None);
    }
}
