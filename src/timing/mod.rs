//! Times below one sample.
//!
//! The recording is first [whitened](crate::signal::whiten), so that hum and rumble do not matter and the noise left is white. Then
//! each impact is timed by a constant fraction of its own rise, which does not walk with loudness, or all
//! are timed together (`joint`) by the sound that they have in common, which uses all of it.

mod joint;

use crate::signal::fraction;
use crate::signal::template::Template;
use crate::signal::whiten::Whitened;
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
    /// Onset of the sound in seconds from the start of the recording.
    pub time_s: f64,
    /// Standard error in seconds, without what all impacts of the drop share.
    pub std_s: f64,
}

/// Sound kept before and after each coarse time, in seconds: the jitter of the detector, the search, and the first
/// milliseconds of an impact, which hold most of its bandwidth.
const BEFORE_S: f64 = 3e-3;
const AFTER_S: f64 = 5e-3;

/// The times of the impacts of a drop, and the sound that they have in common.
#[derive(Debug, Clone)]
pub struct Refined {
    /// In the order of the coarse times.
    pub times: Vec<Timed>,
    /// What all were timed by; none where each was timed by itself.
    pub template: Option<Template>,
}

/// Times the impacts of one drop in its whitened sound, given coarse times in ascending order and how far off they may be.
///
/// Where a method fails on an impact (its window is cut by the end of the recording, or nothing rises in it) the coarse time
/// stays, with its error.
#[must_use]
pub fn refine(sound: &Whitened<'_>, coarse: &[Timed], timing: Timing) -> Refined {
    let together = match timing {
        Timing::Correlation => joint::times(sound, coarse),
        Timing::Envelope | Timing::Fraction => None,
    };
    if let Some((times, template)) = together {
        return Refined {
            times,
            template: Some(template),
        };
    }
    // One drop is timed in one way: what its impacts have in common then cancels.
    let times = match timing {
        Timing::Envelope => coarse.to_vec(),
        Timing::Fraction | Timing::Correlation => {
            let each = coarse.iter();
            each.map(|coarse| by_fraction(sound, coarse.time_s).unwrap_or(*coarse))
                .collect()
        }
    };
    Refined {
        times,
        template: None,
    }
}

/// The time of one impact by its own rise.
fn by_fraction(sound: &Whitened<'_>, time_s: f64) -> Option<Timed> {
    let rate = sound.sample_rate_hz();
    let centre = sound.sound().sample_at(time_s);
    let start = centre.checked_sub(samples_in(BEFORE_S, rate))?;
    let window = sound.between(start, centre + samples_in(AFTER_S, rate))?;
    let rise = fraction::time(&window, centre - start, rate)?;
    Some(Timed {
        time_s: sound.sound().time_s(real(start) + rise.position),
        std_s: rise.std / rate,
    })
}
