//! From impact times to the coefficient of restitution. Sees times only: no samples, no files.
//!
//! Two ways stand side by side: [`flights`] from the ratios of successive flights, [`total_time`] from height, number
//! and total time by the paper's equation (25).

mod banded;
mod bend;
pub mod bounces;
pub mod curve;
mod fitted;
pub mod flights;
mod found;
mod grid;
pub mod groups;
mod hypotheses;
pub mod irregular;
mod least_squares;
mod mixture;
pub mod model;
pub mod model_kind;
pub mod model_selection;
mod noise;
pub mod outlier;
mod posterior;
mod prior;
pub mod random_effects;
mod solution;
mod state;
pub mod total_time;
mod trial_law;
pub mod unfitted;

pub use model_kind::{BallParameters, ModelKind};

use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::statistics::NORMAL95;

/// A value with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Its standard error; none where the data do not tell.
    pub std_error: Option<f64>,
    /// The interval that holds the truth in 95 of 100 cases; none where the data do not tell.
    pub interval95: Option<[f64; 2]>,
}

impl Estimate {
    /// A value without a known error.
    #[must_use]
    pub const fn bare(value: f64) -> Self {
        Self {
            value,
            std_error: None,
            interval95: None,
        }
    }

    /// What cannot be below zero, from its relative standard error.
    #[must_use]
    pub fn with_relative_std(value: f64, relative_std: f64) -> Self {
        let std = value * relative_std;
        Self {
            value,
            std_error: Some(std),
            interval95: Some([(value - NORMAL95 * std).max(0.0), value + NORMAL95 * std]),
        }
    }

    /// A restitution from its logarithm and that one's standard error, which rests on this many degrees of freedom.
    ///
    /// # Formula
    /// ```text
    /// e = exp(l),  σ_e = e·σ_l,  interval exp(l ± t·σ_l),  t the 0.975 quantile of Student's distribution
    /// ```
    #[must_use]
    pub fn from_ln(ln: f64, ln_std: f64, degrees_of_freedom: f64) -> Self {
        let reach = student_975(degrees_of_freedom) * ln_std;
        Self {
            value: ln.exp(),
            std_error: Some(ln.exp() * ln_std),
            interval95: Some([(ln - reach).exp(), (ln + reach).exp()]),
        }
    }
}

/// The 0.975 quantile of Student's distribution; the normal's where the degrees of freedom are infinite.
#[must_use]
pub fn student_975(degrees_of_freedom: f64) -> f64 {
    if degrees_of_freedom > 1e6 {
        return NORMAL95;
    }
    student(0.975, degrees_of_freedom)
}

/// A quantile of Student's distribution.
fn student(share: f64, degrees_of_freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, degrees_of_freedom).map_or(f64::INFINITY, |t| t.inverse_cdf(share))
}

#[cfg(test)]
mod drop_tests;
#[cfg(test)]
mod law_tests;
#[cfg(test)]
mod oracle_tests;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (freedom, quantile) in [
            (1.0, 12.706),
            (2.0, 4.303),
            (5.0, 2.571),
            (30.0, 2.042),
            (f64::INFINITY, 1.960),
        ] {
            assert!(
                (student_975(freedom) - quantile).abs() < 6e-4,
                "{freedom}: {}",
                student_975(freedom)
            );
        }
    }
}
