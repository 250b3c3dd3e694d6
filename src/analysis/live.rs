//! Drops told while they are played.
//!
//! A [`Listener`](super::Listener) waits for the end of a scene, which noise or a knock each second puts off. Here the last
//! seconds are analyzed again and again, and what was told before is told by the impacts that both have in common.

use serde::Serialize;

use super::{Settings, analyze};
use crate::Error;
use crate::detect::activity_gate::ActivityGate;
use crate::report::{Drop, Restitution};
use crate::units::{frame_time_s, frames, samples_in};

/// The last seconds that are heard again. Convention: a drop of ten seconds with as much around it.
const WINDOW_S: f64 = 20.0;
/// How often, in seconds. With [`RESTS_S`] a drop is told within a second of its last impact.
const EVERY_S: f64 = 0.5;
/// Most audio between two hearings, in seconds, however much is handed over: who lags behind catches up.
const AT_ONCE_S: f64 = 2.0;
/// A drop is over after this time without an impact, in seconds …
const RESTS_S: f64 = 0.35;
/// … or after so many of its last flights: the next impact is late by half of a flight.
const LATE: f64 = 1.5;
/// Nothing is heard again after this time without a rise, in seconds, as long as a drop's last impacts may be fainter than
/// what rises. A drop that is known to go on is.
const IDLE_S: f64 = 1.5;
/// Impacts of two hearings that are nearer than this are one, in seconds. A flight is longer.
const SAME_S: f64 = 2e-3;

/// A drop as it was heard so far.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Told {
    /// Its number, from 1; a drop of which more was heard is told again under it.
    pub number: usize,
    /// Its first impact, in seconds from the first sample.
    pub first_s: f64,
    /// Its last impact.
    pub last_s: f64,
    /// How many impacts were heard.
    pub bounces: usize,
    /// The answer so far.
    pub restitution: Option<Restitution>,
}

/// Listens to one channel as it is played, and tells each drop as soon as it is over.
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
/// let mut live = Live::new(8_000.0, &Settings::default())?;
/// let mut told = Vec::new();
/// for block in samples.chunks(500) {
///     told.extend(live.hear(block)?);
/// }
/// assert_eq!(told.len(), 1);
/// assert!((told[0].first_s - 0.5).abs() < 0.001);
/// # Ok::<(), bounce_audio::Error>(())
/// ```
#[derive(Debug)]
pub struct Live {
    settings: Settings,
    sample_rate_hz: f64,
    gate: ActivityGate,
    /// The last seconds, and the frame that they begin at.
    held: Vec<f32>,
    from: u64,
    /// How many of the samples held were judged by the gate.
    judged: usize,
    /// The end of the last unit that something rose in, and of what was heard last.
    rose: Option<u64>,
    heard: u64,
    /// Whether a drop that was found then went on.
    goes_on: bool,
    /// Times of the impacts of each drop that was told.
    told: Vec<Vec<f64>>,
}

impl Live {
    /// A listener that heard nothing. Where to start and to end has no meaning here.
    ///
    /// # Errors
    /// [`Error::Argument`] for a setting out of range or a rate too low to listen at.
    pub fn new(sample_rate_hz: f64, settings: &Settings) -> Result<Self, Error> {
        let settings = settings.clone().start_s(None).end_s(None);
        super::Listener::new(1, sample_rate_hz, &settings)?;
        Ok(Self {
            settings,
            sample_rate_hz,
            gate: ActivityGate::new(sample_rate_hz),
            held: Vec::new(),
            from: 0,
            judged: 0,
            rose: None,
            heard: 0,
            goes_on: false,
            told: Vec::new(),
        })
    }

    /// Listens to the next samples, full scale being ±1; gives the drops that are over, and those of which more was heard
    /// than was told.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn hear(&mut self, samples: &[f32]) -> Result<Vec<Told>, Error> {
        let mut told = Vec::new();
        let at_once = samples_in(AT_ONCE_S, self.sample_rate_hz);
        for part in samples.chunks(at_once) {
            self.held.extend_from_slice(part);
            self.judge();
            if self.is_due() {
                told.extend(self.listen()?);
            }
        }
        Ok(told)
    }

    /// Whether a drop may be going on: what is told of a drop then is not the last word.
    #[must_use]
    pub fn hears_something(&self) -> bool {
        let idle = frames(samples_in(IDLE_S, self.sample_rate_hz));
        self.goes_on || self.rose.is_some_and(|rose| self.end() - rose < idle)
    }

    fn end(&self) -> u64 {
        self.from + frames(self.held.len())
    }

    fn judge(&mut self) {
        let unit = self.gate.unit();
        while self.held.len() - self.judged >= unit {
            let rises = self.gate.rises(&self.held[self.judged..self.judged + unit]);
            self.judged += unit;
            if rises {
                self.rose = Some(self.from + frames(self.judged));
            }
        }
        // Moved only when as much again is there, so that a sample is copied once.
        let window = samples_in(WINDOW_S, self.sample_rate_hz);
        if self.held.len() >= 2 * window {
            let gone = (self.held.len() - window).min(self.judged);
            self.held.drain(..gone);
            self.judged -= gone;
            self.from += frames(gone);
        }
    }

    fn is_due(&self) -> bool {
        let every = frames(samples_in(EVERY_S, self.sample_rate_hz));
        self.hears_something() && self.end() - self.heard >= every
    }

    /// Analyzes the last seconds.
    fn listen(&mut self) -> Result<Vec<Told>, Error> {
        self.heard = self.end();
        let window = samples_in(WINDOW_S, self.sample_rate_hz);
        let first = self.held.len().saturating_sub(window);
        let analysis = analyze(&self.held[first..], self.sample_rate_hz, &self.settings)?;
        let from_s = frame_time_s(self.from + frames(first), self.sample_rate_hz);
        let end_s = frame_time_s(self.end(), self.sample_rate_hz);
        let times = |drop: &Drop| -> Vec<f64> {
            let impacts = drop.impacts.iter();
            impacts.map(|i| from_s + i.time_s).collect()
        };
        let mut drops: Vec<(Vec<f64>, &Drop)> =
            analysis.drops.iter().map(|d| (times(d), d)).collect();
        let heard = drops.len();
        drops.retain(|(times, _)| is_over(times, end_s));
        self.goes_on = drops.len() < heard;
        let told = drops.into_iter();
        Ok(told.filter_map(|(times, d)| self.tell(d, times)).collect())
    }

    /// What there is to tell of a drop that is over, with these impacts.
    fn tell(&mut self, drop: &Drop, times: Vec<f64>) -> Option<Told> {
        let known = self.told.iter().position(|told| is_same(told, &times));
        // What begins before the window has fewer impacts than were told.
        if known.is_some_and(|known| times.len() <= self.told[known].len()) {
            return None;
        }
        let place = known.unwrap_or(self.told.len());
        self.told.resize(self.told.len().max(place + 1), Vec::new());
        let told = Told {
            number: place + 1,
            first_s: *times.first()?,
            last_s: *times.last()?,
            bounces: drop.bounces,
            restitution: drop.restitution.clone(),
        };
        self.told[place] = times;
        Some(told)
    }
}

/// Whether no impact follows these, at this time.
fn is_over(times: &[f64], now_s: f64) -> bool {
    let [.., before_s, last_s] = times else {
        return true;
    };
    now_s - last_s >= RESTS_S.max(LATE * (last_s - before_s))
}

/// Whether two hearings are of one drop: half of the impacts of the shorter are those of the other.
fn is_same(told: &[f64], times: &[f64]) -> bool {
    let is_told = |time_s: &&f64| told.iter().any(|t| (t - **time_s).abs() < SAME_S);
    let common = times.iter().filter(is_told).count();
    2 * common >= told.len().min(times.len())
}

#[cfg(all(test, feature = "lab"))]
mod tests {
    use super::*;
    use crate::synth::presets::preset;
    use crate::synth::render;

    const RATE_HZ: f64 = 44_100.0;

    /// Half a minute of hiss with a steel ball at 2 s and at 13 s, and a knock each second or none.
    fn played(knocks: bool) -> Vec<f32> {
        let drop = render(&preset("steel").unwrap(), 1).unwrap().samples;
        let mut random = crate::random::SplitMix64::new(7);
        let mut samples: Vec<f32> = (0..30 * 44_100)
            .map(|_| crate::units::narrow(3e-4 * random.normal()))
            .collect();
        for start_s in [2.0, 13.0] {
            let from = samples_in(start_s, RATE_HZ);
            samples[from..]
                .iter_mut()
                .zip(&drop)
                .for_each(|(x, y)| *x += 0.7 * y);
        }
        for second in (0..30).filter(|_| knocks) {
            let from = samples_in(f64::from(second) + 0.37, RATE_HZ);
            for (i, x) in samples[from..].iter_mut().take(2_000).enumerate() {
                let ring = (0.13 * i as f32).sin() * (-(i as f32) / 300.0).exp();
                *x += 0.05 * ring;
            }
        }
        samples
    }

    #[test]
    fn each_drop_is_told_once_and_within_a_second() {
        for knocks in [false, true] {
            let samples = played(knocks);
            let settings = Settings::default();
            let whole = analyze(&samples, RATE_HZ, &settings).unwrap();
            assert_eq!(whole.drops.len(), 2);
            let mut live = Live::new(RATE_HZ, &settings).unwrap();
            let mut told = Vec::new();
            for (n, block) in samples.chunks(2_048).enumerate() {
                let at_s = (n + 1) as f64 * 2_048.0 / RATE_HZ;
                told.extend(live.hear(block).unwrap().into_iter().map(|t| (at_s, t)));
            }
            let numbers: Vec<usize> = told.iter().map(|(_, told)| told.number).collect();
            assert_eq!(numbers, [1, 2], "knocks: {knocks}, {told:?}");
            for ((at_s, told), drop) in told.iter().zip(&whole.drops) {
                let last_s = drop.impacts.last().unwrap().time_s;
                assert!((told.last_s - last_s).abs() < 0.05, "{told:?} {last_s}");
                assert!(
                    at_s - told.last_s < 1.0,
                    "told after {}",
                    at_s - told.last_s
                );
                let [e, of_whole] =
                    [&told.restitution, &drop.restitution].map(|r| r.as_ref().unwrap().estimate);
                let off = (e.value - of_whole.value).abs();
                assert!(off < of_whole.std_error.unwrap(), "{e:?} {of_whole:?}");
            }
        }
    }

    #[test]
    fn silence_is_not_heard_again() {
        let mut live = Live::new(RATE_HZ, &Settings::default()).unwrap();
        assert!(live.hear(&vec![0.0; 44_100 * 50]).unwrap().is_empty());
        assert_eq!(live.heard, 0);
        assert!(live.held.len() <= 2 * samples_in(WINDOW_S, RATE_HZ));
    }
}
