//! The end of a drop, followed by the sound of its own impacts.
//!
//! The energy no longer rises where the last impact still rings. So once a chain is known, the late part of it is
//! searched again for the sound of its impacts, and the chain is followed there anew by the same physics.

use super::stretch::Stretch;
use crate::detect::{SEPARATION_S, matched};
use crate::impact::Impact;
use crate::sequence::{self, Chain};
use crate::signal::whiten::Whitened;
use crate::timing::Sketch;

/// Flights below this, in seconds, are short: the sound of one impact reaches into the next.
const SHORT_FLIGHT_S: f64 = 0.06;
/// Impacts before the short flights that are searched again too, so that the chain has something to start from.
const LEAD: usize = 3;
/// Time past the last impact that is searched, over that of the flights left at the ratio so far.
const PAST_END: f64 = 2.0;
/// Longest region that is searched, in seconds.
const LONGEST_REGION_S: f64 = 4.0;

/// A chain after its end was sought again.
#[derive(Debug)]
pub(super) struct Followed<'a> {
    pub chain: Chain,
    /// The sound that it is timed in, whitened by the noise around the chain.
    pub sound: Whitened<'a>,
}

/// The chain with its end followed by the sound of its impacts, if that finds more.
pub(super) fn follow<'a>(stretch: &Stretch<'a>, chain: Chain) -> Followed<'a> {
    let sound = stretch.whitened(&chain);
    match longer(stretch, &chain, &sound) {
        Some(chain) => Followed {
            sound: stretch.whitened(&chain),
            chain,
        },
        None => Followed { chain, sound },
    }
}

/// The chain with an end in which more was heard, if there is one.
fn longer(stretch: &Stretch<'_>, chain: &Chain, sound: &Whitened<'_>) -> Option<Chain> {
    let region_s = region(chain, stretch.sound.end_s())?;
    let Sketch { impacts, template } = stretch.sketch(chain, sound)?;
    let heard = impacts.iter().filter(|i| i.is_heard());
    let heard_s: Vec<f64> = heard.map(|i| i.time_s).collect();
    let flights = heard_s.windows(2).map(|w| w[1] - w[0]);
    let shortest_s = flights.fold(f64::INFINITY, f64::min);
    let late = matched::events(sound, &template, shortest_s, region_s)?;
    joined(chain, &sequence::follow_again(&late, &known(&impacts))?)
}

/// Greatest distance of an impact from its match, in seconds.
const MATCH_WITHIN_S: f64 = 0.4e-3;

/// The times of impacts, and how far off they may be.
fn known(timed: &[Impact]) -> Vec<(f64, f64)> {
    let times = timed.iter().map(|i| (i.time_s, MATCH_WITHIN_S));
    times.collect()
}

/// The time from just before the first impact of the late part to well past the end.
fn region(chain: &Chain, recording_end_s: f64) -> Option<(f64, f64)> {
    let flight = |i: usize| chain.impacts[i + 1].time_s - chain.impacts[i].time_s;
    let flights = chain.impacts.len().checked_sub(1)?;
    let short = (0..flights)
        .find(|&i| flight(i) < SHORT_FLIGHT_S)
        .unwrap_or(flights);
    let first = short.min(flights.checked_sub(LEAD)?).saturating_sub(LEAD);
    let last_s = chain.impacts[flights].time_s;
    let ratio = (flight(flights - 1) / flight(first))
        .powf(1.0 / crate::units::real((flights - 1 - first).max(1)));
    let left_s = flight(flights - 1) * ratio / (1.0 - ratio).max(0.01);
    let start_s = chain.impacts[first].time_s - 0.2 * flight(first);
    let end_s = (last_s + PAST_END * left_s + SHORT_FLIGHT_S)
        .min(recording_end_s)
        .min(start_s + LONGEST_REGION_S);
    Some((start_s, end_s))
}

/// The early part of the old chain and the new late part, if more was heard that way and that part is likelier a ball than chance.
fn joined(chain: &Chain, end: &Chain) -> Option<Chain> {
    let [first_new, second_new, ..] = end.impacts.as_slice() else {
        return None;
    };
    // Old impacts nearer to the first new one than half its flight are that impact.
    let begin_s = first_new.time_s - 0.5 * (second_new.time_s - first_new.time_s);
    let early = chain.impacts.iter().take_while(|i| i.time_s < begin_s);
    let impacts: Vec<Impact> = early.chain(&end.impacts).copied().collect();
    let near = |time_s: f64| {
        impacts
            .iter()
            .any(|i| (i.time_s - time_s).abs() < SEPARATION_S)
    };
    let rejected = chain.rejected.iter().filter(|r| !near(r.time_s));
    let joined = Chain {
        rejected: rejected.copied().collect(),
        impacts,
    };
    (joined.heard() > chain.heard() && end.evidence() > 0.0).then_some(joined)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::Status;

    /// Impacts of a ball of e = 0.8 from one of its impacts on.
    fn chain(impacts: std::ops::Range<i32>, nats: f64) -> Chain {
        let impact = |n: i32| Impact {
            time_s: 1.0 + 0.5 * (1.0 - 0.8_f64.powi(n)) / (1.0 - 0.8),
            std_s: 1e-5,
            status: Status::Heard,
            nats,
        };
        Chain {
            impacts: impacts.map(impact).collect(),
            rejected: Vec::new(),
        }
    }

    #[test]
    fn an_end_is_joined_where_it_has_more_impacts_and_is_likelier_a_ball_than_chance() {
        let known = chain(0..8, 3.0);
        let joined_to = |end: &Chain| joined(&known, end).map(|chain| chain.heard());
        assert!(joined_to(&chain(4..12, 2.0)) == Some(12));
        assert!(joined_to(&chain(4..12, -0.1)).is_none());
        assert!(joined_to(&chain(4..8, 2.0)).is_none());
    }
}
