//! The drops of a recording: the best chains that share no event.

use super::Event;
use super::chain::{Chain, Track};
use super::clutter::Clutter;
use super::reasons::{self, NonImpact, Reason};
use super::reassociate::reassociated;
use super::seeds::seeds;
use super::track::{Scene, Step, follow};
use crate::units::real;

/// What was found among the events.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Found {
    /// The drops, in order of time.
    pub drops: Vec<Chain>,
    /// Strong events outside any drop.
    pub rejected: Vec<NonImpact>,
}

/// Evidence a chain needs to be a drop, in nats: chance rarely makes one (none in 24 recordings without a drop).
const LEAST_EVIDENCE: f64 = 12.0;
/// Fewest impacts heard that make a drop: three flights, whose two ratios agree.
const FEWEST: usize = 4;
/// Over a whole drop the flights shrink at least to this share: ticking clocks and voices do not.
const LEAST_SHRINKAGE: f64 = 0.9;
/// The longest flight of a drop is at least this, in seconds: pulses of a voice are nearer together.
const LEAST_FLIGHT_S: f64 = 0.025;
/// No ball keeps more than this share of its speed at every bounce.
const GREATEST_RATIO: f64 = 0.985;

/// Finds the drops among events in order of time.
#[must_use]
pub fn find(events: &[Event]) -> Found {
    if events.is_empty() {
        return Found::default();
    }
    let clutter = Clutter::new(events);
    let scene = Scene::new(events, &clutter);
    let mut taken = vec![false; events.len()];
    let mut associated = vec![false; events.len()];
    let mut drops: Vec<Track> = Vec::new();
    loop {
        let left: Vec<usize> = (0..events.len()).filter(|&i| !associated[i]).collect();
        let found = disjoint(events, &left, &drops);
        if found.is_empty() {
            break;
        }
        for track in found {
            for &i in &track.events {
                taken[i] = true;
            }
            for i in reasons::own_sounds(&scene, &track) {
                associated[i] = true;
            }
            drops.push(track);
        }
    }
    drops.sort_by(|a, b| a.chain.span_s().0.total_cmp(&b.chain.span_s().0));
    reasons::explain(&scene, drops, &taken)
}

/// The best chains among some of the events that share none, and are no echo of one another or of the drops known.
fn disjoint(events: &[Event], left: &[usize], known: &[Track]) -> Vec<Track> {
    let some: Vec<Event> = left.iter().map(|&i| events[i]).collect();
    let clutter = Clutter::new(&some);
    let scene = Scene::new(&some, &clutter);
    let mut tracks = tracks(&scene);
    tracks.retain(|track| is_drop(&track.chain));
    tracks.sort_by(|a, b| b.chain.evidence().total_cmp(&a.chain.evidence()));
    let mut taken = vec![false; some.len()];
    let mut found: Vec<Track> = Vec::new();
    for mut track in tracks {
        let mut before = known.iter().chain(&found);
        let is_known = track.events.iter().any(|&i| taken[i]);
        if is_known || before.any(|d| reasons::is_echo_of(&track.chain, &d.chain)) {
            continue;
        }
        for event in &mut track.events {
            taken[*event] = true;
            *event = left[*event];
        }
        found.push(track);
    }
    found
}

/// Follows a known chain through other events, from the three neighbouring impacts among them that earn most.
///
/// `impacts_s` are the times of all impacts of the chain and how far off each may be, in seconds. None if no three
/// neighbouring impacts have events.
#[must_use]
pub fn follow_again(events: &[Event], impacts_s: &[(f64, f64)]) -> Option<Chain> {
    let clutter = Clutter::new(events);
    let scene = Scene::new(events, &clutter);
    follow_known(&scene, impacts_s).map(|track| track.chain)
}

fn follow_known(scene: &Scene<'_>, impacts_s: &[(f64, f64)]) -> Option<Track> {
    let strength = |i: usize| scene.events[i].strength;
    let known: Vec<Option<usize>> = impacts_s
        .iter()
        .map(|&(t, off)| {
            let near = scene.between(t - off, t + off);
            near.max_by(|&a, &b| strength(a).total_cmp(&strength(b)))
        })
        .collect();
    let seeds = known.windows(3).filter_map(|w| Some([w[0]?, w[1]?, w[2]?]));
    // The known impacts are no clutter to each other.
    let own: Vec<usize> = known.iter().flatten().copied().collect();
    let mut clearer = scene.rates_without(&own);
    let mut chains: Vec<Vec<Step>> = Vec::new();
    for seed in seeds {
        // A seed whose events all stand in one chain would only find it again.
        let stands_in = |chain: &[Step], i| chain.iter().any(|s| s.event == Some(i));
        if !chains.iter().any(|c| seed.iter().all(|&i| stands_in(c, i))) {
            chains.push(follow(scene, &mut clearer, seed));
        }
    }
    let evidence = |steps: &Vec<Step>| steps.iter().map(|s| s.gain).sum::<f64>();
    let best = chains
        .into_iter()
        .max_by(|a, b| evidence(a).total_cmp(&evidence(b)))?;
    Some(reassociated(scene, best))
}

/// The chains that the seeds lead to, the most promising seed first.
fn tracks(scene: &Scene<'_>) -> Vec<Track> {
    let mut tracks: Vec<Track> = Vec::new();
    // The chains that each event stands in. A seed whose events all stand in one would only find it again.
    let mut known: Vec<Vec<usize>> = vec![Vec::new(); scene.events.len()];
    let mut rates = scene.rates();
    for seed in seeds(scene) {
        let [first, second, third] = seed.map(|i| &known[i]);
        if first
            .iter()
            .any(|track| second.contains(track) && third.contains(track))
        {
            continue;
        }
        let steps = follow(scene, &mut rates, seed);
        if steps.iter().filter(|s| s.event.is_some()).count() < FEWEST {
            continue;
        }
        let track = reassociated(scene, steps);
        for &event in &track.events {
            known[event].push(tracks.len());
        }
        tracks.push(track);
    }
    tracks
}

fn is_drop(chain: &Chain) -> bool {
    let flights: Vec<f64> = chain
        .impacts
        .windows(2)
        .map(|w| w[1].time_s - w[0].time_s)
        .collect();
    let (Some(&first), Some(&last)) = (flights.first(), flights.last()) else {
        return false;
    };
    let ratio = (last / first).powf(1.0 / real((flights.len() - 1).max(1)));
    chain.heard() >= FEWEST
        && chain.evidence() >= LEAST_EVIDENCE
        && last <= LEAST_SHRINKAGE * first
        && first >= LEAST_FLIGHT_S
        && ratio <= GREATEST_RATIO
}

/// An event's reason for being left out, with its time.
pub(super) fn reject(event: &Event, reason: Reason) -> NonImpact {
    NonImpact {
        time_s: event.time_s,
        reason,
    }
}
