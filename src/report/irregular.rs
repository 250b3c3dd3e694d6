//! One irregular bounce as data, and as a sentence.

use serde::{Deserialize, Serialize};

use super::numbers::with_error;
use crate::fit::Estimate;
pub use crate::fit::irregular::Kind;

/// A bounce that does not go by the e of the others.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Irregular {
    /// Number of the impact, from 1.
    pub impact: usize,
    /// Its time in seconds from the first sample.
    pub time_s: f64,
    /// How it is irregular.
    pub kind: Kind,
    /// The flight after it over the one before; where e changed, the median of the bounces from it on.
    pub ratio: f64,
    /// The ratio to be expected by the bounces around it; where e changed, the median of those before.
    pub expected_ratio: f64,
    /// e of the shorter part where e changed; null for other kinds.
    pub other_restitution: Option<Estimate>,
}

impl Irregular {
    /// Of an impact with this number from 1 at this time.
    #[must_use]
    pub const fn new(impact: usize, time_s: f64, kind: Kind, ratio: f64, expected: f64) -> Self {
        Self {
            impact,
            time_s,
            kind,
            ratio,
            expected_ratio: expected,
            other_restitution: None,
        }
    }

    /// What happened there, for people.
    pub(super) fn in_words(&self) -> String {
        let (ratio, expected) = (self.ratio, self.expected_ratio);
        let at = format!("{} at {:.3} s", self.impact, self.time_s);
        match self.kind {
            Kind::Odd => {
                let more = if ratio < expected { "more" } else { "less" };
                format!(
                    "Bounce {at} lost {more} than the others: ratio {ratio:.3} among {expected:.3}"
                )
            }
            Kind::LostTime => format!(
                "The flight after impact {at} is too short: ratio {ratio:.3} among {expected:.3}, the recording lacks a piece"
            ),
            Kind::Changed => {
                let other = self.other_restitution.map_or_else(String::new, |e| {
                    format!("; e of the shorter part is {}", with_error(&e))
                });
                format!(
                    "From bounce {at} on, e is different: ratio {ratio:.3}, and {expected:.3} before{other}"
                )
            }
        }
    }
}
