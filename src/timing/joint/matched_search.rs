//! Matched-filter search: the place of a shape among samples, by its likelihood.

use std::ops::Range;

use super::Prior;
use super::independence::independent_samples;
use super::step::FREEDOM;
use crate::linalg::dot;
use crate::signal::correlate::Correlator;
use crate::signal::interpolate::{KERNEL, maximum, shifted};
use crate::units::real;

/// A rival is less likely than the best match by no more than this, in nats (convention): rarer ones move no mean.
const RIVAL: f64 = 9.0;

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
    /// Samples either way over which the power of what is left is judged.
    pub judged: usize,
}

/// The best place for a shape in a window.
///
/// # Formula
/// ```text
/// L(p) = −n/2·ln(R + E − E(p)) − (ν + 1)/2·ln(1 + z²/ν),      z = (p − prior)/σ
/// ```
/// `E(p) = (Σ w·x·s(· − p))²/Σ w·s²(· − p)` is the energy that the shape explains at p, by a positive amplitude, and E the most;
/// there R is left, or what noise leaves if that is more, of n [`independent_samples`]. Where it is noise, L falls by half of what
/// is explained less; where it is another sound, of a size that nobody knows, several places remain likely.
pub(super) fn best_match(
    correlator: &mut Correlator,
    window: Window<'_>,
    shape: &[f64],
    search: Search,
) -> Option<Match> {
    let correlated = Correlated::of(correlator, window, shape)?;
    let top = correlated.top()?;
    let near = |position: f64| (position - search.prior.position).abs() <= real(search.reach);
    let tops: Vec<usize> = correlated.tops().filter(|&k| near(real(k))).collect();
    let best = correlated.peak(top);
    // One alone has no rival, whatever is left.
    let left = if tops.len() > 1 {
        best.left(window, shape, top)
    } else {
        Vec::new()
    };
    let independent = independent_samples(correlator, &left, search.judged);
    let least = left
        .iter()
        .map(|r| r * r)
        .sum::<f64>()
        .max(real(shape.len()));
    let likelihood = |position: f64, energy: f64| {
        let z = (position - search.prior.position) / search.prior.std;
        -0.5 * independent * (least + (best.energy - energy).max(0.0)).ln()
            - 0.5 * (FREEDOM + 1.0) * (z * z / FREEDOM).ln_1p()
    };
    let coarse = tops
        .iter()
        .map(|&k| likelihood(real(k), correlated.energy(k)));
    let highest = coarse.clone().fold(f64::NEG_INFINITY, f64::max);
    let rivals = tops.iter().zip(coarse).filter(|t| t.1 > highest - RIVAL);
    let peaks = rivals.map(|(&k, _)| correlated.peak(k));
    let peaks = peaks.filter(|peak| near(peak.position));
    let peaks: Vec<(Peak, f64)> = peaks
        .map(|peak| (peak, likelihood(peak.position, peak.energy)))
        .collect();
    let &(best, highest) = peaks.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let shares = peaks.iter().map(|(p, l)| ((l - highest).exp(), p.position));
    let total: f64 = shares.clone().map(|(share, _)| share).sum();
    let spread = shares.map(|(share, p)| share * (p - best.position).powi(2));
    Some(Match {
        position: best.position,
        amplitude: best.amplitude,
        ambiguity: (spread.sum::<f64>() / total).sqrt(),
    })
}

/// A shape against samples, at every lag.
struct Correlated {
    /// `Σ w·x·s` and `Σ w·s²`.
    products: Vec<f64>,
    energies: Vec<f64>,
    /// The lags between which a maximum can be interpolated.
    inside: Range<usize>,
}

/// A maximum of a match between lags.
#[derive(Debug, Clone, Copy)]
struct Peak {
    position: f64,
    amplitude: f64,
    /// The energy that it explains, over the noise.
    energy: f64,
}

impl Correlated {
    fn of(correlator: &mut Correlator, window: Window<'_>, shape: &[f64]) -> Option<Self> {
        let weights: Vec<f64> = window.noise.iter().map(|n| 1.0 / n).collect();
        let weighted = window.sound.iter().zip(&weights).map(|(x, w)| x * w);
        let products = correlator.correlate(&weighted.collect::<Vec<f64>>(), shape)?;
        let lags = products.len();
        let flat = weights.iter().all(|w| (w - weights[0]).abs() < 1e-9);
        let energies = if flat {
            vec![weights[0] * dot(shape, shape); lags]
        } else {
            // Energies next to 0 are rounding errors: the floor keeps matches there from explaining anything.
            let squares: Vec<f64> = shape.iter().map(|s| s * s).collect();
            let mut energies = correlator.correlate(&weights, &squares)?;
            let least = LEAST_ENERGY * energies.iter().fold(0.0, |a: f64, &b| a.max(b));
            energies.iter_mut().for_each(|e| *e = e.max(least));
            energies
        };
        Some(Self {
            products,
            energies,
            inside: KERNEL..lags.checked_sub(KERNEL)?.max(KERNEL + 1),
        })
    }

    /// The energy that a lag explains.
    fn energy(&self, k: usize) -> f64 {
        self.products[k].max(0.0).powi(2) / self.energies[k]
    }

    /// The lag that explains most; none where none does.
    fn top(&self) -> Option<usize> {
        let more = |&a: &usize, &b: &usize| self.energy(a).total_cmp(&self.energy(b));
        let top = self.inside.clone().max_by(more)?;
        (self.products[top] > 0.0).then_some(top)
    }

    /// The lags of the maxima.
    fn tops(&self) -> impl Iterator<Item = usize> {
        let p = &self.products;
        let lags = self.inside.clone();
        lags.filter(|&k| p[k] > 0.0 && p[k] >= p[k - 1] && p[k] > p[k + 1])
    }

    /// The maximum near a lag.
    fn peak(&self, k: usize) -> Peak {
        let (position, height) = maximum(&self.products, k);
        Peak {
            position,
            amplitude: height / self.energies[k],
            energy: height * height / self.energies[k],
        }
    }
}

impl Peak {
    /// What it leaves of the samples, over their noise.
    fn left(self, window: Window<'_>, shape: &[f64], lag: usize) -> Vec<f64> {
        let sound = shifted(window.sound, self.position, shape.len());
        let each = sound.iter().zip(&window.noise[lag..]).zip(shape);
        let left = each.map(|((x, n), s)| (x - self.amplitude * s) / n.sqrt());
        left.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

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
                judged: 4,
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

    #[test]
    fn beside_another_loud_sound_several_places_are_likely_and_alone_one() {
        let ring = |t: f64| {
            if t > 0.0 {
                (-t / 25.0).exp() * (0.5 * t).sin()
            } else {
                0.0
            }
        };
        let shape: Vec<f64> = (0..160).map(|i| ring(real(i) - 10.0)).collect();
        let prior = Prior {
            position: 66.0,
            std: 12.0,
        };
        let search = Search {
            prior,
            reach: 40,
            judged: 44,
        };
        let mut rng = SplitMix64::new(8);
        let mut found = |other: f64| {
            let at = |i: usize| {
                let t = real(i);
                let another =
                    other * (-(t - 90.0).max(0.0) / 30.0).exp() * (0.41 * (t - 90.0)).sin();
                60.0 * ring(t - 70.0) + if t > 90.0 { another } else { 0.0 } + rng.normal()
            };
            let sound: Vec<f64> = (0..300).map(at).collect();
            let window = Window {
                noise: &[1.0; 300],
                sound: &sound,
            };
            best_match(&mut Correlator::default(), window, &shape, search).unwrap()
        };
        let alone = found(0.0);
        assert!(
            (alone.position - 60.0).abs() < 0.1 && alone.ambiguity < 0.01,
            "{alone:?}"
        );
        let beside = found(150.0);
        let off = (beside.position - 60.0).abs();
        assert!(
            beside.ambiguity > 3.0 && off < 2.0 * beside.ambiguity,
            "{beside:?}"
        );
    }
}
