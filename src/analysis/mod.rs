//! The whole way from samples to drops: `detect`, `sequence`, `timing`, `fit`.
//!
//! A [`Listener`] takes a recording of any length block by block; [`analyze`] gives it one that is in memory.

mod agreement;
mod bounce;
mod candidate;
mod course;
mod drop;
mod few;
mod findings;
mod first_rebound;
mod irregular;
mod labelled;
mod listener;
mod live;
mod louder_before;
mod model;
mod predict;
mod release;
mod scene;
mod stretch;
mod tail;
mod times;
mod warnings;

pub use crate::report::Settings;
pub use labelled::analyze_labelled;
#[cfg(feature = "cli")]
pub(crate) use listener::ALL_CHANNELS;
pub use listener::Listener;
pub use live::{Hears, Live, Told};
pub use predict::{Question, predict};
pub use times::fit_times;

use crate::Error;
use crate::report::{Analysis, RejectReason, Rejected};
use crate::sequence::{self, Reason};

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
fn rejected(event: &sequence::NonImpact) -> Rejected {
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
