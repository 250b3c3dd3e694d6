//! Generalised least squares with what is known of the parameters beforehand, given the sizes of the noises.

use statrs::distribution::{ContinuousCDF, Normal};

use super::bounces::Bounces;
use super::noise::{Noise, Sizes};
use crate::units::real;

/// Most parameters a model has: θ, C, K and p.
const MOST: usize = 4;

/// Precision and precision-weighted centre of a parameter before the data, as far as it lies from its trial value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Prior {
    pub precision: f64,
    pub centre: f64,
    /// It cannot be less than this.
    pub least: f64,
}

impl Prior {
    /// Nothing is known.
    pub(super) const FLAT: Self = Self {
        precision: 0.0,
        centre: 0.0,
        least: f64::NEG_INFINITY,
    };

    /// ln of how much likelier it became by the data that the parameter is not less than its least value.
    fn ln_allowed(&self, value: f64, variance: f64) -> f64 {
        if self.least == f64::NEG_INFINITY {
            return 0.0;
        }
        let normal = Normal::standard();
        let after = normal.cdf((value - self.least) / variance.sqrt());
        let before = normal.cdf((self.centre - self.least) * self.precision.sqrt());
        (after.max(f64::MIN_POSITIVE) / before).ln()
    }
}

/// The parameters and how well they explain the bounces.
#[derive(Debug, Clone)]
pub(super) struct Solution {
    /// ln of the restricted likelihood: θ and what else is fitted are integrated out.
    pub ln_likelihood: f64,
    /// Parameters, θ first.
    pub values: Vec<f64>,
    /// Their covariance.
    pub covariance: [[f64; MOST]; MOST],
}

/// Solves for the parameters.
///
/// # Formula
/// ```text
/// β = V·(XᵀΣ⁻¹z + Λm),   V = (XᵀΣ⁻¹X + Λ)⁻¹
/// ln L = −½·[ln|Σ| + ln|V⁻¹| − ln|Λ| + (z − Xβ)ᵀΣ⁻¹(z − Xβ) + (β − m)ᵀΛ(β − m) + (n − 1)·ln 2π]
/// ```
/// Λ is 0 for θ, of which nothing is known, and is left out of ln|Λ| there: ln L then compares models that all have a θ.
///
/// What was observed are times and not ln e. Where the bounces' own noise rules, the density of the times is that of ln e
/// times the derivative of ln e by the flight after the bounce, `1/(D − C)`, which depends on the parameters:
/// `Σ ρ_j·ln ∂z_j/∂D_j` is added to ln L and its slope to the right side of the equations, `ρ_j` being the bounces' share of
/// the variance. Without it C comes out too small, as long flights would explain themselves.
pub(super) fn solve(
    bounces: &Bounces,
    noise: &Noise,
    sizes: Sizes,
    priors: &[Prior],
) -> Option<Solution> {
    let factors = noise.factors(sizes)?;
    let own: Vec<f64> = noise.own_shares(sizes).collect();
    let white: Vec<Vec<f64>> = bounces
        .columns
        .iter()
        .map(|c| factors.whitened(c))
        .collect();
    let z = factors.whitened(&bounces.ln_e);
    let count = white.len();
    let mut normal = [[0.0; MOST]; MOST];
    let (mut right, mut pull) = ([0.0; MOST], [0.0; MOST]);
    for i in 0..count {
        for j in 0..=i {
            normal[i][j] = dot(&white[i], &white[j]);
            normal[j][i] = normal[i][j];
        }
        normal[i][i] += priors[i].precision;
        pull[i] = dot(&bounces.stretching[i], &own);
        right[i] = dot(&white[i], &z) + priors[i].precision * priors[i].centre + pull[i];
    }
    let (covariance, ln_determinant) = inverse(&normal, count)?;
    let values: Vec<f64> = (0..count)
        .map(|i| (0..count).map(|j| covariance[i][j] * right[j]).sum())
        .collect();
    let mut misfit: f64 = 0.0;
    for (k, z) in z.iter().enumerate() {
        let explained: f64 = white.iter().zip(&values).map(|(w, b)| w[k] * b).sum();
        misfit += (z - explained).powi(2);
    }
    let slopes = bounces.slopes.iter().zip(&own);
    let density = slopes.map(|(s, own)| own * s[2].ln()).sum::<f64>() + dot(&values, &pull);
    let mut ln_prior = 0.0;
    for (value, prior) in values.iter().zip(priors).filter(|(_, p)| p.precision > 0.0) {
        misfit += prior.precision * (value - prior.centre).powi(2);
        ln_prior += prior.precision.ln();
    }
    let allowed: f64 = (0..count)
        .map(|i| priors[i].ln_allowed(values[i], covariance[i][i]))
        .sum();
    let constant = real(z.len().saturating_sub(1)) * std::f64::consts::TAU.ln();
    Some(Solution {
        ln_likelihood: -0.5
            * (factors.ln_determinant() + ln_determinant - ln_prior + misfit + constant)
            + density
            + allowed,
        values,
        covariance,
    })
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Inverse and ln of the determinant of the leading part of a positive definite matrix, by Gauss and Jordan.
fn inverse(matrix: &[[f64; MOST]; MOST], count: usize) -> Option<([[f64; MOST]; MOST], f64)> {
    let (mut left, mut right) = (*matrix, [[0.0; MOST]; MOST]);
    // Columns differ by orders of magnitude (seconds, s⁻²): scaled to a unit diagonal nothing is lost.
    let scales: Vec<f64> = (0..count).map(|i| matrix[i][i].sqrt()).collect();
    if scales.iter().any(|s| !(*s > 0.0 && s.is_finite())) {
        return None;
    }
    let mut ln_determinant = 0.0;
    for i in 0..count {
        for j in 0..count {
            left[i][j] /= scales[i] * scales[j];
        }
        right[i][i] = 1.0;
        ln_determinant += 2.0 * scales[i].ln();
    }
    for i in 0..count {
        let pivot = left[i][i];
        if pivot <= 1e-14 {
            return None;
        }
        ln_determinant += pivot.ln();
        for j in 0..count {
            left[i][j] /= pivot;
            right[i][j] /= pivot;
        }
        for k in (0..count).filter(|&k| k != i) {
            let factor = left[k][i];
            for j in 0..count {
                left[k][j] -= factor * left[i][j];
                right[k][j] -= factor * right[i][j];
            }
        }
    }
    for i in 0..count {
        for j in 0..count {
            right[i][j] /= scales[i] * scales[j];
        }
    }
    Some((right, ln_determinant))
}
