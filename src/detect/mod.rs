//! Where something struck: candidate impacts from samples and a rate. Knows nothing of balls.
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
use crate::signal::filterbank::Filterbank;
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

/// A moment at which the energy rose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Seconds from the first sample.
    pub time_s: f64,
    /// How far off the time may be, in seconds (one standard deviation): a quarter of a millisecond for a click, a
    /// millisecond or two for a thud.
    pub jitter_s: f64,
    /// Evidence that something struck, in nats: the log-likelihood ratio of a rise in energy, summed over bands, or of a match
    /// of z standard deviations, z²/2.
    pub strength: f64,
}

/// Margin on both sides of a segment that is computed but not reported, in seconds: the reach of the longest filters.
const MARGIN_S: f64 = 0.25;

/// Finds candidates at one rate.
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
    pub fn candidates(&self, samples: &[f32]) -> Vec<Candidate> {
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
            self.add_candidates(&samples[from..to], from, inside, &mut found);
            start = end;
        }
        found
    }

    /// Adds the candidates of one segment, which begins at the sample `from`, that lie in a range of its hops.
    fn add_candidates(
        &self,
        segment: &[f32],
        from: usize,
        inside: std::ops::Range<usize>,
        found: &mut Vec<Candidate>,
    ) {
        let evidence = rise::Evidence::of(&self.bank, segment);
        let separation = self.settings.separation_s / self.bank.hop_s();
        let peaks = peaks::pick(&evidence.total, separation, self.settings.weakest);
        let peaks = peaks.iter().filter(|p| inside.contains(&p.index));
        found.extend(peaks.map(|p| Candidate {
            time_s: real(from) / self.sample_rate_hz + evidence.begin(p.index) * self.bank.hop_s(),
            jitter_s: evidence.jitter_s(p.index),
            strength: p.height,
        }));
    }
}

/// How many of its strongest candidates speak for a channel.
const SPEAKERS: usize = 100;

/// How clearly a recording's impacts stand out: the sum of its hundred strongest candidates, in nats.
///
/// Of several channels the clearest is listened to. Channels are never averaged: two microphones hear one impact at
/// different times, and their sum smears its onset.
#[must_use]
pub fn clarity(candidates: &[Candidate]) -> f64 {
    let mut strengths: Vec<f64> = candidates.iter().map(|c| c.strength).collect();
    strengths.sort_by(|a, b| b.total_cmp(a));
    strengths.iter().take(SPEAKERS).sum()
}
