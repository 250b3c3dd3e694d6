//! The fit against dense matrices and a fine quadrature: `fixtures/oracle/fit.json`, made by
//! `python3 fixtures/oracle/fit.py`.

use serde::Deserialize;

use super::bounces::{Bounces, CONTACT, DRAG, ImpactLaw, PARAMETERS, SPEED, Terms, Values};
use super::least_squares::solve;
use super::model_selection::fit;
use super::noise::{Noise, Sizes};
use super::outlier::Outliers;
use super::posterior::{Model, Posterior};
use super::prior::{Prior, Priors};
use super::solution::Solution;
use crate::impact::Impact;
use crate::physics::priors::Known;

const TABLE: &str = include_str!("../../fixtures/oracle/fit.json");

/// A drop, what is known of it beforehand, and what the oracle finds.
#[derive(Debug, Deserialize)]
struct Row {
    times_s: Vec<f64>,
    time_std_s: f64,
    contact_s: Option<[f64; 2]>,
    drag_per_s2: Option<[f64; 2]>,
    exponent: Option<[f64; 2]>,
    trial: Trial,
    at_sizes: Vec<AtSizes>,
    posterior: Mixture,
}

/// Values around which the oracle has made the model linear.
#[derive(Debug, Deserialize)]
struct Trial {
    times_s: Vec<f64>,
    contact_s: f64,
    drag_per_s2: f64,
}

/// Its solution at given sizes of the noises.
#[derive(Debug, Deserialize)]
struct AtSizes {
    bounce: f64,
    timing: f64,
    values: Vec<f64>,
    std: Vec<f64>,
    ln_likelihood: f64,
    plain_values: Vec<f64>,
    plain_ln_likelihood: f64,
}

/// Its posterior over all sizes.
#[derive(Debug, Deserialize)]
struct Mixture {
    mean: Vec<f64>,
    std: Vec<f64>,
    interval95: [f64; 2],
    ln_evidence: f64,
}

impl Row {
    fn all() -> Vec<Self> {
        serde_json::from_str(TABLE).unwrap()
    }

    fn impacts(&self) -> Vec<Impact> {
        let impact = |&time_s| Impact::heard(time_s, self.time_std_s);
        self.times_s.iter().map(impact).collect()
    }

    fn terms(&self) -> Terms {
        let known = |[value, std]: [f64; 2]| Known { value, std };
        Terms {
            contact: self.contact_s.map(known),
            drag: self.drag_per_s2.map(known),
            speed: self.exponent.map(known),
            bend: None,
            law: ImpactLaw::Alike,
        }
    }

    fn values(&self) -> Values {
        Values {
            contact_s: self.trial.contact_s,
            drag_per_s2: self.trial.drag_per_s2,
            ln_fast_restitution: 0.0,
        }
    }

    /// The model made linear where the oracle has.
    fn linear(&self) -> (Bounces, Noise, Priors) {
        let impacts = self.impacts();
        let (times_s, law) = (&self.trial.times_s, ImpactLaw::Alike);
        let around = Bounces::around(times_s, &impacts, law, self.values(), None);
        let bounces = around.unwrap();
        let variances = vec![self.time_std_s.powi(2); impacts.len()];
        let noise = Noise::new(&bounces, &variances, vec![1.0; bounces.ln_e.len()]);
        (bounces, noise, self.priors())
    }

    fn priors(&self) -> Priors {
        let mut priors = [Prior::ABSENT; PARAMETERS];
        priors[0] = Prior::FLAT;
        let known = [
            (CONTACT, self.contact_s, self.trial.contact_s, 0.0),
            (DRAG, self.drag_per_s2, self.trial.drag_per_s2, 0.0),
            (SPEED, self.exponent, 0.0, f64::NEG_INFINITY),
        ];
        for (place, known, trial, least) in known {
            if let Some([value, std]) = known {
                priors[place] = Prior::new(value - trial, std, least - trial);
            }
        }
        priors
    }

    /// Place of each parameter that is fitted, and the trial value that it is counted from.
    fn offsets(&self) -> Vec<(usize, f64)> {
        let contact = self.contact_s.map(|_| (CONTACT, self.trial.contact_s));
        let drag = self.drag_per_s2.map(|_| (DRAG, self.trial.drag_per_s2));
        let speed = self.exponent.map(|_| (SPEED, 0.0));
        let fitted = [Some((0, 0.0)), contact, drag, speed];
        fitted.into_iter().flatten().collect()
    }
}

/// The largest difference of two lists, each in units of the third.
fn largest(found: &[f64], expected: &[f64], units: &[f64]) -> f64 {
    assert_eq!((found.len(), units.len()), (expected.len(), expected.len()));
    let pairs = found.iter().zip(expected).zip(units);
    // A NaN is the largest.
    let off = pairs.map(|((a, b), unit)| ((a - b) / unit).abs());
    off.fold(0.0, |most, x| if x <= most { most } else { x })
}

/// Parameters as the oracle counts them, and their standard errors.
fn answer(row: &Row, solution: &Solution) -> (Vec<f64>, Vec<f64>) {
    let offsets = row.offsets().into_iter();
    offsets
        .map(|(i, offset)| {
            let std = solution.covariance[i][i].sqrt();
            (solution.values[i] + offset, std)
        })
        .unzip()
}

impl AtSizes {
    const fn sizes(&self) -> Sizes {
        Sizes {
            bounce: self.bounce,
            timing: self.timing,
        }
    }
}

/// Relative, of the parameters and their errors: dense matrices and bands differ by rounding alone. A millionth is asked
/// for.
const ROUNDING: f64 = 1e-9;

#[test]
fn given_the_noises_the_solution_is_that_of_dense_matrices() {
    for (number, row) in Row::all().iter().enumerate() {
        let (mut bounces, noise, priors) = row.linear();
        bounces.stretching.fill([0.0; 2]);
        for at in &row.at_sizes {
            let solution = solve(&bounces, &noise, at.sizes(), &priors).unwrap();
            let (values, std) = answer(row, &solution);
            let value_off = largest(&values, &at.plain_values, &at.plain_values);
            let std_off = largest(&std, &at.std, &at.std);
            let ln_off = (solution.ln_likelihood - at.plain_ln_likelihood).abs();
            assert!(
                value_off < ROUNDING && std_off < ROUNDING && ln_off < 1e-8,
                "drop {number}, {at:?}: {value_off:e} {std_off:e} {ln_off:e}"
            );
        }
    }
}

/// In standard errors: how ln of the stretch depends on C and K is taken to first order in K·T², which is up to 0.9 here.
const SLOPES_WITH_DRAG: f64 = 0.01;

#[test]
fn the_density_of_the_times_moves_the_solution_as_it_should() {
    for (number, row) in Row::all().iter().enumerate() {
        let (bounces, noise, priors) = row.linear();
        let allowed = row.drag_per_s2.map_or(ROUNDING, |_| SLOPES_WITH_DRAG);
        for at in &row.at_sizes {
            let solution = solve(&bounces, &noise, at.sizes(), &priors).unwrap();
            let (values, _) = answer(row, &solution);
            let value_off = largest(&values, &at.values, &at.std);
            let ln_off = (solution.ln_likelihood - at.ln_likelihood).abs();
            assert!(
                value_off < allowed && ln_off < allowed.max(1e-8),
                "drop {number}, {at:?}: {value_off:e} {ln_off:e}"
            );
        }
    }
}

/// Mean and standard deviation of each parameter, and the interval of ln e, against the oracle, in standard deviations.
fn mixture_off(row: &Row, posterior: &Posterior, expected: &Mixture) -> f64 {
    let offsets = row.offsets().into_iter();
    let (means, stds): (Vec<f64>, Vec<f64>) = offsets
        .map(|(i, offset)| {
            let (mean, std) = posterior.moments(i);
            (mean + offset, std)
        })
        .unzip();
    let ends = [0.025, 0.975].map(|p| posterior.quantile(0, f64::NEG_INFINITY, p));
    largest(&means, &expected.mean, &expected.std)
        .max(largest(&stds, &expected.std, &expected.std))
        .max(largest(&ends, &expected.interval95, &[expected.std[0]; 2]))
}

impl Row {
    /// How far the sum over sizes of the noises may be off, in standard deviations.
    ///
    /// The sum of a bell of width s in steps of h is off by `2·exp(−2π²·s²/h²)` at the most, with s = 1/√(2ν) and ν
    /// degrees of freedom. With ten, s = 0.22 and h is at most 2s: 0.8 % of the weight is off, which moves a width by s of
    /// that, 2e-3; three values of φ, laid where its posterior is, add as much. With fewer degrees of freedom the density
    /// is cut off at 0.3, where half a step may be off in slope: up to 1 %.
    fn quadrature(&self) -> f64 {
        let sums = if self.times_s.len() < 12 { 0.01 } else { 4e-3 };
        let is_cut = |[value, std]: [f64; 2]| value < 2.0 * std;
        if self.contact_s.is_some_and(is_cut) {
            sums + CUT
        } else {
            sums
        }
    }
}

/// In standard deviations: where a contact of 0 is near, the part below it is cut off, and ln e is skewed. A normal
/// distribution of the same mean and variance stands for it, whose third cumulant is 0: with a skewness of 1/2, as half a
/// normal distribution gives at a correlation of 0.8, the ends are off by `(z² − 1)/6·½ = 0.24` at most; here far less.
const CUT: f64 = 0.06;

/// Nats that the drag's slopes and the quadrature may cost the evidence, of which 2 are a reason to prefer a model.
const EVIDENCE: f64 = 0.02;

#[test]
fn over_all_sizes_of_the_noises_the_posterior_is_that_of_a_fine_quadrature() {
    for (number, row) in Row::all().iter().enumerate() {
        let (bounces, noise, priors) = row.linear();
        let model = Model {
            ln_odds: 0.0,
            priors,
        };
        let posterior = Posterior::over_noise(&bounces, &noise, &[model]).unwrap();
        let off = mixture_off(row, &posterior, &row.posterior);
        let evidence = posterior.ln_evidence - row.posterior.ln_evidence;
        let slopes = row.drag_per_s2.map_or(0.0, |_| SLOPES_WITH_DRAG);
        assert!(
            off < row.quadrature() + slopes && evidence.abs() < EVIDENCE,
            "drop {number}: {off:e}, evidence {evidence:e}"
        );
    }
}

/// In standard deviations: rounds end where the times move by less than a thousandth of the flights.
const SETTLING: f64 = 2e-3;

#[test]
fn the_whole_fit_is_that_of_the_oracle() {
    for (number, row) in Row::all().iter().enumerate() {
        let fit = fit(&row.impacts(), &row.terms()).unwrap();
        assert_eq!(fit.outliers, Outliers::default(), "drop {number}");
        let found = fit.ln_restitution;
        let [low, high] = found.interval95.unwrap();
        let slopes = row.drag_per_s2.map_or(0.0, |_| SLOPES_WITH_DRAG);
        let allowed = row.quadrature() + slopes + SETTLING;
        let oracle = &row.posterior;
        let [from, to] = oracle.interval95;
        let off = largest(
            &[fit.own_ln_restitution, found.std.unwrap(), low, high],
            &[oracle.mean[0], oracle.std[0], from, to],
            &[oracle.std[0]; 4],
        );
        assert!(off < allowed, "drop {number}: {off:e}");
    }
}
