//! Bounces that lose more and less by turns.

use super::Ratio;
use super::robust::LEAST_SCATTER;
use crate::fit::student;
use crate::units::{real, whole};

/// Parts of a drop that have to alternate alike, and the chance that they do without cause. Conventions.
const PARTS: usize = 4;
const CHANCE: f64 = 1e-3;
/// Fewest ratios with a neighbour on each side: two in most parts.
const FEWEST: usize = 6;

/// An alternation of ln ratios.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alternation {
    /// Mean of the ln ratios.
    middle: f64,
    /// What those of bounces of even number have beside it, and the others less.
    half: f64,
}

impl Alternation {
    /// What ln of the ratio of this bounce has beside the mean.
    pub(super) const fn at(&self, bounce: usize) -> f64 {
        if bounce.is_multiple_of(2) {
            self.half
        } else {
            -self.half
        }
    }

    /// The two ratios, the greater first.
    #[must_use]
    pub fn ratios(&self) -> [f64; 2] {
        [self.half.abs(), -self.half.abs()].map(|off| (self.middle + off).exp())
    }
}

/// The alternation of bounces that lose more and less by turns.
///
/// # Formula
/// ```text
/// u_i = (−1)^i·(r_i − (r_{i−1} + r_{i+1})/2)/2,   r = ln(T'/T)
/// ```
/// has the mean a where ln ratios alternate by ±a, and 0 whatever the trend. The means of u in four parts of the drop differ from
/// 0 by Student's test: errors of the times alternate as well, but in every part otherwise. Weights are 1/(s² + timing), s the
/// least scatter, and the parts are equal in weight.
pub(super) fn alternation(ratios: &[Ratio]) -> Option<Alternation> {
    let in_turn = ratios.windows(3).filter(|w| w[2].0 == w[0].0 + 2);
    let turns: Vec<(f64, f64)> = in_turn
        .map(|w| {
            let off = 0.5 * (w[1].1 - 0.5 * (w[0].1 + w[2].1));
            let weight = 1.0 / (LEAST_SCATTER.powi(2) + w[1].2);
            (if w[1].0.is_multiple_of(2) { off } else { -off }, weight)
        })
        .collect();
    if turns.len() < FEWEST {
        return None;
    }
    let total: f64 = turns.iter().map(|(_, weight)| weight).sum();
    let (mut sums, mut before) = ([(0.0, 0.0); PARTS], 0.0);
    for (off, weight) in turns {
        let share = (before + 0.5 * weight) / total;
        let (sum, weights) = &mut sums[whole(share * real(PARTS)).min(PARTS - 1)];
        *sum += weight * off;
        *weights += weight;
        before += weight;
    }
    let parts = sums.map(|(sum, weights)| sum / weights);
    let (half, freedom) = (parts.iter().sum::<f64>() / real(PARTS), real(PARTS - 1));
    let squares: f64 = parts.iter().map(|p| (p - half).powi(2)).sum();
    let error = (squares / (freedom * real(PARTS))).sqrt();
    let middle = ratios.iter().map(|r| r.1).sum::<f64>() / real(ratios.len());
    (half.abs() > student(1.0 - 0.5 * CHANCE, freedom) * error)
        .then_some(Alternation { middle, half })
}
