//! Why an event is no impact of a drop.

use super::chain::{Chain, Track};
use super::drops::{Found, reject};
use super::track::Scene;
use crate::order::sort_by_number;
use crate::statistics::upper_median;
use crate::units::real;

/// Why a strong event is no impact.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// It follows most impacts at the same delay: the sound came back from a wall.
    Echo {
        /// The delay in seconds.
        delay_s: f64,
    },
    /// It is too near an impact to be another.
    Near {
        /// Seconds from that impact, negative before it.
        offset_s: f64,
    },
    /// It lies between two impacts and does not fit the shrinking flights.
    BetweenImpacts,
    /// No drop starts or goes on here.
    NoSequence,
}

/// A strong event that is no impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NonImpact {
    /// Seconds from the first sample.
    pub time_s: f64,
    /// Why.
    pub reason: Reason,
}

/// An echo's delay is constant to this many seconds.
const DELAY_TOLERANCE_S: f64 = 0.6e-3;
/// … and that of a whole chain to this share of a flight: what comes back from many places begins now here, now there. Another
/// ball's delays walk through whole flights.
const DELAY_TOLERANCE: f64 = 0.01;
/// Longest delay that is looked for: 34 m to the wall of a sports hall.
const LONGEST_DELAY_S: f64 = 0.2;
/// An echo follows at least this share of the impacts …
const ECHO_SHARE: f64 = 0.3;
/// … and more of them than events without order would by so many standard deviations.
const ECHO_ABOVE_CHANCE: f64 = 4.0;
/// Nearer to an impact than this, an event belongs to its sound.
const NEAR_S: f64 = 5e-3;
/// How many events outside the drops of a recording are named, the strongest; the rest is counted.
pub const NAMED: usize = 50;
/// A drop's rejected events are named from this share of its impacts' median strength on.
const NOTABLE_SHARE: f64 = 0.3;

/// Whether a chain is the echo of another, or the same again: more than half of its impacts belong to the sound of one of the
/// other's, or lie at the same delay from one. The other has more evidence, and may yet be the one that came back from a wall:
/// then the chain is ahead of it.
#[must_use]
pub fn is_echo_of(chain: &Chain, direct: &Chain) -> bool {
    let delays = chain.impacts.iter();
    let delays: Vec<Delay> = delays.map(|i| Delay::of(direct, i.time_s)).collect();
    let are_alike = |side: fn(&Delay) -> f64| {
        let usual = upper_median(delays.iter().map(side)).unwrap_or(f64::INFINITY);
        let same = |d: &&Delay| d.is_near() || (side(d) - usual).abs() < d.tolerance_s;
        usual < LONGEST_DELAY_S && 2 * delays.iter().filter(same).count() > chain.impacts.len()
    };
    are_alike(|d| d.after_s) || are_alike(|d| d.ahead_s)
}

/// Where a time lies among the impacts of a chain.
struct Delay {
    /// Seconds since the impact before it and until the one after it; infinite where there is none.
    after_s: f64,
    ahead_s: f64,
    /// How far the delay of an echo may be from that of others here.
    tolerance_s: f64,
}

impl Delay {
    fn of(chain: &Chain, time_s: f64) -> Self {
        let impacts = &chain.impacts;
        let after = impacts.partition_point(|i| i.time_s <= time_s);
        let before = after.checked_sub(1).map(|i| &impacts[i]);
        let after_s = before.map_or(f64::INFINITY, |i| time_s - i.time_s);
        let ahead_s = impacts
            .get(after)
            .map_or(f64::INFINITY, |i| i.time_s - time_s);
        let flight_s = after_s + ahead_s;
        let of_flight_s = if flight_s.is_finite() {
            DELAY_TOLERANCE * flight_s
        } else {
            0.0
        };
        Self {
            after_s,
            ahead_s,
            tolerance_s: of_flight_s.max(DELAY_TOLERANCE_S),
        }
    }

    /// Whether it belongs to the sound of one of the impacts.
    fn is_near(&self) -> bool {
        self.after_s.min(self.ahead_s) < NEAR_S
    }
}

/// Which events a chain explains, in order: its impacts and their echoes.
pub(super) fn associated(scene: &Scene<'_>, track: &Track) -> Vec<usize> {
    let echoes = own_echoes(scene, track);
    let mut associated = track.events.clone();
    for impact in &track.chain.impacts {
        associated.extend(
            scene
                .between(impact.time_s, impact.time_s + LONGEST_DELAY_S)
                .filter(|&i| {
                    let delay = scene.events[i].time_s - impact.time_s;
                    echoes.iter().any(|d| (delay - d).abs() < DELAY_TOLERANCE_S)
                }),
        );
    }
    associated.sort_unstable();
    associated.dedup();
    associated
}

/// Which events the sound of a chain accounts for: what it explains, and what is near one of its impacts and weaker.
pub(super) fn own_sounds(scene: &Scene<'_>, track: &Track) -> Vec<usize> {
    let mut own = associated(scene, track);
    for (event, impact) in track.heard() {
        let strength = scene.events[event].strength;
        let near = scene.between(impact.time_s - NEAR_S, impact.time_s + NEAR_S);
        own.extend(near.filter(|&i| scene.events[i].strength <= strength));
    }
    own
}

/// Gives every strong event that is no impact its reason.
pub(super) fn explain(scene: &Scene<'_>, mut drops: Vec<Track>, taken: &[bool]) -> Found {
    let mut named = vec![false; taken.len()];
    for track in &mut drops {
        let least = NOTABLE_SHARE * median_strength(scene, track);
        let drop = &mut track.chain;
        let echoes = echo_delays(scene, drop, |i| taken[i]);
        let (start_s, end_s) = drop.span_s();
        for i in scene.between(start_s - NEAR_S, end_s + LONGEST_DELAY_S) {
            if taken[i] || scene.events[i].strength < least {
                continue;
            }
            let event = &scene.events[i];
            if let Some(reason) = reason_within(drop, event.time_s, &echoes) {
                named[i] = true;
                drop.rejected.push(reject(event, reason));
            }
        }
    }
    let mut outside: Vec<usize> = (0..taken.len())
        .filter(|&i| !taken[i] && !named[i])
        .collect();
    sort_by_number(&mut outside, |&i| -scene.events[i].strength);
    outside.truncate(NAMED);
    outside.sort_unstable();
    let rejected = outside
        .into_iter()
        .map(|i| reject(&scene.events[i], Reason::NoSequence))
        .collect();
    Found {
        drops: drops.into_iter().map(|track| track.chain).collect(),
        rejected,
        candidate: None,
    }
}

fn reason_within(drop: &Chain, time_s: f64, echoes: &[f64]) -> Option<Reason> {
    let after = drop.impacts.partition_point(|i| i.time_s <= time_s);
    let previous = after
        .checked_sub(1)
        .map(|i| time_s - drop.impacts[i].time_s);
    let next = drop.impacts.get(after).map(|i| time_s - i.time_s);
    if let Some(&delay_s) = echoes
        .iter()
        .find(|&&d| previous.is_some_and(|p| (p - d).abs() < DELAY_TOLERANCE_S))
    {
        return Some(Reason::Echo { delay_s });
    }
    let nearest = [previous, next]
        .into_iter()
        .flatten()
        .min_by(|a, b| a.abs().total_cmp(&b.abs()));
    match nearest {
        Some(offset_s) if offset_s.abs() < NEAR_S => Some(Reason::Near { offset_s }),
        _ if previous.is_some() && next.is_some() => Some(Reason::BetweenImpacts),
        _ => None,
    }
}

/// Delays at which events follow many of the impacts of a chain.
fn own_echoes(scene: &Scene<'_>, track: &Track) -> Vec<f64> {
    echo_delays(scene, &track.chain, |i| {
        track.events.binary_search(&i).is_ok()
    })
}

/// Delays at which something follows many of the impacts.
fn echo_delays(scene: &Scene<'_>, drop: &Chain, taken: impl Fn(usize) -> bool) -> Vec<f64> {
    let mut delays: Vec<f64> = Vec::new();
    for impact in &drop.impacts {
        let window = scene.between(
            impact.time_s + DELAY_TOLERANCE_S,
            impact.time_s + LONGEST_DELAY_S,
        );
        delays.extend(
            window
                .filter(|&i| !taken(i))
                .map(|i| scene.events[i].time_s - impact.time_s),
        );
    }
    delays.sort_by(f64::total_cmp);
    let by_chance = real(delays.len()) * DELAY_TOLERANCE_S / (LONGEST_DELAY_S - DELAY_TOLERANCE_S);
    let needed = (ECHO_SHARE * real(drop.impacts.len()))
        .max(by_chance + ECHO_ABOVE_CHANCE * by_chance.sqrt());
    let mut echoes = Vec::new();
    let mut first = 0;
    while first < delays.len() {
        let end = delays.partition_point(|&d| d < delays[first] + DELAY_TOLERANCE_S);
        if real(end - first) >= needed.max(3.0) {
            echoes.push(delays[first + (end - first) / 2]);
            first = end;
        } else {
            first += 1;
        }
    }
    echoes
}

fn median_strength(scene: &Scene<'_>, track: &Track) -> f64 {
    let heard = track.events.iter();
    upper_median(heard.map(|&i| scene.events[i].strength)).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::Impact;

    /// Impacts of a ball of e = 0.85, each this much later than it strikes.
    fn ball(first_s: f64, late_s: impl Fn(usize) -> f64) -> Chain {
        let time_s = |n: usize| first_s + 0.5 * (1.0 - 0.85_f64.powf(real(n))) / (1.0 - 0.85);
        let impact = |n: usize| Impact::heard(time_s(n) + late_s(n), 1e-5);
        Chain {
            impacts: (0..26).map(impact).collect(),
            rejected: Vec::new(),
        }
    }

    #[test]
    fn an_echo_is_one_also_where_it_goes_over_to_the_impacts_themselves() {
        let direct = ball(1.0, |_| 0.0);
        let echo = ball(1.0, |_| 0.018);
        let goes_over = ball(1.0, |n| if n < 13 { 0.018 } else { 1e-4 });
        assert!(is_echo_of(&echo, &direct) && is_echo_of(&goes_over, &direct));
    }

    #[test]
    fn an_echo_begins_now_here_now_there_and_may_be_heard_better_than_what_came_before_it() {
        let direct = ball(1.0, |_| 0.0);
        let wanders = ball(1.0, |n| 0.007 + if n % 3 == 0 { 9e-4 } else { -4e-4 });
        assert!(is_echo_of(&wanders, &direct));
        let ahead = ball(1.0, |_| -0.0102);
        assert!(is_echo_of(&ahead, &direct) && is_echo_of(&direct, &ahead));
    }

    #[test]
    fn another_ball_is_no_echo() {
        let direct = ball(1.0, |_| 0.0);
        assert!(!is_echo_of(&ball(1.37, |_| 0.0), &direct));
    }
}
