//! A recording in memory, and where it is quiet.

use std::ops::Range;

use bounce_audio::units::{real, samples_in};

/// Length of the quietest stretch, in seconds: long enough for the noise of a room, short enough for any pause.
const QUIET_S: f64 = 0.05;
/// A stretch is quiet in which no sample is further from 0 than so many root mean squares of the quietest stretch.
const QUIET_PEAK: f64 = 10.0;

/// Samples of each channel, full scale being ±1, at a rate in Hz.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Recording {
    pub(crate) channels: Vec<Vec<f32>>,
    pub(crate) rate: f64,
}

impl Recording {
    /// The number of samples of a channel.
    pub(crate) fn len(&self) -> usize {
        self.channels.first().map_or(0, Vec::len)
    }

    /// The same with another sound in each channel.
    pub(crate) fn map(&self, of_channel: impl Fn(&[f32]) -> Vec<f32>) -> Self {
        Self {
            channels: self.channels.iter().map(|c| of_channel(c)).collect(),
            rate: self.rate,
        }
    }

    /// The number of samples in a time in seconds.
    pub(crate) fn samples_in(&self, span_s: f64) -> usize {
        samples_in(span_s, self.rate)
    }

    /// The quietest stretch outside of some others, none where these leave no room for it.
    pub(crate) fn quietest(&self, sounding: &[Range<usize>]) -> Option<Range<usize>> {
        let length = self.samples_in(QUIET_S).max(2);
        let apart = |quiet: &Range<usize>| {
            let mut others = sounding.iter();
            others.all(|s| quiet.end <= s.start || s.end <= quiet.start)
        };
        let starts = (0..=self.len().checked_sub(length)?).step_by(length / 2);
        let stretches = starts.map(|start| start..start + length);
        stretches
            .filter(apart)
            .map(|stretch| (self.rms(stretch.clone()), stretch))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, stretch)| stretch)
    }

    /// Root mean square of a stretch, over all channels.
    pub(crate) fn rms(&self, stretch: Range<usize>) -> f64 {
        let channels = self.channels.iter();
        let samples = channels.flat_map(|c| &c[stretch.clone()]);
        let count = (stretch.len() * self.channels.len()).max(1);
        let sum: f64 = samples.map(|x| f64::from(*x).powi(2)).sum();
        (sum / real(count)).sqrt()
    }

    /// Whether nothing sounds in a stretch, beside the quiet of this root mean square.
    pub(crate) fn is_quiet(&self, stretch: Range<usize>, rms: f64) -> bool {
        let mut channels = self.channels.iter();
        channels.all(|c| {
            let mut samples = c[stretch.clone()].iter();
            samples.all(|x| f64::from(x.abs()) <= QUIET_PEAK * rms)
        })
    }
}
