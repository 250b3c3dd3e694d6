//! The inner loop of the alternation, and when it rests.

use super::Place;
use super::alternate::Joint;
use super::damping::Damping;
use super::step::{Moved, Step};
use crate::linalg::dot;
use crate::signal::template::Sample;
use crate::signal::template::average::factors;

/// An impact rests once it moves by no more than this share of its standard error, against the others: a loud one, which makes
/// most of its own template, has ten such steps to go (convention) …
const REST: f64 = 0.02;
/// … and what is held is learnt anew until none moves by more than this share in all, and until no standard error changes by
/// more than this share of itself (convention).
const HELD_REST: f64 = 0.2;
const STD_REST: f64 = 0.3;
/// Rounds of the inner loop at most: a bound for dull sounds that overlap, more than three times the most seen, 149 in 301
/// recordings.
const LIMIT: usize = 500;
/// Moves are steady where their cosine with those before is at least this, and they shrink by no more than the first share;
/// a share above the second is taken as that (convention).
const STEADY: f64 = 0.9;
const SHARES: (f64, f64) = (0.5, 0.95);

impl Joint<'_> {
    /// Times and template in turn until they rest, and the heads with them, whose noise and weights are held.
    ///
    /// What all moves have in common is not gone: times and template leave it undetermined, and it would creep on for ever.
    /// Where the moves beyond it are about the same share r of those of the round before, the rest of the way is
    /// `r + r² + … = r/(1 − r)` of the last ones (Aitken), and is gone at once.
    pub(super) fn rest(&mut self, heads: &mut [Sample]) {
        let count = self.places.len();
        let mut before: Option<Vec<f64>> = None;
        let mut damping = Damping::lasting(count);
        for _ in 0..LIMIT {
            let steps: Vec<Step> = (0..count).map(|i| self.step(i)).collect();
            let moves: Vec<Moved> = steps.iter().map(|s| s.moved).collect();
            let mut beyond = self.beyond_common(&moves);
            damp(&mut beyond, &moves, &mut damping);
            let share = before.as_ref().and_then(|b| steady_share(b, &beyond));
            let left = share.map_or(0.0, |share| share / (1.0 - share));
            let on = beyond.iter().zip(&moves).map(|(z, m)| {
                // An impact that has vanished knows nothing, and stays.
                let wanted = (1.0 + left) * z * m.std;
                if wanted.is_finite() {
                    wanted - m.by
                } else {
                    0.0
                }
            });
            for (i, (step, on)) in steps.iter().zip(on).enumerate() {
                self.go_on(i, step, on, &mut heads[i]);
            }
            let stretches = &self.started.contact_stretches;
            self.template.learn_shape(heads, stretches);
            if greatest(&beyond) < REST {
                break;
            }
            before = share.is_none().then_some(beyond);
        }
    }

    /// The places as they are, with their standard errors.
    pub(super) fn now(&self) -> Vec<(Place, f64)> {
        let each = self.places.iter().enumerate();
        each.map(|(i, place)| (*place, self.std(i))).collect()
    }

    /// What has changed since then.
    pub(super) fn since(&self, before: &[(Place, f64)]) -> Since {
        let now = self.now();
        let pairs = now.iter().zip(before);
        let moves = pairs.clone().map(|((now, std), (then, _))| Moved {
            by: now.position - then.position,
            std: *std,
        });
        let known = pairs.map(|((_, now), (_, then))| (now / then).ln().abs());
        Since {
            moves: self.beyond_common(&moves.collect::<Vec<Moved>>()),
            known: known.fold(0.0, f64::max),
        }
    }

    /// Moves in standard errors, beyond what all have in common: as many terms in the contact stretch as the template has
    /// components, which times and template leave undetermined together.
    fn beyond_common(&self, moves: &[Moved]) -> Vec<f64> {
        let stretches = &self.started.contact_stretches;
        let terms = self.template.components.len();
        let (mut moments, mut right) = ([0.0; 5], [0.0; 3]);
        for (moved, u) in moves.iter().zip(stretches) {
            let mut power = moved.std.powi(-2);
            for (k, moment) in moments.iter_mut().enumerate() {
                *moment += power;
                if k < terms {
                    right[k] += power * moved.by;
                }
                power *= u;
            }
        }
        let [level, slope, bend] = factors(&moments, terms).map_or([0.0; 3], |f| f.solve(&right));
        let beyond = moves.iter().zip(stretches).map(|(moved, u)| {
            let common = level + u * (slope + u * bend);
            (moved.by - common) / moved.std
        });
        beyond.collect()
    }
}

/// What a round changed.
pub(super) struct Since {
    /// Moves in standard errors, against the others.
    moves: Vec<f64>,
    /// Greatest change of a standard error, as a logarithm.
    known: f64,
}

impl Since {
    /// The moves in standard errors, 0 of what rests: which way that goes is rounding.
    pub(super) fn steps(&self) -> impl Iterator<Item = f64> {
        let step = |m: &f64| if m.abs() < HELD_REST { 0.0 } else { *m };
        self.moves.iter().map(step)
    }

    /// Whether nothing moved by much, and no standard error changed by much.
    pub(super) fn rests(&self) -> bool {
        self.known < STD_REST && greatest(&self.moves) < HELD_REST
    }
}

/// Shortens the moves beyond what all have in common, in standard errors, where they go to and fro. What they do together with
/// the others says nothing of that: it creeps on one way for ever, whatever they do beyond it.
fn damp(beyond: &mut [f64], moves: &[Moved], damping: &mut Damping) {
    for (i, z) in beyond.iter_mut().enumerate() {
        *z *= damping.share(i);
    }
    damping.learn(beyond.iter().zip(moves).map(|(z, m)| z * m.std));
}

/// The greatest of some moves, either way.
fn greatest(moves: &[f64]) -> f64 {
    moves.iter().fold(0.0, |a, m| a.max(m.abs()))
}

/// The share that moves, in standard errors, are of those before, where they are steady.
fn steady_share(before: &[f64], now: &[f64]) -> Option<f64> {
    let (same, own, other) = (dot(now, before), dot(now, now), dot(before, before));
    let share = same / other;
    let steady = same > STEADY * (own * other).sqrt() && share > SHARES.0;
    steady.then_some(share.min(SHARES.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_goes_to_and_fro_beyond_a_common_creep_is_damped() {
        let mut damping = Damping::lasting(2);
        for turn in [1.0, -1.0] {
            let moved = |by: f64| Moved { by, std: 0.5 };
            let moves = [moved(3.0 + turn), moved(3.0)];
            damp(&mut [turn, 0.0], &moves, &mut damping);
        }
        assert_eq!([damping.share(0), damping.share(1)], [0.5, 1.0]);
    }

    #[test]
    fn steady_moves_are_told_from_those_that_turn() {
        let before = [1.0, -0.5, 0.2];
        let share = steady_share(&before, &[0.8, -0.4, 0.16]).unwrap();
        assert!((share - 0.8).abs() < 1e-12, "{share}");
        assert_eq!(steady_share(&before, &[-0.8, 0.4, -0.16]), None);
        assert_eq!(steady_share(&before, &[0.3, -0.15, 0.06]), None);
        // Moves that do not shrink would go on for ever.
        let share = steady_share(&before, &[1.1, -0.55, 0.22]).unwrap();
        assert_eq!(share, SHARES.1);
    }
}
