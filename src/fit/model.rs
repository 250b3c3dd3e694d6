//! The fit of the models to the impact times of a drop: e with an interval that covers it.

use super::bounces::{Bounces, CONTACT, DRAG, PARAMETERS, SPEED};
use super::fitted::Fitted;
use super::hypotheses::Hypothesis;
use super::mixture::{self, Mixture};
use super::model_kind::ModelKind;
use super::outlier::Outliers;
use super::posterior::{Model, Part, Posterior};
use crate::linalg::dot;
use crate::statistics::NORMAL95;

/// Fewest impacts with a ratio of flights.
pub(super) const FEWEST: usize = 3;

/// A model fitted to a drop.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// ln e at the mean speed, by all models: median, standard deviation, and the ends of the interval that holds it with 95 %;
    /// none for one ratio alone.
    pub ln_restitution: Parameter,
    /// ln e at the mean speed by this model alone.
    pub own_ln_restitution: f64,
    /// C in seconds, if the model has it; of fast impacts for a linear ball.
    pub contact_s: Option<Parameter>,
    /// K in s⁻², if the model has it.
    pub drag_per_s2: Option<Parameter>,
    /// p, if the model has it.
    pub exponent: Option<Parameter>,
    /// `σ_e`, the scatter of ln e from bounce to bounce.
    pub bounce_std: f64,
    /// φ, the ratio of the errors of the times to those stated.
    pub timing_scale: f64,
    /// Geometric mean of the speeds of arrival, as `2v/g` in seconds.
    pub mean_speed_s: f64,
    /// ln of the evidence for the model: comparable between models of one drop.
    pub ln_evidence: f64,
    /// The variance of ln e by cause.
    pub budget: Budget,
    /// Outliers among bounces and times.
    pub outliers: Outliers,
}

/// A number with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Mean.
    pub value: f64,
    /// Standard deviation; none where the data do not tell.
    pub std: Option<f64>,
    /// 95 % interval; none where the data do not tell.
    pub interval95: Option<[f64; 2]>,
}

/// Shares of the variance of ln e by cause; together 1.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub struct Budget {
    /// By the errors of the times.
    pub timing: f64,
    /// By the scatter of the bounces.
    pub bounce: f64,
    /// By the priors of contact, drag and speed dependence: their inputs' errors.
    pub inputs: f64,
    /// By the uncertainty of the sizes of the noises.
    pub noise_sizes: f64,
    /// By the uncertainty which model is right.
    pub model: f64,
}

impl Fit {
    /// Of the law that the selected kind of model is of; ln e is that of all laws.
    pub(super) fn of(
        fits: &[Fitted<'_>],
        selected: (usize, ModelKind),
        unfitted: f64,
        outliers: Outliers,
    ) -> Option<Self> {
        let (law, kind) = selected;
        let fit = &fits[law];
        let own = fit
            .posterior
            .given(|p| fit.hypotheses[p.model].kind == kind)?;
        let state = &fit.state;
        let known = state.impacts.len() > FEWEST;
        let parameter = |place: usize, offset: f64| {
            let has = |h: &Hypothesis| match place {
                CONTACT => h.terms.contact.is_some(),
                _ => h.terms.drag.is_some(),
            };
            let mut own_models = fit.hypotheses.iter().filter(|h| h.kind == kind);
            own_models
                .any(has)
                .then(|| parameter(&own, &fit.models, place, offset, known))
        };
        Some(Self {
            ln_restitution: Mixture::of(fits, unfitted).parameter(known),
            own_ln_restitution: own.moments(0).0,
            contact_s: parameter(CONTACT, state.values.contact_s),
            drag_per_s2: parameter(DRAG, state.values.drag_per_s2),
            exponent: kind
                .has_exponent()
                .then(|| exponent(&own, &fit.bounces, known)),
            bounce_std: fit.posterior.mean_of(|p| p.sizes.bounce),
            timing_scale: fit.posterior.mean_of(|p| p.sizes.timing),
            mean_speed_s: fit.bounces.reference.exp(),
            ln_evidence: own.ln_evidence,
            budget: mixture::budget(fits),
            outliers,
        })
    }
}

/// A parameter by its place, counted from this offset.
fn parameter(
    posterior: &Posterior,
    models: &[Model],
    place: usize,
    offset: f64,
    known: bool,
) -> Parameter {
    let (mean, std) = posterior.moments(place);
    // The mean and the ends are truncated at the least value, which the normal distribution passes.
    let least = models[posterior.parts[0].model].priors[place].least;
    let quantile = |p| offset + posterior.quantile(place, least, p).max(least);
    Parameter {
        value: offset + mean.max(least),
        std: known.then_some(std),
        interval95: known.then(|| [quantile(0.025), quantile(0.975)]),
    }
}

/// How e falls with the speed on average over the bounces: the power that comes nearest to what is fitted.
///
/// # Formula
/// ```text
/// p̄ = Σ_k c_k·β_k,   c_k = Σ_j x_j·(X_jk − X̄_k)/Σ_j x_j·(x_j − x̄),   x = ln(v̄/v)
/// ```
fn exponent(posterior: &Posterior, bounces: &Bounces, known: bool) -> Parameter {
    let count = crate::units::real(bounces.design.len());
    let sums = |of: &dyn Fn(&[f64; PARAMETERS]) -> f64| bounces.design.iter().map(of).sum::<f64>();
    let middle = sums(&|row| row[SPEED]) / count;
    let spread = sums(&|row| (row[SPEED] - middle) * row[SPEED]);
    let mut shares = [0.0; PARAMETERS];
    for (place, share) in shares.iter_mut().enumerate().skip(SPEED) {
        *share = sums(&|row| (row[SPEED] - middle) * row[place]) / spread.max(f64::MIN_POSITIVE);
    }
    let of = |part: &Part| dot(&shares, &part.solution.values);
    let mean = posterior.mean_of(of);
    let variance = posterior.mean_of(|part| {
        let covariance = part.solution.covariance.map(|row| dot(&row, &shares));
        dot(&covariance, &shares) + (of(part) - mean).powi(2)
    });
    let std = variance.sqrt();
    Parameter {
        value: mean,
        std: known.then_some(std),
        interval95: known.then_some([mean - NORMAL95 * std, mean + NORMAL95 * std]),
    }
}
