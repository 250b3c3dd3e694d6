//! Two impacts timed by each other: the delay at which one is most like the other.

use super::{AFTER_S, BEFORE_S, by_fraction};
use crate::impact::Impact;
use crate::linalg::dot;
use crate::signal::correlate::correlate;
use crate::signal::interpolate::{maximum, slope};
use crate::signal::whiten::Whitened;
use crate::units::{real, samples_in};

/// Least correlation of two sounds of one source at their best delay. Below, each is timed by its own rise. Convention: half of
/// what is heard is in common where its square is a half.
const LEAST_CORRELATION: f64 = 0.7;

/// The times of two impacts; none where they are unlike or lie at the edge of the recording.
///
/// # Formula
/// ```text
/// r(k) = Σ x₁(j)·x₂(j + k),   ρ = r/√(Σ x₁² · Σ x₂(j + k)²),   T = argmax ρ,   σ_T² = 2·max((1 − ρ²)/ρ² · Σ x₁²/N, σ²) / Σ x₁′²
/// ```
/// over the N samples of the first one's window, σ² being the noise before it. Where the first itself began is known by its rise alone, and is common to both.
pub(super) fn times(sound: &Whitened<'_>, pair: [Impact; 2]) -> Option<[Impact; 2]> {
    let rate = sound.sample_rate_hz();
    let [first, second] = pair;
    let centre = pair.map(|impact| sound.sound().sample_at(impact.time_s));
    let (before, after) = (samples_in(BEFORE_S, rate), samples_in(AFTER_S, rate));
    let own = sound.between(centre[0].checked_sub(before)?, centre[0] + after)?;
    let other = sound.between(
        centre[1].checked_sub(2 * before)?,
        centre[1] + before + after,
    )?;
    let products = correlate(&other, &own)?;
    let energy = dot(&own, &own);
    let likeness = products.iter().zip(other.windows(own.len()));
    let likeness: Vec<f64> = likeness
        .map(|(product, window)| {
            product / (energy * dot(window, window)).sqrt().max(f64::MIN_POSITIVE)
        })
        .collect();
    let top = (0..likeness.len()).max_by(|&a, &b| likeness[a].total_cmp(&likeness[b]))?;
    let correlation = likeness[top];
    if correlation < LEAST_CORRELATION {
        return None;
    }
    // Near its top ρ is flat: what is interpolated is how far it lies below.
    let below: Vec<f64> = likeness.iter().map(|l| l - correlation).collect();
    let (delay, _) = maximum(&below, top);
    let slopes = slope(&own);
    let unlike = (1.0 - correlation * correlation).max(0.0) / (correlation * correlation);
    let quiet = &own[..before / 2];
    let noise = dot(quiet, quiet) / real(quiet.len().max(1));
    let unlike = (unlike * energy / real(own.len())).max(noise);
    let variance = 2.0 * unlike / dot(&slopes, &slopes);
    // Half of the variance of the flight each: an error that both share cancels in it.
    let std_s = (0.5 * variance).sqrt() / rate;
    let start = by_fraction(sound, first).unwrap_or(first);
    let apart = real(centre[1]) - real(centre[0]) + delay - real(before);
    Some([
        Impact { std_s, ..start },
        Impact {
            time_s: start.time_s + apart / rate,
            std_s,
            ..second
        },
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;
    use crate::signal::sound::Sound;
    use crate::units::narrow;

    const RATE: f64 = 48_000.0;

    /// Thuds whose loudest moment comes 2 ms after their onset, in noise.
    fn thuds(onsets_s: [f64; 2], frequencies_hz: [f64; 2], seed: u64) -> Vec<f32> {
        let mut rng = SplitMix64::new(seed);
        let sound = |t: f64, hz: f64| {
            if t <= 0.0 {
                return 0.0;
            }
            (t / 2e-3).powi(2) * (-t / 2e-3).exp() * (std::f64::consts::TAU * hz * t).sin()
        };
        let sample = |i: usize| {
            let t = real(i) / RATE;
            let [a, b] = [0, 1].map(|k| sound(t - onsets_s[k], frequencies_hz[k]));
            narrow(0.3 * a + 0.2 * b + 1e-4 * rng.normal())
        };
        (0..96_000).map(sample).collect()
    }

    fn timed(onsets_s: [f64; 2], frequencies_hz: [f64; 2]) -> Option<[Impact; 2]> {
        let samples = thuds(onsets_s, frequencies_hz, 3);
        let recorded = Sound::from_start(&samples, RATE);
        let sound = Whitened::around(recorded, (onsets_s[0], onsets_s[1]));
        // The detector errs by a millisecond.
        let off = [0.8e-3, -0.5e-3];
        times(
            &sound,
            [0, 1].map(|k| Impact::heard(onsets_s[k] + off[k], 1e-3)),
        )
    }

    #[test]
    fn the_flight_between_two_like_sounds_is_exact_whatever_the_detector_errs() {
        let onsets_s = [0.6, 1.234_567_8];
        let [first, second] = timed(onsets_s, [400.0, 400.0]).unwrap();
        let off = (second.time_s - first.time_s) - (onsets_s[1] - onsets_s[0]);
        let std = first.std_s.hypot(second.std_s);
        assert!(off.abs() < 2e-5 && off.abs() < 4.0 * std, "{off} {std}");
        assert!(std < 1e-4, "{std}");
    }

    #[test]
    fn unlike_sounds_are_not_timed_by_each_other() {
        assert!(timed([0.6, 1.2], [400.0, 2_700.0]).is_none());
    }
}
