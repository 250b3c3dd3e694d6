//! What the bands say together of where each impact begins.

use super::bands::Windows;
use super::focus::Focus;
use super::rise::Likelihoods;
use crate::units::real;
use std::ops::Range;

/// Widths of the bands' disagreement that are compared, in seconds, and shares of bands that say nothing of an impact.
pub(super) const WIDTHS_S: [f64; 7] = [4e-6, 10e-6, 20e-6, 40e-6, 80e-6, 160e-6, 320e-6];
pub(super) const SILENT: [f64; 3] = [0.02, 0.1, 0.3];
/// Least width of the kernel, in places: narrower ones are alike on the grid.
const NARROWEST: f64 = 0.3;
/// Places of less than this share of a posterior are not widened.
const LEAST_PLACE: f64 = 1e-7;
/// A trial of less than this share of the evidence does not count.
const LEAST_TRIAL: f64 = 1e-4;

/// Where one impact begins: mean from the centre of its window and standard deviation, in samples, and the probability of
/// each place of its grid.
#[derive(Debug, Clone)]
pub(super) struct Posterior {
    pub mean: f64,
    pub std: f64,
    pub p: Vec<f64>,
}

/// A width and a share: its evidence in nats, and the probability of each place of each impact in focus, up to a factor.
struct Trial {
    evidence: f64,
    joint: Vec<Vec<f64>>,
}

/// Posteriors of all impacts, over the widths and shares by their evidence; and the share of each of these, none where it is
/// out of focus.
pub(super) fn fuse(
    bands: &[Likelihoods],
    windows: &Windows,
    rate: f64,
    focus: &Focus,
) -> (Vec<Posterior>, Vec<f64>) {
    let of_band = |band: &Likelihoods| -> Vec<Vec<f64>> {
        let scaled = |ln: &Vec<f64>| ln.iter().map(|l| band.kappa * l).collect::<Vec<f64>>();
        let each = band.of.iter().map(|l| normalised(&scaled(&l.ln)));
        each.collect()
    };
    let each: Vec<Vec<Vec<f64>>> = bands.iter().map(of_band).collect();
    let priors = priors(windows);
    let mut trials = Vec::with_capacity(WIDTHS_S.len() * SILENT.len());
    for (w, width_s) in WIDTHS_S.iter().enumerate() {
        let silent = focus.of_width(w);
        if silent.iter().all(|looks| !looks) {
            trials.extend(SILENT.map(|_| None));
            continue;
        }
        let kernel = kernel(width_s * rate / real(windows.step), windows.places());
        let widened = |band: &Vec<Vec<f64>>| -> Vec<Vec<f64>> {
            let each = band.iter().zip(&focus.places);
            each.map(|(p, places)| convolved(p, &kernel, places))
                .collect()
        };
        let wide: Vec<Vec<Vec<f64>>> = each.iter().map(widened).collect();
        let tried = SILENT.iter().zip(silent);
        trials.extend(tried.map(|(s, looks)| looks.then(|| trial(&priors, &wide, *s, focus))));
    }
    averaged(&trials, windows, focus)
}

/// Probability of each place of each grid by the prior.
fn priors(windows: &Windows) -> Vec<Vec<f64>> {
    let prior = windows.of.iter().map(|w| {
        let places = 0..=2 * w.reach;
        let ln = places.map(|k| {
            let off = (w.offset(k, windows.step) - w.prior.position) / w.prior.std;
            -0.5 * off * off
        });
        normalised(&ln.collect::<Vec<f64>>())
    });
    prior.collect()
}

fn trial(priors: &[Vec<f64>], wide: &[Vec<Vec<f64>>], silent: f64, focus: &Focus) -> Trial {
    let joint = |(i, (prior, places)): (usize, (&Vec<f64>, &Range<usize>))| -> Vec<f64> {
        let other = silent / real(prior.len());
        let together = |k: usize| -> f64 {
            let bands = wide.iter().map(|b| (1.0 - silent) * b[i][k] + other);
            bands.product()
        };
        let near = prior[places.clone()].iter().enumerate();
        near.map(|(k, p)| p * together(k)).collect()
    };
    let each = priors.iter().zip(&focus.places).enumerate();
    let joint: Vec<Vec<f64>> = each.map(joint).collect();
    let sums = joint.iter().map(|j| j.iter().sum::<f64>());
    Trial {
        evidence: sums.map(|s| s.max(f64::MIN_POSITIVE).ln()).sum(),
        joint,
    }
}

/// The posteriors of impacts, over trials by their evidence, and the share of each trial.
fn averaged(
    trials: &[Option<Trial>],
    windows: &Windows,
    focus: &Focus,
) -> (Vec<Posterior>, Vec<f64>) {
    let evidence = |t: &Option<Trial>| t.as_ref().map_or(f64::NEG_INFINITY, |t| t.evidence);
    let shares = normalised(&trials.iter().map(evidence).collect::<Vec<f64>>());
    let likely = shares.iter().zip(trials);
    let likely: Vec<(f64, &Trial)> = likely
        .filter(|(share, _)| **share > LEAST_TRIAL)
        .filter_map(|(share, trial)| Some((*share, trial.as_ref()?)))
        .collect();
    let each = windows.of.iter().zip(&focus.places).enumerate();
    let posterior = each.map(|(i, (w, places))| {
        let mut p = vec![0.0; 2 * w.reach + 1];
        for (share, trial) in &likely {
            let sum: f64 = trial.joint[i].iter().sum();
            for (p, joint) in p[places.clone()].iter_mut().zip(&trial.joint[i]) {
                *p += share * joint / sum.max(f64::MIN_POSITIVE);
            }
        }
        let sum: f64 = p.iter().sum();
        p.iter_mut().for_each(|p| *p /= sum);
        let step = windows.step;
        let places = || p.iter().enumerate().map(|(k, p)| (p, w.offset(k, step)));
        let mean: f64 = places().map(|(p, at)| p * at).sum();
        let variance: f64 = places().map(|(p, at)| p * (at - mean).powi(2)).sum();
        // Of a grid's place the variance is that of an even density over a step.
        let std = (variance + real(step).powi(2) / 12.0).sqrt();
        Posterior { mean, std, p }
    });
    (posterior.collect(), shares)
}

/// Probabilities of sum 1 from their logarithms up to a constant.
fn normalised(ln: &[f64]) -> Vec<f64> {
    let top = ln.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let p: Vec<f64> = ln.iter().map(|l| (l - top).exp()).collect();
    let sum: f64 = p.iter().sum();
    p.into_iter().map(|p| p / sum).collect()
}

/// Student's density with 3 degrees of freedom at whole places, this many on either side of its middle one, of sum 1.
fn kernel(width: f64, places: usize) -> Vec<f64> {
    let width = width.max(NARROWEST);
    let at = |k: usize| (1.0 + (real(k.abs_diff(places)) / width).powi(2) / 3.0).powi(-2);
    let both: Vec<f64> = (0..=2 * places).map(at).collect();
    let sum: f64 = both.iter().sum();
    both.into_iter().map(|k| k / sum).collect()
}

/// At some places only.
fn convolved(p: &[f64], kernel: &[f64], places: &Range<usize>) -> Vec<f64> {
    let middle = kernel.len() / 2;
    let mut out = vec![0.0; places.len()];
    for (i, p) in p.iter().enumerate().filter(|(_, p)| **p > LEAST_PLACE) {
        for (o, k) in out.iter_mut().zip(&kernel[middle + places.start - i..]) {
            *o += p * k;
        }
    }
    out
}
