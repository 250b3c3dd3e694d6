//! Times below one sample.
//!
//! The recording is first [whitened](crate::signal::whiten), so that hum and rumble do not matter and the noise left is white. Then
//! each impact is timed by a [constant fraction](mod@fraction) of its own rise, which does not walk with loudness, or all
//! are timed together (`joint`) by the sound that they have in common, which uses all of it.

pub mod fraction;
mod joint;

use crate::signal::whiten::Whitener;
use crate::units::{real, samples_in};
use crate::words::words;

words! {
    /// How impacts are timed, from fastest to most exact.
    #[derive(Default)]
    #[non_exhaustive]
    pub enum Timing {
        /// The detector's own grid: a quarter of a millisecond, and free.
        Envelope = "envelope",
        /// Where the whitened sound first reaches a fixed fraction of its peak.
        Fraction = "fraction",
        /// Best match with the mean impact of the drop.
        #[default]
        Correlation = "correlation",
    }
}

/// A time with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timed {
    /// Seconds from the first sample to the onset of the sound.
    pub time_s: f64,
    /// Standard error in seconds, without what all impacts of the drop share.
    pub std_s: f64,
}

/// Sound kept before and after each coarse time, in seconds: the jitter of the detector, the search, and the first
/// milliseconds of an impact, which hold most of its bandwidth.
const BEFORE_S: f64 = 3e-3;
const AFTER_S: f64 = 5e-3;

/// The whitened sound around one impact.
#[derive(Debug, Clone)]
pub struct Window {
    /// Whitened samples, noise having unit variance.
    pub samples: Vec<f64>,
    /// Index in the recording of the first of them.
    pub start: usize,
    /// Index in the window nearest to the coarse time.
    pub coarse: usize,
}

/// Times the impacts of one drop, given coarse times in ascending order and how far off they may be.
///
/// The result is in the same order. Where a method fails on an impact (its window is cut by the end of the recording,
/// or nothing rises in it) the coarse time stays, with its error.
#[must_use]
pub fn refine(
    samples: &[f32],
    sample_rate_hz: f64,
    coarse: &[Timed],
    timing: Timing,
) -> Vec<Timed> {
    if timing == Timing::Envelope || coarse.is_empty() {
        return coarse.to_vec();
    }
    let coarse_s: Vec<f64> = coarse.iter().map(|t| t.time_s).collect();
    let whitener = Whitener::learn(samples, sample_rate_hz, &coarse_s);
    let together = if timing == Timing::Correlation {
        joint::times(samples, sample_rate_hz, coarse, &whitener)
    } else {
        None
    };
    // One drop is timed in one way: what its impacts have in common then cancels.
    together.unwrap_or_else(|| {
        let each = coarse.iter().map(|coarse| {
            by_fraction(samples, sample_rate_hz, coarse.time_s, &whitener).unwrap_or(*coarse)
        });
        each.collect()
    })
}

/// The time of one impact by its own rise.
fn by_fraction(
    samples: &[f32],
    sample_rate_hz: f64,
    time_s: f64,
    whitener: &Whitener,
) -> Option<Timed> {
    let window = window(samples, sample_rate_hz, time_s, whitener)?;
    let rise = fraction::time(&window, sample_rate_hz)?;
    Some(Timed {
        time_s: (real(window.start) + rise.position) / sample_rate_hz,
        std_s: rise.std / sample_rate_hz,
    })
}

fn window(
    samples: &[f32],
    sample_rate_hz: f64,
    time_s: f64,
    whitener: &Whitener,
) -> Option<Window> {
    let centre = samples_in(time_s, sample_rate_hz);
    let start = centre.checked_sub(samples_in(BEFORE_S, sample_rate_hz))?;
    let end = centre + samples_in(AFTER_S, sample_rate_hz);
    let whitened = whitener.apply(samples, start, end)?;
    Some(Window {
        samples: whitened,
        start,
        coarse: centre - start,
    })
}
