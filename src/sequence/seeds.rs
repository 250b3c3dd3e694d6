//! Three events from which a drop may be followed.

use super::flight::{Doubt, FlightLaw};
use super::marks::ln_sounds;
use super::track::Scene;
use super::{Event, LONGEST_FLIGHT_S, SHORTEST_FLIGHT_S};
use crate::order::sort_by_number;
use crate::physics::priors::LN_RESTITUTION;

/// The strongest events within this many seconds …
const NEIGHBOURHOOD_S: f64 = 0.6;
/// … and this many of them may start a chain: a drop stands out somewhere along its way.
const INITIATORS: usize = 10;
/// A chain starts with events of at least this strength, in nats: white noise offers two a second.
const LEAST_STRENGTH: f64 = 9.0;
/// Seeds kept for each second of the recording.
const SEEDS_PER_S: usize = 6;
/// Least ratio of neighbouring flights that may start a chain: a limit of time, as no chain was ever found below it.
const LEAST_RATIO: f64 = 0.15;

/// A seed with what it promises, in nats.
type Scored = (f64, [usize; 3]);

/// Triples of events that look like neighbouring impacts, most promising first: strong ones whose next or previous
/// impact seems to be there.
#[must_use]
pub fn seeds(scene: &Scene<'_>) -> Vec<[usize; 3]> {
    let mut rates = scene.rates();
    let initiators: Vec<Initiator> = initiators(scene.events)
        .into_iter()
        .map(|event| Initiator {
            event,
            time_s: scene.events[event].time_s,
            worth: -rates.ln_per_s(event, f64::INFINITY),
        })
        .collect();
    let mut found: Vec<Scored> = Vec::new();
    let mut second: Vec<Scored> = Vec::new();
    let mut end_s = f64::NEG_INFINITY;
    for (place, initiator) in initiators.iter().enumerate() {
        if initiator.time_s > end_s {
            keep_best(&mut second, &mut found);
            end_s = initiator.time_s + 1.0;
        }
        triples_around(scene, &initiators, place, &mut second);
    }
    keep_best(&mut second, &mut found);
    best_first(&mut found);
    found.into_iter().map(|(_, seed)| seed).collect()
}

fn keep_best(second: &mut Vec<Scored>, found: &mut Vec<Scored>) {
    best_first(second);
    found.extend(second.drain(..).take(SEEDS_PER_S));
}

fn best_first(scored: &mut [Scored]) {
    sort_by_number(scored, |(score, _)| -score);
}

/// An event that may start a chain.
#[derive(Debug, Clone, Copy)]
struct Initiator {
    event: usize,
    time_s: f64,
    /// Minus ln of the rate of its like: the rarer, the more.
    worth: f64,
}

/// Strong events that few of their neighbours surpass.
fn initiators(events: &[Event]) -> Vec<usize> {
    let mut first = 0;
    let mut last = 0;
    let mut initiators = Vec::new();
    for (i, event) in events.iter().enumerate() {
        while events[first].time_s < event.time_s - NEIGHBOURHOOD_S {
            first += 1;
        }
        while last < events.len() && events[last].time_s <= event.time_s + NEIGHBOURHOOD_S {
            last += 1;
        }
        let stronger = events[first..last]
            .iter()
            .filter(|e| e.strength > event.strength)
            .take(INITIATORS)
            .count();
        if stronger < INITIATORS && event.strength >= LEAST_STRENGTH {
            initiators.push(i);
        }
    }
    initiators
}

fn triples_around(
    scene: &Scene<'_>,
    initiators: &[Initiator],
    place: usize,
    found: &mut Vec<Scored>,
) {
    let second = initiators[place];
    for first in initiators[..place].iter().rev() {
        let flight = second.time_s - first.time_s;
        if flight > LONGEST_FLIGHT_S {
            break;
        }
        for third in &initiators[place + 1..] {
            let next = third.time_s - second.time_s;
            if next > flight {
                break;
            }
            if next < LEAST_RATIO * flight || next < SHORTEST_FLIGHT_S {
                continue;
            }
            let triple = [*first, second, *third];
            found.push((
                promise(scene, triple) + neighbour(scene, initiators, triple),
                triple.map(|l| l.event),
            ));
        }
    }
}

/// What three impacts are worth, in nats, but for a constant.
fn promise(scene: &Scene<'_>, triple: [Initiator; 3]) -> f64 {
    let [t0, t1, t2] = triple.map(|l| l.time_s);
    let (flight, next) = (t1 - t0, t2 - t1);
    let ratio = next / flight;
    let sounds = |a: Initiator, b: Initiator| {
        ln_sounds(&scene.events[a.event], &scene.events[b.event], ratio)
    };
    let off = (ratio.ln() - LN_RESTITUTION.value) / LN_RESTITUTION.std;
    // Rare events and short flights say more: chance fills a long flight with anything.
    triple.iter().map(|l| l.worth).sum::<f64>() - flight.ln() - next.ln() - 0.5 * off * off
        + sounds(triple[0], triple[1])
        + sounds(triple[1], triple[2])
}

/// An impact before or after three others is sought within this share of its flight.
const NEIGHBOUR_REACH: f64 = 0.1;

/// What the best match for the impact after or before the three is worth, in nats; 0 where there is none.
fn neighbour(scene: &Scene<'_>, initiators: &[Initiator], triple: [Initiator; 3]) -> f64 {
    let [t0, t1, t2] = triple.map(|l| l.time_s);
    let mut law = FlightLaw::prior();
    let jitter_s = scene.jitter_s(triple.map(|l| l.event));
    law.learn(
        t1 - t0,
        t2 - t1,
        Doubt {
            unheard: 0,
            jitter_s,
        },
    );
    let (next, previous) = (law.next_s(t2 - t1), law.previous_s(t1 - t0));
    let worth = |centre_s: f64, flight_s: f64| {
        if !(SHORTEST_FLIGHT_S..=LONGEST_FLIGHT_S).contains(&flight_s) {
            return 0.0;
        }
        let reach = NEIGHBOUR_REACH * flight_s;
        let from = initiators.partition_point(|l| l.time_s < centre_s - reach);
        let near = initiators[from..]
            .iter()
            .take_while(|l| l.time_s <= centre_s + reach);
        near.map(|l| l.worth - (2.0 * reach).ln())
            .fold(0.0, f64::max)
    };
    worth(t2 + next, next).max(worth(t0 - previous, previous))
}
