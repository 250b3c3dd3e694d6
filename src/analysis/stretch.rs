//! The stretch of a channel that is analyzed.

use crate::detect::HOP_S;
use crate::impact::Impact;
use crate::sequence::Chain;
use crate::signal::sound::Sound;
use crate::signal::whiten::Whitened;
use crate::timing::{self, Sketch, Timing};

/// Standard error of a time on the detector's grid, in hops. Derived: 1/√3, a uniform error of one hop either way.
const GRID_ERROR: f64 = 0.58;

/// A stretch of a channel, and where listening to its recording began.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch<'a> {
    pub sound: Sound<'a>,
    /// Where listening began; the stretch may begin later.
    pub listened_from_s: f64,
}

impl<'a> Stretch<'a> {
    /// The sound that a chain is timed in.
    pub(super) fn whitened(&self, chain: &Chain) -> Whitened<'a> {
        Whitened::around(self.sound, chain.span_s())
    }

    /// The impacts of a chain with their times.
    pub(super) fn timed(&self, chain: &Chain, sound: &Whitened<'_>, timing: Timing) -> Vec<Impact> {
        timing::refine(sound, &coarse(chain), timing)
    }

    /// What more impacts of a chain can be found by.
    pub(super) fn sketch(&self, chain: &Chain, sound: &Whitened<'_>) -> Option<Sketch> {
        timing::sketch(sound, &coarse(chain))
    }
}

/// The impacts of a chain, with how far off the detector's times may be.
fn coarse(chain: &Chain) -> Vec<Impact> {
    let coarse = chain.impacts.iter().map(|&seen| Impact {
        std_s: seen.std_s.max(GRID_ERROR * HOP_S),
        ..seen
    });
    coarse.collect()
}
