//! Where a shape fits best among samples.

use super::Prior;
use crate::signal::correlate::Correlator;
use crate::signal::interpolate::{KERNEL, maximum};
use crate::units::real;

/// A match of less than this share of the best is no rival.
const RIVAL: f64 = 0.5;

/// A place where a shape fits.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    pub position: f64,
    pub amplitude: f64,
    /// Spread over all places that fit, each by its likelihood.
    pub doubt: f64,
}

/// Least energy of a shape where much of it was not recorded, as a share of the greatest.
const LEAST_ENERGY: f64 = 1e-9;

/// Samples, and the variance of each.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window<'a> {
    pub sound: &'a [f64],
    pub noise: &'a [f64],
}

/// Where a shape is expected to begin.
#[derive(Debug, Clone, Copy)]
pub(super) struct Search {
    pub prior: Prior,
    /// Farthest from the prior, in samples.
    pub reach: usize,
    /// How many times the variance of independent samples that of these is.
    pub overdispersion: f64,
}

/// The best place for a shape in a window.
///
/// # Formula
/// `L(p) = (Σ w·x·s(· − p))²/(2 Σ w·s²(· − p))/scale − (p − prior)²/2σ²`: what a shape of positive amplitude explains,
/// where what it leaves has the variance `scale`, at least 1, times the overdispersion.
pub(super) fn best(
    correlator: &mut Correlator,
    window: Window<'_>,
    shape: &[f64],
    search: Search,
) -> Option<Fit> {
    let (samples, noise, prior) = (window.sound, window.noise, search.prior);
    let weighted: Vec<f64> = samples.iter().zip(noise).map(|(x, n)| x / n).collect();
    let squares: Vec<f64> = shape.iter().map(|s| s * s).collect();
    let weights: Vec<f64> = noise.iter().map(|n| 1.0 / n).collect();
    let lags = samples.len() - shape.len() + 1;
    let products = correlator.correlate(&weighted, shape)?;
    let flat = weights.iter().all(|w| (w - weights[0]).abs() < 1e-9);
    let energies = if flat {
        vec![weights[0] * squares.iter().sum::<f64>(); lags]
    } else {
        // Rounding leaves nothing certain of what is next to none: there a match explains nothing.
        let mut energies = correlator.correlate(&weights, &squares)?;
        let least = LEAST_ENERGY * energies.iter().fold(0.0, |a: f64, &b| a.max(b));
        energies.iter_mut().for_each(|e| *e = e.max(least));
        energies
    };
    let explained = |k: usize| products[k].max(0.0).powi(2) / (2.0 * energies[k]);
    let inside = KERNEL..lags.checked_sub(KERNEL)?.max(KERNEL + 1);
    let top = inside
        .clone()
        .max_by(|&a, &b| explained(a).total_cmp(&explained(b)))?;
    if products[top] <= 0.0 {
        return None;
    }
    let all: f64 = samples[top..top + shape.len()]
        .iter()
        .zip(&weighted[top..])
        .map(|(x, w)| x * w)
        .sum();
    let scale = search.overdispersion * ((all - 2.0 * explained(top)) / real(shape.len())).max(1.0);
    let peaks: Vec<(f64, f64, f64)> = inside
        .filter(|&k| {
            explained(k) >= RIVAL * explained(top)
                && products[k] >= products[k - 1]
                && products[k] > products[k + 1]
        })
        .map(|k| {
            let (position, height) = maximum(&products, k);
            let likelihood = height * height / (2.0 * energies[k]) / scale
                - 0.5 * ((position - prior.position) / prior.std).powi(2);
            (position, height / energies[k], likelihood)
        })
        .filter(|(position, ..)| (position - prior.position).abs() <= real(search.reach))
        .collect();
    let &(position, amplitude, likelihood) = peaks.iter().max_by(|a, b| a.2.total_cmp(&b.2))?;
    let shares = peaks.iter().map(|p| ((p.2 - likelihood).exp(), p.0));
    let total: f64 = shares.clone().map(|(share, _)| share).sum();
    let spread = shares.map(|(share, p)| share * (p - position).powi(2));
    Some(Fit {
        position,
        amplitude,
        doubt: (spread.sum::<f64>() / total).sqrt(),
    })
}
