//! Why an event is no impact of a drop.

use super::drops::{Chain, Found, reject};
use super::track::Scene;
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
pub struct Rejected {
    /// Seconds from the first sample.
    pub time_s: f64,
    /// Why.
    pub reason: Reason,
}

/// An echo's delay is constant to this many seconds.
const DELAY_TOLERANCE_S: f64 = 0.6e-3;
/// Longest delay that is looked for: 17 m to a wall.
const LONGEST_DELAY_S: f64 = 0.1;
/// An echo follows at least this share of the impacts.
const ECHO_SHARE: f64 = 0.3;
/// Nearer to an impact than this, an event belongs to its sound.
const NEAR_S: f64 = 5e-3;
/// How many events outside the drops are named, the strongest; the rest is counted.
const NAMED: usize = 50;
/// A drop's rejected events are named from this share of its impacts' median strength on.
const NOTABLE_SHARE: f64 = 0.3;

/// Whether a chain is the echo of another, or the same again: more than half of its impacts follow one of the other's at
/// the same delay.
#[must_use]
pub fn is_echo_of(chain: &Chain, direct: &Chain) -> bool {
    let delays = chain.links.iter();
    let delays: Vec<f64> = delays
        .filter_map(|l| delay_after(direct, l.time_s))
        .collect();
    let Some(median) = upper_median(delays.iter().copied()) else {
        return false;
    };
    let same = |delay: &&f64| (**delay - median).abs() < DELAY_TOLERANCE_S;
    median < LONGEST_DELAY_S && 2 * delays.iter().filter(same).count() > chain.links.len()
}

/// Seconds from the impact of a chain before a time, or just after it.
fn delay_after(chain: &Chain, time_s: f64) -> Option<f64> {
    let before = chain.links.partition_point(|d| d.time_s <= time_s + NEAR_S);
    Some(time_s - chain.links[before.checked_sub(1)?].time_s)
}

/// Which events a chain explains, in order: its impacts and their echoes.
#[must_use]
pub fn explained(scene: &Scene<'_>, chain: &Chain) -> Vec<usize> {
    let (mut explained, echoes) = own_echoes(scene, chain);
    for link in &chain.links {
        explained.extend(
            scene
                .between(link.time_s, link.time_s + LONGEST_DELAY_S)
                .filter(|&i| {
                    let delay = scene.events[i].time_s - link.time_s;
                    echoes.iter().any(|d| (delay - d).abs() < DELAY_TOLERANCE_S)
                }),
        );
    }
    explained.sort_unstable();
    explained.dedup();
    explained
}

/// Which events the sound of a chain accounts for: what it explains, and what is near one of its impacts and weaker.
#[must_use]
pub fn own_sounds(scene: &Scene<'_>, chain: &Chain) -> Vec<usize> {
    let mut own = explained(scene, chain);
    for link in &chain.links {
        let Some(event) = link.event else { continue };
        let strength = scene.events[event].strength;
        let near = scene.between(link.time_s - NEAR_S, link.time_s + NEAR_S);
        own.extend(near.filter(|&i| scene.events[i].strength <= strength));
    }
    own
}

/// Gives every strong event that is no impact its reason.
#[must_use]
pub fn explain(scene: &Scene<'_>, mut drops: Vec<Chain>, taken: &[bool]) -> Found {
    let mut named = vec![false; taken.len()];
    for drop in &mut drops {
        let echoes = echo_delays(scene, drop, |i| taken[i]);
        let least = NOTABLE_SHARE * median_strength(scene, drop);
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
    outside.sort_by(|&a, &b| {
        scene.events[b]
            .strength
            .total_cmp(&scene.events[a].strength)
    });
    let weak = outside.len().saturating_sub(NAMED);
    outside.truncate(NAMED);
    outside.sort_unstable();
    let rejected = outside
        .into_iter()
        .map(|i| reject(&scene.events[i], Reason::NoSequence))
        .collect();
    Found {
        drops,
        rejected,
        weak,
    }
}

fn reason_within(drop: &Chain, time_s: f64, echoes: &[f64]) -> Option<Reason> {
    let after = drop.links.partition_point(|l| l.time_s <= time_s);
    let previous = after.checked_sub(1).map(|i| time_s - drop.links[i].time_s);
    let next = drop.links.get(after).map(|l| time_s - l.time_s);
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

/// The events of a chain, and the delays at which others follow many of them.
fn own_echoes(scene: &Scene<'_>, chain: &Chain) -> (Vec<usize>, Vec<f64>) {
    let own: Vec<usize> = chain.events().collect();
    let echoes = echo_delays(scene, chain, |i| own.binary_search(&i).is_ok());
    (own, echoes)
}

/// Delays at which something follows many of the impacts.
fn echo_delays(scene: &Scene<'_>, drop: &Chain, taken: impl Fn(usize) -> bool) -> Vec<f64> {
    let mut delays: Vec<f64> = Vec::new();
    for link in &drop.links {
        let window = scene.between(
            link.time_s + DELAY_TOLERANCE_S,
            link.time_s + LONGEST_DELAY_S,
        );
        delays.extend(
            window
                .filter(|&i| !taken(i))
                .map(|i| scene.events[i].time_s - link.time_s),
        );
    }
    delays.sort_by(f64::total_cmp);
    let needed = ECHO_SHARE * real(drop.links.len());
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

fn median_strength(scene: &Scene<'_>, drop: &Chain) -> f64 {
    let heard = drop.links.iter().filter_map(|l| l.event);
    upper_median(heard.map(|i| scene.events[i].strength)).unwrap_or(0.0)
}
