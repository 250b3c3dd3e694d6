//! Robust curves in the contact stretch.

use crate::signal::template::average::factors;
use crate::statistics::{MAD_TO_STD, upper_median};

/// Robust averaging ends once neither slope nor bend moves by more than this share of its standard error (convention) …
pub(super) const REST: f64 = 0.05;
/// … or after this number of rounds: four times the most seen, on both suites and real recordings.
const LIMIT: usize = 100;

/// A value at a contact stretch, and its standard error.
#[derive(Debug, Clone, Copy)]
pub(super) struct Value {
    pub contact_stretch: f64,
    pub value: f64,
    pub std: f64,
}

/// `c₀ + c₁·u + c₂·u²` in the contact stretch u, with the covariance of the coefficients.
#[derive(Debug, Clone, Copy)]
pub(super) struct Curve {
    pub coefficients: [f64; 3],
    pub covariance: [[f64; 3]; 3],
}

impl Curve {
    /// The curve of so many terms through all values by iteratively reweighted least squares, until it rests: Cauchy's weights,
    /// for three robust standard deviations. None of too few values.
    pub(super) fn robust(values: &[Value], terms: usize) -> Option<Self> {
        Self::in_rounds(values, terms, LIMIT)
    }

    fn in_rounds(values: &[Value], terms: usize, limit: usize) -> Option<Self> {
        let mut weights: Vec<f64> = values.iter().map(|v| 1.0 / (v.std * v.std)).collect();
        let mut last: Option<Self> = None;
        for _ in 0..limit {
            let mut curve = Self::through(values, &weights, terms)?;
            let off = |v: &Value| (v.value - curve.at(v.contact_stretch)) / v.std;
            let scale = (MAD_TO_STD * upper_median(values.iter().map(|v| off(v).abs()))?).max(1.0);
            for (w, v) in weights.iter_mut().zip(values) {
                *w = 1.0 / (v.std * v.std * (1.0 + (off(v) / (3.0 * scale)).powi(2)));
            }
            // The ratio of the errors to those that the weights state.
            curve.covariance = curve.covariance.map(|row| row.map(|c| c * scale * scale));
            let rests = last.is_some_and(|before| curve.moved_from(&before) < REST);
            last = Some(curve);
            if rests {
                break;
            }
        }
        last
    }

    fn through(values: &[Value], weights: &[f64], terms: usize) -> Option<Self> {
        let (mut moments, mut right) = ([0.0; 5], [0.0; 3]);
        for (v, weight) in values.iter().zip(weights) {
            let mut power = *weight;
            for (k, moment) in moments.iter_mut().enumerate() {
                *moment += power;
                if k < terms {
                    right[k] += power * v.value;
                }
                power *= v.contact_stretch;
            }
        }
        let factors = factors(&moments, terms)?;
        Some(Self {
            coefficients: factors.solve(&right),
            covariance: factors.inverse(),
        })
    }

    fn at(&self, contact_stretch: f64) -> f64 {
        let [level, slope, bend] = self.coefficients;
        level + contact_stretch * (slope + contact_stretch * bend)
    }

    /// Greatest distance of its slope and bend from those of another, in standard errors.
    fn moved_from(&self, other: &Self) -> f64 {
        greatest_in_std((1..3).map(|k| {
            let moved = self.coefficients[k] - other.coefficients[k];
            (moved, self.covariance[k][k].sqrt())
        }))
    }
}

/// The greatest of some moves, each with its standard error, in those.
pub(super) fn greatest_in_std(moves: impl Iterator<Item = (f64, f64)>) -> f64 {
    let in_std = moves.map(|(moved, std)| in_std(moved, std));
    in_std.fold(0.0, f64::max)
}

/// The size of a move in standard errors; 0 of what does not move and has none.
pub(super) fn in_std(moved: f64, std: f64) -> f64 {
    if moved == 0.0 { 0.0 } else { moved.abs() / std }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;
    use crate::units::real;

    #[test]
    fn the_curve_rests_on_the_most_whatever_lies_far_off_and_twice_the_limit_changes_nothing() {
        let mut rng = SplitMix64::new(5);
        for terms in [2, 3] {
            let values = (0..40).map(|i| {
                let contact_stretch = 0.02 * real(i) - 0.4;
                let off = if i % 8 == 0 { 60.0 } else { 0.0 };
                Value {
                    contact_stretch,
                    value: 2.0 - 9.0 * contact_stretch + 0.5 * rng.normal() + off,
                    std: 0.5,
                }
            });
            let values: Vec<Value> = values.collect();
            let curve = Curve::robust(&values, terms).unwrap();
            let (slope, std) = (curve.coefficients[1], curve.covariance[1][1].sqrt());
            assert!((slope + 9.0).abs() < 3.0 * std, "{slope} ± {std}");
            let longer = Curve::in_rounds(&values, terms, 2 * LIMIT).unwrap();
            assert_eq!(curve.coefficients, longer.coefficients);
        }
    }
}
