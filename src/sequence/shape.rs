//! Whether the flights of a chain shrink as those of a ball do, and by how much.

use super::chain::Chain;
use crate::units::real;

/// Scatter of one ln ratio before any is known, and how many ratios that knowledge is worth.
const SCATTER: (f64, f64) = (3e-3, 2.0);

/// Drops of one ball differ in ln e by at most this many standard errors …
const AGREEMENT: f64 = 3.0;
/// … and by this, as e depends on the speed.
const CHANGE: f64 = 0.02;

/// ln of the ratio of a flight to the one before it: its mean over a chain and what that rests on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shrinkage {
    /// Mean of ln(T'/T): ln e.
    pub ln_ratio: f64,
    /// Standard error of that.
    pub std: f64,
    /// Number of ratios known.
    count: f64,
}

impl Shrinkage {
    /// None where fewer than two ratios are known.
    ///
    /// # Formula
    /// Between impacts heard lie n flights of mean T, whose middle is s flights after that of the ones before. Then
    /// `ρ = Σ ln(T'/T)/Σ s`, and a ratio scatters about s·ρ with s times the variance of one bounce. Impacts that are only inferred
    /// break no row of ratios: a clock whose ticks come early and late by turns shrinks where every other rise is left out.
    pub(super) fn of(chain: &Chain) -> Option<Self> {
        let ratios = ratios(chain);
        let steps: f64 = ratios.iter().map(|r| r.steps).sum();
        let count = real(ratios.len());
        let ln_ratio = ratios.iter().map(|r| r.ln).sum::<f64>() / steps;
        let squares = ratios
            .iter()
            .map(|r| (r.ln - r.steps * ln_ratio).powi(2) / r.steps);
        let (scatter, worth) = SCATTER;
        let variance = (worth * scatter * scatter + squares.sum::<f64>()) / (worth + count - 1.0);
        (ratios.len() > 1).then(|| Self {
            ln_ratio,
            std: (variance / steps).sqrt(),
            count,
        })
    }

    /// How much better the flights are explained by a ball than by a hand or a clock, whose ratios have mean 0, in nats.
    ///
    /// # Formula
    /// `(m + ν)/2 · ln(1 + t²/(m − 1 + ν))` with Student's `t = mean/std` of m ratios and what is known of their scatter
    /// beforehand, worth ν = 2; 0 where they grow.
    pub(super) fn nats(&self) -> f64 {
        if self.ln_ratio >= 0.0 {
            return 0.0;
        }
        let t = self.ln_ratio / self.std;
        0.5 * (self.count + SCATTER.1) * (t * t / (self.count - 1.0 + SCATTER.1)).ln_1p()
    }

    /// Whether two chains may be drops of one ball: their ratios agree.
    pub(super) fn agrees(&self, other: &Self) -> bool {
        let off = (self.ln_ratio - other.ln_ratio).abs();
        off < AGREEMENT * self.std.hypot(other.std) + CHANGE
    }
}

/// ln of the ratio of the flights between two impacts heard and those before them, and how many flights later they are.
#[derive(Debug, Clone, Copy)]
struct Ratio {
    ln: f64,
    steps: f64,
}

fn ratios(chain: &Chain) -> Vec<Ratio> {
    let heard = chain.impacts.iter().enumerate();
    let heard: Vec<(usize, f64)> = heard
        .filter(|(_, impact)| impact.is_heard())
        .map(|(n, impact)| (n, impact.time_s))
        .collect();
    let ratio = |w: &[(usize, f64)]| {
        let [before, flights] = [real(w[1].0 - w[0].0), real(w[2].0 - w[1].0)];
        let [earlier_s, later_s] = [(w[1].1 - w[0].1) / before, (w[2].1 - w[1].1) / flights];
        Ratio {
            ln: (later_s / earlier_s).ln(),
            steps: 0.5 * (before + flights),
        }
    };
    heard.windows(3).map(ratio).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::{Impact, Status};

    fn chain(flights_s: impl Iterator<Item = f64>, is_heard: impl Fn(usize) -> bool) -> Chain {
        let mut time_s = 1.0;
        let times_s = std::iter::once(time_s).chain(flights_s.map(|flight_s| {
            time_s += flight_s;
            time_s
        }));
        let impact = |(n, time_s)| Impact {
            status: if is_heard(n) {
                Status::Heard
            } else {
                Status::Inferred
            },
            ..Impact::heard(time_s, 1e-5)
        };
        Chain {
            impacts: times_s.enumerate().map(impact).collect(),
            rejected: Vec::new(),
        }
    }

    #[test]
    fn a_ball_shrinks_as_much_whether_all_its_impacts_are_heard_or_not() {
        let ball = |is_heard: fn(usize) -> bool| {
            let flights_s = (0..20).map(|n| 0.5 * 0.9_f64.powi(n));
            Shrinkage::of(&chain(flights_s, is_heard)).unwrap()
        };
        let (all, some) = (ball(|_| true), ball(|n| n % 4 != 3));
        assert!((all.ln_ratio - 0.9_f64.ln()).abs() < 1e-12, "{all:?}");
        assert!(
            (some.ln_ratio / all.ln_ratio - 1.0).abs() < 0.02,
            "{some:?}"
        );
        assert!(some.nats() > 20.0 && all.nats() > some.nats());
    }

    #[test]
    fn a_clock_whose_ticks_are_early_and_late_by_turns_does_not_shrink_where_each_rise_is_left_out()
    {
        let clock = (0..30).map(|n| [0.253, 0.247, 0.249, 0.251][n % 4]);
        let shrinkage = Shrinkage::of(&chain(clock, |n| n % 4 != 3)).unwrap();
        assert!(shrinkage.nats() < 1.0, "{shrinkage:?}");
    }
}
