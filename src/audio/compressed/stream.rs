//! Packets into samples, in blocks, with silence for what was lost.

use std::fmt;
use std::ops::Range;

use symphonia::core::packet::Packet;

use super::codec::Decoder;
use super::guard::guarded;
use super::losses::{Losses, real_s};
use super::opening::open;
use super::source::Source;
use super::start::Start;
use super::{Next, Opened, Packets};
use crate::Error;
use crate::audio::content::Content;
use crate::audio::wav::zero_what_is_not_finite;
use crate::audio::{Ending, Track, unreadable};

/// Frames of silence that are handed over at a time.
const BLOCK: u64 = 4_096;
/// More than a packet of any codec holds.
const MOST_PER_PACKET: u64 = 1 << 16;
/// Seconds of silence that stand for lost sound, over a whole recording: a damaged number must not make hours of it.
const MOST_SILENCE_S: u64 = 60;

/// Frames that wait for a mark at most: a page holds less.
const MOST_UNMARKED: u64 = 1 << 20;

/// A compressed recording that stands at its first samples.
pub(in crate::audio) struct Stream<'s> {
    packets: Box<dyn Packets + 's>,
    decoder: Decoder,
    /// Whether the container has marks.
    marks: bool,
    /// Whether the length of what is lost is an estimate, from the length of frames.
    is_estimate: bool,
    sample_rate_hz: u32,
    channels: usize,
    start: Start,
    /// Frames at the head of the stream that are yet to be left out.
    hidden: u64,
    /// Frames of silence, and after them samples, that are yet to be handed over.
    silence: u64,
    ready: Vec<Vec<f32>>,
    /// Frames so far, with those that are yet to be handed over.
    frames: u64,
    /// Frames since the last mark, and where that was.
    unmarked: u64,
    mark: Option<u64>,
    /// Frames of the last packet that could be decoded.
    usual: u64,
    losses: Losses,
    end: Option<Next>,
    /// What is to be said of the choice of a track.
    note: Option<String>,
    /// Units per second of what packets say of how long they last, if they say so.
    units_per_s: Option<u32>,
    /// Frames that are missing behind the last packet, which lasts longer than its sound.
    gap: u64,
    /// Frames by which the sound of all packets so far lasts less than they do.
    behind: i64,
}

impl fmt::Debug for Stream<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Stream")
            .field("encoding", &self.encoding())
            .finish_non_exhaustive()
    }
}

impl<'s> Stream<'s> {
    /// Goes to the first sound that can be decoded.
    ///
    /// # Errors
    /// [`Error::Recording`] if there is none, or it is of a kind that is not read; [`Error::Io`] if reading fails.
    pub(in crate::audio) fn open(
        content: Content,
        source: Source<'s>,
        wanted: Track,
    ) -> Result<Self, Error> {
        let broken = || unreadable("its header is damaged beyond what can be read");
        let opened = guarded(|| open(content, source, wanted)).ok_or_else(broken)?;
        let Opened {
            packets,
            decoder,
            start,
            note,
            units_per_s,
        } = opened?;
        let mut stream = Self {
            packets,
            decoder,
            marks: content == Content::Ogg,
            is_estimate: matches!(content, Content::Mp3 | Content::Adts | Content::Tagged),
            sample_rate_hz: 0,
            channels: 0,
            start,
            hidden: 0,
            silence: 0,
            ready: Vec::new(),
            frames: 0,
            unmarked: 0,
            mark: None,
            usual: 0,
            losses: Losses::default(),
            end: None,
            note,
            units_per_s,
            gap: 0,
            behind: 0,
        };
        while stream.channels == 0 || stream.hidden > 0 {
            if stream.end.is_some() {
                return Err(unreadable(if stream.channels == 0 {
                    "none of its sound could be decoded"
                } else {
                    "it ends before the place where its sound begins"
                }));
            }
            stream.step()?;
        }
        Ok(stream)
    }

    pub(in crate::audio) const fn sample_rate_hz(&self) -> u32 {
        self.sample_rate_hz
    }

    pub(in crate::audio) const fn channels(&self) -> usize {
        self.channels
    }

    pub(in crate::audio) fn encoding(&self) -> String {
        self.decoder.encoding()
    }

    pub(in crate::audio) const fn is_lossy(&self) -> bool {
        self.decoder.is_lossy
    }

    /// Adds the next samples of some channels to those of each; false at the end.
    pub(in crate::audio) fn append(
        &mut self,
        channels: &Range<usize>,
        samples: &mut [Vec<f32>],
    ) -> Result<bool, Error> {
        // What was decoded may yet get silence before it, by a mark.
        let settled = |s: &Self| {
            (s.unmarked == 0 || s.unmarked > MOST_UNMARKED) && (s.silence > 0 || s.has_samples())
        };
        while !settled(self) && self.end.is_none() {
            self.step()?;
        }
        if self.silence > 0 {
            let block = usize::try_from(self.silence.min(BLOCK)).unwrap_or(0);
            for channel in samples {
                channel.resize(channel.len() + block, 0.0);
            }
            self.silence -= block as u64;
            return Ok(true);
        }
        for (out, of) in samples.iter_mut().zip(&self.ready[channels.clone()]) {
            out.extend(of);
        }
        let any = self.has_samples();
        self.ready.iter_mut().for_each(Vec::clear);
        Ok(any)
    }

    fn has_samples(&self) -> bool {
        self.ready
            .first()
            .is_some_and(|channel| !channel.is_empty())
    }

    /// Takes what comes next in the container.
    fn step(&mut self) -> Result<(), Error> {
        match guarded(|| self.packets.next()).unwrap_or(Ok(Next::Cut))? {
            Next::Packet { packet, lost } => {
                if lost > 0 {
                    self.decoder.reset();
                    self.lose(lost);
                }
                let gap = std::mem::take(&mut self.gap);
                if gap > 0 {
                    self.lose(gap);
                }
                if self.end.is_none() {
                    self.decode(&packet);
                }
            }
            Next::Lost => self.decoder.reset(),
            Next::Mark(end) => self.place(end),
            Next::Anew { decoder, start } => {
                self.decoder = *decoder;
                self.hidden = start.hidden.frames(self.sample_rate_hz);
                self.mark = None;
            }
            end => self.end = Some(end),
        }
        Ok(())
    }

    /// Decodes a packet; what cannot be is silence for as long as it would have been.
    fn decode(&mut self, packet: &Packet) {
        let Some(decoded) = guarded(|| self.decoder.decode(packet)) else {
            self.end = Some(Next::Cut);
            return;
        };
        let Some(decoded) = decoded else {
            if self.marks {
                return;
            }
            let lasts = if self.usual > 0 {
                self.usual
            } else {
                packet.dur.get()
            };
            self.fall_behind(packet);
            return self.lose(lasts.min(MOST_PER_PACKET));
        };
        let (rate, mut planes) = (decoded.sample_rate_hz, decoded.planes);
        let (channels, frames) = (planes.len(), planes.first().map_or(0, Vec::len));
        if self.channels == 0 {
            (self.sample_rate_hz, self.channels) = (rate, channels);
            self.ready = vec![Vec::new(); channels];
            self.begin();
        } else if (rate, channels) != (self.sample_rate_hz, self.channels) {
            self.end = Some(Next::Changed);
            return;
        }
        self.usual = frames as u64;
        self.fall_behind(packet);
        let shown = self.shown(self.usual);
        let hidden = usize::try_from(self.usual - shown).unwrap_or(frames);
        for (ready, plane) in self.ready.iter_mut().zip(&mut planes) {
            plane.drain(..hidden.min(plane.len()));
            self.losses.not_finite += zero_what_is_not_finite(plane);
            ready.append(plane);
        }
        self.frames += shown;
        if self.marks {
            self.unmarked += shown;
        }
    }

    /// Counts how far the sound, of which this packet has as much as is usual, has fallen behind the time stamps: these may
    /// jitter, which is no gap.
    fn fall_behind(&mut self, packet: &Packet) {
        // Opus counts in an MP4 by the rate that it was made from, a part of its own.
        let rate = self.sample_rate_hz;
        let units = self.units_per_s.filter(|units| rate.is_multiple_of(*units));
        let Some(units) = units else {
            return;
        };
        let dur = packet.dur.get().saturating_mul(u64::from(rate / units));
        let dur = i64::try_from(dur).unwrap_or(i64::MAX);
        let usual = self.usual.cast_signed();
        let behind = self.behind.saturating_add(dur.saturating_sub(usual));
        self.behind = behind.max(-usual);
        if self.behind > usual / 2 {
            self.gap = std::mem::take(&mut self.behind).unsigned_abs();
        }
    }

    /// Goes to where the sound begins, once the sample rate is known.
    fn begin(&mut self) {
        let rate = self.sample_rate_hz;
        self.hidden = self.start.hidden.frames(rate);
        // What could not be decoded until now comes before it too.
        let shown = self.shown(self.silence);
        self.losses.frames = shown;
        if shown == 0 {
            self.losses.times = 0;
        }
        let later = self.start.later.frames(rate);
        let is_sane = later <= MOST_SILENCE_S * u64::from(rate);
        self.silence = shown + if is_sane { later } else { 0 };
        self.frames = self.silence;
    }

    /// How many of the next frames are not hidden.
    fn shown(&mut self, frames: u64) -> u64 {
        let hidden = self.hidden.min(frames);
        self.hidden -= hidden;
        frames - hidden
    }

    /// Silence for so many frames, before what is ready.
    fn lose(&mut self, frames: u64) {
        let hidden = self.hidden > 0;
        let frames = self.shown(frames);
        if hidden && frames == 0 {
            return;
        }
        // Before the first samples their rate is not known.
        let rate = u64::from(self.sample_rate_hz.max(8_000));
        if self.losses.frames + frames > MOST_SILENCE_S * rate {
            self.losses.too_long = true;
            self.end = Some(Next::End);
            self.frames -= self.unmarked;
            self.ready.iter_mut().for_each(Vec::clear);
            return;
        }
        if self.losses.times == 0 {
            self.losses.first = self.frames - self.unmarked;
        }
        self.losses.times += 1;
        self.losses.frames += frames;
        self.silence += frames;
        self.frames += frames;
    }

    /// What came since the last mark ends here: what is missing was lost before it.
    fn place(&mut self, end: u64) {
        if self.unmarked == 0 && self.mark.is_none() {
            // The headers of a stream have marks, which say nothing.
            return;
        }
        let due = self.mark.map(|mark| mark.saturating_add(self.unmarked));
        let missing = due.map_or(0, |due| end.saturating_sub(due));
        if missing > 0 {
            self.lose(missing);
        }
        self.cut(due.map_or(0, |due| due.saturating_sub(end)));
        self.mark = Some(end);
        self.unmarked = 0;
    }

    /// Takes away what an encoder put at the end of its last page; another stream may follow, which keeps its time.
    fn cut(&mut self, frames: u64) {
        let there = self.ready.first().map_or(0, Vec::len);
        let cut = usize::try_from(frames.min(self.unmarked)).map_or(there, |cut| cut.min(there));
        for channel in &mut self.ready {
            channel.truncate(there - cut);
        }
        self.frames -= cut as u64;
    }

    /// What is known after the last block.
    pub(in crate::audio) fn finish(self) -> Ending {
        let at = |frames: u64| real_s(frames, self.sample_rate_hz);
        let losses = &self.losses;
        let mut warnings = losses.warnings(self.sample_rate_hz, self.is_estimate);
        let ended = match &self.end {
            _ if losses.too_long => Some(format!(
                "more than {MOST_SILENCE_S} s of its sound are missing"
            )),
            Some(Next::Cut) => Some("the file is cut or broken".to_owned()),
            Some(Next::Changed) => {
                Some("the sample rate, the channels or the stream change".to_owned())
            }
            _ => None,
        };
        let ended = ended.map(|why| {
            format!(
                "{why} at {:.3} s; only what comes before was read",
                at(self.frames)
            )
        });
        warnings.extend(ended);
        Ending {
            duration_s: at(self.frames),
            warnings,
            tracks: self.note,
        }
    }
}
