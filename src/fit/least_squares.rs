//! Generalised least squares with priors on the parameters, given the sizes of the noises.

use statrs::distribution::{Continuous, ContinuousCDF, Normal};

use super::bounces::{Bounces, MOST_PARAMETERS};
use super::noise::{Noise, Sizes};
use crate::linalg::{Cholesky, dot};
use crate::units::real;

/// Prior of a parameter, counted from its trial value: precision and centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Prior {
    pub precision: f64,
    pub centre: f64,
    /// Least possible value.
    pub least: f64,
    /// Prior probability, by precision and centre alone, of a possible value.
    allowed: f64,
}

impl Prior {
    /// No knowledge.
    pub(super) const FLAT: Self = Self {
        precision: 0.0,
        centre: 0.0,
        least: f64::NEG_INFINITY,
        allowed: 1.0,
    };

    /// A normal distribution truncated below `least`.
    pub(super) fn new(centre: f64, std: f64, least: f64) -> Self {
        Self {
            precision: std.powi(-2),
            centre,
            least,
            allowed: Normal::standard().cdf((centre - least) / std),
        }
    }

    /// ln of the ratio of the probabilities of a possible value after the data and before.
    fn ln_allowed(&self, value: f64, variance: f64) -> f64 {
        if self.least == f64::NEG_INFINITY {
            return 0.0;
        }
        let after = Normal::standard().cdf((value - self.least) / variance.sqrt());
        (after.max(f64::MIN_POSITIVE) / self.allowed).ln()
    }
}

/// The parameters and how well they explain the bounces.
#[derive(Debug, Clone)]
pub(super) struct Solution {
    /// ln of the restricted likelihood: θ and what else is fitted are integrated out.
    pub ln_likelihood: f64,
    /// Parameters, θ first; 0 past the last.
    pub values: [f64; MOST_PARAMETERS],
    /// Their covariance.
    pub covariance: [[f64; MOST_PARAMETERS]; MOST_PARAMETERS],
    /// Mean and variance of the normal distribution of each before it is truncated at its least value.
    pub before_least: [(f64, f64); MOST_PARAMETERS],
}

impl Solution {
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
        for j in 0..MOST_PARAMETERS {
            self.values[j] += column[j] / variance * off;
            for k in 0..MOST_PARAMETERS {
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
    pub(super) fn keep_above_least(&mut self, priors: &[Prior]) {
        for (i, prior) in priors.iter().enumerate() {
            let variance = self.covariance[i][i];
            self.before_least[i] = (self.values[i], variance);
            if prior.least == f64::NEG_INFINITY || variance <= 0.0 {
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
            for j in 0..MOST_PARAMETERS {
                self.values[j] += lambda * column[j] / std;
                for k in 0..MOST_PARAMETERS {
                    self.covariance[j][k] -= shrink * column[j] * column[k];
                }
            }
        }
        // θ and p are as the cuts of the others leave them.
        for (i, _) in priors
            .iter()
            .enumerate()
            .filter(|(_, p)| p.least == f64::NEG_INFINITY)
        {
            self.before_least[i] = (self.values[i], self.covariance[i][i]);
        }
    }
}

/// Solves for the parameters.
///
/// # Formula
/// ```text
/// β = V·(XᵀΣ⁻¹z + Λm),   V = (XᵀΣ⁻¹X + Λ)⁻¹
/// ln L = −½·[ln|Σ| + ln|V⁻¹| − ln|Λ| + (z − Xβ)ᵀΣ⁻¹(z − Xβ) + (β − m)ᵀΛ(β − m) + (n − 1)·ln 2π]
/// ```
/// Λ is 0 for θ, which has no prior, and is left out of ln|Λ| there: ln L then compares models that all have a θ.
///
/// Times are observed, and not ln e. Where the bounces' own noise rules, the density of the times is that of ln e
/// times the derivative of ln e by the flight after the bounce, `1/(D − C)`, which depends on the parameters:
/// `Σ ln ∂z_j/∂D_j` is added to ln L, and `ρ_j` times its slope to the right side of the equations, `ρ_j` being the bounces'
/// share of the variance: where the times' noise rules, its determinant changes with C and cancels the slope. Without it C
/// comes out too small, as long flights would explain themselves.
pub(super) fn solve(
    bounces: &Bounces,
    noise: &Noise,
    sizes: Sizes,
    priors: &[Prior],
) -> Option<Solution> {
    match bounces.parameters {
        1 => solve_columns::<2>(bounces, noise, sizes, priors),
        2 => solve_columns::<3>(bounces, noise, sizes, priors),
        3 => solve_columns::<4>(bounces, noise, sizes, priors),
        _ => solve_columns::<COLUMNS>(bounces, noise, sizes, priors),
    }
}

/// The columns of the design and, last, the observations.
const COLUMNS: usize = MOST_PARAMETERS + 1;

/// [`solve`] with a number of columns that is known to the compiler, so that they stay in the machine's registers.
fn solve_columns<const N: usize>(
    bounces: &Bounces,
    noise: &Noise,
    sizes: Sizes,
    priors: &[Prior],
) -> Option<Solution> {
    let factors = noise.factors(sizes)?;
    let rows = bounces.design.iter().zip(&bounces.ln_e);
    let count = N - 1;
    let white = factors.forward(rows.map(|(row, &z)| {
        let mut columns = [z; N];
        columns[..count].copy_from_slice(&row[..count]);
        columns
    }));
    let products = products(&white, factors.precisions());
    let density = Density::of(bounces, noise, sizes);
    let (mut normal, mut right) = (
        [[0.0; MOST_PARAMETERS]; MOST_PARAMETERS],
        [0.0; MOST_PARAMETERS],
    );
    for (i, prior) in priors.iter().enumerate().take(count) {
        normal[i][..count].copy_from_slice(&products[i][..count]);
        normal[i][i] += prior.precision;
        right[i] = products[i][count] + prior.precision * prior.centre + density.pull[i];
    }
    let inverse = Cholesky::of(&normal, count)?;
    let (covariance, ln_determinant) = (inverse.inverse(), inverse.ln_determinant());
    let values: [f64; MOST_PARAMETERS] = std::array::from_fn(|i| dot(&covariance[i], &right));
    let mut misfit: f64 = 0.0;
    for (row, precision) in white.iter().zip(factors.precisions()) {
        let explained: f64 = row[..count].iter().zip(&values).map(|(w, b)| w * b).sum();
        misfit += precision * (row[count] - explained).powi(2);
    }
    let mut ln_prior = 0.0;
    for (value, prior) in values.iter().zip(priors).filter(|(_, p)| p.precision > 0.0) {
        misfit += prior.precision * (value - prior.centre).powi(2);
        ln_prior += prior.precision.ln();
    }
    let allowed: f64 = (0..count)
        .map(|i| priors[i].ln_allowed(values[i], covariance[i][i]))
        .sum();
    let constant = real(white.len().saturating_sub(1)) * std::f64::consts::TAU.ln();
    Some(Solution {
        ln_likelihood: -0.5
            * (factors.ln_determinant() + ln_determinant - ln_prior + misfit + constant)
            + density.ln
            + dot(&values, &density.pull)
            + allowed,
        values,
        covariance,
        before_least: [(0.0, 0.0); MOST_PARAMETERS],
    })
}

/// `Σ w·xᵢ·xⱼ` of all pairs of columns.
fn products<const N: usize>(
    rows: &[[f64; N]],
    weights: impl Iterator<Item = f64>,
) -> [[f64; N]; N] {
    let mut products = [[0.0; N]; N];
    for (row, weight) in rows.iter().zip(weights) {
        for (sums, x) in products.iter_mut().zip(row) {
            for (sum, y) in sums.iter_mut().zip(row) {
                *sum += weight * x * y;
            }
        }
    }
    products
}

/// `Σ ln ∂z_j/∂D_j` at the trial, and its slope by each parameter times `ρ_j`.
struct Density {
    ln: f64,
    pull: [f64; MOST_PARAMETERS],
}

impl Density {
    fn of(bounces: &Bounces, noise: &Noise, sizes: Sizes) -> Self {
        let mut density = Self {
            ln: 0.0,
            pull: [0.0; MOST_PARAMETERS],
        };
        let stretches = bounces.ln_stretch.iter().zip(&bounces.stretching);
        for (own, (ln, stretching)) in noise.own_shares(sizes).zip(stretches) {
            density.ln += ln;
            for (pull, s) in density.pull.iter_mut().zip(stretching) {
                *pull += own * s;
            }
        }
        density
    }
}
