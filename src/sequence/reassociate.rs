//! Following a chain anew with what it taught: its own impacts and their echoes are no clutter.

use super::chain::Track;
use super::clutter::Rates;
use super::drops::LEAST_EVIDENCE;
use super::reasons;
use super::track::{Scene, Step, follow};

/// A chain as it was followed, the events that it explains, in order, its impacts and their echoes, and its evidence where those are
/// no clutter.
#[derive(Debug)]
struct Version<'a> {
    steps: Vec<Step>,
    associated: Vec<usize>,
    /// The rates of clutter without those.
    rates: Rates<'a>,
    evidence: f64,
}

impl<'a> Version<'a> {
    fn of(scene: &'a Scene<'_>, steps: Vec<Step>) -> Self {
        let associated = reasons::associated(scene, &Track::new(steps.clone()));
        let mut rates = scene.rates_without(&associated);
        Self {
            evidence: evidence(&judged(steps.clone(), &mut rates)),
            steps,
            associated,
            rates,
        }
    }

    /// Its steps, each against a burst of sounds like it.
    fn track(mut self) -> Track {
        Track::new(against_bursts(self.steps, &mut self.rates))
    }
}

/// Follows a chain anew, and what comes of it again, until that was seen before or no three neighbours of it are heard.
///
/// If it is the chain followed last, nothing moves any more. If it is an earlier one, the versions since then lead to one another
/// for ever, and the one with the most evidence among them is taken, under one clutter: all events but those that any of them
/// explains. What is followed anew can also leave its way, to echoes of its own, which are no clutter to it either: then a version
/// before has more evidence by as much as a drop needs, under one clutter too, and is taken.
#[must_use]
pub(super) fn reassociated(scene: &Scene<'_>, steps: Vec<Step>) -> Track {
    let mut versions: Vec<Version<'_>> = Vec::new();
    let mut next = Version::of(scene, steps);
    let first = loop {
        let seen = versions.iter().position(|v| is_same(&v.steps, &next.steps));
        if let Some(first) = seen {
            // The same impacts, judged as they stand now.
            versions[first] = next;
            break first;
        }
        let Some(seed) = best_seed(&next.steps) else {
            versions.push(next);
            break versions.len() - 1;
        };
        let steps = follow(scene, &mut next.rates, seed);
        versions.push(next);
        next = Version::of(scene, steps);
    };
    let last = Version::of(scene, best(scene, &versions.split_off(first)));
    let left = versions
        .into_iter()
        .max_by(|a, b| a.evidence.total_cmp(&b.evidence));
    taken(scene, last, left)
}

/// The last version, or one that was left before it where that has so much more evidence, among its own clutter and under one.
fn taken(scene: &Scene<'_>, last: Version<'_>, left: Option<Version<'_>>) -> Track {
    let Some(left) = left.filter(|left| left.evidence > last.evidence + LEAST_EVIDENCE) else {
        return last.track();
    };
    let pair = [last, left];
    let evidences = under_one_clutter(scene, &pair).map(|steps| evidence(&steps));
    let evidences: Vec<f64> = evidences.collect();
    let [last, left] = pair;
    if evidences[1] > evidences[0] + LEAST_EVIDENCE {
        left.track()
    } else {
        last.track()
    }
}

/// Whether the same events are the impacts of both.
fn is_same(a: &[Step], b: &[Step]) -> bool {
    let events = |steps: &[Step]| steps.iter().filter_map(|s| s.event).collect::<Vec<_>>();
    events(a) == events(b)
}

/// The steps of the version with the most evidence under one clutter.
fn best(scene: &Scene<'_>, versions: &[Version<'_>]) -> Vec<Step> {
    under_one_clutter(scene, versions)
        .max_by(|a, b| evidence(a).total_cmp(&evidence(b)))
        .unwrap_or_default()
}

/// The steps of versions under the clutter that none of them explains.
fn under_one_clutter<'v>(
    scene: &'v Scene<'_>,
    versions: &'v [Version<'_>],
) -> impl Iterator<Item = Vec<Step>> + 'v {
    let associated = versions.iter().flat_map(|v| v.associated.iter().copied());
    let mut associated: Vec<usize> = associated.collect();
    associated.sort_unstable();
    associated.dedup();
    let mut rates = scene.rates_without(&associated);
    let judged = move |v: &Version<'_>| judged(v.steps.clone(), &mut rates);
    versions.iter().map(judged)
}

fn evidence(steps: &[Step]) -> f64 {
    steps.iter().map(|s| s.gain).sum()
}

/// The steps among other clutter: where it is the rarer, an event earns the more.
fn judged(steps: Vec<Step>, rates: &mut Rates<'_>) -> Vec<Step> {
    at_rates(steps, |event| rates.ln_per_s(event, f64::INFINITY))
}

/// The steps against their sounds being a burst of clutter: each is judged among those before it.
pub(super) fn against_bursts(steps: Vec<Step>, rates: &mut Rates<'_>) -> Vec<Step> {
    let mut before = Vec::new();
    at_rates(steps, |event| {
        let ln_rate = rates.ln_per_s_in_burst(event, &before);
        before.push(event);
        ln_rate
    })
}

fn at_rates(mut steps: Vec<Step>, mut ln_rate: impl FnMut(usize) -> f64) -> Vec<Step> {
    for step in &mut steps {
        if let Some(event) = step.event {
            let ln_rate = ln_rate(event);
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
    use crate::units::real;

    fn event(time_s: f64, jitter_s: f64, strength: f64) -> Event {
        Event {
            time_s,
            jitter_s,
            strength,
            loudness: strength.ln(),
            profile: Profile::default(),
        }
    }

    /// A drop of faint impacts with an echo, among knocks nearly as strong.
    fn events(seed: u64) -> Vec<Event> {
        let mut rng = SplitMix64::new(seed);
        let mut events = Vec::new();
        let mut add = |time_s, strength| events.push(event(time_s, 2e-4, strength));
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
    fn what_is_followed_anew_has_hardly_less_evidence() {
        let (mut followed, mut more) = (0, 0);
        for seed in 1..=12 {
            let events = events(seed);
            let clutter = Clutter::new(&events);
            let scene = Scene::new(&events, &clutter);
            let mut rates = scene.rates();
            for start in seeds(&scene).into_iter().take(12) {
                let steps = follow(&scene, &mut rates, start);
                let before = Version::of(&scene, steps.clone()).evidence;
                let track = reassociated(&scene, steps);
                let after = Version::of(&scene, track.steps).evidence;
                assert!(
                    after >= before - LEAST_EVIDENCE,
                    "scene {seed}: {before} to {after}"
                );
                more += usize::from(after > before);
                followed += 1;
            }
        }
        assert!(followed > 100 && more > 10, "{more} of {followed}");
    }

    /// Evidence of a drop of so many impacts of one loudness, with so many knocks as loud before.
    fn evidence_after_knocks(impacts: usize, knocks: usize) -> f64 {
        let mut times_s: Vec<f64> = (0..knocks).map(|i| 0.5 + 0.3 * real(i)).collect();
        let (mut at_s, mut flight_s) = (3.0, 0.4);
        for _ in 0..impacts {
            times_s.push(at_s);
            at_s += flight_s;
            flight_s *= 0.93;
        }
        let alike = |&time_s: &f64| event(time_s, 1e-4, 90.0);
        let events: Vec<Event> = times_s.iter().map(alike).collect();
        let clutter = Clutter::new(&events);
        let scene = Scene::new(&events, &clutter);
        let start = [knocks, knocks + 1, knocks + 2];
        let track = reassociated(&scene, follow(&scene, &mut scene.rates(), start));
        assert!(track.events.len() == impacts);
        track.chain.evidence()
    }

    #[test]
    fn knocks_as_loud_as_the_impacts_cost_a_few_nats_in_all_and_not_a_few_of_each() {
        for impacts in [6, 12, 24] {
            let alone = evidence_after_knocks(impacts, 0);
            for knocks in [1, 3] {
                let cost = alone - evidence_after_knocks(impacts, knocks);
                assert!(
                    cost < 6.0,
                    "{cost} of {alone} for {knocks} and {impacts} impacts"
                );
            }
        }
    }

    /// Loud impacts of a lively ball, each with two echoes of nearly one loudness, in faint noise.
    fn with_echoes(seed: u64) -> (Vec<Event>, Vec<f64>) {
        let mut rng = SplitMix64::new(seed);
        let (mut events, mut impacts_s) = (Vec::new(), Vec::new());
        let mut add = |time_s, strength| events.push(event(time_s, 1.7e-4, strength));
        let (mut at_s, mut flight_s) = (0.13, 0.188);
        for _ in 0..60 {
            impacts_s.push(at_s);
            add(at_s, 90.0 * (0.15 * rng.normal()).exp());
            add(at_s + 10.2e-3, 30.0 * (0.15 * rng.normal()).exp());
            add(at_s + 20.6e-3, 25.0 * (0.3 * rng.normal()).exp());
            at_s += flight_s;
            flight_s *= 0.947 * (0.003 * rng.normal()).exp();
        }
        for _ in 0..200 {
            add(3.5 * rng.uniform(), 4.0 * (0.3 * rng.normal()).exp());
        }
        events.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
        (events, impacts_s)
    }

    #[test]
    fn a_chain_that_goes_over_to_its_echoes_is_taken_as_it_was_before() {
        let mut kept = 0;
        for seed in 1..=12 {
            let (events, impacts_s) = with_echoes(seed);
            let clutter = Clutter::new(&events);
            let scene = Scene::new(&events, &clutter);
            let is_impact = |i: &usize| impacts_s.contains(&events[*i].time_s);
            for start in seeds(&scene).into_iter().take(6) {
                if !start.iter().all(is_impact) {
                    continue;
                }
                let track = reassociated(&scene, follow(&scene, &mut scene.rates(), start));
                let own = track.events.iter().filter(|i| is_impact(i)).count();
                let all = track.events.len();
                assert!(5 * own > 4 * all, "scene {seed}: {own} of {all}");
                kept += 1;
            }
        }
        assert!(kept > 20, "{kept}");
    }
}
