//! A recording in memory as a stream: what was decoded once need not be again.

use std::ops::Range;

use super::{Ending, Recording};
use crate::units::real;

/// Frames of a block: a quarter of a second at 64 kHz. What is found does not depend on it.
const BLOCK: usize = 1 << 14;

#[derive(Debug)]
pub(super) struct Stream<'s> {
    pub(super) recording: &'s Recording,
    /// The next frame.
    next: usize,
}

impl<'s> Stream<'s> {
    pub(super) const fn new(recording: &'s Recording) -> Self {
        Self { recording, next: 0 }
    }

    fn frames(&self) -> usize {
        self.recording.channels.first().map_or(0, Vec::len)
    }

    pub(super) fn append(&mut self, channels: &Range<usize>, samples: &mut [Vec<f32>]) -> bool {
        let end = self.frames().min(self.next + BLOCK);
        let block = self.next..end;
        let read = &self.recording.channels[channels.clone()];
        for (channel, samples) in read.iter().zip(samples) {
            samples.extend_from_slice(&channel[block.clone()]);
        }
        self.next = end;
        !block.is_empty()
    }

    pub(super) fn finish(self) -> Ending {
        Ending {
            duration_s: real(self.frames()) / f64::from(self.recording.sample_rate_hz),
            warnings: self.recording.warnings.clone(),
            tracks: self.recording.tracks.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::audio;

    #[test]
    fn what_was_read_streams_again() {
        let frames = 2 * BLOCK + 7;
        let ramp: Vec<f32> = (0..frames).map(|i| (i % 100) as f32 / 128.0).collect();
        let other: Vec<f32> = ramp.iter().map(|x| -x).collect();
        let recording = Recording {
            sample_rate_hz: 8_000,
            channels: vec![ramp, other.clone()],
            encoding: "AAC".to_owned(),
            lossy: true,
            warnings: vec!["repaired".to_owned()],
            tracks: None,
        };
        let again = audio::Stream::again(&recording).into_recording().unwrap();
        assert_eq!(again.channels, recording.channels);
        assert_eq!((again.encoding.as_str(), again.lossy), ("AAC", true));
        assert_eq!(again.warnings, recording.warnings);

        for (room, whole) in [(2 * frames, true), (2 * frames - 1, false)] {
            let stream = audio::Stream::again(&recording);
            let within = stream.into_recording_within(room).unwrap();
            assert_eq!(within.is_some(), whole, "room for {room} samples");
        }

        let mut stream = audio::Stream::again(&recording);
        let mut second = vec![Vec::new()];
        while stream.append(&(1..2), &mut second).unwrap() {}
        assert_eq!(second[0], other);
        let duration_s = stream.finish().unwrap().duration_s;
        assert_eq!(duration_s, frames as f64 / 8_000.0);
    }
}
