//! Steps that overshoot are shortened, so that they come to rest instead of going to and fro.

/// A step back by this share of the one before has overshot: steps of that unknown are halved (convention) …
const OVERSHOT: f64 = 0.7;
/// … and longer by this factor with each that goes on, up to the whole, where they may be longer again (convention).
const LONGER: f64 = 1.25;

/// Shares of their steps that some unknowns take.
#[derive(Debug)]
pub(super) struct Damping {
    shares: Vec<f64>,
    last: Vec<f64>,
    longer: f64,
}

impl Damping {
    /// Whole steps for so many unknowns at first.
    pub(super) fn of(count: usize) -> Self {
        Self {
            shares: vec![1.0; count],
            last: vec![0.0; count],
            longer: LONGER,
        }
    }

    /// The same without becoming longer: from one round to the next the shares are the same but where a step went back.
    pub(super) fn lasting(count: usize) -> Self {
        Self {
            longer: 1.0,
            ..Self::of(count)
        }
    }

    /// The share of its step that an unknown takes next.
    pub(super) fn share(&self, i: usize) -> f64 {
        self.shares[i]
    }

    /// Learns from the steps that were taken, one of each unknown: after one that goes back by most of the one before, the next
    /// is half as long; after one that goes on, longer again.
    pub(super) fn learn(&mut self, steps: impl Iterator<Item = f64>) {
        let unknowns = self.shares.iter_mut().zip(&mut self.last);
        for ((share, last), step) in unknowns.zip(steps) {
            if step * *last < 0.0 && step.abs() > OVERSHOT * last.abs() {
                *share *= 0.5;
            } else if step * *last > 0.0 {
                *share = (self.longer * *share).min(1.0);
            }
            *last = step;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_to_and_fro_come_to_rest() {
        // Newton's steps are twice too long here, and would go to and fro between 1 and −1 for ever.
        let (mut place, mut damping) = (1.0, Damping::of(1));
        for _ in 0..3 {
            let step = damping.share(0) * -2.0 * place;
            place += step;
            damping.learn(std::iter::once(step));
        }
        assert_eq!(place, 0.0);
    }

    #[test]
    fn steps_on_and_short_steps_back_stay_whole() {
        let mut damping = Damping::of(2);
        for steps in [[1.0, 1.0], [0.9, -0.5], [0.8, 0.2]] {
            damping.learn(steps.into_iter());
        }
        assert_eq!([damping.share(0), damping.share(1)], [1.0, 1.0]);
    }
}
