//! What comes nearest to a drop where there is none, as data.

use serde::{Deserialize, Serialize};

use super::Impact;
use super::numbers::odds;
use crate::words::words;

/// Sounds that may be the impacts of a drop, but with too little evidence to call them one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Candidate {
    /// The impacts in order of time.
    pub impacts: Vec<Impact>,
    /// Evidence that they are a drop and no chance, in nats.
    pub evidence_nats: f64,
    /// The evidence that would make them a drop.
    pub needed_nats: f64,
    /// What they lack.
    pub lack: Lack,
}

impl Candidate {
    /// A candidate that lacks evidence, or else is not the only one.
    #[must_use]
    pub fn new(impacts: Vec<Impact>, evidence_nats: f64, needed_nats: f64) -> Self {
        let lack = if evidence_nats < needed_nats {
            Lack::Evidence
        } else {
            Lack::Lead
        };
        Self {
            impacts,
            evidence_nats,
            needed_nats,
            lack,
        }
    }

    /// What it is, what it lacks and what to do, as sentences.
    #[must_use]
    pub fn in_words(&self) -> String {
        let count = self.impacts.len();
        let time = |impact: Option<&Impact>| impact.map_or(0.0, |i| i.time_s);
        let (first, last) = (time(self.impacts.first()), time(self.impacts.last()));
        let flights = if count == 2 {
            "stand out alike"
        } else {
            "have flights that shrink as those of a bouncing ball do"
        };
        let lack = match self.lack {
            Lack::Evidence => format!(
                "the odds that they are a drop and not chance are {}, and {} are needed",
                odds(self.evidence_nats),
                odds(self.needed_nats)
            ),
            Lack::Lead => "others fit nearly as well".to_owned(),
        };
        format!(
            "{count} sounds from {first:.3} to {last:.3} s {flights}, but {lack}. If they are the impacts, write \
             them as labels and have those fitted"
        )
    }
}

words! {
    /// What a candidate lacks to be a drop.
    #[non_exhaustive]
    pub enum Lack {
        /// Chance may have made it.
        Evidence = "evidence",
        /// Another choice of sounds is nearly as good.
        Lead = "lead",
    }
}
