//! Which events are the impacts of a drop: the chain whose flights shrink as those of a bouncing ball do.
//!
//! [`seeds`] proposes three events, [`track`] follows the flights from there both ways, [`clutter`] says how much
//! each match is worth, [`drops`] chooses among the chains found, [`reasons`] says why the rest was left out.

pub mod chain;
pub mod clutter;
pub mod drops;
mod extend;
pub mod few;
pub mod flight;
mod marks;
pub mod reasons;
mod reassociate;
mod scatter;
pub mod seeds;
mod shape;
mod together;
pub mod track;

pub use chain::Chain;
pub use drops::{Candidate, Found, find, follow_again};
pub use reasons::{NAMED, NonImpact, Reason, is_echo_of};

use crate::event::Event;

/// Longest flight followed, in seconds: a rebound of 20 m, or one of 1 m in slow motion.
const LONGEST_FLIGHT_S: f64 = 4.0;
/// Shortest flight followed, in seconds: impacts nearer than that are one sound.
const SHORTEST_FLIGHT_S: f64 = 4e-3;
