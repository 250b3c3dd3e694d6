//! The drops of a recording: the best chains that share no event.

use super::clutter::Clutter;
use super::reasons::{self, Reason, Rejected};
use super::reassociate::reassociated;
use super::seeds::seeds;
use super::track::{Scene, Step, follow};
use super::{Event, Settings};
use crate::units::real;

/// One impact of a drop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// Index of the event; none where the impact is inferred from its neighbours.
    pub event: Option<usize>,
    /// Seconds from the first sample.
    pub time_s: f64,
    /// How far off the event's time may be, in seconds (one standard deviation); 0 where there is none.
    pub jitter_s: f64,
    /// What the event earned in nats.
    pub gain: f64,
    /// Whether chance offers events as strong so often here that this one may be none of the ball's.
    pub doubtful: bool,
}

/// An impact is doubtful where chance offers this many events as strong in a flight.
const DOUBTFUL_PER_FLIGHT: f64 = 10.0 / 3.0;

/// A drop: one impact after another.
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    /// The impacts in order of time.
    pub links: Vec<Link>,
    /// Evidence that this is a drop and no chance, in nats.
    pub evidence: f64,
    /// Strong events between its impacts that are none of them.
    pub rejected: Vec<Rejected>,
}

impl Chain {
    pub(super) fn new(steps: &[Step]) -> Self {
        Self {
            links: links(steps),
            evidence: steps.iter().map(|s| s.gain).sum(),
            rejected: Vec::new(),
        }
    }

    /// Indices of the events that are its impacts.
    pub(super) fn events(&self) -> impl Iterator<Item = usize> + '_ {
        self.links.iter().filter_map(|l| l.event)
    }

    /// How many of its impacts were heard.
    #[must_use]
    pub fn heard(&self) -> usize {
        self.events().count()
    }

    /// Seconds of the first and last impact.
    #[must_use]
    pub fn span_s(&self) -> (f64, f64) {
        let at = |link: Option<&Link>| link.map_or(0.0, |l| l.time_s);
        (at(self.links.first()), at(self.links.last()))
    }
}

/// What was found among the events.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Found {
    /// The drops, in order of time.
    pub drops: Vec<Chain>,
    /// Strong events outside any drop.
    pub rejected: Vec<Rejected>,
    /// How many weaker events were left without a word each.
    pub weak: usize,
}

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
pub fn find(events: &[Event], settings: &Settings) -> Found {
    if events.is_empty() {
        return Found::default();
    }
    let clutter = Clutter::new(events);
    let scene = Scene::new(events, &clutter, settings);
    let mut taken = vec![false; events.len()];
    let mut explained = vec![false; events.len()];
    let mut drops: Vec<Chain> = Vec::new();
    loop {
        let left: Vec<usize> = (0..events.len()).filter(|&i| !explained[i]).collect();
        let found = disjoint(events, &left, &drops, settings);
        if found.is_empty() {
            break;
        }
        for chain in found {
            for i in chain.events() {
                taken[i] = true;
            }
            for i in reasons::own_sounds(&scene, &chain) {
                explained[i] = true;
            }
            drops.push(chain);
        }
    }
    drops.sort_by(|a, b| a.span_s().0.total_cmp(&b.span_s().0));
    reasons::explain(&scene, drops, &taken)
}

/// The best chains among some of the events that share none, and are no echo of one another or of the drops known.
fn disjoint(events: &[Event], left: &[usize], known: &[Chain], settings: &Settings) -> Vec<Chain> {
    let some: Vec<Event> = left.iter().map(|&i| events[i]).collect();
    let clutter = Clutter::new(&some);
    let scene = Scene::new(&some, &clutter, settings);
    let mut chains = chains(&scene);
    chains.retain(|chain| is_drop(chain, settings));
    chains.sort_by(|a, b| b.evidence.total_cmp(&a.evidence));
    let mut taken = vec![false; some.len()];
    let mut found: Vec<Chain> = Vec::new();
    for mut chain in chains {
        let mut before = known.iter().chain(&found);
        if chain.events().any(|i| taken[i]) || before.any(|d| reasons::is_echo_of(&chain, d)) {
            continue;
        }
        chain.events().for_each(|i| taken[i] = true);
        for link in &mut chain.links {
            link.event = link.event.map(|i| left[i]);
        }
        found.push(chain);
    }
    found
}

/// Follows a known chain through other events, from the three neighbouring impacts among them that earn most.
///
/// `impacts_s` are the times of all impacts of the chain and how far off each may be, in seconds. None if no three
/// neighbouring impacts have events.
#[must_use]
pub fn follow_again(
    events: &[Event],
    impacts_s: &[(f64, f64)],
    settings: &Settings,
) -> Option<Chain> {
    let clutter = Clutter::new(events);
    let scene = Scene::new(events, &clutter, settings);
    follow_known(&scene, impacts_s)
}

fn follow_known(scene: &Scene<'_>, impacts_s: &[(f64, f64)]) -> Option<Chain> {
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
fn chains(scene: &Scene<'_>) -> Vec<Chain> {
    let mut chains: Vec<Chain> = Vec::new();
    // The chains that each event stands in. A seed whose events all stand in one would only find it again.
    let mut known: Vec<Vec<usize>> = vec![Vec::new(); scene.events.len()];
    let mut rates = scene.rates();
    for seed in seeds(scene) {
        let [first, second, third] = seed.map(|i| &known[i]);
        if first
            .iter()
            .any(|chain| second.contains(chain) && third.contains(chain))
        {
            continue;
        }
        let steps = follow(scene, &mut rates, seed);
        if steps.iter().filter(|s| s.event.is_some()).count() < FEWEST {
            continue;
        }
        let chain = reassociated(scene, steps);
        for event in chain.events() {
            known[event].push(chains.len());
        }
        chains.push(chain);
    }
    chains
}

fn is_drop(chain: &Chain, settings: &Settings) -> bool {
    let flights: Vec<f64> = chain
        .links
        .windows(2)
        .map(|w| w[1].time_s - w[0].time_s)
        .collect();
    let (Some(&first), Some(&last)) = (flights.first(), flights.last()) else {
        return false;
    };
    let ratio = (last / first).powf(1.0 / real((flights.len() - 1).max(1)));
    chain.heard() >= FEWEST
        && chain.evidence >= settings.least_evidence
        && last <= LEAST_SHRINKAGE * first
        && first >= LEAST_FLIGHT_S
        && ratio <= GREATEST_RATIO
}

/// Puts inferred impacts where their neighbours want them: the flights between two heard impacts shrink evenly.
fn links(steps: &[Step]) -> Vec<Link> {
    let mut links: Vec<Link> = steps
        .iter()
        .map(|s| Link {
            event: s.event,
            time_s: s.time_s,
            jitter_s: s.jitter_s,
            gain: s.gain,
            doubtful: s.chance > DOUBTFUL_PER_FLIGHT,
        })
        .collect();
    let heard: Vec<usize> = (0..links.len())
        .filter(|&i| links[i].event.is_some())
        .collect();
    for pair in heard.windows(2).filter(|p| p[1] - p[0] > 1) {
        let flight = |k: usize| (links[k].time_s - links[k - 1].time_s).abs();
        // The mean ratio of the flights just outside the gap, where there are any.
        let ratio = match (pair[0] > 0, pair[1] + 1 < links.len()) {
            (true, true) => {
                (flight(pair[1] + 1) / flight(pair[0])).powf(1.0 / real(pair[1] + 1 - pair[0]))
            }
            _ => 1.0,
        };
        let weights: Vec<f64> = (pair[0]..pair[1])
            .scan(1.0, |w, _| {
                *w *= ratio;
                Some(*w)
            })
            .collect();
        let span = links[pair[1]].time_s - links[pair[0]].time_s;
        let total: f64 = weights.iter().sum();
        let mut time_s = links[pair[0]].time_s;
        for (link, weight) in links[pair[0] + 1..pair[1]].iter_mut().zip(&weights) {
            time_s += span * weight / total;
            link.time_s = time_s;
        }
    }
    links
}

/// An event's reason for being left out, with its time.
pub(super) fn reject(event: &Event, reason: Reason) -> Rejected {
    Rejected {
        time_s: event.time_s,
        reason,
    }
}
