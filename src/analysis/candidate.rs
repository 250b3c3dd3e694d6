//! What comes nearest to a drop in a recording without one: a chain with too little evidence, or two or three sounds.

use super::Settings;
use super::drop::{self, Measured};
use super::few;
use super::stretch::Stretch;
use super::tail::Followed;
use crate::Error;
use crate::report;
use crate::sequence;

/// What comes nearest to a drop in a scene.
#[derive(Debug)]
pub(super) struct Candidate {
    measured: Measured,
    needed_nats: f64,
}

impl Candidate {
    /// A chain with its impacts timed.
    ///
    /// # Errors
    /// [`Error::Argument`] for a setting out of range.
    pub(super) fn of_chain(
        stretch: &Stretch<'_>,
        found: sequence::Candidate,
        channel: usize,
        settings: &Settings,
    ) -> Result<Self, Error> {
        let followed = Followed {
            sound: stretch.whitened(&found.chain),
            chain: found.chain,
        };
        Ok(Self {
            measured: drop::measure(stretch, followed, channel, settings)?,
            needed_nats: found.needed_nats,
        })
    }

    /// Two or three impacts that are no drop.
    pub(super) fn of_few(few: few::Heard) -> Self {
        Self {
            measured: few.measured,
            needed_nats: sequence::few::LEAST_NATS,
        }
    }

    /// Nats by which it is short; negative where there are enough, and only others fit nearly as well.
    fn short_nats(&self) -> f64 {
        self.needed_nats - self.measured.evidence_nats
    }

    /// The one that is nearer to a drop.
    pub(super) fn or_nearer(self, other: Self) -> Self {
        if other.short_nats() < self.short_nats() {
            other
        } else {
            self
        }
    }

    /// The candidate as data; none where chance is likelier.
    pub(super) fn reported(self) -> Option<report::Candidate> {
        let nats = self.measured.evidence_nats;
        (nats > 0.0).then(|| report::Candidate::new(self.measured.impacts, nats, self.needed_nats))
    }
}
