//! The drops of a recording: the best chains that share no event.

use super::Event;
use super::chain::{Chain, Track};
use super::clutter::Clutter;
use super::reasons::{self, NonImpact, Reason};
use super::reassociate::reassociated;
use super::seeds::seeds;
use super::shape::Shrinkage;
use super::together::together;
use super::track::{Scene, Step, follow};
use crate::order::sort_by_number;
use crate::units::real;

/// What was found among the events.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Found {
    /// The drops, in order of time.
    pub drops: Vec<Chain>,
    /// Strong events outside any drop.
    pub rejected: Vec<NonImpact>,
    /// Where there is no drop, the chain that comes nearest to one.
    pub candidate: Option<Candidate>,
}

/// A chain whose flights shrink, but with too little evidence for a drop.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// The chain.
    pub chain: Chain,
    /// The evidence that would make it a drop, in nats.
    pub needed_nats: f64,
}

/// Evidence a chain needs to be a drop, in nats: odds of 150 to 1 against a burst of like sounds.
pub(super) const LEAST_EVIDENCE: f64 = 5.0;
/// Fewest impacts heard that make a drop: three flights, whose two ratios agree.
const FEWEST: usize = 4;
/// The flights shrink: nats by which a ball explains them better than a hand or a clock.
const LEAST_SHRINKAGE: f64 = 6.0;
/// The longest flight of a drop is at least this, in seconds: pulses of a voice are nearer together.
const LEAST_FLIGHT_S: f64 = 0.025;

/// Finds the drops among events in order of time.
///
/// Energy that rises says little of short flights, where one sound rings into the next. So a chain that is likelier a ball than
/// chance, but too little so for a drop, is one where it has enough evidence by the sound of its own impacts: `by_sound` gives that, in nats.
#[must_use]
pub fn find(events: &[Event], by_sound: impl Fn(&Chain) -> f64) -> Found {
    if events.is_empty() {
        return Found::default();
    }
    let clutter = Clutter::new(events);
    let scene = Scene::new(events, &clutter);
    let mut taken = vec![false; events.len()];
    let mut associated = vec![false; events.len()];
    let mut drops: Vec<Track> = Vec::new();
    let candidate = loop {
        let left: Vec<usize> = (0..events.len()).filter(|&i| !associated[i]).collect();
        let (mut found, mut rest) = disjoint(events, &left, &drops);
        if found.is_empty() {
            let is_drop = |track: &mut Track| {
                track.chain.evidence() > 0.0 && by_sound(&track.chain) >= LEAST_EVIDENCE
            };
            found = rest.extract_if(.., is_drop).collect();
        }
        if found.is_empty() {
            break rest.into_iter().next().filter(|_| drops.is_empty());
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
    };
    sort_by_number(&mut drops, |track| track.chain.span_s().0);
    Found {
        candidate: candidate.map(|track| Candidate {
            chain: track.chain,
            needed_nats: LEAST_EVIDENCE,
        }),
        ..reasons::explain(&scene, drops, &taken)
    }
}

/// The best chains among some of the events that share none, and are no echo of one another or of the drops known; and those with
/// too little evidence, the best first.
fn disjoint(events: &[Event], left: &[usize], known: &[Track]) -> (Vec<Track>, Vec<Track>) {
    let some: Vec<Event> = left.iter().map(|&i| events[i]).collect();
    let clutter = Clutter::new(&some);
    let scene = Scene::new(&some, &clutter);
    let mut tracks = tracks(&scene);
    tracks.retain(|track| is_shaped(&track.chain));
    let apart = apart(tracks, known);
    let is_enough = |track: &Track| track.chain.evidence() >= LEAST_EVIDENCE;
    let (mut found, mut rest): (Vec<Track>, Vec<Track>) = apart.into_iter().partition(is_enough);
    if found.is_empty() {
        found = together(&scene, &rest, LEAST_EVIDENCE);
    }
    for event in found
        .iter_mut()
        .chain(&mut rest)
        .flat_map(|track| &mut track.events)
    {
        *event = left[*event];
    }
    (found, rest)
}

/// The chains of most evidence that share no event and are no echo of one another or of those known, the best first.
///
/// Chains that share events are explained together: one with less evidence goes before others that run through it, if it and
/// what is left of them beside it have more than they alone. What is left of them stands in the way of others, and is followed
/// anew among the events that are left.
fn apart(mut tracks: Vec<Track>, known: &[Track]) -> Vec<Track> {
    let most_evidence_first = |track: &Track| -track.chain.evidence();
    sort_by_number(&mut tracks, most_evidence_first);
    let (mut found, mut left): (Vec<Track>, Vec<Track>) = (Vec::new(), Vec::new());
    for track in tracks {
        let mut before = known.iter().chain(&found);
        if before.any(|d| reasons::is_echo_of(&track.chain, &d.chain)) {
            continue;
        }
        let sharing = found.iter().chain(&left).filter(|t| t.shares(&track));
        let sharing: Vec<(f64, Track)> = sharing
            .map(|other| {
                let rest = other.beside(&track);
                (cost(other, &rest), rest)
            })
            .collect();
        if track.chain.evidence() > sharing.iter().map(|(cost, _)| cost).sum() {
            found.retain(|other| !other.shares(&track));
            left.retain(|other| !other.shares(&track));
            left.extend(sharing.into_iter().map(|(_, rest)| rest));
            found.push(track);
        }
    }
    sort_by_number(&mut found, most_evidence_first);
    found
}

/// What it costs a chain that only a part of it is left: as much of its evidence as of its impacts at least, since the part has to
/// begin anew, as the whole did.
fn cost(whole: &Track, rest: &Track) -> f64 {
    let evidence = whole.chain.evidence();
    let share = real(rest.events.len()) / real(whole.events.len());
    (evidence - rest.chain.evidence().min(share * evidence)).max(0.0)
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
    let mut rates = scene.rates().hopeful();
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

/// Whether a chain has the form of a drop, whatever its evidence.
fn is_shaped(chain: &Chain) -> bool {
    let flights = chain.impacts.windows(2);
    let flights: Vec<f64> = flights.map(|w| w[1].time_s - w[0].time_s).collect();
    let (Some(&first), Some(&last)) = (flights.first(), flights.last()) else {
        return false;
    };
    chain.heard() >= FEWEST
        && first >= LEAST_FLIGHT_S
        && last < first
        && Shrinkage::of(chain).is_some_and(|s| s.nats() >= LEAST_SHRINKAGE)
}

/// An event's reason for being left out, with its time.
pub(super) fn reject(event: &Event, reason: Reason) -> NonImpact {
    NonImpact {
        time_s: event.time_s,
        reason,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::event::Profile;

    /// Faint impacts of a ball, and a sound as loud every second.
    fn faint() -> Vec<Event> {
        let impacts_s = [2.0, 2.5, 2.9, 3.22, 3.476, 3.6808];
        let others_s = (0..3).map(|n| real(n) + 0.17);
        let event = |time_s| Event {
            time_s,
            jitter_s: 1e-4,
            strength: 20.0,
            loudness: 3.0,
            profile: Profile::default(),
        };
        let mut events: Vec<Event> = impacts_s.into_iter().chain(others_s).map(event).collect();
        sort_by_number(&mut events, |event| event.time_s);
        events
    }

    #[test]
    fn a_chain_with_too_little_evidence_is_a_drop_where_its_own_sound_has_enough() {
        let silent = find(&faint(), |_| 0.0);
        let candidate = silent.candidate.unwrap();
        let evidence = candidate.chain.evidence();
        assert!(
            silent.drops.is_empty() && (0.0..LEAST_EVIDENCE).contains(&evidence),
            "{evidence}"
        );
        let heard = find(&faint(), |chain| chain.evidence() + LEAST_EVIDENCE);
        assert!(heard.candidate.is_none());
        assert!(heard.drops.len() == 1 && heard.drops[0].impacts == candidate.chain.impacts);
        assert!(heard.rejected.len() < silent.rejected.len());
    }
}
