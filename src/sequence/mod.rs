//! Which events are the impacts of a drop: the chain whose flights shrink as those of a bouncing ball do.
//!
//! [`seeds`] proposes three events, [`track`] follows the flights from there both ways, [`clutter`] says how much
//! each match is worth, [`drops`] chooses among the chains found, [`reasons`] says why the rest was left out.

pub mod chain;
pub mod clutter;
pub mod drops;
mod extend;
pub mod flight;
pub mod reasons;
mod reassociate;
pub mod seeds;
pub mod track;

pub use chain::Chain;
pub use drops::{Found, find, follow_again};
pub use reasons::{Reason, Rejected, is_echo_of};

use crate::event::Event;
use crate::physics::priors::TRACKED_BOUNCE_STD;

/// What is known of balls before listening. Defaults suit drops from centimetres to metres.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Settings {
    /// Longest flight followed, in seconds. Default 2: a rebound of 5 m.
    pub longest_flight_s: f64,
    /// Shortest flight followed, in seconds. Default 4 ms: impacts nearer than that are one sound.
    pub shortest_flight_s: f64,
    /// Relative scatter of one flight about the trend, before the drop's own is learnt. Default 0.01: twice that of a
    /// ping-pong ball.
    pub bounce_scatter: f64,

    /// Evidence a chain needs to be a drop, in nats. Default 12: chance rarely makes one (none in 24 recordings without a drop).
    pub least_evidence: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            longest_flight_s: 2.0,
            shortest_flight_s: 4e-3,
            bounce_scatter: TRACKED_BOUNCE_STD,

            least_evidence: 12.0,
        }
    }
}
