//! The parameters as they are found, and what is possible of them.

use statrs::distribution::{Continuous, ContinuousCDF, Normal};

use super::bounces::PARAMETERS;
use super::prior::Priors;

/// The parameters, each at its place, and how well they explain the bounces; 0 for those that the model lacks.
#[derive(Debug, Clone)]
pub(super) struct Solution {
    /// ln of the restricted likelihood: θ and what else is fitted are integrated out.
    pub ln_likelihood: f64,
    pub values: [f64; PARAMETERS],
    /// Their covariance.
    pub covariance: [[f64; PARAMETERS]; PARAMETERS],
    /// Mean and variance of the normal distribution of each before it is truncated at its least value.
    pub before_least: [(f64, f64); PARAMETERS],
}

impl Solution {
    /// Of a model without parameters.
    pub(super) const NONE: Self = Self {
        ln_likelihood: 0.0,
        values: [0.0; PARAMETERS],
        covariance: [[0.0; PARAMETERS]; PARAMETERS],
        before_least: [(0.0, 0.0); PARAMETERS],
    };

    /// The solution where one parameter has this value: the others follow by their covariance with it.
    ///
    /// # Formula
    /// ```text
    /// β_j + V_ij/V_ii·(x − β_i),   V_jk − V_ij·V_ik/V_ii
    /// ```
    pub(super) fn fix(&mut self, parameter: usize, value: f64) {
        let column = self.covariance[parameter];
        let (off, variance) = (value - self.values[parameter], column[parameter]);
        if variance <= 0.0 {
            return;
        }
        for j in 0..PARAMETERS {
            self.values[j] += column[j] / variance * off;
            for k in 0..PARAMETERS {
                self.covariance[j][k] -= column[j] * column[k] / variance;
            }
        }
        self.values[parameter] = value;
    }

    /// Mean and covariance given that all parameters are possible: one after the other by the moments of a truncated normal
    /// distribution.
    ///
    /// # Formula
    /// ```text
    /// λ = φ(α)/(1 − Φ(α)),  α = (least − m)/σ:   m_j + λ·V_ij/σ,   V_jk − λ(λ − α)·V_ij·V_ik/σ²
    /// ```
    pub(super) fn keep_above_least(&mut self, priors: &Priors) {
        for (i, prior) in priors.iter().enumerate() {
            let variance = self.covariance[i][i];
            self.before_least[i] = (self.values[i], variance);
            if !prior.is_cut() || variance <= 0.0 {
                continue;
            }
            let std = variance.sqrt();
            let alpha = (prior.least - self.values[i]) / std;
            let left = Normal::standard().sf(alpha);
            let lambda = if left > f64::MIN_POSITIVE {
                Normal::standard().pdf(alpha) / left
            } else {
                alpha
            };
            let (column, shrink) = (self.covariance[i], lambda * (lambda - alpha) / variance);
            for j in 0..PARAMETERS {
                self.values[j] += lambda * column[j] / std;
                for k in 0..PARAMETERS {
                    self.covariance[j][k] -= shrink * column[j] * column[k];
                }
            }
        }
        // The others are as the cuts leave them.
        for (i, _) in priors.iter().enumerate().filter(|(_, p)| !p.is_cut()) {
            self.before_least[i] = (self.values[i], self.covariance[i][i]);
        }
    }
}
