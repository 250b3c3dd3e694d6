//! Three candidates from which a drop may be followed.

use super::Event;
use super::flight::FlightLaw;
use super::track::Scene;

/// The strongest events within this many seconds …
const NEIGHBOURHOOD_S: f64 = 0.6;
/// … and this many of them may start a chain: a drop stands out somewhere along its way.
const LEADERS: usize = 10;
/// Seeds kept for each second of the recording.
const SEEDS_PER_S: usize = 12;
/// Ratios of neighbouring flights that may start a chain.
const RATIOS: (f64, f64) = (0.25, 1.0);

/// Triples of events that look like neighbouring impacts, most promising first: strong ones whose next or previous
/// impact seems to be there.
#[must_use]
pub fn seeds(scene: &Scene<'_>) -> Vec<[usize; 3]> {
    let leaders = leaders(scene.events);
    let mut found: Vec<(f64, [usize; 3])> = Vec::new();
    let mut bin: Vec<(f64, [usize; 3])> = Vec::new();
    let mut bin_end_s = f64::NEG_INFINITY;
    for (place, &second) in leaders.iter().enumerate() {
        let time_s = scene.events[second].time_s;
        if time_s > bin_end_s {
            keep_best(&mut bin, &mut found);
            bin_end_s = time_s + 1.0;
        }
        triples_around(scene, &leaders, place, &mut bin);
    }
    keep_best(&mut bin, &mut found);
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.into_iter().map(|(_, seed)| seed).collect()
}

fn keep_best(bin: &mut Vec<(f64, [usize; 3])>, found: &mut Vec<(f64, [usize; 3])>) {
    bin.sort_by(|a, b| b.0.total_cmp(&a.0));
    found.extend(bin.drain(..).take(SEEDS_PER_S));
}

/// Events that few of their neighbours surpass.
fn leaders(events: &[Event]) -> Vec<usize> {
    let mut first = 0;
    let mut last = 0;
    let mut leaders = Vec::new();
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
            .take(LEADERS)
            .count();
        if stronger < LEADERS {
            leaders.push(i);
        }
    }
    leaders
}

fn triples_around(
    scene: &Scene<'_>,
    leaders: &[usize],
    place: usize,
    bin: &mut Vec<(f64, [usize; 3])>,
) {
    let second = leaders[place];
    let time = |i: usize| scene.events[i].time_s;
    for &first in leaders[..place].iter().rev() {
        let flight = time(second) - time(first);
        if flight > scene.settings.longest_flight_s {
            break;
        }
        for &third in &leaders[place + 1..] {
            let next = time(third) - time(second);
            if next > RATIOS.1 * flight {
                break;
            }
            if next < RATIOS.0 * flight || next < scene.settings.shortest_flight_s {
                continue;
            }
            let seed = [first, second, third];
            let strength: f64 = seed.iter().map(|&i| -scene.ln_rates[i]).sum();
            // Rare events and short flights say more: chance fills a long flight with anything.
            bin.push((
                strength + neighbour(scene, seed) - flight.ln() - next.ln(),
                seed,
            ));
        }
    }
}

/// What the best match for the impact after or before the three is worth, in nats; 0 where there is none.
fn neighbour(scene: &Scene<'_>, seed: [usize; 3]) -> f64 {
    let [t0, t1, t2] = seed.map(|i| scene.events[i].time_s);
    let mut law = FlightLaw::prior(scene.settings);
    law.learn(t1 - t0, t2 - t1, 0, scene.settings);
    let (next, previous) = (law.next_s(t2 - t1), law.previous_s(t1 - t0));
    let worth = |centre_s: f64, flight_s: f64| {
        let reach = 0.1 * flight_s;
        scene
            .between(centre_s - reach, centre_s + reach)
            .map(|i| -scene.ln_rates[i] - (2.0 * reach).ln())
            .fold(0.0, f64::max)
    };
    worth(t2 + next, next).max(worth(t0 - previous, previous))
}
