//! Listening to a recording of any length as it comes, in bounded memory.
//!
//! A cheap [watch](crate::detect::quiet) judges every quarter of a second. Where something rises a *scene* begins; it
//! ends once nothing has risen for a while, is [analyzed](super::scene) at once, and its audio is let go. A scene that
//! outgrows the memory is analyzed as far as it goes: drops that may go on past the cut wait for the rest.

use super::Settings;
use super::findings::Findings;
use super::scene::{Bounds, hear};
use crate::Error;
use crate::detect::Detector;
use crate::detect::quiet::Watch;
use crate::report::Analysis;
use crate::units::{real, samples_in};

/// Audio before the first rise that belongs to a scene, in seconds: it shows what is usual here.
const BEFORE_S: f64 = 1.0;
/// Audio after the last rise that belongs to a scene, in seconds: a drop's last impacts are fainter than what rises.
const AFTER_S: f64 = 1.5;
/// A scene is over once nothing has risen for so long, in seconds: no flight takes as long.
const OVER_S: f64 = 3.0;
/// Audio that is held at most, in bytes over all channels: with the working memory of the analysis it stays below
/// 64 MiB.
const HELD_BYTES: usize = 20 << 20;
/// But so much is held of any recording, in seconds: a drop has to fit. Only above 600,000 samples a second over all
/// channels is that more than [`HELD_BYTES`].
const LEAST_HELD_S: f64 = 8.0;

/// Listens to all channels of a recording, block after block.
///
/// ```
/// use bounce_audio::analysis::{Listener, Settings};
///
/// let mut listener = Listener::new(1, 8_000.0, &Settings::default())?;
/// for _ in 0..100 {
///     listener.push(&[vec![0.0_f32; 4_000]])?;
/// }
/// assert_eq!(listener.finish()?.1.warnings[0].code, "silence");
/// # Ok::<(), bounce_audio::Error>(())
/// ```
#[derive(Debug)]
pub struct Listener {
    settings: Settings,
    sample_rate_hz: f64,
    detector: Detector,
    watches: Vec<Watch>,
    /// The frames that are listened to, counted from the start of the recording.
    listened: std::ops::Range<usize>,
    /// Frames pushed so far.
    position: usize,
    /// The audio held, channel by channel; its first frame is `held_from`, and `judged` is where the watches stand.
    held: Vec<Vec<f32>>,
    held_from: usize,
    judged: usize,
    scene: Option<Rises>,
    /// Frames that may be held.
    most_held: usize,
    findings: Findings,
}

/// Where things rise in the scene that goes on.
#[derive(Debug, Clone, Copy)]
struct Rises {
    /// First frame of the scene.
    from: usize,
    /// First frame after the last unit in which something rose.
    last: usize,
}

impl Listener {
    /// A listener to this many channels.
    ///
    /// # Errors
    /// [`Error::Argument`] for a setting out of range, no channels, or a rate too low to listen at.
    pub fn new(channels: usize, sample_rate_hz: f64, settings: &Settings) -> Result<Self, Error> {
        settings.check()?;
        if channels == 0 {
            return Err(Error::argument("channels", 0.0, "at least one"));
        }
        let detector = Detector::new(sample_rate_hz, &settings.detect)?;
        let frames = |time_s: f64| samples_in(time_s, sample_rate_hz);
        let first = settings.start_s.map_or(0, frames);
        let budget = HELD_BYTES / size_of::<f32>() / channels;
        Ok(Self {
            detector,
            watches: vec![Watch::new(sample_rate_hz); channels],
            listened: first..settings.end_s.map_or(usize::MAX, frames),
            position: 0,
            held: vec![Vec::new(); channels],
            held_from: first,
            judged: first,
            scene: None,
            most_held: budget.max(frames(LEAST_HELD_S)),
            findings: Findings::new(channels),
            settings: settings.clone(),
            sample_rate_hz,
        })
    }

    /// Listens to the next samples of each channel, full scale being ±1. Blocks may be of any length; what is found
    /// does not depend on it.
    ///
    /// # Errors
    /// [`Error::Argument`] if there are more or fewer channels than expected or they differ in length.
    pub fn push<C: AsRef<[f32]>>(&mut self, block: &[C]) -> Result<(), Error> {
        let length = block.first().map_or(0, |c| c.as_ref().len());
        if block.len() != self.held.len() || block.iter().any(|c| c.as_ref().len() != length) {
            let expected = "as many as announced, all of one length";
            return Err(Error::argument("channels", real(block.len()), expected));
        }
        let within = |frame: usize| frame.saturating_sub(self.position).min(length);
        let (mut from, to) = (within(self.listened.start), within(self.listened.end));
        self.position += length;
        let unit = self.watches[0].unit();
        while from < to {
            let end = to.min(from + unit - self.waiting());
            for (held, channel) in self.held.iter_mut().zip(block) {
                held.extend_from_slice(&channel.as_ref()[from..end]);
            }
            from = end;
            if self.waiting() == unit {
                self.judge();
                self.let_go()?;
            }
        }
        Ok(())
    }

    /// What was heard, and the channel that most of it was heard on.
    ///
    /// # Errors
    /// [`Error::Argument`] if the recording ended before the part that was to be listened to.
    pub fn finish(mut self) -> Result<(usize, Analysis), Error> {
        let end = self.held_end();
        if end <= self.listened.start {
            let got = self.settings.start_s.unwrap_or(0.0);
            return Err(Error::argument("start", got, "a time within the recording"));
        }
        self.judge();
        if let Some(rises) = self.scene.take() {
            let after = samples_in(AFTER_S, self.sample_rate_hz);
            self.hear(rises.from, end.min(rises.last + after), false)?;
        }
        let end_s = real(end) / self.sample_rate_hz;
        Ok(self.findings.analysis(end_s))
    }

    /// First frame after what is held.
    fn held_end(&self) -> usize {
        self.held_from + self.held[0].len()
    }

    /// Frames that the watches have not judged yet.
    fn waiting(&self) -> usize {
        self.held_end() - self.judged
    }

    /// Has the watches judge what waits.
    fn judge(&mut self) {
        let begin = self.judged - self.held_from;
        let mut rises = false;
        for (watch, held) in self.watches.iter_mut().zip(&self.held) {
            // Every watch has to hear everything.
            rises |= watch.rises(held, begin);
        }
        if rises {
            let before = samples_in(BEFORE_S, self.sample_rate_hz);
            let from = self.judged.saturating_sub(before).max(self.held_from);
            let last = self.held_end();
            self.scene = Some(Rises {
                from: self.scene.map_or(from, |scene| scene.from),
                last,
            });
        }
        self.judged = self.held_end();
    }

    /// Lets audio go that is not needed any more, after it was analyzed if it is part of a scene.
    fn let_go(&mut self) -> Result<(), Error> {
        let frames = |span_s| samples_in(span_s, self.sample_rate_hz);
        let (before, after, over) = (frames(BEFORE_S), frames(AFTER_S), frames(OVER_S));
        let end = self.held_end();
        match self.scene {
            // Moving the margin costs as much as the audio let go: so that is done seldom.
            None if end - self.held_from > 3 * before => self.forget(end - before),
            Some(rises) if end - rises.last >= over => {
                self.scene = None;
                self.hear(rises.from, rises.last + after, false)?;
                self.forget(end - before);
            }
            Some(rises) if end - rises.from >= self.most_held => {
                let settled = self.hear(rises.from, end, true)?;
                self.scene = Some(Rises {
                    from: settled,
                    ..rises
                });
                self.forget(settled);
            }
            _ => {}
        }
        Ok(())
    }

    fn forget(&mut self, before: usize) {
        for held in &mut self.held {
            held.drain(..before - self.held_from);
        }
        self.held_from = before;
    }

    /// Analyzes a scene; gives the frame up to which that is settled.
    fn hear(&mut self, from: usize, to: usize, cut: bool) -> Result<usize, Error> {
        let bounds = Bounds {
            first: from,
            listened_from: self.listened.start,
            cut,
        };
        let part = from - self.held_from..to - self.held_from;
        let channels: Vec<&[f32]> = self.held.iter().map(|held| &held[part.clone()]).collect();
        let told_s = self.findings.told_after(real(from) / self.sample_rate_hz);
        let heard = hear(&channels, &bounds, told_s, &self.detector, &self.settings)?;
        let settled = samples_in(heard.settled_s, self.sample_rate_hz).clamp(from, to);
        self.findings.add(heard);
        Ok(settled)
    }
}

#[cfg(test)]
mod tests;
