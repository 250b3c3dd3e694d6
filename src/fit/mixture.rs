//! ln e by all models that may be right, and the causes of its variance.

use statrs::distribution::{Continuous, ContinuousCDF, Normal};

use super::fitted::Fitted;
use super::model::{Budget, Parameter};
use super::model_kind::ModelKind;
use super::posterior::{HALVINGS, Part, RANGE_STDS};
use crate::order::sort_by_number;
use crate::statistics::bisected;

/// Parts that together have less than this share of the weight are left out of an interval.
const NEGLIGIBLE: f64 = 1e-4;
/// A normal distribution of ln e, below 0, with its weight.
#[derive(Debug, Clone, Copy)]
struct Component {
    weight: f64,
    mean: f64,
    std: f64,
    /// Share of the normal distribution that is below 0.
    below_one: f64,
}

impl Component {
    fn of(part: &Part, weight: f64) -> Self {
        let (mean, variance) = part.solution.before_least[0];
        let std = variance.max(f64::MIN_POSITIVE).sqrt();
        let below_one = Normal::standard().cdf(-mean / std).max(f64::MIN_POSITIVE);
        Self {
            weight: weight * below_one,
            mean,
            std,
            below_one,
        }
    }

    /// Mean and variance of the part below 0.
    ///
    /// # Formula
    /// `α = −m/σ`, `λ = φ(α)/Φ(α)`: `m − λ·σ`, `σ²·(1 − α·λ − λ²)`
    fn moments(&self) -> (f64, f64) {
        let alpha = -self.mean / self.std;
        if self.below_one <= f64::MIN_POSITIVE {
            return (0.0, 0.0);
        }
        let lambda = Normal::standard().pdf(alpha) / self.below_one;
        let shrunk = (1.0 - alpha * lambda - lambda * lambda).max(0.0);
        (self.mean - lambda * self.std, self.std * self.std * shrunk)
    }

    fn below(&self, ln: f64) -> f64 {
        Normal::standard().cdf((ln - self.mean) / self.std) / self.below_one
    }
}

/// ln e over all models: no ball gains, so it is below 0.
#[derive(Debug)]
pub(super) struct Mixture {
    components: Vec<Component>,
}

impl Mixture {
    /// Of the models of several laws under one likelihood. The odds of laws that could not be fitted go to the models in which e
    /// may depend on the speed in any way, which are the widest.
    ///
    /// `unfitted` is the ratio of those odds to the odds of the laws that were fitted.
    pub(super) fn of(fits: &[Fitted<'_>], unfitted: f64) -> Self {
        let most = fits.iter().map(|f| f.posterior.ln_evidence);
        let most = most.fold(f64::NEG_INFINITY, f64::max);
        let mut components = Vec::new();
        for fit in fits {
            let share = (fit.posterior.ln_evidence - most).exp();
            let flexible = |h: usize| fit.hypotheses[h].kind == ModelKind::Flexible;
            let odds = |h: usize| fit.hypotheses[h].ln_odds.exp();
            let all = 0..fit.hypotheses.len();
            let widest: f64 = all.clone().filter(|&h| flexible(h)).map(odds).sum();
            let total: f64 = all.map(odds).sum();
            let widening = 1.0 + unfitted * total / widest.max(f64::MIN_POSITIVE);
            components.extend(fit.posterior.parts.iter().map(|part| {
                let wider = if flexible(part.model) { widening } else { 1.0 };
                Component::of(part, share * wider * part.weight)
            }));
        }
        Self::normalised(components)
    }

    /// Without the lightest, the weights together 1.
    fn normalised(mut components: Vec<Component>) -> Self {
        let total: f64 = components.iter().map(|c| c.weight).sum();
        sort_by_number(&mut components, |component| -component.weight);
        let mut left = total;
        components.retain(|c| {
            let kept = left > NEGLIGIBLE * total;
            left -= c.weight;
            kept
        });
        let total: f64 = components.iter().map(|c| c.weight).sum();
        for component in &mut components {
            component.weight /= total;
        }
        Self { components }
    }

    /// Median, standard deviation and interval; the median alone where the data do not tell more. The median, as one likely
    /// model with a long tail draws the mean away from all others.
    pub(super) fn parameter(&self, known: bool) -> Parameter {
        let moments: Vec<(f64, f64, f64)> = self
            .components
            .iter()
            .map(|c| {
                let (mean, variance) = c.moments();
                (c.weight, mean, variance)
            })
            .collect();
        let mean: f64 = moments.iter().map(|(w, m, _)| w * m).sum();
        let parts = moments.iter();
        let variance: f64 = parts.map(|(w, m, v)| w * (v + (m - mean).powi(2))).sum();
        let std = variance.sqrt();
        let range = (mean - RANGE_STDS * std, (mean + RANGE_STDS * std).min(0.0));
        let below = |x: f64| -> f64 { self.components.iter().map(|c| c.weight * c.below(x)).sum() };
        let quantile = |p: f64| bisected(range, HALVINGS, |x| below(x) < p);
        Parameter {
            value: quantile(0.5),
            std: known.then_some(std),
            interval95: known.then(|| [0.025, 0.975].map(quantile)),
        }
    }
}

/// The variance of `θ = Σ a_j·z_j` and the priors' part, `a = V·XᵀΣ⁻¹`, by each cause, averaged over models and sizes of the
/// noises of the likeliest law; what the means of models and of sizes differ by is added.
pub(super) fn budget(fits: &[Fitted<'_>]) -> Budget {
    let by_evidence = |a: &&Fitted<'_>, b: &&Fitted<'_>| {
        let (a, b) = (&a.posterior, &b.posterior);
        a.ln_evidence.total_cmp(&b.ln_evidence)
    };
    let Some(fit) = fits.iter().max_by(by_evidence) else {
        return Budget::default();
    };
    let posterior = &fit.posterior;
    let inputs = posterior.mean_of(|p| {
        let priors = fit.models[p.model].priors.iter();
        let pairs = p.solution.covariance[0].iter().zip(priors);
        let known = pairs.filter(|(_, prior)| !prior.is_absent());
        known.map(|(v, prior)| v * v * prior.precision).sum()
    });
    let (mut timing, mut bounce, mut weights) = (0.0, 0.0, 0.0);
    for same_sizes in posterior.parts.chunk_by(|a, b| a.sizes == b.sizes) {
        let heaviest = same_sizes
            .iter()
            .max_by(|a, b| a.weight.total_cmp(&b.weight));
        let Some((part, factors)) =
            heaviest.and_then(|part| Some((part, fit.noise.factors(part.sizes)?)))
        else {
            continue;
        };
        let rows = fit.bounces.design.iter();
        let column = &part.solution.covariance[0];
        let target: Vec<f64> = rows
            .map(|row| row.iter().zip(column).map(|(x, v)| x * v).sum())
            .collect();
        let (by_times, own) = fit.noise.shares(&factors.solve(&target));
        timing += part.weight * part.sizes.timing.powi(2) * by_times;
        bounce += part.weight * part.sizes.bounce.powi(2) * own;
        weights += part.weight;
    }
    let (noise_sizes, model) = between(fits);
    let (timing, bounce) = (timing / weights, bounce / weights);
    let total = timing + bounce + inputs + noise_sizes + model;
    Budget {
        timing: timing / total,
        bounce: bounce / total,
        inputs: inputs / total,
        noise_sizes: noise_sizes / total,
        model: model / total,
    }
}

/// The variance of the mean of ln e between sizes of the noises within a model, and between models.
fn between(fits: &[Fitted<'_>]) -> (f64, f64) {
    let most = fits.iter().map(|f| f.posterior.ln_evidence);
    let most = most.fold(f64::NEG_INFINITY, f64::max);
    let mut models: Vec<(f64, f64, f64)> = Vec::new();
    for fit in fits {
        let share = (fit.posterior.ln_evidence - most).exp();
        let first = models.len();
        models.resize(first + fit.hypotheses.len(), (0.0, 0.0, 0.0));
        for part in &fit.posterior.parts {
            let (weight, sum, square) = &mut models[first + part.model];
            let (w, mean) = (share * part.weight, part.solution.values[0]);
            *weight += w;
            *sum += w * mean;
            *square += w * mean * mean;
        }
    }
    let total: f64 = models.iter().map(|m| m.0).sum();
    let mean = models.iter().map(|m| m.1).sum::<f64>() / total;
    let (mut within, mut among) = (0.0, 0.0);
    for (weight, sum, square) in models.into_iter().filter(|m| m.0 > 0.0) {
        let own = sum / weight;
        within += (square / weight - own * own).max(0.0) * weight / total;
        among += (own - mean).powi(2) * weight / total;
    }
    (within, among)
}
