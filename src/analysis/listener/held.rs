//! The audio that a listener holds: all that the scene that goes on, or the next one, may need.

use std::mem;

use crate::units::{frames, length};

/// Largest capacity of the buffer of earlier audio, over its length.
const MOST_ASIDE: usize = 8;

/// Audio of all channels, of which the first part was judged. Frames count from the start of the recording.
#[derive(Debug)]
pub(super) struct Held {
    /// The samples, channel by channel. What comes next is added at the end of each.
    pub channels: Vec<Vec<f32>>,
    /// The first frame.
    from: u64,
    /// The first frame that was not judged yet.
    judged: u64,
    /// The audio just before, which was set aside.
    earlier: Vec<Vec<f32>>,
}

impl Held {
    /// Nothing, from this frame on.
    pub(super) fn new(channels: usize, from: u64) -> Self {
        Self {
            channels: vec![Vec::new(); channels],
            from,
            judged: from,
            earlier: vec![Vec::new(); channels],
        }
    }

    /// The first frame.
    pub(super) const fn from(&self) -> u64 {
        self.from
    }

    /// The first frame that was not judged yet.
    pub(super) const fn judged(&self) -> u64 {
        self.judged
    }

    /// The first frame after all that is held.
    pub(super) fn end(&self) -> u64 {
        self.from + frames(self.channels[0].len())
    }

    /// How many frames were not judged yet.
    pub(super) fn unjudged(&self) -> usize {
        self.channels[0].len() - self.place(self.judged)
    }

    /// Index of a frame in each channel.
    fn place(&self, frame: u64) -> usize {
        length(frame - self.from)
    }

    /// The next frames of each channel that were not judged yet.
    pub(super) fn next(&self, unit: usize) -> impl Iterator<Item = &[f32]> {
        let begin = self.place(self.judged);
        self.channels
            .iter()
            .map(move |held| &held[begin..begin + unit])
    }

    /// Counts the next frames as judged.
    pub(super) fn judge(&mut self, unit: usize) {
        self.judged += frames(unit);
    }

    /// The frames from one to another of each channel.
    pub(super) fn between(&self, from: u64, to: u64) -> Vec<&[f32]> {
        let part = self.place(from)..self.place(to);
        let channels = self.channels.iter();
        channels.map(|held| &held[part.clone()]).collect()
    }

    /// The first frame of a scene that begins so many frames before what comes next, or where the audio does; what was
    /// set aside of it is held from then on.
    pub(super) fn begin(&mut self, before: usize) -> u64 {
        let missing = before.saturating_sub(self.place(self.judged));
        let missing = missing.min(self.earlier[0].len());
        for (held, earlier) in self.channels.iter_mut().zip(&self.earlier) {
            held.splice(0..0, earlier[earlier.len() - missing..].iter().copied());
        }
        self.from -= frames(missing);
        self.judged.saturating_sub(frames(before)).max(self.from)
    }

    /// Moves what was judged out of the way, in place of what was moved before. Buffers change places, so that silence
    /// is not copied, and are no longer than has to be, so that they stay in the cache.
    pub(super) fn set_aside(&mut self) {
        let judged = self.place(self.judged);
        for (earlier, held) in self.earlier.iter_mut().zip(&mut self.channels) {
            mem::swap(earlier, held);
            held.clear();
            held.extend(earlier.drain(judged..));
            // A long scene must not be room for two.
            earlier.shrink_to(MOST_ASIDE * judged);
        }
        self.from = self.judged;
    }

    /// Goes on from a frame, and gives what was held until now.
    pub(super) fn split(&mut self, from: u64) -> Self {
        let place = self.place(from);
        let rest = self.channels.iter().map(|held| held[place..].to_vec());
        let rest = rest.collect();
        Self {
            channels: mem::replace(&mut self.channels, rest),
            from: mem::replace(&mut self.from, from),
            judged: self.judged,
            earlier: Vec::new(),
        }
    }
}
