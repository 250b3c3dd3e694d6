//! One impact: its best match by a search, and one step of least squares towards it.

use super::alternate::Joint;
use super::interference::JUDGED_S;
use super::matched_search::{Search, Window, best_match};
use super::normal_equations::NormalEquations;
use super::{Place, Prior};
use crate::signal::interpolate::{KERNEL, shifted};
use crate::signal::template::Sample;
use crate::units::{real, samples_in};

/// Farthest that a match moves in one step, in samples. Derived: beyond a sample the expansion in time does not hold.
const STEP: f64 = 1.0;
/// Least share that an amplitude falls to in one step, so that it never vanishes or changes its sign.
const LEAST_AMPLITUDE: f64 = 0.1;
/// Degrees of freedom of a prior (convention: as robust regression has them): what the detector saw may be another sound.
pub(super) const FREEDOM: f64 = 3.0;

/// A step of one impact.
#[derive(Debug)]
pub(super) struct Step {
    /// Its sound where it was, the others taken out, with a margin on both sides.
    wide: Vec<f64>,
    pub moved: Moved,
}

/// How far an impact moves, and the standard error of its place, in samples.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moved {
    pub by: f64,
    pub std: f64,
}

impl Joint<'_> {
    /// The best match of an impact within its reach, the others taken out, and its ambiguity.
    pub(super) fn searched(&mut self, i: usize) -> Option<(Place, f64)> {
        let prior = self.priors[i];
        let prior = Prior {
            position: prior.position + self.guided.unwrap_or(0.0),
            ..prior
        };
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
            judged: samples_in(JUDGED_S, self.started.rate),
        };
        let shape = &self.template.shape(i)[..head];
        let found = best_match(&mut self.correlator, window, shape, search)?;
        let place = Place {
            position: begin + found.position + before,
            amplitude: found.amplitude,
        };
        Some((place, found.ambiguity))
    }

    /// One step towards the best amplitude and time of an impact, by weighted least squares.
    ///
    /// # Formula
    /// `x = a·s − a·δ·ds/dt` with weights `1/noise`, solved for a and δ; with I the information of that match, corrected
    /// for overdispersion, and the prior's, J about μ, the place τ moves by `(I·δ + J·(μ − τ))/(I + J)`.
    pub(super) fn step(&mut self, i: usize) -> Step {
        let head = self.template.head;
        let begin = self.begin(i) - real(KERNEL);
        let mut wide = shifted(&self.started.sound, begin, head + 2 * KERNEL);
        self.take_out_others(i, begin, &mut wide);
        let normal = self.normal(i, &wide[KERNEL..KERNEL + head], &self.noise[i]);
        let place = self.places[i];
        let (amplitude, matched, _) = normal.solve(place.amplitude);
        let (off, prior) = self.pull_of_prior(i);
        let information = self.information(i, &normal);
        let by = (information * matched + prior * off) / (information + prior);
        let by = if by.is_finite() { by } else { 0.0 };
        let by = by.clamp(-STEP, STEP);
        self.places[i] = Place {
            position: place.position + by,
            amplitude: amplitude.max(LEAST_AMPLITUDE * place.amplitude),
        };
        Step {
            wide,
            moved: Moved {
                by,
                std: (information + prior).sqrt().recip(),
            },
        }
    }

    /// Goes on from where a step led, by at most [`STEP`], and the head of the impact with it.
    pub(super) fn go_on(&mut self, i: usize, step: &Step, by: f64, head: &mut Sample) {
        let by = by.clamp(-STEP, STEP);
        self.places[i].position += by;
        head.amplitude = self.places[i].amplitude;
        let from = real(KERNEL) + step.moved.by + by;
        head.sound = shifted(&step.wide, from, self.template.head);
    }

    /// Standard error of a place by its match and its prior, in samples.
    pub(super) fn std(&self, i: usize) -> f64 {
        // The information is that of the template, whatever is heard.
        let noise = &self.noise[i];
        let normal = self.normal(i, noise, noise);
        let prior = self.pull_of_prior(i).1;
        (self.information(i, &normal) + prior).sqrt().recip()
    }

    fn normal(&self, i: usize, sound: &[f64], noise: &[f64]) -> NormalEquations {
        NormalEquations::of(
            sound,
            noise,
            self.template.shape(i),
            self.template.slopes(i),
        )
    }

    /// Information of a match on the place of an impact.
    fn information(&self, i: usize, normal: &NormalEquations) -> f64 {
        self.places[i].amplitude.powi(2) * normal.slope_information() / self.overdispersions[i]
    }

    /// How far its prior would move an impact, and its information, of Student's distribution where it stands.
    fn pull_of_prior(&self, i: usize) -> (f64, f64) {
        let Some(usual) = self.guided else {
            return (0.0, 0.0);
        };
        let prior = self.priors[i];
        let off = prior.position + usual - self.places[i].position;
        let z = off / prior.std;
        let share = (FREEDOM + 1.0) / (FREEDOM + z * z);
        (off, share / (prior.std * prior.std))
    }
}
