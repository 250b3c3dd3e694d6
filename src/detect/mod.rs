//! Where something struck: [events](crate::event) from samples and a rate. Knows nothing of balls.
//!
//! [`quiet`] watches over everything for the little in which something happens. A [filter bank](crate::signal::filterbank) splits that
//! into octaves, [`rise`] measures how surely the energy went up at each moment, [`peaks`] picks the moments.

pub mod matched;
pub mod peaks;
mod pursuit;
pub mod quiet;
pub mod rise;
mod rounding;
mod windows;

use crate::Error;
use crate::event::Event;
use crate::signal::filterbank::Filterbank;
use crate::signal::sound::Sound;
use crate::units::{real, samples_in};

/// How candidates are found. Every field has a default that suits all recordings seen so far.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Settings {
    /// Time grid of the energy, in seconds; rounded to a power of two of samples. Default 0.25 ms: a few times shorter
    /// than the shortest contact, and still cheap.
    pub hop_s: f64,
    /// Lowest frequency listened to, in Hz. Default 40: the octave above holds most of a basketball's thud.
    pub lowest_hz: f64,
    /// Two candidates are at least this far apart, in seconds. Default 1 ms: a quarter of the shortest audible flight.
    pub separation_s: f64,
    /// Weakest candidate kept, in nats of evidence. Default 3.5: white noise offers a hundred of these a second, and
    /// the sequence needs weak ones.
    pub weakest: f64,
    /// Length of the stretches whose ordinary level is learnt together, in seconds. Default 8: long against a flight,
    /// short against a change of scene.
    pub segment_s: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            hop_s: 0.25e-3,
            lowest_hz: 40.0,
            separation_s: 1e-3,
            weakest: 3.5,
            segment_s: 8.0,
        }
    }
}

/// Margin on both sides of a segment that is computed but not reported, in seconds: the reach of the longest filters.
const MARGIN_S: f64 = 0.25;

/// Finds events at one rate.
#[derive(Debug, Clone)]
pub struct Detector {
    bank: Filterbank,
    sample_rate_hz: f64,
    settings: Settings,
}

impl Detector {
    /// A detector for samples at this rate.
    ///
    /// # Errors
    /// [`Error::Argument`] if the rate is too low to hold an octave above [`Settings::lowest_hz`].
    pub fn new(sample_rate_hz: f64, settings: &Settings) -> Result<Self, Error> {
        Ok(Self {
            bank: Filterbank::new(sample_rate_hz, settings.hop_s, settings.lowest_hz)?,
            sample_rate_hz,
            settings: settings.clone(),
        })
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
        // Whole hops, so that the grids of neighbouring segments are one grid.
        let hops = |span_s| samples_in(span_s, self.sample_rate_hz).div_ceil(hop) * hop;
        let (segment, margin) = (hops(self.settings.segment_s), hops(MARGIN_S));
        let mut found = Vec::new();
        let mut start = 0;
        while start < samples.len() {
            // A short remainder joins the last segment: too little to learn an ordinary level from.
            let end = if samples.len() - start < segment + segment / 2 {
                samples.len()
            } else {
                start + segment
            };
            let from = start.saturating_sub(margin);
            let to = (end + margin).min(samples.len());
            let inside = (start - from) / hop..(end - from).div_ceil(hop);
            let segment = Sound {
                samples: &samples[from..to],
                start_s: sound.time_s(real(from)),
                ..*sound
            };
            self.add_events(&segment, inside, &mut found);
            start = end;
        }
        found
    }

    /// Adds the events of one segment that lie in a range of its hops.
    fn add_events(
        &self,
        segment: &Sound<'_>,
        inside: std::ops::Range<usize>,
        found: &mut Vec<Event>,
    ) {
        let evidence = rise::Evidence::of(&self.bank, segment.samples);
        let separation = self.settings.separation_s / self.bank.hop_s();
        let peaks = peaks::pick(&evidence.total, separation, self.settings.weakest);
        let peaks = peaks.iter().filter(|p| inside.contains(&p.index));
        found.extend(peaks.map(|p| Event {
            time_s: segment.start_s + evidence.begin(p.index) * self.bank.hop_s(),
            jitter_s: evidence.jitter_s(p.index),
            strength: p.height,
        }));
    }
}

/// How many of its strongest events speak for a channel.
const SPEAKERS: usize = 100;

/// How clearly a recording's impacts stand out: the sum of its hundred strongest events, in nats.
///
/// Of several channels the clearest is listened to. Channels are never averaged: two microphones hear one impact at
/// different times, and their sum smears its onset.
#[must_use]
pub fn clarity(events: &[Event]) -> f64 {
    let mut strengths: Vec<f64> = events.iter().map(|e| e.strength).collect();
    strengths.sort_by(|a, b| b.total_cmp(a));
    strengths.iter().take(SPEAKERS).sum()
}
