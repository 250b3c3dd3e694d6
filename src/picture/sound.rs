//! What a sheet keeps of the sound: the peaks of some hundred stretches, and the samples about a few onsets.

use crate::report::{Drop, Impact, Report, Status};
use crate::units::{real, samples_in};

/// Stretches whose peaks are kept: about one for each pixel of a sheet.
const STRETCHES: usize = 1200;
/// Room beside a drop, as a share of its length and in seconds.
const BESIDE: f64 = 0.05;
const BESIDE_S: f64 = 0.05;
/// An onset is shown from this long before its time to that long after it, in seconds …
const BEFORE_S: f64 = 3e-3;
const AFTER_S: f64 = 8e-3;
/// … and longer, up to this factor, where its time is unsure: its error is then this share of what is before it.
const LONGEST: f64 = 4.0;
const ERROR_SHARE: f64 = 0.4;

/// What is kept of one channel for one sheet: its size does not grow with the recording.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Sound {
    /// The channel, counted from 1.
    pub channel: usize,
    /// Where it begins, in seconds from the first sample.
    pub from_s: f64,
    /// Where it ends.
    pub to_s: f64,
    sample_rate_hz: f64,
    /// Greatest size of the samples in each of the stretches, which are equally long.
    peaks: Vec<f32>,
    /// A few onsets.
    pub onsets: Vec<Onset>,
}

/// The samples about one onset.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Onset {
    /// Which impact of the drop, counted from 0.
    pub impact: usize,
    first: usize,
    end: usize,
    sample_rate_hz: f64,
    /// The samples, full scale being ±1.
    pub samples: Vec<f32>,
}

impl Onset {
    fn of(impact: usize, of: &Impact, sample_rate_hz: f64) -> Self {
        let std_s = of.time_std_s.unwrap_or(0.0);
        let longer = (std_s / (ERROR_SHARE * BEFORE_S)).clamp(1.0, LONGEST);
        let at = |offset_s: f64| samples_in(of.time_s + longer * offset_s, sample_rate_hz);
        Self {
            impact,
            first: at(-BEFORE_S),
            end: at(AFTER_S),
            sample_rate_hz,
            samples: Vec::new(),
        }
    }

    /// Time of a sample in seconds from the first of the recording.
    #[must_use]
    pub fn time_s(&self, sample: usize) -> f64 {
        real(self.first + sample) / self.sample_rate_hz
    }
}

impl Sound {
    /// What is to be kept for each drop of a report; without a drop, for the whole that was listened to. All silent
    /// until it has [heard](Self::hear) the recording.
    #[must_use]
    pub fn of(report: &Report) -> Vec<Self> {
        let drops = &report.drops;
        if drops.is_empty() {
            let from_s = report.settings.start_s.unwrap_or(0.0);
            return vec![Self::between(
                report,
                report.recording.channel,
                from_s,
                None,
            )];
        }
        drops
            .iter()
            .map(|drop| Self::of_drop(report, drop))
            .collect()
    }

    fn of_drop(report: &Report, drop: &Drop) -> Self {
        let time_s = |impact: Option<&Impact>| impact.map_or(0.0, |i| i.time_s);
        let (first_s, last_s) = (time_s(drop.impacts.first()), time_s(drop.impacts.last()));
        let beside_s = BESIDE_S + BESIDE * (last_s - first_s);
        let to_s = Some(last_s + beside_s);
        let mut sound = Self::between(report, drop.channel, first_s - beside_s, to_s);
        let heard = |i: &usize| drop.impacts[*i].status != Status::Inferred;
        let heard: Vec<usize> = (0..drop.impacts.len()).filter(heard).collect();
        let mut chosen = match heard.as_slice() {
            [] => Vec::new(),
            [first, .., last] => vec![*first, heard[heard.len() / 2], *last],
            [only] => vec![*only],
        };
        chosen.dedup();
        let rate = report.recording.sample_rate_hz;
        let onset = |i: usize| Onset::of(i, &drop.impacts[i], rate);
        sound.onsets = chosen.into_iter().map(onset).collect();
        sound
    }

    fn between(report: &Report, channel: usize, from_s: f64, to_s: Option<f64>) -> Self {
        let recording = &report.recording;
        let end_s = report.settings.end_s.unwrap_or(f64::INFINITY);
        let to_s = to_s.unwrap_or(f64::INFINITY).min(end_s);
        let to_s = to_s.min(recording.duration_s);
        let from_s = from_s.clamp(0.0, to_s);
        let samples = samples_in(to_s - from_s, recording.sample_rate_hz);
        Self {
            channel,
            from_s,
            to_s,
            sample_rate_hz: recording.sample_rate_hz,
            peaks: vec![0.0; STRETCHES.min(samples).max(1)],
            onsets: Vec::new(),
        }
    }

    /// Takes in the next samples of its channel, `first` being the number of the first of them in the recording.
    pub fn hear(&mut self, first: usize, samples: &[f32]) {
        let end = first + samples.len();
        let inside = |from: usize, to: usize| {
            let (from, to) = (from.clamp(first, end), to.clamp(first, end));
            from - first..to.max(from) - first
        };
        for onset in &mut self.onsets {
            let part = &samples[inside(onset.first, onset.end)];
            onset.samples.extend_from_slice(part);
        }
        let length_s = (self.to_s - self.from_s) / real(self.peaks.len());
        let (from_s, rate) = (self.from_s, self.sample_rate_hz);
        let start = |stretch: usize| samples_in(from_s + real(stretch) * length_s, rate);
        // A block touches few of the stretches: the first of them is where the block begins.
        let nearest = samples_in(real(first) / rate - from_s, 1.0 / length_s.max(1.0 / rate));
        for stretch in nearest.saturating_sub(1)..self.peaks.len() {
            if start(stretch) >= end {
                break;
            }
            let part = &samples[inside(start(stretch), start(stretch + 1))];
            let peak = part.iter().map(|x| x.abs()).fold(0.0, f32::max);
            self.peaks[stretch] = self.peaks[stretch].max(peak);
        }
    }

    /// The last moment that is kept, in seconds.
    #[must_use]
    pub fn end_s(&self) -> f64 {
        let onsets = self.onsets.iter().map(|o| real(o.end) / o.sample_rate_hz);
        onsets.fold(self.to_s, f64::max)
    }

    /// The middle of each stretch in seconds, and its level in dB below full scale; −∞ in silence.
    pub fn levels(&self) -> impl Iterator<Item = (f64, f64)> {
        let length_s = (self.to_s - self.from_s) / real(self.peaks.len());
        let level = |peak: f32| 20.0 * f64::from(peak).log10();
        let levels = self.peaks.iter().enumerate();
        levels.map(move |(i, &peak)| (self.from_s + (real(i) + 0.5) * length_s, level(peak)))
    }

    /// The level of the stretch at a time.
    #[must_use]
    pub fn level_at(&self, time_s: f64) -> f64 {
        let nearest =
            |a: &(f64, f64), b: &(f64, f64)| (a.0 - time_s).abs().total_cmp(&(b.0 - time_s).abs());
        let nearest = self.levels().min_by(nearest);
        nearest.map_or(f64::NEG_INFINITY, |(_, level)| level)
    }
}
