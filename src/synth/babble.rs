//! Sounds like speech.

use super::sound::rms;
use crate::random::SplitMix64;
use crate::units::{real, samples_in};

/// Speech-like bursts: syllables of 80 to 300 ms, two thirds of them voiced at a gliding pitch of 90 to 220 Hz, the
/// others hissed, each through three formants of its own, with pauses in between.
pub(super) fn add(level: f64, rate: f64, rng: &mut SplitMix64, samples: &mut [f64]) {
    let mut start = 0;
    while start < samples.len() {
        let length = samples_in(0.08 + 0.22 * rng.uniform(), rate);
        let end = (start + length).min(samples.len());
        let syllable = syllable(end - start, rate, rng);
        let loudness = rms(&syllable);
        let gain = if loudness > 0.0 {
            level / loudness
        } else {
            0.0
        };
        for (x, y) in samples[start..end].iter_mut().zip(&syllable) {
            *x += gain * y;
        }
        start = end + samples_in(0.02 + 0.15 * rng.uniform() * rng.uniform(), rate);
    }
}

fn syllable(count: usize, rate: f64, rng: &mut SplitMix64) -> Vec<f64> {
    let voiced = rng.uniform() < 0.67;
    let (pitch_hz, glide) = (90.0 + 130.0 * rng.uniform(), 0.4 * rng.uniform() - 0.2);
    let formants = [
        250.0 + 500.0 * rng.uniform(),
        900.0 + 1_300.0 * rng.uniform(),
        2_300.0 + 900.0 * rng.uniform(),
    ];
    let mut phase = 0.0;
    let mut source: Vec<f64> = (0..count)
        .map(|i| {
            let share = real(i) / real(count);
            phase += pitch_hz * (1.0 + glide * share) / rate;
            let pulse = if phase >= 1.0 { 1.0 } else { 0.0 };
            phase -= pulse;
            let excitation = if voiced {
                pulse + 0.01 * rng.normal()
            } else {
                0.2 * rng.normal()
            };
            // A syllable swells in a tenth of its time and fades over the rest.
            let swell = (10.0 * share).min(1.0) * libm::cos(0.5 * std::f64::consts::PI * share);
            excitation * swell
        })
        .collect();
    for hz in formants.into_iter().filter(|hz| *hz < 0.45 * rate) {
        resonate(&mut source, hz, 90.0, rate);
    }
    source
}

/// A two-pole resonance added to what comes in.
fn resonate(samples: &mut [f64], frequency_hz: f64, width_hz: f64, rate: f64) {
    let radius = libm::exp(-std::f64::consts::PI * width_hz / rate);
    let (a, b) = (
        2.0 * radius * libm::cos(std::f64::consts::TAU * frequency_hz / rate),
        -radius * radius,
    );
    let (mut y1, mut y2) = (0.0, 0.0);
    for x in samples {
        let y = *x + a * y1 + b * y2;
        (y2, y1) = (y1, y);
        *x = y;
    }
}
