//! What impacts teach of the rise in one band: its course, step by step, around where it is said to be.

use super::bands::{Band, Windows};
use super::focus::MARGIN;
use super::fusion::Posterior;
use super::rise::{Fit, Likelihoods, Rise};
use crate::units::{real, whole};

/// Places below this share of an impact's posterior teach nothing.
const LEAST_SHARE: f64 = 0.01;
/// A level of this share of a size halves what an impact teaches.
const CLEAR: f64 = 0.3;
/// An onset that is known this well counts half, in seconds.
const CERTAIN_S: f64 = 0.1e-3;

/// Sums over impacts, each at its likely places, from some steps before the foot on.
#[derive(Debug)]
pub(super) struct Lesson {
    /// Samples of a step, and those before the foot.
    step: usize,
    lead: usize,
    /// Energy above the level in sizes, and number of samples, weighted, before each step's end.
    above: Vec<f64>,
    weights: Vec<f64>,
}

impl Lesson {
    /// What impacts teach of a rise by where they are likely to begin.
    pub(super) fn of(
        rise: &Rise,
        (band, windows): (&Band, &Windows),
        rate: f64,
        likelihoods: &Likelihoods,
        posteriors: &[Posterior],
    ) -> Self {
        let lead = MARGIN * windows.step;
        let steps = (rise.length() + 2 * lead).div_ceil(windows.step);
        let mut lesson = Self {
            step: windows.step,
            lead,
            above: vec![0.0; steps + 1],
            weights: vec![0.0; steps + 1],
        };
        let each = windows.of.iter().zip(&band.sums).zip(&likelihoods.of);
        for (((window, sums), likelihood), posterior) in each.zip(posteriors) {
            let sure = 1.0 / (1.0 + (posterior.std / (CERTAIN_S * rate)).powi(2));
            let places = posterior.p.iter().enumerate();
            for (place, &p) in places.filter(|(_, p)| **p > LEAST_SHARE) {
                let foot = window.onset(place, windows) - windows.foot;
                lesson.add(sums, foot, likelihood.fits[place], p * sure);
            }
        }
        lesson
    }

    /// Adds an impact whose foot stands at an index of its sums.
    fn add(&mut self, sums: &[f64], foot: usize, fit: Fit, share: f64) {
        let weight = share / (fit.level / fit.size + CLEAR);
        let last = sums.len() - 1;
        let edge = |step: usize| {
            (foot + step * self.step)
                .saturating_sub(self.lead)
                .min(last)
        };
        let first = edge(0);
        for step in 1..self.above.len() {
            let to = edge(step);
            let count = real(to - first);
            self.above[step] += weight * (sums[to] - sums[first] - fit.level * count) / fit.size;
            self.weights[step] += weight * count;
        }
    }

    /// Mean of the rise between two places in samples after the foot; none where nothing was heard.
    pub(super) fn mean(&self, from: f64, to: f64) -> Option<f64> {
        let between = |sums: &[f64]| self.until(sums, to) - self.until(sums, from);
        let weight = between(&self.weights);
        (weight > 0.0).then(|| between(&self.above) / weight)
    }

    /// A sum until a place, even within a step.
    fn until(&self, sums: &[f64], place: f64) -> f64 {
        let last = sums.len() - 1;
        let steps = ((place + real(self.lead)) / real(self.step)).clamp(0.0, real(last));
        let step = whole(steps.floor());
        let share = steps - steps.floor();
        (1.0 - share) * sums[step] + share * sums[(step + 1).min(last)]
    }
}
