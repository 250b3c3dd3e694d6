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
mod focus;
mod fusion;
mod rise;

use bands::Windows;
use focus::Focus;
use fusion::Posterior;
use rise::{Likelihoods, Rise};

use super::joint::Prior;
use crate::statistics::upper_median;
use crate::units::real;

/// Rounds of learning end once no onset moves by this share of its standard deviation (convention) …
const REST: f64 = 0.1;
/// … or after this number of rounds: in long drops an impact with two likely places goes on moving between them.
const LIMIT: usize = 24;
/// Times that windows are laid at most.
const CENTRED: usize = 4;

/// Where impacts begin, from their priors, all in samples of the sound.
///
/// The windows are laid around what is found until it stays in their middle: what lies in them then depends little on where
/// the impacts were expected.
pub(super) fn onsets(sound: &[f64], rate: f64, priors: &[Prior]) -> Vec<Prior> {
    let mut found = priors.to_vec();
    let mut rises = None;
    for _ in 0..CENTRED {
        let windows = Windows::of(sound, rate, priors, &found);
        let first = || windows.bands.iter().map(|_| Rise::expected(rate)).collect();
        let known: Vec<Rise> = rises.take().unwrap_or_else(first);
        let (posteriors, known) = learnt(&windows, known, rate);
        let each = windows.of.iter().zip(&posteriors);
        let placed = each.map(|(w, p)| Prior {
            position: w.centre + p.mean,
            std: p.std,
        });
        found = placed.collect();
        rises = Some(known);
        let stays = |p: &Posterior| p.mean.abs() < 0.5 * real(windows.step).max(p.std);
        if posteriors.iter().all(stays) {
            break;
        }
    }
    found
}

/// The posteriors in windows, and the rises of all bands, learnt in turn from those given until no onset moves.
///
/// A round looks only where something was likely before; what rests so has to rest where all is looked at.
fn learnt(windows: &Windows, mut rises: Vec<Rise>, rate: f64) -> (Vec<Posterior>, Vec<Rise>) {
    let everywhere = Focus::whole(windows);
    let each = rises.iter().zip(&windows.bands);
    let mut likelihoods: Vec<Likelihoods> = each.map(|(r, b)| r.likelihoods(b, windows)).collect();
    let (mut posteriors, mut trials) = fusion::fuse(&likelihoods, windows, rate, &everywhere);
    let mut rested = false;
    for _ in 0..LIMIT {
        for ((rise, band), l) in rises.iter_mut().zip(&windows.bands).zip(&mut likelihoods) {
            rise.learn(band, l, windows, &posteriors);
        }
        let near = Focus::on(&posteriors, &trials);
        let focus = if rested { &everywhere } else { &near };
        for ((rise, band), l) in rises.iter().zip(&windows.bands).zip(&mut likelihoods) {
            rise.relook(band, windows, focus, l);
        }
        let now = fusion::fuse(&likelihoods, windows, rate, focus);
        let rests = rest(&posteriors, &now.0);
        (posteriors, trials) = now;
        if rested && rests {
            break;
        }
        rested = rests;
    }
    (posteriors, rises)
}

/// Whether no onset moved by much, against the others: what is common to all is only where the rise is said to begin.
fn rest(before: &[Posterior], now: &[Posterior]) -> bool {
    let moves = || before.iter().zip(now).map(|(b, n)| n.mean - b.mean);
    let Some(common) = upper_median(moves()) else {
        return false;
    };
    moves()
        .zip(now)
        .all(|(moved, n)| (moved - common).abs() < REST * n.std)
}

#[cfg(test)]
mod tests;
