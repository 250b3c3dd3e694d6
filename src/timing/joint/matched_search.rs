//! Matched-filter search: the place of a shape among samples, by its likelihood.

use super::Prior;
use crate::signal::correlate::Correlator;
use crate::signal::interpolate::{KERNEL, maximum};
use crate::units::real;

/// A rival explains at least this share of the energy that the best match explains.
const RIVAL: f64 = 0.5;

/// The best match of a shape.
#[derive(Debug, Clone, Copy)]
pub(super) struct Match {
    pub position: f64,
    pub amplitude: f64,
    /// Standard deviation over all rival places, weighted by their likelihoods.
    pub ambiguity: f64,
}

/// Least energy of a shape where much of it was not recorded, as a share of the greatest.
const LEAST_ENERGY: f64 = 1e-9;

/// Samples, and the variance of each.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window<'a> {
    pub sound: &'a [f64],
    pub noise: &'a [f64],
}

/// Range and prior of the search for a shape.
#[derive(Debug, Clone, Copy)]
pub(super) struct Search {
    pub prior: Prior,
    /// Farthest from the prior, in samples.
    pub reach: usize,
    /// Variance of these samples over that of independent ones.
    pub overdispersion: f64,
}

/// The best place for a shape in a window.
///
/// # Formula
/// `L(p) = (Σ w·x·s(· − p))²/(2 Σ w·s²(· − p))/scale − (p − prior)²/2σ²`: the log-likelihood of a shape of positive
/// amplitude, where the residual has the variance `scale`, at least 1, times the overdispersion.
pub(super) fn best_match(
    correlator: &mut Correlator,
    window: Window<'_>,
    shape: &[f64],
    search: Search,
) -> Option<Match> {
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
        // Energies next to 0 are rounding errors: the floor keeps matches there from explaining anything.
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
    Some(Match {
        position,
        amplitude,
        ambiguity: (spread.sum::<f64>() / total).sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::dot;
    use crate::random::SplitMix64;
    use crate::signal::interpolate::shifted;

    /// The best place at every hundredth of a sample by the definition of the likelihood, and the amplitude there.
    fn searched(sound: &[f64], shape: &[f64], prior: Prior, scale: f64) -> (f64, f64) {
        let last = sound.len() - shape.len() - KERNEL;
        let places = (100 * KERNEL..100 * last).map(|k| 0.01 * real(k));
        let energy = dot(shape, shape);
        let each = places.map(|p| {
            let product = dot(&shifted(sound, p, shape.len()), shape).max(0.0);
            let far = (p - prior.position) / prior.std;
            (
                product * product / (2.0 * energy * scale) - 0.5 * far * far,
                p,
                product / energy,
            )
        });
        let best = each.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
        (best.1, best.2)
    }

    #[test]
    fn the_best_place_is_that_of_a_search_of_all() {
        let mut rng = SplitMix64::new(6);
        let ring = |t: f64| {
            if t > 0.0 {
                t.powi(2) * (-t / 9.0).exp() * (0.5 * t).sin()
            } else {
                0.0
            }
        };
        let shape: Vec<f64> = (0..80).map(|i| ring(real(i) - 10.0)).collect();
        for (place, std) in [(60.3, 5.0), (75.81, 20.0), (52.5, 8.0)] {
            let at = |i: usize| 0.4 * ring(real(i) - 10.0 - place) + rng.normal();
            let sound: Vec<f64> = (0..200).map(at).collect();
            let prior = Prior {
                position: 60.0,
                std,
            };
            let (position, amplitude) = searched(&sound, &shape, prior, 1.0);
            let window = Window {
                noise: &vec![1.0; sound.len()],
                sound: &sound,
            };
            let search = Search {
                prior,
                reach: 100,
                overdispersion: 1.0,
            };
            let found = best_match(&mut Correlator::default(), window, &shape, search).unwrap();
            assert!(
                (found.position - position).abs() < 0.05,
                "{} {position}",
                found.position
            );
            assert!((found.amplitude / amplitude - 1.0).abs() < 0.01);
            assert!(
                (found.position - place).abs() < 0.3,
                "{} {place}",
                found.position
            );
        }
    }
}
