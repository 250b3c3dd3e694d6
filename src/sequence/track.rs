//! Following a drop from three of its impacts, forwards and backwards in time.

use std::cell::RefCell;
use std::collections::HashMap;

use super::clutter::{Clutter, Explained};
use super::flight::{Doubt, FlightLaw, GATE};
use super::{Event, Settings};

/// Hypotheses kept at each step: enough for an echo, a knock and a silence to compete with the true impact.
const BEAM: usize = 5;
/// Nats a step must earn: under chance the best match in a window earns about one, so a chain of chance events loses.
const STEP_COST: f64 = 3.5;
/// Nats lost for an expected impact that nobody hears, where impacts are faint …
const SILENCE_COST: f64 = 2.0;
/// … which is below this strength; among louder ones a silence is less likely by the square of their strength.
const FAINT: f64 = 10.0;
/// Impacts in a row that may be unheard.
const LONGEST_SILENCE: usize = 2;
/// No flight is longer than the one before, up to scatter.
const GROWTH: f64 = 1.03;
/// No flight is shorter than this share of the one before.
const SHRINKAGE: f64 = 0.2;
/// Spread of ln strength from one impact to the next; the detector's strengths vary by a factor of two.
const LOUDNESS_SPREAD: f64 = 0.7;
/// Share of the newest impact in the mean loudness.
const NEWEST_SHARE: f64 = 0.3;
/// An impact is sought at most this share of a flight from where it is expected, however little is known.
const WIDEST_WINDOW: f64 = 0.25;

/// Everything that tracking looks at and does not change.
#[derive(Debug)]
pub struct Scene<'a> {
    /// The events in order of time.
    pub events: &'a [Event],
    /// What is known of balls.
    pub settings: &'a Settings,
    clutter: &'a Clutter,
    explained: Explained,
    /// Rates that were asked for: hypotheses meet at the same events again and again.
    ln_rates: RefCell<HashMap<usize, f64>>,
}

impl<'a> Scene<'a> {
    /// All events, none of them explained.
    #[must_use]
    pub fn new(events: &'a [Event], clutter: &'a Clutter, settings: &'a Settings) -> Self {
        Self {
            events,
            settings,
            clutter,
            explained: Explained::default(),
            ln_rates: RefCell::default(),
        }
    }

    /// The same events, some of them no longer clutter: indices in order.
    #[must_use]
    pub fn without(&self, explained: &[usize]) -> Self {
        let explained = Explained::new(explained.iter().map(|&i| self.events[i]).collect());
        Self {
            explained,
            ln_rates: RefCell::default(),
            ..*self
        }
    }

    /// ln of the rate of clutter at least as strong as this event, per second.
    pub(super) fn ln_rate(&self, event: usize) -> f64 {
        let rate = || {
            self.clutter
                .rate_per_s(&self.events[event], &self.explained)
                .ln()
        };
        *self.ln_rates.borrow_mut().entry(event).or_insert_with(rate)
    }

    /// The length of the recording in seconds, at least one.
    pub(super) const fn duration_s(&self) -> f64 {
        self.clutter.duration_s()
    }

    /// The greatest jitter of three events.
    pub(super) fn jitter_s(&self, events: [usize; 3]) -> f64 {
        events
            .iter()
            .map(|&i| self.events[i].jitter_s)
            .fold(0.0, f64::max)
    }

    /// Indices of the events in an interval of time.
    pub(super) fn between(&self, from_s: f64, to_s: f64) -> std::ops::Range<usize> {
        let first = self.events.partition_point(|e| e.time_s < from_s);
        let last = self.events.partition_point(|e| e.time_s <= to_s);
        first..last.max(first)
    }
}

/// Which way a chain is extended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    Forward,
    Backward,
}

/// One impact of a chain: an event, or a time at which one is inferred.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// The event; none where the impact is inferred.
    pub event: Option<usize>,
    /// Seconds from the first sample.
    pub time_s: f64,
    /// How far off that may be, in seconds; 0 where the impact is inferred.
    pub jitter_s: f64,
    /// Nats this step earned.
    pub gain: f64,
    /// How many events as strong chance would offer near it: within a few hundredths of its flight.
    pub chance: f64,
}

/// A share of a flight within which an event would be taken for the impact, both ways together.
const MATCH_WIDTH: f64 = 0.06;

impl Scene<'_> {
    fn chance(&self, event: usize, flight_s: f64) -> f64 {
        self.ln_rate(event).exp() * MATCH_WIDTH * flight_s
    }
}

/// A way of continuing a chain.
#[derive(Debug, Clone, Copy)]
struct Hypothesis {
    /// Where in the trail its last step stands; none before the first.
    last: Option<usize>,
    law: FlightLaw,
    /// Time of the last impact and the flight that ended (forward) or began (backward) there.
    time_s: f64,
    flight_s: f64,
    doubt: Doubt,
    /// Mean of ln strength of the last few impacts.
    loudness: f64,
    score: f64,
}

/// Steps of all hypotheses, each knowing the one before it: pasts are shared, not copied.
type Trail = Vec<(Option<usize>, Step)>;

/// Extends three impacts both ways and gives the whole chain in order of time, with its evidence in nats.
#[must_use]
pub fn follow(scene: &Scene<'_>, seed: [usize; 3]) -> (Vec<Step>, f64) {
    let t = seed.map(|i| scene.events[i].time_s);
    let (first, second) = (t[1] - t[0], t[2] - t[1]);
    let mut law = FlightLaw::prior(scene.settings);
    let doubt = Doubt {
        unheard: 0,
        jitter_s: scene.jitter_s(seed),
    };
    let expected = law.expect(first, second, doubt);
    let ratio_density = expected.ln_density((second / first).ln() - expected.mean) - second.ln();
    law.learn(first, second, doubt);
    // The first impact may be anywhere in the recording, the second anywhere within the longest flight.
    let gains = [
        -scene.ln_rate(seed[0]) - scene.duration_s().ln(),
        -scene.ln_rate(seed[1]) - scene.settings.longest_flight_s.ln(),
        ratio_density - scene.ln_rate(seed[2]),
    ];
    let middle: Vec<Step> = (0..3)
        .map(|i| Step {
            event: Some(seed[i]),
            time_s: t[i],
            jitter_s: scene.events[seed[i]].jitter_s,
            gain: gains[i],
            chance: scene.chance(seed[i], second),
        })
        .collect();
    let loudness = seed.iter().map(|&i| ln_strength(scene, i)).sum::<f64>() / 3.0;
    let start = Hypothesis {
        last: None,
        law,
        time_s: t[2],
        flight_s: second,
        doubt,
        loudness,
        score: 0.0,
    };
    let forward = extend(scene, start, Way::Forward);
    let mut law_back = law;
    let late: Vec<f64> = std::iter::once(t[2])
        .chain(forward.iter().map(|s| s.time_s))
        .collect();
    relearn(&mut law_back, second, &late, doubt);
    let start = Hypothesis {
        law: law_back.at_large(scene.settings),
        time_s: t[0],
        flight_s: first,
        ..start
    };
    let backward = extend(scene, start, Way::Backward);
    let chain: Vec<Step> = backward
        .into_iter()
        .rev()
        .chain(middle)
        .chain(forward)
        .collect();
    let evidence = chain.iter().map(|s| s.gain).sum();
    (chain, evidence)
}

/// The flights found forwards sharpen the law before it is used backwards.
fn relearn(law: &mut FlightLaw, mut flight_s: f64, times_s: &[f64], doubt: Doubt) {
    for pair in times_s.windows(2) {
        let next = pair[1] - pair[0];
        law.learn(flight_s, next, doubt);
        flight_s = next;
    }
}

fn ln_strength(scene: &Scene<'_>, event: usize) -> f64 {
    scene.events[event].strength.max(f64::MIN_POSITIVE).ln()
}

fn extend(scene: &Scene<'_>, start: Hypothesis, way: Way) -> Vec<Step> {
    let mut trail = Trail::new();
    let mut best = start;
    let mut beam = vec![start];
    let mut next = Vec::new();
    while !beam.is_empty() {
        for hypothesis in &beam {
            hypothesis.go_on(scene, way, &mut trail, &mut next);
        }
        next.sort_by(|a: &Hypothesis, b| b.score.total_cmp(&a.score));
        beam.clear();
        for h in next.drain(..) {
            // Hypotheses at one event with one flight behind them have one future: the better past is enough.
            let same = |o: &Hypothesis| {
                (o.time_s - h.time_s).abs() < 1e-9 && (o.flight_s / h.flight_s - 1.0).abs() < 1e-3
            };
            if beam.len() < BEAM && !beam.iter().any(same) {
                beam.push(h);
            }
        }
        let heard = beam
            .iter()
            .filter(|h| h.doubt.unheard == 0)
            .max_by(|a, b| a.score.total_cmp(&b.score));
        if let Some(&leader) = heard.filter(|h| h.score > best.score) {
            best = leader;
        }
    }
    let mut steps = Vec::new();
    let mut at = best.last;
    while let Some(index) = at {
        steps.push(trail[index].1);
        at = trail[index].0;
    }
    steps.reverse();
    steps
}

impl Hypothesis {
    /// All ways to go on by one impact: heard at each event in the window, or not heard.
    fn go_on(&self, scene: &Scene<'_>, way: Way, trail: &mut Trail, next: &mut Vec<Self>) {
        let (flight, sign) = match way {
            Way::Forward => (self.law.next_s(self.flight_s), 1.0),
            Way::Backward => (self.law.previous_s(self.flight_s), -1.0),
        };
        if flight < scene.settings.shortest_flight_s
            || flight > 1.2 * scene.settings.longest_flight_s
        {
            return;
        }
        let (earlier, later) = self.in_order(flight, way);
        let sd = self
            .law
            .expect(earlier, later, self.doubt)
            .variance()
            .sqrt();
        let reach = flight * (GATE * sd).min(WIDEST_WINDOW);
        let (a, b) = (
            self.time_s + sign * (flight - reach),
            self.time_s + sign * (flight + reach),
        );
        for event in scene.between(a.min(b), a.max(b)) {
            next.extend(self.heard(scene, way, event, trail));
        }
        if self.doubt.unheard < LONGEST_SILENCE {
            let mut child = *self;
            child.flight_s = flight;
            child.doubt.unheard += 1;
            let step = Step {
                event: None,
                time_s: self.time_s + sign * flight,
                jitter_s: 0.0,
                gain: -self.silence_cost(),
                chance: 1.0,
            };
            next.push(child.after(step, trail));
        }
    }

    fn heard(&self, scene: &Scene<'_>, way: Way, event: usize, trail: &mut Trail) -> Option<Self> {
        let time_s = scene.events[event].time_s;
        let flight = (time_s - self.time_s).abs();
        let (earlier, later) = self.in_order(flight, way);
        let ratio = later / earlier;
        let possible = (SHRINKAGE..GROWTH).contains(&ratio)
            && (scene.settings.shortest_flight_s..scene.settings.longest_flight_s)
                .contains(&flight);
        if !possible {
            return None;
        }
        let jitter_s = self.doubt.jitter_s.max(scene.events[event].jitter_s);
        let doubt = Doubt {
            jitter_s,
            ..self.doubt
        };
        let expected = self.law.expect(earlier, later, doubt);
        // The density is of ln T; per second it is divided by T.
        let density = expected.ln_density(ratio.ln() - expected.mean) - flight.ln();
        // Loudness is not monotone, but an impact much fainter than those around it is more likely to be something else.
        // A slower impact is fainter by its speed.
        let slower = if way == Way::Forward { ratio.ln() } else { 0.0 };
        let expected_loudness = self.loudness + slower;
        let fainter = (expected_loudness - ln_strength(scene, event)).max(0.0) / LOUDNESS_SPREAD;
        let gain = density - scene.ln_rate(event) - 0.5 * fainter * fainter - STEP_COST;
        if gain < -self.silence_cost() {
            // Silence explains it better.
            return None;
        }
        let mut child = *self;
        child.law.learn(earlier, later, doubt);
        child.flight_s = flight;
        child.doubt = Doubt {
            unheard: 0,
            jitter_s: scene.events[event].jitter_s,
        };
        child.loudness =
            expected_loudness + NEWEST_SHARE * (ln_strength(scene, event) - expected_loudness);
        Some(child.after(
            Step {
                event: Some(event),
                time_s,
                jitter_s: scene.events[event].jitter_s,
                gain,
                chance: scene.chance(event, flight),
            },
            trail,
        ))
    }

    /// Nats lost for an impact that is expected and not heard.
    fn silence_cost(&self) -> f64 {
        SILENCE_COST + 2.0 * (self.loudness - FAINT.ln()).max(0.0)
    }

    /// The known and the new flight as earlier and later.
    const fn in_order(&self, flight_s: f64, way: Way) -> (f64, f64) {
        match way {
            Way::Forward => (self.flight_s, flight_s),
            Way::Backward => (flight_s, self.flight_s),
        }
    }

    fn after(mut self, step: Step, trail: &mut Trail) -> Self {
        self.time_s = step.time_s;
        self.score += step.gain;
        trail.push((self.last, step));
        self.last = Some(trail.len() - 1);
        self
    }
}
