//! A stretch of a recording: the one place where seconds of the recording become samples of the stretch and back.

use std::ops::Range;

use crate::units::{real, samples_in};

/// Consecutive samples of one channel of a recording.
#[derive(Debug, Clone, Copy)]
pub struct Sound<'a> {
    /// Full scale is ±1.
    pub samples: &'a [f32],
    /// Samples per second.
    pub sample_rate_hz: f64,
    /// Time of the first sample, in seconds from the start of the recording.
    pub start_s: f64,
}

impl<'a> Sound<'a> {
    /// The sound from the start of a recording on.
    #[must_use]
    pub const fn from_start(samples: &'a [f32], sample_rate_hz: f64) -> Self {
        Self {
            samples,
            sample_rate_hz,
            start_s: 0.0,
        }
    }

    /// Time after the last sample, in seconds from the start of the recording.
    #[must_use]
    pub fn end_s(&self) -> f64 {
        self.time_s(real(self.samples.len()))
    }

    /// The time at a position in samples, in seconds from the start of the recording.
    #[must_use]
    pub fn time_s(&self, position: f64) -> f64 {
        self.start_s + position / self.sample_rate_hz
    }

    /// The position of a time in samples.
    #[must_use]
    pub fn position(&self, time_s: f64) -> f64 {
        (time_s - self.start_s) * self.sample_rate_hz
    }

    /// The sample nearest to a time, the first one for earlier times; later ones may lie past the end.
    #[must_use]
    pub fn sample_at(&self, time_s: f64) -> usize {
        samples_in(time_s - self.start_s, self.sample_rate_hz)
    }

    /// The samples between two times, as far as they are in the stretch.
    #[must_use]
    pub fn between(&self, from_s: f64, to_s: f64) -> &'a [f32] {
        let at = |time_s: f64| self.sample_at(time_s).min(self.samples.len());
        &self.samples[at(from_s)..at(to_s).max(at(from_s))]
    }
}

/// The samples from the first to the last that is not 0.
#[must_use]
pub fn heard(samples: &[f32]) -> Range<usize> {
    let sounds = |x: &f32| *x != 0.0;
    let first = samples.iter().position(sounds).unwrap_or(samples.len());
    first..samples.iter().rposition(sounds).map_or(first, |k| k + 1)
}

/// The first of the loudest samples; 0 of none.
#[must_use]
pub fn loudest(samples: &[f32]) -> usize {
    let sizes = samples.iter().map(|x| x.abs()).enumerate().rev();
    sizes
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(0, |(i, _)| i)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_count_from_the_start_of_the_recording() {
        let samples: Vec<f32> = (0..100_u8).map(f32::from).collect();
        let sound = Sound {
            samples: &samples,
            sample_rate_hz: 100.0,
            start_s: 7.0,
        };
        assert_eq!(sound.end_s(), 8.0);
        assert_eq!(sound.sample_at(7.25), 25);
        assert_eq!(sound.position(sound.time_s(12.5)), 12.5);
        assert_eq!(sound.between(7.1, 7.13), [10.0, 11.0, 12.0]);
        assert_eq!(
            (sound.sample_at(6.0), sound.between(6.0, 6.5).len()),
            (0, 0)
        );
        assert_eq!(sound.between(7.98, 9.0).len(), 2);
    }
}
