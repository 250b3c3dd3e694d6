//! Generalised least squares with priors on the parameters, given the sizes of the noises.

use super::bounces::{Bounces, CONTACT, DRAG, FIRST_BEND, PARAMETERS};
use super::noise::{Noise, Sizes};
use super::prior::Priors;
use super::solution::Solution;
use crate::linalg::Cholesky;
use crate::units::real;

/// The bounces given the sizes of the noises, ready to be solved under any priors.
///
/// # Formula
/// ```text
/// β = V·(XᵀΣ⁻¹z + Λm),   V = (XᵀΣ⁻¹X + Λ)⁻¹
/// ln L = −½·[ln|Σ| + ln|V⁻¹| − ln|Λ| + (z − Xβ)ᵀΣ⁻¹(z − Xβ) + (β − m)ᵀΛ(β − m) + (n − 1)·ln 2π]
/// ```
/// Λ is 0 for θ, which has no prior, and is left out of ln|Λ| there: ln L then compares models that all have a θ. A parameter
/// that a model lacks is left out of X. XᵀΣ⁻¹X and XᵀΣ⁻¹z are those of all models.
///
/// Times are observed, and not ln e. Where the bounces' own noise rules, the density of the times is that of ln e
/// times the derivative of ln e by the flight after the bounce, `1/(D − C)`, which depends on the parameters:
/// `Σ ln ∂z_j/∂D_j` is added to ln L, and `ρ_j` times its slope to the right side of the equations, `ρ_j` being the bounces'
/// share of the variance: where the times' noise rules, its determinant changes with C and cancels the slope. Without it C
/// comes out too small, as long flights would explain themselves.
#[derive(Debug, Clone)]
pub(super) struct NormalEquations {
    /// `XᵀΣ⁻¹X`.
    matrix: [[f64; PARAMETERS]; PARAMETERS],
    /// `XᵀΣ⁻¹z`, …
    right: [f64; PARAMETERS],
    /// … and `zᵀΣ⁻¹z`, of z counted from this θ, so that little cancels.
    square: f64,
    middle: f64,
    /// `ρ_j` times the slopes of the density, summed; 0 but for C and K.
    pull: [f64; PARAMETERS],
    /// What does not depend on the priors: `Σ ln ∂z_j/∂D_j − ½·[ln|Σ| + (n − 1)·ln 2π]`.
    ln_constant: f64,
}

/// Columns of the largest design and of the observations, and of one without a departure from a law.
const COLUMNS: usize = PARAMETERS + 1;
const COLUMNS_OF_LAWS: usize = FIRST_BEND + 1;

impl NormalEquations {
    /// With the columns of a departure from the law, or without them where no model has it. None where Σ is singular.
    pub(super) fn of(
        bounces: &Bounces,
        noise: &Noise,
        sizes: Sizes,
        with_bends: bool,
    ) -> Option<Self> {
        if with_bends {
            Self::of_columns::<COLUMNS>(bounces, noise, sizes)
        } else {
            Self::of_columns::<COLUMNS_OF_LAWS>(bounces, noise, sizes)
        }
    }

    /// With a number of columns that is known to the compiler, so that they stay in the machine's registers.
    fn of_columns<const N: usize>(bounces: &Bounces, noise: &Noise, sizes: Sizes) -> Option<Self> {
        let factors = noise.factors(sizes)?;
        let count = N - 1;
        let bounced = real(bounces.ln_e.len());
        let middle = bounces.ln_e.iter().sum::<f64>() / bounced;
        let rows = bounces.design.iter().zip(&bounces.ln_e);
        let white = factors.forward(rows.map(|(row, &z)| {
            let mut columns = [z - middle * row[0]; N];
            columns[..count].copy_from_slice(&row[..count]);
            columns
        }));
        let products = products(&white, factors.precisions());
        let mut equations = Self {
            matrix: [[0.0; PARAMETERS]; PARAMETERS],
            right: [0.0; PARAMETERS],
            square: products[count][count],
            middle,
            pull: [0.0; PARAMETERS],
            ln_constant: bounces.ln_stretch.iter().sum::<f64>()
                - 0.5 * (factors.ln_determinant() + (bounced - 1.0) * std::f64::consts::TAU.ln()),
        };
        for (i, row) in products.iter().enumerate().take(count) {
            equations.matrix[i][..count].copy_from_slice(&row[..count]);
            equations.right[i] = row[count];
        }
        for (own, [contact, drag]) in noise.own_shares(sizes).zip(&bounces.stretching) {
            equations.pull[CONTACT] += own * contact;
            equations.pull[DRAG] += own * drag;
        }
        Some(equations)
    }

    /// ln L of a model, and its θ: a fraction of the work of [`solve`](Self::solve). None where the solution lies beyond what a
    /// ball can have: the equations are linear about a trial, and it is of no ball.
    pub(super) fn ln_likelihood(&self, priors: &Priors) -> Option<(f64, f64)> {
        let system = System::of(self, priors)?;
        let solved = system.factors.solve(&system.right);
        let mut values = system.places().iter().zip(&solved);
        if values.any(|(&place, value)| *value > priors[place].greatest) {
            return None;
        }
        let variance = |i: usize| {
            let mut unit = [0.0; PARAMETERS];
            unit[i] = 1.0;
            system.factors.quadratic(&unit)
        };
        let ln = system.ln_likelihood(self, priors, &solved, variance);
        Some((ln, solved[0] + self.middle))
    }

    /// Solves for the parameters of a model.
    pub(super) fn solve(&self, priors: &Priors) -> Option<Solution> {
        let system = System::of(self, priors)?;
        let (solved, inverse) = (
            system.factors.solve(&system.right),
            system.factors.inverse(),
        );
        let mut solution = Solution::NONE;
        solution.ln_likelihood = system.ln_likelihood(self, priors, &solved, |i| inverse[i][i]);
        for (i, &place) in system.places().iter().enumerate() {
            solution.values[place] = solved[i];
            for (j, &other) in system.places().iter().enumerate() {
                solution.covariance[place][other] = inverse[i][j];
            }
        }
        solution.values[0] += self.middle;
        Some(solution)
    }
}

/// The equations of one model: `V⁻¹·β = right`, of the parameters that it has.
struct System {
    places: [usize; PARAMETERS],
    count: usize,
    factors: Cholesky<PARAMETERS>,
    /// `XᵀΣ⁻¹z + Λm`, without and with the pull of the density.
    plain: [f64; PARAMETERS],
    right: [f64; PARAMETERS],
    /// `zᵀΣ⁻¹z + mᵀΛm`.
    square: f64,
    /// `ln|Λ|`.
    ln_prior: f64,
}

impl System {
    fn of(equations: &NormalEquations, priors: &Priors) -> Option<Self> {
        let (mut places, mut count) = ([0; PARAMETERS], 0);
        for (place, _) in (0..).zip(priors).filter(|(_, p)| !p.is_absent()) {
            places[count] = place;
            count += 1;
        }
        let mut matrix = [[0.0; PARAMETERS]; PARAMETERS];
        let (mut plain, mut right) = ([0.0; PARAMETERS], [0.0; PARAMETERS]);
        let (mut square, mut ln_prior) = (equations.square, 0.0);
        for (i, &place) in places[..count].iter().enumerate() {
            let prior = &priors[place];
            for (element, &other) in matrix[i].iter_mut().zip(&places[..=i]) {
                *element = equations.matrix[place][other];
            }
            matrix[i][i] += prior.precision;
            plain[i] = equations.right[place] + prior.precision * prior.centre;
            right[i] = plain[i] + equations.pull[place];
            square += prior.precision * prior.centre * prior.centre;
            ln_prior += prior.ln_precision;
        }
        Some(Self {
            places,
            count,
            factors: Cholesky::of(&matrix, count)?,
            plain,
            right,
            square,
            ln_prior,
        })
    }

    fn places(&self) -> &[usize] {
        &self.places[..self.count]
    }

    /// ln L at the solution, from the variances of the parameters.
    fn ln_likelihood(
        &self,
        equations: &NormalEquations,
        priors: &Priors,
        solved: &[f64; PARAMETERS],
        variance: impl Fn(usize) -> f64,
    ) -> f64 {
        // (z − Xβ)ᵀΣ⁻¹(z − Xβ) + (β − m)ᵀΛ(β − m), where βᵀV⁻¹β = βᵀ·right.
        let mut misfit = self.square;
        let mut beside = 0.0;
        for (i, &place) in self.places().iter().enumerate() {
            misfit += solved[i] * (self.right[i] - 2.0 * self.plain[i]);
            beside += solved[i] * equations.pull[place];
            if priors[place].is_cut() {
                beside += priors[place].ln_allowed(solved[i], variance(i));
            }
        }
        let determinants = self.factors.ln_determinant() - self.ln_prior;
        equations.ln_constant - 0.5 * (determinants + misfit) + beside
    }
}

/// Solves for the parameters of one model.
pub(super) fn solve(
    bounces: &Bounces,
    noise: &Noise,
    sizes: Sizes,
    priors: &Priors,
) -> Option<Solution> {
    let with_bends = !priors[FIRST_BEND].is_absent();
    NormalEquations::of(bounces, noise, sizes, with_bends)?.solve(priors)
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
