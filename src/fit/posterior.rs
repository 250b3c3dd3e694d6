//! The posterior of ln e, the sizes of the noises and the models integrated out.

use statrs::distribution::{ContinuousCDF, Normal};

use super::bounces::{Bounces, FIRST_BEND};
use super::grid::Grid;
use super::least_squares::{NormalEquations, solve};
use super::noise::{Noise, Sizes};
use super::prior::Priors;
use super::solution::Solution;
use crate::physics::priors::{BOUNCE_STD, BOUNCE_STD_AT_LARGE, Known};
use crate::statistics::bisected;
use crate::units::whole;

/// Steps over the range of `σ_e` in the search for its likelihood: a factor of four each, twice narrowed.
const COARSE: usize = 10;
const NARROWINGS: usize = 2;
/// Steps over the part that matters: greatest length in `ln σ_e`, and least number.
const FINE_STEP: f64 = 0.5;
const FEWEST_STEPS: usize = 9;
/// Values this many nats below the best are left out.
const NEGLIGIBLE: f64 = 12.0;
/// Models this many nats below the best at every size of the noises are left out.
const UNLIKELY: f64 = 9.0;
/// Prior standard deviation of ln φ: the stated errors of the times are right within a quarter.
const TIMING_SCALE_STD: f64 = 0.25;
/// Nodes and weights of Gauss and Hermite's rule for a standard normal variable: ±√3 and 0.
const HERMITE: [(f64, f64); 3] = [
    (-1.732_050_807_568_877_2, 1.0 / 6.0),
    (0.0, 2.0 / 3.0),
    (1.732_050_807_568_877_2, 1.0 / 6.0),
];
/// ln φ either side of 0 at which its likelihood is evaluated beforehand.
const LOOK: f64 = 0.15;
/// Half the range in which the ends of an interval are sought, in standard deviations: by Chebyshev's inequality one in 64
/// lies beyond at the most, less than the one in forty beyond an end.
pub(super) const RANGE_STDS: f64 = 8.0;
/// That range halved this often leaves a ten-thousandth of a standard deviation.
pub(super) const HALVINGS: usize = 17;
/// Place of most balls in the range of `ln σ_e`, as a share of it: half a per cent.
const COMMON: f64 = 0.67;

/// A model of one law of the impacts: ln of its odds beforehand, and the priors of its parameters.
#[derive(Debug, Clone)]
pub(super) struct Model {
    pub ln_odds: f64,
    pub priors: Priors,
}

/// Mixture of the solutions of all models at all sizes of the noises, each by its share of the evidence.
#[derive(Debug)]
pub(super) struct Posterior {
    pub parts: Vec<Part>,
    /// ln of the evidence, the odds of the models included.
    pub ln_evidence: f64,
    /// Of each model ln of its density, its odds included, and ln e, where the scatter is likeliest; none where it has no
    /// solution.
    pub peaks: Vec<Option<(f64, f64)>>,
}

/// The solution of one model at one size of each noise.
#[derive(Debug, Clone)]
pub(super) struct Part {
    pub weight: f64,
    pub sizes: Sizes,
    /// The model's number.
    pub model: usize,
    pub solution: Solution,
}

impl Posterior {
    /// Integrates over models and both sizes. None if no size of the noises has a solution.
    ///
    /// # Formula
    /// ```text
    /// p(θ) ∝ Σ_m P(m)·∬ L_m(σ_e, φ)·N(θ; θ̂_m, V_m)·p(σ_e)·p(φ) dσ_e dφ
    /// ```
    /// `p(ln σ_e)` is that of balls at large ([`BOUNCE_STD_AT_LARGE`]).
    /// Over `ln σ_e` by the trapezoidal rule, over ln φ by Gauss and Hermite's, laid where the posterior of φ is.
    pub(super) fn over_noise(bounces: &Bounces, noise: &Noise, models: &[Model]) -> Option<Self> {
        let search = Search::of(bounces, noise, models);
        let (range, top) = range(|ln_bounce| Some((search.density(ln_bounce, 1.0)?, ())))?;
        let likely = search.likely();
        let search = search.among(likely);
        let (centre, width) = timing_scale(|ln_timing| search.density(top, ln_timing.exp()))?;
        let mut places = Vec::with_capacity(range.count * HERMITE.len());
        for k in 0..range.count {
            let end = k == 0 || k + 1 == range.count;
            for (node, weight) in HERMITE {
                let ln_timing = centre + width * node;
                // The prior over the normal distribution that the rule is for.
                let prior = 0.5 * (node * node - (ln_timing / TIMING_SCALE_STD).powi(2));
                let share = weight * width / TIMING_SCALE_STD * if end { 0.5 } else { 1.0 };
                places.extend(search.at(range.at(k), ln_timing.exp(), prior + share.ln()));
            }
        }
        Self::normalised(&places, models, range.step, search.peaks())
    }

    /// From ln of the densities at places a step apart.
    fn normalised(
        places: &[Place],
        models: &[Model],
        step: f64,
        peaks: Vec<Option<(f64, f64)>>,
    ) -> Option<Self> {
        let densities = || places.iter().flat_map(|p| &p.ln_densities);
        let best = densities().map(|d| d.1).fold(f64::NEG_INFINITY, f64::max);
        let mut parts = Vec::new();
        let mut total = 0.0;
        for place in places {
            for &(model, ln) in place.ln_densities.iter().filter(|d| d.1 > best - UNLIKELY) {
                let priors = &models[model].priors;
                let mut solution = place.equations.solve(priors)?;
                solution.keep_above_least(priors);
                let weight = (ln - best).exp();
                total += weight;
                parts.push(Part {
                    weight,
                    sizes: place.sizes,
                    model,
                    solution,
                });
            }
        }
        for part in &mut parts {
            part.weight /= total;
        }
        (total > 0.0).then(|| Self {
            parts,
            ln_evidence: best + (total * step).ln(),
            peaks,
        })
    }

    /// The same of some parts alone; none where they have no share.
    pub(super) fn given(&self, is_meant: impl Fn(&Part) -> bool) -> Option<Self> {
        let parts = self.parts.iter().filter(|p| is_meant(p));
        let mut parts: Vec<Part> = parts.cloned().collect();
        let total: f64 = parts.iter().map(|p| p.weight).sum();
        for part in &mut parts {
            part.weight /= total;
        }
        (total > 0.0).then(|| Self {
            parts,
            ln_evidence: self.ln_evidence + total.ln(),
            peaks: self.peaks.clone(),
        })
    }

    /// Mean and standard deviation of a parameter, θ being number 0.
    pub(super) fn moments(&self, parameter: usize) -> (f64, f64) {
        let mean = self.mean_of(|p| p.solution.values[parameter]);
        let variance = self.mean_of(|p| {
            let off = p.solution.values[parameter] - mean;
            p.solution.covariance[parameter][parameter] + off * off
        });
        (mean, variance.sqrt())
    }

    /// The value below which a parameter lies with this probability, if it can have no less than the least.
    pub(super) fn quantile(&self, parameter: usize, least: f64, probability: f64) -> f64 {
        let normal = Normal::standard();
        let parts = self.parts.iter().map(|p| {
            let (mean, variance) = p.solution.before_least[parameter];
            let cut = if least > f64::NEG_INFINITY {
                normal.cdf((least - mean) / variance.sqrt())
            } else {
                0.0
            };
            (p.weight, mean, variance.sqrt(), cut)
        });
        let parts: Vec<_> = parts.collect();
        let below = |x: f64| -> f64 {
            let share = |&(weight, mean, std, cut): &(f64, f64, f64, f64)| {
                let above_least = normal.cdf((x - mean) / std) - cut;
                weight * (above_least / (1.0 - cut).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
            };
            parts.iter().map(share).sum()
        };
        let (mean, std) = self.moments(parameter);
        let range = (mean - RANGE_STDS * std, mean + RANGE_STDS * std);
        bisected(range, HALVINGS, |x| below(x) < probability)
    }

    /// Mean of something over the mixture.
    pub(super) fn mean_of(&self, of: impl Fn(&Part) -> f64) -> f64 {
        self.parts.iter().map(|p| p.weight * of(p)).sum()
    }
}

/// The models at one size of each noise: of each that has a solution its number and ln of its density.
struct Place {
    sizes: Sizes,
    equations: NormalEquations,
    ln_densities: Vec<(usize, f64)>,
}

/// The models at sizes of the noises, and how likely each was at best.
struct Search<'a> {
    bounces: &'a Bounces,
    noise: &'a Noise,
    models: &'a [Model],
    /// Numbers of the models that are looked at.
    among: Vec<usize>,
    with_bends: bool,
    peaks: std::cell::RefCell<Vec<Option<(f64, f64)>>>,
}

impl<'a> Search<'a> {
    fn of(bounces: &'a Bounces, noise: &'a Noise, models: &'a [Model]) -> Self {
        let search = Self {
            bounces,
            noise,
            models,
            among: Vec::new(),
            with_bends: false,
            peaks: std::cell::RefCell::new(vec![None; models.len()]),
        };
        search.among((0..models.len()).collect())
    }

    /// Among models of these numbers.
    fn among(mut self, among: Vec<usize>) -> Self {
        let has_bends = |&m: &usize| !self.models[m].priors[FIRST_BEND].is_absent();
        self.with_bends = among.iter().any(has_bends);
        self.among = among;
        self
    }

    /// ln of the densities over `ln σ_e` at these sizes.
    fn at(&self, ln_bounce: f64, timing: f64, ln_share: f64) -> Option<Place> {
        let sizes = Sizes {
            bounce: ln_bounce.exp(),
            timing,
        };
        let equations = NormalEquations::of(self.bounces, self.noise, sizes, self.with_bends)?;
        let ln_prior = ln_density(ln_bounce);
        let mut peaks = self.peaks.borrow_mut();
        let ln_densities = self.among.iter().filter_map(|&number| {
            let model = &self.models[number];
            let (ln_likelihood, ln_e) = equations.ln_likelihood(&model.priors)?;
            let ln = ln_likelihood + model.ln_odds + ln_prior;
            if peaks[number].is_none_or(|(most, _)| ln > most) {
                peaks[number] = Some((ln, ln_e));
            }
            Some((number, ln + ln_share))
        });
        Some(Place {
            sizes,
            ln_densities: ln_densities.collect(),
            equations,
        })
    }

    /// ln of the density of all models together.
    fn density(&self, ln_bounce: f64, timing: f64) -> Option<f64> {
        let place = self.at(ln_bounce, timing, 0.0)?;
        let lns = || place.ln_densities.iter().map(|d| d.1);
        let most = lns().fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = lns().map(|ln| (ln - most).exp()).sum();
        (sum > 0.0).then(|| most + sum.ln())
    }

    /// Numbers of the models that were likely at some size of the noises.
    fn likely(&self) -> Vec<usize> {
        let peaks = self.peaks.borrow();
        let ln = |m: usize| peaks[m].map_or(f64::NEG_INFINITY, |p| p.0);
        let most = (0..peaks.len()).map(ln).fold(f64::NEG_INFINITY, f64::max);
        (0..peaks.len())
            .filter(|&m| ln(m) > most - UNLIKELY)
            .collect()
    }

    fn peaks(self) -> Vec<Option<(f64, f64)>> {
        self.peaks.into_inner()
    }
}

/// ln of the density of `ln σ_e` for balls at large.
///
/// # Formula
/// Student's distribution of four degrees of freedom: `p(u) = (3/8)·(1 + u²/4)^(−5/2)/s`, `u = (ln σ_e − m)/s`.
pub(super) fn ln_density(ln_bounce: f64) -> f64 {
    let Known { value, std } = BOUNCE_STD_AT_LARGE;
    let off = (ln_bounce - value) / std;
    (0.375 / std).ln() - 2.5 * (0.25 * off * off).ln_1p()
}

/// The sizes of the noises that are likeliest, with the stated errors of the times, and their solution.
pub(super) fn likeliest(
    bounces: &Bounces,
    noise: &Noise,
    priors: &Priors,
) -> Option<(Sizes, Solution)> {
    let at = |ln_bounce: f64| {
        let sizes = Sizes {
            bounce: ln_bounce.exp(),
            timing: 1.0,
        };
        let mut solution = solve(bounces, noise, sizes, priors)?;
        solution.ln_likelihood += ln_density(ln_bounce);
        Some((solution.ln_likelihood, (sizes, solution)))
    };
    let (range, top) = range(at)?;
    let hill = range.hill(top, 0.0, at)?;
    // Taken between the places of the grid, so that it is continuous as the trial moves.
    match at(hill.vertex) {
        Some((likelihood, found)) if likelihood >= hill.top.1 => Some(found),
        _ => Some(hill.top.2),
    }
}

/// The part of the range of `ln σ_e` that matters, in fine steps, and about the place in it of greatest density.
fn range<T>(ln_density: impl Fn(f64) -> Option<(f64, T)>) -> Option<(Grid, f64)> {
    let (first, last) = (BOUNCE_STD.0.ln(), BOUNCE_STD.1.ln());
    let (mut from, mut to) = (first, last);
    let mut top = first + COMMON * (last - first);
    for _ in 0..NARROWINGS {
        let grid = Grid::new(from, to, COARSE);
        let hill = grid.hill(top, NEGLIGIBLE, &ln_density)?;
        top = hill.top.0;
        from = (hill.lowest - grid.step).max(first);
        to = (hill.highest + grid.step).min(last);
    }
    let count = whole(((to - from) / FINE_STEP).ceil()) + 1;
    Some((Grid::new(from, to, count.max(FEWEST_STEPS)), top))
}

/// Centre and width of the posterior of ln φ, by a parabola through three of its values.
fn timing_scale(ln_likelihood: impl Fn(f64) -> Option<f64>) -> Option<(f64, f64)> {
    let ln = |x: f64| Some(ln_likelihood(x)? - 0.5 * (x / TIMING_SCALE_STD).powi(2));
    let (less, same, more) = (ln(-LOOK)?, ln(0.0)?, ln(LOOK)?);
    let curvature = (2.0 * same - less - more) / (LOOK * LOOK);
    // The curvature is at least that of the prior: the likelihood can bend the other way.
    let width = curvature.max(TIMING_SCALE_STD.powi(-2)).sqrt().recip();
    let centre = width * width * (more - less) / (2.0 * LOOK);
    Some((
        centre.clamp(-2.0 * TIMING_SCALE_STD, 2.0 * TIMING_SCALE_STD),
        width,
    ))
}
