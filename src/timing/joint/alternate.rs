//! Alternating least squares: times given the template, then the template given the times.

use super::align::Aligned;
use super::matched_search::{Search, Window, best_match};
use super::normal_equations::NormalEquations;
use super::standard_error::overdispersions;
use super::start::Started;
use super::{Place, Prior};
use crate::signal::correlate::Correlator;
use crate::signal::interpolate::{KERNEL, shifted};
use crate::signal::template::{Sample, Template};
use crate::units::{real, samples_in};

/// Smoothing of the misfit, either way, in seconds.
const MISFIT_S: f64 = 0.1e-3;
/// Farthest that a match moves in one step, in samples. Derived: beyond a sample the expansion in time does not hold.
const STEP: f64 = 1.0;
/// Rounds in which impacts may jump to a better match, and rounds of steps alone that follow.
const SEARCHES: usize = 3;
const ROUNDS: usize = 3;

/// The impacts of a drop and their template, under refinement.
#[derive(Debug)]
pub(super) struct Joint<'a> {
    pub started: &'a Started,
    pub priors: Vec<Prior>,
    pub places: Vec<Place>,
    pub template: Template,
    /// Power of the interference at each impact, where it stood out of the last round's residual: knocks, voices, a hand.
    pub interference: Vec<Vec<f64>>,
    correlator: Correlator,
}

impl<'a> Joint<'a> {
    /// The impacts as they are aligned, with a template of this number of components: more than one where impacts may differ
    /// by their contact stretch.
    pub(super) fn of(started: &'a Started, aligned: Aligned, components: usize) -> Self {
        let mut template = aligned.template;
        let none = vec![0.0; template.len()];
        template.components.resize(components, none);
        Self {
            started,
            interference: vec![Vec::new(); aligned.places.len()],
            priors: aligned.priors,
            places: aligned.places,
            template,
            correlator: Correlator::default(),
        }
    }

    /// Refines times and template in turn, for this number of rounds.
    pub(super) fn alternate(&mut self, rounds: usize) {
        for _ in 0..rounds {
            let heads: Vec<Sample> = (0..self.places.len()).map(|i| self.step(i)).collect();
            self.learn_heads(&heads);
        }
    }

    /// The usual rounds: first those in which impacts may jump. Gives the ambiguity of each: the standard error by rival places
    /// that match nearly as well.
    pub(super) fn search_and_alternate(&mut self) -> Vec<f64> {
        let count = self.places.len();
        let mut ambiguities = vec![0.0; count];
        for round in 0..SEARCHES {
            // Likelihoods count samples as independent, which overdispersion corrects; in the first round it is unknown.
            let overdispersions = match round {
                0 => vec![1.0; count],
                _ => overdispersions(self),
            };
            let heads = (0..count).map(|i| {
                if let Some(ambiguity) = self.search(i, overdispersions[i]) {
                    ambiguities[i] = ambiguity;
                }
                self.step(i)
            });
            let heads: Vec<Sample> = heads.collect();
            self.learn_heads(&heads);
        }
        self.learn_whole();
        self.alternate(ROUNDS);
        ambiguities
    }

    /// Learns the head of the template, and the interference that it leaves.
    fn learn_heads(&mut self, heads: &[Sample]) {
        self.learn(heads);
        let interference = heads
            .iter()
            .enumerate()
            .map(|(i, h)| self.interference_of(i, h));
        self.interference = interference.collect();
    }

    fn learn(&mut self, samples: &[Sample]) {
        let smoothing = samples_in(MISFIT_S, self.started.rate);
        self.template
            .learn(samples, &self.started.contact_stretches, smoothing);
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
        let samples: Vec<Sample> = of.into_iter().map(|i| self.sample(i, length)).collect();
        self.learn(&samples);
    }

    /// Moves an impact to its best match within its reach, the others taken out; gives its ambiguity if there is a match.
    fn search(&mut self, i: usize, overdispersion: f64) -> Option<f64> {
        let prior = self.priors[i];
        let (head, before) = (self.template.head, real(self.template.before));
        let reach = prior.reach() + KERNEL;
        let begin = prior.position.round() - before - real(reach);
        let mut sound = shifted(&self.started.sound, begin, head + 2 * reach);
        self.take_out_others(i, begin, &mut sound);
        let window = Window {
            noise: &self.noise(begin, sound.len(), Some(i)),
            sound: &sound,
        };
        let search = Search {
            prior: prior.from(begin).from(before),
            reach,
            overdispersion,
        };
        let shape = &self.template.shape(i)[..head];
        let found = best_match(&mut self.correlator, window, shape, search)?;
        self.places[i] = Place {
            position: begin + found.position + before,
            amplitude: found.amplitude,
        };
        Some(found.ambiguity)
    }

    /// One step towards the best amplitude and time of an impact, by weighted least squares; gives its sound as it then
    /// stands.
    ///
    /// # Formula
    /// `x = a·s − a·δ·ds/dt` with weights `1/noise`, solved for a and δ.
    fn step(&mut self, i: usize) -> Sample {
        let head = self.template.head;
        let begin = self.begin(i) - real(KERNEL);
        let mut wide = shifted(&self.started.sound, begin, head + 2 * KERNEL);
        self.take_out_others(i, begin, &mut wide);
        let noise = self.noise_and_interference(i, head);
        let (shape, slopes) = (self.template.shape(i), self.template.slopes(i));
        let normal = NormalEquations::of(&wide[KERNEL..KERNEL + head], &noise, shape, slopes);
        let place = &mut self.places[i];
        let (amplitude, moved, _) = normal.solve(place.amplitude);
        place.amplitude = amplitude.max(LEAST_AMPLITUDE * place.amplitude);
        let moved = moved.clamp(-STEP, STEP);
        place.position += moved;
        Sample {
            amplitude: place.amplitude,
            contact_stretch: self.started.contact_stretches[i],
            sound: shifted(&wide, real(KERNEL) + moved, head),
            noise,
        }
    }
}

/// Fewest impacts that the whole template is learnt from alone.
const FEWEST_ALONE: usize = 4;

/// Least share that an amplitude falls to in one step, so that it never vanishes or changes its sign.
const LEAST_AMPLITUDE: f64 = 0.1;
