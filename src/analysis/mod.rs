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

pub use crate::report::Settings;
pub use labelled::analyze_labelled;
pub use listener::Listener;

use crate::Error;
use crate::detect::Candidate;
use crate::report::{Analysis, RejectReason, Rejected};
use crate::sequence::{self, Chain, Event, Reason};
use crate::signal::whiten::Whitened;
use crate::timing::{Refined, Timed, Timing, refine};
use crate::units::{real, samples_in};

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

    /// The sound that a chain is timed in.
    fn whitened(&self, chain: &Chain) -> Whitened<'a> {
        let (first_s, last_s) = chain.span_s();
        let span_s = (first_s - self.start_s, last_s - self.start_s);
        Whitened::around(self.samples, self.sample_rate_hz, span_s)
    }

    /// The heard impacts of a chain, in seconds of the stretch.
    fn timed(&self, chain: &Chain, sound: &Whitened<'_>, timing: Timing) -> Refined {
        let heard = chain.links.iter().filter(|l| l.event.is_some());
        let coarse = heard.map(|l| Timed {
            time_s: l.time_s - self.start_s,
            std_s: l.jitter_s.max(GRID_ERROR * self.hop_s),
        });
        let coarse: Vec<Timed> = coarse.collect();
        refine(sound, &coarse, timing)
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
/// use bounce_audio::{Settings, analyze};
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
/// See `detect::clarity`.
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
