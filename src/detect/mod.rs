//! Detection of [events](crate::event), moments at which something struck, in samples at a rate. Knows nothing of balls.
//!
//! [`activity_gate`] passes on the parts of a recording in which something happens. A
//! [filter bank](crate::signal::filterbank) splits those into octaves, [`change_point`] measures the evidence that the
//! energy went up at each moment, [`peaks`] picks the moments. Once a drop's template is known, [`matched`] finds the events
//! that it explains, under the ring of others too.

pub mod activity_gate;
pub mod change_point;
pub mod matched;
mod matches;
pub mod peaks;
mod pursuit;
mod quantization;
mod running_mean;

use std::ops::Range;

use crate::Error;
use crate::event::Event;
use crate::order::sort_by_number;
use crate::signal::filterbank::Filterbank;
use crate::signal::sound::{Sound, loudest};
use crate::statistics::sorted;
use crate::units::{real, samples_in};

/// Time grid of the energy, in seconds; a bank rounds it to a power of two of samples. Convention: a few times shorter than
/// the shortest contact, and still cheap.
pub const HOP_S: f64 = 0.25e-3;
/// Lowest frequency listened to, in Hz. Convention: the octave above holds most of a basketball's thud.
const LOWEST_HZ: f64 = 40.0;
/// Two events are at least this far apart, in seconds. Convention: a quarter of the shortest audible flight.
pub const SEPARATION_S: f64 = 1e-3;
/// Weakest event kept, in nats: white noise offers a hundred of these a second, and the sequence needs weak ones.
const WEAKEST: f64 = 3.5;
/// Length of the stretches whose ordinary level is learnt together, in seconds: long against a flight, short against a
/// change of scene.
const SEGMENT_S: f64 = 8.0;
/// Margin on both sides of a segment that is computed but not reported, in seconds. Derived: the reach of the longest
/// filters.
const MARGIN_S: f64 = 0.25;

/// Finds events at one rate.
#[derive(Debug, Clone)]
pub struct Detector {
    bank: Filterbank,
    sample_rate_hz: f64,
}

impl Detector {
    /// A detector for samples at this rate.
    ///
    /// # Errors
    /// [`Error::Argument`] if the rate is too low to hold an octave above 40 Hz.
    pub fn new(sample_rate_hz: f64) -> Result<Self, Error> {
        Ok(Self {
            bank: Filterbank::new(sample_rate_hz, HOP_S, LOWEST_HZ)?,
            sample_rate_hz,
        })
    }

    /// The octaves that it listens in.
    #[must_use]
    pub const fn bank(&self) -> &Filterbank {
        &self.bank
    }

    /// Samples per second.
    #[must_use]
    pub const fn sample_rate_hz(&self) -> f64 {
        self.sample_rate_hz
    }

    /// All moments at which the energy rose, weak ones included, in order of time.
    #[must_use]
    pub fn events(&self, sound: &Sound<'_>) -> Vec<Event> {
        let samples = sound.samples;
        let hop = self.bank.hop();
        // The grid belongs to the sound and not to the recording: hops and segments lie at whole steps from its loudest sample.
        let anchor = loudest(samples);
        let first = anchor % hop;
        let margin = self.whole_hops(MARGIN_S);
        let mut found = Vec::new();
        for Range { start, end } in self.segments(samples.len(), anchor) {
            let from = start.saturating_sub(margin).max(first);
            let to = (end + margin).min(samples.len());
            let inside = (start - from) / hop..(end - from).div_ceil(hop);
            let segment = Sound {
                samples: &samples[from..to],
                start_s: sound.time_s(real(from)),
                ..*sound
            };
            self.add_events(&segment, inside, &mut found);
        }
        // The sound of a peak may begin before that of the peak before it.
        sort_by_number(&mut found, |event| event.time_s);
        found
    }

    /// Samples of a span, in whole hops, so that the grids of neighbouring segments are one grid.
    fn whole_hops(&self, span_s: f64) -> usize {
        samples_in(span_s, self.sample_rate_hz).next_multiple_of(self.bank.hop())
    }

    /// The segments, as ranges of samples, from the first whole hop on. A short remainder at either end joins its neighbour:
    /// too little to learn an ordinary level from.
    fn segments(&self, length: usize, anchor: usize) -> Vec<Range<usize>> {
        let segment = self.whole_hops(SEGMENT_S);
        let (mut start, mut border) = (anchor % self.bank.hop(), anchor % segment + segment);
        let mut segments = Vec::new();
        while border + segment / 2 <= length {
            segments.push(start..border);
            start = border;
            border += segment;
        }
        segments.push(start..length);
        segments
    }

    /// Adds the events of one segment that lie in a range of its hops.
    fn add_events(&self, segment: &Sound<'_>, inside: Range<usize>, found: &mut Vec<Event>) {
        let evidence = change_point::Evidence::of(&self.bank, segment.samples);
        let separation = SEPARATION_S / self.bank.hop_s();
        let peaks = peaks::pick(&evidence.total, separation, WEAKEST);
        let peaks = peaks.iter().filter(|p| inside.contains(&p.index));
        found.extend(peaks.map(|p| Event {
            time_s: segment.start_s + evidence.begin(p.index) * self.bank.hop_s(),
            jitter_s: evidence.jitter_s(p.index),
            strength: p.height,
            loudness: p.height.ln(),
            profile: evidence.profile(p.index),
        }));
    }
}

/// Strongest events of a channel that its clarity sums.
const SPEAKERS: usize = 100;

/// Clarity of a recording's impacts: the sum of its hundred strongest events, in nats.
///
/// Of several channels the clearest is listened to. Channels are never averaged: two microphones hear one impact at
/// different times, and their sum smears its onset.
#[must_use]
pub fn clarity(events: &[Event]) -> f64 {
    let strengths = sorted(events.iter().map(|e| e.strength));
    strengths.iter().rev().take(SPEAKERS).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;
    use crate::units::narrow;

    /// Clicks and slow thumps at random, in noise.
    fn clicks_and_thumps(seed: u64) -> Vec<f32> {
        const RATE: f64 = 8_000.0;
        let mut random = SplitMix64::new(seed);
        let mut samples: Vec<f64> = (0..16_000).map(|_| 1e-4 * random.normal()).collect();
        for i in 0..40 {
            let (hz, decay_s) = if i % 2 == 0 {
                (70.0, 0.03)
            } else {
                (2_500.0, 2e-3)
            };
            let onset_s = 2.0 * random.uniform();
            let height = 0.1 * random.normal().exp();
            for (k, sample) in samples.iter_mut().enumerate() {
                let t = real(k) / RATE - onset_s;
                if t > 0.0 {
                    *sample +=
                        height * (-t / decay_s).exp() * (std::f64::consts::TAU * hz * t).sin();
                }
            }
        }
        samples.into_iter().map(narrow).collect()
    }

    #[test]
    fn events_are_in_order_of_time_also_where_a_slow_sound_begins_before_a_quick_one() {
        let detector = Detector::new(8_000.0).unwrap();
        for seed in 0..20 {
            let sound = Sound {
                samples: &clicks_and_thumps(seed),
                sample_rate_hz: 8_000.0,
                start_s: 0.0,
            };
            let events = detector.events(&sound);
            assert!(events.len() > 20, "{}", events.len());
            assert!(events.is_sorted_by_key(|e| e.time_s), "seed {seed}");
        }
    }

    #[test]
    fn events_move_with_the_sound_by_any_number_of_samples() {
        const RATE: f64 = 48_000.0;
        let detector = Detector::new(RATE).unwrap();
        let original: Vec<f32> = (0..30).flat_map(clicks_and_thumps).collect();
        let heard = |zeros: usize| {
            let samples = [&vec![0.0; zeros], &original[..]].concat();
            let mut events = detector.events(&Sound::from_start(&samples, RATE));
            for event in &mut events {
                event.time_s -= real(zeros) / RATE;
            }
            // Zeros before a sound end where it begins.
            events.retain(|e| e.time_s > 0.05);
            events
        };
        assert!(detector.bank().hop() > 1);
        let expected = heard(0);
        for zeros in [1, 5, 100, 10_007] {
            let found = heard(zeros);
            assert_eq!(found.len(), expected.len(), "{zeros} zeros");
            // Of two hops that begin a sound as well the other may be taken.
            let pairs = found.iter().zip(&expected);
            let same = pairs.filter(|(a, b)| {
                let stronger = (a.strength / b.strength).ln();
                (a.time_s - b.time_s).abs() < 1e-9 && stronger.abs() < 0.01
            });
            assert!(100 * same.count() >= 98 * found.len(), "{zeros} zeros");
        }
    }
}
