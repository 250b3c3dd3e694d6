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
//!
//! Rises and onsets are learnt in turn until no onset moves against the others. Where all begin together is not told by them: a rise
//! that is said to begin later fits the same sounds with earlier onsets. Left alone, both drift that way for a hundred rounds, for
//! there the rise is divided more finely. So the onsets are held, in the median, where the first round placed them: a rise is
//! learnt as it is from there on.

mod bands;
mod focus;
mod fusion;
mod lesson;
mod rise;

use bands::Windows;
use focus::{Focus, MARGIN};
use fusion::Posterior;
use lesson::Lesson;
use rise::{Likelihoods, Rise};

use super::joint::Prior;
use crate::statistics::upper_median;
use crate::units::real;

/// Learning ends once no onset moves by this share of its standard deviation (convention) in a whole step.
const REST: f64 = 0.1;
/// Share of the way to what is learnt that a step goes (convention): more certain places make a steeper rise and the other way
/// round. It is halved where an onset turns back by more than this share of its move before.
const STEP: f64 = 0.5;
const OVERSHOT: f64 = 0.7;
/// Rounds of learning at most: a bound that no real drop of those tried reaches.
const LIMIT: usize = 100;

/// Where impacts begin, from their priors, all in samples of the sound.
///
/// The windows are laid around what is found until it stays in their middle: what lies in them then depends little on where
/// the impacts were expected. An onset that turns back has two likely places, and its window stays between them; so each goes
/// one way, by half a step at least, and no farther than its prior lets it.
pub(super) fn onsets(sound: &[f64], rate: f64, priors: &[Prior]) -> Vec<Prior> {
    let mut found = priors.to_vec();
    let mut moved: Vec<Option<f64>> = vec![Some(0.0); priors.len()];
    let mut known: Option<Learnt> = None;
    loop {
        let windows = Windows::of(sound, rate, priors, &found);
        let learnt = known
            .take()
            .unwrap_or_else(|| Learnt::nothing(&windows, rate));
        let (posteriors, learnt) = learnt.settled(&windows, rate);
        let mut moves = false;
        for ((at, moved), p) in found.iter_mut().zip(&mut moved).zip(&posteriors) {
            at.position = at.position.round();
            at.std = p.std;
            // What is no number goes nowhere.
            let goes = p.mean.abs() >= 0.5 * real(windows.step).max(p.std);
            let Some(before) = moved.filter(|_| goes) else {
                continue;
            };
            let back = before * p.mean < 0.0;
            at.position += if back { 0.5 * p.mean } else { p.mean };
            *moved = (!back).then_some(p.mean);
            moves = true;
        }
        if !moves {
            let each = windows.of.iter().zip(&posteriors);
            let placed = each.map(|(w, p)| Prior {
                position: w.centre + p.mean,
                std: p.std,
            });
            return placed.collect();
        }
        known = Some(learnt);
    }
}

/// What is learnt of all impacts.
struct Learnt {
    /// The rise of each band.
    rises: Vec<Rise>,
    /// Where all onsets are held together, in samples after their priors; none before a first look.
    held: Option<f64>,
}

impl Learnt {
    /// Before any sound is seen.
    fn nothing(windows: &Windows, rate: f64) -> Self {
        Self {
            rises: windows.bands.iter().map(|_| Rise::expected(rate)).collect(),
            held: None,
        }
    }

    /// The posteriors in windows, learnt in turn with the rises until no onset moves.
    ///
    /// A round looks only where something was likely before; what rests so has to rest where all is looked at.
    fn settled(mut self, windows: &Windows, rate: f64) -> (Vec<Posterior>, Self) {
        let everywhere = Focus::whole(windows);
        let each = self.rises.iter().zip(&windows.bands);
        let mut likelihoods: Vec<Likelihoods> =
            each.map(|(r, b)| r.likelihoods(b, windows)).collect();
        let (mut posteriors, mut trials) = fusion::fuse(&likelihoods, windows, rate, &everywhere);
        let held = *self
            .held
            .get_or_insert_with(|| common(&posteriors, windows));
        let farthest = real(MARGIN * windows.step);
        let mut step = STEP;
        let mut last = vec![0.0; posteriors.len()];
        let mut rested = false;
        for _ in 0..LIMIT {
            let early = (held - common(&posteriors, windows)).clamp(-farthest, farthest);
            for ((rise, band), l) in (self.rises.iter_mut().zip(&windows.bands)).zip(&likelihoods) {
                let lesson = Lesson::of(rise, (band, windows), rate, l, &posteriors);
                rise.learn(&lesson, early, step);
            }
            let near = Focus::on(&posteriors, &trials);
            let focus = if rested { &everywhere } else { &near };
            for ((rise, band), l) in (self.rises.iter().zip(&windows.bands)).zip(&mut likelihoods) {
                rise.relook(band, windows, focus, l);
            }
            let now = fusion::fuse(&likelihoods, windows, rate, focus);
            let moves = moves(&posteriors, &now.0);
            (posteriors, trials) = now;
            let rests = moves.iter().all(|z| z.abs() < REST * step / STEP);
            if rested && rests {
                break;
            }
            if turns_back(&last, &moves) {
                step *= 0.5;
            }
            last = moves;
            rested = rests;
        }
        (posteriors, self)
    }
}

/// Where all onsets lie together, in samples after their priors.
fn common(posteriors: &[Posterior], windows: &Windows) -> f64 {
    let each = posteriors.iter().zip(&windows.of);
    upper_median(each.map(|(p, w)| p.mean - w.prior.position)).unwrap_or(0.0)
}

/// Moves of the onsets in standard deviations, against the others: what is common to all is only where the rise is said to
/// begin.
fn moves(before: &[Posterior], now: &[Posterior]) -> Vec<f64> {
    let moves = || before.iter().zip(now).map(|(b, n)| n.mean - b.mean);
    let common = upper_median(moves()).unwrap_or(0.0);
    moves()
        .zip(now)
        .map(|(moved, n)| (moved - common) / n.std)
        .collect()
}

/// Whether the onset that moves most turns back, and by nearly as much as it moved before.
fn turns_back(before: &[f64], now: &[f64]) -> bool {
    let pairs = before.iter().zip(now);
    let most = pairs.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    most.is_some_and(|(before, now)| before * now < 0.0 && now.abs() > OVERSHOT * before.abs())
}

#[cfg(test)]
mod tests;
