//! Extending a chain impact by impact, one way in time.

use super::clutter::Rates;
use super::flight::{Doubt, FlightLaw, GATE};
use super::marks::{ln_likeness, ln_loudness_density};
use super::track::{Scene, Step, chance};
use super::{LONGEST_FLIGHT_S, SHORTEST_FLIGHT_S};
use crate::event::Profile;
use crate::order::sort_by_number;

/// A hypothesis is given up so many nats below the best.
const HOPELESS: f64 = 12.0;
/// Hypotheses kept at each step: enough for an echo, a knock and a silence to compete with the true impact.
const BEAM: usize = 5;
/// Nats a step must earn: under chance the best match in a window earns about one, so a chain of chance events loses.
const STEP_COST: f64 = 1.0;
/// Nats by which a chain that goes on must be better than one that ends here; so the last of its impacts earn twice what a
/// step in its midst must.
const END_COST: f64 = 1.0;
/// Nats lost for an expected impact that nobody hears, where impacts are faint …
const SILENCE_COST: f64 = 2.0;
/// … which is below ln of this; among louder ones a silence is less likely by the square of how loud they are.
const FAINT: f64 = 10.0;
/// Impacts in a row that may be unheard.
const LONGEST_SILENCE: usize = 2;
/// Share of the newest impact in the mean loudness.
const NEWEST_SHARE: f64 = 0.3;
/// An impact is sought at most this share of a flight from where it is expected, however little is known …
const WIDEST_WINDOW: f64 = 0.25;
/// … but an accident may take this share of a flight more than other bounces do.
const GREATEST_LOSS: f64 = 0.45;

/// Nats that it costs to say that the recorder lost a part of a flight. Derived: as likely as that the ball lost energy.
const LOST_TIME_COST: f64 = std::f64::consts::LN_2;
/// A flight that nobody heard may be longer than the longest that is followed, by this factor.
const SLACK: f64 = 1.2;
/// Two hypotheses are one if their times are nearer than this, in seconds, and their flights alike to this share.
const SAME_TIME_S: f64 = 1e-9;
const SAME_FLIGHT: f64 = 1e-3;

/// Which way a chain is extended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    Forward,
    Backward,
}

/// A way of continuing a chain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hypothesis {
    /// Where in the trail its last step stands; none before the first.
    pub last: Option<usize>,
    pub law: FlightLaw,
    /// Time of the last impact and the flight that ended (forward) or began (backward) there.
    pub time_s: f64,
    pub flight_s: f64,
    pub doubt: Doubt,
    /// Mean loudness of the last few impacts.
    pub loudness: f64,
    pub score: f64,
    /// What the last impact heard was like.
    pub profile: Profile,
}

/// Steps of all hypotheses, each knowing the one before it: pasts are shared, not copied.
type Trail = Vec<(Option<usize>, Step)>;

/// The search for the impacts after a chain, or before it.
#[derive(Debug)]
pub(super) struct Extension<'s, 'r, 'e> {
    scene: &'s Scene<'e>,
    rates: &'s mut Rates<'r>,
    way: Way,
    trail: Trail,
}

impl<'s, 'r, 'e> Extension<'s, 'r, 'e> {
    pub(super) const fn new(scene: &'s Scene<'e>, rates: &'s mut Rates<'r>, way: Way) -> Self {
        Self {
            scene,
            rates,
            way,
            trail: Trail::new(),
        }
    }

    /// The steps that earn most from a start on.
    pub(super) fn from(mut self, start: Hypothesis) -> Vec<Step> {
        let mut best = start;
        let mut beam = vec![start];
        let mut next = Vec::new();
        while !beam.is_empty() {
            for hypothesis in &beam {
                self.go_on(hypothesis, &mut next);
            }
            sort_by_number(&mut next, |hypothesis: &Hypothesis| -hypothesis.score);
            beam.clear();
            for hypothesis in next.drain(..) {
                let hopeless = hypothesis.score < best.score - HOPELESS;
                if beam.len() < BEAM && !hopeless && !beam.iter().any(|h| hypothesis.is_like(h)) {
                    beam.push(hypothesis);
                }
            }
            let heard = beam
                .iter()
                .filter(|h| h.doubt.unheard == 0)
                .max_by(|a, b| a.score.total_cmp(&b.score));
            if let Some(&best_heard) = heard.filter(|h| h.score > best.score + END_COST) {
                best = best_heard;
            }
        }
        self.steps_to(best.last)
    }

    fn steps_to(&self, mut last: Option<usize>) -> Vec<Step> {
        let mut steps = Vec::new();
        while let Some(index) = last {
            steps.push(self.trail[index].1);
            last = self.trail[index].0;
        }
        steps.reverse();
        steps
    }

    /// All ways to go on by one impact: heard at each event in the window, or not heard.
    fn go_on(&mut self, from: &Hypothesis, next: &mut Vec<Hypothesis>) {
        let (flight, sign) = match self.way {
            Way::Forward => (from.law.next_s(from.flight_s), 1.0),
            Way::Backward => (from.law.previous_s(from.flight_s), -1.0),
        };
        if !(SHORTEST_FLIGHT_S..=SLACK * LONGEST_FLIGHT_S).contains(&flight) {
            return;
        }
        let (earlier, later) = self.in_order(from, flight);
        let expected = from.law.expect(earlier, later, from.doubt);
        let reach = (GATE * expected.variance().sqrt()).min(WIDEST_WINDOW);
        // An accident makes the later flight the shorter one, lost time any.
        let shorter = reach.max(GREATEST_LOSS);
        let longer = match self.way {
            Way::Forward => reach,
            Way::Backward => reach.max(1.0 / (1.0 - GREATEST_LOSS) - 1.0),
        };
        let (a, b) = (
            from.time_s + sign * flight * (1.0 - shorter),
            from.time_s + sign * flight * (1.0 + longer),
        );
        for event in self.scene.between(a.min(b), a.max(b)) {
            self.heard(from, event, flight, next);
        }
        if from.doubt.unheard < LONGEST_SILENCE {
            let mut child = *from;
            child.flight_s = flight;
            child.doubt.unheard += 1;
            let step = Step {
                event: None,
                time_s: from.time_s + sign * flight,
                jitter_s: 0.0,
                gain: -from.silence_cost(),
                ln_rate: 0.0,
                chance: f64::INFINITY,
            };
            next.push(self.after(child, step));
        }
    }

    /// The hypotheses that an event is the next impact, where silence does not explain it better: that the flight to it is one
    /// of the ball's, and if it is much shorter than expected, that the recorder lost the rest of it.
    fn heard(&mut self, from: &Hypothesis, event: usize, whole_s: f64, next: &mut Vec<Hypothesis>) {
        let heard = self.scene.events[event];
        let flight = (heard.time_s - from.time_s).abs();
        let (earlier, later) = self.in_order(from, flight);
        let ratio = later / earlier;
        let flights = SHORTEST_FLIGHT_S..LONGEST_FLIGHT_S;
        if !flights.contains(&flight) {
            return;
        }
        let doubt = Doubt {
            jitter_s: from.doubt.jitter_s.max(heard.jitter_s),
            ..from.doubt
        };
        let expected = from.law.expect(earlier, later, doubt);
        let is_flight = ratio.ln() < expected.greatest();
        if !(is_flight || flight < whole_s) {
            return;
        }
        // The density is of ln T; per second it is divided by T.
        let density = expected.ln_density(ratio.ln() - expected.mean) - flight.ln();
        // Loudness is not monotone, but an impact much fainter than those around it is more likely to be something else.
        // A slower impact is fainter by its speed.
        let slower = match self.way {
            Way::Forward => ratio.ln(),
            Way::Backward => -ratio.ln(),
        };
        let expected_loudness = from.loudness + slower;
        let louder = heard.loudness - expected_loudness;
        let ln_rate = self.rates.ln_per_s(event, flight);
        let like = ln_likeness(&heard, &from.profile);
        let gain = density - ln_rate + ln_loudness_density(louder) - STEP_COST + like;
        if gain < -from.silence_cost() {
            return;
        }
        let mut child = *from;
        let accident = child.law.learn(earlier, later, doubt);
        child.flight_s = flight;
        child.profile = heard.profile;
        child.doubt = Doubt {
            unheard: 0,
            jitter_s: heard.jitter_s,
        };
        child.loudness = expected_loudness + NEWEST_SHARE * louder;
        let step = Step {
            event: Some(event),
            time_s: heard.time_s,
            jitter_s: heard.jitter_s,
            gain,
            ln_rate,
            chance: chance(ln_rate, flight),
        };
        if is_flight {
            next.push(self.after(child, step));
        }
        if accident > 0.5 && flight < whole_s {
            let cut = Hypothesis {
                law: from.law,
                flight_s: whole_s,
                ..child
            };
            let gain = gain - LOST_TIME_COST;
            next.push(self.after(cut, Step { gain, ..step }));
        }
    }

    /// The known and the new flight as earlier and later.
    const fn in_order(&self, from: &Hypothesis, flight_s: f64) -> (f64, f64) {
        match self.way {
            Way::Forward => (from.flight_s, flight_s),
            Way::Backward => (flight_s, from.flight_s),
        }
    }

    fn after(&mut self, mut hypothesis: Hypothesis, step: Step) -> Hypothesis {
        hypothesis.time_s = step.time_s;
        hypothesis.score += step.gain;
        self.trail.push((hypothesis.last, step));
        hypothesis.last = Some(self.trail.len() - 1);
        hypothesis
    }
}

impl Hypothesis {
    /// Whether both have one future: they stand at one event with one flight behind them, so the better past is enough.
    fn is_like(&self, other: &Self) -> bool {
        (other.time_s - self.time_s).abs() < SAME_TIME_S
            && (other.flight_s / self.flight_s - 1.0).abs() < SAME_FLIGHT
    }

    /// Nats lost for an impact that is expected and not heard.
    fn silence_cost(&self) -> f64 {
        SILENCE_COST + 2.0 * (self.loudness - FAINT.ln()).max(0.0)
    }
}
