//! Events by a matched filter: impacts that the ring or the echo of another hides in the energy are found by their shape.
//!
//! The best match of the drop's template, ring and echo included, is found in the whitened recording and subtracted whole,
//! then the next best match in the residue, until none stands out of the noise.

use super::pursuit::Residue;
use crate::event::{Event, Profile};
use crate::linalg::dot;
use crate::order::sort_by_number;
use crate::signal::template::Template;
use crate::signal::whiten::Whitened;
use crate::units::{real, samples_in};

/// The matched part begins this long before the onset, in seconds, …
const BEFORE_S: f64 = 0.4e-3;
/// … holds this share of the energy of the sound …
const MATCHED_SHARE: f64 = 0.85;
/// … within this range of lengths, in seconds: longer ones would reach into the next impact …
const MATCHED_S: (f64, f64) = (1.5e-3, 6e-3);
/// … or, where the shortest flight known is long, up to this share of it: a thud of 100 Hz needs more than half a period.
const MATCHED_FLIGHT: f64 = 0.2;
const MATCHED_LONGEST_S: f64 = 20e-3;
/// A match of so many standard deviations is a sound: white noise makes one in some minutes.
const CERTAIN: f64 = 5.0;
/// Weakest match, in standard deviations of the noise.
const WEAKEST: f64 = 3.5;
/// Two matches are at least this far apart, in seconds: nearer ones are the residue of one sound.
const APART_S: f64 = 0.5e-3;
/// Least jitter of a match, by neighbours that overlap it: a standard deviation in seconds, and as a share of 1/β of the
/// matched part.
const LEAST_JITTER_S: f64 = 0.05e-3;
const LEAST_JITTER_SHARE: f64 = 0.3;

/// Matches with a drop's template in its whitened sound, in a region of the recording, in order of time.
///
/// No flight of the drop is known to be shorter than `shortest_s`; `region_s` is where to look. A match of z
/// standard deviations of the noise is z²/2 nats; z falls with the ball's speed as loudness does. None where the region is
/// cut by the end of the recording.
#[must_use]
pub fn events(
    sound: &Whitened<'_>,
    template: &Template,
    shortest_s: f64,
    region_s: (f64, f64),
) -> Option<Vec<Event>> {
    let rate = sound.sample_rate_hz();
    let before = samples_in(BEFORE_S, rate).min(template.before);
    let pattern = template.audible().split_off(template.before - before);
    let head = head_length(&pattern, before, rate, shortest_s);
    let alone = (before + samples_in(shortest_s, rate)).clamp(head, pattern.len());
    let inverse_bandwidth_s = 1.0 / bandwidth_per_s(&pattern[..head], rate);
    let recorded = *sound.sound();
    let start = recorded.sample_at(region_s.0);
    let end = recorded.sample_at(region_s.1).min(sound.range().end);
    let sound = sound.between(start, end)?;
    let apart = samples_in(APART_S, rate).max(1);
    let onset = real(start + before) + template.onset(rate);
    let mut found: Vec<Event> = Residue::new(sound, &pattern, head, alone)?
        .matches(CERTAIN, WEAKEST, apart)
        .into_iter()
        .map(|(position, z)| Event {
            time_s: recorded.time_s(onset + position),
            jitter_s: (inverse_bandwidth_s * LEAST_JITTER_SHARE.max(1.0 / z)).max(LEAST_JITTER_S),
            strength: 0.5 * z * z,
            loudness: z.ln(),
            profile: Profile::default(),
        })
        .collect();
    sort_by_number(&mut found, |event: &Event| event.time_s);
    Some(found)
}

/// The effective bandwidth of a sound.
///
/// # Formula
/// `β = √(∫ s'² dt / ∫ s² dt)` in radians a second: in white noise a match of z standard deviations errs by 1/(β·z) in time
/// (Cramér and Rao's bound for a known pulse).
fn bandwidth_per_s(sound: &[f64], rate: f64) -> f64 {
    let change: f64 = sound.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum();
    let energy = dot(sound, sound).max(f64::MIN_POSITIVE);
    rate * (change.max(f64::MIN_POSITIVE) / energy).sqrt()
}

/// Samples of a pattern that are matched, of which so many come before the onset.
fn head_length(shape: &[f64], before: usize, rate: f64, shortest_s: f64) -> usize {
    let most_s = (MATCHED_FLIGHT * shortest_s).clamp(MATCHED_S.1, MATCHED_LONGEST_S);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;
    use crate::signal::sound::Sound;
    use crate::signal::template::aligned::Cut;

    const RATE: f64 = 44_100.0;

    /// Rings of 8 ms at 900 Hz with an echo, at these times with these amplitudes, in noise.
    fn recording(impacts: &[(f64, f64)]) -> Vec<f32> {
        let mut rng = SplitMix64::new(12);
        let ring = |t: f64| {
            if t > 0.0 {
                (-t / 8e-3).exp()
                    * (1.0 - (-t / 2e-4).exp())
                    * (std::f64::consts::TAU * 900.0 * t).sin()
            } else {
                0.0
            }
        };
        #[expect(clippy::cast_possible_truncation, reason = "test samples")]
        (0..88_200)
            .map(|i| {
                let t = real(i) / RATE;
                let sound: f64 = impacts
                    .iter()
                    .map(|&(at, a)| a * (ring(t - at) + 0.4 * ring(t - at - 11e-3)))
                    .sum();
                (sound + 1e-3 * rng.normal()) as f32
            })
            .collect()
    }

    /// The template of impacts that begin at a sample, from 1 ms before the onset to 40 ms after.
    fn template(sound: &Whitened<'_>, impacts: &[(f64, f64)]) -> Template {
        let (before, after) = (samples_in(1e-3, RATE), samples_in(40e-3, RATE));
        let aligned = impacts.iter().map(|&(at_s, amplitude)| {
            let at = samples_in(at_s, RATE);
            Cut {
                amplitude,
                sound: sound.between(at - before, at + after).unwrap(),
            }
        });
        let aligned: Vec<Cut> = aligned.collect();
        Template::of_aligned(&aligned, before, RATE).unwrap()
    }

    #[test]
    fn impacts_under_the_ring_and_the_echo_of_others_are_found() {
        let mut known: Vec<(f64, f64)> = (0..6)
            .map(|i| (0.3 + 0.1 * real(i), 0.5 - 0.05 * real(i)))
            .collect();
        // Flights are known down to 30 ms: no ball goes from 100 to 9 at once.
        known.extend([(0.86, 0.24), (0.89, 0.23)]);
        let late = [(1.000, 0.2), (1.009, 0.15), (1.0171, 0.12), (1.0243, 0.1)];
        let samples = recording(&[&known[..], &late].concat());
        let sound = Whitened::around(Sound::from_start(&samples, RATE), (0.3, 0.89));
        let template = template(&sound, &known[..6]);
        let found = events(&sound, &template, 0.03, (0.95, 1.1)).unwrap();
        let mut strongest = found.clone();
        strongest.sort_by(|a, b| b.strength.total_cmp(&a.strength));
        let mut times: Vec<f64> = strongest[..4].iter().map(|c| c.time_s).collect();
        times.sort_by(f64::total_cmp);
        for (time, (true_time, _)) in times.iter().zip(late) {
            // Overlapping impacts pull each other by some hundredths of a millisecond.
            let late = time - true_time - template.onset(RATE) / RATE;
            assert!(late.abs() < 1e-4, "{times:?}");
        }
        // The echoes were taken out with their impacts: of the last one nothing is left.
        let echo = found.iter().filter(|c| (c.time_s - 1.0353).abs() < 3e-3);
        assert!(
            echo.clone()
                .all(|c| c.strength < 0.03 * strongest[3].strength),
            "{echo:?}"
        );
    }
}
