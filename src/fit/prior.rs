//! What is known of a parameter beforehand.

use statrs::distribution::{ContinuousCDF, Normal};

use super::bounces::PARAMETERS;

/// Prior of a parameter, counted from its trial value: precision and centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Prior {
    pub precision: f64,
    /// Its logarithm; 0 where nothing is known.
    pub ln_precision: f64,
    pub centre: f64,
    /// Least possible value.
    pub least: f64,
    /// Greatest possible value: a solution beyond it is of no ball.
    pub greatest: f64,
    /// Prior probability, by precision and centre alone, of a possible value.
    allowed: f64,
}

/// Those of all parameters, each at its place.
pub(super) type Priors = [Prior; PARAMETERS];

impl Prior {
    /// No knowledge.
    pub(super) const FLAT: Self = Self {
        precision: 0.0,
        ln_precision: 0.0,
        centre: 0.0,
        least: f64::NEG_INFINITY,
        greatest: f64::INFINITY,
        allowed: 1.0,
    };

    /// A parameter that the model lacks.
    pub(super) const ABSENT: Self = Self {
        precision: f64::INFINITY,
        ..Self::FLAT
    };

    /// A normal distribution truncated below `least`.
    pub(super) fn new(centre: f64, std: f64, least: f64) -> Self {
        Self {
            precision: std.powi(-2),
            ln_precision: -2.0 * std.ln(),
            centre,
            least,
            greatest: f64::INFINITY,
            allowed: if least > f64::NEG_INFINITY {
                Normal::standard().cdf((centre - least) / std)
            } else {
                1.0
            },
        }
    }

    /// The same with a greatest value.
    pub(super) const fn up_to(mut self, greatest: f64) -> Self {
        self.greatest = greatest;
        self
    }

    pub(super) const fn is_absent(&self) -> bool {
        self.precision.is_infinite()
    }

    pub(super) const fn is_cut(&self) -> bool {
        self.least > f64::NEG_INFINITY
    }

    /// ln of the ratio of the probabilities of a possible value after the data and before.
    pub(super) fn ln_allowed(&self, value: f64, variance: f64) -> f64 {
        if !self.is_cut() {
            return 0.0;
        }
        let after = Normal::standard().cdf((value - self.least) / variance.sqrt());
        (after.max(f64::MIN_POSITIVE) / self.allowed).ln()
    }
}
