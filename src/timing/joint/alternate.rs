//! Alternating least squares: times given the template, then the template given the times, until nothing moves.
//!
//! Two loops stand in each other. In the [inner one](Joint::rest) what the sounds differ by, and what else is heard, is held,
//! and times and template come to rest under it; the outer one learns it anew. Learnt in each round, it would feed on its own
//! errors and never rest.

use super::align::Aligned;
use super::damping::Damping;
use super::standard_error::overdispersions;
use super::start::{Started, period};
use super::{Place, Prior, usual_move};
use crate::signal::correlate::Correlator;
use crate::signal::template::{Sample, Template};
use crate::units::{real, samples_in};

/// Smoothing of the misfit, either way, in seconds.
const MISFIT_S: f64 = 0.1e-3;
/// A match this far from the place before is another, in periods of the sound. Derived: steps find what is nearer than half
/// of one, and a third leaves room for a template that is not yet right.
const CYCLE: f64 = 0.33;
/// Rounds in which what is held is learnt anew, at most: more than three times the most seen.
const LIMIT: usize = 200;

/// The impacts of a drop and their template, under refinement.
#[derive(Debug)]
pub(super) struct Joint<'a> {
    pub started: &'a Started,
    pub priors: Vec<Prior>,
    pub places: Vec<Place>,
    pub template: Template,
    /// Variance of each sample of each head, as it is held.
    pub noise: Vec<Vec<f64>>,
    /// Weight of each of those samples, below 1 where more is heard than impacts and noise explain: knocks, voices, a hand.
    pub weights: Vec<Vec<f64>>,
    /// Variance of each match over that by independent samples.
    pub overdispersions: Vec<f64>,
    /// By which share what is held of each impact is learnt anew.
    held: Damping,
    /// What the places are after the priors by, in the median, in samples; none where priors have no say but in a search.
    pub guided: Option<f64>,
    pub correlator: Correlator,
}

impl<'a> Joint<'a> {
    /// The impacts as they are aligned, with a template of this number of components: more than one where impacts may differ
    /// by their contact stretch.
    pub(super) fn of(started: &'a Started, aligned: Aligned, components: usize) -> Self {
        let mut template = aligned.template;
        let none = vec![0.0; template.len()];
        template.components.resize(components, none);
        let count = aligned.places.len();
        Self {
            started,
            noise: vec![Vec::new(); count],
            weights: vec![Vec::new(); count],
            overdispersions: vec![1.0; count],
            held: Damping::of(count),
            priors: aligned.priors,
            places: aligned.places,
            template,
            guided: (components == 1).then_some(0.0),
            correlator: Correlator::default(),
        }
    }

    /// Refines times and template until they rest, without jumps.
    pub(super) fn settle(&mut self) {
        self.settle_while(|_| true);
    }

    /// The same as long as something holds after a round.
    pub(super) fn settle_while(&mut self, holds: impl Fn(&Self) -> bool) {
        self.held = Damping::of(self.places.len());
        let mut heads = self.heads();
        for _ in 0..LIMIT {
            if self.round(&mut heads) || !holds(self) {
                break;
            }
        }
    }

    /// One round of the outer loop, from the heads as they are; whether nothing moved.
    fn round(&mut self, heads: &mut [Sample]) -> bool {
        self.hold(heads);
        let before = self.now();
        self.rest(heads);
        self.learn_misfit(heads);
        let since = self.since(&before);
        self.held.learn(since.steps());
        since.rests()
    }

    /// Refines times and template by the heads first and then by the whole template, with jumps once those rest.
    pub(super) fn settle_whole(&mut self) {
        self.round(&mut self.heads());
        self.learn_whole();
        self.settle();
        if self.jump(&mut Rivals::of(self.places.len())) {
            self.settle();
        }
    }

    /// The same as [settling](Self::settle) with jumps to better matches first. Gives the ambiguity of each: the standard
    /// error by rival places that match nearly as well.
    pub(super) fn search_and_settle(&mut self) -> Vec<f64> {
        let mut rivals = Rivals::of(self.places.len());
        let mut heads = self.heads();
        loop {
            self.hold(&mut heads);
            let before = self.now();
            let jumped = self.jump(&mut rivals);
            self.rest(&mut heads);
            self.learn_misfit(&heads);
            if !jumped || self.since(&before).rests() {
                break;
            }
        }
        self.learn_whole();
        rivals.tried.iter_mut().for_each(Vec::clear);
        self.settle();
        self.jump_and_settle(rivals)
    }

    /// Goes to better matches and settles there, until there are none. Gives the ambiguity of each.
    pub(super) fn jump_and_settle(&mut self, mut rivals: Rivals) -> Vec<f64> {
        while self.jump(&mut rivals) {
            self.settle();
        }
        rivals.ambiguities
    }

    /// Moves each impact to its best match where that is another than those it has had; whether there was one.
    fn jump(&mut self, rivals: &mut Rivals) -> bool {
        let cycle = CYCLE * period(&self.template.mean()[..self.template.head]);
        let mut jumped = false;
        for i in 0..self.places.len() {
            let Some((place, ambiguity)) = self.searched(i) else {
                continue;
            };
            rivals.ambiguities[i] = ambiguity;
            let other = |there: f64| (place.position - there).abs() > cycle;
            let here = self.places[i].position;
            if other(here) && rivals.tried[i].iter().copied().all(other) {
                rivals.tried[i].extend([here, place.position]);
                self.places[i] = place;
                jumped = true;
            }
        }
        jumped
    }

    /// Holds what the impacts differ by, and what else is heard, as they are known now from their heads.
    fn hold(&mut self, heads: &mut [Sample]) {
        for (i, head) in heads.iter_mut().enumerate() {
            head.noise = self.noise(self.begin(i), self.template.head, None);
            head.weights = self.weights_of(i, head);
            for (n, w) in head.noise.iter_mut().zip(&head.weights) {
                *n /= w;
            }
            let share = self.held.share(i);
            blend(&mut head.noise, &self.noise[i], |new, before| {
                // What a sample knows is the reciprocal of its noise, which may be endless.
                (share / new + (1.0 - share) / before).recip()
            });
            blend(&mut head.weights, &self.weights[i], |new, before| {
                before + share * (new - before)
            });
            self.noise[i].clone_from(&head.noise);
            self.weights[i].clone_from(&head.weights);
        }
        self.template.learn_noise(heads);
        self.overdispersions = overdispersions(self, heads);
        self.guided = self.guided.map(|_| usual_move(&self.priors, &self.places));
    }

    /// Share of the energy of the sounds that is not in their template, learnt where they are until it rests.
    pub(super) fn unlike(&mut self) -> f64 {
        let mut heads = self.heads();
        let mut known = 0.0;
        for _ in 0..LIMIT {
            self.hold(&mut heads);
            self.learn_misfit(&heads);
            let now = self.unlike_now();
            if (now - known).abs() < UNLIKE_REST {
                break;
            }
            known = now;
        }
        self.unlike_now()
    }

    fn unlike_now(&self) -> f64 {
        let head = self.template.head;
        let energy: f64 = self.template.mean()[..head].iter().map(|s| s * s).sum();
        let misfit: f64 = self.template.misfit[..head].iter().sum();
        misfit / (misfit + energy)
    }

    /// The heads of all impacts.
    pub(super) fn heads(&self) -> Vec<Sample> {
        let each = (0..self.places.len()).map(|i| self.sample(i, self.template.head));
        each.collect()
    }

    /// Learns what the impacts differ by.
    fn learn_misfit(&mut self, samples: &[Sample]) {
        let smoothing = samples_in(MISFIT_S, self.started.rate);
        let stretches = &self.started.contact_stretches;
        self.template.learn_misfit(samples, stretches, smoothing);
    }

    /// Learns the whole template from those impacts that sound alone, or from all if they are too few.
    fn learn_whole(&mut self) {
        let length = self.template.len();
        let apart = real(length + self.template.before);
        let position = |i: usize| self.places[i].position;
        let alone = |&i: &usize| {
            let before = i
                .checked_sub(1)
                .is_none_or(|j| position(i) - position(j) > apart);
            before && (i + 1 == self.places.len() || position(i + 1) - position(i) > apart)
        };
        let mut of: Vec<usize> = (0..self.places.len()).filter(alone).collect();
        if of.len() < FEWEST_ALONE {
            of = (0..self.places.len()).collect();
        }
        let samples: Vec<Sample> = of.iter().map(|&i| self.sample(i, length)).collect();
        self.template
            .learn_shape(&samples, &self.started.contact_stretches);
        self.learn_misfit(&samples);
    }
}

/// What searches know of the rivals of each impact's place.
pub(super) struct Rivals {
    /// Standard error of each place by rivals that match nearly as well, in samples.
    ambiguities: Vec<f64>,
    /// Places that each impact has left and gone to: it does not come back, or jumps would never end.
    tried: Vec<Vec<f64>>,
}

impl Rivals {
    pub(super) fn of(count: usize) -> Self {
        Self {
            ambiguities: vec![0.0; count],
            tried: vec![Vec::new(); count],
        }
    }
}

/// Makes each new value what it is together with that before; it stays as it is where nothing was before.
fn blend(new: &mut [f64], before: &[f64], together: impl Fn(f64, f64) -> f64) {
    for (new, before) in new.iter_mut().zip(before) {
        *new = together(*new, *before);
    }
}

/// The share of sounds that is unlike rests once it moves by less than this (convention).
const UNLIKE_REST: f64 = 0.01;

/// Fewest impacts that the whole template is learnt from alone.
const FEWEST_ALONE: usize = 4;
