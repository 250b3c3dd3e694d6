//! The fit of one model to the impact times of a drop: e with an interval that covers it.

use statrs::distribution::{ContinuousCDF, Normal};

use super::bounces::{Bounces, Terms};
use super::least_squares::Prior;
use super::noise::Noise;
use super::outlier::{self, Outliers};
use super::posterior::Posterior;
use super::state::State;
use crate::impact::Impact;
use crate::physics::priors::Known;
use crate::statistics::{NORMAL95, bisected};

/// Fewest impacts with a ratio of flights.
const FEWEST: usize = 3;

/// A model fitted to a drop.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// ln e at the mean speed, by all models that may be right: mean, standard deviation, and the ends of the interval that
    /// holds it with 95 %; none for one ratio alone.
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
    /// The fit where one of several models may be the right one, this one among them: ln e is that of their mixture.
    ///
    /// # Formula
    /// ```text
    /// ln e = Σ w_k·ln e_k,   σ² = Σ w_k·[(ln e_k − ln e)² + σ_k²],
    /// interval: where Σ w_k·Φ(1.96·(x − ln e_k)/r_k) is 0.025 and 0.975
    /// ```
    /// w are the odds of the models, together 1; `r_k` is the reach of a model's own interval on the side of x.
    #[must_use]
    pub(super) fn among(mut self, models: &[Rival]) -> Self {
        let Parameter {
            value,
            std,
            interval95,
        } = &mut self.ln_restitution;
        let total: f64 = models.iter().map(|m| m.weight).sum();
        if let (Some(std), Some(ends), true) = (std, interval95, total > 0.0) {
            let mean_of = |of: &dyn Fn(&Rival) -> f64| {
                models.iter().map(|m| m.weight * of(m)).sum::<f64>() / total
            };
            *value = mean_of(&|m| m.ln_restitution);
            let variance = mean_of(&|m| (m.ln_restitution - *value).powi(2) + m.std * m.std);
            let normal = Normal::standard();
            let below = |x: f64| {
                mean_of(&|m| {
                    let reach = m.interval95[usize::from(x > m.ln_restitution)] - m.ln_restitution;
                    normal.cdf(NORMAL95 * (x - m.ln_restitution) / reach.abs())
                })
            };
            let widest = |m: &Rival| m.interval95.map(|end| (end - *value).abs());
            let reach = FAR * models.iter().flat_map(widest).fold(0.0, f64::max);
            let range = (*value - reach, *value + reach);
            *ends = [0.025, 0.975].map(|p| bisected(range, HALVINGS, |x| below(x) < p));
            let own = (*std * *std / variance).min(1.0);
            *std = variance.sqrt();
            let b = &mut self.budget;
            for share in [
                &mut b.timing,
                &mut b.bounce,
                &mut b.inputs,
                &mut b.noise_sizes,
            ] {
                *share *= own;
            }
            b.model = 1.0 - own;
        }
        self
    }
}

/// A model that may be the right one: its odds, its ln e, the standard error and the interval of that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rival {
    pub weight: f64,
    pub ln_restitution: f64,
    pub std: f64,
    pub interval95: [f64; 2],
}

/// Reaches in which the ends of a mixture are bisected; they lie within the widest of its intervals, at one.
const FAR: f64 = 2.0;
/// Bisections: four reaches halved this often leave a hundred-thousandth of one.
const HALVINGS: usize = 19;

/// Fits a model. None for fewer than three impacts, a flight that is not longer than the contact, or parameters that run
/// away.
#[cfg(test)]
pub(super) fn fit(impacts: &[Impact], terms: &Terms) -> Option<Fit> {
    Some(Fitted::new(impacts, &[], terms)?.summary())
}

/// A fitted model before its intervals and budget are computed: they are costly, and only the selected model needs them.
#[derive(Debug)]
pub(super) struct Fitted<'a> {
    state: State<'a>,
    bounces: Bounces,
    noise: Noise,
    priors: Vec<Prior>,
    posterior: Posterior,
    outliers: Outliers,
}

impl<'a> Fitted<'a> {
    pub(super) fn new(impacts: &'a [Impact], odd: &[usize], terms: &Terms) -> Option<Self> {
        if impacts.len() < FEWEST {
            return None;
        }
        let mut state = State::new(impacts, odd, terms);
        state.converge()?;
        let outliers = outlier::find(&mut state)?;
        let bounces = state.bounces()?;
        let noise = state.noise(&bounces);
        let priors = state.priors();
        let posterior = Posterior::over_noise(&bounces, &noise, &priors)?;
        // The posterior is linear about the solution; where it lies beyond what a ball can have it is of no ball.
        if !state.can_have(|place| posterior.moments(place).0) {
            return None;
        }
        Some(Self {
            posterior,
            state,
            bounces,
            noise,
            priors,
            outliers,
        })
    }

    /// ln of the evidence for the model.
    pub(super) const fn ln_evidence(&self) -> f64 {
        self.posterior.ln_evidence
    }

    /// The mean of ln e.
    pub(super) fn ln_restitution(&self) -> f64 {
        self.posterior.moments(0).0
    }

    /// The fit as one of several, with its odds; none where it has no interval.
    pub(super) fn rival(&self, weight: f64) -> Option<Rival> {
        let ln = self.parameter(0, 0.0);
        Some(Rival {
            weight,
            ln_restitution: ln.value,
            std: ln.std?,
            interval95: ln.interval95?,
        })
    }

    pub(super) fn summary(self) -> Fit {
        let (values, terms) = (self.state.values, self.state.terms);
        let mut index = 0;
        let mut next = |known: Option<Known>, offset: f64| {
            known.map(|_| {
                index += 1;
                self.parameter(index, offset)
            })
        };
        let ln_restitution = self.parameter(0, 0.0);
        Fit {
            own_ln_restitution: ln_restitution.value,
            ln_restitution,
            contact_s: next(terms.contact, values.contact_s),
            drag_per_s2: next(terms.drag, values.drag_per_s2),
            exponent: next(terms.speed, 0.0),
            bounce_std: self.posterior.mean_of(|n, _| n.bounce),
            timing_scale: self.posterior.mean_of(|n, _| n.timing),
            mean_speed_s: self.bounces.mean_ln_speed.exp(),
            ln_evidence: self.ln_evidence(),
            budget: budget(&self.bounces, &self.noise, &self.priors, &self.posterior),
            outliers: self.outliers,
        }
    }

    /// A parameter by its number, counted from this offset.
    fn parameter(&self, index: usize, offset: f64) -> Parameter {
        let known = self.state.impacts.len() > FEWEST;
        let (mean, std) = self.posterior.moments(index);
        // The mean and the ends are truncated at the least value, which the normal distribution passes.
        let least = self.priors[index].least;
        let quantile = |p| offset + self.posterior.quantile(index, p).max(least);
        Parameter {
            value: offset + mean.max(least),
            std: known.then_some(std),
            interval95: known.then(|| [quantile(0.025), quantile(0.975)]),
        }
    }
}

/// The variance of `θ = Σ a_j·z_j` and the prior part, `a = V·XᵀΣ⁻¹`, at each size of the noises, and its mean.
fn budget(bounces: &Bounces, noise: &Noise, priors: &[Prior], posterior: &Posterior) -> Budget {
    let mean = posterior.moments(0).0;
    let inputs = posterior.mean_of(|_, s| {
        let pairs = s.covariance[0].iter().zip(priors);
        pairs.map(|(v, p)| v * v * p.precision).sum()
    });
    let (timing, bounce) = posterior.mean_of_two(|sizes, s| {
        let rows = bounces.design.iter();
        let target: Vec<f64> = rows
            .map(|row| row.iter().zip(&s.covariance[0]).map(|(x, v)| x * v).sum())
            .collect();
        let (timing, own) = noise
            .factors(sizes)
            .map_or((0.0, 0.0), |f| noise.shares(&f.solve(&target)));
        (sizes.timing.powi(2) * timing, sizes.bounce.powi(2) * own)
    });
    let noise_sizes = posterior.mean_of(|_, s| (s.values[0] - mean).powi(2));
    let total = timing + bounce + inputs + noise_sizes;
    Budget {
        timing: timing / total,
        bounce: bounce / total,
        inputs: inputs / total,
        noise_sizes: noise_sizes / total,
        model: 0.0,
    }
}
