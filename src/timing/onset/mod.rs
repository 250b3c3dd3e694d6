//! Onsets: where each impact's sound begins, by the rise of its energy in several bands.
//!
//! Impacts whose sounds are unlike each other have no common template, but each has a beginning. In every octave band b the
//! whitened sound x has a variance that rises at the onset τ:
//! ```text
//! V(t) = n + A·g(t − τ),     L_b(τ) = −κ/2 Σ_t [ln V(t) + x(t)²/V(t)]
//! ```
//! n is measured before τ, A maximises L, and g, the rise that all impacts have in this band, is learnt, a foot before
//! the onset included. κ < 1 tells how many samples err together. Bands disagree by more than each knows: what one
//! says is widened by a kernel, whose width is learnt from the drop, before they are multiplied:
//! ```text
//! p(τ) ∝ prior(τ)·Π_b [(1 − ε)·(p_b ∗ t₃(σ_J))(τ) + ε/R]
//! ```
//! Sounds that are alike are placed a hundred times better by their [common template](super::joint).

mod bands;
mod fusion;
mod rise;

use bands::Windows;
use fusion::Posterior;
use rise::{Likelihood, Rise};

use super::joint::Prior;
use crate::linalg::dot;
use crate::statistics::upper_median;
use crate::units::real;

/// Rounds of learning end once no onset moves by this share of its standard deviation, or by the second where windows are
/// going to be laid anew (convention) …
const REST: f64 = 0.1;
const REST_ASIDE: f64 = 0.5;
/// … or after this number of rounds: in long drops an impact with two likely places goes on moving between them.
const LIMIT: usize = 24;
/// Times that windows are laid at most.
const CENTRED: usize = 8;
/// Rises go this share of the way to what the onsets teach: more certain onsets make a steeper rise and the other way round …
const LEARNT: f64 = 0.5;
/// … and half of it from when moves turn back by this share of those before (convention).
const TURNED: f64 = 0.5;

/// Where impacts begin, from their priors, all in samples of the sound.
///
/// The windows are laid around what is found until it stays in their middle: what lies in them then depends little on where
/// the impacts were expected.
pub(super) fn onsets(sound: &[f64], rate: f64, priors: &[Prior]) -> Vec<Prior> {
    let mut found = priors.to_vec();
    let mut learning = Learning::default();
    for _ in 0..CENTRED {
        let windows = Windows::of(sound, rate, priors, &found);
        let posteriors = learning.rested(&windows, rate);
        let each = windows.of.iter().zip(&posteriors);
        let placed = each.map(|(w, p)| Prior {
            position: w.centre + p.mean,
            std: p.std,
        });
        found = placed.collect();
        if centred(&posteriors, &windows) {
            break;
        }
    }
    found
}

/// What is learnt in turn with the onsets.
#[derive(Debug, Default)]
struct Learning {
    /// The rises of all bands.
    rises: Vec<Rise>,
    /// Where the onsets were first found, in samples of the sound.
    first: Vec<f64>,
}

impl Learning {
    /// The posteriors in windows, and the rises, learnt in turn until no onset moves.
    fn rested(&mut self, windows: &Windows, rate: f64) -> Vec<Posterior> {
        let expected = || Rise::expected(rate);
        self.rises.resize_with(windows.bands.len(), expected);
        let mut posteriors: Vec<Posterior> = Vec::new();
        let mut likelihoods: Vec<Vec<Likelihood>> = Vec::new();
        let mut moves: Vec<f64> = Vec::new();
        let mut share = LEARNT;
        for _ in 0..LIMIT {
            let each = self.rises.iter().zip(&windows.bands).enumerate();
            let now = each.map(|(k, (r, b))| r.likelihoods(b, windows, likelihoods.get(k)));
            likelihoods = now.collect();
            let now = fusion::fuse(&likelihoods, windows, rate);
            let moved = moves_between(&posteriors, &now);
            posteriors = now;
            if turned(&moves, &moved) {
                share *= 0.5;
            }
            let rest = if centred(&posteriors, windows) {
                REST
            } else {
                REST_ASIDE
            };
            if !moved.is_empty() && moved.iter().all(|m| m.abs() < rest * share / LEARNT) {
                break;
            }
            moves = moved;
            let late = self.late(windows, &posteriors);
            let each = self.rises.iter_mut().zip(&windows.bands).zip(&likelihoods);
            for ((rise, band), l) in each {
                rise.learn(band, l, windows, (&posteriors, late), share);
            }
        }
        posteriors
    }

    /// How far the onsets have moved in common, in samples.
    ///
    /// Where a rise begins is a name: all onsets later and the rise earlier by as much is the same sound. Rises are learnt
    /// from where the onsets were first found, or both would creep on for ever.
    fn late(&mut self, windows: &Windows, posteriors: &[Posterior]) -> f64 {
        let each = windows.of.iter().zip(posteriors);
        let at: Vec<f64> = each.map(|(w, p)| w.centre + p.mean).collect();
        if self.first.is_empty() {
            self.first.clone_from(&at);
        }
        upper_median(at.iter().zip(&self.first).map(|(a, f)| a - f)).unwrap_or(0.0)
    }
}

/// Whether windows are centred on what was found in them.
fn centred(posteriors: &[Posterior], windows: &Windows) -> bool {
    let step = real(windows.step);
    let stays = |p: &Posterior| p.mean.abs() < 0.5 * step.max(p.std);
    posteriors.iter().all(stays)
}

/// How far each onset moved, in its standard deviations, against the others: what is common to all is only where the rise is
/// said to begin.
fn moves_between(before: &[Posterior], now: &[Posterior]) -> Vec<f64> {
    let moves = || before.iter().zip(now).map(|(b, n)| n.mean - b.mean);
    let common = upper_median(moves()).unwrap_or(0.0);
    let each = moves().zip(now).map(|(moved, n)| (moved - common) / n.std);
    each.collect()
}

/// Whether moves go back on those before.
fn turned(before: &[f64], now: &[f64]) -> bool {
    let pairs = before.iter().zip(now);
    let along: f64 = pairs.map(|(b, n)| b * n).sum();
    along < -TURNED * dot(before, before)
}

#[cfg(test)]
mod tests;
