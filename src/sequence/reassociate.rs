//! Following a chain anew with what it taught: its own impacts and their echoes are no clutter.

use super::chain::Track;
use super::clutter::Rates;
use super::reasons;
use super::track::{Scene, Step, follow};

/// Versions of a chain that are followed at most; two to four are usual, and a limit that is reached is a fault.
const MOST_VERSIONS: usize = 100;

/// A chain as it was followed, and the events that it explains, in order: its impacts and their echoes.
#[derive(Debug)]
struct Version {
    steps: Vec<Step>,
    associated: Vec<usize>,
}

/// Follows a chain anew, and what comes of it again, until that was seen before.
///
/// If it is the chain followed last, nothing moves any more. If it is an earlier one, the versions since then lead to
/// one another for ever, and the one with the most evidence among them is taken. They are compared under one clutter:
/// all events but those that any of them explains.
#[must_use]
pub(super) fn reassociated(scene: &Scene<'_>, steps: Vec<Step>) -> Track {
    within(MOST_VERSIONS, scene, steps)
}

fn within(most: usize, scene: &Scene<'_>, mut steps: Vec<Step>) -> Track {
    let mut versions: Vec<Version> = Vec::new();
    loop {
        if let Some(first) = versions.iter().position(|v| is_same(&v.steps, &steps)) {
            // The same impacts, judged as they stand now.
            versions[first].steps = steps;
            return Track::new(best(scene, versions.split_off(first)));
        }
        let Some(seed) = best_seed(&steps) else {
            return Track::new(steps);
        };
        let associated = reasons::associated(scene, &Track::new(steps.clone()));
        let next = follow(scene, &mut scene.rates_without(&associated), seed);
        versions.push(Version { steps, associated });
        steps = next;
        if versions.len() == most {
            return Track::new(best(scene, versions));
        }
    }
}

/// Whether the same events are the impacts of both.
fn is_same(a: &[Step], b: &[Step]) -> bool {
    let events = |steps: &[Step]| steps.iter().filter_map(|s| s.event).collect::<Vec<_>>();
    events(a) == events(b)
}

/// The version with the most evidence, under the clutter that none of them explains.
fn best(scene: &Scene<'_>, versions: Vec<Version>) -> Vec<Step> {
    let associated = versions.iter().flat_map(|v| v.associated.iter().copied());
    let mut associated: Vec<usize> = associated.collect();
    associated.sort_unstable();
    associated.dedup();
    let mut rates = scene.rates_without(&associated);
    let among = |version: Version| judged(version.steps, &mut rates);
    let judged = versions.into_iter().map(among);
    let evidence = |steps: &Vec<Step>| steps.iter().map(|s| s.gain).sum::<f64>();
    judged
        .max_by(|a, b| evidence(a).total_cmp(&evidence(b)))
        .unwrap_or_default()
}

/// The steps among other clutter: where it is the rarer, an event earns the more.
pub(super) fn judged(mut steps: Vec<Step>, rates: &mut Rates<'_>) -> Vec<Step> {
    for step in &mut steps {
        if let Some(event) = step.event {
            let ln_rate = rates.ln_per_s(event, f64::INFINITY);
            step.gain += step.ln_rate - ln_rate;
            step.ln_rate = ln_rate;
        }
    }
    steps
}

/// The three neighbouring impacts, all heard, that earned most.
fn best_seed(steps: &[Step]) -> Option<[usize; 3]> {
    steps
        .windows(3)
        .filter_map(|w| {
            let events = [w[0].event?, w[1].event?, w[2].event?];
            Some((events, w.iter().map(|s| s.gain).sum::<f64>()))
        })
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(events, _)| events)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::event::Profile;
    use crate::random::SplitMix64;
    use crate::sequence::Event;
    use crate::sequence::clutter::Clutter;
    use crate::sequence::seeds::seeds;

    /// A drop of faint impacts with an echo, among knocks nearly as strong.
    fn events(seed: u64) -> Vec<Event> {
        let mut rng = SplitMix64::new(seed);
        let mut events = Vec::new();
        let mut add = |time_s: f64, strength: f64| {
            events.push(Event {
                time_s,
                jitter_s: 2e-4,
                strength,
                loudness: strength.ln(),
                profile: Profile::default(),
            });
        };
        let (mut at_s, mut flight_s) = (1.0, 0.5);
        for _ in 0..30 {
            let strength = 30.0 * (0.5 * rng.normal()).exp();
            add(at_s, strength);
            add(at_s + 11e-3, 0.6 * strength);
            at_s += flight_s;
            flight_s *= 0.88 * (0.01 * rng.normal()).exp();
        }
        for _ in 0..600 {
            add(6.0 * rng.uniform(), 25.0 * (0.8 * rng.normal()).exp());
        }
        events.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
        events
    }

    #[test]
    fn more_rounds_than_the_limit_and_one_more_change_nothing() {
        let (mut followed, mut cycles) = (0, 0);
        for seed in 1..=12 {
            let events = events(seed);
            let clutter = Clutter::new(&events);
            let scene = Scene::new(&events, &clutter);
            let mut rates = scene.rates();
            for start in seeds(&scene).into_iter().take(12) {
                let steps = follow(&scene, &mut rates, start);
                let usual = within(MOST_VERSIONS, &scene, steps.clone());
                for most in [2 * MOST_VERSIONS, 2 * MOST_VERSIONS + 1] {
                    let longer = within(most, &scene, steps.clone());
                    assert_eq!(usual, longer, "scene {seed}, at most {most}");
                }
                // A chain that does not come out again when it is followed anew is one of a cycle.
                let associated = reasons::associated(&scene, &usual);
                let mut rates = scene.rates_without(&associated);
                let again =
                    best_seed(&usual.steps).map(|s| Track::new(follow(&scene, &mut rates, s)));
                cycles += usize::from(again.is_some_and(|a| a.events != usual.events));
                followed += 1;
            }
        }
        assert!(followed > 100 && cycles > 0, "{cycles} of {followed}");
    }
}
