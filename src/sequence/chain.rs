//! The impacts of a drop, as the tracker sees them.

use super::reasons::NonImpact;
use super::track::Step;
use crate::impact::{Impact, Status};
use crate::units::real;

/// An impact is doubtful where chance offers this many events as strong in a flight.
const DOUBTFUL_PER_FLIGHT: f64 = 10.0 / 3.0;

/// A drop: one impact after another.
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    /// The impacts in order of time; the standard error is the event's jitter, and 0 where there is none.
    pub impacts: Vec<Impact>,
    /// Strong events between its impacts that are none of them.
    pub rejected: Vec<NonImpact>,
}

impl Chain {
    /// Evidence that this is a drop and no chance, in nats.
    #[must_use]
    pub fn evidence(&self) -> f64 {
        self.impacts.iter().map(|i| i.nats).sum()
    }

    /// How many of its impacts were heard.
    #[must_use]
    pub fn heard(&self) -> usize {
        self.impacts.iter().filter(|i| i.is_heard()).count()
    }

    /// Seconds of the first and last impact.
    #[must_use]
    pub fn span_s(&self) -> (f64, f64) {
        let at = |impact: Option<&Impact>| impact.map_or(0.0, |i| i.time_s);
        (at(self.impacts.first()), at(self.impacts.last()))
    }
}

/// A chain, and which events its impacts are.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Track {
    pub chain: Chain,
    /// Indices of the events of the impacts heard, in order.
    pub events: Vec<usize>,
    /// What it was made of.
    pub steps: Vec<Step>,
}

impl Track {
    pub(super) fn new(steps: Vec<Step>) -> Self {
        Self {
            chain: Chain {
                impacts: impacts(&steps),
                rejected: Vec::new(),
            },
            events: steps.iter().filter_map(|s| s.event).collect(),
            steps,
        }
    }

    /// Whether an event is an impact of both.
    pub(super) fn shares(&self, other: &Self) -> bool {
        let is_own = |event: &usize| self.events.binary_search(event).is_ok();
        other.events.iter().any(is_own)
    }

    /// Its part of most evidence between impacts of another chain.
    pub(super) fn beside(&self, other: &Self) -> Self {
        let is_other = |step: &Step| {
            let event = step.event;
            event.is_some_and(|event| other.events.binary_search(&event).is_ok())
        };
        let parts = self.steps.split(is_other);
        let parts = parts.map(|part| Self::new(part.to_vec()));
        parts
            .max_by(|a, b| a.chain.evidence().total_cmp(&b.chain.evidence()))
            .unwrap_or_else(|| Self::new(Vec::new()))
    }

    /// The impacts heard, each with its event.
    pub(super) fn heard(&self) -> impl Iterator<Item = (usize, &Impact)> {
        let heard = self.chain.impacts.iter().filter(|i| i.is_heard());
        self.events.iter().copied().zip(heard)
    }
}

/// Puts inferred impacts where their neighbours want them: the flights between two heard impacts shrink evenly.
fn impacts(steps: &[Step]) -> Vec<Impact> {
    let mut impacts: Vec<Impact> = steps.iter().map(Impact::from).collect();
    let heard: Vec<usize> = (0..impacts.len())
        .filter(|&i| impacts[i].is_heard())
        .collect();
    for pair in heard.windows(2).filter(|p| p[1] - p[0] > 1) {
        let flight = |k: usize| (impacts[k].time_s - impacts[k - 1].time_s).abs();
        // The mean ratio of the flights just outside the gap, where there are any.
        let ratio = match (pair[0] > 0, pair[1] + 1 < impacts.len()) {
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
        let span = impacts[pair[1]].time_s - impacts[pair[0]].time_s;
        let total: f64 = weights.iter().sum();
        let mut time_s = impacts[pair[0]].time_s;
        for (impact, weight) in impacts[pair[0] + 1..pair[1]].iter_mut().zip(&weights) {
            time_s += span * weight / total;
            impact.time_s = time_s;
        }
    }
    impacts
}

impl From<&Step> for Impact {
    fn from(step: &Step) -> Self {
        Self {
            time_s: step.time_s,
            std_s: step.jitter_s,
            status: match step.event {
                None => Status::Inferred,
                Some(_) if step.chance > DOUBTFUL_PER_FLIGHT => Status::Doubtful,
                Some(_) => Status::Heard,
            },
            nats: step.gain,
        }
    }
}
