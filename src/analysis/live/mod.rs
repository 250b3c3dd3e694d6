//! Drops told while they are played.
//!
//! Twice a second the latest seconds are searched for chains, which is cheap. Where they show one that is over and was not
//! measured before, a longer window is searched, and what it shows is measured once; what is heard of it later is told as a
//! correction. Noise and a knock each second put nothing off: no scene has to end.

mod known;

use serde::Serialize;

use super::drop::Extent;
use super::few::Heard;
use super::listener::unlike;
use super::scene::{Bounds, Chained};
use super::{Listener, Settings};
use crate::Error;
use crate::detect::Detector;
use crate::detect::activity_gate::ActivityGate;
use crate::report::Drop;
use crate::sequence::{Chain, is_echo_of};
use crate::units::{frame_at, frame_time_s, frames, length, samples_in};
use crate::workers::Workers;
use known::{Known, Times};

/// The last seconds that are searched where the latest show something new. Convention: a drop of ten seconds with as much
/// around it.
const WINDOW_S: f64 = 20.0;
/// The latest seconds, which are searched each time: a chain is seen in them while its drop goes on and when it is over.
const LATEST_S: f64 = 6.0;
/// How often, in seconds. With [`RESTS_S`] a drop is told within a second of its last impact.
const EVERY_S: f64 = 0.5;
/// Most audio between two searches, in seconds, however much is handed over: who lags behind catches up.
const AT_ONCE_S: f64 = 2.0;
/// A drop is over after this time without an impact, in seconds …
const RESTS_S: f64 = 0.35;
/// … or after so many of its last flights: the next impact is late by half of a flight.
const LATE: f64 = 1.5;
/// Nothing is searched after this time without a rise, in seconds, as long as a drop's last impacts may be fainter than
/// what rises. A drop that is known to go on is.
const IDLE_S: f64 = 1.5;

/// A drop as it was heard so far.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Told {
    /// Its number, from 1; a drop of which more was heard is told again under it.
    pub number: usize,
    /// The drop; times are in seconds from the first sample.
    pub drop: Drop,
}

/// What is heard at the moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Hears {
    /// Nothing that rises.
    Nothing,
    /// Something that rises and is no drop so far.
    Something,
    /// A drop that goes on.
    Drop,
}

/// Listens to a sound as it is played, and tells each drop within a second of its last impact.
///
/// ```
/// use bounce_audio::{Live, Settings};
///
/// // A click every flight of a ball with e = 0.8, at 8 kHz.
/// let mut samples = vec![0.0_f32; 48_000];
/// let (mut at_s, mut flight_s) = (0.5, 0.5);
/// while flight_s > 0.01 {
///     samples[(at_s * 8_000.0) as usize] = 0.5;
///     at_s += flight_s;
///     flight_s *= 0.8;
/// }
///
/// let mut live = Live::new(1, 8_000.0, &Settings::default())?;
/// let mut told = Vec::new();
/// for block in samples.chunks(500) {
///     told.extend(live.hear(&[block])?);
/// }
/// assert_eq!(told.len(), 1);
/// assert!((told[0].drop.impacts[0].time_s - 0.5).abs() < 0.001);
/// # Ok::<(), bounce_audio::Error>(())
/// ```
#[derive(Debug)]
pub struct Live {
    settings: Settings,
    sample_rate_hz: f64,
    detector: Detector,
    gates: Vec<ActivityGate>,
    /// The last seconds of each channel, and the frame that they begin at.
    held: Vec<Vec<f32>>,
    from: u64,
    /// How many of the samples held were judged by the gates.
    judged: usize,
    /// The end of the last unit that something rose in.
    rose: Option<u64>,
    /// The end of what was searched last.
    searched: u64,
    /// Whether a drop that was found then went on.
    goes_on: bool,
    /// The chains that were measured, as long as their ends are in the window.
    known: Vec<Known>,
    /// How many drops were told.
    count: usize,
}

impl Live {
    /// A listener that heard nothing, to this many channels; of several the clearest is listened to. Where to start and to
    /// end has no meaning here.
    ///
    /// # Errors
    /// As for [`Listener::new`].
    pub fn new(channels: usize, sample_rate_hz: f64, settings: &Settings) -> Result<Self, Error> {
        let settings = settings.clone().start_s(None).end_s(None);
        Listener::new(channels, sample_rate_hz, &settings)?;
        let sample_rate_hz = sample_rate_hz * settings.time_scale;
        Ok(Self {
            settings,
            sample_rate_hz,
            detector: Detector::new(sample_rate_hz)?,
            gates: vec![ActivityGate::new(sample_rate_hz); channels],
            held: vec![Vec::new(); channels],
            from: 0,
            judged: 0,
            rose: None,
            searched: 0,
            goes_on: false,
            known: Vec::new(),
            count: 0,
        })
    }

    /// Listens to the next samples of each channel, full scale being ±1; gives the drops that are over, and those of which
    /// more was heard than was told.
    ///
    /// # Errors
    /// [`Error::Argument`] if there are more or fewer channels than announced or they differ in length.
    pub fn hear<C: AsRef<[f32]>>(&mut self, block: &[C]) -> Result<Vec<Told>, Error> {
        let length = block.first().map_or(0, |c| c.as_ref().len());
        if block.len() != self.held.len() || block.iter().any(|c| c.as_ref().len() != length) {
            return Err(unlike(block.len()));
        }
        let mut told = Vec::new();
        let at_once = samples_in(AT_ONCE_S, self.sample_rate_hz);
        for from in (0..length).step_by(at_once) {
            let part = from..length.min(from + at_once);
            for (held, channel) in self.held.iter_mut().zip(block) {
                held.extend_from_slice(&channel.as_ref()[part.clone()]);
            }
            self.judge();
            if self.is_due() {
                told.extend(self.search(false)?);
            }
        }
        Ok(told)
    }

    /// The drops that were not told so far, or not whole, because the sound ends here.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn finish(&mut self) -> Result<Vec<Told>, Error> {
        if self.held[0].is_empty() {
            return Ok(Vec::new());
        }
        self.search(true)
    }

    /// What is heard at the moment. While it is a drop, more of it will be told.
    #[must_use]
    pub fn hears(&self) -> Hears {
        match self.silent_from() {
            _ if self.goes_on => Hears::Drop,
            Some(silent) if self.end() < silent => Hears::Something,
            _ => Hears::Nothing,
        }
    }

    /// The last sound of each channel that reaches back to this time in seconds, or as far as is held, which is 20 s at
    /// least; and the time of its first sample.
    #[must_use]
    pub fn since(&self, time_s: f64) -> (f64, Vec<&[f32]>) {
        let from = frame_at(time_s, self.sample_rate_hz).clamp(self.from, self.end());
        let place = length(from - self.from);
        let channels = self.held.iter().map(|held| &held[place..]);
        (frame_time_s(from, self.sample_rate_hz), channels.collect())
    }

    fn end(&self) -> u64 {
        self.from + frames(self.held[0].len())
    }

    /// The frame from which on nothing is searched, unless something rises before.
    fn silent_from(&self) -> Option<u64> {
        let idle = frames(samples_in(IDLE_S, self.sample_rate_hz));
        self.rose.map(|rose| rose + idle)
    }

    fn judge(&mut self) {
        let unit = self.gates[0].unit();
        while self.held[0].len() - self.judged >= unit {
            let next = self.judged..self.judged + unit;
            let mut rises = false;
            for (gate, held) in self.gates.iter_mut().zip(&self.held) {
                // Each gate takes in every unit, also where another one rose.
                rises |= gate.rises(&held[next.clone()]);
            }
            self.judged += unit;
            if rises {
                self.rose = Some(self.from + frames(self.judged));
            }
        }
        // Moved only when as much again is there, so that a sample is copied once.
        let window = samples_in(WINDOW_S, self.sample_rate_hz);
        if self.held[0].len() >= 2 * window {
            let gone = (self.held[0].len() - window).min(self.judged);
            for held in &mut self.held {
                held.drain(..gone);
            }
            self.judged -= gone;
            self.from += frames(gone);
        }
    }

    /// Whether it is time to search: regularly while something is heard, and once when that has ended.
    fn is_due(&self) -> bool {
        let every = frames(samples_in(EVERY_S, self.sample_rate_hz));
        let ended = self.silent_from().is_some_and(|s| self.searched < s);
        (ended || self.goes_on) && self.end() - self.searched >= every
    }

    /// Searches the latest seconds, and all of the window where they show something new; where the sound ends here, all is
    /// over.
    fn search(&mut self, ends: bool) -> Result<Vec<Told>, Error> {
        self.searched = self.end();
        let now_s = frame_time_s(self.end(), self.sample_rate_hz);
        self.known
            .retain(|known| known.ends_after(now_s - WINDOW_S));
        let mut latest = self.chained(LATEST_S).found.drops;
        self.goes_on = latest.iter().any(|chain| is_open(chain, now_s));
        let is_last = ends || self.hears() == Hears::Nothing;
        keep_wanted(&mut latest, &self.known, now_s, ends);
        if latest.is_empty() && !is_last {
            return Ok(Vec::new());
        }
        let mut chained = self.chained(WINDOW_S);
        let chains = &mut chained.found.drops;
        let goes_on = chains.iter().any(|chain| is_open(chain, now_s));
        let latest = latest.iter().map(Times::of_chain);
        let unconfirmed = latest.filter(|l| !chains.iter().any(|c| l.is_same(&Times::of_chain(c))));
        let unconfirmed: Vec<Times> = unconfirmed.collect();
        // Two or three impacts count where there is no drop, once nothing follows them.
        let few = chains.is_empty() && is_last;
        keep_wanted(chains, &self.known, now_s, ends);
        let seen: Vec<Times> = chains.iter().map(Times::of_chain).collect();
        let drops = if seen.is_empty() && !few {
            Vec::new()
        } else {
            self.measured(chained, &seen, now_s)?
        };
        self.goes_on = goes_on;
        for times in unconfirmed {
            // It is not looked for again, unless it goes on.
            self.see(&times);
        }
        let is_over = |drop: &Drop| ends || is_over(&Times::of_drop(drop), now_s);
        Ok(self.tell_all(drops, &seen, is_over))
    }

    /// The drops of chains that were seen so.
    fn measured(
        &self,
        chained: Chained<'_>,
        seen: &[Times],
        now_s: f64,
    ) -> Result<Vec<Drop>, Error> {
        let reported_s = known::reported_s(&self.known, seen);
        let workers = Workers::default();
        let result = chained.measured(&reported_s, &self.detector, &self.settings, workers)?;
        let few = result.few.filter(Heard::is_enough);
        let measured = result.drops.into_iter().chain(few.map(|few| few.measured));
        let extent = Extent {
            first_channel: 0,
            end_s: now_s,
        };
        let drops = measured.map(|m| m.within(extent, &self.settings));
        drops.collect()
    }

    /// The chains of the last seconds held, not measured.
    fn chained(&self, last_s: f64) -> Chained<'_> {
        let last = frames(samples_in(last_s, self.sample_rate_hz));
        let first = self.end().saturating_sub(last).max(self.from);
        let held = self.held.iter();
        let channels: Vec<&[f32]> = held.map(|h| &h[length(first - self.from)..]).collect();
        let bounds = Bounds {
            first,
            listened_from: 0,
            cut: false,
        };
        Chained::of(&channels, &bounds, &self.detector, Workers::default())
    }

    /// What there is to tell of the drops that were measured, of chains as they were seen.
    fn tell_all(
        &mut self,
        drops: Vec<Drop>,
        seen: &[Times],
        is_over: impl Fn(&Drop) -> bool,
    ) -> Vec<Told> {
        let (over, open): (Vec<Drop>, Vec<Drop>) = drops.into_iter().partition(is_over);
        let told = over.into_iter().filter_map(|drop| self.tell(drop));
        let told = told.collect();
        // What turned out to go on is measured again once it is over.
        let goes_on = |seen: &Times| open.iter().any(|d| seen.is_same(&Times::of_drop(d)));
        for seen in seen.iter().filter(|seen| !goes_on(seen)) {
            self.see(seen);
        }
        told
    }

    /// What there is to tell of a drop that is over.
    fn tell(&mut self, drop: Drop) -> Option<Told> {
        let times = Times::of_drop(&drop);
        let place = self.see(&times);
        let known = &mut self.known[place];
        if !known.is_more(&times) {
            return None;
        }
        self.count += usize::from(known.number().is_none());
        let number = known.number().unwrap_or(self.count);
        known.tell(number, times);
        Some(Told { number, drop })
    }

    /// Where a chain is among those that were measured, from now on.
    fn see(&mut self, times: &Times) -> usize {
        let known = self.known.iter().position(|k| k.is_same(times));
        if let Some(place) = known {
            self.known[place].see(times);
            return place;
        }
        self.known.push(Known::new(times.clone()));
        self.known.len() - 1
    }
}

/// Keeps the chains that are to be measured: those that are over, that are no echo of another, and that say more than those
/// known.
fn keep_wanted(chains: &mut Vec<Chain>, known: &[Known], now_s: f64, ends: bool) {
    let is_wanted = |chain: &Chain| {
        let times = Times::of_chain(chain);
        let echoes =
            |other: &Chain| other.evidence() > chain.evidence() && is_echo_of(chain, other);
        (ends || is_over(&times, now_s))
            && known.iter().all(|k| k.is_news(&times))
            && !chains.iter().any(echoes)
    };
    let wanted: Vec<bool> = chains.iter().map(is_wanted).collect();
    let mut of_wanted = wanted.into_iter();
    chains.retain(|_| of_wanted.next().unwrap_or(false));
}

/// Whether impacts may follow those of a chain, at this time.
fn is_open(chain: &Chain, now_s: f64) -> bool {
    !is_over(&Times::of_chain(chain), now_s)
}

/// Whether no impact follows these, at this time.
fn is_over(times: &Times, now_s: f64) -> bool {
    let [.., before_s, last_s] = times.all_s() else {
        return true;
    };
    now_s - last_s >= RESTS_S.max(LATE * (last_s - before_s))
}

#[cfg(all(test, feature = "lab"))]
mod tests;
