//! Listening to a recording of any length as it comes, in bounded memory.
//!
//! An [activity gate](crate::detect::activity_gate) judges every quarter of a second. Where something rises a *scene* begins;
//! it ends once nothing has risen for a while, is [analyzed](super::scene) at once, or with others by many
//! [workers](Workers), and its audio is let go. A scene that outgrows the memory is analyzed as far as it goes: drops that
//! may go on past the cut are deferred to the rest.

mod held;

use std::mem;
use std::ops::Range;

use super::Settings;
use super::drop::Extent;
use super::findings::Findings;
use super::scene::{Bounds, Chained, SceneResult};
use crate::Error;
use crate::detect::Detector;
use crate::detect::activity_gate::ActivityGate;
use crate::report::Analysis;
use crate::units::{frame_at, frame_time_s, frames, length, real, samples_in};
use crate::workers::Workers;
use held::Held;

/// Audio before the first rise that belongs to a scene, in seconds: it shows the usual level.
const BEFORE_S: f64 = 1.0;
/// Audio after the last rise that belongs to a scene, in seconds: a drop's last impacts are fainter than what rises.
const AFTER_S: f64 = 1.5;
/// Time without a rise after which a scene is over, in seconds. Derived: a flight of 3 s rises 11 m.
const OVER_S: f64 = 3.0;
/// Most audio held, in bytes over all channels: with the working memory of one worker it stays below 64 MiB.
const HELD_BYTES: usize = 20 << 20;
/// Least audio held of any recording, in seconds: a drop has to fit. It exceeds [`HELD_BYTES`] only above 600,000 samples a
/// second over all channels.
const LEAST_HELD_S: f64 = 8.0;
/// Most samples a second over all channels, such as 32 channels at 48 kHz or two at 768: with [`LEAST_HELD_S`] of them and
/// the working memory of one worker it stays below 256 MiB. A header may claim 4 GHz.
const MOST_SAMPLES_PER_S: f64 = 1_536_000.0;

/// What there is too much of where listening to one channel would do: the command names its option for that.
pub(crate) const ALL_CHANNELS: &str = "sample rate of all channels together";

/// Listens to all channels of a recording, block after block.
///
/// ```
/// use bounce_audio::{Listener, Settings};
///
/// let mut listener = Listener::new(1, 8_000.0, &Settings::default())?;
/// for _ in 0..100 {
///     listener.push(&[vec![0.0_f32; 4_000]])?;
/// }
/// assert_eq!(listener.finish()?.1.warnings[0].code.word(), "silence");
/// # Ok::<(), bounce_audio::Error>(())
/// ```
#[derive(Debug)]
pub struct Listener {
    settings: Settings,
    sample_rate_hz: f64,
    /// Index in the recording of the first channel that is listened to.
    first_channel: usize,
    detector: Detector,
    gates: Vec<ActivityGate>,
    /// The frames that are listened to, counted from the start of the recording.
    listened: Range<u64>,
    /// Frames pushed so far.
    position: u64,
    held: Held,
    scene: Option<Rises>,
    /// Scenes that are over and wait to be analyzed.
    waiting: Vec<Scene>,
    /// Frames that may be held.
    most_held: usize,
    workers: Workers,
    findings: Findings,
}

/// A scene, and the audio that holds it.
#[derive(Debug)]
struct Scene {
    held: Held,
    frames: Range<u64>,
}

/// Range of the rises in the scene that goes on.
#[derive(Debug, Clone, Copy)]
struct Rises {
    /// First frame of the scene.
    from: u64,
    /// First frame after the last unit in which something rose.
    last: u64,
}

impl Listener {
    /// A listener to this many channels.
    ///
    /// # Errors
    /// [`Error::Argument`] for a setting out of range, no channels, a rate too low to listen at, or more samples a
    /// second than fit the memory.
    pub fn new(channels: usize, sample_rate_hz: f64, settings: &Settings) -> Result<Self, Error> {
        Self::to_channels(0..channels, sample_rate_hz, settings)
    }

    /// A listener to the channels of a recording with these indices, which are those of what it finds.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub(crate) fn to_channels(
        indices: Range<usize>,
        recorded_rate_hz: f64,
        settings: &Settings,
    ) -> Result<Self, Error> {
        settings.check()?;
        let sample_rate_hz = recorded_rate_hz * settings.time_scale;
        let channels = indices.len();
        if channels == 0 {
            return Err(Error::argument("channels", 0.0, "at least one"));
        }
        let together = sample_rate_hz * real(channels);
        if together > MOST_SAMPLES_PER_S {
            return Err(too_many_samples(together, channels));
        }
        let detector = Detector::new(sample_rate_hz)?;
        let frame = |time_s: f64| frame_at(time_s, recorded_rate_hz);
        let first = settings.start_s.map_or(0, frame);
        let budget = HELD_BYTES / size_of::<f32>() / channels;
        Ok(Self {
            detector,
            gates: vec![ActivityGate::new(sample_rate_hz); channels],
            listened: first..settings.end_s.map_or(u64::MAX, frame),
            position: 0,
            held: Held::new(channels, first),
            scene: None,
            waiting: Vec::new(),
            workers: Workers::default(),
            most_held: budget.max(samples_in(LEAST_HELD_S, sample_rate_hz)),
            findings: Findings::new(channels),
            settings: settings.clone(),
            sample_rate_hz,
            first_channel: indices.start,
        })
    }

    /// The listener with workers of another kind; it finds the same.
    pub(crate) fn with_workers(self, workers: Workers) -> Self {
        Self { workers, ..self }
    }

    /// Listens to the next samples of each channel, full scale being ±1. Blocks may be of any length; what is found
    /// does not depend on it.
    ///
    /// # Errors
    /// [`Error::Argument`] if there are more or fewer channels than expected or they differ in length.
    pub fn push<C: AsRef<[f32]>>(&mut self, block: &[C]) -> Result<(), Error> {
        let length = block.first().map_or(0, |c| c.as_ref().len());
        if block.len() != self.held.channels.len()
            || block.iter().any(|c| c.as_ref().len() != length)
        {
            return Err(unlike(block.len()));
        }
        // A long block is taken in by parts, so that no more than a scene of it is held.
        let unit = self.gates[0].unit();
        for from in (0..length).step_by(unit) {
            let part = from..length.min(from + unit);
            self.push_with(|room| {
                for (held, channel) in room.iter_mut().zip(block) {
                    held.extend_from_slice(&channel.as_ref()[part.clone()]);
                }
            })?;
        }
        Ok(())
    }

    /// As [`push`](Self::push), for samples that `read` adds to the end of those of each channel: what is decoded to
    /// where it is held needs no copy. It has to leave alone what is there. All that it adds is held at once.
    ///
    /// # Errors
    /// [`Error::Argument`] if it adds more to one channel than to another.
    pub fn push_with<T>(&mut self, read: impl FnOnce(&mut [Vec<f32>]) -> T) -> Result<T, Error> {
        let held = &mut self.held.channels;
        let before = held[0].len();
        let result = read(held);
        let end = held[0].len();
        if held.iter().any(|held| held.len() != end) {
            return Err(unlike(held.len()));
        }
        let read = end - before;
        let within = |frame: u64| length(frame.saturating_sub(self.position)).min(read);
        let (from, to) = (within(self.listened.start), within(self.listened.end));
        self.position += frames(read);
        for held in held {
            held.truncate(before + to);
            held.drain(before..(before + from).min(held.len()));
        }
        let unit = self.gates[0].unit();
        while self.held.unjudged() >= unit {
            self.judge(unit);
            self.let_go()?;
        }
        Ok(result)
    }

    /// The analysis, and the channel that most of it was heard on.
    ///
    /// # Errors
    /// [`Error::Argument`] if nothing of the recording is in the part that was to be listened to.
    pub fn finish(mut self) -> Result<(usize, Analysis), Error> {
        let end = self.held.end();
        if let Some(got) = self.settings.end_s
            && self.listened.is_empty()
        {
            let expected = "after the start by a sample or more";
            return Err(Error::argument("end", got, expected));
        }
        if end <= self.listened.start {
            let got = self.settings.start_s.unwrap_or(0.0);
            return Err(Error::argument("start", got, "a time within the recording"));
        }
        self.judge(self.held.unjudged());
        if let Some(rises) = self.scene.take() {
            let after = frame_at(AFTER_S, self.sample_rate_hz);
            self.put_off(rises.from..end.min(rises.last + after), end);
        }
        self.hear_waiting()?;
        let extent = self.extent();
        self.findings.analysis(extent, &self.settings)
    }

    /// What was listened to so far.
    fn extent(&self) -> Extent {
        Extent {
            first_channel: self.first_channel,
            end_s: frame_time_s(self.held.end(), self.sample_rate_hz),
        }
    }

    /// Has the gates judge the next frames.
    fn judge(&mut self, unit: usize) {
        let mut rises = false;
        for (gate, sound) in self.gates.iter_mut().zip(self.held.next(unit)) {
            // Each gate takes in every unit, also where another one rose.
            rises |= gate.rises(sound);
        }
        if rises {
            let before = samples_in(BEFORE_S, self.sample_rate_hz);
            let scene = self.scene.map(|scene| scene.from);
            let from = scene.unwrap_or_else(|| self.held.begin(before));
            let last = self.held.judged() + frames(unit);
            self.scene = Some(Rises { from, last });
        }
        self.held.judge(unit);
    }

    /// Lets audio go that is not needed any more, after it was analyzed if it is part of a scene.
    fn let_go(&mut self) -> Result<(), Error> {
        let span = |span_s| frame_at(span_s, self.sample_rate_hz);
        let (before, after, over) = (span(BEFORE_S), span(AFTER_S), span(OVER_S));
        let end = self.held.judged();
        match self.scene {
            None if end - self.held.from() >= before => self.held.set_aside(),
            Some(rises) if end - rises.last >= over => {
                self.scene = None;
                self.put_off(rises.from..rises.last + after, end - before);
            }
            Some(rises) if end - rises.from >= frames(self.most_held) => {
                self.hear_waiting()?;
                let heard = self.heard(&self.held, &(rises.from..end), true)?;
                let final_until = frame_at(heard.final_until_s, self.sample_rate_hz);
                let from = final_until.clamp(rises.from, end);
                self.findings.add(heard);
                self.scene = Some(Rises { from, ..rises });
                drop(self.held.split(from));
            }
            _ => {}
        }
        if self.is_full() {
            self.hear_waiting()?;
        }
        Ok(())
    }

    /// Leaves a scene that is over to be analyzed later, and goes on from a frame.
    fn put_off(&mut self, frames: Range<u64>, from: u64) {
        let held = self.held.split(from);
        self.waiting.push(Scene { held, frames });
    }

    /// Whether no scene may wait any longer: one worker has no use for several.
    fn is_full(&self) -> bool {
        let waiting = self.waiting.iter().map(|scene| &scene.held);
        let held = waiting.chain([&self.held]).map(|h| h.end() - h.from());
        !self.workers.are_many() || held.sum::<u64>() >= frames(self.most_held)
    }

    /// Analyzes the scenes that wait. They share no audio, [`OVER_S`] being more than [`AFTER_S`] and [`BEFORE_S`]: what is
    /// reported of one is none of the others' concern.
    fn hear_waiting(&mut self) -> Result<(), Error> {
        let waiting = mem::take(&mut self.waiting);
        let hear = |scene: Scene| self.heard(&scene.held, &scene.frames, false);
        for heard in self.workers.map(waiting, hear) {
            self.findings.add(heard?);
        }
        Ok(())
    }

    /// What is heard in a scene.
    fn heard(&self, held: &Held, scene: &Range<u64>, cut: bool) -> Result<SceneResult, Error> {
        let bounds = Bounds {
            first: scene.start,
            listened_from: self.listened.start,
            cut,
        };
        let channels = held.between(scene.start, scene.end);
        let from_s = frame_time_s(scene.start, self.sample_rate_hz);
        let reported_s = self.findings.reported_after(from_s);
        let (detector, workers) = (&self.detector, self.workers);
        let chained = Chained::of(&channels, &bounds, detector, workers);
        chained.measured(reported_s, detector, &self.settings, workers)
    }
}

/// The error of a block whose channels differ in number or length from those announced.
pub(super) fn unlike(channels: usize) -> Error {
    let expected = "as many as announced, all of one length";
    Error::argument("channels", real(channels), expected)
}

/// The error of more samples a second than are held.
fn too_many_samples(per_s: f64, channels: usize) -> Error {
    if channels == 1 {
        return Error::argument("sample rate", per_s, "1536000 Hz or less: resample it");
    }
    let expected = "1536000 Hz or less: listen to one of them, or resample it";
    Error::argument(ALL_CHANNELS, per_s, expected)
}

#[cfg(all(test, feature = "lab"))]
mod tests;
