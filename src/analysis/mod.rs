//! The whole way from samples to drops: detect, sequence, refine, fit.
//!
//! A [`Listener`] takes a recording of any length block by block; [`analyze`] gives it one that is in memory.

mod agreement;
mod bounce;
mod drop;
mod findings;
mod labelled;
mod listener;
mod model;
mod scene;
mod tail;
mod warnings;

pub use labelled::analyze_labelled;
pub use listener::Listener;

use std::ops::RangeInclusive;

use crate::Error;
use crate::detect::{self, Candidate};
use crate::fit::ladder;
use crate::report::{Analysis, RejectReason, Rejected, SettingsInfo};
use crate::sequence::{self, Chain, Event, Reason};
use crate::timing::{Timed, Timing, refine};
use crate::units::{real, samples_in};

/// What is known beforehand and how to listen.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Settings {
    /// From the ball's lowest point to the surface at release, in metres, if known. It applies to every drop.
    pub height_m: Option<f64>,
    /// Standard error of the height in metres. Default 1 mm: a ruler read by eye.
    pub height_std_m: f64,
    /// Gravity in m/s². Default 9.81.
    pub gravity_m_per_s2: f64,
    /// Mass of the ball in kg, if known: with the diameter it gives the drag of the air, with a contact time k and c.
    pub mass_kg: Option<f64>,
    /// Diameter of the ball in metres, if known.
    pub diameter_m: Option<f64>,
    /// Time in contact at each impact in seconds, if known, taken to be right within 5 %.
    pub contact_time_s: Option<f64>,
    /// The model of the intervals. Default: as far up the ladder as the recording supports.
    pub model: ladder::Choice,
    /// Listen from here, in seconds. Default: the start.
    pub start_s: Option<f64>,
    /// Listen up to here, in seconds. Default: the end.
    pub end_s: Option<f64>,
    /// How impacts are timed. Default: correlation.
    pub timing: Timing,
    /// How candidates are found.
    pub detect: detect::Settings,
    /// What is known of balls.
    pub sequence: sequence::Settings,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            height_m: None,
            height_std_m: 1e-3,
            gravity_m_per_s2: 9.81,
            mass_kg: None,
            diameter_m: None,
            contact_time_s: None,
            model: ladder::Choice::Auto,
            start_s: None,
            end_s: None,
            timing: Timing::default(),
            detect: detect::Settings::default(),
            sequence: sequence::Settings::default(),
        }
    }
}

impl Settings {
    /// What a document says of them.
    #[must_use]
    pub const fn info(&self) -> SettingsInfo {
        SettingsInfo {
            height_m: self.height_m,
            height_std_m: self.height_std_m,
            gravity_m_per_s2: self.gravity_m_per_s2,
            mass_kg: self.mass_kg,
            diameter_m: self.diameter_m,
            contact_time_s: self.contact_time_s,
            model: self.model,
            start_s: self.start_s,
            end_s: self.end_s,
            timing: self.timing,
        }
    }

    /// Whether the settings mean something, whatever the recording. Ranges reach far beyond any ball, and stay where no
    /// product of settings leaves those of the physics.
    ///
    /// # Errors
    /// [`Error::Argument`] for the first that is out of range.
    pub fn check(&self) -> Result<(), Error> {
        let within = |name, value: Option<f64>, range: RangeInclusive<f64>, expected| match value {
            Some(value) if !range.contains(&value) => Err(Error::argument(name, value, expected)),
            _ => Ok(()),
        };
        let gravity = Some(self.gravity_m_per_s2);
        within("gravity", gravity, 1e-3..=1e6, "0.001 to 1000000 m/s²")?;
        within("height", self.height_m, 1e-6..=1e4, "1 µm to 10 km")?;
        let height_error = Some(self.height_std_m);
        within("height error", height_error, 0.0..=1e4, "0 to 10 km")?;
        within("mass", self.mass_kg, 1e-9..=1e6, "1 µg to 1000 t")?;
        within("diameter", self.diameter_m, 1e-6..=1e3, "1 µm to 1 km")?;
        let contact_time = self.contact_time_s;
        within("contact time", contact_time, 1e-9..=1.0, "1 ns to 1 s")?;
        within("start", self.start_s, 0.0..=f64::MAX, "0 s or more")?;
        within("end", self.end_s, 0.0..=f64::MAX, "0 s or more")?;
        match (self.start_s, self.end_s) {
            (Some(start), Some(end)) if end <= start => {
                Err(Error::argument("end", end, "after the start"))
            }
            _ => Ok(()),
        }
    }
}

/// Standard error of a time on the detector's grid, in hops: a uniform error of one hop either way.
const GRID_ERROR: f64 = 0.58;

/// The stretch of a channel that is analyzed. All times outside it count from the start of the recording.
#[derive(Debug, Clone, Copy)]
struct Stretch<'a> {
    samples: &'a [f32],
    sample_rate_hz: f64,
    start_s: f64,
    /// Where listening began; the stretch may begin later.
    listened_from_s: f64,
    /// The grid of the detector.
    hop_s: f64,
}

impl<'a> Stretch<'a> {
    fn end_s(&self) -> f64 {
        self.start_s + real(self.samples.len()) / self.sample_rate_hz
    }

    /// Candidates, whose times count from the start of the stretch, as events of the recording.
    fn events(&self, candidates: &[Candidate]) -> Vec<Event> {
        let event = |c: &Candidate| Event {
            time_s: self.start_s + c.time_s,
            jitter_s: c.jitter_s,
            strength: c.strength,
        };
        candidates.iter().map(event).collect()
    }

    /// The heard impacts of a chain, in seconds of the stretch.
    fn timed(&self, chain: &Chain, timing: Timing) -> Vec<Timed> {
        let heard = chain.links.iter().filter(|l| l.event.is_some());
        let coarse = heard.map(|l| Timed {
            time_s: l.time_s - self.start_s,
            std_s: l.jitter_s.max(GRID_ERROR * self.hop_s),
        });
        let coarse: Vec<Timed> = coarse.collect();
        refine(self.samples, self.sample_rate_hz, &coarse, timing)
    }

    /// The samples between two times of the recording, as far as they are in the stretch.
    fn between(&self, from_s: f64, to_s: f64) -> &'a [f32] {
        let at = |t: f64| samples_in(t - self.start_s, self.sample_rate_hz).min(self.samples.len());
        &self.samples[at(from_s)..at(to_s).max(at(from_s))]
    }
}

/// Listens to one channel: samples of full scale ±1 at a rate in Hz.
///
/// ```
/// use bounce_audio::analysis::{Settings, analyze};
///
/// // A click every flight of a ball with e = 0.8, at 8 kHz.
/// let mut samples = vec![0.0_f32; 32_000];
/// let (mut at_s, mut flight_s) = (0.5, 0.5);
/// while flight_s > 0.01 {
///     samples[(at_s * 8_000.0) as usize] = 0.5;
///     at_s += flight_s;
///     flight_s *= 0.8;
/// }
/// let analysis = analyze(&samples, 8_000.0, &Settings::default())?;
/// let e = analysis.drops[0].restitution.as_ref().map(|r| r.estimate.value);
/// assert!((e.unwrap_or(0.0) - 0.8).abs() < 0.002);
/// # Ok::<(), bounce_audio::Error>(())
/// ```
///
/// # Errors
/// [`Error::Argument`] for a setting out of range or a rate too low to listen at.
pub fn analyze(
    samples: &[f32],
    sample_rate_hz: f64,
    settings: &Settings,
) -> Result<Analysis, Error> {
    analyze_clearest(&[samples], sample_rate_hz, settings).map(|(_, analysis)| analysis)
}

/// Listens to the clearest of several channels, scene by scene; gives the index of the one that most was heard on too.
/// See [`detect::clarity`].
///
/// # Errors
/// As [`analyze`]; [`Error::Argument`] if there are no channels.
pub fn analyze_clearest<C: AsRef<[f32]>>(
    channels: &[C],
    sample_rate_hz: f64,
    settings: &Settings,
) -> Result<(usize, Analysis), Error> {
    let mut listener = Listener::new(channels.len(), sample_rate_hz, settings)?;
    listener.push(channels)?;
    listener.finish()
}

/// An event's reason in words.
fn rejected(event: &sequence::Rejected) -> Rejected {
    let (reason, detail) = match event.reason {
        Reason::Echo { delay_s } => (
            RejectReason::Echo,
            format!(
                "follows many impacts by {:.1} ms: an echo or a part of their sound",
                1e3 * delay_s
            ),
        ),
        Reason::Near { offset_s } if offset_s < 0.0 => {
            (RejectReason::NearImpact, "just before an impact".to_owned())
        }
        Reason::Near { .. } => (
            RejectReason::NearImpact,
            "within 5 ms after an impact: its own sound".to_owned(),
        ),
        Reason::BetweenImpacts => (
            RejectReason::OffSequence,
            "between two impacts, where no flight ends".to_owned(),
        ),
        Reason::NoSequence => (
            RejectReason::NoSequence,
            "belongs to no sequence of shrinking flights".to_owned(),
        ),
    };
    Rejected {
        time_s: event.time_s,
        reason,
        detail,
    }
}
