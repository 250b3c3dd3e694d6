//! What was heard and is no impact, as data.

use serde::{Deserialize, Serialize};

use crate::words::words;

/// A strong event that is no impact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Rejected {
    /// Seconds from the first sample.
    pub time_s: f64,
    /// Why.
    pub reason: RejectReason,
    /// Why, for people: a part of a sentence.
    pub detail: String,
}

words! {
    /// Why an event is no impact.
    #[non_exhaustive]
    pub enum RejectReason {
        /// It follows many impacts by the same time.
        Echo = "echo",
        /// It is the sound of an impact nearby.
        NearImpact = "near_impact",
        /// It lies between impacts, where no flight ends.
        OffSequence = "off_sequence",
        /// It belongs to no drop.
        NoSequence = "no_sequence",
    }
}
